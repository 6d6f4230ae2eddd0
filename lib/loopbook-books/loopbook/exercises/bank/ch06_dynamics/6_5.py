"""Python beside the page of exercise 6.5."""

import math

import numpy as np

from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.transfer import response_time, second_order  # noqa: F401


def time_to_63(T_1, T_2):
    """The time to 63 % for two different lags in series, by bisection."""
    low, high = float(T_1), float(2 * (T_1 + T_2))
    for _ in range(50):
        x = (low + high) / 2
        missing = (T_1 * math.exp(-x / T_1) - T_2 * math.exp(-x / T_2)) / (T_1 - T_2)
        low, high = (x, high) if missing > math.exp(-1) else (low, x)
    return low


def after(H, time):
    """The step response at a moment, by simulation."""
    return System(H).step(np.array([0, float(time)]))[-1]


def solution_picture(T_1, T_2, delay, estimate):
    """The share of the change that the sensor shows, with the estimate marked."""
    T_1, T_2, delay = float(T_1), float(T_2), float(delay)
    times = np.linspace(0, delay + 4 * (T_1 + T_2), 400)
    x = np.maximum(times - delay, 0)
    shown = 1 - (T_1 * np.exp(-x / T_1) - T_2 * np.exp(-x / T_2)) / (T_1 - T_2)
    plot = time_plot({"sensor": (shown, "measurement")}, times, ylabel="share of the change", low=True)
    return plot.mark(estimate, "at the estimate").level(1 - math.exp(-1), "63.2 %")
