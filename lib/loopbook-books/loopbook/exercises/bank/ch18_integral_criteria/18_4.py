"""The loop of exercise 18.4."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.figures import time_plot
from loopbook.ise import ise, pi_first_order
from loopbook.pid import PID
from loopbook.stability import margins
from loopbook.transfer import first_order

__all__ = ["first_order", "ise", "margins", "pi_first_order", "solution_picture"]


def solution_picture(K, T, delay, Kc, Ti, ISE):
    """The squared error after the setpoint step, with its area shaded."""
    times = np.linspace(0, 3 * float(T + delay), 401)
    e = 1 - Loop(first_order(K, T, delay), PID(Kc, Ti)).servo.step(times)
    plot = time_plot({"$e^2$": (e**2, "measurement")}, times, "What the ISE adds up")
    return plot.area("$e^2$", label=f"{ISE:.3g} s")
