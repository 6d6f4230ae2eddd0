"""Python beside the page of exercise 6.2."""

import numpy as np
import sympy

from loopbook.deadtime import System
from loopbook.expressions import t
from loopbook.figures import time_plot
from loopbook.transfer import first_order


def after(change, T, time):
    """How far a lag has come, by simulation."""
    return System(first_order(change, T)).step(np.array([0, float(time)]))[-1]


def solution_picture(y_1, dy, t_half, T):
    """The temperature of the air against time, with the points at half of the change and at 63 % of it."""
    curve = {"air": (y_1 + dy * (1 - sympy.exp(-t / T)), "measurement")}
    plot = time_plot(curve, np.linspace(0, 5 * float(T), 201), xlabel="$t$ [min]", ylabel="temperature [°C]", low=True)
    return plot.mark(t_half, "half of the change").mark(T, "63 %, at $T$")
