"""Python beside the page of exercise 12.2."""

from itertools import pairwise

from loopbook.diagrams import sequential_function_chart
from loopbook.exercises.bank.ch12_sequential_control.shared import listed
from loopbook.sequence import Chart

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


def left_on(steps, step, without_off=(), only_now=""):
    """What is on in a step with stored values; one may overlook each FALSE of some outputs, or an earlier TRUE."""
    on = {}
    for name, actions in steps.items():
        for output, value in actions.items():
            if output not in without_off if not value else output != only_now or name == step:
                on[output] = value
        if name == step:
            return [output for output in OUTPUTS if on.get(output)]


def set_by(steps, step, to=None):
    """What a step sets, to anything or to TRUE only."""
    return [output for output in OUTPUTS if output in steps[step] and to in (None, steps[step][output])]


def as_table(steps):
    """The steps with their actions."""
    rows = ["| step | actions |", "|---|---|"]
    for name, actions in steps.items():
        done = listed(f"`{output} := {str(value).upper()}`" for output, value in actions.items())
        rows.append(f"| `{name}` | {done or 'none'} |")
    return "\n".join(rows)


def row_by_row(steps, step):
    """What is on in each step until this one."""
    names = [*steps][: [*steps].index(step) + 1]
    return "\n".join(f"- in `{name}`: {listed(left_on(steps, name)) or 'nothing'}" for name in names)


def _chart(steps):
    ways = [(one, other, f"{one}.T >= 60") for one, other in pairwise(steps)]
    return Chart((), dict.fromkeys(OUTPUTS, False), steps, "Rinse", ways, final="Empty")


def run(steps, step):
    """What is on in a step when the chart runs."""
    running = _chart(steps)
    for time in range(0, 600, 60):
        on = running.update({}, time)
        if running.active == (step,):
            return [output for output in OUTPUTS if on[output]]


def picture(chart):
    """The chart: five steps from top to bottom, with the actions of the table."""
    return sequential_function_chart(_chart(chart))
