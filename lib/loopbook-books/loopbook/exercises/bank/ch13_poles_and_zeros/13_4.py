"""Python beside the page of exercise 13.4."""

import numpy as np

from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.exercises.bank.ch08_feedforward.shared import in_numbers  # noqa: F401
from loopbook.exercises.bank.ch13_poles_and_zeros.shared import factor
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation  # noqa: F401
from loopbook.transfer import feedback, second_order, static_gain  # noqa: F401


def picture(k, tau_1, tau_2):
    """A loop of the controller with the gain K_c and a process of two lags."""
    lags = "".join(f"({factor(x)}s + 1)" for x in (tau_1, tau_2))
    process = diagrams.block(rf"\frac{{{float(k):g}}}{{{lags}}}")
    return diagrams.block_diagram("y_s", diagrams.feedback_loop([diagrams.block("K_c"), "u", process]), "y")


def solution_picture(closed, tau):
    """A setpoint step of the loop with this gain: it oscillates, and an offset is left."""
    times = np.linspace(0, 12 * float(tau), 301)
    curves = {"temperature": (System(closed).step(times), "measurement"), "setpoint": (1, "setpoint")}
    return time_plot(curves, times, ylabel="share of the step", low=True)
