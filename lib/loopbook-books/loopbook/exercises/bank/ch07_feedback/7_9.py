"""Python beside the page of exercise 7.9."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.transfer import initial_gain  # noqa: F401


def _stairs(times, q, seconds):
    """What the transmitter sends while the temperature rises evenly."""
    return float(q) * np.floor(times / float(seconds) + 0.5)


def mean_slope(q, seconds):
    """The slope of the staircase over eight steps."""
    first, last = _stairs(np.array([0, 8 * float(seconds)]), q, seconds)
    return (last - first) / (8 * float(seconds))


def largest_change(q, seconds, h):
    """The largest change of the staircase from one sample to the next."""
    return max(np.diff(_stairs(np.arange(0, 8 * float(seconds), float(h)), q, seconds)))


def picture(q, seconds):
    """The measured temperature against time: a staircase that rises evenly."""
    times = np.linspace(0, 8 * float(seconds), 641)
    return time_plot({"measured": (20 + _stairs(times, q, seconds), "measurement")}, times, ylabel="temperature [°C]")


def solution_picture(u_true, u_filtered, T_f, seconds):
    """The magnitude of the derivative term over some steps: with the filter, and what the rise calls for."""
    seconds, T_f = float(seconds), float(T_f)
    times = np.linspace(0, 2.5 * seconds, 501)
    since = [(times - k * seconds, times >= k * seconds) for k in range(3)]
    filtered = float(u_filtered) * sum(np.exp(-late / T_f) * is_on for late, is_on in since)
    curves = {"with filter": filtered, "for the true rise": float(u_true)}
    return time_plot(curves, times, ylabel="derivative term [%]", low=True)
