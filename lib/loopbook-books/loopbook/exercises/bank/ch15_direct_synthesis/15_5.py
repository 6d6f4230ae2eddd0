"""The design of exercise 15.5."""

import math

import numpy as np

from loopbook import Loop, first_order
from loopbook.exercises.authoring import criterion, design, largest_sensitivity, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.integrals import pi_first_order


def recovery(K, T, delay, controller):
    """How long the deviation after a step of the load stays above 5 % of its largest value, up to 200 dead times."""
    times = np.linspace(0, 200 * float(delay), 8001)
    y = abs(Loop(first_order(K, T, delay), controller).regulator.step(times))
    return float(times[np.flatnonzero(y > 0.05 * max(y))[-1]])


def robust_and_quick(controller, K, T, delay):
    """Settings with an Ms of at most 1.7, with which the oven recovers in 25 dead times."""

    def is_stable(pid):
        return pi_first_order(*map(float, (K, T, delay, pid.Kp, pid.Ti)), "regulator", math.inf) < math.inf

    def after_a_load(pid):
        times = np.linspace(0, float(40 * delay), 401)
        y = Loop(first_order(K, T, delay), pid).regulator.step(times)
        curves = {"$y$": (y, "measurement")}
        plot = time_plot(curves, times, "Your loop after a load step of 1 %", "$t$ [min]", "$y$ [K]")
        return plot.level(0.05 * max(y), "5 % of the largest").event(25 * delay, "recovered?")

    return design(
        settings(controller, gain="%/K", time="min", what="the settings of the PI controller"),
        pi_controller(),
        stable(by=is_stable),
        largest_sensitivity(first_order(K, T, delay), 20 / delay, below=1.7),
        criterion("the time of recovery", lambda pid: recovery(K, T, delay, pid), below=25 * delay, unit="min"),
        draws=after_a_load,
    )
