"""The course of exercise 17.4."""

from loopbook import Loop, first_order
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import is_step_response, predictor, times_until
from loopbook.figures import time_plot
from loopbook.laplace import evaluate

__all__ = ["Loop", "at", "first_order", "is_step_response", "predictor", "solution_picture"]


def at(y, time):
    """The value of a function of time."""
    return float(evaluate(y, [float(time)])[0])


def solution_picture(y, end, T, time):
    """The deviation after the load: it grows for two dead times and a little longer, and then fades."""
    curves = {"$y$": (y, "measurement")}
    plot = time_plot(curves, times_until(end + 6 * T), "After the load", ylabel="deviation [K]")
    return plot.mark(float(time), "largest")
