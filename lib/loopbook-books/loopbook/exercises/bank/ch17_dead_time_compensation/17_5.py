"""The design of exercise 17.5."""

import math

import numpy as np

from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor, times_until
from loopbook.figures import time_plot
from loopbook.ise import ise, pi_first_order
from loopbook.stability import is_closed_loop_stable
from loopbook.transfer import first_order

__all__ = ["first_order", "is_closed_loop_stable", "ise", "largest_M", "predictor", "safe_and_quick"]


def _M(K, T, off, pid, w):
    """The size of M at the frequencies w."""
    Kp, Ti, Td, Tf = (float(x) for x in (pid.Kp, pid.Ti, pid.Td, pid.Tf))
    jw = 1j * w
    L = Kp * (1 + 1 / (Ti * jw) + Td * jw / (Tf * jw + 1)) * float(K) / (float(T) * jw + 1)
    return abs(L / (1 + L)) * 2 * abs(np.sin(w * float(off) / 2))


def largest_M(K, T, off, pid):
    """The largest size of M at any frequency."""
    return float(np.max(_M(K, T, off, pid, np.geomspace(0.01, 50, 2000) / float(off))))


def safe_and_quick(K, T, model_delay, off, limit, controller):
    """A PI controller with |M| below 0.8, and with an ISE of at most a limit where the model is right."""

    def error(pid):
        Kp, Ti = float(pid.Kp), float(pid.Ti)
        if Kp <= 0 or math.isinf(Ti):
            return math.inf
        return float(model_delay) + pi_first_order(float(K), float(T), 0, Kp, Ti, unstable=math.inf)

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
