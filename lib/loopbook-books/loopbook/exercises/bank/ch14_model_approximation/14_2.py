"""The responses of exercise 14.2."""

from loopbook.exercises.bank.ch14_model_approximation.shared import beside


def solution_picture(g, g_1, g_2, tau_2):
    """The level after a step of the valve, and those of both models: one ramp is ahead, the other one is right."""
    return beside(
        {"$g$": g, "$g_1$": g_1, "$g_2$": g_2}, 5 * tau_2, "The gas holder and its models", ylabel="level [%]"
    )
