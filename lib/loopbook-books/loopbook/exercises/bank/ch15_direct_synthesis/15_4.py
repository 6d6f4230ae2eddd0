"""The responses of exercise 15.4."""

import numpy as np

from loopbook import System
from loopbook.figures import time_plot


def least(H, end):
    """The least value of a step response."""
    return float(min(System(H).step(np.linspace(0, float(end), 2001))))


def picture(K, process, T1):
    """The temperature after a step of the feed valve by 1 %: first it falls below zero, then it rises to its end."""
    times = np.linspace(0, float(5 * T1), 401)
    curves = {"$y$": (System(K * process).step(times), "measurement")}
    return time_plot(curves, times, "The process alone", "$t$ [min]", "temperature [K]")


def solution_picture(y, Tc, moment):
    """The temperature after a step of the setpoint: it dips below zero, and then rises to the setpoint."""
    times, curves = np.linspace(0, float(8 * Tc), 401), {"$y$": (y, "measurement")}
    plot = time_plot(curves, times, "A step of the setpoint by 1 K", "$t$ [min]", "temperature [K]")
    return plot.mark(moment, "undershoot").level(1, "setpoint")
