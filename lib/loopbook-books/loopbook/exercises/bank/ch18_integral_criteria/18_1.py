"""The errors of exercise 18.1."""

import numpy as np
import sympy

from loopbook import t
from loopbook.figures import time_plot


def integral(e, until=sympy.oo):
    """The integral of a function of time from zero."""
    return sympy.integrate(e, (t, 0, until))


def picture(delay, T, far, near):
    """The errors over time: that of {far} is one and then jumps to zero, that of {near} fades from the beginning."""
    times = np.linspace(0, float(max(3 * T, 1.25 * delay)), 2001)
    curves = {far: np.where(times < float(delay), 1.0, 0.0), near: np.exp(-times / float(T))}
    return time_plot(dict(sorted(curves.items())), times, "After a unit step of the setpoint", ylabel="error")
