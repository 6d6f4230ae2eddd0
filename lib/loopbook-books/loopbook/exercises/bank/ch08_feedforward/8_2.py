"""Python beside the page of exercise 8.2."""

import numpy as np

from loopbook.figures import time_plot


def picture(v, rise):
    """The setpoint of the speed against time: an even rise from zero, then constant."""
    speed = {"$v_{SP}$": (np.array([0, v, v], float), "setpoint")}
    return time_plot(speed, [0, rise, 2 * rise], ylabel="speed [m/s]", low=True)


def solution_picture(rise, F_w, F_rise, F_after):
    """The force that the feedforward asks for: it rises with the speed, and falls where the rise ends."""
    force = np.array([F_rise - F_after + F_w, F_rise, F_after, F_after], float)
    times = [0, rise, 1.0001 * rise, 2 * rise]
    return time_plot({"$F_f$": (force, "control signal")}, times, ylabel="force [N]", low=True)
