"""The oscillation of exercise 16.2."""

import math

import numpy as np

from loopbook.figures import time_plot


def cycle(P_u):
    """Times, and a level that oscillates."""
    times = np.linspace(0, 4.5 * float(P_u), 401)
    return times, 50 + 4 * np.sin(2 * math.pi * times / float(P_u) + 1)


def picture(t, y):
    """The level oscillates around 50 % with a steady amplitude; a little more than four periods are shown."""
    return time_plot({"$y$": (y, "measurement")}, t, "At the limit of stability", "$t$ [min]", "level [%]")
