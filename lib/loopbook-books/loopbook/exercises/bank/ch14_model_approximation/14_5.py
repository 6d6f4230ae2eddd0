"""The responses of exercise 14.5."""

import numpy as np

from loopbook import System, first_order
from loopbook.exercises.bank.ch14_model_approximation.shared import times_until
from loopbook.figures import time_plot
from loopbook.laplace import evaluate


def is_step_response(y, H, end):
    """Whether a function of time is the response of a system to a unit step."""
    times = times_until(end)
    return np.allclose(evaluate(y, times), System(H).step(times), atol=1e-6)


def back_at_zero(y, after, end):
    """When the response passes zero again behind its lowest point."""
    times = np.linspace(float(after), float(end), 2001)
    return times[np.flatnonzero(evaluate(y, times) > 0)[0]]


def solution_picture(y, K, tau, theta, moment):
    """The response of the approximation dips below zero at first; the exact one waits for the dead time."""
    times = times_until(4 * tau)
    curves = {"Padé": (y, "model"), "exact": (System(first_order(K, tau, theta)).step(times), "process")}
    plot = time_plot(curves, times, "Before the dead time is over", "$t$ [min]", "temperature [K]")
    return plot.mark(float(moment), "lowest", "Padé")
