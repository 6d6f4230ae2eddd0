"""Python beside the page of exercise 10.9."""

from functools import lru_cache
from math import pi, sqrt

import numpy as np

from loopbook.figures import time_plot

_EACH = 5.5  # periods with each of the gains


@lru_cache
def _bath(tried):
    """The record with a period and an ultimate gain of one: times, setpoint, temperature, and valve in percent."""
    w, late = 1.7582, 55  # w + atan(3 w) is pi: a time constant of three dead times
    delay = w / (2 * pi)
    h, T, K = delay / (late + 1 / 2), 3 * delay, sqrt(1 + 9 * w**2)  # what is held for h is late by h/2
    times = np.arange(0, 4 * _EACH, h)
    setpoint = np.where((times // _EACH) % 2 == 0, 25.0, 0.0)
    gain = np.array(tried)[(times // _EACH).astype(int)]
    u, y, decay, x = np.zeros(times.size + late), np.zeros(times.size), np.exp(-h / T), 0.0
    for k in range(times.size):
        y[k] = x
        u[k + late] = np.clip(gain[k] * (setpoint[k] - x), -50, 50)
        x = decay * x + (1 - decay) * K * u[k]
    return times, setpoint, y, 50 + u[late:]


def in_the_record(tried, place):
    """The part with the ultimate gain: its period, by how much the oscillation decays, and the valve at its limits."""
    times, _, y, u = _bath(tuple(map(float, tried)))
    part = times // _EACH == int(place) - 1
    y, u = y[part & (times % _EACH > 1)], u[part]
    middle = (y.max() + y.min()) / 2
    tops = np.flatnonzero((y[:-1] < middle) & (y[1:] >= middle))
    first, last = (np.ptp(y[at : at + tops[1] - tops[0]]) for at in (tops[0], tops[-2]))
    return [np.diff(tops).mean() * times[1], last / first, min(u.min(), 100 - u.max())]


def picture(K_u, P_u, tried):
    """The record: the temperature with its setpoint, and the valve, with four gains one after the other."""
    times, setpoint, y, u = _bath(tuple(map(float, tried)))
    curves = {"setpoint": (60 + setpoint / float(K_u), "setpoint"), "temperature": (60 + y / float(K_u), "measurement")}
    panels = [curves, {"valve [%]": (u, "control signal")}]
    return time_plot(panels, times * float(P_u), ylabel=["temperature [°C]", "valve [%]"], ylim=[None, (-5, 105)])
