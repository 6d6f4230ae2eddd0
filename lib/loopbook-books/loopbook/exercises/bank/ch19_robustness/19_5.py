"""The design of exercise 19.5."""

import math

import numpy as np

from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.exercises.bank.ch19_robustness.shared import robustness_plot
from loopbook.integrals import pi_first_order
from loopbook.stability import robustness_pi_first_order


def distance(K, T, delay, Kp, Ti):
    """The least quotient of the limit of stability and the upper sides of Shinskey's window."""
    k = np.geomspace(0.5, 2, 201)
    return float(min(robustness_pi_first_order(K, T, delay, Kp, Ti, k) / (2 * np.minimum(k, 1 / k))))


def load_ISE(K, T, delay, Kp, Ti):
    """The integral of the squared error after a unit step of the load; infinite for an unstable loop."""
    return float(pi_first_order(*map(float, (K, T, delay, Kp, Ti)), "regulator", math.inf))


def robust_and_quick(K, T, delay, controller, limit):
    """A PI controller that keeps the window, and whose ISE after a load is at most a limit."""

    def error(pid):
        return load_ISE(K, T, delay, pid.Kp, pid.Ti)

    return design(
        settings(controller, time="s", what="the settings of the PI controller"),
        pi_controller(),
        stable(by=lambda pid: error(pid) < math.inf),
        criterion("the distance from the window", lambda pid: distance(K, T, delay, pid.Kp, pid.Ti), above=1),
        criterion("the ISE after the load step", error, below=limit, unit="s"),
        draws=lambda pid: robustness_plot(K, T, delay, pid.Kp, pid.Ti),
    )
