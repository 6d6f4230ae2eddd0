"""The responses of exercise 14.1."""

from loopbook import System, first_order
from loopbook.exercises.bank.ch14_model_approximation.shared import beside, times_until
from loopbook.figures import time_plot


def picture(g, theta_0, T_inv, tau_3):
    """The first minutes after a step of the steam: the composition waits, dips below zero, and then begins to rise."""
    times = times_until(2 * (theta_0 + T_inv + tau_3))
    curves = {"$y$": (System(g).step(times), "measurement")}
    return time_plot(curves, times, "The first minutes", "$t$ [min]", "share of the final value")


def solution_picture(g, tau, theta, tau_1, tau_2):
    """The process and its model: the model waits while the process goes the wrong way; then they stay together."""
    return beside(
        {"process": g, "model": first_order(1, tau, theta)}, 2.5 * (tau_1 + tau_2), "The column and its model"
    )
