"""The responses of exercise 14.1."""

from loopbook.approximation import half_rule
from loopbook.deadtime import System
from loopbook.exercises.bank.ch14_model_approximation.shared import beside, equation, times_until
from loopbook.figures import time_plot
from loopbook.transfer import first_order

__all__ = ["equation", "half_rule", "picture", "solution_picture"]


def picture(g, theta_0, T_inv, tau_3):
    """The first minutes after a step of the steam: the composition rests, dips below zero, and then begins to rise."""
    times = times_until(2 * (theta_0 + T_inv + tau_3))
    curves = {"$y$": (System(g).step(times), "measurement")}
    return time_plot(curves, times, "The first minutes", "$t$ [min]", "share of the final value")


def solution_picture(g, tau, theta, tau_1, tau_2):
    """The process and its model: the model waits while the process goes the wrong way; then they stay together."""
    systems = {"process": g, "model": first_order(1, tau, theta)}
    return beside(systems, times_until(2.5 * (tau_1 + tau_2)), "The column and its model")
