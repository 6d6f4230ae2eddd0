"""Python beside the page of exercise 9.5."""

import numpy as np
from sympy import Piecewise, lambdify

from loopbook.expressions import t
from loopbook.figures import time_plot


def in_turn(first, second, at):
    """A function of time that is one up to a moment, and another one from there on."""
    return Piecewise((first, t < at), (second, True))


def _cycles(full, T, on, P, number):
    """Times and temperatures in cycles from room temperature on, in small exact steps."""
    full, T, on, P = map(float, (full, T, on, P))
    times, y = np.linspace(0, number * P, 200 * number + 1), [0.0]
    for step in range(200 * number):
        end = full if step % 200 < round(200 * on / P) else 0.0
        y.append(end + (y[-1] - end) * np.exp(-times[1] / T))
    return times, np.array(y)


def settled(full, T, on, P):
    """Mean and ripple of the twentieth cycle."""
    y = _cycles(full, T, on, P, 20)[1][-201:]
    return [np.trapezoid(y) / 200, np.ptp(y)]


def farthest(y, full, T, on, P):
    """How far a formula is from the oven in its first cycle, at most."""
    times, found = _cycles(full, T, on, P, 1)
    return float(max(abs(lambdify(t, y)(times[:-1]) - found[:-1])))


def picture(D, P):
    """The power that the relay lets through in the first three cycles."""
    times = np.linspace(0, 3 * float(P), 601)[:-1]
    power = np.where(times % float(P) < float(D * P), 100.0, 0.0)
    return time_plot({"power [%]": (power, "control signal")}, times, xlabel="$t$ [min]", low=True)


def solution_picture(full, T, on, P, mean):
    """The first cycles, from room temperature to where each cycle is like the one before."""
    times, y = _cycles(full, T, on, P, 5)
    plot = time_plot({"temperature above the room [K]": (y, "measurement")}, times, xlabel="$t$ [min]")
    return plot.level(float(mean), "mean in the end")
