"""Responses in time of a state-space model with delay channels."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.collocation import NODES, follow
from loopbook.deadtime.echoes import ROUNDED
from loopbook.deadtime.family import shared_cells
from loopbook.deadtime.superposition import superpose
from plainmath.validation import increasing, not_negative, one_of, real_numbers, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["ChannelModel", "Response", "response_to_samples", "step_family"]

HOLDS = ("zero order", "first order")
WORTH = 12  # models of the same dead times that are taken together


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: np.ndarray
    B1: np.ndarray
    B2: np.ndarray
    C1: np.ndarray
    C2: np.ndarray
    D11: np.ndarray
    D12: np.ndarray
    D21: np.ndarray
    D22: np.ndarray
    delays: list[Fraction]


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

    def __init__(self, model: ChannelModel, end: float):
        end = not_negative("end", end)
        model = model._replace(delays=[Fraction(delay) for delay in model.delays])
        self.edges, self._coefficients = follow(model, end)

    def __call__(self, times: ArrayLike) -> np.ndarray:
        """Return the values at the given times, at a jump the one after it."""
        times = times_from_zero(times)
        edges = self.edges
        if times.size and times.max() > edges[-1]:
            raise ValueError(f"t = {times.max():g} is later than {edges[-1]:g}, the end of the response")
        # a time that is an edge but for rounding belongs to the segment that begins there
        index = np.searchsorted(edges, times * (1 + float(ROUNDED)), side="right") - 1
        index = np.clip(index, 0, len(edges) - 2)
        length = edges[index + 1] - edges[index]
        return legendre.legval(2 * (times - edges[index]) / length - 1, self._coefficients.T[:, index], tensor=False)

    def quadrature(self, longest: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
        """Return times and weights, two arrays with a row for each interval, for integrals over the response.

        The sum of ``weight * response(time)**2`` is the integral of the square, exact for these polynomials. It goes to
        the last of the edges, which lies beyond the end that was asked for only where a segment begins there.

        Arguments:
            longest: no interval is longer; by itself each is a segment. For integrals of what is not smooth, as of the
                size of an error, short ones are more exact.

        >>> import numpy as np
        >>> one = np.ones((1, 1))
        >>> none = np.zeros((1, 0))
        >>> lag = ChannelModel(-one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
        >>> times, weights = Response(lag, 5).quadrature(longest=0.5)
        >>> times.shape, round(float(weights.sum()), 12)
        ((10, 20), 5.0)
        """
        pieces = np.ceil(np.diff(self.edges) / longest).astype(int).clip(1)
        begin, step = np.repeat([self.edges[:-1], np.diff(self.edges) / pieces], pieces, axis=1)
        edges = np.append(begin + step * np.concatenate([*map(np.arange, pieces)]), self.edges[-1])
        nodes, weights = legendre.leggauss(NODES)
        half = np.diff(edges)[:, None] / 2
        return edges[:-1, None] + half * (nodes + 1), half * weights

    @property
    def coefficients(self) -> np.ndarray:
        """The coefficients of the Legendre polynomials, an array with a row for each segment."""
        return self._coefficients


def response_to_samples(model: ChannelModel, times: ArrayLike, u: ArrayLike, hold: str = "zero order") -> np.ndarray:
    """Return the output at the times of samples of the input, in a time that grows with their number.

    Arguments:
        model: a `ChannelModel`, at rest before the first of the times; the first sample is a step from 0.
        times: an array of times that increase, evenly or not.
        u: the samples, one for each of the times.
        hold: "zero order", each value is kept until the next sample; or "first order", they are joined by straight
            lines.
    Returns:
        An array; the error is about 1e-13 of the largest value.
    Raises:
        ValueError: for arrays that do not fit, another hold, as `Response`; or for uneven times where more than eight
            million pairs of samples had to be taken one by one, as with a step response that jumps hundreds of times.

    >>> import numpy as np
    >>> one = np.ones((1, 1))
    >>> none = np.zeros((1, 0))
    >>> integrator = ChannelModel(0 * one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
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
    late = float(ROUNDED) * 8 * abs(times).max()
    return superpose(response, since, u, hold == "first order", late)


def step_family(models: ChannelModel, times: ArrayLike) -> np.ndarray:
    """Return the step responses of many models of the same shape at the same times.

    Arguments:
        models: a `ChannelModel` whose arrays have one more axis, the first, for the models; its `delays` is an array of
            numbers, a row for each model.
        times: an array of times, not negative.
    Returns:
        An array with a row for each model, in it a value for each of the times, at a jump the one after it. The error
        is below 1e-10 of the largest value up to then. Models with the same dead times are taken together, what is too
        stiff or too long for that, one by one.
    Raises:
        ValueError: for arrays that do not fit, or as `Response`.

    >>> import numpy as np
    >>> gains = np.array([1.0, 2.0]).reshape(2, 1, 1)
    >>> one, none, zero = np.ones((2, 1, 1)), np.zeros((2, 1, 0)), np.zeros((2, 1, 1))
    >>> loops = ChannelModel(zero, one, -gains, gains, one, zero, zero, zero, zero, np.ones((2, 1)))
    >>> step_family(loops, [0.5, 1.5]).round(6)   # of gain/(s + gain*exp(-s))
    array([[0.5  , 1.375],
           [1.   , 2.5  ]])
    """
    times = times_from_zero(times)
    delays = real_numbers("delays", models.delays)
    parts = zip(ChannelModel._fields, models[:-1], strict=False)
    models = ChannelModel(*(real_numbers(name, part) for name, part in parts), delays)
    shape = _family_shape(models)
    count = shape[0]
    flat = times.ravel()
    values = np.empty((count, flat.size))
    rows, member = np.unique(delays, axis=0, return_inverse=True)
    member = member.ravel()
    end = flat.max(initial=0.0)
    for number, row in enumerate(rows):
        exact = [Fraction(repr(delay)) for delay in row.tolist()]  # as it is written
        if any(delay <= 0 for delay in exact):
            raise ValueError(f"the delays of the channels are {row.tolist()}: expected positive ones")
        here = np.flatnonzero(member == number)
        group = ChannelModel(*(array[here] for array in models[:-1]), exact)
        found = np.full((len(here), flat.size), math.nan)
        if len(here) >= WORTH:
            found = shared_cells(group, exact, flat)
        for k in np.flatnonzero(np.isnan(found).any(axis=1)):
            found[k] = Response(ChannelModel(*(array[k] for array in group[:-1]), exact), end)(flat)
        values[here] = found
    return values.reshape(count, *times.shape)


def _family_shape(models):
    """The numbers of models, states and channels, or ValueError where arrays do not fit."""
    shapes = [part.shape for part in models]
    if models.A.ndim == 3 and models.delays.ndim == 2:
        (count, n, _), q = models.A.shape, models.delays.shape[1]
        expected = [(n, n), (n, 1), (n, q), (1, n), (q, n), (1, 1), (1, q), (q, 1), (q, q), (q,)]
        if shapes == [(count, *shape) for shape in expected]:
            return count, n, q
    raise ValueError(f"the arrays of the models have the shapes {shapes}: expected an axis of models before the others")
