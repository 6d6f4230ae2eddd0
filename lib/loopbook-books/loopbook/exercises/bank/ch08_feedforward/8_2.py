"""Python beside the page of exercise 8.2."""

import numpy as np

from loopbook.expressions import parse
from loopbook.figures import time_plot


def in_numbers(formula, m, D, F_w, v, a):
    """The feedforward with the numbers of the trolley."""
    values = {"m": m, "D": D, "F_w": F_w, "v_SP": v, "a_SP": a}
    return parse(formula).subs({symbol: values[symbol.name] for symbol in parse(formula).free_symbols})


def _setpoint(v, rise):
    times = np.linspace(0, 2 * float(rise), 401)
    return times, np.minimum(times / float(rise), 1) * float(v)


def picture(v, rise):
    """The setpoint of the speed against time: an even rise from zero, then constant."""
    times, speed = _setpoint(v, rise)
    return time_plot({"$v_{SP}$": (speed, "setpoint")}, times, ylabel="speed [m/s]", low=True)


def solution_picture(inertia, D, v, rise, F_w):
    """The force that the feedforward asks for: it rises with the speed, and falls where the rise ends."""
    times, speed = _setpoint(v, rise)
    force = float(inertia) * (times <= float(rise)) + float(D) * speed + float(F_w)
    panels = [{"$v_{SP}$": (speed, "setpoint")}, {"$F_f$": (force, "control signal")}]
    return time_plot(panels, times, ylabel=["speed [m/s]", "force [N]"], low=True)
