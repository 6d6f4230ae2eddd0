"""Integral criteria from the exact response, followed until its slowest modes are left, and those in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime import System
from loopbook.deadtime.step_info import zeros_of
from loopbook.integrals.error import ErrorFraction, NotApplicableError, error_of
from loopbook.integrals.modes import FEW_MODES, MOST_MODES, ManyModesError, slow_modes
from loopbook.quasipolynomials import read
from plainmath.expressions import s
from plainmath.validation import number

if TYPE_CHECKING:
    from loopbook.deadtime import Response

__all__ = ["Criteria", "criteria"]

DIFFERENTIATOR = read(s)
SMALLEST_TOLERANCE = 1e-12  # smaller ones are lost in rounding, and the response would be followed forever
NEGLIGIBLE = 1e-11  # the share of the integral that may be left when a response is cut off
MOST_SEGMENTS = 16_000  # of a response that is followed
EARLY = 400  # segments from which it pays to ask for the modes at once
GONE = 30.0  # the exponent after which a mode has decayed below what floating point holds


class Criteria(NamedTuple):
    """Integrals of the error e(t), or of its size, with and without the time as a weight: what `criteria` returns."""

    ISE: float
    IAE: float
    ITAE: float
    ITSE: float


def criteria(
    process: object,
    controller: object = None,
    mode: str = "servo",
    from_setpoint: object = None,
    tolerance: float = 1e-9,
) -> Criteria:
    """Return four integral criteria of the control error after a unit step, from the exact response.

    The response is a polynomial in each of its segments. The integrals of abs(e) are those between its zeros. What
    comes after a certain time is the sum of a few modes, of which the argument principle proves that they are all that
    have not decayed by then, and which have to agree with the response before it: their integrals are known in closed
    form, also that of abs(e), as a geometric series of half periods, when one mode is left. So the response need not be
    followed for long where the loop is hardly damped.

    Arguments:
        process, controller, mode, from_setpoint: as for `ise`.
        tolerance: the share of each integral that may be left out, 1e-12 or more.
    Returns:
        `Criteria`: the integrals of e^2, abs(e), t abs(e) and t e^2.
    Raises:
        UnstableLoopError, ValueError: as `ise`; or where the response lasts too long to be followed: with more than
            16,000 segments before few modes are left, or several modes that last too long together.

    >>> [round(value, 6) for value in criteria(1 / s, 1)]
    [0.5, 1.0, 1.0, 0.25]
    """
    range_ = f"a number from {SMALLEST_TOLERANCE:g} to 1"
    tolerance = number("tolerance", tolerance, range_, lambda x: SMALLEST_TOLERANCE <= x < 1)
    fraction = ErrorFraction.of(error_of(process, controller, mode, from_setpoint))
    if fraction is None:
        return Criteria(0.0, 0.0, 0.0, 0.0)
    return Criteria(*map(float, _followed(fraction, tolerance, sizes=True)))


def by_response(fraction: ErrorFraction) -> float:
    try:
        return float(_followed(fraction, NEGLIGIBLE, sizes=False)[0])
    except ValueError as reason:
        raise NotApplicableError(str(reason)) from None


# ---- over the segments of a response


def _four_integrals(response: Response, sizes: bool) -> np.ndarray:
    """The integrals over each segment of e^2, abs(e), t abs(e) and t e^2, those of abs(e) only where wanted."""
    times, weights = response.quadrature()
    squares = response(times) ** 2 * weights
    plain, weighted = _of_sizes(response) if sizes else np.zeros((2, len(squares)))
    return np.stack([squares.sum(axis=1), plain, weighted, (times * squares).sum(axis=1)], axis=1)


def _of_sizes(response: Response) -> tuple[np.ndarray, np.ndarray]:
    """The integrals over each segment of abs(e) and t abs(e), between the zeros of the polynomials."""
    rows, edges = response.coefficients, response.edges
    half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    # the integral of e from the left end, and by parts that of x e, x being -1 there and 1 at the right end
    once = legendre.legint(rows.T, lbnd=-1)
    twice = legendre.legint(once, lbnd=-1)
    whole = once.sum(axis=0)
    found = np.sign(whole) * np.array([whole, whole - twice.sum(axis=0)])
    for k in np.flatnonzero(abs(rows[:, 0]) <= abs(rows[:, 1:]).sum(axis=1)):
        x = np.r_[-1.0, np.sort(zeros_of(rows[k])), 1.0]
        plain = legendre.legval(x, once[:, k])
        pieces = np.diff([plain, x * plain - legendre.legval(x, twice[:, k])])
        found[:, k] = pieces @ np.sign(pieces[0])
    return found[0] * half, (found[0] * middle + found[1] * half) * half


# ---- and beyond


def _followed(fraction: ErrorFraction, tolerance: float, sizes: bool) -> np.ndarray:
    """Integrals over the response, followed twice as far until what comes later is known or does not matter."""
    e = System(fraction.fraction * DIFFERENTIATOR)
    delays = fraction.fraction.delays
    end, enough = 2 * float(max(delays, default=0)) + 8 / fraction.speed, 4 * float(sum(delays)) + 16 / fraction.speed
    number, reason = 0, ""
    while True:
        response = e.step_until(end)
        table = _four_integrals(response, sizes)
        total, later = table.sum(axis=0), table[response.edges[1:] > end / 2].sum(axis=0)
        # the first time, it may only be that an error within a dead time has not begun to move
        negligible = bool((later <= tolerance * total).all())
        if negligible or number or len(response.edges) > EARLY:
            rest, reason = _beyond(fraction, response, total, tolerance, sizes)
            if rest is not None:
                return total + rest
        if negligible and end >= enough:
            return total
        if 2 * len(response.edges) > MOST_SEGMENTS:
            left = max(b / a for a, b in zip(total, later, strict=True) if a)
            raise ValueError(
                f"the response up to t = {end:g} needs more than {MOST_SEGMENTS // 2} segments, its later half adds "
                f"{left:.0e} of an integral, and {reason}: expected an error that decays sooner"
            )
        end, number = 2 * end, number + 1


def _beyond(
    fraction: ErrorFraction, response: Response, total: np.ndarray, tolerance: float, sizes: bool
) -> tuple[np.ndarray | None, str]:
    """The integrals from the end of a response on, or None and the reason why they are not known."""
    end = float(response.edges[-1])
    rate = GONE / end
    modes = slow_modes(fraction, rate, MOST_MODES if len(response.edges) > EARLY else FEW_MODES)
    if modes is None:
        return None, "the modes that last longer are many, or were not found"
    modes = modes.later(-float(fraction.earliest))
    late = np.append(response.edges[:-2] >= 0.9 * end, True)
    times = response.quadrature()[0][late]
    apart = float(abs(response(times) - modes(times)).max())
    rest_modes = modes.later(end)
    square, square_later = rest_modes.squares()
    found = np.array([square, 0.0, 0.0, end * square + square_later])
    if sizes:
        lead, lead_later = (bounds.max(initial=0.0) for bounds in rest_modes.bounds())
        lead_later += end * lead
        allowed = tolerance / 20 * (total[1] + lead / 2), tolerance / 20 * (total[2] + lead_later / 2)
        try:
            found[1:3] = rest_modes.sizes(end, allowed)
        except ManyModesError:
            return None, "several modes that hardly decay last too long together"
    # what is no mode decays at that rate or faster
    size = float((rest_modes.weights * abs(rest_modes.residues)).sum())
    plain, weighted = apart / rate, apart * (end / rate + 1 / rate**2)
    error = np.array([(2 * size + apart) * plain, plain, weighted, (2 * size + apart) * weighted])
    if not (error <= tolerance / 2 * (total + found))[: 4 if sizes else 1].all():
        return None, f"what the modes leave of it, {apart:.0e}, has not decayed"
    return found, ""
