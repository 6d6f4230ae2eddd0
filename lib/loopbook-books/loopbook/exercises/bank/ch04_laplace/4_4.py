"""Python beside the page of exercise 4.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook.expressions import t
from loopbook.figures import time_plot
from loopbook.laplace import inverse  # noqa: F401


def reading_at(y, moment):
    """The reading at a moment."""
    return float(y.subs(t, moment))


def picture(T, start, bath, rest):
    """What is around the thermometer: {start} until t = 0, and {bath} from then on. The reading is drawn up to t = 0,
    and also the line {rest} below the water."""
    times = np.linspace(-float(T), 5 * float(T), 601)
    before = times < 0
    signals = {
        "around it, $u$": (np.where(before, float(start), float(bath)), "setpoint"),
        "reading, $y$": (np.where(before, float(start), np.nan), "measurement"),
        f"{written(rest)} K below": (np.where(before, np.nan, float(bath - rest)), "raw"),
    }
    return time_plot(signals, times, ylabel="temperature [°C]", low=True)


def solution_picture(y, bath, t_near):
    """The reading goes from where it was to the temperature of the water."""
    plot = time_plot({"$y$": (y, "measurement")}, np.linspace(0, 1.3 * float(t_near), 201), ylabel="$y$ [°C]")
    return plot.level(bath, "water").mark(float(t_near), "near enough")
