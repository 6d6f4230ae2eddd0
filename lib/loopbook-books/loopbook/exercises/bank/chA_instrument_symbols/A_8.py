"""The diagrams of exercise A.8."""

import re

from loopbook import diagrams as draw
from loopbook.exercises import authoring
from loopbook.exercises.connections import connections
from loopbook.exercises.diagram_layout import drawn


def written(lines, **names):
    """The lines of a diagram with tags, without those that are empty."""
    return "\n".join(line.format(**names) for line in lines if line)


def loop_letters(diagram, number):
    """What the instruments of a loop do, by the letter behind the first one."""
    return sorted({tag[1] for tag in re.findall(rf"\b[A-Z]+(?={number}\b)", diagram)})


def picture(n):
    """A vessel with its inlet and its outlet: a temperature is measured in the vessel, its controller acts on a valve
    in the inlet by a pneumatic signal, and an indicator shows it."""
    layout = f"""
        .   1      TC{n}   .      .    .
        .   .      .       .      .    .
        .   .      TT{n}   .      .    TI{n}
        in  TV{n}  vessel  vessel out  ."""
    parts = {f"TV{n}": draw.control_valve(f"TV{n}"), "vessel": draw.vessel()}
    names = {"in": "inlet", "out": "outlet"}
    signals, air = f"vessel TT{n} TC{n}, TT{n} TI{n}", {"pneumatic": f"TC{n} 1 TV{n}"}
    return draw.instrumentation_diagram(layout, f"in TV{n} vessel out", signals, parts, names, lines=air)


def solution_picture(diagram):
    """The cascade: the transmitter and controller above the vessel, the flow loop at the {pipe}, and the alarm."""
    process = {"inlet": "pipe", "vessel": "vessel", "outlet": "pipe"}
    return drawn(connections(authoring.instrument_diagram(diagram, process).key), process)
