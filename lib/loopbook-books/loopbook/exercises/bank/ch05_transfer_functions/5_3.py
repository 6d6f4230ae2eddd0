"""Python beside the page of exercise 5.3."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.transfer import initial_gain, static_gain, step_response  # noqa: F401


def solution_picture(y, y_s, T):
    """The signal after the step: it jumps, and then creeps to its final value."""
    plot = time_plot({"signal [mV]": (y, "measurement")}, np.linspace(0, 5 * float(T), 201), low=True)
    return plot.level(y_s, "final value")
