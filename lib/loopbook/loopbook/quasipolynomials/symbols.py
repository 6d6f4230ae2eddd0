"""Transfer functions with symbols, for many values of these at once."""

from __future__ import annotations

import functools
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import DelayFraction, Quasipolynomial, plus
from loopbook.quasipolynomials.normal_form import normal_form
from loopbook.transfer import transfer_function
from plainmath.expressions import s
from plainmath.validation import real_numbers

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

__all__ = ["broadcast_values", "fraction_of", "with_values"]


def broadcast_values(values: Mapping[str, ArrayLike]) -> tuple[dict[str, np.ndarray], tuple[int, ...]]:
    """Return the values of symbols as arrays of one dimension and equal length, and the shape that they had together.

    Raises ValueError for what is not real and finite, or shapes that do not fit.
    """
    arrays = {name: real_numbers(f"values of {name}", array) for name, array in values.items()}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"the shapes of the values are {shapes}: expected shapes that fit together") from None
    return {name: np.broadcast_to(array, shape).ravel() for name, array in arrays.items()}, shape


def with_values(H: object, values: Mapping[str, np.ndarray]) -> tuple[Quasipolynomials, Quasipolynomials]:
    """Return numerator and denominator of a transfer function for many values of its symbols.

    Arguments:
        H: a transfer function, whose symbols may also stand in dead times.
        values: an array of values for each symbol, by its name, of one dimension and equal length.
    Raises:
        ValueError: for symbols without values, a negative dead time, or what is no transfer function.

    >>> import numpy as np
    >>> K = sympy.Symbol("K")
    >>> above, below = with_values(K * sympy.exp(-s) / (2 * s + 1), {"K": np.array([1.0, 3.0])})
    >>> above.delays.tolist(), above.coefficients.tolist()
    ([[1.0, 1.0]], [[[1.0, 3.0]]])
    """
    H = transfer_function(H)
    if missing := sorted({str(symbol) for symbol in H.free_symbols - {s}} - set(values)):
        raise ValueError(f"give values for {', '.join(missing)} in {H}")
    count, sides = len(next(iter(values.values()))) if values else 1, []
    for function, parts, powers in _compiled(H, tuple(values)):
        table = np.array([row + np.zeros(count) for row in function(*values.values())])
        coefficients, delays = table[: parts * powers].reshape(parts, powers, count), table[parts * powers :]
        if (delays < 0).any():
            raise ValueError(f"the values make a dead time {delays.min():g}: expected one that is not negative")
        sides.append(Quasipolynomials(coefficients, delays))
    above, below = sides
    return above, below


@functools.lru_cache(maxsize=64)  # the same loop is asked again and again, with other values
def _compiled(H, names):
    """For numerator and denominator: a function of the symbols, and how many parts and powers it returns."""
    # symbols in dead times are ordered as positive ones
    positive = {name: sympy.Symbol(name, positive=True) for name in names}
    found = []
    for side in normal_form(H.xreplace({symbol: positive[str(symbol)] for symbol in H.free_symbols - {s}})):
        side = side or {sympy.S.Zero: sympy.Poly(0, s)}
        order = max(max(part.degree() for part in side.values()), 0)
        rows = [part.coeff_monomial(s**n) for part in side.values() for n in range(order + 1)]
        numbers = sympy.lambdify([*positive.values()], [*rows, *side], "numpy")
        found.append((numbers, len(side), order + 1))
    return found


def fraction_of(above: Quasipolynomials, below: Quasipolynomials, point: int) -> DelayFraction:
    """Return one of many fractions, exact: its coefficients as they are, its dead times as they are written.

    >>> import numpy as np
    >>> K = sympy.Symbol("K")
    >>> fraction_of(*with_values(K * sympy.exp(-s / 10) / (2 * s + 1), {"K": np.array([1.0, 3.0])}), 1)
    DelayFraction(3*exp(-s/10)/(2*s + 1))
    """
    sides: list[Quasipolynomial] = []
    # numbers in floating point are whole ones over a power of two
    rows = [sums.coefficients[..., point % sums.count].tolist() for sums in (above, below)]
    scale = max(c.as_integer_ratio()[1] for side in rows for row in side for c in row)
    for side, sums in zip(rows, (above, below), strict=True):
        parts = zip(side, sums.delays[:, point % sums.count].tolist(), strict=True)
        whole = [{Fraction(repr(delay)): tuple(int(Fraction(c) * scale) for c in row)} for row, delay in parts]
        sides.append(functools.reduce(plus, whole, {}))
    return DelayFraction(*sides)
