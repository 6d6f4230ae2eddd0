"""A denominator with one dead time: the zeros of Delta, and what they prove about stability."""

from __future__ import annotations

import cmath
import functools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

ROUNDING = 2.3e-16
CLEAR = 100.0  # how many times its error a phase has to be away from one that would make a pole on the axis


class Zero(NamedTuple):
    """A zero x = s^2 of Delta, how far it may lie from the true one, and dDelta/dx there, for monic A."""

    x: complex
    radius: float
    slope: complex


class OneDelay:
    """The sum ``A(s) + C(s) exp(-delay*s)``, and Delta = A(s) A(-s) - C(s) C(-s), a polynomial in s^2.

    Arguments:
        A, C: whole coefficients, lowest power first.
        delay: the dead time.
    """

    def __init__(self, A: tuple[int, ...], C: tuple[int, ...], delay: Fraction):
        self.A, self.C, self.delay = A, C, float(delay)
        self.leading = A[-1]

    @functools.cached_property
    def Delta(self) -> list[int]:
        """The coefficients of Delta in s^2, exact."""
        return squared(self.A, self.C)

    @functools.cached_property
    def zeros(self) -> list[Zero] | None:
        """The zeros of Delta in s^2; None where one is at zero, at infinity or not simple in floating point."""
        Delta = self.Delta
        if not Delta[0] or not Delta[-1]:
            return None
        try:
            find = _by_formula if len(Delta) <= 3 else _by_eigenvalues
            return find(Delta, Delta[-1] / self.leading**2)
        except (OverflowError, ZeroDivisionError):
            return None

    @property
    def unstable(self) -> int | None:
        """The number of roots in the right half-plane, or None where floating point does not prove it.

        Without dead time Routh's scheme counts them, in whole numbers. As the dead time grows, roots cross the axis at
        the zeros of Delta on it alone, outwards where abs(A)^2 - abs(C)^2 rises with the frequency, and at dead times
        that the phase of -C/A gives.

        Source: Walton and Marshall, Direct method for TDS stability analysis, IEE Proceedings D 134, 1987.
        """
        A, C, order = self.A, self.C, len(self.A) - 1
        if len(C) > order + 1 or (len(C) == order + 1 and abs(C[-1]) >= abs(A[-1])):
            return None
        count = routh([a + (C[k] if k < len(C) else 0) for k, a in enumerate(A)])
        if count is None or not C:
            return count
        zeros = self.zeros
        if zeros is None:
            return None
        try:
            A, C = ([c / self.leading for c in part] for part in (A, C))
        except OverflowError:
            return None
        for n, (x, radius, slope) in enumerate(zeros):
            if not radius <= 1e-3 * abs(x) or any(abs(x - y.x) <= 2 * (radius + y.radius) for y in zeros[:n]):
                return None
            if x.imag:
                if abs(x.imag) <= radius:
                    return None
                continue
            if x.real > 0:
                continue
            w = math.sqrt(-x.real)
            at_A, at_C = (value(part, 1j * w) for part in (A, C))
            angle, turn = cmath.phase(-at_C / at_A) % (2 * math.pi), w * self.delay
            # of the frequency, of the values and of the products
            error = radius / abs(x) * (turn + sum(_steepness(part, w, at) for part, at in ((A, at_A), (C, at_C))))
            error += ROUNDING * (turn + 2 * math.pi)
            error += ROUNDING * len(A) * sum(size(part, w) / abs(at) for part, at in ((A, at_A), (C, at_C)))
            error *= CLEAR
            passed = (turn - angle) / (2 * math.pi)
            # a crossing at no dead time at all would have been a root on the axis there
            if not (error < 0.1 and error < angle < 2 * math.pi - error and abs(passed - round(passed)) > error):
                return None
            crossings = max(0, math.floor(passed) + 1)
            count += 2 * crossings if slope.real < 0 else -2 * crossings
        return count


def squared(A: tuple[int, ...], C: tuple[int, ...]) -> list[int]:
    """The coefficients of A(s) A(-s) - C(s) C(-s) in s^2, exact."""
    total = [0] * max(len(A), len(C))
    for part, sign in ((A, 1), (C, -1)):
        for i, a in enumerate(part):
            if a:
                for j in range(i % 2, len(part), 2):
                    total[(i + j) // 2] += -sign * a * part[j] if j % 2 else sign * a * part[j]
    return total


def routh(coefficients: list[int]) -> int | None:
    """The number of roots in the right half-plane of a polynomial; None in the singular cases."""
    if not coefficients[-1]:
        return None
    one, other = coefficients[::-1][0::2], coefficients[::-1][1::2]
    count = 0
    while other:
        if not other[0]:
            return None
        count += (one[0] < 0) != (other[0] < 0)
        factor, sign = abs(other[0]), 1 if other[0] > 0 else -1
        below = [
            factor * one[k + 1] - sign * one[0] * (other[k + 1] if k + 1 < len(other) else 0)
            for k in range(len(one) - 1)
        ]
        content = math.gcd(*below) or 1
        one, other = other, [c // content for c in below]
    return count


def _by_formula(Delta: list[int], highest: float) -> list[Zero]:
    """The zeros of a polynomial of degree 0, 1 or 2, whose discriminant is computed in whole numbers."""
    if len(Delta) == 1:
        return []
    if len(Delta) == 2:
        c, b = Delta
        x = -c / b
        return [Zero(x, 4 * ROUNDING * abs(x), highest)]
    c, b, a = Delta
    discriminant = b * b - 4 * a * c
    # over a^2 before the root is taken, since whole numbers may be too large for floating point
    root, middle = math.sqrt(abs(discriminant) / (a * a)), -b / a
    if not root:
        raise ZeroDivisionError
    if discriminant < 0:
        xs = [complex(middle, root) / 2, complex(middle, -root) / 2]
    else:
        large = (middle + math.copysign(root, middle)) / 2
        xs = [large, c / a / large]
        if xs[0] < xs[1]:
            root = -root
        # the difference of the zeros is the root of the discriminant, also where they are close together
    slopes = [root, -root] if discriminant > 0 else [1j * root, -1j * root]
    return [Zero(x, 8 * ROUNDING * abs(x), highest * slope) for x, slope in zip(xs, slopes, strict=True)]


def _by_eigenvalues(Delta: list[int], highest: float) -> list[Zero]:
    """The zeros of a polynomial, with radii of discs in which there is one (Smith 1970, after Gerschgorin)."""
    n, lowest = len(Delta) - 1, Delta[0]
    unit = abs(lowest / Delta[-1]) ** (1 / n)  # where the product of the zeros is 1
    scaled = np.array([c / lowest * unit**k for k, c in enumerate(Delta)])[::-1]
    x = np.roots(scaled)
    powers = abs(x)[:, None] ** np.arange(n, -1, -1)
    with np.errstate(all="ignore"):
        left = abs(np.polyval(scaled, x)) + 4 * n * ROUNDING * (powers @ abs(scaled))
        apart = x[:, None] - x
        np.fill_diagonal(apart, 1)
        slope = apart.prod(axis=1)
        radius = n * left / abs(scaled[0] * slope)
    slope = slope * (highest * unit ** (n - 1))
    return [Zero(*three) for three in zip((x * unit).tolist(), (radius * unit).tolist(), slope.tolist(), strict=True)]


def value(part: Sequence[float], point: complex) -> complex:
    total = 0.0
    for c in reversed(part):
        total = total * point + c
    return total


def size(part: Sequence[float], w: float) -> float:
    """The sum of the sizes of the terms."""
    return float(sum(abs(c) * w**k for k, c in enumerate(part)))


def _steepness(part: Sequence[float], w: float, value: complex) -> float:
    """How many times the relative change of the frequency the phase can change."""
    return float(sum(k * abs(c) * w**k for k, c in enumerate(part)) / abs(value))
