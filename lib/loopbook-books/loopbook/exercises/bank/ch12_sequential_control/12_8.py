"""Python beside the page of exercise 12.8."""

from types import SimpleNamespace

from loopbook.diagrams import sequential_function_chart
from loopbook.sequence import Chart

OUTPUTS = ["inlet", "heater", "stirrer", "drain", "lamp"]


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


def _chart(boxes, mix):
    ways = [
        ("Wait", ("Fill", "Warm"), "start"),
        ("Fill", "Hold", "full"),
        ("Warm", "Ready", "hot"),
        (("Hold", "Ready"), "Mix", "TRUE"),
        ("Mix", "Drain", f"Mix.T >= {mix}"),
        ("Drain", "Wait", "empty"),
    ]
    return Chart(("start", "full", "hot", "empty"), dict.fromkeys(OUTPUTS, False), boxes, "Wait", ways)


def run(boxes, mix, **moments):
    """What is active and on after each scan, with the moments from which on inputs are true."""
    chart, found = _chart(boxes, mix), []
    for time in range(60):
        on = chart.update({"empty": 0} | {name: int(bool(time >= at)) for name, at in moments.items()}, time)
        found.append(SimpleNamespace(active=list(chart.active), on=[output for output in OUTPUTS if on[output]]))
    return found


def picture(boxes, mix):
    """A chart. From Wait, if start, to Fill and Warm at the same time; from Fill to Hold if full; from Warm to Ready if
    hot; from Hold and Ready together to Mix, always; from Mix to Drain if Mix.T >= {mix}; from Drain to Wait if empty.
    The actions: Wait: drain := FALSE, lamp := FALSE; Fill: inlet := TRUE; Hold: inlet := FALSE; Warm: heater := TRUE;
    Mix: stirrer := TRUE; Drain: stirrer := FALSE, drain := TRUE; and {heater_off}: heater := FALSE; {lamp}: lamp :=
    TRUE.
    """
    return sequential_function_chart(_chart(boxes, mix))
