"""Responses in time of a state-space model with delay channels."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from loopbook.deadtime.collocation import NODES, follow
from loopbook.deadtime.echoes import ROUNDED
from loopbook.deadtime.superposition import superpose
from loopbook.inputs import one_of, real_numbers, times_from_zero

if TYPE_CHECKING:
    from fractions import Fraction

    import numpy
    from numpy.typing import ArrayLike

__all__ = ["ChannelModel", "Response", "response_to_samples"]

HOLDS = ("zero order", "first order")


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: numpy.ndarray
    B1: numpy.ndarray
    B2: numpy.ndarray
    C1: numpy.ndarray
    C2: numpy.ndarray
    D11: numpy.ndarray
    D12: numpy.ndarray
    D21: numpy.ndarray
    D22: numpy.ndarray
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
        edges: the ends of the segments, an array; the last one is at `end` or later.
    Raises:
        ValueError: for an end that is none; where the response needs more than 60,000 segments, where its dead times
            have more than 30,000 sums at which it is not smooth, or where it grows beyond all numbers.

    >>> import numpy
    >>> one = numpy.ones((1, 1))
    >>> none = numpy.zeros((1, 0))
    >>> lag = ChannelModel(-one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
    >>> Response(lag, 5)([0.5, 1]).round(6)
    array([0.393469, 0.632121])
    """

    edges: numpy.ndarray

    def __init__(self, model: ChannelModel, end: float):
        try:
            end = float(end)
        except (TypeError, ValueError):
            raise ValueError(f"the end is {end!r}: expected a number") from None
        if not 0 <= end < math.inf:
            raise ValueError(f"the end is {end}: expected a finite time, zero or later")
        self.edges, self._coefficients = follow(model, end)
        self.edges[-1] = max(self.edges[-1], end)  # which may differ by rounding

    def __call__(self, times: ArrayLike) -> numpy.ndarray:
        """Return the values at the given times, at a jump the one after it."""
        import numpy
        from numpy.polynomial import legendre

        times = times_from_zero(times)
        edges = self.edges
        if times.size and times.max() > edges[-1]:
            raise ValueError(f"t = {times.max():g} is later than {edges[-1]:g}, the end of the response")
        # a time that is an edge but for rounding belongs to the segment that begins there
        index = numpy.searchsorted(edges, times * (1 + float(ROUNDED)), side="right") - 1
        index = numpy.clip(index, 0, len(edges) - 2)
        length = edges[index + 1] - edges[index]
        return legendre.legval(2 * (times - edges[index]) / length - 1, self._coefficients.T[:, index], tensor=False)

    def quadrature(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Return times and weights, two arrays with a row for each segment, for integrals over the response.

        The sum of weight * response(time)**2 is the integral of the square, exact for these polynomials. It goes to the
        last of the edges, which may lie beyond the end that was asked for.
        """
        import numpy

        nodes, weights = numpy.polynomial.legendre.leggauss(NODES)
        half = numpy.diff(self.edges)[:, None] / 2
        return self.edges[:-1, None] + half * (nodes + 1), half * weights

    @property
    def coefficients(self) -> numpy.ndarray:
        """The coefficients of the Legendre polynomials, an array with a row for each segment."""
        return self._coefficients


def response_to_samples(model: ChannelModel, times: ArrayLike, u: ArrayLike, hold: str = "zero order") -> numpy.ndarray:
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
        ValueError: for arrays that do not fit, another hold, as `Response`; or for uneven times where more than ten
            million pairs of samples had to be taken one by one, as with a step response that jumps hundreds of times.

    >>> import numpy
    >>> one = numpy.ones((1, 1))
    >>> none = numpy.zeros((1, 0))
    >>> integrator = ChannelModel(0 * one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0]).round(6)
    array([0., 1., 5.])
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0], hold="first order").round(6)
    array([0. , 1.5, 3.5])
    """
    import numpy

    one_of("the hold", hold, HOLDS)
    times, u = real_numbers("times", times), real_numbers("values of u", u)
    if times.ndim != 1 or u.shape != times.shape or not len(times) or not (numpy.diff(times) > 0).all():
        raise ValueError(f"{u.size} values of u for {times.size} times: expected one each for times that increase")
    since = times - times[0]
    response = Response(model, since[-1])
    if len(times) == 1:
        return u * response(since)
    late = float(ROUNDED) * 8 * abs(times).max()
    return superpose(response, since, u, hold == "first order", late)
