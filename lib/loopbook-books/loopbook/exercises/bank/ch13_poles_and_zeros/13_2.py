"""The pressure of exercise 13.2."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.laplace import evaluate
from loopbook.oscillation import oscillation
from loopbook.transfer import step_response

__all__ = ["at", "oscillation", "picture", "step_response"]


def at(y, time):
    """The value of a function of time."""
    return float(evaluate(y, [float(time)])[0])


def picture(before, after, P, real, imaginary):
    """The pressure after the step of its setpoint: a damped oscillation around the new setpoint."""
    times, real, w = np.linspace(0, float(P) * 2.2, 301), float(real), float(imaginary)
    wave = np.exp(real * times) * (np.cos(w * times) - real / w * np.sin(w * times))
    pressure = float(after) - float(after - before) * wave
    curves = {"pressure": (pressure, "measurement"), "setpoint": (after, "setpoint")}
    plot = time_plot(curves, times, ylabel="pressure [bar]", low=True)
    return plot.mark(P / 2, "first peak", "pressure").mark(3 * P / 2, "next peak", "pressure")
