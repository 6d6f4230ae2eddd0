"""Exercises of chapter 11, control structures."""

import cmath
import math

import numpy as np
from sympy import Min, Rational, exp, symbols

from exercisebook.parameters import written
from exercisebook.reading import listed
from loopbook import diagrams
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    settings,
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.pid import PID

OTHER = {"reverse": "direct", "direct": "reverse"}


def _apart(value, *others, by=0.03):
    """Whether a wrong value can be told from the right one and from those of other mistakes."""
    return all(abs(value - other) > by * abs(other) for other in others)


# --- 11.1 ---------------------------------------------------------------------------------------------------------


@exercise(
    "11.1",
    title="Lemonade from syrup",
    points=2,
    insight="Multiply the wild stream, do not divide by it: the loop gain is then the same at every production rate.",
)
def lemonade(
    x_S=between(58, 70, "%", reference=65),
    x_L=between(8, 16, "%", reference=13),
    F_S=between(0.4, 2, "kg/s", reference=0.5),
    part=between(20, 80, "%", reference=25, step=5),
):
    """Lemonade is mixed from sugar syrup and water. The syrup contains {x_S} of sugar by mass, the lemonade should
    contain {x_L}, and the water has none. The syrup is the wild stream: its flow follows the filling machine, and is
    {F_S} now. A ratio controller multiplies the measured flow of syrup by $K$, and the result is the setpoint of the
    water's flow controller, $F_{W,SP} = K F_S$.

    Which ratio $K$ is needed, and what is the setpoint of the water now? Somebody proposes to control the measured
    quotient $F_W/F_S$ instead, with the same valve. Suppose the flow of syrup falls to {part} of what it is now: by
    which factor does the gain from the control signal to the quotient change?
    """
    K = x_S / x_L - 1
    return answers(
        K=number(K, "", "the ratio of water to syrup"),
        F_W=number(K * F_S, "kg/s", "the setpoint of the water's flow"),
        factor=number(100 / part, "", "the factor by which the gain of the quotient changes"),
    )


@lemonade.mistake("That is the ratio of the lemonade to the syrup. What flows through the valve for water?")
def _(x_S, x_L, F_S):
    return {"K": x_S / x_L, "F_W": x_S / x_L * F_S}


@lemonade.mistake("That is the ratio of the two sugar contents. Set up two balances, of the sugar and of all the mass.")
def _(x_S, x_L, F_S):
    return {"K": x_L / x_S, "F_W": x_L / x_S * F_S}


@lemonade.mistake("That is the share of the water in the lemonade. The ratio controller starts from the flow of syrup.")
def _(x_S, x_L, F_S):
    return {"K": 1 - x_L / x_S, "F_W": (1 - x_L / x_S) * F_S}


@lemonade.mistake(
    "With $K F_S$ as setpoint the loop gain would stay as it is. The quotient has the flow of syrup in its denominator."
)
def _():
    return {"factor": 1}


@lemonade.mistake(
    "That is the fraction by which the flow of syrup falls. Write the quotient's gain before and after, and divide."
)
def _(part):
    return {"factor": 1 - part / 100} if part != 50 else {}


@lemonade.mistake("That is the ratio of the syrup to the water. Which of the two flows is multiplied by $K$?")
def _(x_S, x_L, F_S):
    K = x_S / x_L - 1
    return {"K": 1 / K, "F_W": F_S / K}


@lemonade.mistake("The quotient has the flow of syrup in its denominator. What does a smaller denominator do to it?")
def _(part):
    return {"factor": part / 100}


@lemonade.mistake(
    "That is by how much the gain grows, relative to what it was. The factor is the new gain over the old one."
)
def _(part):
    return {"factor": 100 / part - 1} if part != 50 else {}


@lemonade.mistake("That holds for pure sugar in the place of the syrup. How much sugar is in a kilogram of syrup?")
def _(x_L, F_S):
    return {"K": 100 / x_L - 1, "F_W": (100 / x_L - 1) * F_S}


@lemonade.mistake("There the flow of syrup falls *by* {part}. It falls *to* {part}: how much of it is left?")
def _(part):
    return {"factor": 100 / (100 - part)} if part != 50 else {}


lemonade.hints(
    "Sugar is neither made nor lost: which balances hold for the place where the two streams meet?",
    "Of the sugar $x_S F_S = x_L (F_S + F_W)$; put $F_W = K F_S$ in. For the last question, write the gain of the "
    "quotient: the valve changes $F_W$, and $F_S$ is in the denominator.",
    "Divided by $F_S$ the balance is ${x_S} = {x_L} \\cdot (1 + K)$. The syrup's flow becomes ${part}/100$ of what it "
    "was, and the gain of the quotient is proportional to $1/F_S$.",
)


@lemonade.solution
def _():
    r"""All the sugar comes with the syrup, and the lemonade is as much as syrup and water together:
    $x_S F_S = x_L (F_S + F_W)$. With $F_W = K F_S$ the flow of syrup cancels: ${x_S} = {x_L} \cdot (1 + K)$.

    ***

    So $K = {x_S}/{x_L} - 1$, which is {K}. The setpoint of the water is $K F_S = {K} \cdot {F_S}$, which is {F_W}.

    The valve changes $F_W$ by a certain amount for each percent. In the quotient $F_W/F_S$ this amount is divided by
    the flow of syrup. If that falls to {part}, the gain of the quotient changes by the factor $100/{part}$, which is
    {factor}, and the loop gain with it. With $K F_S$ as the setpoint, nothing of the kind happens.
    """
    return {}


@lemonade.picture
def _(x_S, x_L):
    """The flow diagram: the measured flow of syrup times K is the setpoint of the flow controller of the water."""
    layout = """
        syrup  FT1  .   .   M   lemonade
        K      x    .   .   .   .
        .      FC2  2   .   .   .
        water  FT2  V2  .   3   ."""
    parts = {"V2": diagrams.control_valve(), "x": r"\times", "M": "Mixer"}
    names = {"syrup": f"syrup, {x_S} $\\%$ sugar", "lemonade": f"lemonade, {x_L} $\\%$ sugar"}
    pipes, signals = "syrup FT1 M lemonade, water FT2 V2 3 M", "FT1 x FC2 2 V2, K x, FT2 FC2"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)


# --- 11.2 ---------------------------------------------------------------------------------------------------------


def blanket_valves(u, split, action):
    """The openings of the vent and of the inlet for nitrogen."""
    falling, rising = max(0, 100 * (1 - u / split)), max(0, 100 * (u - split) / (100 - split))
    return (falling, rising) if action == "reverse" else (rising, falling)


def _clear_opening(u, split):
    moving = max(blanket_valves(u, split, "reverse"))
    return split != 50 and abs(u - split) >= 5 and abs(moving - 50) >= 5 and moving <= 95


@exercise(
    "11.2",
    title="Nitrogen over a solvent",
    points=2,
    where=_clear_opening,
    insight="Over the whole range more signal must do the same thing to the process, so one valve closes where the "
    "other one opens.",
)
def blanket(
    action=choice("reverse", "direct"),
    split=between(30, 70, "%", reference=40, step=5),
    u=between(5, 95, "%", reference=30, step=5),
):
    """The space above a solvent in a tank is filled with nitrogen. One pressure controller keeps the pressure with two
    valves: the inlet lets nitrogen in, the vent lets gas out. The two must never be open at the same time. Below
    {split} of the control signal one of them travels its full range, above {split} the other one. The controller is set
    to *{action}* action.

    Which of the valves moves in the lower part of the range? What are the openings when the control signal is {u}?
    """
    vent, inlet = blanket_valves(u, split, action)
    return answers(
        lower=word("vent" if action == "reverse" else "inlet", ["vent", "inlet"], what="the valve of the lower part"),
        vent=number(vent, "%", "the opening of the vent"),
        inlet=number(inlet, "%", "the opening of the inlet"),
    )


@blanket.mistake(
    "That belongs to the other action of the controller. Does its signal rise or fall as the pressure rises?"
)
def _(u, split, action):
    vent, inlet = blanket_valves(u, split, OTHER[action])
    return {"lower": "inlet" if action == "reverse" else "vent", "vent": vent, "inlet": inlet}


@blanket.mistake(
    "That valve moves the wrong way. Over the whole range more signal must move the pressure in one direction, "
    "so that one valve closes where the other one opens."
)
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: 100 - opening for valve, opening in openings.items() if opening}


@blanket.mistake("At this control signal the other valve is open. May this one be open, too?")
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: 100 for valve, opening in openings.items() if not opening}


@blanket.mistake("That is the control signal. Each valve travels its full range over a part of it.")
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: u for valve, opening in openings.items() if opening and abs(opening - u) > 2}


@blanket.mistake("There the valve takes all of the range for its travel. Over which part of it does this valve move?")
def _(u, split, action):
    here = blanket_valves(u, split, action)
    wrong, opening = 100 - u, max(here)
    others = opening, 100 - opening, *blanket_valves(u, split, OTHER[action]), u
    moving = ("vent", "inlet")[here.index(opening)]
    return {moving: wrong} if u < split and _apart(wrong, *others, by=0.05) else {}


@blanket.mistake("Which of the two valves moves in this part of the range, and which way?")
def _(u, split, action):
    here = blanket_valves(u, split, action)
    closed, wrong = ("vent", "inlet")[here.index(min(here))], 100 - max(here)
    return {closed: wrong} if _apart(wrong, *blanket_valves(u, split, OTHER[action])) else {}


@blanket.mistake("That would be right if the range were split in the middle. Where is it split here?")
def _(u, split, action):
    if (u - split) * (u - 50) <= 0:
        return {}
    here = blanket_valves(u, split, action)
    middle = blanket_valves(u, Rational(50), action)
    pairs = zip(("vent", "inlet"), here, middle, strict=True)
    return {valve: there for valve, opening, there in pairs if abs(there - opening) > 2}


blanket.hints(
    "What does the action of a controller say? How does its signal move when the pressure is too high?",
    "Too high a pressure must move the signal towards an open vent, too low a one towards an open inlet. The two are "
    "therefore at opposite ends of the range, and both are closed at the split.",
    "With {action} action the signal {moves} when the pressure rises. The valve of the lower part is fully open at 0 "
    "% and closed at {split}; the other one is closed at {split} and fully open at 100 %.",
)


@blanket.shows
def _(action):
    return {"moves": "falls" if action == "reverse" else "rises"}


@blanket.solution
def _(u, split, action):
    r"""With {action} action the signal {moves} when the pressure rises. There gas must be let out, so the vent belongs
    to the {end} end of the range: the valve of the lower part is the {lower}. It is fully open at 0 % and closes
    towards {split}; the {upper} opens from there up to 100 %.

    A control signal of {u} is {side} the split. There the {closed} is closed, 0 %, and the {moving} has moved along its
    part of the range by {way} of {length}: it is open by {opening}. So the vent is at {vent} and the inlet at {inlet}.
    """
    lower, upper = ("vent", "inlet") if action == "reverse" else ("inlet", "vent")
    low = u < split
    return {
        "end": "lower" if action == "reverse" else "upper", "upper": upper, "side": "below" if low else "above",
        "moving": lower if low else upper, "closed": upper if low else lower,
        "way": (split - u if low else u - split, "%"), "length": (split if low else 100 - split, "%"),
        "opening": (max(blanket_valves(u, split, action)), "%"),
    }  # fmt: skip


@blanket.picture
def _(action, u):
    """The flow diagram: one pressure controller in {action} action moves the inlet for nitrogen and the vent."""
    layout = """
        .         .      mode  .     .
        .         4      PC    5     .
        .         .      PT    .     .
        nitrogen  inlet  3     vent  outside
        .         .      tank  .     ."""
    parts = {"inlet": diagrams.control_valve("inlet"), "vent": diagrams.control_valve("vent")}
    parts["tank"] = diagrams.vessel(filled=0.6)
    names = {"mode": f"{action} action, $u$ = {u} $\\%$"}
    pipes, signals = "nitrogen inlet 3 vent outside, 3 tank", "3 PT PC 4 inlet, PC 5 vent, mode PC"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)


@blanket.solution_picture
def _(split, action):
    """The openings of the two valves over the whole range of the control signal."""
    u = np.linspace(0, 100, 201)
    falling, rising = np.interp(u, [0, float(split)], [100, 0]), np.interp(u, [float(split), 100], [0, 100])
    vent, inlet = (falling, rising) if action == "reverse" else (rising, falling)
    return time_plot({"vent": vent, "inlet": inlet}, u, xlabel="$u$ [%]", ylabel="opening [%]", low=True)


# --- 11.3 ---------------------------------------------------------------------------------------------------------


ONE = [f"LC{n}" for n in (4, 1, 2, 3)]
TWO = [f"LC{n} and LC{m}" for n in range(1, 5) for m in range(n + 1, 5)]


def actions_in_row(place, closing):
    """The actions of the level controllers; the valves of some of them close as the signal rises."""
    actions = {f"LC{n}": "reverse" if n <= place else "direct" for n in range(1, 5)}
    return {name: OTHER[action] if name in closing else action for name, action in actions.items()}


@exercise(
    "11.3",
    title="Four tanks in a row",
    points=2,
    insight="Upstream of the flow controller levels are kept by what flows in, downstream by what flows out; the "
    "action follows from that and from the valve.",
)
def tanks_in_row(place=choice(2, 0, 1, 3, 4), closing=choice(*ONE, *TWO)):
    r"""In a dairy the milk passes four tanks, one after the other. Each has a level controller, LC1 to LC4, whose valve
    is in the pipe in front of the tank or in the one behind it. A flow controller {where} sets the production rate, so
    that this pipe has no valve of a level controller. Every valve opens as its control signal rises, with {exceptions}
    without signal and closed at 100 %.

    Which action does each level controller need, if no two controllers may share a pipe?
    """
    actions = actions_in_row(place, closing)
    return answers(
        **{name: word(action, ["reverse", "direct"], what=f"the action of {name}") for name, action in actions.items()}
    )


@tanks_in_row.shows
def _(place, closing):
    wheres = {0: "in front of tank 1", 4: "behind tank 4"}
    two = "and" in closing
    exceptions = "two exceptions: the valves of {} are open" if two else "one exception: the valve of {} is open"
    return {
        "where": wheres.get(place, f"between tank {place} and tank {place + 1}"),
        "exceptions": exceptions.format(closing),
    }


@tanks_in_row.mistake(
    "With a valve that opens as its signal rises this would be right, or with one in the other pipe of the tank. What "
    "does this valve do, and in which pipe is it?"
)
def _(place, closing):
    return {name: OTHER[action] for name, action in actions_in_row(place, closing).items() if name in closing}


@tanks_in_row.mistake(
    "One of the two pipes of this tank is taken by the flow controller. Which one is left, and what does more of its "
    "flow do to the level?"
)
def _(place, closing):
    actions = actions_in_row(place, closing)
    beside = {f"LC{place}", f"LC{place + 1}"} & actions.keys()
    return {name: OTHER[actions[name]] for name in sorted(beside) if name not in closing}


@tanks_in_row.mistake(
    "Look at where the flow is already decided: upstream of that point a level must be controlled by its inflow, "
    "downstream of it by its outflow. Direct action lets the signal rise with the level: what does this valve do then?"
)
def _(place, closing):
    return {name: OTHER[action] for name, action in actions_in_row(place, closing).items() if name not in closing}


tanks_in_row.hints(
    "The flow is decided in one pipe. Go outwards from there, tank by tank: which pipe is left for each level "
    "controller?",
    "Upstream of the flow controller the inflows are left, downstream the outflows. Does the level rise or fall when "
    "that flow grows? And does the flow grow when the signal rises?",
    "The flow controller is {where}. A level kept by its inflow, with a valve that opens with the signal, needs "
    "reverse action: too high a level must make the signal fall. Each change of one of these words turns the action "
    "round.",
)


@tanks_in_row.solution
def _(place, closing):
    r"""Five pipes, four level controllers and one flow controller: no pipe is left over. The flow controller is
    {where}. From there outwards each tank has only one pipe left: {sides}.

    With a valve that opens with the signal, a level kept by its inflow needs reverse action (too high a level must
    close the valve), and one kept by its outflow direct action. For {closing} it is the other way round, because the
    valve closes as the signal rises. So

    - LC1: {LC1},
    - LC2: {LC2},
    - LC3: {LC3},
    - LC4: {LC4}.
    """
    ways = [(range(1, place + 1), "the pipe in front"), (range(place + 1, 5), "the pipe behind")]
    sides = [f"{pipe} for {listed([f'tank {n}' for n in tanks])}" for tanks, pipe in ways if tanks]
    return {"sides": ", ".join(sides)}


@tanks_in_row.picture
def _(place):
    """The four tanks, and the flow controller in one of the five pipes."""
    tanks, pipes, above, far = ["milk"], ["milk"], ["."], ["."]
    for n in range(5):
        if n == place:
            tanks, above, far = [*tanks, "FT", "V"], [*above, "FC", "9"], [*far, ".", "."]
            pipes += ["FT", "V"]
        if n < 4:
            tanks, above, far = [*tanks, f"T{n + 1}"], [*above, f"LT{n + 1}"], [*far, f"LC{n + 1}"]
            pipes.append(f"T{n + 1}")
    rows = [[*far, "."], [*above, "."], [*tanks, "filling"]]
    layout = "\n".join(" ".join(row) for row in rows)
    parts = {f"T{n}": diagrams.vessel(str(n), filled=0.5) for n in range(1, 5)} | {"V": diagrams.control_valve()}
    signals = ", ".join(["FT FC 9 V", *(f"T{n} LT{n} LC{n}" for n in range(1, 5))])
    return diagrams.instrumentation_diagram(layout, " ".join([*pipes, "filling"]), signals, parts)


# --- 11.4 ---------------------------------------------------------------------------------------------------------


@exercise(
    "11.4",
    title="A drying oven in cascade",
    points=3,
    insight="What the secondary loop feels, it makes smaller and quicker by one factor, before the primary loop "
    "notices.",
)
def oven(
    K_1=between(0.5, 0.95, "K/K", reference=0.8, step=0.05),
    T_1=between(200, 600, "s", reference=400, step=20),
    K_2=between(0.5, 2.5, "K/%", reference=1.5),
    T_2=between(20, 60, "s", reference=40),
    K_p2=between(2, 6, "%/K", reference=2),
):
    """Painted parts dry in an oven with hot air. From the opening of the burner's valve to the temperature $y_2$ of the
    air the process is a lag with the gain {K_2} and the time constant {T_2}; from there to the temperature $y_1$ of the
    parts it is a lag with the gain {K_1} and the time constant {T_1}. When the fuel's pressure varies, this acts like
    an additional opening $d$ of the valve, in %. The secondary controller is a P controller with the gain {K_p2}; it
    measures $y_2$ without delay. The primary controller is in manual mode.

    Find the transfer function from $d$ to $y_1$, with the time in seconds. By which factor does the secondary loop
    reduce the final effect of a constant $d$ on $y_1$, and which time constant does that loop have?
    """
    loop = 1 + K_p2 * K_2
    return answers(
        H=transfer_function(K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + loop)), "the transfer function from d to $y_1$"),
        factor=number(loop, "", "the factor by which the effect is smaller"),
        T=number(T_2 / loop, "s", "the time constant of the secondary loop"),
    )


@oven.mistake("That is the process without the secondary loop. How does the air's temperature come back to the valve?")
def _(K_1, T_1, K_2, T_2):
    return {"H": K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1)), "T": T_2}


@oven.mistake("There the loop goes around both parts of the process. The secondary loop closes at $y_2$.")
def _(K_1, T_1, K_2, T_2, K_p2):
    both = K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1))
    loop, inner = 1 + K_p2 * K_1 * K_2, K_p2 * K_2
    wrong = {"factor": loop, "T": T_2 / loop} if _apart(loop, inner, 1 + inner, by=0.02) else {}
    return {"H": both / (1 + K_p2 * both)} | wrong


@oven.mistake("There $K_1$ is in the loop. Is the part from the air to the parts between the valve and $y_2$?")
def _(K_1, T_1, K_2, T_2, K_p2):
    return {"H": K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1 + K_p2 * K_1 * K_2))} if Rational(9, 10) > K_1 else {}


@oven.mistake("That is the way to the air, $y_2$. What comes between the air and the parts?")
def _(K_2, T_2, K_p2):
    return {"H": K_2 / (T_2 * s + 1 + K_p2 * K_2)}


@oven.mistake("The secondary loop closes at $y_2$. Which of the two time constants is in it?")
def _(K_2, T_1, T_2, K_p2):
    wrong = T_1 / (1 + K_p2 * K_2)
    return {"T": wrong} if _apart(wrong, T_2) else {}


@oven.mistake("That is the effect of 1 % itself. How many times smaller is it than without the loop?")
def _(K_1, K_2, K_p2):
    loop = 1 + K_p2 * K_2
    left = K_1 * K_2 / loop
    return {"factor": left} if _apart(left, loop, 1 - 1 / loop) else {}


@oven.mistake(
    "That is the response to the setpoint of the secondary loop. The disturbance does not pass the controller."
)
def _(K_1, T_1, K_2, T_2, K_p2):
    return {"H": K_p2 * K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1 + K_p2 * K_2))}


@oven.mistake("That is the fraction by which the effect falls. How many times smaller does it become?")
def _(K_2, K_p2):
    return {"factor": 1 - 1 / (1 + K_p2 * K_2)}


@oven.mistake(
    "The secondary loop makes its time constant shorter. Does it leave the effect of a constant disturbance as it was?"
)
def _(K_1, T_1, K_2, T_2, K_p2):
    return {"H": K_1 * K_2 / ((T_1 * s + 1) * (T_2 / (1 + K_p2 * K_2) * s + 1))}


@oven.mistake("That is the gain of the secondary loop alone. What else is in the denominator of a closed loop?")
def _(K_2, K_p2, T_2):
    return {"factor": K_p2 * K_2, "T": T_2 / (K_p2 * K_2)}


oven.hints(
    "The secondary controller sees the disturbance in $y_2$ and works against it. Which closed loop is that, and where "
    "does $d$ enter it?",
    "From $d$ to $y_2$: the forward path is $P_2 = \\frac{{K_2}}{T_2 s + 1}$, and the way back is $K_{p2}$ alone, so "
    "that the transfer function is $\\frac{{P_2}}{1 + K_{p2} P_2}$. Then comes the part from the air to the parts.",
    "Multiplied by the denominator, the loop is $\\frac{ {K_2} }{ {T_2} s + 1 + {K_p2} \\cdot {K_2} }$. Compare it "
    "with the process without the loop: what has become of its gain and of its time constant?",
)


@oven.solution
def _(K_2, K_p2):
    r"""From $d$ to $y_2$ the forward path is $P_2 = \frac{ {K_2} }{ {T_2} s + 1}$. The secondary controller measures
    $y_2$ and takes away $K_{p2}\,y_2$. So the loop makes of it

    $$\frac{{P_2}}{1 + K_{p2} P_2} = \frac{ {K_2} }{ {T_2} s + 1 + {K_p2} \cdot {K_2} }.$$

    The number $1 + {K_p2} \cdot {K_2}$ = {factor} divides both the gain and the time constant of that part: the effect
    is smaller by the factor {factor}, and the time constant of the loop is ${T_2}/{factor}$, which is {T}.

    Behind it comes the rest of the process, which the loop does not touch:

    $$H(s) = \frac{ {K_1} }{ {T_1} s + 1} \cdot \frac{ {K_2} }{ {T_2} s + {factor} }.$$
    """
    return {}


@oven.picture
def _(K_1, T_1, K_2, T_2, K_p2):
    """The block diagram: the secondary loop around the first part of the process, and then the second part."""
    layout = """
        .      .  .     .  d  .    .  .   .
        y_2SP  e  K_p2  u  j  P_2  1  P_1  y_1
        .      3  .     .  .  .    2  .   ."""
    blocks = {"K_p2": written(K_p2), "P_2": _lag(K_2, T_2), "P_1": _lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, "y_2SP e K_p2 u j P_2 1 P_1 y_1, d + j, 1 2 3 - e", blocks)


def _lag(K, T, delay=0):
    """A lag with dead time, as it is written in a block."""
    late = f"e^{{-{written(delay)}s}}" if delay else ""
    return rf"\frac{{{written(K)}\,{late}}}{{{written(T)}\,s+1}}"


@oven.solution_picture
def _(K_1, T_1, K_2, T_2, K_p2):
    """What a disturbance of 1 % does to the parts, with the secondary loop and without it."""
    times = np.linspace(0, 5 * float(T_1), 301)

    def effect(gain, short):
        long = float(T_1)
        slow, fast = np.exp(-times / long), np.exp(-times / float(short))
        return float(gain) * (1 - (long * slow - float(short) * fast) / (long - float(short)))

    loop = 1 + K_p2 * K_2
    curves = {"without": effect(K_1 * K_2, T_2), "with the secondary loop": effect(K_1 * K_2 / loop, T_2 / loop)}
    return time_plot(curves, times, ylabel="$y_1$ [K]", low=True)


# --- 11.5 ---------------------------------------------------------------------------------------------------------


@exercise(
    "11.5",
    title="A basin for rain",
    points=3,
    where=lambda F, k: 0.1 <= F / k <= 0.5,
    insight="A level under P control is a lag: a small gain makes it slow and calm, and the level gives way for it.",
)
def basin(
    A=between(4, 20, "m²", reference=10),
    F=between(5, 20, "kg/s", reference=8),
    k=between(20, 80, "kg/(s m)", reference=40),
):
    r"""A basin with vertical walls and an area of {A} buffers rain water, so that the sewage works downstream get a
    calmer flow. A P controller keeps the level, $u = u_0 + K_p (h_{SP} - h)$, where $u$ is the outflow in kg/s; the
    magnitude of $K_p$ is {k}, and its sign is the right one. The level is at its setpoint. Then it begins to rain, and
    from $t = 0$ on the inflow is larger by {F}. Water has a density of 1000 kg/m³.

    With which time constant does the level respond, how far above its setpoint does it settle, and what is its
    deviation $h - h_{SP}$ as a function of time?
    """
    T = 1000 * A / k
    return answers(
        T=number(T, "s", "the time constant of the level"),
        left=number(F / k, "m", "the deviation of the level in the end"),
        deviation=time_function(F / k * (1 - exp(-t / T)), 5 * T, "m", "the deviation for t in s"),
    )


@basin.mistake("There volumes and masses are mixed: all the flows are masses per second, and so is what $K_p$ moves.")
def _(A, F, k):
    return {"T": A / k, "left": F / (1000 * k), "deviation": F / k * (1 - exp(-t * k / A))}


@basin.mistake("That is the level without control, where the outflow stays as it was.")
def _(A, F):
    return {"deviation": F * t / (1000 * A)}


@basin.mistake("Only an integral term would bring the level back to its setpoint, and this controller has none.")
def _():
    return {"left": 0}


@basin.mistake("That is how the deviation would die away. It begins at zero and ends where the outflow is the inflow.")
def _(A, F, k):
    return {"deviation": F / k * exp(-t * k / (1000 * A))}


@basin.mistake("The rain does not make the level quick or slow. By how much does the outflow grow for each metre?")
def _(A, F):
    return {"T": 1000 * A / F}


@basin.mistake("That is how fast the level rises at first. Where does the outflow become as large as the inflow?")
def _(A, F, k):
    return {"left": F / (1000 * A)}


@basin.mistake("There the level is at its end at once. How does a lag begin, and what divides $t$ in its exponent?")
def _(A, F, k):
    return {"deviation": F / k * (1 - exp(-1000 * A / k * t))}


@basin.mistake("There the level is at its end at once. How does a lag begin, and what divides $t$ in its exponent?")
def _(F, k):
    return {"deviation": F / k}


basin.hints(
    "The mass in the basin changes by what flows in minus what flows out. Write that for the deviation of the level.",
    "With $x = h - h_{SP}$: $\\rho A\\,\\dot x = F - k x$, where $k$ is the magnitude of $K_p$. At rest $\\dot x = 0$.",
    "In numbers $1000 \\cdot {A}\\,\\dot x = {F} - {k}\\,x$. Divide by {k} and compare with $T \\dot x = x_{end} - x$.",
)


@basin.solution
def _():
    r"""The level must let more flow out when it is too high. With $x = h - h_{SP}$ the outflow has grown by $k x$, and
    the mass balance is $\rho A\,\dot x = F - k x$, in numbers $1000 \cdot {A}\,\dot x = {F} - {k}\,x$.

    Divided by $k$ it is that of a lag, $T \dot x = x_{end} - x$, with $T = 1000 \cdot {A}/{k}$, which is {T}, and
    $x_{end} = {F}/{k}$, which is {left}: there the outflow has become as large as the inflow.

    It begins at zero and approaches its end with that time constant: $x(t) = {left}\,(1 - e^{-t/{T} })$, in m.
    """
    return {}


@basin.picture
def _(A, F):
    """The flow diagram: the level controller acts on the valve in the outflow."""
    layout = """
        rain  1     .    h_SP  .
        .     tank  LT1  LC1   .
        .     tank  .    .     .
        .     2     .    V1    sewage"""
    parts = {"V1": diagrams.control_valve(), "tank": diagrams.tank(text=f"{A}$\\,$m²", level="h")}
    names = {"rain": f"rain,$\\,${F} kg/s more"}
    pipes, signals = "rain 1 tank 2 V1 sewage", "tank LT1 LC1 V1, h_SP LC1"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)


# --- 11.6 ---------------------------------------------------------------------------------------------------------


def two_P(K_1, T_1, K_2, T_2, L_1, L_2):
    """The gains of the cascade that has the lags L_1 and L_2."""
    inner = T_2 / L_1 + T_2 / L_2 - T_2 / T_1 - 1  # K_2 K_p2
    outer = (T_1 * T_2 / (L_1 * L_2) - 1 - inner) / inner  # K_1 K_p1
    return outer / K_1, inner / K_2


def _two_reasonable_gains(K_1, T_1, K_2, T_2, L_1, L_2):
    if L_2 >= L_1 or L_1 >= T_1 or L_2 >= T_2:
        return False
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return K_p2 * K_2 >= 0.5 and K_p1 * K_1 >= 0.4 and abs(K_p2 - 1) > 0.1


@exercise(
    "11.6",
    title="Two P controllers for two poles",
    points=4,
    where=_two_reasonable_gains,
    insight="Two measured states and two gains place two poles wherever you like; an offset remains all the same.",
)
def two_poles(
    K_1=between(0.5, 0.9, "K/K", reference=0.8, step=0.05),
    T_1=between(80, 200, "s", reference=120, step=10),
    K_2=between(0.5, 2, "K/%", reference=1.25, step=0.25),
    T_2=between(20, 50, "s", reference=30, step=5),
    L_1=between(20, 60, "s", reference=40, step=5),
    L_2=between(8, 20, "s", reference=10, step=1),
):
    r"""A heater warms air, and the air warms a drying drum. The temperature $y_2$ of the air follows the control signal
    with the gain {K_2} and the time constant {T_2}; the temperature $y_1$ of the drum follows the air with the gain
    {K_1} and the time constant {T_1}. There are no dead times. Both temperatures are measured, and two P controllers in
    cascade control the drum, $u = K_{p2}\,(K_{p1}(y_{SP} - y_1) - y_2)$, all counted from the operating point.

    Choose the two gains so that the closed loop has the time constants {L_1} and {L_2}, that is, poles at minus one
    over each. A P controller leaves an error: give, in the symbols `K_1`, `K_2`, `K_p1` and `K_p2`, what is left of a
    setpoint step of 1 K in the end. (All that you need is the denominator of a closed loop. Section 11.1.4, which is
    further reading, does the same with matrices.)
    """
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    left = (1 + k_2 * p_2) / (1 + k_2 * p_2 + k_1 * k_2 * p_1 * p_2)
    return answers(
        K_p2=number(K_p2, "%/K", "the gain of the secondary controller"),
        K_p1=number(K_p1, "K/K", "the gain of the primary controller"),
        left=expression(left, "the error that is left, in K_1, K_2, K_p1 and K_p2"),
    )


@two_poles.mistake(
    "That gives the secondary loop alone the shorter time constant. The primary loop then moves this pole."
)
def _(K_2, T_2, L_2):
    return {"K_p2": (T_2 / L_2 - 1) / K_2}


@two_poles.mistake(
    "That is the gain with which the state feedback acts on $y_1$. The signal of the primary controller passes "
    "the secondary one before it reaches the heater."
)
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p1": K_p1 * K_p2}


@two_poles.mistake(
    "That would be the gain of the other controller. Which of the two is alone in the coefficient of $s$?"
)
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    first = (T_2 / L_2 - 1) / K_2
    wrong = {"K_p1": K_p2} if _apart(K_p2, K_p1, K_p1 * K_p2, K_1 * K_p1, by=0.05) else {}
    return wrong | ({"K_p2": K_p1} if _apart(K_p1, K_p2, first, K_2 * K_p2, by=0.05) else {})


@two_poles.mistake(
    "Two polynomials are compared after they begin with the same term. Which factor has $s^2$ in each of yours?"
)
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    inner = (L_1 + L_2 - T_2) / T_1 - 1
    return {"K_p2": inner / K_2, "K_p1": -1 / K_1}


@two_poles.mistake("The drum has a pole of its own, even without a controller. Where is it in the coefficient of $s$?")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    wrong = (T_2 / L_1 + T_2 / L_2 - 1) / K_2
    others = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p2": wrong} if _apart(wrong, *others, (T_2 / L_2 - 1) / K_2, K_2 * others[1]) else {}


@two_poles.mistake("Where is $K_{p2}$ in the constant term? Beside the product of all gains it is there once more.")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    wrong = (T_1 * T_2 / (L_1 * L_2) - 1) / (K_2 * K_p2 * K_1)
    return {"K_p1": wrong} if _apart(wrong, K_p1, K_p2, K_p1 * K_p2, K_1 * K_p1, by=0.02) else {}


@two_poles.mistake("In $T_2 s + 1 + K_2K_{p2}$ there is a one beside the gains. What does it leave for them?")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    wrong = (T_2 / L_1 + T_2 / L_2 - T_2 / T_1) / K_2
    others = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p2": wrong} if _apart(wrong, *others, K_2 * others[1]) else {}


@two_poles.mistake("That may be its value here. Give an expression in the symbols.")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"left": float((1 + K_2 * K_p2) / (1 + K_2 * K_p2 + K_1 * K_2 * K_p1 * K_p2))}


@two_poles.mistake("That is the gain of a controller times that of its process. Give the controller's gain alone.")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p1": K_1 * K_p1} | ({"K_p2": K_2 * K_p2} if K_2 != 1 else {})


@two_poles.mistake("That is how far the drum comes. How much is missing in the end?")
def _():
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    return {"left": k_1 * k_2 * p_1 * p_2 / (1 + k_2 * p_2 + k_1 * k_2 * p_1 * p_2)}


@two_poles.mistake(
    "There the air would follow its setpoint without an error, but the secondary controller is a P, too."
)
def _():
    k_1, p_1 = symbols("K_1 K_p1", positive=True)
    return {"left": 1 / (1 + k_1 * p_1)}


@two_poles.mistake("There the air is not fed back. At rest the secondary loop gives less than its setpoint.")
def _():
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    return {"left": 1 / (1 + k_1 * k_2 * p_1 * p_2)}


two_poles.hints(
    "The poles are the roots of the closed loop's denominator. Which polynomial has the roots that are asked for?",
    "Work from the inside out. The denominator is $(T_1 s + 1)(T_2 s + 1 + K_2 K_{p2}) + K_1 K_2 K_{p1} K_{p2}$. It "
    "must be $(L_1 s + 1)(L_2 s + 1)$ except for a factor: divide both by the coefficient of $s^2$ and compare.",
    "The coefficients of $s$ say $\\frac{1 + K_2 K_{p2} }{ {T_2} } + \\frac{1}{ {T_1} } = \\frac{1}{ {L_1} } + "
    "\\frac{1}{ {L_2} }$, which has only $K_{p2}$ in it. The constant terms give $K_{p1}$.",
)


@two_poles.solution
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    r"""The secondary loop makes of the air $\frac{K_2 K_{p2} }{T_2 s + 1 + K_2 K_{p2} }$. Around it and the drum goes
    the primary loop; its denominator is $(T_1 s + 1)(T_2 s + 1 + K_2 K_{p2}) + K_1 K_2 K_{p1} K_{p2}$.

    Divide it by $T_1 T_2$, and $(L_1 s + 1)(L_2 s + 1)$ by $L_1 L_2$, so that both begin with $s^2$. The coefficients
    of $s$ are then equal if
    $\frac{1 + K_2 K_{p2} }{ {T_2} } + \frac{1}{ {T_1} } = \frac{1}{ {L_1} } + \frac{1}{ {L_2} }$. So $K_2 K_{p2}$ =
    {inner}, and $K_{p2}$ is {K_p2}.

    The constant terms: $1 + {inner} + K_1 K_{p1} \cdot {inner} = \frac{ {T_1} \cdot {T_2} }{ {L_1} \cdot {L_2} }$. So
    $K_1 K_{p1}$ = {outer}, and $K_{p1}$ is {K_p1}.

    **What is left.** At rest, $s = 0$, the drum comes up to the share
    $\frac{K_1 K_2 K_{p1} K_{p2} }{1 + K_2 K_{p2} + K_1 K_2 K_{p1} K_{p2} }$ of its setpoint. What is missing is
    $\frac{1 + K_2 K_{p2} }{1 + K_2 K_{p2} + K_1 K_2 K_{p1} K_{p2} }$, here {rest} K of 1 K.
    """
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    inner, outer = K_2 * K_p2, K_1 * K_p1
    return {"inner": inner, "outer": outer, "rest": (1 + inner) / (1 + inner + inner * outer)}


def _cascade(first, second, P_1, P_2):
    """A cascade in a block diagram, from its two controllers and the two parts of the process."""
    layout = """
        .     .  .    .      .  .    .  .    .  .    .  .
        y_SP  e  C_1  y_2SP  f  C_2  u  P_2  1  P_1  2  y_1
        .     .  .    .      4  .    .  .    3  .    .  .
        .     6  .    .      .  .    .  .    .  .    5  ."""
    wires = "y_SP e C_1 y_2SP f C_2 u P_2 1 P_1 2 y_1, 1 3 4 - f, 2 5 6 - e"
    return diagrams.grid_diagram(layout, wires, {"C_1": first, "C_2": second, "P_1": P_1, "P_2": P_2})


@two_poles.picture
def _(K_1, T_1, K_2, T_2):
    """The block diagram of the cascade: two P controllers, and the two parts of the process, both measured."""
    return _cascade("K_{p1}", "K_{p2}", _lag(K_1, T_1), _lag(K_2, T_2))


# --- 11.7 ---------------------------------------------------------------------------------------------------------


@exercise(
    "11.7",
    title="From the inside out",
    points=5,
    where=lambda T_1, T_2, delay: T_1 >= 2 * T_2 and abs(T_2 - delay) >= 0.5 * delay,
    insight="A cascade replaces the inner time constant by the one that was ordered; it pays where the inner one is "
    "longer than its dead time.",
)
def inside_out(
    K_1=between(0.4, 2, "K/K", reference=0.5),
    T_1=between(60, 200, "s", reference=120, step=10),
    K_2=between(0.5, 4, "K/%", reference=2),
    T_2=between(2, 36, "s", reference=30, step=2),
    delay=between(4, 16, "s", reference=6, step=1),
):
    r"""The temperature $y_1$ of a mould is controlled through the temperature $y_2$ of the oil that flows around it.
    From the valve to the oil the process has the gain {K_2}, the time constant {T_2} and a dead time of {delay}; from
    the oil to the mould it has the gain {K_1} and the time constant {T_1}.

    Tune both PI controllers of the cascade by Skogestad's rule with $c = 4$, each with $T_C$ equal to the dead time of
    its model. For the primary controller, take the secondary loop as it was ordered, the time constant $T_C$ behind the
    dead time, and use the half rule. For comparison: which dead time would the half rule give to the model for a single
    PI controller from $y_1$ to the valve? And in which of the two structures has the controller of $y_1$ the shorter
    dead time in its model?
    """
    inner, outer, alone = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    return answers(
        secondary=settings(inner, gain="%/K", time="s", what="the settings of the secondary controller"),
        primary=settings(outer, gain="K/K", time="s", what="the settings of the primary controller"),
        alone=number(alone, "s", "the dead time of the model for the single loop"),
        better=word(
            "cascade" if alone > 3 * delay / 2 else "single loop",
            ["cascade", "single loop"],
            what="the structure with the shorter dead time",
        ),
    )


def tuned_inside_out(K_1, T_1, K_2, T_2, delay):
    """The settings of the cascade, and the dead time of the model for a single loop."""
    inner = PID(T_2 / (2 * K_2 * delay), Min(T_2, 8 * delay))
    late = delay + delay / 2  # with half of the secondary loop's lag
    outer = PID((T_1 + delay / 2) / (2 * K_1 * late), Min(T_1 + delay / 2, 8 * late))
    return inner, outer, delay + min(T_1, T_2) / 2


@inside_out.mistake("Compare the two dead times that you have computed, each with its half of a time constant in it.")
def _(K_1, T_1, K_2, T_2, delay):
    alone = tuned_inside_out(K_1, T_1, K_2, T_2, delay)[2]
    return {"better": "single loop" if alone > 3 * delay / 2 else "cascade"}


@inside_out.mistake(
    "That takes the secondary loop for a dead time alone. It was specified with a time constant as well."
)
def _(K_1, T_1, delay):
    return {"primary": PID(T_1 / (2 * K_1 * delay), Min(T_1, 8 * delay))}


@inside_out.mistake(
    "In Skogestad's rule $c$ multiplies $T_C$ and the dead time, both. Which integral time does that allow?"
)
def _(K_1, T_1, K_2, T_2, delay):
    inner, outer, _ = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    short = {"secondary": (inner, 4 * delay), "primary": (outer, 6 * delay)}
    return {name: PID(pid.Kp, Ti) for name, (pid, Ti) in short.items() if Ti < pid.Ti}


@inside_out.mistake("The rule takes the smaller of two times for $T_i$. Which is the other one?")
def _(K_1, T_1, K_2, T_2, delay):
    inner, outer, _ = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    lags = {"secondary": (inner, T_2, 8 * delay), "primary": (outer, T_1 + delay / 2, 12 * delay)}
    return {
        name: PID(pid.Kp, max(T, most)) for name, (pid, T, most) in lags.items() if _apart(max(T, most), min(T, most))
    }


@inside_out.mistake(
    "There the half rule is used on the oil's own time constant. Which one does the closed secondary loop have?"
)
def _(K_1, T_1, K_2, T_2, delay):
    late = delay + T_2 / 2
    wrong = PID((T_1 + T_2 / 2) / (2 * K_1 * late), Min(T_1 + T_2 / 2, 8 * late))
    return {"primary": wrong} if K_2 != 1 else {}


@inside_out.mistake("The dead time has its half of the secondary loop's time constant. Who gets the other half?")
def _(K_1, T_1, delay):
    late = delay + delay / 2
    wrong = PID(T_1 / (2 * K_1 * late), Min(T_1, 8 * late))
    return {"primary": wrong} if delay / 2 > T_1 / 45 else {}


@inside_out.mistake("There all of the secondary loop's time constant has become dead time. How much of it should?")
def _(K_1, T_1, delay):
    return {"primary": PID(T_1 / (4 * K_1 * delay), Min(T_1, 16 * delay))}


@inside_out.mistake("The half rule neglects the smaller of the two time constants. Which one is that?")
def _(T_1, T_2, delay):
    return {"alone": delay + T_1 / 2} if T_1 != 2 * T_2 else {}


@inside_out.mistake(
    "That is the dead time in the model of the cascade. Which time constant does a single loop neglect?"
)
def _(T_2, delay):
    late = 3 * delay / 2
    return {"alone": late} if _apart(late, T_2 / 2, delay + T_2) else {}


@inside_out.mistake("What else is in the denominator of Skogestad's gain beside $T_C$?")
def _(K_1, T_1, K_2, T_2, delay):
    inner, outer, _ = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    return {"secondary": PID(2 * inner.Kp, inner.Ti), "primary": PID(2 * outer.Kp, outer.Ti)}


@inside_out.mistake("That is tuned for the whole process. The primary controller acts on the closed secondary loop.")
def _(K_1, T_1, K_2, T_2, delay):
    late = delay + T_2 / 2
    return {"primary": PID((T_1 + T_2 / 2) / (2 * K_1 * K_2 * late), Min(T_1 + T_2 / 2, 8 * late))}


@inside_out.mistake(
    "The half rule gives half of the neglected time constant to the one that stays. The dead time gets the other half."
)
def _(T_2, delay):
    return {"alone": delay + T_2}


@inside_out.mistake("That is only what comes from the neglected time constant. Which dead time was there before?")
def _(T_2, delay):
    return {"alone": T_2 / 2}


@inside_out.mistake(
    "A dead time and a lag differ: the half rule turns some of the smaller time constant into dead time."
)
def _(delay):
    return {"alone": delay}


inside_out.hints(
    "Tune the inner loop first: it is a lag with dead time, for which the rule holds as it is. What does the outer "
    "controller see of it afterwards?",
    "Rule: $K_p = \\frac{{T}}{K(T_C + \\theta)}$ and $T_i = \\min(T,\\ c\\,(T_C + \\theta))$, here with $T_C = "
    "\\theta$. The secondary loop, as ordered, is a lag with the time constant $\\theta$ behind the dead time "
    "$\\theta$. The half rule gives half of a neglected time constant to the dead time, half to the time constant "
    "that stays.",
    "Secondary: $K_p = \\frac{ {T_2} }{2 \\cdot {K_2} \\cdot {delay} }$. Primary: the secondary loop has a "
    "time constant of {delay}, of which half goes to the dead time of the model and half to $T_1$. The single loop "
    "must neglect $T_2$ = {T_2} instead.",
)


@inside_out.solution
def _(K_1, T_1, K_2, T_2, delay):
    r"""**The secondary controller** acts on a lag with dead time. With $T_C = \theta$ = {delay} the rule gives
    $K_p = \frac{ {T_2} }{ {K_2} \cdot 2 \cdot {delay} }$, which is {K_p2}, and the shorter one of {T_2} and
    $4 \cdot 2 \cdot {delay}$ for $T_i$, which is {T_i2}.

    **The primary controller** sees the secondary loop as it was ordered: a time constant of {delay} behind a dead time
    of {delay}. The half rule gives half of it to $T_1$ and half to the dead time: the model has the time constant
    ${T_1} + {delay}/2$, which is {long}, and the dead time ${delay} + {delay}/2$, which is {late}. With $T_C$ = {late}
    the rule gives $K_p = \frac{ {long} }{ {K_1} \cdot 2 \cdot {late} }$, which is {K_p1}, and $T_i$ = {T_i1}.

    **A single controller** has the whole process in front of it, and must neglect the smaller time constant, {T_2}.
    Half of it becomes dead time: ${delay} + {T_2}/2$, which is {alone}.

    That is {compared} than {late}. So the shorter dead time is that of the {better}.
    """
    inner, outer, alone = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    late, long = delay + delay / 2, T_1 + delay / 2
    return {
        "K_p2": (inner.Kp, "%/K"), "T_i2": (inner.Ti, "s"), "K_p1": (outer.Kp, "K/K"), "T_i1": (outer.Ti, "s"),
        "late": (late, "s"), "long": (long, "s"), "compared": "longer" if alone > late else "shorter",
    }  # fmt: skip


@inside_out.picture
def _(K_1, T_1, K_2, T_2, delay):
    """The block diagram of the cascade: two PI controllers, and the two parts of the process, both measured."""
    return _cascade("PI controller", "PI controller", _lag(K_1, T_1), _lag(K_2, T_2, delay))


# --- 11.8 ---------------------------------------------------------------------------------------------------------


def _unequal_halves(K_c, K_h, margin):
    large, small = max(K_c, K_h), min(K_c, K_h)
    return 1.5 * small <= large and margin * small >= 1.2 * large


@exercise(
    "11.8",
    title="Where to split",
    points=3,
    where=_unequal_halves,
    insight="The range belongs to the valves in proportion to their effect: then every percent of the signal does the "
    "same.",
)
def where_to_split(
    K_c=between(0.1, 0.8, "K/%", reference=0.6, step=0.05),
    K_h=between(0.1, 0.8, "K/%", reference=0.2, step=0.05),
    margin=between(3, 6, "", reference=4, step=0.5),
):
    """A fermenter is cooled or heated by one controller in split range: the valve of the chilled water closes from 100
    to 0 % over the lower half of the control signal, the valve of the steam opens over the upper half. For each percent
    by which they open, chilled water makes the fermenter {cold} colder in the end, and steam makes it {warm} warmer.
    Apart from the gains the dynamics are the same.

    Which static gain does the controller see in the lower half, which in the upper one? In which half must it be tuned?
    Suppose somebody tunes it in the other half, with a gain margin of {margin} there: which gain margin is left where
    the gain is larger? And at which control signal should the range be split instead, so that one tuning is right in
    both parts? (All that you need is the slope of a valve's characteristic. An example is in the further part of
    Section 11.3.)
    """
    large, small = max(K_c, K_h), min(K_c, K_h)
    return answers(
        lower=number(2 * K_c, "K/%", "the gain in the lower half"),
        upper=number(2 * K_h, "K/%", "the gain in the upper half"),
        tune=word("lower" if K_c > K_h else "upper", ["lower", "upper"], what="the half for the tuning"),
        left=number(margin * small / large, "", "the gain margin that is left"),
        split=number(100 * K_c / (K_c + K_h), "%", "the control signal at which to split"),
    )


@where_to_split.shows
def _(K_c, K_h):
    return {"cold": written(K_c, "K"), "warm": written(K_h, "K")}


@where_to_split.mistake(
    "That is the gain from the opening. How many percent does the valve move for one percent of the control signal?"
)
def _(K_c, K_h):
    return {"lower": K_c, "upper": K_h}


@where_to_split.mistake(
    "A valve travels its full range over half of the signal: is its characteristic then steeper or flatter?"
)
def _(K_c, K_h):
    return {"lower": K_c / 2, "upper": K_h / 2}


@where_to_split.mistake("In the other half the loop gain is then larger than the controller was made for.")
def _(K_c, K_h):
    return {"tune": "upper" if K_c > K_h else "lower"}


@where_to_split.mistake("There the valve with the larger effect has become the steeper one. It needs the wider part.")
def _(K_c, K_h):
    return {"split": 100 * K_h / (K_c + K_h)}


@where_to_split.mistake("That is one effect as a share of the other. Which share is it of both together?")
def _(K_c, K_h):
    wrong = 100 * min(K_c, K_h) / max(K_c, K_h)
    both = K_c + K_h
    return {"split": wrong} if _apart(wrong, 50, 100 * K_c / both, 100 * K_h / both) else {}


@where_to_split.mistake(
    "That margin holds in the half where it was tuned. How much larger is the gain in the other one?"
)
def _(margin):
    return {"left": margin}


@where_to_split.mistake("There the range is split already, and the two gains differ.")
def _():
    return {"split": 50}


@where_to_split.mistake(
    "The loop gain becomes larger as the fermenter comes into that half. Does the margin grow with it?"
)
def _(K_c, K_h, margin):
    return {"left": margin * max(K_c, K_h) / min(K_c, K_h)}


where_to_split.hints(
    "The controller sees the valve and the fermenter in series. What does one percent of its signal do to a valve that "
    "travels its full range over half of the signal?",
    "The slope of a valve is 100 % divided by the part of the range that it has. The gain of a half is this slope "
    "times the effect of a percent of opening. A gain margin shrinks as the loop gain grows.",
    "Lower half: $\\frac{100}{50}$ times {cold} for each percent. For equal gains, with the split at $p$: "
    "$\\frac{100}{p}$ times {cold} must be $\\frac{100}{100 - p}$ times {warm}.",
)


@where_to_split.solution
def _(K_c, K_h, margin):
    r"""A valve that travels 100 % over half of the signal moves by 2 % for each percent of it. So the controller sees
    $2 \cdot {K_c}$ in the lower half, which is {lower}, and $2 \cdot {K_h}$ in the upper one, which is {upper}.

    It must be tuned where the gain is larger, in the {tune} half. Tuned in the other one, with a gain margin of
    {margin} there, it finds in the {tune} half a gain that is {times} times as large, and the gain margin is
    ${margin}/{times}$, which is {left}.

    With the split at $p$ the slopes are $100/p$ and $100/(100 - p)$. The gains are equal if
    ${K_c}/p = {K_h}/(100 - p)$, that is, $p = 100 \cdot \frac{ {K_c} }{ {K_c} + {K_h} }$, which is {split}.
    """
    return {"times": max(K_c, K_h) / min(K_c, K_h)}


@where_to_split.picture
def _(K_c, K_h):
    """The characteristics of the valves: chilled water over the lower half of the signal, steam over the upper half."""
    u = np.linspace(0, 100, 101)
    cold, warm = (f"{written(K)} K for 1 %" for K in (-K_c, K_h))
    curves = {f"chilled water, {cold}": np.interp(u, [0, 50], [100, 0])}
    curves |= {f"steam, +{warm}": np.interp(u, [50, 100], [0, 100])}
    return time_plot(curves, u, xlabel="$u$ [%]", ylabel="opening [%]")


@where_to_split.solution_picture
def _(K_c, K_h):
    """What the signal does to the temperature at rest, split in the middle and split so that both gains are equal."""
    u = np.linspace(0, 100, 101)

    def effect(p):
        return -float(K_c) * np.interp(u, [0, p], [100, 0]) + float(K_h) * np.interp(u, [p, 100], [0, 100])

    curves = {"split in the middle": effect(50), "split for equal gains": effect(float(100 * K_c / (K_c + K_h)))}
    return time_plot(curves, u, xlabel="$u$ [%]", ylabel="effect [K]", low=True)


# --- 11.9 ---------------------------------------------------------------------------------------------------------

HIGHEST = math.sqrt(2) * math.exp(-math.pi / 4)  # of the level, with simc and c = 2, relative to F T_C/(rho A)


def shortest_T_C(period, gain):
    """The T_C with which a wave of a period passes with a flow gain, in %."""
    g = (float(gain) / 100) ** 2
    y = (1 + math.sqrt(1 + g * (1 - g))) / (2 * g)
    return math.sqrt(y) * float(period) / (2 * math.pi)


def longest_T_C(A, F, dh):
    return 1000 * float(A) * float(dh) / (HIGHEST * float(F))


def _some_room(A, F, dh, period, gain):
    return 1.2 < longest_T_C(A, F, dh) / shortest_T_C(period, gain) < 2.5


def buffer_loop(pid, A):
    """The coefficients a, b of s**2 + a s + b in the closed loop; None where that is not stable."""
    Kp, Ti = float(pid.Kp), float(pid.Ti)
    if Kp >= 0 or Ti <= 0:
        return None
    a = -Kp / (1000 * float(A))
    return a, a / Ti


def rise_of_level(pid, A, F):
    """The highest point of the level after a step F of the inflow, in m."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, split = float(F) / (1000 * float(A)), a * a / 4 - b
    if b == 0:
        return size / a
    if abs(split) < 1e-9 * a * a:
        return size * 2 / a * math.exp(-1)
    w = math.sqrt(abs(split))
    time = (math.atanh(2 * w / a) if split > 0 else math.atan2(2 * w, a)) / w
    return size * math.exp(-a * time / 2) * (math.sinh if split > 0 else math.sin)(w * time) / w


def flow_gain(pid, A, w):
    """How large a wave of the inflow comes out, in %."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    return 100 * math.sqrt((a * a * w * w + b * b) / ((b - w * w) ** 2 + a * a * w * w))


def largest_flow_gain(pid, A):
    """That of the worst wave, in %; a P controller makes none larger."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    if b == 0:
        return 100.0
    return flow_gain(pid, A, math.sqrt((math.sqrt(b**4 + 2 * a * a * b**3) - b * b) / (a * a)))


def level_after(pid, A, F, time):
    """The deviation of the level at a time after the step of the inflow, in m."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, w = float(F) / (1000 * float(A)), cmath.sqrt(a * a / 4 - b)
    if abs(w) < 1e-6 * a:
        return size * time * math.exp(-a * time / 2)
    modes = cmath.exp((w - a / 2) * time) - cmath.exp(-(w + a / 2) * time)
    return size * (modes / (2 * w)).real


def _buffered(pid, A, F, dh, period):
    """The level after the step of the inflow, and the wave of the inflow with what comes out of it."""
    times = np.linspace(0, max(12 * longest_T_C(A, F, dh), 3 * float(period)), 401)
    level = np.array([level_after(pid, A, F, time) for time in times])
    phase, size = 2 * np.pi * times / float(period), flow_gain(pid, A, 2 * math.pi / float(period))
    waves = {"wave in": 100 * np.sin(phase), "wave out, without its delay": size * np.sin(phase)}
    limits = [(-float(dh), 2 * float(dh)), (-120, 220)]
    panels = [{"level": (level, "measurement")}, waves]
    plot = time_plot(panels, times, ylabel=["rise of the level [m]", "wave [%]"], ylim=limits)
    return plot.level(dh, "highest allowed", "level")


@exercise(
    "11.9",
    title="A lazy tank",
    points=6,
    where=_some_room,
    insight="A buffer's level controller has two limits: too quick and the flow is not calmed, too slow and the level "
    "runs away; the design lies between them.",
)
def lazy_tank(
    A=between(1, 6, "m²", reference=2),
    F=between(3, 12, "kg/s", reference=6),
    dh=between(0.2, 0.6, "m", reference=0.4, step=0.05),
    period=between(100, 400, "s", reference=250, step=10),
    gain=between(30, 70, "%", reference=40, step=5),
):
    r"""Process water reaches a distillation column through a tank with vertical walls and an area of {A}. The pump
    upstream cycles: its flow has a wave with a period of {period}, of which at most {gain} may reach the column. Now
    and then another pump is started; then {F} more flow in and go on doing so, and the level must not rise by more than
    {dh}. Two hours later it must be back at its setpoint, to 1 cm. And no wave of any other period may leave the tank
    with more than 130 % of its size. The level controller acts on the outflow $u$ in kg/s, and the density is 1000
    kg/m³.

    First, for Skogestad's settings with $c = 2$: the longest time constant $T_C$ that the rise of the level allows.
    Then design a PI controller that meets all the demands, by whatever method; write its gain with the sign that
    belongs to $u = u_0 + K_p(e + \frac{1}{T_i} \int e\,dt)$ with $e = h_{SP} - h$.
    """
    w = 2 * math.pi / float(period)
    longest = longest_T_C(A, F, dh)
    T_C = math.sqrt(longest * shortest_T_C(period, gain))
    return answers(
        T_C=number(longest, "s", "the longest time constant that the level allows"),
        controller=design(
            settings(PID(-1000 * float(A) / T_C, 2 * T_C), gain="kg/(s m)", time="s", what="the settings"),
            criterion("there is no derivative term", lambda pid: pid.Td == 0),
            criterion(
                "the loop is stable",
                lambda pid: buffer_loop(pid, A) is not None,
                otherwise="the loop is not stable: must more or less flow out when the level is too high, and where "
                "is $e$ then?",
            ),
            criterion("the rise of the level", lambda pid: rise_of_level(pid, A, F), below=float(dh), unit="m"),
            criterion(
                "the flow gain at the wave's period", lambda pid: flow_gain(pid, A, w), below=float(gain), unit="%"
            ),
            criterion("the largest flow gain", lambda pid: largest_flow_gain(pid, A), below=130, unit="%"),
            criterion(
                "the deviation two hours later", lambda pid: abs(level_after(pid, A, F, 7200)), below=0.01, unit="m"
            ),
            draws=lambda pid: _buffered(pid, A, F, dh, period),
        ),
    )


@lazy_tank.mistake(
    "That is what a P controller alone would allow. The integral term keeps the excursion of the level smaller."
)
def _(A, F, dh, period, gain):
    T_C = 1000 * float(A) * float(dh) / float(F)
    return {"T_C": T_C} if abs(T_C / shortest_T_C(period, gain) - 1) > 0.03 else {}


@lazy_tank.mistake(
    "That is where the wave just passes with what is allowed. This demand sets the shortest $T_C$, not the longest."
)
def _(period, gain):
    return {"T_C": shortest_T_C(period, gain)}


@lazy_tank.mistake("That belongs to $c = 4$, where the poles meet. With $c = 2$ the level rises a little less.")
def _(A, F, dh, period, gain):
    T_C = 1000 * float(A) * float(dh) / float(F) * math.e / 2
    return {"T_C": T_C} if _apart(T_C, shortest_T_C(period, gain)) else {}


@lazy_tank.mistake("That is the integral time. Which part of it is $T_C$ with $c = 2$?")
def _(A, F, dh):
    return {"T_C": 2 * longest_T_C(A, F, dh)}


@lazy_tank.mistake("The factor of the highest point divides what is allowed: a low factor allows a slower controller.")
def _(A, F, dh, period, gain):
    T_C = HIGHEST * 1000 * float(A) * float(dh) / float(F)
    return {"T_C": T_C} if _apart(T_C, shortest_T_C(period, gain)) else {}


@lazy_tank.mistake("The density is missing: the flows are masses per second.")
def _(A, F, dh):
    return {"T_C": longest_T_C(A, F, dh) / 1000}


lazy_tank.hints(
    "Two demands pull in opposite directions: the wave wants a slow controller, the level a quick one. Skogestad's "
    "rule has one number for that.",
    "An integrator $\\frac{K}{s}$ with $K = -\\frac{1}{\\rho A}$, and $c = 2$: $K_p = \\frac{1}{K T_C}$ and $T_i = 2 "
    "T_C$. The level rises highest by $\\sqrt{2}\\,e^{-\\pi/4} \\cdot \\frac{F T_C}{\\rho A}$ after a step $F$ of the "
    "inflow, which is 0.645 of $\\frac{F T_C}{\\rho A}$.",
    "$0.645 \\cdot \\frac{ {F}\\,T_C}{1000 \\cdot {A} }$ must be at most {dh}: that is the longest $T_C$. The wave "
    "sets the shortest one: with $y = 2\\pi T_C/{period}$ its flow gain is $\\sqrt{\\frac{1 + 4y^2}{(1 - 2y^2)^2 + "
    "4y^2} }$. Take one between the two.",
)


def _away(level):
    """A deviation of the level as one says it: what nobody can measure is less than a tenth of a millimetre."""
    size = abs(1000 * level)
    return "less than 0.1 mm" if size < 0.1 else (size, "mm")


@lazy_tank.solution
def _(A, F, dh, period, gain):
    r"""From the outflow to the level the tank is an integrator with the gain $-\frac{1}{\rho A}$. Skogestad's settings
    with $c = 2$ are $K_p = -\frac{\rho A}{{T_C}}$ and $T_i = 2 T_C$.

    **The level.** After a step $F$ of the inflow it rises highest by
    $\sqrt{2}\,e^{-\pi/4}\,\frac{F T_C}{\rho A} = {highest}\,\frac{F T_C}{\rho A}$. For at most {dh} the time constant
    may be $T_C = \frac{1000 \cdot {A} \cdot {dh} }{ {highest} \cdot {F} }$, which is {T_C}.

    **The wave.** With $w = \frac{2\pi}{ {period} }$ and $y = w T_C$ the flow gain is
    $\sqrt{\frac{1 + 4y^2}{(1 - 2y^2)^2 + 4y^2} }$. It falls to {gain} at $T_C$ = {shortest}; the controller must be at
    least that slow.

    **The choice.** Any $T_C$ between the two meets all demands, for example their geometric mean, {chosen}. Then
    $K_p = -\frac{1000 \cdot {A} }{ {chosen} }$, which is {K_p}, and $T_i$ is twice $T_C$, {T_i}. With it the level
    rises by {rise}, and two hours later it is {later} away from its setpoint. Of the wave {passes} reach the column;
    the largest wave that leaves is {largest} of what comes in, whatever $T_C$ is.
    """
    longest, shortest = longest_T_C(A, F, dh), shortest_T_C(period, gain)
    T_C = math.sqrt(longest * shortest)
    pid = PID(-1000 * float(A) / T_C, 2 * T_C)
    return {
        "highest": HIGHEST, "shortest": (shortest, "s"), "chosen": (T_C, "s"), "K_p": (float(pid.Kp), "kg/(s m)"),
        "T_i": (2 * T_C, "s"), "rise": (rise_of_level(pid, A, F), "m"), "largest": (largest_flow_gain(pid, A), "%"),
        "passes": (flow_gain(pid, A, 2 * math.pi / float(period)), "%"),
        "later": _away(level_after(pid, A, F, 7200)),
    }  # fmt: skip


# --- 11.10 --------------------------------------------------------------------------------------------------------


def integral_state_feedback(K_1, T_1, K_2, T_2, L):
    """The gains k_1, k_2 and k_i that place three poles at -1/L."""
    inner = 3 * T_2 / L - T_2 / T_1 - 1  # K_2 k_2
    outer = 3 * T_1 * T_2 / L**2 - 1 - inner  # K_1 K_2 k_1
    return outer / (K_1 * K_2), inner / K_2, T_1 * T_2 / (L**3 * K_1 * K_2)


def _reasonable_feedback(K_1, T_1, K_2, T_2, L):
    k_1, k_2, _ = integral_state_feedback(K_1, T_1, K_2, T_2, L)
    return K_1 * K_2 * k_1 >= 1 and K_2 * k_2 >= 0.5


@exercise(
    "11.10",
    title="State feedback with an integral term",
    points=4,
    where=_reasonable_feedback,
    insight="Three gains, of two states and of the integral, place three poles, and no error is left.",
)
def glue_kettle(
    K_1=between(0.5, 0.9, "K/K", reference=0.8, step=0.05),
    T_1=between(180, 400, "s", reference=300, step=20),
    K_2=between(0.5, 2, "K/%", reference=1.25, step=0.25),
    T_2=between(40, 90, "s", reference=60, step=5),
    L=between(30, 90, "s", reference=60, step=5),
):
    r"""Glue is warmed in a kettle by its jacket. The temperature $x_2$ of the jacket follows the steam valve with the
    gain {K_2} and the time constant {T_2}; the temperature $x_1$ of the glue follows the jacket with the gain {K_1} and
    the time constant {T_1}. Both are measured. The controller uses both, and the integral of the control error as well:

    $$u = k_i \int (y_{SP} - x_1)\,dt - k_1 x_1 - k_2 x_2,$$

    all counted from the operating point.

    Choose the three gains so that all three poles of the closed loop are at $-1/L$ with $L$ = {L}.
    """
    k_1, k_2, k_i = integral_state_feedback(K_1, T_1, K_2, T_2, L)
    return answers(
        k_1=number(k_1, "%/K", "the gain of the glue's temperature"),
        k_2=number(k_2, "%/K", "the gain of the jacket's temperature"),
        k_i=number(k_i, "%/(K s)", "the gain of the integral"),
    )


def _unlike(key, values):
    """Those of the values that differ from the key by more than its tolerance."""
    return {name: value for name, value in values.items() if _apart(value, key[name])}


def _glue_key(K_1, T_1, K_2, T_2, L):
    return dict(zip(("k_1", "k_2", "k_i"), integral_state_feedback(K_1, T_1, K_2, T_2, L), strict=True))


@glue_kettle.mistake("Those gains would place two poles without the integral. How many states has the loop with it?")
def _(K_1, T_1, K_2, T_2, L):
    inner = 2 * T_2 / L - T_2 / T_1 - 1
    outer = T_1 * T_2 / L**2 - 1 - inner
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), {"k_1": outer / (K_1 * K_2), "k_2": inner / K_2})


@glue_kettle.mistake("Jacket and kettle have poles without any controller, too. Where are they in the polynomial?")
def _(K_1, T_1, K_2, T_2, L):
    wrong = {"k_1": 3 * T_1 * T_2 / L**2 / (K_1 * K_2), "k_2": 3 * T_2 / L / K_2}
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), wrong)


@glue_kettle.mistake(
    "That follows from a $k_2$ without the poles of jacket and kettle. Where are they in the polynomial?"
)
def _(K_1, T_1, K_2, T_2, L):
    wrong = {"k_1": (3 * T_1 * T_2 / L**2 - 1 - 3 * T_2 / L) / (K_1 * K_2)}
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), wrong)


@glue_kettle.mistake("That forgets that $k_2$ is in the coefficient of $s$ as well, beside $k_1$.")
def _(K_1, T_1, K_2, T_2, L):
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), {"k_1": (3 * T_1 * T_2 / L**2 - 1) / (K_1 * K_2)})


@glue_kettle.mistake(
    "Two polynomials are compared after they begin with the same term. Which factor has $s^3$ in yours?"
)
def _(K_1, T_1, K_2, T_2, L):
    inner = (3 * L**2 - T_2) / T_1 - 1
    wrong = {"k_1": (3 * L - 1 - inner) / (K_1 * K_2), "k_2": inner / K_2, "k_i": 1 / (K_1 * K_2)}
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), wrong)


@glue_kettle.mistake("Multiply the polynomial out again: beside $K_2k_2$ the coefficient of $s$ has a one.")
def _(K_1, T_1, K_2, T_2, L):
    _, k_2, _ = integral_state_feedback(K_1, T_1, K_2, T_2, L)
    wrong = {"k_1": (3 * T_1 * T_2 / L**2 - K_2 * k_2) / (K_1 * K_2), "k_2": (3 * T_2 / L - T_2 / T_1) / K_2}
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), wrong) if _apart(K_2 * k_2, 1, by=0.2) else {}


@glue_kettle.mistake("What is $(s + 1/L)^3$, multiplied out? Its middle terms have a factor.")
def _(K_1, T_1, K_2, T_2, L):
    inner = T_2 / L - T_2 / T_1 - 1
    outer = T_1 * T_2 / L**2 - 1 - inner
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), {"k_1": outer / (K_1 * K_2), "k_2": inner / K_2})


@glue_kettle.mistake("In the coefficient of $s^2$ there is a term of the process itself, which no gain moves.")
def _(K_1, T_1, K_2, T_2, L):
    inner = 3 * T_2 / L - 1
    outer = 3 * T_1 * T_2 / L**2 - 1 - inner
    return _unlike(_glue_key(K_1, T_1, K_2, T_2, L), {"k_1": outer / (K_1 * K_2), "k_2": inner / K_2})


@glue_kettle.mistake("The three roots multiply to $-1/L^3$. Which power of $L$ have you taken?")
def _(K_1, T_1, K_2, T_2, L):
    return {"k_i": T_1 * T_2 / (L**2 * K_1 * K_2)}


@glue_kettle.mistake("What the controller does reaches the glue through the valve and the jacket: through both gains.")
def _(K_1, T_1, K_2, T_2, L):
    k_1, _, k_i = integral_state_feedback(K_1, T_1, K_2, T_2, L)
    return {"k_1": k_1 * K_1, "k_i": k_i * K_1}


glue_kettle.hints(
    "Three states, the two temperatures and the integral, make a polynomial of the third degree. Which one has three "
    "roots at $-1/L$?",
    "Let the setpoint be zero. The jacket: $(T_2 s + 1)\\,x_2 = K_2 u$; the glue: $(T_1 s + 1)\\,x_1 = K_1 x_2$; the "
    "integral is $-x_1/s$. Eliminate $u$ and $x_2$: $s\\,(T_1 s + 1)(T_2 s + 1 + K_2 k_2) + K_1 K_2\\,(k_1 s + k_i) = "
    "0$.",
    "This must be $T_1 T_2\\,(s + 1/L)^3$. The coefficients of $s^2$ say "
    "${T_1}\\,(1 + K_2 k_2) + {T_2} = 3 \\cdot \\frac{ {T_1} \\cdot {T_2} }{ {L} }$.",
)


@glue_kettle.solution
def _(K_1, T_1, K_2, T_2, L):
    r"""With a setpoint of zero, the jacket is $(T_2 s + 1)\,x_2 = K_2 u$ and the glue $(T_1 s + 1)\,x_1 = K_1 x_2$. The
    controller is $u = -\frac{{k_i}}{s} x_1 - k_1 x_1 - k_2 x_2$. Put one into the other; then $x_1$ cancels, and what
    remains is

    $$s\,(T_1 s + 1)(T_2 s + 1 + K_2 k_2) + K_1 K_2\,(k_1 s + k_i) = 0.$$

    It begins with $T_1 T_2 s^3$. So it must be $T_1 T_2 (s + 1/L)^3 = T_1 T_2 (s^3 + 3s^2/L + 3s/L^2 + 1/L^3)$.
    Compare:

    - $s^2$: ${T_1}\,(1 + K_2 k_2) + {T_2} = 3 \cdot \frac{ {T_1} \cdot {T_2} }{ {L} }$, so $K_2 k_2$ = {inner}
      and $k_2$ is {k_2}.
    - $s$: $1 + {inner} + K_1 K_2 k_1 = 3 \cdot \frac{ {T_1} \cdot {T_2} }{ {L}^2}$, so $K_1 K_2 k_1$ = {outer}
      and $k_1$ is {k_1}.
    - Constant: $K_1 K_2 k_i = \frac{ {T_1} \cdot {T_2} }{ {L}^3}$, so $k_i$ is {k_i}.

    At rest the integral stands still only if $x_1 = y_{SP}$: a constant load leaves no error, whatever the gains are.
    """
    k_1, k_2, _ = integral_state_feedback(K_1, T_1, K_2, T_2, L)
    return {"inner": K_2 * k_2, "outer": K_1 * K_2 * k_1}


@glue_kettle.picture
def _(K_1, T_1, K_2, T_2):
    """The block diagram: the integral of the control error, minus both temperatures, each with its gain."""
    layout = """
        .     .  .         .    .  .    .       .  .     .  .
        y_SP  e  Integral  k_i  f  u    Jacket  1  Glue  2  x_1
        .     .  .         .    9  k_2  .       3  .     .  .
        .     .  .         .    7  k_1  .       .  .     4  .
        .     6  .         .    .  .    .       .  .     5  ."""
    wires = "y_SP e Integral k_i f u Jacket 1 Glue 2 x_1, 1 3 k_2 9 - f, 2 4 k_1 7 - f, 4 5 6 - e"
    blocks = {"Integral": r"\frac{1}{s}", "Jacket": _lag(K_2, T_2), "Glue": _lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, wires, blocks | {name: name for name in ("k_i", "k_1", "k_2")})


@glue_kettle.solution_picture
def _(K_1, T_1, K_2, T_2, L):
    """The glue after a setpoint step and, later, a load at the valve, with these gains."""
    k_1, k_2, k_i = map(float, integral_state_feedback(K_1, T_1, K_2, T_2, L))
    a, b, K_a, K_b = (float(x) for x in (T_1, T_2, K_1, K_2))
    A = np.array([[-1 / a, K_a / a, 0], [-K_b * k_1 / b, -(1 + K_b * k_2) / b, K_b * k_i / b], [-1, 0, 0]])
    from scipy.linalg import expm

    times = np.linspace(0, 30 * float(L), 301)
    advance, x = expm(A * times[1]), np.zeros((times.size, 3))
    for k in range(1, times.size):
        at_rest = -np.linalg.solve(A, [0, 10 * K_b / b * (times[k] > 15 * float(L)), 1])  # a load of 10 % of the valve
        x[k] = at_rest + advance @ (x[k - 1] - at_rest)
    curves = {"setpoint": (1, "setpoint"), "glue": (x[:, 0], "measurement")}
    return time_plot(curves, times, ylabel="$x_1$ [K]").event(15 * float(L), "load")


# --- 11.11 --------------------------------------------------------------------------------------------------------

VALVES = ["V1", "V2", "V3", "V4"]


def around_the_filter(place):
    """The valve of the flow controller, and those of the level controllers, with the filter in the pipe of a valve."""
    levels = {f"LC{n}": f"V{n}" if n < place else f"V{n + 1}" for n in range(1, 4)}
    return {"rate": f"V{place}"} | levels


@exercise(
    "11.11",
    title="Around the bottleneck",
    points=3,
    insight="The production rate is set at the bottleneck, and the level controllers work outwards from there: "
    "upstream with what flows in, downstream with what flows out.",
)
def bottleneck(
    place=choice(1, 2, 3, 4, reference=2),
    capacity=between(8, 40, "t/h", step=1, reference=20),
    margin=between(2, 8, "%", step=0.5, reference=4),
):
    r"""A pigment is made in three vessels, one after the other, with the valves V1 to V4 in the pipes as in the
    picture. One unit limits the whole plant, the filter in the pipe of {valve}, which can pass {capacity} at most. Each
    vessel has a level controller, LC1 to LC3, and one flow controller sets the production rate.

    Today the flow controller is at {today}. The level controllers pass all variations on to the filter, so that the
    average production must stay {margin} below what it can do. Where should the flow controller act, so that the filter
    always works at its limit? Which valve does each level controller move then, if no two controllers may move the same
    valve? And how many tonnes a day are gained?
    """
    return answers(
        **{name: word(valve, VALVES, _moves(name)) for name, valve in around_the_filter(place).items()},
        gained=number(24 * capacity * margin / 100, "t", "what is gained in a day"),
    )


def _moves(name):
    return "the valve of the flow controller" if name == "rate" else f"the valve of {name}"


@bottleneck.shows
def _(place):
    return {"valve": f"V{place}", "today": "V4, behind the last vessel" if place <= 2 else "V1, in the feed"}


def _relation(name, valve, place):
    """Why a valve is wrong for a controller."""
    if name == "rate":
        return "today" if valve == ("V4" if place <= 2 else "V1") else "elsewhere"
    if valve == f"V{place}":
        return "taken"
    return "side" if int(valve[1]) - int(name[2]) in (0, 1) else "away"


def _wrong(valve, why):
    """A mistake: this valve, for all controllers for which it is wrong for this reason."""

    def mistake(place):
        right = around_the_filter(place)
        return {name: valve for name in right if right[name] != valve and _relation(name, valve, place) == why}

    return mistake


_WHY = {
    "today": (
        "That is how it is today: the filter gets what the level controllers make of the flow. Who decides it there?"
    ),
    "elsewhere": (
        "Between this valve and the filter is a vessel. Does the filter's flow obey the valve, or that vessel's level "
        "controller?"
    ),
    "taken": "The flow controller moves that valve. Can two controllers move one valve?",
    "side": "That flow does change the level. But go outwards from the filter: which controller needs this valve?",
    "away": "Does that valve change what flows into this vessel or out of it?",
}
#: Valves that are never wrong for a reason: only the two at the ends are those of today, and those have one neighbour.
_NEVER = {("V2", "today"), ("V3", "today"), ("V1", "side"), ("V4", "side")}
for why, sentence in _WHY.items():
    for one in VALVES:
        if (one, why) not in _NEVER:
            bottleneck.mistake(sentence)(_wrong(one, why))


@bottleneck.mistake("That is gained in an hour. How many of them has a day?")
def _(capacity, margin):
    return {"gained": capacity * margin / 100}


@bottleneck.mistake("That is what is made in a day today. What would be made at the limit?")
def _(capacity, margin):
    return {"gained": 24 * capacity * (100 - margin) / 100}


@bottleneck.mistake("The distance is in percent of what the filter can do, not of what is made today.")
def _(capacity, margin):
    return {"gained": 24 * capacity * margin / (100 - margin)}


@bottleneck.mistake("That is all that the filter can pass in a day. How much of it is not made today?")
def _(capacity):
    return {"gained": 24 * capacity}


bottleneck.hints(
    "A flow can be kept exactly where it is controlled; everywhere else it is what the levels leave. Where must it be "
    "exact?",
    "The flow controller takes the valve at the filter. From there go outwards: each vessel has one of its two pipes "
    "nearer to the filter, and that one is decided already. Which one is left?",
    "The filter is at {valve}. What is gained is the distance to the limit: {margin} of {capacity}, hour by hour, a "
    "whole day long.",
)


@bottleneck.solution
def _(place):
    r"""Production is lost whenever the filter passes less than it can. So its own flow must be controlled: the flow
    controller takes the valve in the pipe of the filter, {rate}, and its setpoint is the limit.

    From there go outwards, vessel by vessel. {upstream}{downstream} So LC1 moves {LC1}, LC2 moves {LC2} and
    LC3 moves {LC3}. Each valve has one controller.

    What is gained is the distance that is no longer needed: ${capacity} \cdot {margin}/100$ in tonnes an hour, and in
    24 hours {gained}.
    """
    upstream = "Upstream of the filter the outflow of a vessel is decided, so its level needs the inflow. "
    downstream = "Downstream the inflow is decided, so the level needs the outflow."
    return {"upstream": upstream if place > 1 else "", "downstream": downstream if place < 4 else ""}


@bottleneck.picture
def _(place):
    """Three vessels in a row with the valves V1 to V4, and a filter in one pipe; no controller is joined yet."""
    row, above, far = ["feed"], ["."], ["."]
    for n in range(1, 5):
        pipe = ["Filter", f"V{n}"] if n == place else [f"V{n}"]
        row, above, far = row + pipe, above + ["."] * len(pipe), far + ["."] * len(pipe)
        if n < 4:
            row, above, far = [*row, f"T{n}"], [*above, f"LT{n}"], [*far, f"LC{n}"]
    row, above, far = [*row, "pigment"], [*above, "."], [*far, "."]
    layout = "\n".join(" ".join(line) for line in (far, above, row))
    parts = {f"T{n}": diagrams.vessel(str(n), filled=0.5) for n in range(1, 4)} | {"Filter": "Filter"}
    parts |= {valve: diagrams.control_valve(valve) for valve in VALVES}
    signals = ", ".join(f"T{n} LT{n} LC{n}" for n in range(1, 4))
    return diagrams.instrumentation_diagram(layout, " ".join(row), signals, parts)


# --- 11.12 --------------------------------------------------------------------------------------------------------


@exercise(
    "11.12",
    title="The gap in the middle",
    points=3,
    where=lambda u_c, gap, u: u_c + gap + 10 <= u and abs(u - 50) >= 5 and abs(2 * (u - 50) - u_c) >= 5,
    insight="A gap keeps heating and cooling from working against each other, and costs time: in it the loop is open "
    "until the integral term has crossed it.",
)
def gap_in_the_middle(
    u_c=between(25, 55, "%", step=5, reference=40),
    gap=choice(10, 15, 20, unit="%", reference=15),
    u=between(60, 95, "%", step=5, reference=80),
    K_p=between(2, 8, "%/K", step=0.5, reference=5),
    T_i=between(100, 600, "s", step=50, reference=300),
    e=choice(0.4, 0.5, 0.8, unit="K", reference=0.5),
):
    r"""A greenhouse for orchids has a valve for chilled water and one for hot water, both moved by one PI controller in
    split range. The picture shows the openings that were set up; between the two lines is a gap, in which both valves
    are closed. The settings are $K_p$ = {K_p} and $T_i$ = {T_i}.

    Read the picture: at which control signal does the chilled water close, how wide is the gap, and how far is the hot
    water open when the control signal is {u}? In the evening it is {e} too cold, and stays so. The signal rises, and
    just now the chilled water has closed. After how many seconds does the hot water begin to open?
    """
    return answers(
        closes=number(u_c, "%", "the control signal at which the chilled water closes", within=0.05),
        gap=number(gap, "%", "the width of the gap", within=0.15),
        hot=number(100 * (u - u_c - gap) / (100 - u_c - gap), "%", "the opening for hot water", within=0.06),
        time=number(gap * T_i / (K_p * e), "s", "the time until hot water flows", within=0.15),
    )


@gap_in_the_middle.shows
def _(u_c, gap):
    return {"opens": (u_c + gap, "%")}


@gap_in_the_middle.mistake("That is where the other valve begins to open. Which line is that of the chilled water?")
def _(u_c, gap):
    return {"closes": u_c + gap}


@gap_in_the_middle.mistake("That is where the gap ends. Where does it begin?")
def _(u_c, gap):
    return {"gap": u_c + gap}


@gap_in_the_middle.mistake("That would be so without the gap. Where does the hot water begin to open?")
def _(u_c, gap, u):
    right, wrong = 100 * (u - u_c - gap) / (100 - u_c - gap), 100 * (u - u_c) / (100 - u_c)
    return {"hot": wrong} if abs(wrong - right) > 0.1 * right else {}


@gap_in_the_middle.mistake(
    "That is how far the signal is beyond the point of opening. The valve opens by more than that."
)
def _(u_c, gap, u):
    return {"hot": u - u_c - gap}


@gap_in_the_middle.mistake("There the gain is missing: the integral term grows by $K_p e/T_i$ each second.")
def _(gap, T_i, K_p, e):
    return {"time": gap * T_i / e}


@gap_in_the_middle.mistake(
    "That is how long it takes for one $K_p e$ of signal, the integral time. How wide is the gap?"
)
def _(gap, T_i, K_p, e):
    return {"time": T_i} if abs(gap / (K_p * e) - 1) > 0.2 else {}


@gap_in_the_middle.mistake("The error of one kelvin is not the error here. How fast does the signal move with {e}?")
def _(gap, T_i, K_p, e):
    wrong = gap * T_i / K_p
    return {"time": wrong} if _apart(wrong, _after_a_jump(gap, T_i, K_p, e), by=0.2) else {}


def _after_a_jump(gap, T_i, K_p, e):
    """The time if the error began only when the signal is at the gap."""
    return (gap / (K_p * e) - 1) * T_i


@gap_in_the_middle.mistake(
    "There the proportional term moves the signal, too. But the error is the same before and after: what does that "
    "term do?"
)
def _(gap, T_i, K_p, e):
    wrong, right = _after_a_jump(gap, T_i, K_p, e), gap * T_i / (K_p * e)
    return {"time": wrong} if wrong > 0 and _apart(wrong, right, right * e, T_i, by=0.2) else {}


@gap_in_the_middle.mistake(
    "The integral term is all that moves the signal, because the error is the same before and after. How fast is that "
    "with {e}?"
)
def _(gap, T_i, K_p, e):
    jump, one = _after_a_jump(gap, T_i, K_p, e), gap * T_i / K_p
    both = {"time": (jump + one) / 2} if jump > 0 and not _apart(one, jump, by=0.2) else {}
    return both if _apart((jump + one) / 2, one / e, T_i, by=0.2) else {}


@gap_in_the_middle.mistake("There the signal begins at zero. Where is it when the chilled water has just closed?")
def _(u_c, gap, T_i, K_p, e):
    wrong = (u_c + gap) * T_i / (K_p * e)
    return {"time": wrong} if _apart(wrong, gap * T_i / e, by=0.2) else {}


@gap_in_the_middle.mistake("That is the control signal itself. The opening is read at the line of the hot water.")
def _(u_c, gap, u):
    return {"hot": u} if _apart(u, 100 * (u - u_c - gap) / (100 - u_c - gap), by=0.1) else {}


gap_in_the_middle.hints(
    "Each line of the picture belongs to one valve; both are straight. In the gap no valve moves: what moves the "
    "signal while the error stays the same?",
    "An opening on a straight line is a share of its way. The error $e$ is what it was before: the proportional term "
    "is constant, and the integral term moves the signal by $K_p\\,e/T_i$ each second.",
    "Here that is $\\frac{ {K_p} \\cdot {e} }{ {T_i} }$ percent each second. Divide the width of the gap by it.",
)


@gap_in_the_middle.solution
def _(K_p, T_i, e):
    r"""**The picture.** The line of the chilled water reaches zero at {closes}. That of the hot water begins at
    {opens}. So the gap is {gap} wide.

    The hot water opens by 100 % from there up to the end of the range. At {u} it has made the share
    $\frac{ {u} - {opens} }{100 - {opens} }$ of its way: {hot}.

    **The time.** The error is what it was before, so that only the integral term moves the signal, by
    $\frac{K_p\,e}{{T_i}} = \frac{ {K_p} \cdot {e} }{ {T_i} }$, which is {rate}. To cross {gap} it takes {time}. In all
    that time nothing warms the orchids.
    """
    return {"rate": (K_p * e / T_i, "%/s")}


@gap_in_the_middle.picture
def _(u_c, gap):
    """The openings of the two valves over the whole range of the control signal, with a gap between them."""
    signal = np.linspace(0, 100, 201)
    cold = np.interp(signal, [0, float(u_c)], [100, 0])
    hot = np.interp(signal, [float(u_c + gap), 100], [0, 100])
    curves = {"chilled water": cold, "hot water": hot}
    return time_plot(curves, signal, xlabel="control signal [%]", ylabel="opening [%]")
