"""Python beside the page of exercise 13.1."""

import numpy as np

from loopbook.deadtime import System
from loopbook.figures import time_plot


def _response(M, g, until):
    times = np.linspace(0, float(until), 201)
    return times, float(M) * System(g).step(times)


def seen_shape(M, g, tau_1):
    """The shape of the response as one sees it: below zero, above its end, or neither."""
    _, y = _response(M, g, 12 * tau_1)
    return "inverse response" if y.min() < -1e-9 else "overshoot" if y.max() > y[-1] * 1.0001 else "neither"


def solution_picture(M, g, tau_1, end):
    """The step response with its end."""
    times, y = _response(M, g, 6 * tau_1)
    return time_plot({"$y$": y}, times, low=True).level(end, "end")
