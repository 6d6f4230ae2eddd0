"""The integral of the squared error of many loops at once: residues in arrays."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.integrals.error import UnstableLoopError
from loopbook.integrals.loops import integral_of_square
from loopbook.integrals.residues import sums_of_residues
from loopbook.quasipolynomials.symbols import fraction_of
from loopbook.stability.counting import ON_LIMIT, count_roots
from loopbook.stability.enclosures import UndecidedError

if TYPE_CHECKING:
    from loopbook.quasipolynomials.arrays import Quasipolynomials

__all__ = ["ise_family"]


def ise_family(above: Quasipolynomials, below: Quasipolynomials) -> np.ndarray:
    """Return the integrals of e(t)^2 for many errors ``E = above/below`` of one form, as for settings of a controller.

    With one dead time or none at a point, residues are computed for all points at once, each with the bound of the
    digits that it loses. Points that fail it, or have several dead times, are left to `integral_of_square`.

    Returns:
        An array with a value for each point; ``math.inf`` where E has poles in the right half-plane or on the axis, nan
        where that is not decided.
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
        try:
            values[point] = integral_of_square(fraction_of(above, below, point))
        except UnstableLoopError:
            values[point] = math.inf
        except UndecidedError:
            values[point] = math.nan
    return values
