"""Python beside the page of exercise 6.7."""

import numpy as np

from loopbook import signals
from loopbook.exercises import authoring
from loopbook.figures import time_plot


def read_off(key, unit, what, within):
    """A number that is given, and is asked where it is only seen in the picture."""
    return authoring.number(key, unit, what, within=float(within))


def _rising(times, start, T, y_1, dy):
    return float(y_1) + float(dy) * (1 - np.exp(-np.maximum(times - float(start), 0) / float(T)))


def record(start, T, u_1, du, y_1, dy, noise):
    """Times, power and noisy temperature."""
    times = np.linspace(0, float(start + 7 * T), 400)
    power = float(u_1) + float(du) * (times >= float(start))
    return times, power, _rising(times, start, T, y_1, dy) + signals.noise(times, 0.012 * float(dy), seed=int(noise))


def change(values):
    """From the mean at the beginning to that at the end."""
    return np.mean(values[-60:]) - np.mean(values[:15])


def reached(t, values, level):
    """When a curve is above a level for the first time."""
    return float(t[np.argmax(values >= float(level))])


def picture(t, u, y):
    """The noisy temperature of an oven, which rises after a step of its power, and the power below."""
    panels = [{"temperature": (y, "raw")}, {"power": (u, "control signal")}]
    return time_plot(panels, t, xlabel="$t$ [min]", ylabel=["temperature [°C]", "power [%]"])


def solution_picture(t, y, start, T, y_1, dy, moment):
    """The record with the response of the model through the noise, and the point at 63 %."""
    curves = {"measured": (y, "raw"), "model": (_rising(t, start, T, y_1, dy), "model")}
    plot = time_plot(curves, t, xlabel="$t$ [min]", ylabel="temperature [°C]")
    return plot.mark(moment, "63 %, after $T$", "model").event(start, "step")
