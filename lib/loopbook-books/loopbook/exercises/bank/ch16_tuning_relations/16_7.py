"""The design of exercise 16.7."""

import math

import numpy as np

from loopbook import Loop, first_order
from loopbook.exercises.authoring import criterion, design, largest_sensitivity, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.integrals import pi_first_order


def two_digits(value):
    """A number rounded to two digits."""
    return float(f"{value:.2g}")


def ISE(pid, K, tau, theta):
    """The ISE after a load step of one percent."""
    return pi_first_order(*map(float, (K, tau, theta, pid.Kp, pid.Ti)), "regulator", math.inf)


def between_two_rules(K, tau, theta, pid, limit):
    """A PI controller with a largest sensitivity of 2 and an ISE of at most a limit."""
    process = first_order(K, tau, theta)

    def response(pid):
        times = np.linspace(0, 20 * float(theta), 401)
        y = Loop(process, pid).regulator.step(times)
        labels = {"xlabel": "$t$ [min]", "ylabel": ["$y$ [K]", "$y^2$ [K²]"]}
        panels = [{"$y$": (y, "measurement")}, {"$y^2$": (y**2, 0)}]
        plot = time_plot(panels, times, "Your loop after a load step of 1 %", **labels)
        return plot.area("$y^2$", label=f"ISE {ISE(pid, K, tau, theta):.3g}, at most {limit:g}")

    return design(
        settings(pid, "%/K", "min", "the settings"),
        pi_controller(),
        stable(process),
        largest_sensitivity(process, 30 / theta, below=2),
        criterion("the ISE", lambda pid: ISE(pid, K, tau, theta), below=limit, unit="K² min"),
        draws=response,
    )
