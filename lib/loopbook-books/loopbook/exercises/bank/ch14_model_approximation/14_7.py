"""The responses of exercise 14.7."""

import functools

import numpy as np

from loopbook import System
from loopbook.exercises.bank.ch14_model_approximation.shared import times_until
from loopbook.figures import time_plot


@functools.lru_cache(maxsize=8)
def curves(order, tau_1, process, *models):
    """Times, the response of the process, and the curves A to D; the order has the letters of the models."""
    times, by_letter = times_until(3 * tau_1), dict(zip(order, models, strict=True))
    return times, *(System(H).step(times) for H in (process, *(by_letter[letter] for letter in "ABCD")))


def begins(letter, t, *curves):
    """When the curve with a letter leaves zero."""
    return t[np.flatnonzero(abs(curves["ABCD".index(letter)]) > 1e-9)[0]]


def picture(t, y, A, B, C, D):
    """The step responses of the process and of the models A to D, which begin at different times."""
    shown = t <= 2 / 3 * t[-1]
    curves = {name: (one[shown], look) for look, (name, one) in enumerate(zip("ABCD", (A, B, C, D), strict=True))}
    curves = {"process": (y[shown], "process")} | curves
    return time_plot(curves, t[shown], "Which curve is which model?", "$t$ [min]", "share of the step")
