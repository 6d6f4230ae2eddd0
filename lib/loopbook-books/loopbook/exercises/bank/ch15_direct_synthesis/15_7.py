"""The records of exercise 15.7."""

import numpy as np

from loopbook.figures import time_plot


def _rise(times, T, delay):
    return np.where(times > delay, 1 - np.exp(-(times - delay) / T), 0)


def record_and_wish(step, K, T, delay, Tc, noise):
    """The times, the noisy record of the temperature, and the desired response."""
    times, end = np.linspace(0, float(delay + 5 * max(T, Tc)), 251), float(K * step)
    y = end * _rise(times, float(T), float(delay)) + np.random.default_rng(int(noise)).normal(0, 0.008 * end, 251)
    return times, y, _rise(times, float(Tc), float(delay))


def reached(t, y, level):
    """When a curve is at a level for the first time."""
    return float(t[np.argmax(y >= float(level))])


def picture(t, y, wish):
    """Above the noisy record of the temperature after the step of the valve, below the desired response to 1 K."""
    panels = [{"record": (y, "measurement")}, {"desired": (wish, 0)}]
    return time_plot(panels, t, ylabel=["temperature rise [K]", "desired response [K]"])
