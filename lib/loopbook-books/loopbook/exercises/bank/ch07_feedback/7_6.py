"""Python beside the page of exercise 7.6."""

import numpy as np
from sympy import exp

from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID


def picture(A, tau, K_p):
    """The level after a setpoint step of one metre, in winter: it arrives after the delay and overshoots a little."""
    times = np.linspace(0, 14 * float(tau), 300)
    level = Loop(exp(-tau * s) / (A * s), PID(K_p)).servo.step(times)
    curves = {"setpoint": (1, "setpoint"), "level in winter": (level, "measurement")}
    return time_plot(curves, times / 60, xlabel="$t$ [min]", ylabel="change of the level [m]", low=True)
