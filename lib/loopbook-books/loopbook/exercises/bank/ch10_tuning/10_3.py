"""Python beside the page of exercise 10.3."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.tuning import simc


def in_parallel_form(process, T_C, c):
    """The settings that the library finds, in parallel form."""
    return simc(process, T_C, c).parallel()


def solution_picture(process, delay, pid, K_ps, T_is, T_ds):
    """The response to a setpoint step with the converted settings, and with the serial numbers typed as they are."""
    times, ways = np.linspace(0, 30 * float(delay), 301), {"converted": pid, "typed as they are": PID(K_ps, T_is, T_ds)}
    curves = {name: Loop(process, way).servo.step(times) for name, way in ways.items()}
    return time_plot({"setpoint": (1, "setpoint")} | curves, times, ylabel="temperature [K]")
