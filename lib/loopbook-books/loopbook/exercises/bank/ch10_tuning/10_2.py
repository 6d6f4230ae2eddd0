"""Python beside the page of exercise 10.2."""

from math import log, pi

import numpy as np

from loopbook.figures import time_plot


def picture(t_1, t_2, T_ou):
    """The response to a setpoint step with the gain of the experiment; its highest and its lowest point are marked."""
    half, after = float(T_ou), log(5)  # half a period, and the decay in it: an overshoot of 20 %
    start = float(t_1) - half
    times = np.linspace(0, float(t_1) + 3 * half, 601)
    x = np.maximum(times - start, 0) / half
    y = 1 - np.exp(-after * x) * (np.cos(pi * x) + after / pi * np.sin(pi * x))
    curves = {"setpoint": (1, "setpoint"), "pressure": (y, "measurement")}
    plot = time_plot(curves, times, ylabel="share of the step")
    return plot.mark(t_1, "top", "pressure").mark(t_2, "bottom", "pressure")
