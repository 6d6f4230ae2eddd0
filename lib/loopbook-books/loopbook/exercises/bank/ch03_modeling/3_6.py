"""Python beside the page of exercise 3.6."""

from exercisebook.parameters import written
from loopbook import diagrams as draw

#: What lies above the output and what below, and whether the latter is a row.
PARTS = {
    "loaded": (["R_1"], ["C", "R_2"], False),
    "stepped": (["R_1"], ["R_2", "C"], True),
    "bridged": (["R_1", "C"], ["R_2"], False),
}


def picture(circuit, r_1, r_2, c):
    """The circuit. {looks}. The voltage v over the capacitor has its plus at the side towards the input."""
    title = f"$R_1$ = {written(r_1, 'kΩ')}, $R_2$ = {written(r_2, 'kΩ')}, $C$ = {written(c, 'µF')}"
    return draw.voltage_divider(*PARTS[circuit], title=title, voltages={"C": "v"})
