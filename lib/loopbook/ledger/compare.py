"""Whether a computed value is what the book prints: numbers by their digits, formulas by proof, claims by the word."""

import decimal
import difflib
import fractions
import math
import numbers
import re

import sympy

from loopbook.expressions import agreement, parse, symbols_by_name

NUMBER = re.compile(r"[+-]?(\d+(\.\d+)?|\.\d+)([eE][+-]?\d+)?")
INFINITE = {"oo": math.inf, "-oo": -math.inf}
KINDS = ("number", "formula", "claim")


class LedgerError(Exception):
    """A wrong use of the ledger, or a malformed entry: one sentence that names the entry and what was expected."""

    def _render_traceback_(self):
        """Notebooks show the sentence alone: the place in the library's code helps no reader."""
        return [f"{type(self).__name__}: {self}"]


class Disagreement(LedgerError):  # noqa: N818 - it reads as what it is: "Disagreement: Kp = 1.7 ..."
    """A computed value that the ledger does not confirm."""


def suggestion(word, known):
    """A clause that names the closest known word, or all of them.

    >>> suggestion("Kpp", ["Ti", "Kp"])
    "did you mean 'Kp'?"
    """
    close = difflib.get_close_matches(str(word), known, n=1)
    return f"did you mean {close[0]!r}?" if close else f"expected one of {', '.join(known) or 'none'}"


def half_unit(printed):
    """Half a unit of the last printed digit, which is how far a value may lie from the print, as an exact fraction.

    >>> half_unit("1.50"), half_unit("2e-3"), half_unit("1500")
    (Fraction(1, 200), Fraction(1, 2000), Fraction(1, 2))
    """
    return fractions.Fraction(1, 2) * fractions.Fraction(10) ** decimal.Decimal(printed).as_tuple().exponent


def number(value):
    """Return a real number of any usual type as an exact fraction, or as a float where it is infinite.

    Raises TypeError, saying what the value is instead, for anything that is not one real number.
    """
    if isinstance(value, bool) or type(value).__name__ == "bool":
        raise TypeError(f"a truth value, {value}")
    if isinstance(value, sympy.Basic):
        return _sympy_number(value)
    if isinstance(value, decimal.Decimal):
        value = fractions.Fraction(value) if value.is_finite() else float(value)
    if isinstance(value, numbers.Rational):
        return fractions.Fraction(int(value.numerator), int(value.denominator))
    if isinstance(value, numbers.Real):
        value = float(value)
        if math.isnan(value):
            raise TypeError("not a number (NaN)")
        return value if math.isinf(value) else fractions.Fraction(value)
    if isinstance(value, numbers.Complex):
        raise TypeError(f"a complex number, {value}")
    raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")


def _sympy_number(value):
    if value in (sympy.oo, -sympy.oo):
        return float(value)
    if not isinstance(value, sympy.Expr) or value.has(sympy.nan, sympy.zoo, sympy.oo, -sympy.oo):
        raise TypeError(f"not a number, {_shortened(value)}")
    if value.free_symbols or not value.is_number:
        raise TypeError(f"the expression {_shortened(value)}")
    if not value.is_Rational:
        digits = sympy.N(value, 60)
        if not digits.is_Float:
            raise TypeError(f"a complex number, {_shortened(value)}")
        value = sympy.Rational(digits)
    return fractions.Fraction(int(value.p), int(value.q))


def _shortened(value, length=60):
    text = " ".join(repr(value).split())
    return text if len(text) <= length else text[: length - 3] + "..."


def number_agrees(value, printed):
    """Whether a value lies within half a unit of the last printed digit. Nothing is rounded on the way.

    >>> number_agrees(0.6321, "0.63"), number_agrees(0.636, "0.63")
    (True, False)
    """
    value = number(value)
    if printed in INFINITE or isinstance(value, float):
        return value == INFINITE.get(printed)
    return abs(value - fractions.Fraction(printed)) <= half_unit(printed)


def formula(value):
    """Return a computed formula as a SymPy expression or equation.

    Raises TypeError, saying what the value is instead, for anything else, and for one with rounded decimals, which
    no proof can start from.
    """
    if isinstance(value, numbers.Number) and not isinstance(value, bool):
        value = sympy.sympify(value)
    if not isinstance(value, (sympy.Expr, sympy.Equality)):
        raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")
    if value.has(sympy.nan, sympy.zoo):
        raise TypeError(f"not a number, {_shortened(value)}")
    if value.has(sympy.Float):
        raise TypeError(f"{_shortened(value)}, which holds rounded decimals: give exact numbers")
    return value


def parse_formula(text):
    """Read a formula, or an equation ``left = right``, as `loopbook.expressions.parse` does."""
    left, equals, right = text.partition("=")
    return sympy.Eq(parse(left), parse(right), evaluate=False) if equals else parse(left)


def formula_agrees(value, printed):
    """Say how a formula agrees with the printed one: ``"proved"``, ``"probed"``, or ``""`` where it does not.

    A letter is known by its name. An equation may have its terms on either side.

    >>> formula_agrees(sympy.sympify("2*K/(2*T*s + 2)"), "K/(T*s + 1)")
    'proved'
    """
    value = formula(value)
    printed = symbols_by_name(parse_formula(printed), like=value)
    if isinstance(value, sympy.Equality) != isinstance(printed, sympy.Equality):
        return ""
    if isinstance(value, sympy.Equality):
        value, printed = (equation.lhs - equation.rhs for equation in (value, printed))
    how = agreement(value, printed)
    return "" if how == "different" else how


def claim(value):
    """Return a claim, a word or a few. Raises TypeError for anything else."""
    if not isinstance(value, str):
        raise TypeError(f"{_shortened(value)} of type {type(value).__name__}")
    return value


def agrees(kind, value, printed):
    """Say how a value agrees with the print: ``"digits"``, ``"proved"``, ``"probed"``, ``"word"``, or ``""`` if not.

    Raises TypeError, saying what the value is, where it is not of the kind.
    """
    match kind:
        case "number":
            return "digits" if number_agrees(value, printed) else ""
        case "formula":
            return formula_agrees(value, printed)
        case "claim":
            return "word" if claim(value).casefold() == printed.casefold() else ""


def spelled(kind, value, *printed):
    """Return the computed value as text; a number four digits beyond the finest print, without trailing zeros.

    >>> spelled("number", 1 - math.exp(-1), "0.63")
    '0.632121'
    """
    if kind != "number":
        return str(formula(value) if kind == "formula" else claim(value))
    value = number(value)
    if isinstance(value, float):
        return "oo" if value > 0 else "-oo"
    if not any(NUMBER.fullmatch(text) for text in printed):
        return str(float(value))
    places = 4 - min(decimal.Decimal(text).as_tuple().exponent for text in printed if NUMBER.fullmatch(text))
    sign, digits = ("-" if value < 0 else ""), f"{round(abs(value) * 10**places):0{max(places, 0) + 1}d}"
    whole, decimals = (digits[:-places], digits[-places:]) if places > 0 else (digits + "0" * -places, "")
    text = f"{whole}.{decimals}".rstrip("0").rstrip(".") if decimals else whole
    return text if text == "0" else sign + text
