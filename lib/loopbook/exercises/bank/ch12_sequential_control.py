"""Exercises of chapter 12, sequential control."""

import math

from sympy import Rational, ceiling, floor, log, sqrt, symbols

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    word,
    words,
)

# --- 12.1 ---------------------------------------------------------------------------------------------------------


@exercise("12.1", title="Scan by scan", points=2, where=lambda m, q: 3 < m / q < 9 and 0.15 <= (m / q) % 1 <= 0.85)
def bottles(
    arrival=between(2, 9, "s", reference=3, step=1),
    m=between(0.5, 2, "kg", reference=1, step=0.25),
    q=between(0.12, 0.4, "kg/s", reference=0.22, step=0.02),
):
    """A machine fills bottles and closes them. Its chart has four steps:

    | step | action | transition to the next step |
    |---|---|---|
    | `Wait` (initial) | `u_cap := FALSE` | `bottle` |
    | `Fill` | `u_valve := TRUE` | {full} |
    | `Cap` | `u_valve := FALSE`, `u_cap := TRUE` | `TRUE` |
    | `Away` | | `NOT bottle`, back to `Wait` |

    The chart is scanned once a second, the first time at 0 s. At {arrival}, just before the scan, a bottle comes, and
    it stays for a while. While the valve is open, {q} flow into the bottle; `mass` is what has flowed in, in kg, and
    valve and scale have no delay.

    At which scans do the steps `Fill`, `Cap` and `Away` become active, and how much is in the bottle in the end?
    """
    scans = ceiling(m / q)
    return answers(
        Fill=number(arrival, "s", "the time at which Fill becomes active", within=0.005),
        Cap=number(arrival + scans, "s", "the time at which Cap becomes active", within=0.005),
        Away=number(arrival + scans + 1, "s", "the time at which Away becomes active", within=0.005),
        mass=number(scans * q, "kg", "the mass in the bottle", within=0.005),
    )


@bottles.shows
def _(m):
    return {"full": f"`mass >= {float(m):g}`"}


@bottles.mistake("The condition is tested in the scans only. Which scan is the first one that finds it true?")
def _(arrival, m, q):
    return {"Cap": arrival + m / q}


@bottles.mistake("That is the time since the valve was opened. The clock runs from the first scan on.")
def _(m, q):
    return {"Cap": ceiling(m / q), "Away": ceiling(m / q) + 1}


@bottles.mistake("An unconditional transition is a transition, too: its step is active for how many scans?")
def _(arrival, m, q):
    return {"Away": arrival + ceiling(m / q)}


@bottles.mistake("The bottle comes just before the scan. Which scan is the first one that sees it?")
def _(arrival):
    return {"Fill": arrival + 1}


@bottles.mistake("At that scan the limit is not yet reached: the mass of whole scans counts.")
def _(arrival, m, q):
    return {"Cap": arrival + floor(m / q), "mass": floor(m / q) * q}


@bottles.mistake("That is one scan too late. In the scan in which `Fill` becomes active the valve is already opened.")
def _(arrival, m, q):
    return {"Cap": arrival + ceiling(m / q) + 1, "Away": arrival + ceiling(m / q) + 2, "mass": (ceiling(m / q) + 1) * q}


@bottles.mistake("That is the limit in the condition. The valve stays open until a scan finds it reached.")
def _(m):
    return {"mass": m}


# --- 12.2 ---------------------------------------------------------------------------------------------------------

OUTPUTS = ["pump", "heater", "dosing", "stirrer", "drain", "lamp"]


def boxes(stop, lamp, stir):
    """The actions of the steps, in their order; where the pump stops, the lamp and the stirrer start, varies."""
    steps = {
        "Rinse": {"pump": True, "drain": True},
        "Dose": {"drain": False, "dosing": True},
        "Heat": {"dosing": False, "heater": True},
        "Soak": {},
        "Empty": {"heater": False, "stirrer": False, "drain": True},
    }
    steps[stir]["stirrer"] = steps[lamp]["lamp"] = True
    steps[stop]["pump"] = False
    return steps


def stored(stop, lamp, stir, step):
    """What is on in a step when every value is kept until another action changes it."""
    on = {}
    for name, actions in boxes(stop, lamp, stir).items():
        on |= actions
        if name == step:
            return [output for output in OUTPUTS if on.get(output)]


def while_active(stop, lamp, stir, step):
    """What is on in a step when an action lasts as long as its step."""
    return [output for output in OUTPUTS if boxes(stop, lamp, stir)[step].get(output)]


def _two_answers(stop, lamp, stir, step):
    return 0 < len(while_active(stop, lamp, stir, step)) < len(stored(stop, lamp, stir, step))


@exercise("12.2", title="What is on?", points=2, where=_two_answers)
def what_is_on(
    stop=choice("Soak", "Dose", "Heat", "Empty"),
    lamp=choice("Soak", "Rinse", "Dose", "Heat", "Empty"),
    stir=choice("Soak", "Dose", "Heat"),
    step=choice("Heat", "Dose", "Soak", "Empty"),
):
    """A vessel is cleaned by a chart without branches. Before the start all outputs are FALSE; the steps follow one
    another from top to bottom, and their actions are those in the table.

    {table}

    Which outputs are TRUE while the step `{step}` is active, if the values are stored as in the charts of this chapter?
    And which of them would be TRUE with the same table if every output were on only as long as a step is active that
    sets it to TRUE, as with the standard's default qualifier N?
    """
    return answers(
        stored=words(stored(stop, lamp, stir, step), OUTPUTS, what="the outputs that are on with stored values"),
        default=words(while_active(stop, lamp, stir, step), OUTPUTS, what="the outputs that are on with qualifier N"),
    )


@what_is_on.shows
def _(stop, lamp, stir):
    rows = ["| step | actions |", "|---|---|"]
    for name, actions in boxes(stop, lamp, stir).items():
        done = ", ".join(f"`{output} := {str(value).upper()}`" for output, value in actions.items())
        rows.append(f"| `{name}` | {done or 'none'} |")
    return {"table": "\n".join(rows)}


@what_is_on.mistake(
    "The two rules are interchanged. With stored values an output stays as it is until an action changes it."
)
def _(stop, lamp, stir, step):
    return {"stored": while_active(stop, lamp, stir, step), "default": stored(stop, lamp, stir, step)}


@what_is_on.mistake("Go through the table from the top and cross out what an action has set to FALSE on the way.")
def _(stop, lamp, stir, step):
    ever = {}
    for name, actions in boxes(stop, lamp, stir).items():
        ever |= {output: True for output, value in actions.items() if value}
        if name == step:
            break
    ever = [output for output in OUTPUTS if ever.get(output)]
    return {"stored": ever} if ever != stored(stop, lamp, stir, step) else {}


# --- 12.3 ---------------------------------------------------------------------------------------------------------

SIZES = ["Small", "Medium", "Large"]
ORDERS = ("Medium, Small, Large", "Small, Medium, Large", "Large, Medium, Small", "Medium, Large, Small")


def conditions(order, w_1, w_2):
    """The branches in their order, as pairs of step and lowest and highest mass (that excluded) of its condition."""
    from_below = order.endswith("Large")
    of = {
        "Small": (-math.inf, w_1) if from_below else (-math.inf, math.inf),
        "Medium": (-math.inf, w_2) if from_below else (w_1, math.inf),
        "Large": (-math.inf, math.inf) if from_below else (w_2, math.inf),
    }
    return [(size, *of[size]) for size in order.split(", ")]


def way_of(egg, order, w_1, w_2, pick=0):
    """The step to which an egg is sent: the first one whose condition is true."""
    return [size for size, low, high in conditions(order, w_1, w_2) if low <= egg < high][pick]


def by_name(egg, w_1, w_2):
    return SIZES[sum(bool(egg >= limit) for limit in (w_1, w_2))]


@exercise("12.3", title="Which way, egg?", points=2)
def eggs(
    order=choice(*ORDERS),
    w_1=between(51, 54, "g", reference=53, step=1),
    w_2=between(61, 64, "g", reference=63, step=1),
    a=between(46, 50, "g", reference=48, step=1),
    b=between(55, 60, "g", reference=58, step=1),
    c=between(65, 72, "g", reference=67, step=1),
):
    """Eggs are weighed and sorted. Three transitions leave the step `Weigh`, in this order:

    {branches}

    The chart is run by the rules of this chapter. To which step do three eggs of {a}, {b} and {c} come? Which step is
    reached by no egg, whatever its mass?
    """
    a, b, c = (way_of(egg, order, w_1, w_2) for egg in (a, b, c))
    never = [size for size in SIZES if size not in (a, b, c)]
    return answers(
        first=word(a, SIZES, what="the step of the first egg"),
        second=word(b, SIZES, what="the step of the second egg"),
        third=word(c, SIZES, what="the step of the third egg"),
        never=word(*never or ["none"], [*SIZES, "none"], what="the step that no egg reaches"),
    )


@eggs.shows
def _(order, w_1, w_2):
    lines = []
    for n, (size, low, high) in enumerate(conditions(order, w_1, w_2), start=1):
        condition = f"mass < {high}" if high < math.inf else f"mass >= {low}" if low > -math.inf else "TRUE"
        lines.append(f"{n}. to `{size}`: `{condition}`")
    return {"branches": "\n".join(lines)}


def _others(found, **key):
    return {name: size for name, size in found.items() if size != key[name]}


def _key(order, w_1, w_2, a, b, c):
    eggs = dict(first=a, second=b, third=c)
    return {name: way_of(egg, order, w_1, w_2) for name, egg in eggs.items()}


@eggs.mistake("That is where the mass of the egg belongs. Which condition does a scan find true first?")
def _(order, w_1, w_2, a, b, c):
    meant = dict(first=by_name(a, w_1, w_2), second=by_name(b, w_1, w_2), third=by_name(c, w_1, w_2))
    return _others(meant, **_key(order, w_1, w_2, a, b, c))


@eggs.mistake("The last true condition does not win. In which order are alternative branches tested?")
def _(order, w_1, w_2, a, b, c):
    last = {name: way_of(egg, order, w_1, w_2, -1) for name, egg in dict(first=a, second=b, third=c).items()}
    meant = dict(first=by_name(a, w_1, w_2), second=by_name(b, w_1, w_2), third=by_name(c, w_1, w_2))
    return {x: size for x, size in _others(last, **_key(order, w_1, w_2, a, b, c)).items() if size != meant[x]}


@eggs.mistake(
    "Is there a condition that no scan ever finds true first, since the one before it holds for all such eggs?"
)
def _(order, w_1, w_2, a, b, c):
    return {"never": "none"} if len(set(_key(order, w_1, w_2, a, b, c).values())) < 3 else {}


# --- 12.4 ---------------------------------------------------------------------------------------------------------

PLANTS = {
    "A paint shop": ("Load", "Heat", "Mix", "Rinse"),
    "A dye works": ("Fill", "Warm", "Dose", "Drain"),
    "A dairy": ("Start", "Heat", "Stir", "Flush"),
    "A bakery": ("Weigh", "Knead", "Preheat", "Clean"),
}
MISTAKES = {
    "dead end": "no transition leaves the step",
    "orphan": "no transition leads to the step, which is not the initial one",
    "covered branch": "the step is behind a transition that is never cleared, because of the one before it in the list",
    "waiting forever": "the step is behind a convergence of steps that are never active together",
    "twice active": "the step can be activated again while it is still active",
    "sound": "none of these, and the step is `none`",
}


def steps_of(plant, swapped):
    """The four steps of a chart, in one of two orders."""
    first, second, third, last = PLANTS[plant]
    return (first, third, second, last) if swapped else (first, second, third, last)


def faulty_chart(mistake, A, B, C, D):
    """The transitions of a chart, and the step that suffers by its mistake."""
    return {
        "dead end": ([(A, B, "start"), (B, C, "done"), (C, A, "empty"), (B, D, "fault")], D),
        "orphan": ([(A, B, "start"), (B, C, "done"), (C, A, "empty"), (D, A, "reset")], D),
        "covered branch": (
            [(A, B, "start"), (B, C, "TRUE"), (B, D, "fault"), (C, A, "empty"), (D, A, "reset")], D
        ),
        "waiting forever": (
            [(A, B, "start"), (A, C, "fault"), ((B, C), D, "done"), (D, A, "empty")], D
        ),
        "twice active": (
            [(A, (B, C), "start"), (B, D, "fault"), ((B, C), D, "done"), (D, A, "empty")], C
        ),
        "sound": ([(A, (B, C), "start"), ((B, C), D, "done"), (D, A, "empty")], "none"),
    }[mistake]  # fmt: skip


@exercise("12.4", title="What is wrong with this chart?", points=3)
def wrong_chart(
    plant=choice(*PLANTS),
    mistake=choice("twice active", "dead end", "orphan", "covered branch", "waiting forever", "sound"),
    swapped=choice(0, 1),
):
    """{plant} runs by a chart with the initial step `{first}`. These are its transitions in their order, each with the
    steps in front of it, those behind it, and its condition:

    ```
    {transitions}
    ```

    The chart has one of these mistakes, or none:

    {list}

    Which one? And which is the step?
    """
    _, step = faulty_chart(mistake, *steps_of(plant, swapped))
    return answers(
        mistake=word(mistake, [*MISTAKES], what="the mistake"),
        step=word(step, [*PLANTS[plant], "none"], what="the step"),
    )


@wrong_chart.shows
def _(plant, mistake, swapped):
    ways, _ = faulty_chart(mistake, *steps_of(plant, swapped))
    lines = []
    for before, behind, condition in ways:
        before, behind = (y if isinstance(y, str) else " and ".join(y) for y in (before, behind))
        lines.append(f"{before} → {behind}: {condition}")
    names = "\n".join(f"- *{name}*: {meaning}" for name, meaning in MISTAKES.items())
    return {"first": PLANTS[plant][0], "transitions": "\n".join(lines), "list": names}


@wrong_chart.mistake(
    "Simultaneous branches end where one transition has all their last steps before it. "
    "Is there a transition that leaves one of the branches alone?"
)
def _(mistake):
    return {"mistake": "sound"} if mistake == "twice active" else {}


@wrong_chart.mistake(
    "Each transition is fine on its own. But one of them has two steps before it: are both ever active?"
)
def _(mistake):
    return {"mistake": "sound"} if mistake == "waiting forever" else {}


@wrong_chart.mistake(
    "If all goes well, both branches come to their end. What is active after a fault, and what comes next?"
)
def _(mistake):
    return {"mistake": "waiting forever"} if mistake == "twice active" else {}


@wrong_chart.mistake("This one is left by the transition. Look at what goes on in the other branch meanwhile.")
def _(plant, mistake, swapped):
    return {"step": steps_of(plant, swapped)[1]} if mistake == "twice active" else {}


@wrong_chart.mistake("A transition does leave it and one leads to it. Look at when these can be cleared.")
def _(mistake):
    return {"mistake": "orphan"} if mistake in ("covered branch", "waiting forever") else {}


# --- 12.5 ---------------------------------------------------------------------------------------------------------


@exercise(
    "12.5",
    title="Heat and dose",
    points=3,
    where=lambda T_0, T_SP, rate, n, dose: abs((T_SP - T_0) / rate - n * dose) >= 4 and (T_SP - T_0) / rate <= 60,
)
def heat_and_dose(
    T_0=between(12, 25, "°C", reference=20, step=1),
    T_SP=between(60, 90, "°C", reference=80, step=5),
    rate=between(1, 3, "K/min", reference=2),
    n=choice(4, 2, 3),
    dose=between(5, 15, "min", reference=9, step=1),
    react=between(20, 60, "min", reference=45, step=5),
):
    """A reactor is filled with water of {T_0}. After `Start` two simultaneous branches begin. In the first one the step
    `Heat` warms the water by {rate} until it has {T_SP}; then the step `Hold` waits. In the second one {number} powders
    are weighed in one after the other, in the steps {doses}, of {dose} each; then the step `Ready` waits. When `Hold`
    and `Ready` are both active, an unconditional transition leads from them to `React`, which lasts for {react}. After
    it the chart is back in `Start`, where it needs a button to begin again.

    When does `React` begin and when does it end, counted from the beginning of the branches? (The scans are so short
    that they do not matter.) Which step has waited? How many states has the state diagram of the chart?
    """
    heating, dosing = (T_SP - T_0) / rate, n * dose
    return answers(
        begin=number(max(heating, dosing), "min", "the time at which React begins"),
        end=number(max(heating, dosing) + react, "min", "the time at which React ends"),
        waited=word("Ready" if heating > dosing else "Hold", ["Hold", "Ready"], what="the step that has waited"),
        states=number(2 * (n + 1) + 2, "", "the number of states", within=0),
    )


@heat_and_dose.shows
def _(n):
    doses = [f"`Dose{k}`" for k in range(1, int(n) + 1)]
    return {
        "number": {2: "two", 3: "three", 4: "four"}[int(n)],
        "doses": ", ".join(doses[:-1]) + " and " + doses[-1],
    }


@heat_and_dose.mistake("Simultaneous branches run at the same time, independently of each other.")
def _(T_0, T_SP, rate, n, dose, react):
    both = (T_SP - T_0) / rate + n * dose
    return {"begin": both, "end": both + react}


@heat_and_dose.mistake("That is when the first of the branches is done. What does the convergence wait for?")
def _(T_0, T_SP, rate, n, dose, react):
    first = min((T_SP - T_0) / rate, n * dose)
    return {"begin": first, "end": first + react}


@heat_and_dose.mistake("That step comes at the end of the longer branch. Which one is reached first?")
def _(T_0, T_SP, rate, n, dose):
    return {"waited": "Hold" if (T_SP - T_0) / rate > n * dose else "Ready"}


@heat_and_dose.mistake("That is the number of steps. A state is the set of all steps that are active together.")
def _(n):
    return {"states": n + 5}


@heat_and_dose.mistake(
    "That is how many occur in one run. The diagram has all combinations that can be active together, whatever "
    "the times."
)
def _(n):
    return {"states": n + 4} if n != 2 else {}


@heat_and_dose.mistake("Something is missing: the waiting steps count, and so do the steps outside the branches.")
def _(n):
    return {"states": 2 * (n + 1)} if n != 3 else {}


# --- 12.6 ---------------------------------------------------------------------------------------------------------


def stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    """Filling, heating, holding and emptying, in min."""
    filling = A * (h_1 - h_0) / q * 1000 / 60
    heating = tau * log((T_end - T_0) / (T_end - T_SP))
    emptying = 2 * A * (sqrt(h_1) - sqrt(h_0)) / K_v * 1000 / 60
    return tuple(float(x) for x in (filling, heating, hold, emptying))


def _whole_batches(**given):
    return 0.2 <= 480 / sum(stages(**given)) % 1 <= 0.8


@exercise(
    "12.6",
    title="How many batches in a shift?",
    points=4,
    where=lambda A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold: _whole_batches(
        A=A, h_0=h_0, h_1=h_1, q=q, K_v=K_v, tau=tau, T_0=T_0, T_SP=T_SP, T_end=T_end, hold=hold
    ),
)
def shift(
    A=between(0.6, 1.5, "m²", reference=0.8, step=0.1),
    h_0=choice(Rational("0.09"), Rational("0.04"), Rational("0.16"), unit="m"),
    h_1=choice(Rational("0.81"), Rational("0.64"), 1, Rational("1.21"), unit="m"),
    q=between(1, 4, "", reference=2),
    K_v=between(1.5, 4, "", reference=2),
    tau=between(60, 120, "min", reference=90),
    T_0=between(10, 20, "°C", reference=15, step=1),
    T_SP=between(50, 70, "°C", reference=60, step=5),
    T_end=between(85, 100, "°C", reference=100, step=5),
    hold=between(15, 40, "min", reference=25, step=5),
):
    r"""Wool is dyed in batches. The vat has an area of {A}. Its chart runs in a circle: `Fill` at {q} L/s from the
    level $h_0$ = {h_0} up to $h_1$ = {h_1}; `Heat` at full power from $T_0$ = {T_0} to $T_{SP}$ = {T_SP}; `Dye`, which
    its timer ends after {hold}; `Empty` back to $h_0$ through a valve at $h = 0$ with $K_v$ = {K_v} L/(s m$^{1/2}$), by
    Torricelli's law $A\,dh/dt = -K_v \sqrt{h}$. At full power the water follows a lag of $\tau$ = {tau} towards
    $T_{end}$ = {T_end}.

    Give the time of `Empty` in the symbols `A`, `K_v`, `h_0` and `h_1`, in units that fit together; then the time of
    `Heat` and of a whole batch. How many whole batches are finished in a shift of eight hours that begins with `Fill`?
    (The scans are so short that they do not matter.)
    """
    _, heating, _, _ = times = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    a, k, low, high = symbols("A K_v h_0 h_1", positive=True)
    return answers(
        Empty=expression(2 * a * (sqrt(high) - sqrt(low)) / k, "the time of Empty, in A, K_v, h_0 and h_1"),
        Heat=number(heating, "min", "the time of Heat"),
        batch=number(sum(times), "min", "the time of a batch"),
        batches=number(floor(480 / sum(times)), "", "the number of finished batches"),
    )


@shift.mistake("That takes the outflow at the full level for the whole time. It becomes less as the level falls.")
def _():
    a, k, low, high = symbols("A K_v h_0 h_1", positive=True)
    return {"Empty": a * (high - low) / (k * sqrt(high))}


@shift.mistake(
    "That would empty a vat that is filled to $h_1 - h_0$. The root of a difference is not the difference of the roots."
)
def _():
    a, k, low, high = symbols("A K_v h_0 h_1", positive=True)
    return {"Empty": 2 * a * sqrt(high - low) / k}


@shift.mistake("That empties the vat to its bottom. At which level does `Empty` end?")
def _():
    a, k, high = symbols("A K_v h_1", positive=True)
    return {"Empty": 2 * a * sqrt(high) / k}


@shift.mistake("Differentiate the root of the level with respect to time again: a factor is missing.")
def _():
    a, k, low, high = symbols("A K_v h_0 h_1", positive=True)
    return {"Empty": a * (sqrt(high) - sqrt(low)) / k}


@shift.mistake("That holds while the water warms up as fast as at the beginning. A lag becomes slower and slower.")
def _(tau, T_0, T_SP, T_end):
    return {"Heat": tau * (T_SP - T_0) / (T_end - T_0)}


@shift.mistake("The logarithm that belongs to a lag has the base e.")
def _(tau, T_0, T_SP, T_end):
    return {"Heat": float(tau) * math.log10((T_end - T_0) / (T_end - T_SP))}


@shift.mistake("That is the time from zero degrees to the setpoint. At which temperature does heating begin?")
def _(tau, T_SP, T_end):
    return {"Heat": float(tau) * math.log(T_end / (T_end - T_SP))}


@shift.mistake("One step is missing from that sum. Which of the four?")
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    times = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    return {"batch": sum(times) - float(hold)}


@shift.mistake("How many of these are complete?")
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    return {"batches": 480 / sum(stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold))}


@shift.mistake("That may be its value here. Give an expression in the symbols.")
def _(A, h_0, h_1, K_v):
    return {"Empty": float(2 * A * (sqrt(h_1) - sqrt(h_0)) / K_v) * 1000 / 60}


@shift.mistake("A batch that is still in the vat is not finished.")
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    times = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    return {"batches": floor(480 / sum(times)) + 1}


# --- 12.7 ---------------------------------------------------------------------------------------------------------

SCAN = 2  # s


def slowest(A, h_0, h_1, q_low):
    """The time of filling with the weakest supply, in s."""
    return 1000 * A * (h_1 - h_0) / q_low


def level_at_last(limit, A, h_0, q_high, close):
    """The highest level if nobody notices that the tank is full, in m."""
    return float(h_0) + float(q_high) * (float(limit) + SCAN + float(close) / 2) / (1000 * float(A))


def latest(A, h_0, q_high, close, rim):
    """The limit with which that level is at the rim, in s."""
    return 1000 * A * (rim - h_0) / q_high - SCAN - close / 2


def _room_for_limit(A, h_0, h_1, q_low, q_high, close, rim):
    if q_high <= 1.1 * q_low:
        return False
    return 1.06 < latest(A, h_0, q_high, close, rim) / (slowest(A, h_0, h_1, q_low) / 0.9) < 1.4


@exercise("12.7", title="A way out of filling", points=5, where=_room_for_limit)
def way_out(
    A=between(0.5, 2, "m²", reference=1.2, step=0.1),
    h_0=between(0.05, 0.2, "m", reference=0.1, step=0.05),
    h_1=between(0.7, 1.1, "m", reference=0.9, step=0.1),
    rim=between(1.1, 1.8, "m", reference=1.5, step=0.1),
    q_low=between(2, 6, "L/s", reference=4),
    q_high=between(2.5, 7, "L/s", reference=5),
    close=between(4, 20, "s", reference=10, step=2),
):
    r"""The step `Fill` of a chart opens the inlet valve of a tank, and the transition `h > {full}` ends it. The area is
    {A}, filling begins at {h_0}, and the rim of the tank is at {rim}. The supply gives between {q_low} and {q_high}.
    The level transmitter may get stuck. So `Fill` is to have a second way out, the transition `Fill.T > limit` to a
    step `Alarm` that closes the valve. The chart is scanned every 2 s. The valve needs {close} to close, in which its
    flow falls to zero at a constant rate.

    How long does filling take at the longest if all is well? Choose the limit, in s. The longest normal filling may
    take 90 % of it at most, so that nobody gets used to false alarms; and if the transmitter is stuck, the water must
    not run over even when the alarm comes one whole scan late.
    """
    longest = slowest(A, h_0, h_1, q_low)
    last = latest(A, h_0, q_high, close, rim)
    return answers(
        longest=number(longest, "s", "the longest time of a normal filling"),
        limit=design(
            number(floor((longest / 0.9 + last) / 2), "s", "the limit"),
            criterion(
                "the longest normal filling",
                lambda x: 100 * float(longest) / x if x > 0 else math.inf,
                below=90,
                unit="% of the limit",
            ),
            criterion(
                "the highest level", lambda x: level_at_last(x, A, h_0, q_high, close), below=float(rim), unit="m"
            ),
        ),
    )


@way_out.shows
def _(h_1):
    return {"full": f"{float(h_1):g}"}


@way_out.mistake("With that supply the tank fills fastest. Which supply makes filling long?")
def _(A, h_0, h_1, q_high):
    return {"longest": slowest(A, h_0, h_1, q_high)}


@way_out.mistake("There the tank is filled from its bottom on. At which level does filling begin?")
def _(A, h_1, q_low):
    return {"longest": slowest(A, 0, h_1, q_low)}


@way_out.mistake(
    "With that limit the water has reached the rim when the time is over, and the valve has not even begun to close."
)
def _(A, h_0, q_high, rim):
    return {"limit": 1000 * A * (rim - h_0) / q_high}
