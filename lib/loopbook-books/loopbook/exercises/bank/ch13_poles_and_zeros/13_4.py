"""The loop of exercise 13.4."""

import numpy as np
import sympy

from loopbook import diagrams
from loopbook.deadtime import Loop
from loopbook.exercises.bank.ch13_poles_and_zeros.shared import factor
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation
from loopbook.pid import PID
from loopbook.transfer import feedback, second_order, static_gain

__all__ = ["feedback", "oscillation", "picture", "solution_picture", "static_gain", "value"]


def value(damping, k, K_c, tau_1, tau_2):
    """The value of the damping in symbols for some numbers."""
    return sympy.sympify(damping).subs({"k": k, "K_c": K_c, "tau_1": tau_1, "tau_2": tau_2})


def picture(k, tau_1, tau_2):
    """A loop of the controller with the gain K_c and a process of two lags."""
    lags = "".join(f"({factor(x)}s + 1)" for x in (tau_1, tau_2))
    process = diagrams.block(rf"\frac{{{float(k):g}}}{{{lags}}}")
    return diagrams.block_diagram("y_s", diagrams.feedback_loop([diagrams.block("K_c"), "u", process]), "y")


def solution_picture(k, K_c, tau_1, tau_2, tau):
    """A setpoint step of the loop with this gain: it oscillates, and an offset is left."""
    times = np.linspace(0, 12 * float(tau), 301)
    y = Loop(second_order(k, tau_1, tau_2), PID(K_c)).servo.step(times)
    curves = {"temperature": (y, "measurement"), "setpoint": (1, "setpoint")}
    return time_plot(curves, times, ylabel="share of the step", low=True)
