"""The responses of exercise 14.2."""

from loopbook.approximation import half_rule
from loopbook.deadtime import System
from loopbook.exercises.bank.ch14_model_approximation.shared import beside, equation, times_until

__all__ = ["distance", "equation", "half_rule", "solution_picture"]


def distance(one, other, time):
    """How far the step response of one is above that of the other."""
    return float(System(one).step([float(time)])[0] - System(other).step([float(time)])[0])


def solution_picture(g, g_1, g_2, tau_2):
    """The level after a step of the valve, and those of both models: one ramp is ahead, the other one is right."""
    systems = {"$g$": g, "$g_1$": g_1, "$g_2$": g_2}
    return beside(systems, times_until(5 * tau_2), "The gas holder and its models", ylabel="level [%]")
