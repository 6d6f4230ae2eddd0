"""Python beside the page of exercise 1.5."""

import numpy as np

from loopbook.figures import time_plot


def silo(h_SP, above, left, period):
    """The level after a step of the setpoint: a first swing `above`, and then one of `left` times as much."""
    times = np.linspace(0, 2.5 * float(period), 501)
    step, omega = float(above / left), 2 * np.pi / float(period)
    decay = -2 * np.log(float(left)) / float(period)
    swing = np.cos(omega * times) + decay / omega * np.sin(omega * times)
    return times, float(h_SP) - step * np.exp(-decay * times) * swing


def read_off(h, h_SP):
    """The second swing over the first, as a ruler finds them."""
    top = h.argmax()
    return float((float(h_SP) - h[top:].min()) / (h[top] - float(h_SP)))


def picture(t, h, h_SP):
    """The level overshoots its new setpoint, falls below it, and so on, each time less far."""
    signals = {"setpoint": (h_SP, "setpoint"), "$h$": (h, "measurement")}
    return time_plot(signals, t, "A new setpoint at $t = 0$", xlabel="$t$ [min]", ylabel="$h$ [m]")


def solution_picture(t, h, h_SP, period):
    """The picture of the statement, with the two swings marked that are compared."""
    plot = picture(t, h, h_SP)
    return plot.mark(period / 2, "first", signal="$h$").mark(period, "next", signal="$h$")
