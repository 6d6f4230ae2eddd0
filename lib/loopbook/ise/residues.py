"""The residue method in floating point, for one dead time and processes of any order."""

import math
from fractions import Fraction

from loopbook.ise.error import NotApplicableError
from loopbook.ise.residue_method import both_residues

MOST_DIGITS_LOST = 1e-10  # the relative error that residues may have before another method is chosen


def by_residues(fraction):
    """One dead time: minus the sum of Re F(p) over the zeros p of Delta, one of each p and -p (see `ResidueMethod`)."""
    import numpy

    later = {delay for delay in (*fraction.N, *fraction.D) if delay}
    if len(later) > 1:
        raise NotApplicableError("there are different dead times")
    if fraction.pole:
        raise NotApplicableError("Delta has a zero at zero")
    delay = next(iter(later), 0)
    A, B = (parts.get(0, []) for parts in (fraction.D, fraction.N))
    C, D = (parts.get(delay, []) if delay else [] for parts in (fraction.D, fraction.N))
    Delta = [a - c for a, c in zip(_squared(A, len(A)), _squared(C, len(A)), strict=True)]
    lowest, highest = Delta[0], Delta[-1]
    if not lowest or not highest:
        raise NotApplicableError("Delta has a zero at zero or at infinity")
    n = len(Delta) - 1
    # in a unit of time in which the product of the zeros is 1
    square = abs(float(lowest / highest)) ** (1 / n)
    scaled = numpy.array([float(c / lowest) * square**k for k, c in enumerate(Delta)])
    x = numpy.roots(scaled[::-1])
    with numpy.errstate(all="ignore"):
        slope = numpy.polyval(numpy.polyder(scaled[::-1]), x)
        sensitivity = numpy.polyval(abs(scaled[::-1]), abs(x)) / abs(x * slope)
        p = numpy.sqrt(x.astype(complex)) * math.sqrt(square)
        # what polynomials lose where their terms cancel is seen from the sizes of the terms
        A_terms, C_terms = (numpy.polyval([abs(float(c)) for c in part[::-1]], abs(p)) for part in (A, C))
        A, B, C, D, B_mirrored, D_mirrored = (
            numpy.polyval([float(c) for c in part[::-1]], point)
            for part, point in ((A, p), (B, p), (C, p), (D, p), (B, -p), (D, -p))
        )
        z = numpy.exp(-float(delay) * p)
        # dDelta/ds = 2 s dDelta/d(s^2)
        slopes = 2 * p * slope * float(lowest) / square
        shares = both_residues(A, B, C, D, B_mirrored, D_mirrored, z) / ((A + C * z) * slopes)
        total = -float(shares.real.sum())
        near = (A_terms + C_terms * abs(z)) * (1 + abs(p) * float(delay)) / abs(A + C * z)
        lost = 4e-16 * float((abs(shares) * ((1 + sensitivity) ** 2 + near)).sum())
    if not (math.isfinite(total) and lost <= MOST_DIGITS_LOST * total):
        raise NotApplicableError("zeros of Delta lie too close together")
    return total


def _squared(part, length):
    """The coefficients of part(s) part(-s) in s^2, exact."""
    coefficients = [Fraction(0)] * length
    for i, a in enumerate(part):
        for j, b in enumerate(part):
            if (i + j) % 2 == 0:
                coefficients[(i + j) // 2] += a * b * (-1) ** j
    return coefficients
