"""Signals in time: steps, noise and pulses, as expressions in `t` or as samples."""

import math

import sympy

from loopbook.expressions import exact, t

__all__ = ["noise", "pulse_width_modulation", "stepwise"]


def stepwise(start, changes):
    """Return a signal that is constant between steps, an expression in `t`.

    Arguments:
        start: its value from the beginning.
        changes: ``{time: new value}``.
    Raises:
        ValueError: for a time or a value that is no number.

    >>> stepwise(10, {300: 11, 600: 10})
    -Heaviside(t - 600) + Heaviside(t - 300) + 10
    """
    value = total = exact(start)
    for time, new in sorted((exact(time), exact(new)) for time, new in changes.items()):
        if not (time.is_number and new.is_number):
            raise ValueError(f"the signal changes to {new} at t = {time}: expected two numbers")
        total += (new - value) * sympy.Heaviside(t - time)
        value = new
    return total


def noise(times, deviation, seed):
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
    import numpy

    if not deviation >= 0 or math.isinf(deviation):
        raise ValueError(f"the deviation is {deviation}: expected a number that is not negative")
    return numpy.random.default_rng(seed).normal(0, 1, len(times)) * float(deviation)


def pulse_width_modulation(duty, times, period):
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
    import numpy

    times = numpy.asarray(times, dtype=float)
    duty = numpy.asarray(duty, dtype=float)
    if duty.ndim and duty.shape != times.shape:
        raise ValueError(f"the duty cycle has {duty.size} values for {times.size} times")
    if not ((duty >= 0) & (duty <= 100)).all():
        raise ValueError(
            f"the duty cycle is {duty[~((duty >= 0) & (duty <= 100))].ravel()[0]:g} %: expected 0 to 100 %"
        )
    if not period > 0:
        raise ValueError(f"the period is {period}: expected a positive time")
    # a moment that rounding puts just before a whole number of cycles begins the next one
    cycle = numpy.floor((times - times[0]) / period + 1e-9)
    phase = (times - times[0]) / period - cycle
    at_beginning = duty[numpy.searchsorted(cycle, cycle)] if duty.ndim else duty
    return (phase < at_beginning / 100 - 1e-9).astype(int)
