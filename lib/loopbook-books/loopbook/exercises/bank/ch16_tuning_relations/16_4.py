"""The relay of exercise 16.4."""

from loopbook import integrator, ultimate
from loopbook.figures import time_plot
from loopbook.identification import relay_experiment

__all__ = ["integrator", "relay_experiment", "solution_picture", "ultimate"]


def solution_picture(h):
    """The measurement is a triangle; the relay switches when it has passed the hysteresis, before each peak."""
    cycle = relay_experiment(integrator(1, 1), 1, h, periods=2)
    axes = {"xlabel": "$t$ in dead times", "ylabel": "$y$ in $Kd\\theta$"}
    plot = time_plot({"$y$": (cycle.y, "measurement")}, cycle.times, "A relay with hysteresis", **axes)
    return plot.level(float(h), "$h$").level(-float(h), "$-h$")
