"""Python beside the page of exercise 11.12."""

import numpy as np

from loopbook.exercises import authoring
from loopbook.figures import time_plot


def read_off(key, unit, what, within):
    """A number that is given, and is asked where it is only seen in the picture."""
    return authoring.number(key, unit, what, within=float(within))


def openings(u_c, gap, u):
    """The openings for chilled and for hot water at a control signal, in %."""
    u, low, high = np.array(u, float), float(u_c), float(u_c + gap)
    return np.interp(u, [0, low], [100, 0]), np.interp(u, [high, 100], [0, 100])


def integrated(K_p, T_i, e, time):
    """How far the integral term moves the signal in a time, second by second."""
    return float(sum([K_p * e / T_i] * round(time)))


def picture(u_c, gap):
    """The openings of the two valves over the whole range of the control signal, with a gap between them."""
    signal = np.linspace(0, 100, 201)
    cold, hot = openings(u_c, gap, signal)
    curves = {"chilled water": cold, "hot water": hot}
    return time_plot(curves, signal, xlabel="control signal [%]", ylabel="opening [%]")
