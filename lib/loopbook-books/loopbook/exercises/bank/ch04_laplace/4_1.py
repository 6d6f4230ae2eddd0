"""Python beside the page of exercise 4.1."""

import numpy as np

from exercisebook.parameters import written
from loopbook.expressions import t
from loopbook.figures import time_plot


def picture(start, rate):
    """The temperature against time: it begins at {start} and rises along a straight line, by {rate}."""
    signals = {r"$\vartheta(t)$": (start + rate * t, "measurement")}
    plot = time_plot(signals, np.linspace(0, 60, 3), ylabel=r"$\vartheta$ [°C]", ylim=(0, start + 66 * rate), low=True)
    return plot.mark(0, f"{written(start)} °C").mark(30, f"{written(rate)} K in each second")
