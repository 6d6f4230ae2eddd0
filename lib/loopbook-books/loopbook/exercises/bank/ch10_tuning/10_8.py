"""Python beside the page of exercise 10.8."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.identification import fit


def record(K, T, delay, u_0, step, y_0, start, noise):
    """Times, valve opening and temperature."""
    t = np.arange(0, float(start + delay + 8 * T), 5.0)
    u = np.where(t < float(start), float(u_0), float(u_0 + step))
    rise = float(K * step) * -np.expm1(-np.maximum(t - float(start + delay), 0) / float(T))
    dice = np.random.default_rng(int(noise))
    return t, u, (float(y_0) + rise + 0.015 * abs(float(K * step)) * dice.normal(size=t.size)).round(2)


def ends(u, y):
    """Averages before the step and at the end of the record."""
    return float(y[u == u[0]].mean()), float(y[-len(y) // 6 :].mean())


def areas(t, u, y, low, high):
    """T + tau and T, by areas between the response and its end, and below it."""
    k = int(np.argmax(u != u[0]))
    since, share = t[k:] - t[k], (y[k:] - low) / (high - low)
    mean = float(np.trapezoid(1 - share, since))
    until = np.linspace(0, mean, 1001)
    return mean, float(np.e * np.trapezoid(np.interp(until, since, share), until))


def fitted(t, u, y):
    """Gain, time constant and dead time of the library's fit."""
    found = fit(t, u, y).parameters
    return [found[name] for name in ("K", "T1", "delay")]


def picture(t, u, y):
    """The record: the temperature with its noise, and the step of the valve."""
    plot = time_plot([{"temperature [°C]": (y, "measurement")}, {"valve [%]": (u, "control signal")}], t)
    plot.lines["valve [%]"].set_drawstyle("steps-post")
    return plot
