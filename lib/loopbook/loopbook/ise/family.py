"""The integral of the squared error of many loops at once: residues in arrays."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.ise.error import UnstableLoopError
from loopbook.ise.loops import integral_of_square
from loopbook.ise.residues import sums_of_residues
from loopbook.quasipolynomials import DelayFraction
from loopbook.quasipolynomials.fraction import Quasipolynomial, plus
from loopbook.stability.counting import ON_LIMIT, count_roots

if TYPE_CHECKING:
    from loopbook.quasipolynomials.arrays import Quasipolynomials

__all__ = ["ise_family"]


def ise_family(above: Quasipolynomials, below: Quasipolynomials) -> np.ndarray:
    """Return the integrals of e(t)^2 for many errors ``E = above/below`` of one form, as for settings of a controller.

    With one dead time or none at a point, residues are computed for all points at once, each with the bound of the
    digits that it loses. Points that fail it, or have several dead times, are left to `integral_of_square`.

    Returns:
        An array with a value for each point; ``math.inf`` where E has poles in the right half-plane or on the axis.
    Raises:
        ValueError: as `integral_of_square`.
    """
    count = max(above.count, below.count)
    parts = [
        np.broadcast_to(x, (*x.shape[:-1], count)) for sums in (above, below) for x in (sums.coefficients, sums.delays)
    ]
    counts = np.broadcast_to(count_roots(below), count)
    # a pole at zero may be cancelled, and without its highest power a denominator has another order
    left = (counts == ON_LIMIT) | (parts[2][0, -1] == 0)
    values = np.where(left, math.nan, np.where(counts > 0, math.inf, sums_of_residues(*parts)))
    for point in np.flatnonzero(np.isnan(values)):
        values[point] = _alone(*(x[..., point] for x in parts))
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
