"""The errors of exercise 18.1."""

import numpy as np
from scipy.integrate import quad

from loopbook.figures import time_plot
from loopbook.laplace import evaluate


def integral(e, until):
    """The integral of a function of time from zero, by numbers."""
    return quad(lambda time: float(evaluate(e, [time])[0]), 0, float(until), epsrel=1e-9)[0]


def _errors(delay, T, far):
    """Times, and the errors of A and of B."""
    times = np.linspace(0, float(max(3 * T, 1.25 * delay)), 2001)
    both = np.where(times < float(delay), 1.0, 0.0), np.exp(-times / float(T))
    return times, *(both if far == "A" else both[::-1])


def picture(delay, T, far):
    """The errors over time: that of {far} is one and then jumps to zero, that of {near} fades from the beginning."""
    times, A, B = _errors(delay, T, far)
    return time_plot({"A": (A, 0), "B": (B, 1)}, times, "After a unit step of the setpoint", ylabel="error")


def solution_picture(delay, T, far):
    """What is added up: the squared errors above, and below the errors multiplied by the time."""
    times, A, B = _errors(delay, T, far)
    panels = [{"A": (A**2, 0), "B": (B**2, 1)}, {"A, with time": (times * A, 0), "B, with time": (times * B, 1)}]
    return time_plot(panels, times, "What is added up", ylabel=["$e^2$", "$t\\,|e|$ [s]"])
