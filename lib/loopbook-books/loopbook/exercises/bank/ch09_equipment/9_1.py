"""Python beside the page of exercise 9.1."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.figures import time_plot


def scaled(I, T_low, T_high):
    """The temperature for a current, on the straight line through the ends of both ranges."""
    return float(np.polyval(np.polyfit([4, 20], [float(T_low), float(T_high)], 1), float(I)))


def picture(T_low, T_high, R, V):
    """From the temperature to the voltage: a thermometer of {T_low} to {T_high} sends 4 to 20 mA, and the current makes
    {V} at a resistor of {R}."""
    thermometer = draw.block(f"${written(T_low)}$ to ${written(T_high)}$ °C\n$4$ to $20$ mA")
    resistor = draw.block(f"Resistor\n${written(R)}$ Ω")
    return draw.block_diagram(r"$\vartheta$", thermometer, "I", resistor, f"${written(V)}$ V")


def solution_picture(T_low, T_high, R, V):
    """The scaling from the current to the temperature, with the kiln and the broken cable."""
    slope, current = (T_high - T_low) / 16, 1000 * V / R
    I = np.linspace(0, 20, 81)
    curve = {"temperature [°C]": float(T_low) + (I - 4) * float(slope)}
    limits = (float(T_low - 8 * slope), float(T_high))
    plot = time_plot(curve, I, xlabel="current [mA]", ylim=limits)
    return plot.mark(current, "kiln").mark(0, "broken cable").mark(4, "lower end")
