"""The course of exercise 17.4."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor, times_until
from loopbook.figures import time_plot
from loopbook.laplace import evaluate
from loopbook.transfer import first_order

__all__ = ["at", "first_order", "is_load_response", "predictor", "solution_picture"]


def at(y, time):
    """The value of a function of time."""
    return float(evaluate(y, [float(time)])[0])


def is_load_response(y, process, controller, load, end):
    """Whether a function of time is the response of a loop to a step of the load."""
    times = times_until(end)[1:-1]
    return np.allclose(evaluate(y, times), float(load) * Loop(process, controller).regulator.step(times), atol=1e-5)


def solution_picture(y, end, T, time):
    """The deviation after the load: it grows for two dead times and a little longer, and then fades."""
    curves = {"$y$": (y, "measurement")}
    plot = time_plot(curves, times_until(end + 6 * T), "After the load", ylabel="deviation [K]")
    return plot.mark(float(time), "largest")
