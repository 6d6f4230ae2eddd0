"""The responses of exercise 14.3."""

from loopbook import dead_time
from loopbook.exercises.bank.ch14_model_approximation.shared import beside


def solution_picture(part, instead, theta):
    """The step response of zero and lag behind the dead time, and of what takes their place."""
    systems = {"zero and lag": part * dead_time(theta), "instead": instead * dead_time(theta)}
    return beside(systems, 6 * theta, "What the loop sees", "$t$ [s]")
