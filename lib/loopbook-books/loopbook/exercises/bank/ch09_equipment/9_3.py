"""Python beside the page of exercise 9.3."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.figures import time_plot


def picture(R_load, inputs, R_in, wire):
    """The loop: an output of at most {R_load}, a wire of {wire}, {receivers} an input of {R_in}, and a wire back."""
    output = f"$4$ to $20$ mA\nup to ${written(R_load)}$ Ω"
    return draw.current_loop([f"${written(R_in)}$ Ω"] * int(inputs), f"${written(wire)}$ Ω/km", output)


def solution_picture(wire, length, R_voltage):
    """The lost share of the voltage for cables up to twice as long."""
    km = np.linspace(0, 2 * float(length), 101)
    cable = 2 * float(wire) * km
    curve = {"lost voltage [%]": 100 * cable / (cable + 1000 * float(R_voltage))}
    return time_plot(curve, km, xlabel="length [km]", low=True).mark(length, "this cable")
