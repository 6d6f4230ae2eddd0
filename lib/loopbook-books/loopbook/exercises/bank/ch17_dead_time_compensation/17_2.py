"""The predictor of exercise 17.2, and its response."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor, predictor_diagram, times_until
from loopbook.figures import time_plot
from loopbook.ise import ise
from loopbook.laplace import evaluate
from loopbook.transfer import first_order

__all__ = ["first_order", "is_servo_response", "ise", "picture", "predictor", "solution_picture"]


def is_servo_response(y, process, controller, end):
    """Whether a function of time is the response of a loop to a unit step of its setpoint."""
    times = times_until(end)[1:-1]
    return np.allclose(evaluate(y, times), Loop(process, controller).servo.step(times), atol=1e-6)


def picture(K, T, delay):
    """Block diagram of the predictor: controller C, process, and the model with its dead time behind the model."""
    return predictor_diagram(K, T, delay)


def solution_picture(y, delay, Tc):
    """The fat content after the step of the setpoint: it waits for the dead time, and then follows like a lag."""
    times, curves = times_until(delay + 5 * Tc), {"$y$": (y, "measurement")}
    plot = time_plot(curves, times, "A unit step of the setpoint", ylabel="fat content [%]")
    return plot.level(1, "setpoint").event(delay, "dead time")
