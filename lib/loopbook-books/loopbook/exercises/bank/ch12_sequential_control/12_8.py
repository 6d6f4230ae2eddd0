"""Python beside the page of exercise 12.8."""

from types import SimpleNamespace

from loopbook.diagrams import sequential_function_chart
from loopbook.exercises.bank.ch12_sequential_control.shared import listed
from loopbook.sequence import Chart

MIXED = ["inlet", "heater", "stirrer", "drain", "lamp"]


def actions_of(heater_off, lamp):
    """The actions of each step; where the heater is switched off and the lamp on, varies."""
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
    return steps


def _done(boxes, seen):
    return [pair for step in seen for pair in boxes[step].items()]


def left_on(boxes, seen, also="", without=""):
    """What the actions of some steps leave on, and what one takes to be on as well or overlooks."""
    on = dict(_done(boxes, seen)) | {also: True, without: False}
    return [output for output in MIXED if on.get(output)]


def switched_on(boxes, seen):
    """What these steps switch on."""
    return [output for output in MIXED if (output, True) in _done(boxes, seen)]


def in_order(boxes, seen):
    """The actions of some steps, one after the other."""
    return listed(f"`{output} := {str(on).upper()}`" for output, on in _done(boxes, seen))


def in_code(steps):
    """Steps in a sentence."""
    return " and ".join(f"`{step}`" for step in steps)


def _chart(boxes, mix):
    ways = [
        ("Wait", ("Fill", "Warm"), "start"),
        ("Fill", "Hold", "full"),
        ("Warm", "Ready", "hot"),
        (("Hold", "Ready"), "Mix", "TRUE"),
        ("Mix", "Drain", f"Mix.T >= {mix}"),
        ("Drain", "Wait", "empty"),
    ]
    return Chart(("start", "full", "hot", "empty"), dict.fromkeys(MIXED, False), boxes, "Wait", ways)


def run(boxes, mix, start, full, hot):
    """What is active and on after each scan."""
    chart, found = _chart(boxes, mix), []
    for time in range(60):
        inputs = {"start": time >= start, "full": time >= full, "hot": time >= hot, "empty": False}
        on = chart.update({name: int(bool(value)) for name, value in inputs.items()}, time)
        found.append(SimpleNamespace(active=list(chart.active), on=[output for output in MIXED if on[output]]))
    return found


def picture(boxes, mix):
    """A chart. From Wait, if start, to Fill and Warm at the same time; from Fill to Hold if full; from Warm to Ready if
    hot; from Hold and Ready together to Mix, always; from Mix to Drain if Mix.T >= {mix}; from Drain to Wait if empty.
    The actions: Wait: drain := FALSE, lamp := FALSE; Fill: inlet := TRUE; Hold: inlet := FALSE; Warm: heater := TRUE;
    Mix: stirrer := TRUE; Drain: stirrer := FALSE, drain := TRUE; and {heater_off}: heater := FALSE; {lamp}: lamp :=
    TRUE.
    """
    return sequential_function_chart(_chart(boxes, mix))
