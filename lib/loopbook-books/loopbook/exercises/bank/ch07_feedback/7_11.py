"""Python beside the page of exercise 7.11."""

import numpy as np

from loopbook.figures import time_plot


def by_hand(SP, e, u_man, before):
    """Times [min] and trends up to the transfer at 30 min: temperature and control signal."""
    times = np.linspace(0, 30, 301)
    y = float(SP) - float(e) * (1 - np.exp(-np.maximum(times - 10, 0) / 4))
    return times, y, np.where(times < 10, float(before), float(u_man))


def picture(SP, t, T, u):
    """Temperature and setpoint, and below them the control signal, which the operator moves at 10 min."""
    panels = [{"setpoint": (float(SP), "setpoint"), "temperature": (T, "measurement")}, {"$u$": (u, "control signal")}]
    plot = time_plot(panels, t, xlabel="$t$ [min]", ylabel=["temperature [%]", "$u$ [%]"])
    return plot.event(10, "to manual").event(30, "to automatic")
