"""Python beside the page of exercise 5.2."""

import numpy as np

from loopbook.exercises.authoring import number as asked_number  # noqa: F401
from loopbook.figures import time_plot
from loopbook.transfer import initial_slope, static_gain, step_response  # noqa: F401
from loopbook.transfer import poles as poles_of  # noqa: F401
from loopbook.transfer import zeros as zeros_of  # noqa: F401

in_order = sorted


def solution_picture(H, p, q, H_s):
    """The step response with its final value."""
    times = np.linspace(0, 6 / float(min(p, q)), 201)
    plot = time_plot({"$y$": (step_response(H), "measurement")}, times, low=True)
    return plot.level(H_s, "static gain")
