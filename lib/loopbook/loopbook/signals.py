"""Signals in time: steps, noise and pulses, as expressions or as samples, and what a simulation makes of them.

A signal in time is a number, an expression in `t`, or an array with a value for each sample, held until the next one.
"""

from __future__ import annotations

import bisect
import numbers
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy

from loopbook.laplace import between_steps, evaluate
from loopbook.pid import HOLD
from loopbook.types import ManualStretches, Number, Signal
from plainmath.expressions import exact, t
from plainmath.validation import increasing, is_number, not_negative, positive, real_numbers, whole

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["noise", "pulse_width_modulation", "stepwise"]

CLOSE = 1e-9  # two moments that are this share of a step apart are one, but for rounding


def stepwise(start: Number, changes: Mapping[Any, Number]) -> sympy.Expr:
    """Return a signal that is constant between steps, an expression in `t`.

    Arguments:
        start: its value from the beginning.
        changes: ``{time: new value}``.
    Raises:
        ValueError: for a time or a value that is not a number.

    >>> stepwise(10, {300: 11, 600: 10})
    -Heaviside(t - 600) + Heaviside(t - 300) + 10
    """
    if not isinstance(changes, dict):
        raise ValueError(f"the changes are {changes!r}: expected {{time: new value}}")
    changes = {exact(time): exact(new) for time, new in changes.items()}
    value = total = exact(start)
    for time, new in changes.items():
        if not (is_number(time) and is_number(new)):
            raise ValueError(f"the signal changes to {new} at t = {time}: expected two numbers")
    for time, new in sorted(changes.items()):
        total += (new - value) * sympy.Heaviside(t - time)
        value = new
    return total


def noise(times: ArrayLike, deviation: Number, seed: int | tuple[int, ...]) -> np.ndarray:
    """Return normally distributed random values, one for each time, the same for the same seed.

    Arguments:
        times: the moments, an array; only their number matters.
        deviation: standard deviation, in the unit of the signal.
        seed: an integer that names the sequence.
    Raises:
        ValueError: for a deviation that is negative or no number.

    >>> noise([0, 1, 2], deviation=1, seed=7).round(3)
    array([ 0.001,  0.299, -0.274])
    """
    deviation = not_negative("deviation", deviation)
    for part in seed if isinstance(seed, tuple) else (seed,):
        whole("seed", part, least=0)
    if isinstance(times, str):
        raise ValueError(f"the times are {times!r}: expected an array")
    return np.random.default_rng(seed).normal(0, 1, len(times)) * deviation


def pulse_width_modulation(duty: ArrayLike, times: ArrayLike, period: Number) -> np.ndarray:
    """Return an on/off signal, 1 or 0, that is on for the given share of each cycle. (Haugen, Section 9.1)

    The duty cycle of a cycle is the value of `duty` at its beginning. The signal is known at the given times only, so
    that a pulse lasts to the first of them after its end.

    Arguments:
        duty: the duty cycle in percent, 0 to 100: a number, or an array with a value for each time.
        times: increasing moments, an array.
        period: length of a cycle, in the unit of the times.
    Raises:
        ValueError: for a duty cycle outside 0 to 100 %, a period that is not positive, or unequal lengths.

    >>> pulse_width_modulation(60, [0, 1, 2, 3, 4, 5, 6], period=5)
    array([1, 1, 1, 0, 0, 1, 1])
    """
    times, duty = increasing("times", times), real_numbers("duty cycles", duty)
    positive("period", period)
    if duty.ndim and duty.shape != times.shape:
        raise ValueError(f"the duty cycle has {duty.size} values for {times.size} times")
    if not ((duty >= 0) & (duty <= 100)).all():
        raise ValueError(
            f"the duty cycle is {duty[~((duty >= 0) & (duty <= 100))].ravel()[0]:g} %: expected 0 to 100 %"
        )
    # a moment that rounding puts just before a whole number of cycles begins the next one
    cycle = np.floor((times - times[0]) / period + 1e-9)
    phase = (times - times[0]) / period - cycle
    at_beginning = duty[np.searchsorted(cycle, cycle)] if duty.ndim else duty
    return (phase < at_beginning / 100 - 1e-9).astype(int)


# ---------------------------------------------------------------------------------------- for the simulation


def samples(name: str, signal: Signal, times: ArrayLike) -> list[float]:
    """Return the values of a signal in time at the given times, a list.

    Raises ValueError, which calls the signal by its name, for a wrong length or a value that is no finite number.

    >>> samples("setpoint", stepwise(10, {2: 11}), sympy.sympify("[0, 1, 2]"))
    [10.0, 10.0, 11.0]
    """
    times = np.asarray(times, dtype=float)
    if isinstance(signal, (sympy.Expr, str, numbers.Number)):
        try:
            values = evaluate(exact(signal), times)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    else:
        try:
            values = np.asarray(list(signal), dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{name} is {signal!r}: expected a number, an expression in t or an array") from None
    if values.shape != times.shape:
        raise ValueError(f"{name} has {values.size} values for {times.size} samples")
    if not np.isfinite(values).all():
        when = times[~np.isfinite(values)][0]
        raise ValueError(f"{name} is {values[~np.isfinite(values)][0]} at t = {when:g}: expected finite numbers")
    return values.tolist()


def is_given(signal: object) -> bool:
    """Whether an argument of a simulation is a signal at all, and not None, the number 0 or an empty list.

    >>> [is_given(signal) for signal in (None, 0, [], 0.5, t, np.zeros(3))]
    [False, False, False, True, True, True]
    """
    if signal is None or (is_number(signal) and signal == 0):
        return False
    return not hasattr(signal, "__len__") or len(signal) > 0


def in_time(name: str, signal: Signal, times: np.ndarray) -> PiecewiseSignal:
    """Return a signal in time as an object that knows its value at any moment."""
    step = times[1] - times[0]
    if isinstance(signal, sympy.Expr) and signal.has(t):
        with np.errstate(all="ignore"):
            samples(name, signal, times)  # says what is wrong with it
        stretches = [(max(start, times[0]), f) for start, end, f in between_steps(exact(signal)) if end > times[0]]
        values = [float(f) if f.is_number else _changing(name, f) for _, f in stretches]
        return PiecewiseSignal([start for start, _ in stretches], values, step)
    if is_number(signal):
        return PiecewiseSignal(times[:1], [float(signal)], step)
    return PiecewiseSignal(times, samples(name, signal, times), step)


class PiecewiseSignal:
    """A signal that is one number, or one function of time, from each of its moments to the next.

    Before the first moment it is what its past says, another signal.
    """

    past: PiecewiseSignal | None = None
    values: list[Any]  # numbers, and functions of time

    def __init__(self, times: Iterable[float], values: list[Any], step: float):
        self.times, self.values, self.step = list(times), values, step

    def around(self, time: float) -> float | Callable[[float], float]:
        """A number, or a function of time, that is the signal all around a moment at which it does not jump."""
        n = bisect.bisect_right(self.times, time + CLOSE * self.step + 1e-15 * abs(time)) - 1  # as `last_not_after`
        if n < 0:
            return self.past.around(time)
        return self.values[n] if n < len(self.values) else self.values[-1]

    def at(self, time: float) -> float:
        """The value at a moment; a step has its new value."""
        value = self.around(time)
        return value(time) if callable(value) else value

    def jumps(self) -> list[float]:
        """The moments at which the signal may jump."""
        return (self.past.jumps() if self.past else []) + self.times


def _changing(name, formula):
    """A formula in t as a function that says at which moment it has no value."""
    function = sympy.lambdify(t, formula, "math")

    def value(time):
        try:
            return float(function(time))
        except (ArithmeticError, TypeError, ValueError):
            raise ValueError(f"{name} has no value at t = {time:g}") from None

    return value


def by_hand(manual: ManualStretches, times: Sequence[float] | np.ndarray) -> list[float | None]:
    """For each sample None in automatic mode, else the operator's control signal, `HOLD` for the last one."""
    found = [None] * len(times)
    if not isinstance(manual, (list, tuple)):
        raise ValueError(f"manual is {manual!r}: expected a list of (beginning, end, control signal)")
    for stretch in manual:
        valid = isinstance(stretch, (list, tuple)) and len(stretch) == 3
        if not valid or not all(map(is_number, stretch[:2])) or not (stretch[2] is None or is_number(stretch[2])):
            raise ValueError(f"manual has {stretch!r}: expected (beginning, end, control signal)")
        begin, end, u = stretch
        if begin >= end:
            raise ValueError(f"manual has {stretch!r}: expected the beginning before the end")
        for k, time in enumerate(times):
            if float(begin) <= time < float(end):
                found[k] = HOLD if u is None else float(u)
    return found


def last_not_after(time: float, times: Sequence[float], step: float) -> int:
    """The index of the last of the increasing times that is not after `time`, but for rounding; -1 if there is none."""
    return bisect.bisect_right(times, time + CLOSE * step + 1e-15 * abs(time)) - 1


def beyond_all_numbers(names: str, time: float) -> ValueError:
    """The error of a run that cannot go on."""
    reason = "the system is unstable or a signal infinite, end the run earlier"
    return ValueError(f"{names} grows beyond all numbers before t = {time:g}: {reason}")


def too_many_steps(names: str, most: int, start: float, end: float) -> ValueError:
    """The error of a run whose integration does not come to an end."""
    reason = "an oscillation is too fast for the step, or a signal infinite"
    return ValueError(f"{names} needs more than {most} steps between t = {start:g} and {end:g}: {reason}")
