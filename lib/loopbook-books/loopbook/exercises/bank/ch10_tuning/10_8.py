"""Python beside the page of exercise 10.8."""

import numpy as np

from loopbook.exercises import authoring
from loopbook.figures import time_plot


def asked(key, unit, what, within):
    """A number as the key."""
    return authoring.number(key, unit, what, float(within))


def record(K, T, delay, u_0, step, y_0, start, noise):
    """Times, valve opening and temperature."""
    t = np.arange(0, float(start + delay + 8 * T), 5.0)
    u = np.where(t < float(start), float(u_0), float(u_0 + step))
    dice = np.random.default_rng(int(noise))
    noise = 0.015 * abs(float(K * step)) * dice.normal(size=t.size)
    return t, u, (_response(t, K, T, delay, step, y_0, start) + noise).round(2)


def _response(t, K, T, delay, step, y_0, start):
    return float(y_0) + float(K * step) * -np.expm1(-np.maximum(t - float(start + delay), 0) / float(T))


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


def fit_is_right(t, u, y, K, T, tau):
    """Whether the fit of the library is right within the accuracies asked for."""
    from loopbook.identification import fit

    found = fit(t, u, y).parameters
    asked = {"K": (K, 0.04), "T1": (T, 0.1), "delay": (tau, 0.25)}
    return all(abs(found[name] / float(key) - 1) < within for name, (key, within) in asked.items())


def picture(t, u, y):
    """The record: the temperature with its noise, and the step of the valve."""
    plot = time_plot([{"temperature [°C]": (y, "measurement")}, {"valve [%]": (u, "control signal")}], t)
    plot.lines["valve [%]"].set_drawstyle("steps-post")
    return plot


def solution_picture(t, y, K, T, delay, step, y_0, start):
    """The record, and the response of the model through it."""
    curves = {"measured": (y, "raw"), "model": (_response(t, K, T, delay, step, y_0, start), "model")}
    return time_plot(curves, t, ylabel="temperature [°C]")
