"""Python beside the page of exercise 7.9."""

import numpy as np

from loopbook.figures import time_plot


def staircase(q, seconds, h):
    """The samples that arrive while the temperature rises evenly, by eight steps: their times, and the temperatures."""
    times = np.arange(0, 8 * float(seconds) + float(h), float(h))
    return times, 20 + float(q) * np.floor(times / float(seconds) + 0.5)


def grid(seconds):
    """How many seconds are between two lines of the picture's grid."""
    from matplotlib.ticker import MaxNLocator  # not before it is asked: in a page of the site it is loaded then

    return float(np.diff(MaxNLocator(9, steps=[1, 2, 2.5, 5, 10]).tick_values(0, 8 * float(seconds)))[0])


def picture(q, seconds):
    """The measured temperature against time: a staircase that rises evenly."""
    t, y = staircase(q, seconds, seconds / 80)
    return time_plot({"measured": (y, "measurement")}, t, ylabel="temperature [°C]")
