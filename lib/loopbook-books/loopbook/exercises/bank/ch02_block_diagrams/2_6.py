"""Python beside the page of exercise 2.6."""

import math
from types import SimpleNamespace

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises import authoring
from loopbook.figures import time_plot


def _positions(m, D, K, times):
    """The step response of mass, spring and damper, relative to its final value."""
    root = np.sqrt(complex(D**2 - 4 * m * K)) or 1e-6 * D
    p, q = (-D + root) / (2 * m), (-D - root) / (2 * m)
    return 1 + ((q * np.exp(p * times) - p * np.exp(q * times)) / (p - q)).real


def settled(zeta):
    """After which time the step response is within 5 % of its end, for a natural frequency of 1."""
    times = np.linspace(0, 20, 4001)
    return times[np.flatnonzero(abs(1 - _positions(1.0, 2 * float(zeta), 1.0, times)) > 0.05)[-1]]


def response(zeta, omega, t_s):
    """Overshoot, and the largest error from a moment on, in percent of the way, by the library."""
    from loopbook import s
    from loopbook.deadtime import System

    times = np.linspace(0, 5 * float(t_s), 2001)
    y = System(omega**2 / (s**2 + 2 * zeta * omega * s + omega**2)).step(times)
    return SimpleNamespace(overshoot=100 * (y.max() - 1), error=100 * abs(y[times >= float(t_s)] - 1).max())


def enough_damping(key, m, K, t_s):
    """A damping constant that meets both demands."""
    mass, stiffness, end = float(m), 1000 * float(K), float(t_s)

    def overshoot(D):
        zeta = D / (2 * math.sqrt(mass * stiffness))
        return 100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)) if zeta < 1 else 0.0

    def error_after(D):
        times = np.linspace(end, 5 * end, 1001)
        return 100 * float(abs(1 - _positions(mass, D, stiffness, times)).max())

    def way_to_rest(D):
        times = np.linspace(0, 2 * end, 401)
        way = 100 * _positions(mass, max(D, 0.0), stiffness, times)
        signals = {"way to the new position": (way, "measurement")}
        signals["upper limit"] = np.where(times < end, 110, 105), "setpoint"
        signals["lower limit"] = np.where(times < end, np.nan, 95), "setpoint"
        return time_plot(signals, times, f"With $D$ = {D:.4g} N s/m", ylabel="way [%]")

    return authoring.design(
        authoring.number(key, "N s/m", "the damping constant"),
        authoring.criterion("the damping constant is positive", lambda D: D > 0),
        authoring.criterion("the overshoot", overshoot, below=10, unit="%"),
        authoring.criterion(f"the largest error after {written(t_s, 's')}", error_after, below=5, unit="%"),
        draws=way_to_rest,
    )


def picture(m, K):
    """A machine of {m} on springs of {K} and a damper D; a force F presses it down."""
    return draw.mass_spring_damper(f"${written(m)}$ kg", f"${written(K)}$ kN/m", "D", standing=True)
