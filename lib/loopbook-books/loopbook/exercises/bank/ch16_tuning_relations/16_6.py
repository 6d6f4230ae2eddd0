"""The responses of exercise 16.6."""

import numpy as np

from loopbook import PID, Loop, first_order
from loopbook.figures import time_plot


def solution_picture(K, T, tau, Kp, Ti, total):
    """The temperature after a step of the load with this factor, and with the usual factor of four."""
    times, process = np.linspace(0, 10 * float(total), 401), first_order(K, T, tau)
    both = {"this factor": PID(Kp, Ti), "factor 4": PID(Kp, min(T, 4 * total))}
    curves = {name: Loop(process, pid).regulator.step(times) for name, pid in both.items()}
    return time_plot(curves, times, "After a load step of 1 %", "$t$ [min]", "temperature [K]")
