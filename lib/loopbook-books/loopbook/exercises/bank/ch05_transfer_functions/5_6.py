"""Python beside the page of exercise 5.6."""

import numpy as np

from loopbook.figures import time_plot


def curves(K, T_1, T_2, T_0, T_r, order):
    """Times, and the four step responses, each under its letter."""
    K, T_1, T_2, T_0, T_r = map(float, (K, T_1, T_2, T_0, T_r))
    times = np.linspace(0, 6 * T_1, 300)
    slow, quick = np.exp(-times / T_1), np.exp(-times / T_2)
    found = (K * (1 - ((T_1 - T) * slow - (T_2 - T) * quick) / (T_1 - T_2)) for T in (0, T_1, T_0, -T_r))
    return times, dict(sorted(zip(order, found, strict=True)))


def picture(times, responses):
    """Four step responses A to D that end at the same value."""
    return time_plot(responses, times, ylabel="step response")
