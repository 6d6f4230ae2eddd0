"""The design of exercise 17.5."""

import math

import numpy as np

from loopbook import Loop, first_order
from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import times_until
from loopbook.figures import time_plot
from loopbook.integrals import pi_first_order


def _M(K, T, off, pid, w):
    """The size of M at the frequencies w."""
    return abs(Loop(first_order(K, T), pid).T.frequency(w)) * 2 * abs(np.sin(w * float(off) / 2))


def largest_M(K, T, off, pid):
    """The largest size of M at any frequency."""
    return float(np.max(_M(K, T, off, pid, np.geomspace(0.01, 50, 2000) / float(off))))


def safe_and_quick(K, T, model_delay, off, limit, controller):
    """A PI controller with |M| below 0.8, and with an ISE of at most a limit where the model is right."""

    def error(pid):
        return float(model_delay) + pi_first_order(*map(float, (K, T, 0, pid.Kp, pid.Ti)), unstable=math.inf)

    def size(pid):
        w = times_until(12 / off)[1:]
        curve = {"$|M(j\\omega)|$": (_M(K, T, off, pid, w), "measurement")}
        return time_plot(curve, w, "Your predictor", "$\\omega$ [rad/min]").level(0.8, "limit")

    return design(
        settings(controller, time="min", what="the settings of the PI controller"),
        pi_controller(),
        stable(by=lambda pid: error(pid) < math.inf),
        criterion("the largest $|M|$", lambda pid: largest_M(K, T, off, pid), below=0.8),
        criterion("the ISE with the right model", error, below=limit, unit="min"),
        draws=size,
    )
