"""Python beside the page of exercise 2.6."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.deadtime import System
from loopbook.exercises.authoring import criterion, design, number
from loopbook.expressions import s
from loopbook.figures import time_plot


def _way(m, D, K, times):
    """The step response, in percent of its final value, in closed form: it is wanted often."""
    root = np.sqrt(complex(D**2 - 4 * m * K)) or 1e-6 * D
    p, q = (-D + root) / (2 * m), (-D - root) / (2 * m)
    return 100 + 100 * ((q * np.exp(p * times) - p * np.exp(q * times)) / (p - q)).real


def settled(zeta):
    """After which time the step response is within 5 % of its end, for a natural frequency of 1."""
    times = np.linspace(0, 20, 4001)
    return times[np.flatnonzero(abs(_way(1.0, 2 * float(zeta), 1.0, times) - 100) > 5)[-1]]


def by_simulation(m, D, K, t_s):
    """Overshoot, and the largest error from a moment on, in percent of the way."""
    times = np.linspace(0, 5 * float(t_s), 2001)
    y = 100 * System(1000 * K / (m * s**2 + D * s + 1000 * K)).step(times)
    return [y.max() - 100, abs(y[times >= float(t_s)] - 100).max()]


def enough_damping(key, *givens):
    """A damping constant that meets both demands."""
    m, K, end = map(float, givens)
    times = np.linspace(0, 5 * end, 2001)

    def moves(D):
        return _way(m, D, 1000 * K, times)

    def way_to_rest(D):
        signals = {"way to the new position": (moves(max(D, 0.0)), "measurement")}
        signals["upper limit"] = np.where(times < end, 110, 105), "setpoint"
        signals["lower limit"] = np.where(times < end, np.nan, 95), "setpoint"
        shown = {name: (way[:801], role) for name, (way, role) in signals.items()}
        return time_plot(shown, times[:801], f"With $D$ = {D:.4g} N s/m", ylabel="way [%]")

    error = f"the largest error after {written(end, 's')}"
    return design(
        number(key, "N s/m", "the damping constant"),
        criterion("the damping constant is positive", lambda D: D > 0),
        criterion("the overshoot", lambda D: max(moves(D)) - 100, below=10, unit="%"),
        criterion(error, lambda D: max(abs(moves(D)[400:] - 100)), below=5, unit="%"),
        draws=way_to_rest,
    )


def picture(m, K):
    """A machine of {m} on springs of {K} and a damper D; a force F presses it down."""
    return draw.mass_spring_damper(f"${written(m)}$ kg", f"${written(K)}$ kN/m", "D", standing=True)
