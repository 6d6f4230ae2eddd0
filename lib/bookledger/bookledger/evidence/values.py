"""Values as they are compared: numbers exactly or by their digits, formulas by proof, names by the word."""

from __future__ import annotations

import decimal
import fractions
import keyword
import math
import numbers
import re
from typing import TypeAlias

import sympy

from plainmath.expressions import agreement, exact, parse

NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]{1,3})?")


#: A formula that a book prints: an expression, or an equation.
Formula: TypeAlias = sympy.Expr | sympy.Equality


def in_one_line(text: str) -> str:
    """The same text in one line."""
    return " ".join(text.split())


def half_unit(printed: str) -> fractions.Fraction:
    """Half a unit of the last printed digit, which is how far a value may lie from the print, as an exact fraction.

    >>> half_unit("1.50"), half_unit("2e-3"), half_unit("1500")
    (Fraction(1, 200), Fraction(1, 2000), Fraction(1, 2))
    """
    return fractions.Fraction(1, 2) * fractions.Fraction(10) ** decimal.Decimal(printed).as_tuple().exponent


def number(value: object) -> fractions.Fraction | float:
    """Return a real number of any usual type as an exact fraction, or as a float where it is infinite.

    Raises TypeError, saying what the value is instead, for anything that is not one real number.
    """
    if isinstance(value, bool) or type(value).__name__ == "bool":
        raise TypeError(f"a truth value, {value}")
    if isinstance(value, sympy.Basic):
        return _sympy_number(value)
    if isinstance(value, numbers.Real | decimal.Decimal) and type(value).__name__ != "timedelta64":
        if value != value:
            raise TypeError("not a number (NaN)")
        if value in (math.inf, -math.inf):
            return float(value)
        # unlike a detour over float, this is exact for every precision that NumPy and decimal know
        ratio = value.as_integer_ratio() if hasattr(value, "as_integer_ratio") else float(value).as_integer_ratio()
        return fractions.Fraction(*map(int, ratio))
    if isinstance(value, numbers.Complex) and not isinstance(value, numbers.Real):
        raise TypeError(f"a complex number, {value}")
    raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")


def _sympy_number(value):
    if value in (sympy.oo, -sympy.oo):
        return float(value)
    if not isinstance(value, sympy.Expr) or value.has(sympy.nan, sympy.zoo):
        raise TypeError(f"not a number, {_shortened(value)}")
    if value.free_symbols or not value.is_number:
        raise TypeError(f"the expression {_shortened(value)}")
    if not value.is_Rational:
        # 60 certain digits, also where large numbers cancel
        real, imaginary = _parts(value.evalf(60, maxn=1000))
        if not (real.is_Float or real.is_Rational) or not real.is_finite:
            raise TypeError(f"the expression {_shortened(value)}")
        if imaginary != 0:
            raise TypeError(f"a complex number, {_shortened(value)}")
        # beyond every print, and as a fraction perhaps beyond the memory
        if abs(real) > sympy.Float("1e2000"):
            raise TypeError(f"a number beyond 1e2000, {_shortened(value)}")
        value = sympy.Rational(real if abs(real) > sympy.Float("1e-2000") else 0)
    return fractions.Fraction(int(value.p), int(value.q))


def _parts(digits):
    """The real and the imaginary part of an evaluated number, 0 where SymPy found no certain digit.

    That is how it marks a zero, as in the imaginary parts of the three real roots of a cubic.
    """
    return [sympy.S.Zero if part.is_Float and part._prec == 1 else part for part in digits.as_real_imag()]


def _shortened(value, length=60):
    text = in_one_line(repr(value))
    return text if len(text) <= length else text[: length - 3] + "..."


def formula(value: object, real: str = "") -> Formula:
    """Return a computed formula as a SymPy expression or equation, in the symbols of `plainmath.expressions.parse`.

    A symbol is known by its name alone, and of either sign if it is among `real`. What a computation assumed about it
    is dropped, except that it is an integer: otherwise a symbol declared as zero or even could make a false formula
    true.

    Raises TypeError, saying what the value is instead, for anything else, and for one with rounded decimals, which
    no proof can start from.
    """
    if isinstance(value, numbers.Number) and not isinstance(value, bool):
        # a decimal alone, as 1.5, is meant as it is written
        finite = isinstance(value, int | float) and math.isfinite(value)
        value = exact(value) if finite else sympy.sympify(value)
    if not isinstance(value, sympy.Expr | sympy.Equality) or getattr(value, "is_Matrix", False):
        raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")
    if value.has(sympy.Float):
        raise TypeError(f"{_shortened(value)}, which holds rounded decimals: give exact numbers")
    symbols = {}
    for symbol in sorted(value.free_symbols, key=str):
        if symbol.name in {known.name for known in symbols}:
            raise TypeError(f"two different symbols named {symbol.name}: declare {symbol.name} once")
        symbols[symbol] = _letter(symbol, real)
    value = value.xreplace(symbols)
    if not isinstance(value, sympy.Expr | sympy.Equality) or value.has(sympy.nan, sympy.zoo, sympy.AccumBounds):
        raise TypeError(f"not a formula, {_shortened(value)}")
    return value


def _letter(symbol, real):
    """The symbol that `parse` would read for the same name, but an integer where it was one."""
    if symbol.is_integer and symbol.name not in real.split():
        return sympy.Symbol(symbol.name, positive=True, integer=True)
    letter = parse(symbol.name, real) if symbol.name.isidentifier() and not keyword.iskeyword(symbol.name) else symbol
    return letter if letter.is_Symbol else symbol


def parse_formula(text: str, real: str = "") -> Formula:
    """Read a formula, or an equation ``left = right``, as `plainmath.expressions.parse` does.

    Raises ValueError where the text is neither, and for an equation that says nothing, as ``x = x``.
    """
    left, equals, right = text.partition("=")
    if not equals:
        return parse(text, real)
    left, right = parse(left, real), parse(right, real)
    if sympy.expand(left - right) == 0:
        raise ValueError(f"the equation {text!r} says nothing: both sides are the same")
    return sympy.Eq(left, right, evaluate=False)


def formula_agrees(value: object, printed: str, real: str = "") -> str:
    """Say how a formula agrees with the printed one: ``"proved"``, ``"probed"``, or ``""`` where it does not.

    A symbol is known by its name; it is positive, or of either sign if it is among `real`. An equation may have its
    terms on either side, but it may not be multiplied: many a false equation is true times zero.

    >>> formula_agrees(sympy.sympify("2*K/(2*T*s + 2)"), "K/(T*s + 1)")
    'proved'
    >>> formula_agrees(sympy.sympify("Abs(K)"), "K"), formula_agrees(sympy.sympify("Abs(K)"), "K", real="K")
    ('proved', '')
    """
    value, printed = formula(value, real), parse_formula(printed, real)
    whole = {symbol.name: symbol for symbol in value.free_symbols if symbol.is_integer}
    return formulas_agree(value, printed.xreplace({x: whole.get(x.name, x) for x in printed.free_symbols}))


def formulas_agree(one: Formula, other: Formula) -> str:
    """Say how two formulas or two equations agree: ``"proved"``, ``"probed"``, or ``""`` where they do not.

    >>> K, T = sympy.symbols("K T", positive=True)
    >>> formulas_agree(sympy.Eq(K, T), sympy.Eq(T, K)), formulas_agree(K, T)
    ('proved', '')
    """
    if isinstance(one, sympy.Equality) != isinstance(other, sympy.Equality):
        return ""
    if isinstance(one, sympy.Equality):
        one, other = (equation.lhs - equation.rhs for equation in (one, other))
        # with the sides exchanged, it is still the same equation
        how = agreement(one, other)
        how = agreement(-one, other) if how == "different" else how
    elif one.is_infinite or other.is_infinite:
        how = "proved" if one == other else "different"
    else:
        how = agreement(one, other)
    return "" if how == "different" else how


def name_of(value: object) -> str:
    """Return a name, a word or a few, in one line. Raises TypeError for anything else."""
    if not isinstance(value, str):
        raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")
    # the plain text also of an enumeration, or of another kind of text
    return in_one_line(str.__str__(value))


def spelled_number(value: object, *printed: str) -> str:
    """Return a number as text, four digits beyond the finest of some printed ones, without trailing zeros.

    >>> spelled_number(1 - math.exp(-1), "0.63")
    '0.632121'
    """
    value = number(value)
    if isinstance(value, float):
        return "oo" if value > 0 else "-oo"
    finite = [text for text in printed if NUMBER.fullmatch(text)]
    if not finite or abs(value) > 10**6 * max(abs(fractions.Fraction(text)) + 1 for text in finite):
        with decimal.localcontext(prec=7):
            return f"{(decimal.Decimal(value.numerator) / value.denominator).normalize():g}"
    places = 4 - min(decimal.Decimal(text).as_tuple().exponent for text in finite)
    sign, digits = ("-" if value < 0 else ""), f"{round(abs(value) * 10**places):0{max(places, 0) + 1}d}"
    whole, decimals = (digits[:-places], digits[-places:]) if places > 0 else (digits + "0" * -places, "")
    text = f"{whole}.{decimals}".rstrip("0").rstrip(".") if decimals else whole
    return text if text == "0" else sign + text
