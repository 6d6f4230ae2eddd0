"""Python beside the page of exercise 10.6."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID


def solution_picture(K_p, T_i, Kp, Ti, process, other):
    """Setpoint steps: at the first flow, and at the new flow with the old and with the new settings."""
    old, new, times = PID(K_p, T_i), PID(Kp, Ti), np.linspace(0, 8 * float(T_i), 301)
    loops = {"first flow": Loop(process, old), "new flow, old settings": Loop(other, old)}
    loops |= {"new flow, new settings": Loop(other, new)}
    curves = {name: loop.servo.step(times) for name, loop in loops.items()} | {"setpoint": (1, "setpoint")}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]")
