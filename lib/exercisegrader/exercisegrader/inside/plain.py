"""Answers as plain data: what of an answer leaves the student's process.

A judge reads the data as it would read the answer itself: numbers are numbers, expressions and systems are the text
that spells them, a figure is the picture, and what has no such form is a sentence that says so.
"""

from __future__ import annotations

import functools
import inspect
import itertools
import json
import math
import numbers
from collections.abc import Iterator, Mapping, MappingView
from typing import TypeAlias

import numpy as np
import sympy

from exercisebook import png
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable
from exercisebook.judging import harmless
from exercisebook.reading import alone, spelled
from exercisebook.wholes import WHOLES

DEEPEST, MOST_VALUES, LONGEST_TEXT, MOST_TEXT, MOST_DIGITS = 8, 2000, 5000, 50_000, 300
#: Up to this denominator a fraction is written as one; others are the nearest decimal number, to 16 digits.
LARGEST_DENOMINATOR = 10**6
_UNREADABLE = "unreadable"


#: What JSON can hold.
Plain: TypeAlias = "bool | int | float | str | list[Plain] | dict[str, Plain] | None"


def plain(answer: object) -> Plain:
    """Return an answer as JSON data: None, truth values, numbers, texts, lists, and dictionaries with texts as keys.

    Numbers that JSON does not know are texts, as "(1+2j)", "1/3" or "nan". A figure is ``{"png": base64}``. What has no
    plain form becomes ``{"unreadable": sentence}``, all of it. The data is bounded: 2000 values, 8 levels, 50 000
    characters; a picture of 300 kB and 2000 pixels along a side. No exception leaves this function, but the methods of
    an object may run as long as they like.

    >>> import sympy
    >>> plain([sympy.Rational(5, 2), sympy.Rational(1, 3), 1 + 2j, float("nan"), ...])
    [2.5, '1/3', '(1+2j)', 'nan', None]
    >>> plain(2 / sympy.Symbol("s")), plain(sympy.Eq(sympy.Symbol("x"), 3)), plain(lambda t: t)["unreadable"][:36]
    ('2/s', 3, 'a function cannot be handed in: give')
    """
    try:
        if picture := png.of_figure(answer):
            return png.as_data(picture)
        return png.as_data(png.checked(answer)) if png.is_data(answer) else _Reader().read(answer, 0)
    except Unreadable as problem:
        return {_UNREADABLE: harmless(str(problem))}
    except Exception as problem:  # objects of others may fail in any way
        return {_UNREADABLE: f"this fails when it is read, with {harmless(type(problem).__name__)}"}


def unreadable(data: object) -> str:
    """Return the sentence of plain data that stands for what has no plain form; an empty one for all other data.

    >>> unreadable(plain(object())), unreadable(plain(2))
    ('this is of type object: expected a number, a text, a list or an expression', '')
    """
    is_one = isinstance(data, dict) and data.keys() == {_UNREADABLE} and isinstance(data[_UNREADABLE], str)
    return harmless(data[_UNREADABLE]) if is_one else ""


class _Reader:
    """Reads one answer, and counts what it has read."""

    def __init__(self):
        self.values, self.characters = 0, 0

    def read(self, value, depth):
        self.values += 1
        if self.values > MOST_VALUES:
            raise Unreadable(f"there are more than {MOST_VALUES} values: expected fewer")
        if depth > DEEPEST:
            raise Unreadable(f"there are more than {DEEPEST} lists in one another: expected fewer")
        match value:
            case None | bool() | np.bool_() | sympy.logic.boolalg.BooleanAtom():
                return None if value is None else bool(value)
            case str():
                return self._text(str.__str__(value))
            case numbers.Integral() | sympy.Integer():
                return _integer(int(value))
            case numbers.Rational() | sympy.Rational():
                return _fraction(value.numerator, value.denominator)
            case sympy.MatrixBase() | sympy.Tuple() | list() | tuple() | range() | Iterator() | MappingView():
                row = value.tolist() if isinstance(value, sympy.MatrixBase) else value
                return self._several(row, depth)
            case set() | frozenset() | sympy.FiniteSet():
                return sorted(self._several(value, depth), key=_rank)
            case sympy.Equality() if alone(value) is not value:
                return self.read(alone(value), depth + 1)
            case Mapping():
                return self._dictionary(value, depth)
        if value is Ellipsis:
            return None
        if hasattr(value, "magnitude") and hasattr(value, "units"):
            return self._quantity(value, depth)
        for whole in WHOLES:
            if (data := whole.as_data(value)) is not None:
                return {name: self.read(one, depth + 1) for name, one in data.items()}
        if hasattr(value, "tolist") and hasattr(value, "ndim"):
            return self._array(value, depth)
        return self._number(value) if _is_number(value) else self._spelled(value)

    def _several(self, row, depth):
        return [self.read(one, depth + 1) for one in itertools.islice(row, MOST_VALUES + 1)]

    def _text(self, text):
        self.characters += len(text)
        if len(text) > LONGEST_TEXT or self.characters > MOST_TEXT:
            raise Unreadable(f"the text has {len(text)} characters: expected at most {LONGEST_TEXT}")
        return text

    def _dictionary(self, value, depth):
        if alone(value) is not value:  # what an equation was solved for
            return self.read(alone(value), depth + 1)
        found = {}
        for name, one in itertools.islice(value.items(), MOST_VALUES + 1):
            name = self.read(name, depth + 1)
            name = name if isinstance(name, str) else self._text(json.dumps(name))
            if name in found:
                raise Unreadable(f"the dictionary has two keys {name}: expected one")
            found[name] = self.read(one, depth + 1)
        return found

    def _quantity(self, value, depth):
        """A quantity of Pint, as text with its unit."""
        if getattr(value.magnitude, "ndim", 0):
            return self.read(value.tolist(), depth + 1)
        unit = f"{value.units:~C}".replace("Δ°C", "K") or "dimensionless"
        return self._text(f"{self.read(value.magnitude, depth + 1)} {unit}")

    def _array(self, value, depth):
        if value is np.ma.masked:
            return "nan"
        if isinstance(value, np.floating | np.complexfloating):
            return self._number(value)
        if getattr(value, "size", 0) > MOST_VALUES:
            raise Unreadable(f"there are more than {MOST_VALUES} values: expected fewer")
        inside = value.tolist()
        if inside is value or isinstance(inside, type(value)):
            raise Unreadable(_says(value))
        return self.read(inside, depth + 1)

    def _number(self, value):
        """A number as it is, and a constant such as sqrt(2) as its text where that can be read."""
        if isinstance(value, sympy.Expr) and not isinstance(value, sympy.Float):
            text = spelled(value)
            try:
                if np.isfinite(Formula(text)()):
                    return self._text(text)
            except Unreadable:  # a function that is known to SymPy alone
                pass
        number = complex(value)
        return self._text(str(number)) if number.imag else _decimal(number.real)

    def _spelled(self, value):
        try:
            return self._text(spelled(value))
        except Unreadable as problem:
            if inspect.isroutine(value) or isinstance(value, np.ufunc | np.poly1d | functools.partial):
                raise Unreadable(
                    "a function cannot be handed in: give an expression such as 2*exp(-t/5), or its values"
                ) from None
            raise Unreadable(str(problem) if isinstance(value, sympy.Basic) else _says(value)) from None


def _is_number(value):
    """Whether an object is a number, or has one as its value."""
    if isinstance(value, sympy.Basic):
        return bool(isinstance(value, sympy.Expr) and value.is_number and not value.is_Matrix)
    has_value = any(hasattr(type(value), name) for name in ("__complex__", "__float__", "__index__"))
    return has_value and not hasattr(value, "expr")


def _integer(value):
    if value.bit_length() > MOST_DIGITS * math.log2(10):
        raise Unreadable(f"this number has more than {MOST_DIGITS} digits: expected a smaller one")
    return value


def _fraction(above, below):
    above, below = int(above), int(below)
    if below.bit_count() == 1 or below > LARGEST_DENOMINATOR or abs(above) > 10**15:
        try:
            return above / below
        except OverflowError:
            raise Unreadable(f"this number has more than {MOST_DIGITS} digits: expected a smaller one") from None
    return f"{above}/{below}"


def _decimal(value):
    return float(value) if math.isfinite(value) else str(float(value))


def _rank(data):
    """Numbers in their order, then all else by its text."""
    is_number = isinstance(data, int | float)
    return (not is_number, data if is_number else 0, json.dumps(data, sort_keys=True))


def _says(value):
    return f"this is of type {type(value).__name__}: expected a number, a text, a list or an expression"
