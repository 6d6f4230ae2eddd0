"""The dominant poles, of a system or a closed loop: those with the largest real parts, of perhaps infinitely many."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.counting import INFINITELY_MANY, ON_LIMIT, characteristic, count_roots, open_loop
from loopbook.stability.difference import prevailing
from plainmath.expressions import s
from plainmath.validation import whole

if TYPE_CHECKING:
    from loopbook.quasipolynomials.fraction import Quasipolynomial

MOST_POINTS = 16_000  # from which Newton's method begins at once
SLOW = 40  # rows of these points below the height of the others, at first
MOST_TRIES = 2  # of a line left of the poles that are wanted


def dominant_poles(loop: object, count: int = 2) -> list[complex]:
    """Return the poles of the closed loop with the largest real parts, for negative feedback around a loop.

    Newton's method finds them, from many points at once. That none is missing is proved: the argument principle counts
    the poles to the right of a line, and the search goes on until it has as many.

    Arguments:
        loop: the open loop, as for `unstable_closed_loop_poles`.
        count: how many poles; a loop without dead time may have fewer, and a complex pair is never divided.
    Returns:
        Complex numbers, the largest real part first, and of a pair the positive imaginary part first. A pole
        stands there as often as it occurs.
    Raises:
        ValueError: as `unstable_closed_loop_poles`; for a count that is no positive integer; where the loop's gain at
            high frequencies returns with a dead time, so that an infinite row of poles comes before the last one
            wanted; or where the poles are not found, with how many are known to be where.

    >>> import sympy
    >>> from loopbook import s
    >>> [complex(round(p.real, 4), round(p.imag, 4)) for p in dominant_poles(sympy.exp(-s) / s)]
    [(-0.3181+1.3372j), (-0.3181-1.3372j)]
    """
    L = open_loop(loop)
    return dominant_roots(characteristic(L), count, f"the closed loop of {L.expr}", L.removable)


def dominant_roots(parts: Quasipolynomial, count: int | None, name: str, removable: int = 0) -> list[complex]:
    """Return the roots of a quasipolynomial with the largest real parts, as `dominant_poles` does.

    Arguments:
        parts: ``{delay: coefficients}``, the lowest power first, with a part without dead time.
        count: how many; None means all of a polynomial, and two where there are infinitely many.
        name: of what has the roots as its poles, for errors.
        removable: how many roots at zero are no poles, because a numerator removes them.
    """
    if count is not None:
        whole("count", count)
    if len(parts) == 1:
        found = _of_polynomial(sympy.Poly(parts[0][removable:][::-1], s))
        count = len(found) if count is None else count
    else:
        count = 2 if count is None else count
        sums = Quasipolynomials.exact(parts, len(parts[0]) - 1, parts[0][-1])
        found = _of_sum(sums, count, name, removable)
    upper = [p for p in found if p.imag >= 0]
    poles = [q for p in sorted(upper, key=lambda p: (-p.real, p.imag)) for q in ([p, p.conjugate()] if p.imag else [p])]
    end = count + 1 if len(poles) > count and poles[count - 1].imag > 0 else count
    return [complex(np.complex128(p)) for p in poles[:end]]


def roots_right_of(sums: Quasipolynomials, left: float, most: int, removable: int = 0) -> list[complex] | None:
    """Return all roots of a stable quasipolynomial to the right of a line, of each pair the upper one.

    So many of those at zero do not count.

    None where they are more than so many, or not found: multiple ones, or some on the line itself.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        shifted = _shifted(sums, left)
    if not np.isfinite(shifted.coefficients).all() or math.isnan(prevailing(shifted.coefficients)[0]):
        return None  # infinite rows of roots come as far as that
    try:
        number = int(count_roots(shifted)[0]) - removable
    except ValueError:
        return None
    if not 0 <= number <= most:
        return None
    found = _inside(sums, left, 0.0, number, removable) if number else []
    right = sum(2 if p.imag else 1 for p in found) == number and len(set(found)) == len(found)
    return found if right else None


def _of_sum(sums, count, name, removable):
    """The roots right of a line that has at least `count` of them on its right."""
    right, left, most = _strip(sums, 1 / float(sums.delays.max()), count, name, removable)
    for attempt in range(1, MOST_TRIES + 1):
        found = _inside(sums, left, right, most, removable)
        number = sum(2 if p.imag else 1 for p in found)
        if number == most:
            return found
        if attempt < MOST_TRIES:  # the line may pass too close to some of them
            left -= 0.07 * attempt * (right - left)
            most = _right_of(sums, left, removable)
    raise ValueError(f"{most} poles of {name} are known to lie right of {left:.6g}, but {number} were found")


def _of_polynomial(polynomial):
    """The roots of a polynomial, multiple ones as exact as others: it is divided into factors without such."""
    return [
        complex(root)
        for factor, multiplicity in polynomial.sqf_list()[1]
        for root in np.roots([float(c / factor.LC()) for c in factor.all_coeffs()])
        for _ in range(multiplicity)
    ]


def _strip(sums, unit, count, name, removable):
    """Real parts right and left of the poles that are wanted, and how many lie between them."""
    right, left = 0.37 * unit, -0.63 * unit  # no round numbers: on these lines poles of made-up loops like to lie
    while _right_of(sums, right, removable):
        right *= 2
    while (most := _right_of(sums, left, removable)) < count:
        left *= 2
    inner = right
    for _ in range(12):  # as few more as possible
        middle = (inner + left) / 2
        try:
            between = _right_of(sums, middle, removable)
        except ValueError:  # too close to a multiple root
            break
        if between < count:
            inner = middle
        else:
            left, most = middle, between
    if most == INFINITELY_MANY:
        raise ValueError(f"an infinite row of poles of {name} comes before the {count} that are wanted")
    return right, left, most


def _right_of(sums, real_part, removable):
    """The number of roots to the right of a line, which moves a little to the left if some lie on it.

    So many at zero do not count.
    """
    for _ in range(5):
        number = int(count_roots(_shifted(sums, real_part))[0])
        if number != ON_LIMIT:
            return number - removable if real_part < 0 and number != INFINITELY_MANY else number
        real_part -= 1e-7 * abs(real_part)
    raise ValueError(f"roots lie too close to the line of the real part {real_part:g}")


def _shifted(sums, real_part):
    """The quasipolynomials as functions of s - real_part."""
    powers = range(sums.order + 1)
    shift = [[math.comb(n, k) * real_part ** (n - k) if n >= k else 0.0 for n in powers] for k in powers]
    coefficients = np.einsum("kn,pnx->pkx", np.array(shift, dtype=float), sums.coefficients)
    return Quasipolynomials(coefficients * np.exp(-sums.delays * real_part)[:, None], sums.delays)


def _inside(sums, left, right, most, removable=0):
    """Roots with real parts from left to right, by Newton's method, from ever finer grids until `most` are found.

    So many at zero are divided out.
    """
    top = float(prevailing(_shifted(sums, left).coefficients)[0])
    if not math.isfinite(top):
        raise ValueError(f"how far the poles right of {left:.6g} reach is not known: expected fewer to be wanted")
    derivative = sums.derivative()
    for refinement in (1, 4, 16):
        rows = refinement * (20 + int(top * float(sums.delays.max()) + 8 * sums.order))
        columns = 6 * refinement
        rows = min(rows, MOST_POINTS // columns)
        slow = np.geomspace(
            1e-3 * min(right - left, top), top, SLOW * refinement
        )  # roots may be of very different sizes
        x, y = np.meshgrid(np.linspace(left, right, columns), np.r_[np.linspace(0, top, rows), slow])
        points, rest = _newton(sums, derivative, (x + 1j * y).ravel(), removable)
        inside = (points.real > left) & (points.real < right) & (points.imag > -1e-9 * top)
        points, rest, size = points[inside], rest[inside], np.maximum(abs(points[inside]), 1e-9 * top)
        there = rest <= 1e-5 * np.minimum(size, right - left)
        points, rest, size = (each[there] for each in (points, rest, size))
        best = np.argsort(rest)
        # of those that have come to one place the best, so that few are left to compare
        _, first = np.unique(np.round(points[best] / (1e-12 * top)), return_index=True)
        best = best[np.sort(first)]
        for close, flat in ((1e-6, 1e-8), (1e-3, 1e-3)):  # rounding scatters what leads to a triple root
            distinct = []
            for k in best:
                p = points[k]
                if all(abs(p - q) > close * size[k] for q in distinct):
                    distinct.append(complex(p.real, 0.0 if abs(p.imag) < flat * size[k] else p.imag))
            apart = [*distinct, *[0j][:removable]]
            found = [p for p in distinct for _ in range(_multiplicity(sums, derivative, p, apart, top))]
            if sum(2 if p.imag else 1 for p in found) == most:
                return found
    return found


def _newton(sums, derivative, points, removable):
    """Where Newton's method leads from many points, and how long its next step would be."""

    def change(points):
        value, slope = sums.at(points), derivative.at(points)
        return value / (slope - removable * value / points if removable else slope)  # zero where it is a root

    moving = np.arange(len(points))
    with np.errstate(all="ignore"):
        for _ in range(60):
            step = change(points[moving])
            points[moving] -= step
            moving = moving[np.isfinite(step) & (abs(step) > 1e-14 * (1 + abs(step.real)))]
            if not len(moving):
                break
        points = points[np.isfinite(points)]
        rest = abs(change(points))
    return points, rest


def _multiplicity(sums, derivative, root, others, top):
    """How often a root occurs: the turns of the phase on a circle around it that leaves out the others."""
    distances = (abs(root - q) for p in others for q in (p, p.conjugate()) if q != root)
    apart = min(distances, default=top)
    circle = min(apart, 1e-2 * top) / 3 * np.exp(2j * math.pi * np.arange(64) / 64)
    with np.errstate(all="ignore"):
        turns = (derivative.at(root + circle) / sums.at(root + circle) * circle).real.mean()
    return max(1, round(float(turns))) if np.isfinite(turns) else 1
