"""Maps of stability: the number of unstable poles over a plane of two symbols."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from loopbook.quasipolynomials.symbols import with_values
from loopbook.stability.counting import count_closed
from loopbook.transfer import transfer_function
from plainmath.expressions import s
from plainmath.validation import real_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

CHUNK = 2000  # points at once


def stability_map(loop: object, **values: ArrayLike) -> np.ndarray:
    """Return the number of unstable closed-loop poles for many values of two symbols.

    Arguments:
        loop: the open loop L(s), an expression with two symbols, in its coefficients or dead times.
        **values: the values of the two symbols by their names, one-dimensional arrays.
    Returns:
        An array of integers, with a row for each value of the second symbol and a column for each of the first; -1
        on the limit of stability or so close to it that it is not decided, and ``10**9`` where there are infinitely
        many unstable poles.
    Raises:
        ValueError: for other symbols than two with values, a negative dead time, a loop that is improper, or as
            `unstable_roots`.

    >>> import sympy
    >>> K, delay = sympy.symbols("K delay")
    >>> stability_map(K * sympy.exp(-delay * s) / s, K=[1, 2], delay=[0.5, 1, 3])
    array([[0, 0],
           [0, 2],
           [2, 2]])
    """
    L = transfer_function(loop)
    symbols = {str(symbol) for symbol in L.free_symbols - {s}}
    if symbols != set(values) or len(values) != 2:
        raise ValueError(
            f"the loop {L} has the symbols {', '.join(sorted(symbols)) or 'none'}, and there are values for "
            f"{', '.join(values) or 'none'}: expected two symbols, and values for both"
        )
    grids = []
    for name, grid in values.items():
        grids.append(real_numbers(f"values of {name}", grid))
        if grids[-1].ndim != 1:
            raise ValueError(f"the values of {name} are {grid!r}: expected a one-dimensional array")
    points = dict(zip(values, (grid.ravel() for grid in np.meshgrid(*grids)), strict=True))
    A, B = with_values(L, points)
    counts = np.empty(B.count, dtype=int)
    for begin in range(0, counts.size, CHUNK):
        chunk = slice(begin, begin + CHUNK)
        counts[chunk] = count_closed(A[chunk], B[chunk])
    return counts.reshape(len(grids[1]), len(grids[0]))
