"""The responses of exercise 17.1."""

import numpy as np

from loopbook import PID, Loop, System, first_order
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import times_until
from loopbook.figures import time_plot


def integral_of_square(K, T, until):
    """The integral of the square of the lag's response to a unit step."""
    from scipy.integrate import simpson  # not before it is asked: a page of the site loads it then

    times = times_until(until)
    return simpson(System(first_order(K, T)).step(times) ** 2, x=times)


def first_felt(K, T, delay):
    """When the response to a load begins to differ from that without a controller."""
    process, times = first_order(K, T, delay), times_until(4 * delay)
    change = Loop(process, PID(T / (2 * K * delay), T)).regulator.step(times) - System(process).step(times)
    return times[np.flatnonzero(abs(change) > 1e-9)[0] - 1]


def picture(K, T, delay):
    """The signal after a load step of 1 % without a controller: a dead time, and then a lag."""
    times = times_until(delay + 4 * T)
    curves = {"$y$": (System(first_order(K, T, delay)).step(times), "measurement")}
    return time_plot(curves, times, "A load of 1 %, nobody acts", ylabel="$y$ [%]")
