"""The integral of the squared error of many loops at once: residues in arrays."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.ise.error import UnstableLoopError
from loopbook.ise.loops import integral_of_square
from loopbook.ise.one_delay import CLEAR, ROUNDING
from loopbook.ise.residue_method import both_residues
from loopbook.ise.residues import MOST_DIGITS_LOST
from loopbook.quasipolynomials import DelayFraction
from loopbook.quasipolynomials.fraction import Quasipolynomial, plus

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["ise_family"]


def ise_family(
    numerators: ArrayLike, numerator_delays: ArrayLike, denominators: ArrayLike, denominator_delays: ArrayLike
) -> np.ndarray:
    """Return the integrals of e(t)^2 for many errors E(s) of one form, as for the settings of a controller.

    With one dead time or none at a point, residues and the proof of stability are computed for all points at once, each
    with the bound of the digits that it loses. Points that fail it, or have several dead times, are left to
    `integral_of_square`.

    Arguments:
        numerators, denominators: coefficients of E, arrays [part, power, point], the lowest power first.
        numerator_delays, denominator_delays: the dead time of each part, arrays [part] or [part, point].
    Returns:
        An array with a value for each point; ``math.inf`` where E has poles in the right half-plane or on the axis.
    Raises:
        ValueError: for arrays that do not fit, numbers that are not finite, or as `integral_of_square`.

    >>> import numpy as np
    >>> k = np.array([0.1, 1, 1.5, 2])    # E = 1/(s + k exp(-s))
    >>> ise_family([[1 + 0 * k]], [0], [[0 * k, 1 + 0 * k], [k, 0 * k]], [0, 1]).round(6)
    array([5.526778, 1.704112, 9.412751,      inf])
    """
    above, below = (np.asarray(x, dtype=float) for x in (numerators, denominators))
    if above.ndim != 3 or below.ndim != 3 or above.shape[2] != below.shape[2]:
        raise ValueError(
            f"the coefficients have the shapes {above.shape} and {below.shape}: expected part, power, point"
        )
    points = above.shape[2]
    delays = []
    for name, given, parts in (("numerators", numerator_delays, above), ("denominators", denominator_delays, below)):
        each = np.asarray(given, dtype=float)
        if each.ndim == 1:
            each = each[:, None]
        if each.ndim != 2 or len(each) != len(parts) or each.shape[1] not in (1, points):
            raise ValueError(f"the delays of {name} have the shape {each.shape}: expected one for each part and point")
        delays.append(np.broadcast_to(each, (len(parts), points)))
    if not all(np.isfinite(x).all() for x in (above, below, *delays)) or any((x < 0).any() for x in delays):
        raise ValueError("the coefficients and dead times are expected to be finite, and the dead times not negative")
    values = np.full(points, math.nan)
    if points:
        with np.errstate(all="ignore"):
            values = _together(above, delays[0], below, delays[1])
    for point in np.flatnonzero(np.isnan(values)):
        values[point] = _alone(*(x[..., point] for x in (above, delays[0], below, delays[1])))
    return values


def _alone(above, above_delays, below, below_delays) -> float:
    # numbers in floating point are whole ones over a power of two
    scale = max(c.as_integer_ratio()[1] for rows in (above, below) for c in rows.ravel().tolist())
    E = DelayFraction(_exact(above, above_delays, scale), _exact(below, below_delays, scale))
    try:
        return integral_of_square(E)
    except UnstableLoopError:
        return math.inf


def _exact(rows, delays, scale: int) -> Quasipolynomial:
    """A sum times a scale that makes its coefficients whole numbers."""
    total: Quasipolynomial = {}
    for row, delay in zip(rows.tolist(), delays.tolist(), strict=True):
        whole = [int(Fraction(c) * scale) for c in row]
        while whole and not whole[-1]:
            whole.pop()
        if whole:
            total = plus(total, {Fraction(delay): tuple(whole)})
    return total


def _together(above, above_delays, below, below_delays):
    """The integrals by residues; inf where it is proved that there is none, nan where nothing is."""
    points = below.shape[2]
    used = [(delays > 0) & part.any(axis=1) for part, delays in ((above, above_delays), (below, below_delays))]
    every = np.concatenate([np.where(u, d, 0) for u, d in zip(used, (above_delays, below_delays), strict=True)])
    delay = every.max(axis=0)
    fits = ((every == 0) | (every == delay)).all(axis=0)
    order = below.shape[1] - 1
    (A, C), (B, D) = (
        [(part * which[:, None]).sum(axis=0) for which in (~late, late)]
        for part, late in ((below, used[1]), (above, used[0]))
    )
    while order and not (A[order].any() or C[order].any()):
        order -= 1
    A, C = A[: order + 1], C[: order + 1]
    # powers of s that all have in common
    while order and len(B) > 1 and not any(part[0].any() for part in (A, C, B, D)):
        A, B, C, D, order = A[1:], B[1:], C[1:], D[1:], order - 1
    leading = A[-1]
    fits &= (leading != 0) & (abs(C[-1]) < abs(leading))
    fits &= ~(B[order:].any(axis=0) | D[order:].any(axis=0))
    A, B, C, D = (part / leading for part in (A, B, C, D))
    if not order:
        return np.full(points, math.nan)
    Delta, sizes = np.zeros((order + 1, points)), np.zeros((order + 1, points))
    for part, sign in ((A, 1), (C, -1)):
        for i in range(order + 1):
            for j in range(i % 2, order + 1, 2):
                product = part[i] * part[j]
                Delta[(i + j) // 2] += sign * (-1) ** j * product
                sizes[(i + j) // 2] += abs(product)
    x, radius, slope = _zeros(Delta, sizes)
    x, radius = np.where(np.isfinite(x), x, math.nan), np.where(np.isfinite(radius), radius, math.inf)
    fits &= np.isfinite(x).all(axis=0) & (radius <= 1e-3 * abs(x)).all(axis=0)
    known, unstable = _unstable(A, C, delay, x, radius, slope, fits & (Delta[0] != 0))
    p = np.sqrt(x.astype(complex))
    at_A, at_B, at_C, at_D = (_value(part, p) for part in (A, B, C, D))
    z = np.exp(-delay * p)
    close = at_A + at_C * z
    shares = both_residues(at_A, at_B, at_C, at_D, _value(B, -p), _value(D, -p), z) / (close * 2 * p * slope)
    total = -shares.real.sum(axis=0)
    terms = _value(abs(A), abs(p)) + _value(abs(C), abs(p)) * abs(z)
    near = terms * (1 + abs(p) * delay) / abs(close)
    sensitivity = radius / abs(x) / (4 * order**2 * ROUNDING)
    lost = 4e-16 * (abs(shares) * ((1 + sensitivity) ** 2 + near * (1 + sensitivity))).sum(axis=0)
    right = np.isfinite(total) & (lost <= MOST_DIGITS_LOST * total)
    return np.where(known & (unstable > 0), math.inf, np.where(known & right, total, math.nan))


def _value(part, x):
    """The values of polynomials, one for each point, the lowest power first."""
    total = 0.0
    for row in part[::-1]:
        total = total * x + row
    return total


def _zeros(coefficients, sizes):
    """The zeros of polynomials, their radii as in `OneDelay`, and the slopes there: arrays [zero, point]."""
    n, points = len(coefficients) - 1, coefficients.shape[1]
    unit = abs(coefficients[0] / coefficients[-1]) ** (1 / n)
    unit = np.where((unit > 0) & np.isfinite(unit), unit, 1.0)
    powers = np.arange(n + 1)[:, None]
    scaled = coefficients / coefficients[-1] * unit ** (powers - n)
    sizes = sizes / abs(coefficients[-1]) * unit ** (powers - n)
    scaled = np.where(np.isfinite(scaled).all(axis=0), scaled, (powers == n) * 1.0 + (powers == 0))
    if n == 1:
        x = -scaled[:1].astype(complex)
    else:
        companion = np.zeros((points, n, n))
        companion[:, np.arange(1, n), np.arange(n - 1)] = 1
        companion[:, :, -1] = -scaled[:-1].T
        x = np.linalg.eigvals(companion).T.astype(complex)
    derivative = scaled[1:] * powers[1:]
    step = _value(scaled, x) / _value(derivative, x)
    x = np.where(abs(step) < 1e-6 * abs(x), x - step, x)
    apart = x[:, None] - x[None]
    apart[np.arange(n), np.arange(n)] = 1
    slope = apart.prod(axis=1)
    left = abs(_value(scaled, x)) + 4 * n * ROUNDING * _value(sizes, abs(x))
    radius = n * left / abs(slope)
    return x * unit, radius * unit, slope * coefficients[-1] * unit ** (n - 1)


def _unstable(A, C, delay, x, radius, slope, known):
    """Whether the number of roots in the right half-plane is known, and the number, as in `OneDelay.unstable`."""
    together = A + C
    roots, their_radius, _ = _zeros(together, abs(A) + abs(C))
    known = known & (abs(roots.real) > their_radius).all(axis=0) & np.isfinite(roots).all(axis=0)
    count = (roots.real > 0).sum(axis=0)
    late = delay > 0
    apart = abs(x[:, None] - x[None]) > 2 * (radius[:, None] + radius[None])
    apart[np.arange(len(x)), np.arange(len(x))] = True
    known = known & (~late | apart.all(axis=(0, 1)))
    # a zero whose disc meets the real axis alone is real
    real = abs(x.imag) <= radius
    known = known & (~late | (~real | (abs(x.imag) <= 4 * ROUNDING * abs(x))).all(axis=0))
    crossing = real & (x.real < 0) & late
    w = np.sqrt(np.where(crossing, -x.real, 1.0))
    at_A, at_C = _value(A, 1j * w), _value(C, 1j * w)
    angle, turn = np.angle(-at_C / at_A) % (2 * math.pi), w * delay
    error = radius / abs(x) * turn + ROUNDING * (turn + 2 * math.pi)
    powers = np.arange(len(A))[:, None]
    for part, at in ((A, at_A), (C, at_C)):
        error += radius / abs(x) * _value(powers * abs(part), w) / abs(at)
        error += ROUNDING * len(A) * _value(abs(part), w) / abs(at)
    error *= CLEAR
    passed = (turn - angle) / (2 * math.pi)
    clear = (error < 0.1) & (error < angle) & (angle < 2 * math.pi - error)
    clear &= abs(passed - np.rint(passed)) > error
    known = known & (clear | ~crossing).all(axis=0)
    crossings = np.maximum(0, np.floor(passed) + 1) * crossing
    count = count + (np.where(slope.real < 0, 2, -2) * np.where(crossing, crossings, 0)).sum(axis=0)
    return known, count
