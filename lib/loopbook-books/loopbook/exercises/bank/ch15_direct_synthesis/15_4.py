"""Python beside the page of exercise 15.4."""

import numpy as np
import sympy

from loopbook.deadtime import System
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.synthesis import direct_synthesis  # noqa: F401
from loopbook.transfer import step_response  # noqa: F401


def fraction(K, T1, T2, beta):
    """The process as a book prints it: without factors of one."""
    gain, lead = ("" if x == 1 else rf"{float(x):g}\," for x in (K, beta))
    return rf"$\frac{{{gain}(1 - {lead}s)}}{{({float(T1):g}\,s + 1)({float(T2):g}\,s + 1)}}$"


def one_digit(depth):
    """A depth as it is read off the picture."""
    return float(f"{float(depth):.1g}")


def least(y, end):
    """The least value of a function of time."""
    return float(sympy.lambdify(t, y)(np.linspace(0, float(end), 10001)).min())


def least_of_process(T1, T2, beta):
    """The least value of the unit step response of the process, in shares of its final value."""
    process = System((1 - beta * s) / ((T1 * s + 1) * (T2 * s + 1)))
    return float(min(process.step(np.linspace(0, float(T1), 1001))))


def picture(K, T1, T2, beta):
    """The temperature after a step of the feed valve by 1 %: first it falls below zero, then it rises to its end."""
    times = np.linspace(0, float(5 * T1), 401)
    y = System(K * (1 - beta * s) / ((T1 * s + 1) * (T2 * s + 1))).step(times)
    return time_plot({"$y$": (y, "measurement")}, times, "The process alone", "$t$ [min]", "temperature [K]")


def solution_picture(y, Tc, moment):
    """The temperature after a step of the setpoint: it dips below zero, and then rises to the setpoint."""
    times = np.linspace(0, float(8 * Tc), 401)
    plot = time_plot(
        {"$y$": (y, "measurement")}, times, "A step of the setpoint by 1 K", "$t$ [min]", "temperature [K]"
    )
    return plot.mark(moment, "undershoot").level(1, "setpoint")
