"""The limit of stability of exercise 19.4."""

from loopbook.exercises.bank.ch19_robustness.shared import robustness_plot


def solution_picture(K, T, delay, Kc, Ti, k, ratio):
    """The limit of stability over the gain ratio, with Shinskey's window and the point of this exercise."""
    return robustness_plot(K, T, delay, Kc, Ti).points([float(k)], [float(ratio)], "with the new gain", "^")
