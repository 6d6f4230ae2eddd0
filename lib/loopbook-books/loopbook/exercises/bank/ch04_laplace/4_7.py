"""Python beside the page of exercise 4.7."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.laplace import evaluate, final_value, inverse  # noqa: F401


def reading(start, end, T):
    """Times and readings of the picture."""
    times = np.linspace(0, 6 * float(T), 301)
    return times, float(end) + float(start - end) * np.exp(-times / float(T))


def slope_of_log(t, y, end):
    """The slope of the straight line that the logarithm of what is left of the way is."""
    return float(np.polyfit(t, np.log(np.abs(y - float(end))), 1)[0])


def largest_difference(Y, t, y):
    """The largest difference of the readings from the signal that belongs to a transform."""
    return float(np.max(np.abs(evaluate(inverse(Y), t) - y)))


def picture(t, y):
    """The reading goes from one level to another, fast at first and then more and more slowly."""
    return time_plot({"$y$": (y, "measurement")}, t, "The sensor changes baths", ylabel="$y$ [°C]")


def solution_picture(t, y, end, T):
    """The picture of the statement, with the end and the moment at which 63 % of the way are covered."""
    plot = time_plot({"$y$": (y, "measurement")}, t, "63 % of the way", ylabel="$y$ [°C]")
    return plot.level(end, "the end").mark(T, "one time constant")
