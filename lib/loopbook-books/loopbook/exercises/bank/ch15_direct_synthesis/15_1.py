"""Python beside the page of exercise 15.1."""

import numpy as np
import sympy

from loopbook.expressions import t
from loopbook.figures import time_plot
from loopbook.synthesis import direct_synthesis  # noqa: F401
from loopbook.transfer import first_order  # noqa: F401


def solution_picture(T, Tc, time):
    """The temperature after a step of the setpoint, with the controller and with the valve alone."""
    curves = {"with the controller": (1 - sympy.exp(-t / Tc), "measurement"), "without": (1 - sympy.exp(-t / T), 3)}
    times = np.linspace(0, float(3 * T), 401)
    return time_plot(curves, times, "A step of the setpoint by 1 K", "$t$ [min]", "temperature [K]").mark(time, "95 %")
