"""The step response of a state-space model with delay channels, as a function of time."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.breaking_points import ROUNDED
from loopbook.deadtime.collocation import NODES, follow
from loopbook.deadtime.state_space import ChannelModel
from plainmath.validation import not_negative, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Response"]


class Response:
    """The step response of a state-space model with delay channels: a polynomial of degree 19 in each segment.

    Where a delayed signal is not smooth, and what comes back from there, is known exactly: at sums of the dead times.
    A segment ends there, until what comes back is smooth to the last digit; then it may be longer than a dead time. Its
    length follows the signals: short where fast modes are excited, longer when they have died out. The error is about
    1e-13 of the largest value up to then.

    Arguments:
        model: a `ChannelModel`; its input is a unit step.
        end: the time up to which the response is wanted.
    Attributes:
        edges: the ends of the segments, an array; the last one is at `end`, or later if a segment begins there.
        coefficients: of the Legendre polynomials, an array with a row for each segment.
    Raises:
        ValueError: for an end that is none; where the response would take about two seconds (60,000 segments with one
            dead time), where its dead times have more than 30,000 sums at which it is not smooth, or where it
            grows beyond all numbers.

    >>> import numpy as np
    >>> one = np.ones((1, 1))
    >>> none = np.zeros((1, 0))
    >>> lag = ChannelModel(-one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
    >>> Response(lag, 5)([0.5, 1]).round(6)
    array([0.393469, 0.632121])
    """

    edges: np.ndarray
    coefficients: np.ndarray

    def __init__(self, model: ChannelModel, end: float):
        end = not_negative("end", end)
        model = model._replace(delays=[Fraction(delay) for delay in model.delays])
        self.edges, self.coefficients = follow(model, end)

    def __call__(self, times: ArrayLike) -> np.ndarray:
        """Return the values at the given times, at a jump the one after it."""
        times = times_from_zero(times)
        if times.size and times.max() > self.edges[-1]:
            raise ValueError(f"t = {times.max():g} is later than {self.edges[-1]:g}, the end of the response")
        # a time that is an edge but for rounding belongs to the segment that begins there
        return series(self.coefficients.T, *self.located(times, times * float(ROUNDED)))

    def located(self, times: np.ndarray, late: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """The segment of each time, that after an edge from a little before it on, and the place in it from -1 to 1."""
        index = np.clip(np.searchsorted(self.edges, times + late, side="right") - 1, 0, len(self.edges) - 2)
        return index, 2 * (times - self.edges[index]) / (self.edges[index + 1] - self.edges[index]) - 1

    def quadrature(self, longest: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
        """Return times and weights, two arrays with a row for each interval, for integrals over the response.

        The sum of ``weight * response(time)**2`` is the integral of the square, exact for these polynomials. It goes to
        the last of the edges, which lies beyond the end that was asked for only where a segment begins there.

        Arguments:
            longest: no interval is longer; by itself each is a segment. For integrals of what is not smooth, as of the
                size of an error, short ones are more exact.

        >>> from loopbook import System, s
        >>> times, weights = System(1 / (s + 1)).step_until(5).quadrature(longest=0.5)
        >>> times.shape, round(float(weights.sum()), 12)
        ((10, 20), 5.0)
        """
        pieces = np.ceil(np.diff(self.edges) / longest).astype(int).clip(1)
        begin, step = np.repeat([self.edges[:-1], np.diff(self.edges) / pieces], pieces, axis=1)
        edges = np.append(begin + step * np.concatenate([*map(np.arange, pieces)]), self.edges[-1])
        nodes, weights = legendre.leggauss(NODES)
        half = np.diff(edges)[:, None] / 2
        return edges[:-1, None] + half * (nodes + 1), half * weights


def series(rows: np.ndarray, index: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The values of Legendre series, those of the columns `index`, by Clenshaw's recursion.

    NumPy's own would have the coefficients of each place in memory.
    """
    high, low = np.zeros_like(places), rows[-1][index]
    for k in range(len(rows) - 2, -1, -1):
        high, low = low, rows[k][index] + (2 * k + 1) / (k + 1) * places * low - (k + 1) / (k + 2) * high
    return low
