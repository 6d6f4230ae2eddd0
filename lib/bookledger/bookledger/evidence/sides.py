"""The two sides of a comparison: numbers, formulas, texts and rows of them, as they are read, compared and written.

Numbers are exact fractions. Two of them are equal where they differ by no more than rounding, and the larger one is
larger by more than that. Of expressions SymPy proves the order; where it cannot, that is said, and nothing is guessed.
"""

from __future__ import annotations

import decimal
import functools
import itertools
import math
from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from typing import Any, TypeAlias

import sympy
from sympy.core.function import AppliedUndef

from bookledger.evidence.values import formulas_agree, in_one_line, number
from plainmath.expressions import exact

#: A number, which may be infinite; a formula; a text; or several of these in a row.
Side: TypeAlias = Fraction | float | sympy.Expr | sympy.Equality | str | tuple
#: How a formula is written into a sentence.
Typeset: TypeAlias = Callable[[Any], str]

ROUNDING = Fraction(1, 10**9)  # what equal numbers may differ by, as a share of the larger one
_DIGITS = (3, 4, 6, 9, 12, 15)
_OPEN = (sympy.Integral, sympy.Subs, sympy.DiracDelta, sympy.Sum, sympy.Product)  # what may be equal unseen


class EvidenceError(ValueError):
    """What is no evidence: one sentence that names the value and what was expected."""


# ----------------------------------------------------------------------------------------------------------- reading


def numbers(*values: object) -> tuple[Fraction | float, ...]:
    """Return real numbers of any kind as exact fractions, infinite ones as floats; or raise EvidenceError."""
    return tuple(_number(value) for value in values)


def numbers_or_expressions(*values: object) -> tuple[Side, ...]:
    """Return values of which the larger one can be asked for: numbers, or expressions if one of them is.

    A decimal beside an expression is exact, as it is meant. Raises EvidenceError for anything else.
    """
    if any(isinstance(value, sympy.Expr) and not _is_number(value) for value in values):
        return _of_one_language(*(_expression(value) for value in values))
    return numbers(*values)


def anything(*values: object) -> tuple[Side, ...]:
    """Return values of which one can ask whether they are equal; a row for each if one of them is a row.

    If one of them is a set or a mapping, the order of a row does not count.
    """
    if any(isinstance(value, Collection) and not isinstance(value, str | sympy.Basic) for value in values):
        rows = [_row(value) for value in values]
        if any(isinstance(value, frozenset | set | Mapping) or _is_view(value) for value in values):
            rows = [tuple(sorted(row, key=lambda item: text(item, 15))) for row in rows]
        return tuple(rows)
    if any(isinstance(value, str) for value in values):
        return tuple(_text(value) for value in values)
    if any(isinstance(value, sympy.Equality) for value in values):
        return _of_one_language(*(_expression(value) for value in values))
    return numbers_or_expressions(*values)


def _is_view(value):
    return isinstance(value, type({}.keys()) | type({}.items()))


def _is_number(value):
    try:
        number(value)
    except (TypeError, ArithmeticError):
        return False
    return True


def _number(value):
    if isinstance(value, sympy.Basic) and value.has(sympy.Integral, sympy.Sum):
        value = value.doit()
        if value.has(sympy.Integral, sympy.Sum):
            raise EvidenceError(f"{_short(value)} has no value in closed form: expected a number")
    try:
        return number(value)
    except (TypeError, ArithmeticError) as error:
        raise EvidenceError(f"evidence needs a real number, got {error}") from None


def _expression(value):
    if isinstance(value, bool) or not isinstance(value, sympy.Expr | sympy.Equality):
        _number(value)  # a sentence for what is not a number
    if isinstance(value, sympy.Basic) and value.has(sympy.Float):
        raise EvidenceError(f"{_short(value)} holds rounded decimals: give exact numbers")
    if isinstance(value, sympy.Basic) and value.has(sympy.nan, sympy.zoo, sympy.AccumBounds):
        raise EvidenceError(f"{_short(value)} has no value")
    return value if isinstance(value, sympy.Equality) else exact(value)


def _of_one_language(*values):
    """Expressions, in none of which two symbols have the same name."""
    names: dict[str, sympy.Symbol] = {}
    for symbol in itertools.chain.from_iterable(value.free_symbols for value in values):
        if names.setdefault(symbol.name, symbol) != symbol:
            raise EvidenceError(f"two different symbols named {symbol.name}: declare {symbol.name} once")
    return values


def _text(value):
    if not isinstance(value, str):
        raise EvidenceError(f"{_short(value)} beside a text: expected two texts")
    if value in ("True", "False"):
        raise EvidenceError(f"a truth value as text, {value}: hand over what decides it")
    return in_one_line(str.__str__(value))


def _row(value):
    if isinstance(value, str | bytes) or not isinstance(value, Collection):
        raise EvidenceError(f"{_short(value)} beside several values: expected as many")
    try:
        items = [f"{key}: {item}" for key, item in value.items()] if isinstance(value, Mapping) else [*value]
    except TypeError:
        raise EvidenceError(f"{_short(value)} is not a row of values") from None
    if isinstance(value, Mapping):
        for item in value.values():
            anything(item)  # a truth value is refused here, too
        return tuple(map(_text, items))
    return tuple(anything(item)[0] for item in items)


def _short(value):
    shown = in_one_line(repr(value))
    return shown if len(shown) <= 60 else shown[:57] + "..."


# --------------------------------------------------------------------------------------------------------- comparing


def order(left: Fraction | float, right: Fraction | float) -> int:
    """Return 1 where the first of two numbers is larger, -1 where it is smaller, 0 where rounding is all that differs.

    >>> order(Fraction(2), Fraction(1)), order(Fraction(1), Fraction(1)), order(Fraction(1), math.inf)
    (1, 0, -1)
    """
    if math.inf in (abs(left), abs(right)):
        return (left > right) - (left < right)
    if abs(left - right) <= ROUNDING * max(abs(left), abs(right)):
        return 0
    return 1 if left > right else -1


@functools.cache
def proved(left: sympy.Expr, relation: str, right: sympy.Expr) -> bool:
    """Say whether a relation > < ≥ ≤ is between two expressions, by proof.

    Raises EvidenceError where SymPy knows neither that it is nor that it is not.
    """
    holds, fails = {
        ">": ("is_positive", "is_nonpositive"),
        "<": ("is_negative", "is_nonnegative"),
        "≥": ("is_nonnegative", "is_negative"),
        "≤": ("is_nonpositive", "is_positive"),
    }[relation]
    difference = left - right
    for simpler in (sympy.factor, lambda x: sympy.factor(sympy.together(x)), sympy.simplify):
        found = simpler(difference)
        if getattr(found, holds):
            return True
        if getattr(found, fails):
            return False
    raise EvidenceError(f"the sign of {_short(difference)} is not known: expected numbers, or symbols that decide it")


@functools.cache
def equality(left: Side, right: Side) -> str:
    """Say how two values are equal: ``"exact"``, ``"proved"``, ``"probed"``; empty where they are not.

    Raises EvidenceError for formulas with integrals and the like that nothing decides about.
    """
    if isinstance(left, tuple):
        if len(left) != len(right):
            return ""
        found = [equality(a, b) if _alike(a, b) else "" for a, b in zip(left, right, strict=True)]
        return min(found, key=["", "probed", "proved", "exact"].index, default="exact")
    if isinstance(left, str):
        return "exact" if left == right else ""
    if isinstance(left, sympy.Basic):
        how = formulas_agree(left, right)
        if not how and _is_open(left, right):
            raise EvidenceError(f"whether {_short(left)} is {_short(right)} is not decided: expected closed forms")
        return how
    return "" if order(left, right) else "exact"


def _alike(a, b):
    kinds = (str, tuple, sympy.Basic)
    return [isinstance(a, kind) for kind in kinds] == [isinstance(b, kind) for kind in kinds]


def _is_open(left, right):
    """Whether formulas hold what may be equal though it looks different."""
    if isinstance(left, sympy.Equality) != isinstance(right, sympy.Equality):
        return False
    parts = sympy.Tuple(left, right).doit()
    if parts.has(*_OPEN):
        return True
    calls = itertools.combinations(parts.atoms(AppliedUndef), 2)
    return any(a.func == b.func and all(map(formulas_agree, a.args, b.args)) for a, b in calls)


# ----------------------------------------------------------------------------------------------------------- writing


def texts(values: Collection[Side], unit: str = "", typeset: Typeset = str, apart: bool = True) -> list[str]:
    """Return values as text, numbers with the unit, and with enough digits to show their order if it is wanted."""
    digits = next((digits for digits in _DIGITS if not apart or _is_told(values, digits)), _DIGITS[-1])
    space = "" if unit in ("°", "'") else " "
    return [
        text(value, digits, typeset) + (f"{space}{unit}" if unit and isinstance(value, Fraction) and value else "")
        for value in values
    ]


def _is_told(values, digits):
    """Whether the texts of numbers are in the order of the numbers."""
    return all(
        order(a, b) == order(Fraction(text(a, digits)), Fraction(text(b, digits)))
        for a, b in itertools.pairwise(values)
        if isinstance(a, Fraction) and isinstance(b, Fraction)
    )


def text(value: Side, digits: int = 3, typeset: Typeset = str) -> str:
    """A value as text, a number with so many significant digits."""
    if isinstance(value, tuple):
        return ", ".join(text(item, max(digits, 6), typeset) for item in value) or "none"
    if isinstance(value, str):
        return value
    if isinstance(value, sympy.Basic):
        return str(value) if value.is_Integer else typeset(value)
    return rounded(value, digits)


def rounded(value: Fraction | float, digits: int = 3) -> str:
    """A number with so many significant digits, without an exponent where it is of usual size; integers as they are.

    >>> rounded(Fraction(200, 3)), rounded(Fraction(1234)), rounded(Fraction(1, 3000)), rounded(math.inf)
    ('66.7', '1234', '0.000333', '∞')
    >>> rounded(Fraction(10) ** 400), rounded(Fraction(12345, 10))
    ('1e+400', '1230')
    """
    if value in (math.inf, -math.inf):
        return "∞" if value > 0 else "-∞"
    if value.denominator == 1 and abs(value) < 10**6:
        return str(value)
    with decimal.localcontext(prec=digits):
        found = (decimal.Decimal(value.numerator) / value.denominator).normalize()
    if Fraction(1, 10**4) <= abs(value) < 10**6:
        return f"{found:f}"
    digits, _, exponent = f"{found:e}".partition("e")
    return f"{digits}e{exponent}"


def data(*values: Side, decides: Callable[..., bool] = lambda *values: True) -> list[Any]:
    """Return values as JSON data, numbers with as many digits as it takes to see the verdict in them, six at least.

    Arguments:
        values: numbers, formulas, texts or rows.
        decides: whether numbers that are rounded so far lead to the same verdict.
    """
    for digits in (6, 9, 12, 15):
        told = [_as_data(value, digits) for value in values]
        if not all(isinstance(value, Fraction) for value in values):
            break
        read = [Fraction(found) for found in told]
        if decides(*read) and all(
            order(a, b) == (c > d) - (c < d)
            for (a, b), (c, d) in zip(itertools.pairwise(values), itertools.pairwise(read), strict=True)
        ):
            break
    return told


def _as_data(value, digits):
    if isinstance(value, tuple):
        return [_as_data(item, digits) for item in value]
    if isinstance(value, sympy.Equality):
        return f"{value.lhs} = {value.rhs}"
    if isinstance(value, str | sympy.Basic):
        return str(value)
    if value in (math.inf, -math.inf):
        return "oo" if value > 0 else "-oo"
    with decimal.localcontext(prec=digits):
        return f"{(decimal.Decimal(value.numerator) / value.denominator).normalize():g}"


def kind_of(*values: Side) -> str:
    """What is compared: "numbers", "formulas" or "texts", which rows count as."""
    if any(isinstance(value, str | tuple) for value in values):
        return "texts"
    return "formulas" if any(isinstance(value, sympy.Basic) for value in values) else "numbers"
