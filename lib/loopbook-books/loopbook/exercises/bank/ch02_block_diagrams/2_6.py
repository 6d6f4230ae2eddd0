"""Python beside the page of exercise 2.6."""

import functools
import math

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.deadtime import System
from loopbook.exercises.authoring import criterion, design, number
from loopbook.expressions import s
from loopbook.figures import time_plot


def machine(m, D, K):
    """What a constant force does to the machine, relative to where it ends."""
    return System(1000 * K / (m * s**2 + D * s + 1000 * K))


@functools.lru_cache
def moves(m, D, K):
    """Overshoot, and the time after which it is within 5 %."""
    return machine(m, D, K).step_info(0.05)


def enough_damping(key, m, K, t_s):
    """A damping constant that meets both demands."""

    def way_to_rest(D):
        times = np.linspace(0, 2 * float(t_s), 401)
        signals = {"position": (100 * machine(m, D, K).step(times), "measurement")}
        signals["upper limit"] = np.where(times < float(t_s), 110, 105), "setpoint"
        signals["lower limit"] = np.where(times < float(t_s), np.nan, 95), "setpoint"
        return time_plot(signals, times, f"With $D$ = {D:.4g} N s/m", ylabel="position [%]")

    time = "the time after which the machine stays within 5 %"
    return design(
        number(key, "N s/m", "the damping constant", within=0.2),  # so near to a mistake it is that one
        criterion("the damping constant is positive", lambda D: D > 0),
        criterion("the overshoot", lambda D: 100 * moves(m, D, K).overshoot if D > 0 else math.inf, below=10, unit="%"),
        criterion(time, lambda D: moves(m, D, K).settling_time if D > 0 else math.inf, below=float(t_s), unit="s"),
        draws=way_to_rest,
    )


def picture(m, K):
    """A machine of {m} on springs of {K} and a damper D; a force F presses it down."""
    return draw.mass_spring_damper(f"${written(m)}$ kg", f"${written(K)}$ kN/m", "D", standing=True)
