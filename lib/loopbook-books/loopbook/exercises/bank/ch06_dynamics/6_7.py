"""Python beside the page of exercise 6.7."""

import numpy as np

from loopbook import signals
from loopbook.figures import time_plot


def record(start, T, u_1, du, y_1, dy, noise):
    """Times, power, noisy temperature, and that without the noise."""
    start, T, u_1, du, y_1, dy = map(float, (start, T, u_1, du, y_1, dy))
    times = np.linspace(0, start + 7 * T, 400)
    rising = y_1 + dy * (1 - np.exp(-np.maximum(times - start, 0) / T))
    return times, u_1 + du * (times >= start), rising + signals.noise(times, 0.012 * dy, seed=int(noise)), rising


def picture(t, u, y):
    """The noisy temperature of an oven, which rises after a step of its power, and the power below."""
    panels = [{"temperature": (y, "raw")}, {"power": (u, "control signal")}]
    return time_plot(panels, t, xlabel="$t$ [min]", ylabel=["temperature [°C]", "power [%]"])


def solution_picture(t, y, y_model, start, moment):
    """The record with the response of the model through the noise, and the point at 63 %."""
    curves = {"measured": (y, "raw"), "model": (y_model, "model")}
    plot = time_plot(curves, t, xlabel="$t$ [min]", ylabel="temperature [°C]")
    return plot.mark(moment, "63 %, after $T$", "model").event(start, "step")
