"""Python beside the page of exercise 7.6."""

import numpy as np
from sympy import exp

from loopbook.deadtime import Loop
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.stability import delay_margin as delay_margin_of  # noqa: F401
from loopbook.stability import ultimate  # noqa: F401


def _level(A, delay, K_p, times):
    return Loop(exp(-delay * s) / (A * s), PID(K_p)).servo.step(times)


def picture(A, tau, K_p):
    """The level after a setpoint step of one metre, in winter: it arrives after the delay and overshoots a little."""
    times = np.linspace(0, 14 * float(tau), 300)
    curves = {"setpoint": (1, "setpoint"), "level in winter": (_level(A, tau, K_p, times), "measurement")}
    return time_plot(curves, times / 60, xlabel="$t$ [min]", ylabel="change of the level [m]", low=True)


def solution_picture(A, tau, K_p, summer):
    """The level after a setpoint step in winter and in summer, with the longer delay."""
    times = np.linspace(0, 14 * float(tau), 300)
    curves = {"winter": _level(A, tau, K_p, times), "summer": _level(A, summer, K_p, times)}
    curves = {"setpoint": (1, "setpoint")} | curves
    return time_plot(curves, times / 60, xlabel="$t$ [min]", ylabel="change of the level [m]", ylim=(-1.5, 3.5))
