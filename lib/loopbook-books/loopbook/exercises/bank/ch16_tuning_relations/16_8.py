"""The record of exercise 16.8."""

import functools
import math

import numpy as np

from loopbook import PID, Loop, integrator
from loopbook.figures import time_plot


@functools.lru_cache(maxsize=8)
def record(low, step, delay, left):
    """Times and temperature after a step of the setpoint; moments, and heights as shares, of peak, trough and peak.

    With s = -sigma + j omega in s + k e^{-s} = 0, in dead times, tan omega = omega/sigma.
    """
    omega = math.atan(2 * math.pi / math.log(100 / float(left)))
    gain = omega * math.exp(-omega / math.tan(omega)) / math.sin(omega) / float(delay)
    times = np.linspace(0, 6 * math.pi * float(delay) / omega, 3001)
    y = Loop(integrator(gain, delay), PID(1)).servo.step(times) - 1
    first = np.argmax(y)
    trough = first + np.argmin(y[first:])
    extremes = [first, trough, trough + np.argmax(y[trough:])]
    return times[::5], float(low) + float(step) * (1 + y[::5]), times[extremes].tolist(), y[extremes].tolist()


def picture(t, y, end):
    """The temperature after the step of the setpoint: it overshoots, and then oscillates around the new setpoint."""
    curves = {"temperature": (y, "measurement"), "setpoint": (float(end), "setpoint")}
    plot = time_plot(curves, t, "A step of the setpoint", "$t$ [min]", "temperature [°C]")
    plot.figure.axes[0].minorticks_on()
    plot.figure.axes[0].grid(which="minor", linewidth=0.3)
    return plot
