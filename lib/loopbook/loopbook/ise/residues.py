"""The residue method in numbers, for one dead time and processes of any order, with more digits where it needs them."""

from __future__ import annotations

import cmath
import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.ise.error import ErrorFraction, NotApplicableError
from loopbook.ise.one_delay import ROUNDING, OneDelay, size, squared, value
from loopbook.ise.residue_method import both_residues

if TYPE_CHECKING:
    from collections.abc import Sequence

    import mpmath

MOST_DIGITS_LOST = 1e-11  # the relative error that residues may have before they are taken with more digits
DIGITS = 120
APART = 40  # digits after which coefficients are changed, so that multiple zeros come apart
MOST_ORDER = 30  # of a denominator, for which zeros are sought with that many digits
MOST_STEPS = 300


def by_residues(fraction: ErrorFraction) -> float:
    """One dead time: minus the sum of Re F(p) over the zeros p of Delta, one of each p and -p (see `ResidueMethod`)."""
    later = {delay for delay in (*fraction.N, *fraction.D) if delay}
    if len(later) > 1:
        raise NotApplicableError("there are different dead times")
    delay = next(iter(later), Fraction(0))
    parts = fraction.D.get(0, ()), fraction.N.get(0, ())
    parts += (fraction.D.get(delay, ()), fraction.N.get(delay, ())) if delay else ((), ())
    total = None
    if not fraction.pole:
        one_delay = fraction.one_delay if len(fraction.D) > 1 or not delay else OneDelay(parts[0], (), delay)
        total = _in_floating_point(one_delay, *parts)
    return _with_many_digits(parts, delay, fraction.pole, fraction.mean_speed) if total is None else total


def _in_floating_point(one_delay: OneDelay, *parts: Sequence[int]) -> float | None:
    """The sum; None if too many digits are lost."""
    zeros = one_delay.zeros
    if zeros is None:
        return None
    delay, total, lost = one_delay.delay, 0.0, 0.0
    try:
        A, B, C, D = ([c / one_delay.leading for c in part] for part in parts)
        for x, radius, slope in zeros:
            p = cmath.sqrt(x)
            at_A, at_B, at_C, at_D = (value(part, p) for part in (A, B, C, D))
            z = cmath.exp(-delay * p)
            below = at_A + at_C * z
            # dDelta/ds = 2 s dDelta/d(s^2)
            share = both_residues(at_A, at_B, at_C, at_D, value(B, -p), value(D, -p), z) / (below * 2 * p * slope)
            total -= share.real
            # what polynomials lose where their terms cancel is seen from the sizes of the terms
            terms = size(A, abs(p)) + size(C, abs(p)) * abs(z)
            near = terms * (1 + abs(p) * delay) / abs(below)
            sensitivity = radius / abs(x) / (4 * len(zeros) ** 2 * ROUNDING)
            lost += 4e-16 * abs(share) * ((1 + sensitivity) ** 2 + near * (1 + sensitivity))
    except (OverflowError, ZeroDivisionError):
        return None
    return total if math.isfinite(total) and lost <= MOST_DIGITS_LOST * total else None


def _with_many_digits(parts: tuple[Sequence[int], ...], delay: Fraction, pole: int, unit: float) -> float:
    """The same with so many digits that zeros which coincide may be drawn apart, and a pole at zero from zero."""
    import mpmath

    order = len(parts[0]) - 1
    if order + pole > MOST_ORDER:
        raise NotApplicableError(f"Delta has more than {MOST_ORDER} zeros")
    with mpmath.workdps(DIGITS):
        tiny, leading = mpmath.mpf(10) ** -APART, mpmath.mpf(parts[0][-1])
        # in a unit of time in which the numbers are of one size
        A, B, C, D = (
            [c / leading * mpmath.mpf(unit) ** (k - order - more) for k, c in enumerate(part)]
            for part, more in zip(parts, (0, pole, 0, pole), strict=True)
        )
        late = mpmath.mpf(delay.numerator) / delay.denominator * unit
        for _ in range(pole):
            A, C = (
                [a + tiny * b for a, b in zip([0, *part], [*part, 0], strict=True)] if part else part for part in (A, C)
            )
        A = [c * (1 + tiny * math.sin(1 + 2 * k)) for k, c in enumerate(A)]
        Delta = squared(A, C)
        derivative = [k * c for k, c in enumerate(Delta)][1:]
        total, largest = mpmath.mpf(0), mpmath.mpf(0)
        for x in _zeros(Delta):
            p = mpmath.sqrt(x)
            at_A, at_B, at_C, at_D, B_mirrored, D_mirrored, slope = (
                mpmath.polyval(part[::-1], point) if part else mpmath.mpf(0)
                for part, point in ((A, p), (B, p), (C, p), (D, p), (B, -p), (D, -p), (derivative, x))
            )
            z = mpmath.exp(-late * p)
            share = both_residues(at_A, at_B, at_C, at_D, B_mirrored, D_mirrored, z)
            share /= (at_A + at_C * z) * 2 * p * slope
            total -= share.real
            largest = max(largest, abs(share))
        if not (total > 0 and largest < total * mpmath.mpf(10) ** (DIGITS - APART - 20)):
            raise NotApplicableError("zeros of Delta lie too close together")
        return float(total * unit)


def _zeros(polynomial: list[mpmath.mpf]) -> list[mpmath.mpc]:
    """All zeros of a polynomial with simple ones, lowest power first, by the method of Ehrlich and Aberth."""
    import mpmath

    n = len(polynomial) - 1
    largest = max(map(abs, polynomial))
    starts = np.roots([float(c / largest) for c in reversed(polynomial)])
    if len(starts) < n:
        raise NotApplicableError("Delta has a zero at infinity")
    x = [
        mpmath.mpmathify(complex(start)) * (1 + mpmath.mpf("1e-9") * mpmath.expjpi(0.3 + k))
        for k, start in enumerate(starts)
    ]
    x = [p if p else mpmath.mpf("1e-9") * (k + 1) for k, p in enumerate(x)]
    row, slopes = polynomial[::-1], [k * c for k, c in enumerate(polynomial)][:0:-1]
    end = mpmath.mpf(10) ** (50 - DIGITS)  # zeros that nearly coincide are not sharper
    for _ in range(MOST_STEPS):
        moved = False
        for k, p in enumerate(x):
            slope = mpmath.polyval(slopes, p)
            step = mpmath.polyval(row, p)
            if not step:
                continue
            step = step / (slope - step * sum(1 / (p - q) for m, q in enumerate(x) if m != k))
            x[k] = p - step
            moved = moved or abs(step) > end * abs(p)
        if not moved:
            return x
    raise NotApplicableError("the zeros of Delta were not found")
