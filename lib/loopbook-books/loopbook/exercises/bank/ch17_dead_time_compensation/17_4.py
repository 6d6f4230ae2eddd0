"""The course of exercise 17.4."""

from loopbook.exercises.bank.ch17_dead_time_compensation.shared import times_until
from loopbook.figures import time_plot


def solution_picture(y, end, T, time):
    """The deviation after the load: it grows for two dead times and a little longer, and then fades."""
    curves = {"$y$": (y, "measurement")}
    plot = time_plot(curves, times_until(end + 6 * T), "After the load", ylabel="deviation [K]")
    return plot.mark(float(time), "largest")
