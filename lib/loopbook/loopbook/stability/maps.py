"""Maps of stability: the number of unstable poles over a plane of two symbols."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.quasipolynomials import normal_form
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.counting import count_roots
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
        on the limit of stability, and ``10**9``, where there are infinitely many unstable poles.
    Raises:
        ValueError: for other symbols than two with values, a negative dead time, a loop that is improper or loses its
            highest power at a point, or as `unstable_roots`.

    >>> K, delay = sympy.symbols("K delay")
    >>> stability_map(K * sympy.exp(-delay * s) / s, K=[1, 2], delay=[0.5, 1, 3])
    array([[0, 0],
           [0, 2],
           [2, 2]])
    """
    L = transfer_function(loop)
    symbols = {str(symbol): symbol for symbol in L.free_symbols - {s}}
    if set(symbols) != set(values) or len(values) != 2:
        raise ValueError(
            f"the loop {L} has the symbols {', '.join(sorted(symbols)) or 'none'}, and there are values for "
            f"{', '.join(values) or 'none'}: expected two symbols, and values for both"
        )
    grids = []
    for name, grid in values.items():
        grids.append(real_numbers(f"values of {name}", grid))
        if grids[-1].ndim != 1:
            raise ValueError(f"the values of {name} are {grid!r}: expected a one-dimensional array")
    # symbols in dead times are ordered as positive ones
    positive = {name: sympy.Symbol(name, positive=True) for name in values}
    parts = _characteristic(L.xreplace({symbols[name]: positive[name] for name in values}))
    order = parts[0].degree()
    rows = [part.coeff_monomial(s**n) for part in parts.values() for n in range(order + 1)]
    numbers = sympy.lambdify([positive[name] for name in values], [*rows, *parts], "numpy", cse=True)
    points = [grid.ravel() for grid in np.meshgrid(*grids)]
    counts = np.empty(points[0].size, dtype=int)
    for begin in range(0, counts.size, CHUNK):
        chunk = slice(begin, begin + CHUNK)
        here = [x[chunk] for x in points]
        found = [row + 0.0 * here[0] for row in numbers(*here)]
        coefficients, delays = np.array(found[: len(rows)]), np.array(found[len(rows) :])
        if (delays < 0).any():
            raise ValueError(f"the values make a dead time {delays.min():g}: expected one that is not negative")
        coefficients = coefficients.reshape(len(parts), order + 1, -1)
        if (lost := np.flatnonzero(coefficients[0, -1] == 0)).size:
            where = ", ".join(f"{name} = {x[lost[0]]:g}" for name, x in zip(values, here, strict=True))
            raise ValueError(f"the closed loop of {L} loses its highest power at {where}: expected other values")
        counts[chunk] = count_roots(Quasipolynomials(coefficients, delays))
    return counts.reshape(len(grids[1]), len(grids[0]))


def _characteristic(L):
    """The quasipolynomial A + B whose roots are the poles of the closed loop of L = A/B, with symbols."""
    above, below = normal_form(L)
    order = below[0].degree()
    for part in (*above.values(), *below.values()):
        if part.degree() > order:
            raise ValueError(
                f"{L} is improper: it has s**{part.degree()} over s**{order}; expected no more zeros than poles"
            )
    parts = dict(below)
    for delay, part in above.items():
        parts[delay] = parts.get(delay, 0) + part
    if 0 not in parts or parts[0].degree() < order:
        raise ValueError(f"the algebraic loop of {L} has no solution: its gain at infinite frequency is -1")
    return parts
