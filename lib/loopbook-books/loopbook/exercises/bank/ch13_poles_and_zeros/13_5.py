"""Python beside the page of exercise 13.5."""

import numpy as np

from loopbook.exercises.in_formulas import at
from loopbook.figures import time_plot
from loopbook.laplace import evaluate


def back_at_zero(y, before, after):
    """The time between two others at which a response is zero."""
    from scipy.optimize import brentq  # not before it is asked: a page of the site loads it then

    return brentq(lambda time: at(y, time), float(before), float(after))


def picture(rate, K, tau):
    """The two effects of 1 kg/s more feedwater, each alone: a ramp upwards, and a fall that levels off."""
    times = np.linspace(0, float(4 * tau), 201)
    curves = {"more water": float(rate) * times, "fewer bubbles": float(-K) * (1 - np.exp(-times / float(tau)))}
    return time_plot(curves, times, ylabel="level [cm]", low=True)


def solution_picture(h, t_low, tau):
    """The level after the step of the feedwater, with its lowest point."""
    times = np.linspace(0, max(2.5 * float(t_low), float(3 * tau)), 201)
    return time_plot({"level [cm]": evaluate(h, times)}, times, low=True).mark(float(t_low), "lowest")
