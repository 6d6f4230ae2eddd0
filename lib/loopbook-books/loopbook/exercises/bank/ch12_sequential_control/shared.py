"""What several exercises of chapter 12 need."""

from loopbook.exercises.kinds.sequential_chart import SequentialChart

#: Other names under which one knows the signals of the tank, as Figure 12.2 has them.
TANK_NAMES = {
    "start": ["button", "S"],
    "level": ["h", "LT1", "L"],
    "temperature": ["T", "TT1", "temp"],
    "inlet": ["V1", "u_valve_in", "inflow"],
    "outlet": ["V2", "u_valve_out", "drain", "discharge"],
    "heater": ["u_heat", "heating", "heating element"],
    "horn": ["alarm horn"],
}
#: When the button start of the tank is pressed.
PRESSED = "Wait.X AND Wait.T >= 20 AND Wait.T < 24"


def listed(names):
    """Names in a sentence."""
    return ", ".join(names)


def written(lines, **numbers):
    """The lines of a chart with numbers in the places of their names; an empty line is none."""
    return "\n".join(lines).format(**{name: f"{float(x):g}" for name, x in numbers.items()}).replace("\n\n", "\n")


def assigned(actions):
    """Actions in a sentence, from pairs of an output and its value."""
    return listed(f"`{output} := {str(value).upper()}`" for output, value in actions)


def executed(boxes, seen):
    """The actions of some steps, one after the other."""
    return [action for step in seen for action in boxes[step].items()]


def left_on(outputs, boxes, seen, also="", without=""):
    """The outputs that the actions of some steps leave on, with one more, or without one."""
    on = dict(executed(boxes, seen)) | {also: True, without: False}
    return [output for output in outputs if on.get(output)]


def switched_on(outputs, boxes, seen):
    """The outputs that some steps switch on, whatever switches them off."""
    return [output for output in outputs if (output, True) in executed(boxes, seen)]


def tank_chart(key, inputs, outputs, demands, scenarios):
    """A chart that does on the tank what is demanded."""
    also = {name: TANK_NAMES[name] for name in (*inputs, *outputs) if name in TANK_NAMES}
    return SequentialChart(key, inputs, outputs, demands, scenarios, what="the chart of the tank", also=also)
