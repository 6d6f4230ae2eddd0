"""Python beside the page of exercise 10.10."""

from functools import lru_cache

import numpy as np
from sympy import Rational

from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.signals import stepwise
from loopbook.transfer import first_order

#: By which factors gain and integral time are wrong.
FACTORS = {
    "gain too high": (Rational("2.4"), 1),
    "gain too low": (Rational("0.22"), 1),
    "integral time too short": (1, Rational("0.3")),
    "integral time too long": (1, 8),
}
_DEAD_TIMES = np.linspace(0, 60, 601)


def minutes(delay):
    """The times of the responses."""
    return _DEAD_TIMES * float(delay) / 60


@lru_cache
def response(ratio, fault):
    """The response of an oven to its setpoint and, 30 dead times later, to a load; the dead time is one."""
    gain, time = FACTORS.get(fault, (1, 1))
    loop = Loop(first_order(1, ratio, 1), PID(ratio * gain / 2, ratio * time))
    return loop.run(_DEAD_TIMES, setpoint=1, load=stepwise(0, {30: Rational(3, 5)}))["y"]


def seen_in(y):
    """The fault that a response shows: by its period, or by how far it has come after five dead times."""
    y = y[_DEAD_TIMES < 30]
    if y.max() < 1.2:
        return "integral time too long" if y[50] > 0.6 else "gain too low"
    up = np.flatnonzero((y[:-1] < 1) & (y[1:] >= 1))
    return "gain too high" if _DEAD_TIMES[up[1]] - _DEAD_TIMES[up[0]] < 6 else "integral time too short"


def _plot(delay, curves):
    panels = [{name: (y, "measurement")} for name, y in curves.items()]
    plot = time_plot(panels, minutes(delay), xlabel="$t$ [min]", ylim=[(-0.1, 2.0)] * len(curves), low=True)
    for name in curves:
        plot.level(1, "setpoint", name)
    return plot.event(float(delay) / 2, "load")


def picture(delay, y_A, y_B, y_C):
    """The temperatures of three loops, counted in setpoint steps, after the step at time zero and a load later."""
    return _plot(delay, {"A": y_A, "B": y_B, "C": y_C})


def solution_picture(ratio, delay):
    """The same loop with the settings that were meant."""
    return _plot(delay, {"as meant": response(ratio, "")})
