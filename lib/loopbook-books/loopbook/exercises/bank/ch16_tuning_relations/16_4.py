"""The relay of exercise 16.4."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.stability import ultimate
from loopbook.transfer import integrator

__all__ = ["integrator", "relay", "solution_picture", "ultimate"]


def relay(h):
    """Amplitude and period of y' = u(t - 1) with a relay of the height 1 and a hysteresis, followed in short steps."""
    step = 1 / 2000
    y, u, waiting, ends = 0.0, 1, [1] * 2000, []
    for k in range(60_000):
        waiting.append(u)
        slope = waiting[k]
        y += slope * step
        u = -1 if y >= h else 1 if y <= -h else u
        if slope > 0 > waiting[k + 1]:
            ends.append((y, k * step))
    return ends[-1][0], ends[-1][1] - ends[-2][1]


def solution_picture(q):
    """The measurement is a triangle; the relay switches when it has passed the hysteresis, before each peak."""
    amplitude, times = 1 + float(q) / 100, np.linspace(0, 8, 801)
    y = amplitude * (1 - 2 * abs((times / amplitude + 1) % 4 / 2 - 1))
    axes = {"xlabel": "$t$ in dead times", "ylabel": "$y$ in $Kd\\theta$"}
    plot = time_plot({"$y$": (-y, "measurement")}, times, "A relay with hysteresis", **axes)
    return plot.level(float(q) / 100, "$h$").level(-float(q) / 100, "$-h$")
