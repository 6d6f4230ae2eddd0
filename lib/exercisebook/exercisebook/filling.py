"""Texts with places for values: ``{K}`` is the value of K in a variant, bare in a formula, elsewhere with its unit."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sympy

from exercisebook.parameters import written
from plainmath.latex import latex
from plainmath.tables import rounded

#: Significant digits of a number that a solution works out.
DIGITS = 4
_FORMULA = re.compile(r"(\$\$.*?\$\$|\$[^$]*\$)", re.DOTALL)
_PLACE = re.compile(r"\{\{(\w+)\}\}|\{(\w+)\}")


@dataclass(frozen=True)
class Shown:
    """A value as texts show it: within a formula, and outside of one."""

    inside: str
    outside: str


def shown(value: Any, unit: str = "") -> Shown:
    """Return how a value is shown.

    Arguments:
        value: a text, which stays as it is; a number, to four digits; a pair of a number and its unit; an expression.
        unit: of a number.

    >>> shown((2.00049, "s")).outside, shown(sympy.Symbol("K") / 2).outside, shown(1.2e-7).inside
    ('2\\xa0s', '$0.5 K$', '1.2 \\\\times 10^{-7}')
    """
    if isinstance(value, tuple):
        return shown(*value)
    if isinstance(value, str):
        return Shown(value, value)
    if isinstance(value, sympy.Basic) and not (value.is_Number or value.is_NumberSymbol):
        formula = latex(_in_decimals(value)).replace("dfrac", "frac")
        return Shown(formula, f"${formula}$")
    mantissa, _, exponent = rounded(float(value), DIGITS).partition("e")
    mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    number = rf"{mantissa} \times 10^{{{exponent}}}" if exponent else mantissa
    text = f"${number}$" if exponent else number
    return Shown(number, f"{text}\N{NO-BREAK SPACE}{unit}" if unit else text)


def of_parameter(value: Any, unit: str) -> Shown:
    """Return how the value of a parameter is shown: with all its digits.

    >>> of_parameter(sympy.Rational(5, 2), "s")
    Shown(inside='2.5', outside='2.5\\xa0s')
    """
    return Shown(written(value), written(value, unit))


def filled_in(text: str, find: Callable[[str], Shown | None]) -> str:
    """Return a text with values in the places of their names.

    Arguments:
        text: with places such as ``{K}``; ``{{K}}`` is the letter K in braces.
        find: returns what is shown for a name; None where there is no such value, and the place stays as it is.

    >>> filled_in(r"$\\frac{ {K} }{T_{i}}$ with $K$ = {K}", {"K": shown(2, "%/K")}.get)
    '$\\\\frac{ 2 }{T_{i}}$ with $K$ = 2\\xa0%/K'
    """

    def fill(match, side):
        letter, name = match.groups()
        if letter:
            return "{" + letter + "}"
        found = find(name)
        return match[0] if found is None else getattr(found, side)

    parts = _FORMULA.split(text)
    for k, part in enumerate(parts):
        side = "inside" if k % 2 else "outside"
        parts[k] = _PLACE.sub(lambda match, side=side: fill(match, side), part)
    return "".join(parts)


def _in_decimals(value):
    """An expression with its fractions as decimals, where few digits write them; exponents stay."""
    if isinstance(value, sympy.Rational) and not value.is_Integer and 10**4 % value.q == 0:
        return sympy.Float(value, 10)
    if isinstance(value, sympy.Float):
        return sympy.Float(rounded(float(value), DIGITS))
    if isinstance(value, sympy.Pow):
        return sympy.Pow(_in_decimals(value.base), value.exp)
    return value.func(*map(_in_decimals, value.args)) if value.args else value
