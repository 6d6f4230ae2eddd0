"""Python beside the page of exercise 12.2."""

from itertools import pairwise

from loopbook.diagrams import sequential_function_chart
from loopbook.exercises.bank.ch12_sequential_control.shared import assigned, left_on, listed
from loopbook.sequence import Chart

OUTPUTS = ["pump", "heater", "dosing", "stirrer", "drain", "lamp"]


def actions_of(stop, lamp, stir):
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


def until(boxes, step, less=0):
    """The steps from the first one to this one, or so many less."""
    return [*boxes][: [*boxes].index(step) + 1 - int(less)]


def touched(boxes, step):
    """The outputs that a step sets, to whatever."""
    return [*boxes[step]]


def as_table(boxes):
    """The steps with their actions."""
    rows = [f"| `{step}` | {assigned(actions.items()) or 'none'} |" for step, actions in boxes.items()]
    return "\n".join(["| step | actions |", "|---|---|", *rows])


def row_by_row(boxes, seen):
    """What is on in each of some steps."""
    on = {step: left_on(OUTPUTS, boxes, seen[: n + 1]) for n, step in enumerate(seen)}
    return "\n".join(f"- in `{step}`: {listed(names) or 'nothing'}" for step, names in on.items())


def _chart(boxes):
    ways = [(one, other, f"{one}.T >= 60") for one, other in pairwise(boxes)]
    return Chart((), dict.fromkeys(OUTPUTS, False), boxes, "Rinse", ways, final="Empty")


def run(boxes, step):
    """What is on in a step when the chart runs."""
    running = _chart(boxes)
    for time in range(0, 600, 60):
        on = running.update({}, time)
        if running.active == (step,):
            return [output for output in OUTPUTS if on[output]]


def picture(boxes):
    """The chart: five steps from top to bottom, with the actions of the table."""
    return sequential_function_chart(_chart(boxes))
