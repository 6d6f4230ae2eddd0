"""Python beside the page of exercise 13.2."""

import numpy as np

from loopbook.deadtime import System
from loopbook.figures import time_plot


def picture(before, after, P, loop):
    """The pressure after the step of its setpoint: a damped oscillation around the new setpoint."""
    times = np.linspace(0, float(P) * 2.2, 301)
    pressure = float(before) + float(after - before) * System(loop).step(times)
    curves = {"pressure": (pressure, "measurement"), "setpoint": (after, "setpoint")}
    plot = time_plot(curves, times, ylabel="pressure [bar]", low=True)
    return plot.mark(P / 2, "first peak", "pressure").mark(3 * P / 2, "next peak", "pressure")
