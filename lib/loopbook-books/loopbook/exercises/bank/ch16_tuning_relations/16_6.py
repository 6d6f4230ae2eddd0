"""The responses of exercise 16.6."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation
from loopbook.pid import PID
from loopbook.transfer import first_order
from loopbook.tuning import simc

__all__ = ["first_order", "oscillation", "simc", "solution_picture"]


def solution_picture(K, T, tau, Kp, Ti, total):
    """The temperature after a step of the load with this factor, and with the usual factor of four."""
    times = np.linspace(0, 10 * float(total), 401)
    curves = {
        name: Loop(first_order(K, T, tau), PID(Kp, time)).regulator.step(times)
        for name, time in {"this factor": Ti, "factor 4": min(T, 4 * total)}.items()
    }
    return time_plot(curves, times, "After a load step of 1 %", "$t$ [min]", "temperature [K]")
