"""Integral criteria from the exact response, followed until the rest is negligible."""

import numbers
from typing import NamedTuple

from loopbook.deadtime import System
from loopbook.expressions import s
from loopbook.quasipolynomials import read

from loopbook.ise.error import ErrorFraction, NotApplicableError, error_of

__all__ = ["Criteria", "criteria"]

DIFFERENTIATOR = read(s)
SMALLEST_TOLERANCE = 1e-12  # smaller ones are lost in rounding, and the response would be followed for ever
NEGLIGIBLE = 1e-12  # the share of the integral that may be left when a response is cut off


class Criteria(NamedTuple):
    """Integrals of the error e(t), or of its size, with and without the time as a weight: what `criteria` returns."""

    ISE: float
    IAE: float
    ITAE: float
    ITSE: float


def criteria(process, controller=None, mode="servo", from_setpoint=None, tolerance=1e-9):
    """Return four integral criteria of the control error after a unit step, from the exact response.

    The response is a polynomial in each of its segments. The integrals of abs(e) are those between its zeros, so that
    nothing is approximated but the rest beyond a time after which it does not matter: it is followed twice as far until
    the later half adds less than the tolerance to each integral. A tail that is below 1e-11 of the error and very much
    slower than the rest may be overlooked.

    Arguments:
        process, controller, mode, from_setpoint: as for `ise`.
        tolerance: the share of each integral that may be left out, 1e-12 or more.
    Returns:
        `Criteria`: the integrals of e^2, abs(e), t abs(e) and t e^2.
    Raises:
        UnstableLoopError, ValueError: as `ise`; or where the response lasts too long to be followed.

    >>> [round(value, 6) for value in criteria(1 / s, 1)]
    [0.5, 1.0, 1.0, 0.25]
    """
    if not isinstance(tolerance, numbers.Real) or not SMALLEST_TOLERANCE <= tolerance < 1:
        raise ValueError(f"the tolerance is {tolerance!r}: expected a number from {SMALLEST_TOLERANCE:g} to 1")
    fraction = ErrorFraction.of(error_of(process, controller, mode, from_setpoint))
    if fraction is None:
        return Criteria(0.0, 0.0, 0.0, 0.0)
    return Criteria(*map(float, _followed(fraction, _four_integrals, tolerance)))


def _four_integrals(response):
    """The integrals over each segment of e^2, abs(e), t abs(e) and t e^2."""
    import numpy
    from numpy.polynomial import legendre

    times, weights = response.quadrature()
    e = response(times)
    table = numpy.stack([e**2, abs(e), times * abs(e), times * e**2])
    table = (table * weights).sum(axis=2).T
    nodes, their_weights = legendre.leggauss(e.shape[1])
    coefficients = response.coefficients
    # only where the mean is not larger than all the rest can there be a zero
    for k in numpy.flatnonzero(abs(coefficients[:, 0]) <= abs(coefficients[:, 1:]).sum(axis=1)):
        row = numpy.trim_zeros(coefficients[k], "b")
        zeros = legendre.legroots(row) if len(row) > 1 else numpy.array([])
        zeros = numpy.sort(zeros.real[(abs(zeros.imag) < 1e-6) & (abs(zeros.real) < 1)])
        if not len(zeros):
            continue
        edges = numpy.r_[-1, zeros, 1]
        half = numpy.diff(edges)[:, None] / 2
        local = edges[:-1, None] + half * (nodes + 1)
        length = response.edges[k + 1] - response.edges[k]
        size = abs(legendre.legval(local, row)) * half * their_weights * length / 2
        table[k, 1:3] = size.sum(), (size * (response.edges[k] + length / 2 * (local + 1))).sum()
    return table


def by_response(fraction):
    def squares(response):
        times, weights = response.quadrature()
        return (weights * response(times) ** 2).sum(axis=1, keepdims=True)

    try:
        return float(_followed(fraction, squares, NEGLIGIBLE)[0])
    except ValueError as reason:
        raise NotApplicableError(str(reason)) from None


def _followed(fraction, integrals, tolerance):
    """Integrals over the response, followed twice as far until the later half adds nothing that matters."""
    e = System(fraction.fraction * DIFFERENTIATOR)
    end = 4 * float(sum(fraction.fraction.delays)) + 16 / fraction.speed
    while True:
        response = e.step_until(end)
        table = integrals(response)
        total, later = table.sum(axis=0), table[response.edges[1:] > end / 2].sum(axis=0)
        if (later <= tolerance * total).all():
            return total
        end *= 2
