"""The loop of exercise 16.9."""

import numpy as np

from loopbook import PID, Loop, first_order, integrator, margins
from loopbook.figures import time_plot
from loopbook.stability import dominant_poles

__all__ = ["first_order", "first_pole", "margins", "solution_picture"]


def first_pole(gain, delay):
    """The first pole of a loop of an integrator with dead time, the one above the real axis."""
    return max(dominant_poles(integrator(gain, delay)), key=lambda pole: pole.imag)


def solution_picture(K, T, delay, Kc, period):
    """The response of the loop to a unit step of the setpoint, with its first two peaks."""
    times = np.linspace(0, 3 * float(period), 401)
    y = Loop(first_order(K, T, delay), PID(Kc, T)).servo.step(times)
    first = float(times[np.argmax(y)])
    plot = time_plot({"$y$": (y, "measurement")}, times, "A unit step of the setpoint", "$t$ [min]", "$y$ [K]")
    return plot.mark(first, "first peak").mark(first + float(period), "second peak").level(1, "setpoint")
