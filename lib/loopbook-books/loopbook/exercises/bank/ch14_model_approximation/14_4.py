"""The loops of exercise 14.4."""

import math

from scipy.optimize import brentq

from loopbook.approximation import pade
from loopbook.deadtime import Loop
from loopbook.exercises.bank.ch14_model_approximation.shared import times_until
from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.stability import ultimate
from loopbook.transfer import dead_time, first_order

__all__ = ["dead_time", "first_order", "pade", "phase_crossing", "solution_picture", "ultimate"]


def phase_crossing(T, theta):
    """The frequency in rad/s at which lag and dead time together turn by 180 degrees."""
    T, theta = float(T), float(theta)
    return brentq(lambda w: math.atan(w * T) + w * theta - math.pi, math.pi / 2 / theta, math.pi / theta)


def solution_picture(g, T, theta, Ku):
    """The exact loop at the program's ultimate gain: its oscillation grows; the program shows one that stays."""
    times = times_until(12 * theta)
    processes = {"exact dead time": first_order(1, T, theta), "in the program": g}
    curves = {name: Loop(G, PID(Ku)).servo.step(times) for name, G in processes.items()}
    return time_plot(curves, times, "Both loops with the program's ultimate gain", ylabel="measurement")
