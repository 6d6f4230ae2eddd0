"""Exercises of chapter 12, sequential control."""

import math
from itertools import pairwise

import numpy as np
from sympy import Rational, ceiling, floor, log, sqrt, symbols

from loopbook.diagrams import control_valve, instrumentation_diagram, sequential_function_chart, tank
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    sequential_chart,
    word,
    words,
)
from loopbook.figures import time_plot
from loopbook.sequence import Chart

# --- 12.1 ---------------------------------------------------------------------------------------------------------


@exercise(
    "12.1",
    title="Scan by scan",
    points=2,
    where=lambda m, q: 3 < m / q < 9 and 0.15 <= (m / q) % 1 <= 0.85,
    insight="A condition is not true when it becomes true, but when a scan finds it: every limit is overrun by "
    "up to one scan.",
)
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
def _(m, q):
    return {"full": f"`mass >= {float(m):g}`", "ratio": f"{float(m / q):.3g}"}


@bottles.mistake("The condition is tested in the scans only. Which scan is the first one that finds it true?")
def _(arrival, m, q):
    return {"Cap": arrival + m / q, "Away": arrival + m / q + 1}


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


@bottles.mistake("That is one scan too late. In which scan is the valve opened, and what does the next scan find?")
def _(arrival, m, q):
    return {"Cap": arrival + ceiling(m / q) + 1, "Away": arrival + ceiling(m / q) + 2}


@bottles.mistake("The flow of one scan is too much. Which step closes the valve, and does it wait with that?")
def _(m, q):
    return {"mass": (ceiling(m / q) + 1) * q}


@bottles.mistake("That has flowed in if the valve is open from the first scan on. Which step opens it, and when?")
def _(arrival, m, q):
    return {"mass": (arrival + ceiling(m / q)) * q}


@bottles.mistake(
    "That is the flow until `Away`, counted from the first scan. In which two scans is the valve switched?"
)
def _(arrival, m, q):
    return {"mass": (arrival + ceiling(m / q) + 1) * q}


@bottles.mistake("That is the limit in the condition. The valve stays open until a scan finds it reached.")
def _(m):
    return {"mass": m}


bottles.hints(
    "Nothing happens between two scans except in the plant. What does each scan look at, and what can it do?",
    "In the scan in which `Fill` becomes active the valve opens. Each later scan finds one second's flow more. `Cap` "
    "begins in the first scan that finds the limit reached. Even an unconditional transition waits for the next scan.",
    "The bottle is there before the scan at {arrival}. Then ${m}/{q} = {ratio}$ seconds of flow are needed: how many "
    "whole scans are that?",
)


@bottles.solution
def _(arrival, m, q):
    r"""The bottle comes just before the scan at {arrival}, and this scan finds `bottle` true: `Fill` becomes active at
    {Fill}, and the valve is open from then on.

    ***

    After $n$ more scans $n \cdot {q}$ kg have flowed in. The limit is {m} kg, and ${m}/{q} = {ratio}$ is not a whole
    number: the first scan that finds it reached is the one after {scans} seconds, at {Cap}. By then {mass} are in the
    bottle, a little more than the limit, because the valve stays open until a scan has seen it.

    The transition behind `Cap` is always true. But a step lasts for one scan at least, so that `Away` becomes active at
    {Away}.
    """
    return {"scans": str(ceiling(m / q)), "m": f"{float(m):g}"}


@bottles.picture
def _(m):
    """The chart: the steps Wait, Fill, Cap and Away in a circle, with their actions, as in the table."""
    return sequential_function_chart(bottle_chart(m))


def bottle_chart(m):
    """The chart of the machine."""
    steps = {
        "Wait": {"u_cap": False},
        "Fill": {"u_valve": True},
        "Cap": {"u_valve": False, "u_cap": True},
        "Away": {},
    }
    ways = [("Wait", "Fill", "bottle"), ("Fill", "Cap", f"mass >= {float(m):g}"), ("Cap", "Away", "TRUE")]
    ways.append(("Away", "Wait", "NOT bottle"))
    return Chart(("bottle", "mass"), {"u_valve": False, "u_cap": False}, steps, "Wait", ways)


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


@exercise(
    "12.2",
    title="What is on?",
    points=2,
    where=_two_answers,
    insight="What an output does in a step depends on all steps before it, unless the qualifier says that it "
    "ends with its step.",
)
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
    return {"table": "\n".join(rows), "first": " and ".join(stored(stop, lamp, stir, "Rinse"))}


@what_is_on.mistake("That is what this step itself switches on. What have earlier steps switched on, and nobody off?")
def _(stop, lamp, stir, step):
    return {"stored": while_active(stop, lamp, stir, step)}


@what_is_on.mistake(
    "That list is right for stored values. With N an action ends with its step: what does this one set to TRUE?"
)
def _(stop, lamp, stir, step):
    return {"default": stored(stop, lamp, stir, step)}


@what_is_on.mistake("Go through the table from the top and cross out what an action has set to FALSE on the way.")
def _(stop, lamp, stir, step):
    ever = {}
    for name, actions in boxes(stop, lamp, stir).items():
        ever |= {output: True for output, value in actions.items() if value}
        if name == step:
            break
    ever = [output for output in OUTPUTS if ever.get(output)]
    return {"stored": ever} if ever != stored(stop, lamp, stir, step) else {}


@what_is_on.mistake("That is the list as the step before has left it. What does this step itself change?")
def _(stop, lamp, stir, step):
    names = [*boxes(stop, lamp, stir)]
    earlier = stored(stop, lamp, stir, names[names.index(step) - 1])
    return {"stored": earlier} if earlier != stored(stop, lamp, stir, step) else {}


@what_is_on.mistake("An action of this step sets one of these to FALSE. Which of them are set to TRUE?")
def _(stop, lamp, stir, step):
    named = [output for output in OUTPUTS if output in boxes(stop, lamp, stir)[step]]
    return {"default": named} if named != while_active(stop, lamp, stir, step) else {}


def _kept_too_long(output):
    """The mistake of overlooking where this output is switched off."""

    def mistake(stop, lamp, stir, step):
        steps, right = boxes(stop, lamp, stir), stored(stop, lamp, stir, step)
        before = [*steps][: [*steps].index(step)]
        if output in right or not any(steps[name].get(output) for name in before):
            return {}
        return {"stored": [x for x in OUTPUTS if x in right or x == output]}

    return mistake


for _output in ("pump", "heater", "dosing", "stirrer", "drain"):
    what_is_on.mistake(f"`{_output}` was on, and an action has switched it off since. In which box is its FALSE?")(
        _kept_too_long(_output)
    )


def _forgotten(output):
    """The mistake of forgetting what an earlier step has switched on."""

    def mistake(stop, lamp, stir, step):
        right = stored(stop, lamp, stir, step)
        kept = output in right and output not in while_active(stop, lamp, stir, step)
        return {"stored": [x for x in right if x != output]} if kept else {}

    return mistake


for _output in ("pump", "heater", "stirrer", "lamp"):
    what_is_on.mistake("An earlier step has switched on one more output, and no FALSE has come since.")(
        _forgotten(_output)
    )


what_is_on.hints(
    "An action box lists changes. With stored values, who else decides about an output besides the active step?",
    "Stored: go down the table, keep a list of what is on, add at each TRUE, cross out at each FALSE, and stop at the "
    "step. With N: forget the list, and take the TRUE actions of the step alone.",
    "The first step leaves {first} on. Go on from there, step by step, to `{step}`.",
)


@what_is_on.solution
def _(stop, lamp, stir, step):
    """**Stored values.** Go down the table and keep a list of what is on:

    {steps_on}

    So while `{step}` is active, these are on: {kept}.

    **Qualifier N.** An output is on only as long as a step is active that sets it to TRUE. In `{step}` that leaves:
    {own}. Whatever an earlier step has switched on is off again.
    """
    rows = []
    for name in boxes(stop, lamp, stir):
        rows.append(f"- in `{name}`: {', '.join(stored(stop, lamp, stir, name)) or 'nothing'}")
        if name == step:
            break
    return {
        "steps_on": "\n".join(rows),
        "kept": ", ".join(stored(stop, lamp, stir, step)),
        "own": ", ".join(while_active(stop, lamp, stir, step)),
    }


@what_is_on.picture
def _(stop, lamp, stir):
    """The chart: five steps from top to bottom, with the actions of the table."""
    steps = boxes(stop, lamp, stir)
    ways = [(one, other, f"{one}.T >= 60") for one, other in pairwise(steps)]
    return sequential_function_chart(Chart((), dict.fromkeys(OUTPUTS, False), steps, "Rinse", ways, final="Empty"))


# --- 12.3 ---------------------------------------------------------------------------------------------------------

SIZES = ["Small", "Medium", "Large"]
#: The conditions of the branches by their order; 1 and 2 are the limits.
BRANCHES = {
    "Medium, Small, Large": ("< 2", "< 1", ""),
    "Small, Large, Medium": ("< 1", ">= 1", "< 2"),
    "Small, Medium, Large": ("< 1", "< 2", ""),
    "Large, Small, Medium": (">= 2", "< 2", ">= 1"),
    "Large, Medium, Small": (">= 2", ">= 1", ""),
    "Medium, Large, Small": (">= 1", ">= 2", ""),
}


def conditions(order, w_1, w_2):
    """The branches in their order, as pairs of step and lowest and highest mass (that excluded) of its condition."""
    found = []
    for size, condition in zip(order.split(", "), BRANCHES[order], strict=True):
        relation, _, which = condition.partition(" ")
        limit = {"1": w_1, "2": w_2}.get(which)
        low = limit if relation == ">=" else -math.inf
        found.append((size, low, limit if relation == "<" else math.inf))
    return found


def way_of(egg, order, w_1, w_2, pick=0):
    """The step to which an egg is sent: the first one whose condition is true."""
    return [size for size, low, high in conditions(order, w_1, w_2) if low <= egg < high][pick]


def by_name(egg, w_1, w_2):
    return SIZES[sum(bool(egg >= limit) for limit in (w_1, w_2))]


@exercise(
    "12.3",
    title="Which way, egg?",
    points=2,
    where=lambda w_1, w_2, a, b, c: (
        len({by_name(egg, w_1, w_2) for egg in (a, b, c)}) == 3 and not {a, b, c} & {w_1, w_2}
    ),
    insight="Alternative branches are asked from left to right, and the first one that is true wins: a wide "
    "condition belongs behind the narrow ones.",
)
def eggs(
    order=choice(*BRANCHES),
    w_1=between(51, 54, "g", reference=53, step=1),
    w_2=between(61, 64, "g", reference=63, step=1),
    a=between(46, 72, "g", reference=67, step=1),
    b=between(46, 72, "g", reference=48, step=1),
    c=between(46, 72, "g", reference=58, step=1),
):
    """Eggs are weighed and sorted. Three transitions leave the step `Weigh`, in this order:

    {branches}

    The chart is run by the rules of this chapter. To which steps do three eggs of {a}, {b} and {c} come? And which step
    does no egg reach, whatever its mass?
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
    listed = [(size, _condition(low, high)) for size, low, high in conditions(order, w_1, w_2)]
    lines = [f"{n}. to `{size}`: `{condition}`" for n, (size, condition) in enumerate(listed, start=1)]
    return {"branches": "\n".join(lines), "condition": listed[0][1]}


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


@eggs.mistake("That condition is false for this egg. Which ones are true for it, and which of these is the first?")
def _(order, w_1, w_2, a, b, c):
    wrong = {}
    for name, egg in dict(first=a, second=b, third=c).items():
        false = [size for size, low, high in conditions(order, w_1, w_2) if not low <= egg < high]
        wrong |= {name: false[0]} if false else {}
    return wrong


@eggs.mistake("That condition is true for this egg, but is it the first one? Begin at the top of the list.")
def _(order, w_1, w_2, a, b, c):
    wrong = {}
    for name, egg in dict(first=a, second=b, third=c).items():
        true = [size for size, low, high in conditions(order, w_1, w_2) if low <= egg < high]
        wrong |= {name: true[1]} if len(true) > 1 else {}
    return wrong


@eggs.mistake("Put the mass of this egg into that condition: is it true?")
def _(order, w_1, w_2, a, b, c):
    wrong = {}
    for name, egg in dict(first=a, second=b, third=c).items():
        false = [size for size, low, high in conditions(order, w_1, w_2) if not low <= egg < high]
        wrong |= {name: false[-1]} if len(false) > 1 else {}
    return wrong


@eggs.mistake("An egg does reach this step. For which masses is its condition the first one that is true?")
def _(order, w_1, w_2, a, b, c):
    reached = _key(order, w_1, w_2, a, b, c)
    return {"never": reached["second"]}


@eggs.mistake(
    "One of your three eggs comes to this step. Is there a step whose eggs have all left by a branch before it?"
)
def _(order, w_1, w_2, a, b, c):
    reached = _key(order, w_1, w_2, a, b, c)
    return {"never": reached["first"]} if reached["first"] != reached["second"] else {}


@eggs.mistake("The third of your eggs comes to this step. Go through the three steps in this way.")
def _(order, w_1, w_2, a, b, c):
    reached = _key(order, w_1, w_2, a, b, c)
    return {"never": reached["third"]} if reached["third"] not in (reached["first"], reached["second"]) else {}


eggs.hints(
    "Several transitions leave one step, and several of them may be true. Which one does a scan clear?",
    "For each egg go down the list and stop at the first condition that is true. A step is never reached if everything "
    "that satisfies its condition also satisfies one before it.",
    "For the egg of {a}: is `{condition}` true? If not, go on with the second condition.",
)


@eggs.solution
def _(order, w_1, w_2, a, b, c):
    """The first condition that is true decides, from the top of the list:

    {rows}

    {story}
    """
    rows = []
    for egg in (a, b, c):
        size = way_of(egg, order, w_1, w_2)
        asked = [name for name, *_ in conditions(order, w_1, w_2)]
        before = asked[: asked.index(size)]
        no = f"not {' and not '.join(f'`{name}`' for name in before)}, but " if before else "immediately "
        rows.append(f"- {egg} g: {no}`{size}`")
    (never,) = {*SIZES} - {way_of(egg, order, w_1, w_2) for egg in (a, b, c)} or {""}
    story = (
        f"No egg comes to `{never}`: whatever satisfies its condition has satisfied one before it. In a list of "
        "limits the narrow condition belongs before the wide one."
        if never
        else "Each step is reached, because the narrow conditions come before the wide ones. So the answer is none."
    )
    if any(way_of(egg, order, w_1, w_2) != by_name(egg, w_1, w_2) for egg in (a, b, c)):
        story = f"The names say otherwise for some eggs, but the chart does not know names. {story}"
    return {"rows": "\n".join(rows), "story": story}


@eggs.picture
def _(order, w_1, w_2):
    """The chart: from Weigh three branches lead to the sizes, from left to right in the order of the list."""
    ways = [("Weigh", size, _condition(low, high)) for size, low, high in conditions(order, w_1, w_2)]
    steps = {step: {} for step in ("Weigh", *order.split(", "))}
    return sequential_function_chart(Chart("mass", {}, steps, "Weigh", ways, final=SIZES))


def _condition(low, high):
    return f"mass < {high}" if high < math.inf else f"mass >= {low}" if low > -math.inf else "TRUE"


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


@exercise(
    "12.4",
    title="What is wrong with this chart?",
    points=3,
    insight="What can be wrong with a chart can be found before it runs: is each step reached, is it left, and "
    "do branches end as they began?",
)
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
    _, *others = ways[0][1] if not isinstance(ways[0][1], str) else [ways[0][1]]
    kind = (
        "Two simultaneous branches begin there: follow both to their end." if others else "Follow the chart from there."
    )
    return {
        "first": PLANTS[plant][0],
        "transitions": "\n".join(lines),
        "list": names,
        "way": f"`{lines[0]}`",
        "kind": kind,
    }


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


def _not_this_mistake(name):
    def mistake(mistake):
        return {} if mistake == name else {"mistake": name}

    return mistake


for _name, _question in {
    "dead end": "Is there a step that is in front of no transition? Go through the left sides.",
    "orphan": "Is there a step, other than the initial one, that is behind no transition? Go through the right sides.",
    "covered branch": "A branch is covered if the one before it, from the same step, is always taken. Is there one?",
    "waiting forever": "That needs a convergence of two steps that are alternatives. How do its branches begin?",
    "twice active": "That needs a branch that is left alone while the chart comes round again. Is there one?",
    "sound": "Follow each step: is it reached, is it left, and do branches end as they have begun?",
}.items():
    wrong_chart.mistake(_question)(_not_this_mistake(_name))


@wrong_chart.mistake("Then the chart would be sound. Is each step reached and left, and does no branch stay behind?")
def _(mistake):
    return {} if mistake == "sound" else {"step": "none"}


@wrong_chart.mistake(
    "The initial step is active from the beginning and is left by a transition. Which step has a problem?"
)
def _(plant, mistake, swapped):
    return {"step": steps_of(plant, swapped)[0]}


@wrong_chart.mistake(
    "Each description in the list says whether the step is in front of a transition or behind it. Does one of them fit "
    "this step?"
)
def _(plant, mistake, swapped):
    _, suffers = faulty_chart(mistake, *steps_of(plant, swapped))
    return {"step": next(step for step in steps_of(plant, swapped)[1:] if step != suffers)}


@wrong_chart.mistake("This step becomes active when its time has come. Look at the others.")
def _(plant, mistake, swapped):
    _, suffers = faulty_chart(mistake, *steps_of(plant, swapped))
    return {"step": [step for step in steps_of(plant, swapped)[1:] if step != suffers][-1]}


wrong_chart.hints(
    "A chart is sound if each step can be reached and left, and if branches end as they have begun. Draw it.",
    "Go through the left sides of the arrows (is each step there?), then the right sides (each but the initial one?), "
    "then the transitions that leave one step (which is asked first?), then those with two steps on one side.",
    "The first transition is {way}. {kind}",
)


@wrong_chart.solution
def _(plant, mistake, swapped):
    """Check the list in four steps: left sides, right sides, transitions that leave the same step, and how branches
    end.

    {story}

    So the mistake is: {mistake}. The step is: {suffers}.
    """
    A, B, C, D = steps_of(plant, swapped)
    _, suffers = faulty_chart(mistake, A, B, C, D)
    stories = {
        "dead end": f"{D} is reached after a fault, but is in front of no transition: the plant stays there.",
        "orphan": f"{D} is in front of a transition, but behind none, and not the initial step: it is never reached.",
        "covered branch": f"Two transitions leave {B}. The first one is always true, so that the second one, to {D}, "
        "is never cleared.",
        "waiting forever": f"{D} begins when {B} and {C} are both active. But they are alternatives: only one of them "
        "is active at a time, and the convergence waits forever.",
        "twice active": f"{B} and {C} begin together and should end together. After a fault {B} is left alone, {C} "
        f"stays active, and when the chart comes round, {C} is activated once more.",
        "sound": f"{B} and {C} begin together and end together in one transition, {D} follows them, and the chart "
        "comes back to its initial step. Nothing is wrong with it.",
    }
    return {"story": stories[mistake], "suffers": suffers}


# --- 12.5 ---------------------------------------------------------------------------------------------------------


@exercise(
    "12.5",
    title="Heat and dose",
    points=3,
    where=lambda T_0, T_SP, rate, n, dose: abs((T_SP - T_0) / rate - n * dose) >= 4 and (T_SP - T_0) / rate <= 60,
    insight="Simultaneous branches take as long as the longest of them, and a state is a set of steps.",
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
        "second": str(n + 1),
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


@heat_and_dose.mistake("That heats the water from 0 °C. How warm is it at the beginning?")
def _(T_0, T_SP, rate, n, dose, react):
    right, cold = max((T_SP - T_0) / rate, n * dose), max(T_SP / rate, n * dose)
    return {"begin": cold, "end": cold + react} if cold != right else {}


@heat_and_dose.mistake("A rise is divided by its rate: look at the units, kelvin and kelvin per minute.")
def _(T_0, T_SP, rate, n, dose, react):
    right, wrong = max((T_SP - T_0) / rate, n * dose), max((T_SP - T_0) * rate, n * dose)
    return {"begin": wrong, "end": wrong + react} if wrong != right else {}


@heat_and_dose.mistake("That is when `React` begins. How long does it last?")
def _(T_0, T_SP, rate, n, dose):
    return {"end": max((T_SP - T_0) / rate, n * dose)}


@heat_and_dose.mistake("That is the number of steps. A state is the set of all steps that are active together.")
def _(n):
    return {"states": n + 5} if n != 3 else {}


@heat_and_dose.mistake(
    "That is the number of steps, and also that of the combinations within the branches. Which states are outside them?"
)
def _(n):
    return {"states": 8} if n == 3 else {}


@heat_and_dose.mistake("One state is missing. When is a step active alone, before the branches and after them?")
def _(n):
    return {"states": 2 * n + 3} if n != 2 else {}


@heat_and_dose.mistake("`Hold` and `Ready` are steps, too: how many has each branch with them?")
def _(n):
    return {"states": n + 2}


@heat_and_dose.mistake(
    "That is how many occur in one run. The diagram has all combinations that can be active together, whatever "
    "the times."
)
def _(n):
    return {"states": n + 4} if n != 2 else {}


@heat_and_dose.mistake("Something is missing: the waiting steps count, and so do the steps outside the branches.")
def _(n):
    return {"states": 2 * (n + 1)} if n != 3 else {}


heat_and_dose.hints(
    "The two branches run at the same time, and one transition ends both. What does that transition wait for?",
    "Compute how long each branch takes on its own. `React` begins with the later one, and the waiting step of the "
    "other one has waited. For the states: which steps can be active together?",
    "Heating takes $({T_SP} - {T_0})/{rate}$ min, dosing ${n} \\cdot {dose}$ min. Each of the two steps of the first "
    "branch can be active together with each of the {second} steps of the second one.",
)


@heat_and_dose.solution
def _(T_0, T_SP, rate, n, dose, react):
    r"""**Each branch alone.** Heating takes $\frac{ {T_SP} - {T_0} }{ {rate} } = {heating}$ min, the powders
    ${n} \cdot {dose} = {dosing}$ min.

    **The convergence** waits until both are done: `React` begins at {begin}, and ends {react} later, at {end}. The
    branch that is ready first waits in its last step: {waited}.

    **States.** A state is the set of steps that are active together. In the branches, one of 2 steps (`Heat`, `Hold`)
    goes with one of {second} steps (the powders and `Ready`): ${count}$ states. With `Start` and `React` that makes
    {states}, whatever the times are.
    """
    return {"heating": (T_SP - T_0) / rate, "dosing": n * dose, "count": 2 * (n + 1)}


@heat_and_dose.solution_picture
def _(T_0, T_SP, rate, n, dose, react):
    """The chart, with its two simultaneous branches."""
    second = [f"Dose{k}" for k in range(1, int(n) + 1)] + ["Ready"]
    ways = [("Start", ("Heat", "Dose1"), "button"), ("Heat", "Hold", f"T >= {T_SP}")]
    ways += [(one, other, f"{one}.T >= {dose}") for one, other in pairwise(second)]
    ways += [(("Hold", "Ready"), "React", "TRUE"), ("React", "Start", f"React.T >= {react}")]
    steps = {step: {} for step in ("Start", "Heat", "Hold", *second, "React")}
    return sequential_function_chart(Chart(("button", "T"), {}, steps, "Start", ways))


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
    insight="A shift is planned with the times of the steps, and each time comes from the physics of its step.",
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


@shift.mistake("In a lag the distance to its end falls. How far from $T_{{end}}$ is the water at the beginning?")
def _(tau, T_0, T_SP, T_end):
    ratio = float((T_SP - T_0) / (T_end - T_SP))
    return {"Heat": float(tau) * math.log(ratio)} if ratio > 1 else {}


def _without(stage):
    """The mistake of leaving out this stage of the batch."""

    def mistake(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
        times = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
        return {"batch": sum(times) - times[stage]} if times[stage] > sum(times) / 50 else {}

    return mistake


for _stage in range(4):
    shift.mistake("One step is missing from that sum. Which of the four?")(_without(_stage))


@shift.mistake("Some of these times are in seconds, others in minutes: bring them to one unit before you add them.")
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    filling, heating, holding, emptying = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    return {"batch": 60 * (filling + emptying) + heating + holding}


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


shift.hints(
    "Each step of the chart has a physics of its own. Which of the four times are a volume over a flow, which a lag, "
    "which a fall whose rate falls with the level?",
    "Fill: the volume over the flow. Heat: the distance to the final temperature falls by $e^{-t/\\tau}$. Empty: the "
    "law $dt = -\\frac{A\\,dh}{K_v\\sqrt{h}}$, integrated from $h_1$ down to $h_0$; the integral of $1/\\sqrt{h}$ is "
    "$2\\sqrt{h}$.",
    "Heat: $\\tau\\ln\\frac{T_{end} - T_0}{T_{end} - T_{SP}}$ with the distances {from_start} K and {from_end} K. And "
    "a litre is a thousandth of a cubic metre.",
)


@shift.shows
def _(T_0, T_SP, T_end):
    return {"from_start": f"{float(T_end - T_0):g}", "from_end": f"{float(T_end - T_SP):g}"}


@shift.solution
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    r"""**Empty.** Torricelli's law gives each bit of the level its time, $dt = -\frac{A\,dh}{K_v\sqrt{h}}$. From $h_1$
    down to $h_0$ these add up to $\frac{2A}{{K_v}}\left(\sqrt{{h_1}} - \sqrt{{h_0}}\right)$. With $A = {A}$ m² and
    $K_v = {K_v}$ L/(s m$^{1/2}$), a thousandth of that in cubic metres, it takes {emptying}.

    **Heat.** The distance to $T_{end}$ falls by $e^{-t/\tau}$, from {from_start} K to {from_end} K:
    $\tau\ln\frac{ {from_start} }{ {from_end} } =$ {Heat}.

    **Fill** is a volume over a flow: $\frac{ {A} \cdot ({h_1} - {h_0}) }{ {q}/1000} = {seconds}$ s, which is {filling}.

    **A batch** takes the four times together, with {hold} for `Dye`: {batch}. Of these ${shifts}$ fit into eight hours,
    so that {batches} are finished, and the next one is still in the vat.
    """
    filling, _, _, emptying = times = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    return {
        "emptying": (emptying, "min"),
        "filling": (filling, "min"),
        "seconds": 60 * filling,
        "shifts": 480 / sum(times),
    }


@shift.solution_picture
def _(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold):
    """The level during one batch: it rises steadily, stays while heating and dyeing, and falls ever more slowly."""
    filling, heating, holding, emptying = stages(A, h_0, h_1, q, K_v, tau, T_0, T_SP, T_end, hold)
    low, high, begins = float(h_0), float(h_1), filling + heating + holding
    minutes = np.linspace(0, begins + emptying, 401)
    root = np.interp(minutes, [begins, begins + emptying], [math.sqrt(high), math.sqrt(low)])
    level = np.where(minutes < begins, np.interp(minutes, [0, filling], [low, high]), root**2)
    return time_plot({"level [m]": level}, minutes, xlabel="$t$ [min]", low=True)


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


@exercise(
    "12.7",
    title="A way out of filling",
    points=5,
    where=_room_for_limit,
    insight="A step that waits for a sensor needs a second way out, because sensors fail, and its limit lies "
    "between normal operation and the rim.",
)
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
                "the longest normal filling takes at most 90 % of the limit",
                lambda x: float(longest) <= 0.9 * x * (1 + 1e-3),  # a limit that is rounded is right, too
                otherwise="with the weakest supply a normal filling takes more than 90 % of that limit",
            ),
            criterion(
                "the highest level", lambda x: level_at_last(x, A, h_0, q_high, close), below=float(rim), unit="m"
            ),
            draws=lambda x: stuck_trends(x, A, h_0, h_1, rim, q_high, close),
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


@way_out.mistake("After that time the water is at the rim. At which level does filling end if all is well?")
def _(A, h_0, rim, q_low):
    return {"longest": slowest(A, h_0, rim, q_low)}


@way_out.mistake("That is with a supply in the middle. Which supply makes filling longest?")
def _(A, h_0, h_1, q_low, q_high):
    return {"longest": slowest(A, h_0, h_1, (q_low + q_high) / 2)}


@way_out.mistake("Until then there is room with the weakest supply. With which one does the water rise fastest?")
def _(A, h_0, q_low, close, rim):
    return {"limit": latest(A, h_0, q_low, close, rim)}


@way_out.mistake(
    "With that limit the water has reached the rim when the time is over, and the valve has not even begun to close."
)
def _(A, h_0, q_high, rim):
    return {"limit": 1000 * A * (rim - h_0) / q_high}


@way_out.mistake("With that limit a normal filling with the weakest supply would already raise the alarm.")
def _(A, h_0, h_1, q_low):
    return {"limit": slowest(A, h_0, h_1, q_low)}


@way_out.mistake(
    "The limit has to be longer than the longest filling: nine tenths of which of the two is the other one?"
)
def _(A, h_0, h_1, q_low):
    return {"limit": slowest(A, h_0, h_1, q_low) * Rational(9, 10)}


way_out.hints(
    "Two demands: the limit must be longer than any normal filling, and short enough that the water stays below the "
    "rim. Which supply decides about which of them?",
    "The weakest supply fills longest; the limit is at least that time over 0.9. With the strongest one water comes in "
    "during the limit, for one scan more, and while the valve closes, at half of the flow. All of it needs room.",
    "From below: $\\frac{1000 \\cdot {A}\\,({h_1} - {h_0})}{0.9 \\cdot {q_low}}$ s. From above: "
    "$\\frac{1000 \\cdot {A}\\,({rim} - {h_0})}{ {q_high} }$ s, minus the scan of 2 s and half of the closing time.",
)


@way_out.solution
def _(A, h_0, h_1, rim, q_low, q_high, close):
    r"""**The longest normal filling** is that with the weakest supply:
    $\frac{1000 \cdot {A}\,({h_1} - {h_0})}{ {q_low} } =$ {longest}. That may be 90 % of the limit at most, so the limit
    is at least {least}.

    **If the transmitter is stuck** the strongest supply is the worst case. Up to the rim there is room for
    $\frac{1000 \cdot {A}\,({rim} - {h_0})}{ {q_high} } = {room}$ s of its flow. One scan of 2 s may pass before the
    alarm, and while the valve closes, its flow falls steadily from all to nothing: as much water as in half of {close}.
    The limit is at most {most}.

    **Between the two** every limit is right, for example {chosen}, in the middle.
    """
    longest, most = slowest(A, h_0, h_1, q_low), latest(A, h_0, q_high, close, rim)
    return {
        "least": (longest / Rational(9, 10), "s"),
        "room": 1000 * A * (rim - h_0) / q_high,
        "most": (most, "s"),
        "chosen": (floor((longest / Rational(9, 10) + most) / 2), "s"),
    }


@way_out.picture
def _(h_1):
    """The chart: Fill is left at the full level to Heat, or after the limit to Alarm."""
    shut = {"u_valve": False}
    steps = {"Fill": {"u_valve": True}, "Heat": shut, "Alarm": shut}
    ways = [("Fill", "Heat", f"h > {float(h_1):g}"), ("Fill", "Alarm", "Fill.T > limit")]
    inputs = ("h", "limit")
    return sequential_function_chart(Chart(inputs, {"u_valve": False}, steps, "Fill", ways, final="Heat Alarm"))


def stuck_trends(limit, A, h_0, h_1, rim, q_high, close):
    """The level if nobody notices that the tank is full, with the rim and the level at which filling should end."""
    closes = float(limit) + SCAN
    times = np.linspace(0, closes + 1.5 * float(close), 301)
    closing = np.clip((times - closes) / float(close), 0, 1)
    inflow = np.minimum(times, closes) + float(close) * (closing - closing**2 / 2)
    level = float(h_0) + float(q_high) * inflow / (1000 * float(A))
    curves = {"level, transmitter stuck": (level, "measurement"), "full": (float(h_1), "setpoint")}
    return time_plot(curves, times, ylabel="level [m]", low=True).level(rim, "rim")


# --- 12.8 ---------------------------------------------------------------------------------------------------------

MIXED = ["inlet", "heater", "stirrer", "drain", "lamp"]


def mixing_chart(heater_off, lamp, mix):
    """Two simultaneous branches and what follows; where the heater is switched off and the lamp on, varies."""
    steps = {
        "Wait": {"drain": False, "lamp": False},
        "Fill": {"inlet": True},
        "Hold": {"inlet": False},
        "Warm": {"heater": True},
        "Ready": {},
        "Mix": {"stirrer": True},
        "Drain": {"stirrer": False, "drain": True},
    }
    steps[heater_off] |= {"heater": False}
    steps[lamp] |= {"lamp": True}
    ways = [
        ("Wait", ("Fill", "Warm"), "start"),
        ("Fill", "Hold", "full"),
        ("Warm", "Ready", "hot"),
        (("Hold", "Ready"), "Mix", "TRUE"),
        ("Mix", "Drain", f"Mix.T >= {mix}"),
        ("Drain", "Wait", "empty"),
    ]
    return Chart(("start", "full", "hot", "empty"), dict.fromkeys(MIXED, False), steps, "Wait", ways)


def _active(full, hot, look):
    return ["Hold" if look >= full else "Fill", "Ready" if look >= hot else "Warm"]


def mixing_outputs(heater_off, lamp, full, hot, look):
    """What is on at a moment at which one of the branches waits, with stored values."""
    steps, on = mixing_chart(heater_off, lamp, 5).steps, {}
    seen = ["Wait", "Fill", "Warm"]
    seen += ["Hold"] * bool(look >= full) + ["Ready"] * bool(look >= hot)
    for step in seen:
        on |= steps[step]
    return [output for output in MIXED if on.get(output)]


def _one_branch_waits(start, full, hot, look):
    return start + 2 <= min(full, hot) <= look - 1 and look <= max(full, hot) - 2 and full != hot


@exercise(
    "12.8",
    title="Read a chart",
    points=3,
    where=_one_branch_waits,
    insight="To read a chart at a moment, ask three things: which steps are active, what have their actions and all "
    "earlier ones left on, and which condition is being waited for.",
)
def reading(
    heater_off=choice("Mix", "Ready", "Drain"),
    lamp=choice("Warm", "Hold", "Ready", "Mix"),
    mix=between(5, 15, "s", step=1, reference=8),
    start=between(1, 4, "s", step=1, reference=2),
    full=between(6, 20, "s", step=1, reference=7),
    hot=between(6, 20, "s", step=1, reference=14),
    look=between(7, 18, "s", step=1, reference=10),
):
    """The chart of a mixing vessel is scanned once a second. Before the start all outputs are FALSE, and values are
    stored as in all charts of this chapter. Just before the scan at {start} somebody presses the button `start`. `full`
    is TRUE from the scan at {full} on, `hot` from the scan at {hot} on.

    Which steps are active at {look}, after the scan? Which outputs are TRUE then? Which condition must become true next
    so that the chart goes on? And when do `Mix` and `Drain` become active?
    """
    begin = max(full, hot) + 1
    return answers(
        active=words(_active(full, hot, look), STEPS, what="the active steps"),
        on=words(mixing_outputs(heater_off, lamp, full, hot, look), MIXED, what="the outputs that are TRUE"),
        waits_for=word("hot" if look >= full else "full", ["start", "full", "hot", "empty"], what="the next condition"),
        Mix=number(begin, "s", "the time at which Mix becomes active", within=0),
        Drain=number(begin + mix, "s", "the time at which Drain becomes active", within=0),
    )


STEPS = ["Wait", "Fill", "Hold", "Warm", "Ready", "Mix", "Drain"]


@reading.shows
def _(heater_off, lamp, mix):
    chart = mixing_chart(heater_off, lamp, mix)
    actions = {step: ", ".join(f"{x} := {str(on).upper()}" for x, on in do.items()) for step, do in chart.steps.items()}
    return {"actions": "; ".join(f"{step}: {does}" for step, does in actions.items() if does)}


@reading.mistake("A double line begins simultaneous branches: how many steps are active between the two double lines?")
def _(full, hot, look):
    return {"active": _active(full, hot, look)[1 if look >= full else 0 :][:1]}


@reading.mistake("One branch waits in that step. Where is the other one?")
def _(full, hot, look):
    return {"active": _active(full, hot, look)[0 if look >= full else 1 :][:1]}


@reading.mistake("A step that has been left is passive. Which of these has been left by now?")
def _(full, hot, look):
    return {"active": ["Fill", "Hold", "Warm"] if look >= full else ["Fill", "Warm", "Ready"]}


@reading.mistake("Both branches began with these steps. Which of their conditions has come true in the meantime?")
def _():
    return {"active": ["Fill", "Warm"]}


@reading.mistake("The convergence needs both steps in front of it. Has the other branch come to its end yet?")
def _():
    return {"active": ["Mix"]}


@reading.mistake("These steps would be active if both branches were done. Which condition is still false?")
def _():
    return {"active": ["Hold", "Ready"]}


@reading.mistake("That is what the active steps themselves switch on. What have earlier steps left on?")
def _(heater_off, lamp, full, hot, look):
    steps = mixing_chart(heater_off, lamp, 5).steps
    own = [x for x in MIXED if any(steps[step].get(x) for step in _active(full, hot, look))]
    return {"on": own} if own and own != mixing_outputs(heater_off, lamp, full, hot, look) else {}


@reading.mistake(
    "An action switches something off on the way. Which of the steps that were active has a FALSE in its box?"
)
def _(heater_off, lamp, full, hot, look):
    steps = mixing_chart(heater_off, lamp, 5).steps
    seen = ["Fill", "Warm", *_active(full, hot, look)]
    ever = [x for x in MIXED if any(steps[step].get(x) for step in seen)]
    return {"on": ever} if ever != mixing_outputs(heater_off, lamp, full, hot, look) else {}


def _on_too(output):
    """The mistake of taking this output for switched on, too."""

    def mistake(heater_off, lamp, full, hot, look):
        right = mixing_outputs(heater_off, lamp, full, hot, look)
        seen = _actions_so_far(heater_off, lamp, full, hot, look)
        off = output in right or any(x == output and on for x, on in seen)
        return {} if off else {"on": [x for x in MIXED if x in right or x == output]}

    return mistake


def _not_on(output):
    """The mistake of overlooking that this output is on."""

    def mistake(heater_off, lamp, full, hot, look):
        right = mixing_outputs(heater_off, lamp, full, hot, look)
        return {"on": [x for x in right if x != output]} if output in right and len(right) > 1 else {}

    return mistake


def _actions_so_far(heater_off, lamp, full, hot, look):
    """What the actions have set until this moment, one after the other."""
    steps = mixing_chart(heater_off, lamp, 5).steps
    seen = ["Wait", "Fill", "Warm"] + ["Hold"] * bool(look >= full) + ["Ready"] * bool(look >= hot)
    return [pair for step in seen for pair in steps[step].items()]


for _output in ("stirrer", "drain", "lamp"):
    reading.mistake(f"Which step switches on `{_output}`, and has it been active by then?")(_on_too(_output))
for _output in ("inlet", "heater", "lamp"):
    reading.mistake("One more output is on: look at all steps that have been active so far, in both branches.")(
        _not_on(_output)
    )


@reading.mistake("This condition is true already, and its step has been left. What is the other branch waiting for?")
def _(full, look):
    return {"waits_for": "full" if look >= full else "hot"}


@reading.mistake("The button has done its work: `Wait` is not active any more. What are the active steps waiting for?")
def _():
    return {"waits_for": "start"}


@reading.mistake(
    "That is the condition behind `Drain`, which is not active yet. What are the active steps waiting for?"
)
def _():
    return {"waits_for": "empty"}


@reading.mistake("In that scan the last waiting step has only become active. When is a transition behind it cleared?")
def _(full, hot):
    return {"Mix": max(full, hot)}


@reading.mistake("That counts from the last waiting step on. The time is that of `Mix`: when does this step begin?")
def _(full, hot, mix):
    return {"Drain": max(full, hot) + mix}


@reading.mistake("That is one scan too late. How long does the last waiting step last, if what follows is TRUE?")
def _(full, hot):
    return {"Mix": max(full, hot) + 2}


@reading.mistake("Then only one of the branches is done. What does the convergence need?")
def _(full, hot, mix):
    return {"Mix": min(full, hot) + 1, "Drain": min(full, hot) + 1 + mix}


@reading.mistake("That is one scan too late: in the scan in which its time is up, the step is left.")
def _(full, hot, mix):
    return {"Drain": max(full, hot) + mix + 2}


@reading.mistake("That is how long `Mix` lasts. When has it begun?")
def _(mix):
    return {"Drain": mix}


reading.hints(
    "Follow the chart from `Wait`, scan by scan. What does a double line mean, and when is what is below it cleared?",
    "After `start` one step of each branch is active at a time. An output is as the last action has left it, whichever "
    "branch that was in. The transition TRUE needs both steps before it, and these must have been active since the "
    "scan before.",
    "At {start} the steps `Fill` and `Warm` become active. `full` comes at {full}, `hot` at {hot}: and in between?",
)


@reading.solution
def _(heater_off, lamp, mix, start, full, hot, look):
    """**Active.** At {start} `Fill` and `Warm` become active, both at the same time. `Fill` is left at {full}, `Warm`
    at {hot}. At {look} one branch is done and waits: active are {steps}.

    **On.** These actions have been executed by then, in their order: {done}. They leave on: {left}.

    **Next.** The branch that is not done waits for `{waits_for}`. Without it nothing goes on.

    **Times.** At {last} the last of the two waiting steps becomes active. The transition between them and `Mix` is
    always true, but steps must have been active since the scan before: `Mix` becomes active one scan later, at {Mix}.
    Its time is up after {mix}, and `Drain` begins at {Drain}.
    """
    done = [f"`{x} := {str(on).upper()}`" for x, on in _actions_so_far(heater_off, lamp, full, hot, look)]
    return {
        "steps": " and ".join(f"`{step}`" for step in _active(full, hot, look)),
        "done": ", ".join(done),
        "left": ", ".join(mixing_outputs(heater_off, lamp, full, hot, look)) or "nothing",
        "last": (max(full, hot), "s"),
    }


@reading.picture
def _(heater_off, lamp, mix):
    """A chart. From Wait, if start, to Fill and Warm at the same time; from Fill to Hold if full; from Warm to Ready if
    hot; from Hold and Ready together to Mix, always; from Mix to Drain if Mix.T >= {mix}; from Drain to Wait if empty.
    The actions: {actions}.
    """
    return sequential_function_chart(mixing_chart(heater_off, lamp, mix))


# --- 12.9 ---------------------------------------------------------------------------------------------------------

TANK_INPUTS = {"start": "", "level": "m", "temperature": "°C"}
TANK_OUTPUTS = ["inlet", "heater", "outlet"]
#: Other names under which one knows the signals of the tank, as Figure 12.2 has them.
TANK_NAMES = {
    "start": ["button", "S"],
    "level": ["h", "LT1", "L"],
    "temperature": ["T", "TT1", "temp"],
    "inlet": ["V1", "u_valve_in", "inflow"],
    "outlet": ["V2", "u_valve_out", "drain", "discharge"],
    "heater": ["u_heat", "heating", "heating element"],
}


def chart_of_batch(full, T_SP, hold, low, **other):
    """The lines of a chart that does what 12.9 asks, in which single lines may be other ones."""
    lines = {
        "to_fill": "Wait -> Fill: start",
        "fill": "Fill: inlet on",
        "to_heat": f"Fill -> Heat: level >= {float(full):g}",
        "heat": "Heat: inlet off, heater on",
        "to_hold": f"Heat -> Hold: temperature >= {float(T_SP):g}",
        "soak": "Hold: heater off",
        "to_empty": f"Hold -> Empty: {float(hold):g} s",
        "empty": "Empty: outlet on",
        "to_wait": f"Empty -> Wait: level <= {float(low):g}",
        "wait": "Wait (initial): outlet off",
    }
    return "\n".join(line for line in (lines | other).values() if line)


def demands_on_batch(full, T_SP, hold, low):
    """What must not happen, the worst first."""
    full, T_SP, hold, low = (f"{float(x):g}" for x in (full, T_SP, hold, low))
    return [
        ("the tank runs over", "overflow > 0.1"),
        ("the heater is on while the level is still below 0.4 m", "heater AND level < 0.4"),
        ("inlet and outlet are open together", "inlet AND outlet"),
        (
            f"the inlet is closed, although start was pressed and the level has not reached {full} m",
            "NOT inlet",
            "Fill",
        ),
        ("the inlet opens, although nobody has pressed start", "inlet", "Wait"),
        (f"the inlet is still open, although the level has reached {full} m", "inlet", "Heat Hold Empty"),
        (f"the heater is on before the level has reached {full} m", "heater", "Fill"),
        (
            f"the heater stays off, although the tank is full and the water is colder than {T_SP} °C",
            "NOT heater",
            "Heat",
        ),
        (f"the heater is still on, although the water has reached {T_SP} °C", "heater", "Hold Empty"),
        ("the heater is on, although nobody has pressed start", "heater", "Wait"),
        (f"the outlet opens before the water has been held for {hold} s", "outlet", "Hold"),
        (f"the outlet opens before the water has reached {T_SP} °C", "outlet", "Fill Heat"),
        (f"the outlet stays closed, although the water has been held for {hold} s", "NOT outlet", "Empty"),
        (f"the outlet is open, although the level has fallen to {low} m", "outlet", "Wait"),
    ]


SCENARIOS_OF_BATCH = [
    ("", 2, {"start": "Wait.X AND Wait.T >= 20 AND Wait.T < 24"}),
    ("if the supply fails for a while", 1, {
        "start": "Wait.X AND Wait.T >= 20 AND Wait.T < 24",
        "no_supply": "Fill.X AND Fill.T >= 60 AND Fill.T < 1000",
    }),
    ("if somebody presses start during the batch", 1, {
        "start": "Wait.X AND Wait.T >= 20 AND Wait.T < 24 OR Fill.X AND Fill.T >= 60 AND Fill.T < 64 "
        "OR Heat.X AND Heat.T >= 60 AND Heat.T < 64 OR Empty.X AND Empty.T >= 30 AND Empty.T < 34",
    }),
]  # fmt: skip


def asked_chart(full, T_SP, hold, low):
    """What 12.9 asks."""
    return sequential_chart(
        chart_of_batch(full, T_SP, hold, low),
        TANK_INPUTS,
        TANK_OUTPUTS,
        demands_on_batch(full, T_SP, hold, low),
        SCENARIOS_OF_BATCH,
        what="the chart of the tank",
        also=TANK_NAMES,
    )


@exercise(
    "12.9",
    title="Write the chart, and watch it run",
    points=5,
    insight="A chart is right when it is right in every situation: a tank that fills slowly, a second batch, a button "
    "that is pressed at the wrong time. A run on a simulated plant finds in a second what paper hides.",
)
def written_chart(
    full=between(0.7, 1, "m", reference=0.9, step=0.05),
    T_SP=between(45, 75, "°C", reference=60, step=5),
    hold=between(60, 240, "s", reference=120, step=20),
    low=between(0.1, 0.2, "m", reference=0.12, step=0.02),
):
    """The tank of Figure 12.2 makes batches of hot water. It has a button `start`, which is 1 as long as it is pressed,
    a transmitter each of `level` and `temperature`, and an `inlet`, an `outlet` and a `heater` that are on or off.
    Write its chart:

    - At first everything is off, and the chart waits for the button.
    - The tank is filled until its level has reached {full}.
    - Then the water is heated until it has reached {T_SP}, and then held for {hold} with everything off.
    - Then the tank is emptied down to {low}, and the chart waits for the button again.

    The heater must never be on below 0.4 m, the tank must not run over, and inlet and outlet are never open together.
    A press of the button during a batch changes nothing. How long filling and heating take is not known: the supply may
    fail for a while.

    Write one line for each step, with what it switches, and one for each transition, with its condition. As in this
    chapter, an output keeps its value until another step changes it. A lamp that a button lights for a minute:

    ```
    Dark (initial): light off
    Dark -> Bright: button
    Bright: light on
    Bright -> Dark: Bright.T >= 60
    ```

    Your chart is run on the tank in several situations; whatever meets the demands is right. In a notebook, put the
    lines between three quotes, or in a list.
    """
    return answers(chart=asked_chart(full, T_SP, hold, low))


@written_chart.mistake(
    "The heater is on while there is hardly any water in the tank. Which step should switch it on, and when is that "
    "step reached?"
)
def _(full, T_SP, hold, low):
    lines = dict(fill="Fill: inlet on, heater on", heat="Heat: inlet off")
    return {"chart": chart_of_batch(full, T_SP, hold, low, **lines)}


@written_chart.mistake(
    "The heater comes on in the nearly empty tank, because filling is over before it has begun. Put the level of that "
    "moment into your condition: is it true?"
)
def _(full, T_SP, hold, low):
    return {"chart": chart_of_batch(full, T_SP, hold, low, to_heat=f"Fill -> Heat: level <= {float(full):g}")}


@written_chart.mistake(
    "The inlet stays open and the water rises and rises: filling waits for something that filling alone does not bring "
    "about. Which transmitter sees that the tank is full?"
)
def _(full, T_SP, hold, low):
    return {"chart": chart_of_batch(full, T_SP, hold, low, to_heat=f"Fill -> Heat: temperature >= {float(T_SP):g}")}


@written_chart.mistake(
    "The inlet stays open while the water is heated. Values are stored, so leaving a step closes nothing. Which step "
    "should close the valve?"
)
def _(full, T_SP, hold, low):
    return {
        "chart": chart_of_batch(
            full, T_SP, hold, low, heat="Heat: heater on", wait="Wait (initial): inlet off, outlet off"
        )
    }


@written_chart.mistake(
    "The clock ends filling, and no two batches begin with the same rest of water and the same supply. What do you "
    "want to know in the end: how long the inlet was open, or how full the tank is?"
)
def _(full, T_SP, hold, low):
    seconds = round(float(full - Rational(1, 10)) / 0.0048) + 4
    return {"chart": chart_of_batch(full, T_SP, hold, low, to_heat=f"Fill -> Heat: {seconds} s")}


@written_chart.mistake("The water is hot, and it runs away at once. What comes first, and what is on meanwhile?")
def _(full, T_SP, hold, low):
    lines = dict(
        to_hold=f"Heat -> Empty: temperature >= {float(T_SP):g}",
        soak="",
        to_empty="",
        empty="Empty: heater off, outlet on",
    )
    return {"chart": chart_of_batch(full, T_SP, hold, low, **lines)}


@written_chart.mistake(
    "The first batch is perfect, and then somebody presses start again and nothing happens. From where does the chart "
    "come back to its initial step?"
)
def _(full, T_SP, hold, low):
    lines = dict(to_wait=f"Empty -> End: level <= {float(low):g}", wait="Wait (initial): outlet off\nEnd: outlet off")
    return {"chart": chart_of_batch(full, T_SP, hold, low, **lines)}


@written_chart.mistake(
    "The second batch begins although nobody has pressed start. To which step does the last transition lead?"
)
def _(full, T_SP, hold, low):
    lines = dict(fill="Fill: inlet on, outlet off", to_wait=f"Empty -> Fill: level <= {float(low):g}")
    return {"chart": chart_of_batch(full, T_SP, hold, low, **lines)}


@written_chart.mistake(
    "The first batch is perfect, and then the outlet stays open. Which step would have to close it, as values are "
    "stored?"
)
def _(full, T_SP, hold, low):
    return {"chart": chart_of_batch(full, T_SP, hold, low, wait="Wait (initial): inlet off")}


written_chart.hints(
    "Begin with the situations that the plant goes through, one after the other: each is a step. What does the "
    "plant do in each of them, and what does it wait for?",
    "There are five: waiting, filling, heating, holding, emptying. For each step write what *changes* when it "
    "begins: what is switched on, and what the step before has left on. For each transition ask: which transmitter, "
    "or which time, sees that the step is done?",
    "The first lines are `Wait -> Fill: start`, then `Fill: inlet on`, then `Fill -> Heat: level >= ...` with the "
    "level in m. The time of a step is a condition, too: `Hold -> Empty: {hold}`. And the last transition leads "
    "back to `Wait`.",
)


@written_chart.solution
def _(full, T_SP, hold, low):
    """A chart is written down in three rounds.

    *The steps.* The plant goes through five situations: it waits, it is filled, it is heated, the hot water is held,
    and the tank is emptied. These are `Wait`, `Fill`, `Heat`, `Hold` and `Empty`.

    *The transitions.* What ends each of them? The button, the level {full}, the temperature {T_SP}, the time {hold},
    the level {low}. Only holding is ended by a clock. If filling were, too, a supply that fails for a while would leave
    the tank half full, with the heater on.

    ***

    *The actions.* Only changes are listed, so each step has to switch off what the one before it leaves on and it does
    not need: `Heat` closes the inlet, `Hold` switches off the heater, and `Wait` closes the outlet.

    ```
    {chart}
    ```

    Three things are easily forgotten: the way back to `Wait`, without which there is one batch only; the outlet, which
    would be open when the next one begins; and the button, which may be pressed at any time: `Heat` has no transition
    that looks at it, so nothing happens.
    """
    return {"chart": chart_of_batch(full, T_SP, hold, low)}


@written_chart.solution_picture
def _(full, T_SP, hold, low):
    """Two batches with this chart, and the chart itself: level, temperature, what is on, and the active step."""
    kind = asked_chart(full, T_SP, hold, low)
    return kind.drawn(kind.key)


@written_chart.picture
def _(full):
    """The tank with its transmitters of level and temperature, its inlet, outlet and heater, and your chart between
    them, which hears the button start; the level of the full tank, {full}, is marked."""
    layout = """
        .      5     .     .     .     .    3    .
        water  V1    1     .     .     .    .    .
        .      .     tank  tank  tank  LT1  seq  start
        .      .     tank  tank  tank  TT1  seq  .
        .      .     tank  tank  tank  4    seq  .
        .      .     tank  tank  tank  .    seq  .
        .      .     9     .     .     .    .    .
        out    V2    2     .     .     .    .    .
        .      8     .     .     .     .    7    ."""
    parts = {"V1": control_valve("inlet", "solenoid"), "V2": control_valve("outlet", "solenoid")}
    parts |= {"tank": tank(level=f"${float(full):g}$ m", heater=True), "seq": "Your\nchart"}
    lines = "LT1 seq, TT1 seq, start seq, seq 4 tank, seq 3 5 V1, seq 7 8 V2"
    measured = {"measuring line": "tank LT1, tank TT1"}
    return instrumentation_diagram(layout, "water V1 1 tank 9 2 V2 out", lines, parts, lines=measured)


# --- 12.10 --------------------------------------------------------------------------------------------------------


def chart_with_alarm(full, low, limit, **other):
    """The lines of a chart that does what 12.10 asks, in which single lines may be other ones."""
    lines = {
        "to_fill": "Wait -> Fill: start",
        "fill": "Fill: inlet on",
        "to_empty": f"Fill -> Empty: level >= {float(full):g}",
        "to_alarm": f"Fill -> Alarm: {float(limit):g} s",
        "empty": "Empty: inlet off, outlet on",
        "to_wait": f"Empty -> Wait: level <= {float(low):g}",
        "alarm": "Alarm: inlet off, horn on",
        "back": "Alarm -> Wait: reset",
        "wait": "Wait (initial): outlet off, horn off",
    }
    return "\n".join(line for line in (lines | other).values() if line)


def demands_on_alarm(full, limit):
    """What must not happen, the worst first."""
    full, limit = (f"{float(x):g}" for x in (full, limit))
    return [
        ("the tank runs over", "overflow > 0.1"),
        ("inlet and outlet are open together", "inlet AND outlet"),
        (f"the inlet is still open, although filling has taken {limit} s", "inlet", "Alarm"),
        (f"the horn is silent, although filling has taken {limit} s", "NOT horn", "Alarm"),
        ("the outlet is open, although filling has failed", "outlet", "Alarm"),
        (f"the horn sounds, although filling has not taken {limit} s", "horn", "Fill"),
        ("the horn sounds, although the tank was filled in time", "horn", "Empty"),
        ("the horn sounds, although nothing is wrong any more", "horn", "Wait"),
        (f"the inlet is closed, although start was pressed and the level is below {full} m", "NOT inlet", "Fill"),
        ("the inlet opens, although nobody has pressed start", "inlet", "Wait"),
        (f"the inlet is open, although the level has reached {full} m", "inlet", "Empty"),
        (f"the outlet is closed, although the level has reached {full} m", "NOT outlet", "Empty"),
        (f"the outlet opens before the level has reached {full} m", "outlet", "Fill"),
        ("the outlet is open, although nobody has pressed start", "outlet", "Wait"),
    ]


PRESSED = "Wait.X AND Wait.T >= 20 AND Wait.T < 24"
SCENARIOS_OF_ALARM = [
    ("", 2, {"start": PRESSED, "reset": "FALSE"}),
    ("if the level transmitter gets stuck", 2, {
        "start": PRESSED,
        "reset": "Alarm.X AND Alarm.T >= 60 AND Alarm.T < 64",
        "level_stuck": "Fill.X AND Fill.T >= 40 OR Alarm.X",
    }),
    ("if somebody presses reset while the tank is filled", 1, {
        "start": PRESSED,
        "reset": "Fill.X AND Fill.T >= 30 AND Fill.T < 34",
    }),
    ("if somebody presses a button at the wrong time", 1, {
        "start": f"{PRESSED} OR Empty.X AND Empty.T >= 20 AND Empty.T < 24",
        "reset": "Wait.X AND Wait.T >= 8 AND Wait.T < 12 OR Empty.X AND Empty.T >= 10 AND Empty.T < 14",
    }),
    ("if somebody presses start during the alarm", 1, {
        "start": f"{PRESSED} OR Alarm.X AND Alarm.T >= 30 AND Alarm.T < 34",
        "reset": "Alarm.X AND Alarm.T >= 60 AND Alarm.T < 64",
        "level_stuck": "Fill.X AND Fill.T >= 40 OR Alarm.X",
    }),
]  # fmt: skip


def asked_alarm(full, low, limit):
    """What 12.10 asks."""
    return sequential_chart(
        chart_with_alarm(full, low, limit),
        {"start": "", "reset": "", "level": "m"},
        ["inlet", "outlet", "horn"],
        demands_on_alarm(full, limit),
        SCENARIOS_OF_ALARM,
        what="the chart of the tank",
        also={**{name: TANK_NAMES[name] for name in ("start", "level", "inlet", "outlet")}, "horn": ["alarm horn"]},
    )


@exercise(
    "12.10",
    title="A chart that does not trust its transmitter",
    points=5,
    insight="Each step that waits for a measurement needs a second way out, since a measurement may never come. The "
    "way out is an alternative branch, and it must lead back, or the first fault is the last batch.",
)
def chart_of_alarm(
    full=between(0.6, 0.8, "m", reference=0.7, step=0.05),
    low=between(0.1, 0.2, "m", reference=0.12, step=0.02),
    limit=between(170, 200, "s", reference=180, step=5),
):
    """The tank of 12.9 is now used for cold water, with a `horn` and a second button, `reset`. Write the chart:

    - At first everything is closed and the horn is silent. The chart waits for `start`.
    - The tank is filled until its level has reached {full}, then emptied down to {low}, and the chart waits again.
    - Filling takes less than {limit}. If it has taken {limit}, something is wrong: the inlet is closed and the horn
      sounds, until somebody presses `reset`. Then the chart waits for `start` again.

    `reset` does nothing else, and `start` does nothing but begin. The tank must not run over, not even when the level
    transmitter gets stuck, and inlet and outlet are never open together.

    The notation is that of 12.9: a line for each step, `Fill: inlet on`, one for each transition,
    `Fill -> Empty: level >= ...`, and `Fill.T` is the time for which a step has been active.
    """
    return answers(chart=asked_alarm(full, low, limit))


@chart_of_alarm.mistake(
    "The transmitter is stuck, and filling goes on. Which transition would end it if the level is never seen to rise?"
)
def _(full, low, limit):
    return {"chart": chart_with_alarm(full, low, limit, to_alarm="", alarm="", back="")}


@chart_of_alarm.mistake("The horn sounds and water still comes in. What has to be switched in the step of the alarm?")
def _(full, low, limit):
    lines = dict(alarm="Alarm: horn on", wait="Wait (initial): inlet off, outlet off, horn off")
    return {"chart": chart_with_alarm(full, low, limit, **lines)}


@chart_of_alarm.mistake(
    "After `reset` the horn goes on. Values are stored: the step behind the alarm is the first that could silence it."
)
def _(full, low, limit):
    return {"chart": chart_with_alarm(full, low, limit, wait="Wait (initial): outlet off")}


@chart_of_alarm.mistake(
    "The horn has sounded, somebody has pressed `reset`, and nothing can be begun any more. Is there a way out of the "
    "alarm?"
)
def _(full, low, limit):
    return {"chart": chart_with_alarm(full, low, limit, back="")}


@chart_of_alarm.mistake(
    "After the alarm the tank is filled although nobody has pressed `start`. Where does the alarm lead to, and where "
    "should it?"
)
def _(full, low, limit):
    lines = dict(fill="Fill: inlet on, horn off", back="Alarm -> Fill: reset")
    return {"chart": chart_with_alarm(full, low, limit, **lines)}


@chart_of_alarm.mistake(
    "The alarm ends as soon as it has begun, or by another button. Who is to end it, and with what?"
)
def _(full, low, limit):
    return {"chart": chart_with_alarm(full, low, limit, back="Alarm -> Wait: start")}


@chart_of_alarm.mistake(
    "The horn sounds in every batch, as all batches are filled by the clock. What should end filling if all is well?"
)
def _(full, low, limit):
    return {"chart": chart_with_alarm(full, low, limit, to_empty="", empty="", to_wait="")}


chart_of_alarm.hints(
    "Write the chart without the alarm first: three steps in a circle. Then ask of each step that waits for the "
    "level what happens if the level is never reported.",
    "A step may be left by several transitions: these are alternative branches. `Fill` has two, one for the level "
    "and one for the time. Where does each of them lead, and what is on when it comes there?",
    "The second transition is `Fill -> Alarm: Fill.T >= ...` with the limit in s. The step `Alarm` has two actions, "
    "and one transition, on `reset`, which leads to `Wait`. Then go round once more: which step silences the horn?",
)


@chart_of_alarm.solution
def _(full, low, limit):
    """Without the alarm the chart is a circle of three steps: `Wait`, `Fill`, `Empty`. What ends them is the button,
    the level {full}, and the level {low}.

    `Fill` waits for a measurement. If the transmitter is stuck, the level never seems to reach {full}, and the tank
    runs over. The time needs no transmitter: after {limit} the second transition leaves the step.

    ***

    It leads to `Alarm`, which closes the inlet and sounds the horn, and `reset` leads from there to `Wait`. So `Wait`
    is reached in two ways, and silences the horn as it closes the outlet:

    ```
    {chart}
    ```

    After an alarm the tank may be full. The next `start` then finds the level reached in its first scan, and the tank
    is emptied: the chart needs nothing special for it.
    """
    return {"chart": chart_with_alarm(full, low, limit)}


@chart_of_alarm.solution_picture
def _(full, low, limit):
    """Two batches with this chart, and the chart itself, with the two branches that leave the step Fill."""
    kind = asked_alarm(full, low, limit)
    return kind.drawn(kind.key)
