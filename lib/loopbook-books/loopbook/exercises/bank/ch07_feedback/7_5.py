"""Python beside the page of exercise 7.5."""

import numpy as np
from sympy import Heaviside

from loopbook.expressions import t
from loopbook.figures import time_plot


def solution_picture(u_0, u_p, slope, start, back, frost, t_wait):
    """The sum of the terms without anti wind-up: it rises above 100 % during the frost, and takes long to come back."""
    during, falls = u_0 + u_p + slope * t, start - back * (t - frost)
    curves = {"computed": (during + (falls - during) * Heaviside(t - frost), "control signal")}
    times = np.linspace(0, float(frost + 1.8 * t_wait), 301)
    plot = time_plot(curves, times, xlabel="$t$ [min]", ylabel="sum of the terms [%]")
    return plot.level(100, "full power").event(frost, "frost ends").mark(frost + t_wait, "heater leaves full power")
