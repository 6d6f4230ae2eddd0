"""Transfer functions with symbols: their normal form, and their values for many values of the symbols at once."""

from __future__ import annotations

import functools
import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import (
    INFINITE,
    MOST_MULTIPLES,
    NOT_RATIONAL,
    DelayFraction,
    NoFractionError,
    Quasipolynomial,
    dead_time_of,
    earlier,
    plus,
    rational,
)
from loopbook.transfer import transfer_function
from plainmath.expressions import s
from plainmath.validation import real_numbers

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

__all__ = ["broadcast_values", "fraction_of", "normal_form", "with_values"]


# ------------------------------------------------------------------------------------------------ the normal form


def normal_form(H: object) -> tuple[dict[sympy.Expr, sympy.Poly], dict[sympy.Expr, sympy.Poly]]:
    """Return numerator and denominator of a transfer function, each a sum of polynomials with dead times.

    Common factors are cancelled, also those that contain dead times, if these are multiples of one, up to 60 times it.

    Arguments:
        H: expression in `s`, rational in `s` and in dead times ``exp(-delay*s)``, which may stand anywhere. Other
            symbols are allowed, in delays too. Or a `System`.
    Returns:
        Two dictionaries ``{delay: polynomial}``, the polynomials as SymPy ``Poly`` in `s`. The denominator has a part
        without dead time.
    Raises:
        ValueError: if H is no such fraction, or its output depends on the input of a later time.

    >>> numerator, denominator = normal_form(1 / (s + 2 * sympy.exp(-s)))
    >>> {delay: part.as_expr() for delay, part in denominator.items()}
    {0: s, 1: 2}
    """
    H = transfer_function(H)
    letters = sorted(H.free_symbols - {s}, key=str)
    try:
        if H.has(sympy.oo, sympy.zoo):
            raise NoFractionError(INFINITE)
        powers, delays = _dead_times(H)
        rational_function = H.xreplace(powers).replace(_is_irrational, _rational)
        if not rational_function.is_rational_function(s, *delays, *letters):
            raise NoFractionError(NOT_RATIONAL)
        fraction = sympy.QQ.frac_field(s, *delays, *letters).from_sympy(rational_function)
    except ZeroDivisionError:
        raise ValueError(f"{H} {INFINITE}") from None
    except NoFractionError as reason:
        raise ValueError(f"{H} {reason}") from None
    above, below = (_collected(part, list(delays.values()), letters) for part in (fraction.numer, fraction.denom))
    base = next((d for d in below if all((other - d).is_nonnegative for other in below)), None)
    if base is None:
        raise ValueError(f"the dead times {', '.join(map(str, below))} cannot be ordered: give numbers for symbols")
    above, below = earlier(above, base), earlier(below, base)
    for delay in above:
        if not delay.is_nonnegative:
            raise ValueError(f"{H} contains exp({-delay * s}): a dead time cannot be negative")
    return above, below


def _dead_times(H):
    """Symbols for the dead times in H: {exponential: number times power of a symbol} and {symbol: dead time}.

    Dead times that are multiples of a common one are powers of one symbol, so that common factors are seen.
    """
    families = {}
    for exponential in sorted((e for e in H.atoms(sympy.exp) if e.has(s)), key=str):
        number, delay = dead_time_of(exponential)
        delay = _rational(delay) if delay.is_number else delay
        base = next((base for base in families if sympy.cancel(delay / base).is_Rational), delay)
        families.setdefault(base, []).append((exponential, _rational(number), sympy.cancel(delay / base)))
    powers, delays = {}, {}
    for base, family in families.items():
        ratios = [ratio for *_, ratio in family]
        unit = sympy.Rational(math.gcd(*(r.p for r in ratios)), math.lcm(*(r.q for r in ratios)))
        together = max(map(abs, ratios)) <= MOST_MULTIPLES * unit
        for group in [family] if together else [[member] for member in family]:
            step = unit if together else group[0][-1]
            sign = -1 if (step * base).could_extract_minus_sign() else 1
            symbol = sympy.Dummy()
            delays[symbol] = sign * step * base
            powers |= {exponential: number * symbol ** (sign * ratio / step) for exponential, number, ratio in group}
    return powers, delays


def _is_irrational(e):
    return e.is_number and not e.is_Rational


def _rational(number):
    number = rational(number)
    return sympy.Rational(number.numerator, number.denominator)


def _collected(part, delays, letters):
    """A polynomial in s, symbols for dead times and other symbols, as {delay: polynomial in s}."""
    collected = {}
    for (power, *powers), c in part.terms():
        delay = sympy.expand(sympy.Add(*(n * d for n, d in zip(powers, delays, strict=False))))
        others = sympy.Mul(*(x**n for x, n in zip(letters, powers[len(delays) :], strict=True)))
        terms = collected.setdefault(delay, {})
        terms[power,] = terms.get((power,), 0) + sympy.Rational(c.numerator, c.denominator) * others
    ordered = sorted(collected.items(), key=lambda item: sympy.default_sort_key(item[0]))
    polynomials = [(delay, sympy.Poly.from_dict(terms, s)) for delay, terms in ordered]
    return {delay: polynomial for delay, polynomial in polynomials if not polynomial.is_zero}


# ------------------------------------------------------------------------------------------------ in numbers


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
    lost = ~below.coefficients.any(axis=(0, 1))
    if lost.any():
        these = ", ".join(f"{name} = {row[lost][0]:g}" for name, row in values.items())
        raise ValueError(f"the denominator of {H} vanishes at {these}: expected a transfer function")
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
