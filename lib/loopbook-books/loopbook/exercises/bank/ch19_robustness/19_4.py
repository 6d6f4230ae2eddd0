"""The limit of stability of exercise 19.4."""

from loopbook import first_order, margins
from loopbook.exercises.bank.ch19_robustness.shared import robustness_plot
from loopbook.stability import robustness_pi_first_order

__all__ = ["first_order", "margins", "robustness_pi_first_order", "solution_picture"]


def solution_picture(K, T, delay, Kc, Ti, k, ratio):
    """The limit of stability over the gain ratio, with Shinskey's window and the point of this exercise."""
    return robustness_plot(K, T, delay, Kc, Ti).points([float(k)], [float(ratio)], "with the new gain", "^")
