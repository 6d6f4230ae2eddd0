"""The relay of exercise 16.4."""

import functools

from loopbook import integrator
from loopbook.figures import time_plot
from loopbook.identification import relay_experiment


@functools.cache
def cycle(h):
    """The limit cycle, by experiment, with K, d and the dead time as units."""
    return relay_experiment(integrator(1, 1), 1, h, periods=2)


def solution_picture(h):
    """The measurement is a triangle; the relay switches when it has passed the hysteresis, before each peak."""
    axes = {"xlabel": "$t$ in dead times", "ylabel": "$y$ in $Kd\\theta$"}
    plot = time_plot({"$y$": (cycle(h).y, "measurement")}, cycle(h).times, "A relay with hysteresis", **axes)
    return plot.level(float(h), "$h$").level(-float(h), "$-h$")
