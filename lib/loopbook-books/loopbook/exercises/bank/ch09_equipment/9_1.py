"""Python beside the page of exercise 9.1."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(T_low, T_high, R, V):
    """From the temperature to the voltage: a thermometer of {T_low} to {T_high} sends 4 to 20 mA, and the current
    causes {V} across a resistor of {R}."""
    thermometer = draw.block(f"${written(T_low)}$ to ${written(T_high)}$ °C\n$4$ to $20$ mA")
    resistor = draw.block(f"Resistor\n${written(R)}$ Ω")
    return draw.block_diagram(r"$\vartheta$", thermometer, "I", resistor, f"${written(V)}$ V")
