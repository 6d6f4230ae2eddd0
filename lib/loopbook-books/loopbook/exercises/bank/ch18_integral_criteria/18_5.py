"""The design of exercise 18.5."""

import math

import numpy as np

from loopbook import Loop, first_order
from loopbook.exercises.authoring import criterion, design, largest_sensitivity, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.integrals import pi_first_order


def quick_and_robust(K, T, delay, controller, limit):
    """A PI controller with a largest sensitivity of 1.8 and an ISE of at most a limit."""

    def error(pid):
        return pi_first_order(*map(float, (K, T, delay, pid.Kp, pid.Ti)), "servo", math.inf)

    def response(pid):
        times = np.linspace(0, 10 * float(delay), 401)
        y = Loop(first_order(K, T, delay), pid).servo.step(times)
        panels = [{"$y$": (y, "measurement")}, {"$e^2$": ((1 - y) ** 2, 0)}]
        plot = time_plot(panels, times, "Your loop after a unit step of the setpoint", ylabel=["$y$", "$e^2$"])
        return plot.area("$e^2$", label=f"ISE {error(pid):.4g} s, at most {float(limit):g}")

    return design(
        settings(controller, time="s", what="the settings of the PI controller"),
        pi_controller(),
        stable(by=lambda pid: error(pid) < math.inf),
        largest_sensitivity(first_order(K, T, delay), 20 / delay, below=1.8),
        criterion("the ISE", error, below=limit, unit="s"),
        draws=response,
    )
