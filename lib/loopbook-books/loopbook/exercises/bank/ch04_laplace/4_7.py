"""Python beside the page of exercise 4.7."""

import numpy as np

from loopbook.figures import time_plot


def reading(start, end, T):
    """Times and readings of the picture."""
    times = np.linspace(0, 6 * float(T), 301)
    return times, float(end) + float(start - end) * np.exp(-times / float(T))


def picture(t, y):
    """The reading goes from one level to another, fast at first and then more and more slowly."""
    return time_plot({"$y$": (y, "measurement")}, t, "The sensor changes baths", ylabel="$y$ [°C]")


def solution_picture(t, y, end, T):
    """The picture of the statement, with the end and the moment at which 63 % of the way are covered."""
    return picture(t, y).level(end, "the end").mark(T, "63 % of the way")
