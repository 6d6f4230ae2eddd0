"""The response of exercise 16.3."""

import math

import numpy as np

from loopbook.deadtime import Loop
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation
from loopbook.pid import PID
from loopbook.transfer import feedback, second_order, static_gain

__all__ = ["feedback", "oscillation", "solution_picture", "static_gain"]


def solution_picture(K, Kc, tau_1, tau_2, total, square):
    """The response to a setpoint step: two peaks above its final value, which is below the setpoint."""
    turn = math.sqrt(total / (tau_1 * tau_2) * (1 - square))
    times = np.linspace(0, 4.5 * math.pi / turn, 401)
    y = Loop(second_order(K, tau_1, tau_2), PID(Kc)).servo.step(times)
    plot = time_plot({"$y$": (y, "measurement")}, times, "A unit step of the setpoint", "$t$ [min]", "$y$")
    plot.mark(math.pi / turn, "a peak").mark(3 * math.pi / turn, "the next one")
    return plot.level(float(1 - 1 / total), "final value")
