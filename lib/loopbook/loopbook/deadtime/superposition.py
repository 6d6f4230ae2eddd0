"""The response to a record of samples as a sum of step responses: by Fourier transform where they come evenly."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.breaking_points import ROUNDED
from loopbook.deadtime.collocation import NODES
from loopbook.deadtime.response import Response, series
from plainmath.validation import increasing, one_of, real_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from loopbook.deadtime.state_space import ChannelModel

__all__ = ["response_to_samples"]

HOLDS = ("zero order", "first order")
MOST_PAIRS = 20_000_000  # of uneven samples, which are taken one by one: about five seconds
CHUNK = 100_000
LEAF = 256  # samples that are taken directly, a power of two


def response_to_samples(model: ChannelModel, times: ArrayLike, u: ArrayLike, hold: str = "zero order") -> np.ndarray:
    """Return the output at the times of samples of the input.

    Arguments:
        model: a `ChannelModel`, at rest before the first of the times; the first sample is a step from 0.
        times: an array of times that increase, evenly or not.
        u: the samples, one for each of the times.
        hold: "zero order", each value is kept until the next sample; or "first order", they are joined by straight
            lines.
    Returns:
        An array; the error is about 1e-13 of the largest value.
    Raises:
        ValueError: for arrays that do not fit, another hold, more than 6,324 uneven times, or as `Response`.

    >>> from loopbook import System, s
    >>> integrator = System(1 / s).state_space()
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0])[1:].round(6)
    array([1., 5.])
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0], hold="first order")[1:].round(6)
    array([1.5, 3.5])
    """
    one_of("the hold", hold, HOLDS)
    times, u = increasing("times", times), real_numbers("values of u", u)
    if u.shape != times.shape:
        raise ValueError(f"u has {u.size} values for {times.size} times")
    since = times - times[0]
    response = Response(model, since[-1])
    if len(times) == 1:
        return u * response(since)
    late = float(ROUNDED) * 8 * abs(times).max()  # how far a difference of times may be from a jump that is meant
    even = np.linspace(0.0, since[-1], len(since))
    is_even = abs(since - even).max() <= late
    times = even if is_even else since
    return (_evenly if is_even else _unevenly)(response, late, times, u, hold == "first order")


def _unevenly(response, late, times, u, lines):
    """The values at times of any distances, as a sum over all pairs of them."""
    count = len(times)
    if count**2 > 2 * MOST_PAIRS:
        most = math.isqrt(2 * MOST_PAIRS)
        raise ValueError(f"the times are {count} at uneven distances: expected even ones, or {most} at the most")
    changes = np.diff(u, prepend=0.0)
    slopes = changes[1:] / np.diff(times)
    total = u[0] * _values(response, times, late) if lines else np.zeros(count)
    rows = max(1, CHUNK // count)
    for begin in range(0, count, rows):
        end = min(begin + rows, count)
        ago = times[begin:end, None] - times[:end]
        if lines:
            total[begin:end] += _integrals(response, np.maximum(ago, 0.0), late) @ slopes[: end - 1]
        else:
            total[begin:end] = _values(response, ago, late) @ changes[:end]
    return total


def _evenly(response, late, times, u, lines):
    """The values at times of one distance, by what a pulse of one sample does."""
    step = _values(response, times, late)
    if not lines:
        return _causal(np.diff(step, prepend=0.0), u)
    # a straight line is a step for each of its moments: means of the step response between samples
    width = times[-1] / (len(times) - 1)
    inside = response.edges[(response.edges > late) & (response.edges < times[-1] - late)] / width
    inside = inside[abs(inside - np.round(inside)) > late / width]
    points = np.union1d(np.arange(len(times)), inside)  # in samples, so that most pieces are exactly one
    nodes, weights = legendre.leggauss(NODES // 2)
    lengths = np.diff(points)
    places = (points[:-1, None] + lengths[:, None] * (nodes + 1) / 2) * width
    integrals = (_values(response, places, late) @ weights) * lengths / 2
    means = np.bincount(points[:-1].astype(int), integrals, len(times) - 1)
    pulses = np.diff(means, prepend=0.0)
    return u[0] * (step - np.r_[0.0, means]) + np.r_[0.0, _causal(pulses, u[1:])]


def _causal(kernel, u):
    """The convolution of two arrays from their beginnings, each value as exact as those up to it are large."""
    from scipy.signal import fftconvolve

    count, result = len(u), np.zeros(len(u))
    for begins in range(0, count, LEAF):
        ends = min(count, begins + LEAF)
        if begins:
            reach = begins & -begins  # of what came before, as much as fits into a power of two
            ends_there = min(count, begins + reach)
            there = fftconvolve(u[begins - reach : begins], kernel[: reach + ends_there - begins])
            result[begins:ends_there] += there[reach : reach + ends_there - begins]
        result[begins:ends] += np.convolve(kernel[: ends - begins], u[begins:ends])[: ends - begins]
    return result


def _values(response, ago, late):
    """The step response so long ago, zero before the beginning."""
    return np.where(ago < -late, 0.0, series(response.coefficients.T, *response.located(ago, late)))


def _integrals(response, ago, late):
    """Its integrals between moments that follow one another along the last axis, from the later to the earlier.

    Within a segment they are counted from its beginning, so that short ones do not get lost in the whole.
    """
    index, places = response.located(ago, late)
    rows = legendre.legint(response.coefficients.T, lbnd=-1) * (np.diff(response.edges) / 2)
    inside, before = series(rows, index, places), np.r_[0.0, np.cumsum(rows.sum(axis=0))][index]
    return -np.diff(inside) - np.diff(before)
