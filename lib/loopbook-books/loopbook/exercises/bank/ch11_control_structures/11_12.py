"""Python beside the page of exercise 11.12."""

import numpy as np

from loopbook.figures import time_plot


def openings(u_c, gap, u):
    """The openings for chilled and for hot water at a control signal, in %."""
    u, low, high = np.array(u, float), float(u_c), float(u_c + gap)
    return np.interp(u, [0, low], [100, 0]), np.interp(u, [high, 100], [0, 100])


def picture(u_c, gap):
    """The openings of the two valves over the whole range of the control signal, with a gap between them."""
    signal = np.linspace(0, 100, 201)
    cold, hot = openings(u_c, gap, signal)
    curves = {"chilled water": cold, "hot water": hot}
    return time_plot(curves, signal, xlabel="control signal [%]", ylabel="opening [%]")
