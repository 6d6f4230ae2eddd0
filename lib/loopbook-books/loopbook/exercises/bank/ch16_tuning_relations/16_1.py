"""The strip of paper of exercise 16.1."""

import math

import numpy as np

from loopbook.figures import time_plot


def reaction_curve(slope, theta):
    """Times, and the rise of two equal lags behind a dead time whose steepest tangent crosses zero at `theta`."""
    slope, theta = float(slope), float(theta)
    lag, times = 2 * theta, np.linspace(0, 6 * theta, 401)  # its tangent crosses zero 3 - e lags after the dead time
    late = np.maximum(times - theta + (3 - math.e) * lag, 0) / lag
    return times, slope * math.e * lag * (1 - (1 + late) * np.exp(-late))


def steepest(t, y):
    """The steepest slope of a curve."""
    return max(np.diff(y) / np.diff(t))


def picture(t, y, slope, theta):
    """The temperature after the step of the valve, an S-shaped rise, with the tangent at its steepest point."""
    ruler = np.where(t >= theta, float(slope) * (t - float(theta)), np.nan)
    curves = {"record": (y, "measurement"), "ruler": (ruler, "setpoint")}
    return time_plot(curves, t, "The strip of paper", "$t$ [min]", "temperature rise [K]")
