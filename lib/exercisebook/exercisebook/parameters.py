"""The parameters of an exercise: their ranges, and the values that a variant draws from them."""

from __future__ import annotations

import hashlib
import inspect
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy

from exercisebook import units
from plainmath.expressions import exact, parse
from plainmath.validation import did_you_mean, exact_positive

if TYPE_CHECKING:
    from plainmath.types import Number

FEWEST, MOST = 8, 40
#: What a person would write between 1 and 10, for ranges over more than a decade and a half.
_PLEASANT = [Fraction(n, 10) for n in (10, 12, 15, 20, 25, 30, 40, 50, 60, 80)]


#: A value of a parameter: an exact number, or a word.
Value: TypeAlias = sympy.Expr | str


@dataclass(frozen=True)
class Parameter:
    """Values that a variant may draw, their unit, and the value of the reference variant."""

    values: tuple[Value, ...]
    unit: str
    reference: Value

    def draw(self, text: str) -> Value:
        """Return one of the values, the same for the same text on every machine and Python.

        >>> between(1, 4, "s").draw("any text") in between(1, 4, "s").values
        True
        """
        digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).digest()
        return self.values[int.from_bytes(digest[:8], "big") % len(self.values)]


def between(
    low: Number, high: Number, unit: str = "", reference: Number | None = None, step: Number | None = None
) -> Parameter:
    """Return a parameter between two numbers, both included, that takes values such as a person would choose.

    Arguments:
        low, high: the range, in the unit.
        unit: such as "s", "kg/min" or "%/K".
        reference: value in the reference variant; about the middle if not given.
        step: between two values; 1, 2 or 5 times a power of ten if not given.
    Raises:
        ValueError: for a range that is empty, or something that is not a unit.

    >>> [str(value) for value in between(2, 6).values]
    ['2', '5/2', '3', '7/2', '4', '9/2', '5', '11/2', '6']
    """
    low, high = exact(low), exact(high)
    if not (low.is_Rational and high.is_Rational and low < high):
        raise ValueError(f"the range is {low} to {high}: expected two numbers, the smaller one first")
    step = step if step is None else exact_positive("step", step, symbols=False)
    if step is None and low > 0 and high / low > 30:
        values = _over_decades(low, high)
    else:
        step = _pleasant_step(high - low) if step is None else step
        first = low if low == 0 else sympy.ceiling(low / step) * step
        values = [first + k * step for k in range(int((high - first) / step) + 1)]
    if len(values) < 2:
        raise ValueError(f"the step {step} leaves no choice between {low} and {high}: expected a smaller one")
    return _parameter(values, unit, reference)


def choice(*values: Number | str, unit: str = "", reference: Number | str | None = None) -> Parameter:
    """Return a parameter that takes one of several values, words or numbers; the first one is the reference.

    >>> choice("open", "closed").values
    ('open', 'closed')
    """
    if len(values) < 2:
        raise ValueError(f"the values are {values!r}: expected at least two of them")
    values = [value if isinstance(value, str) else exact(value) for value in values]
    return _parameter(values, unit, values[0] if reference is None else reference)


def _parameter(values, unit, reference):
    if not units.is_unit(unit):
        raise ValueError(f"{unit!r} is not a unit: expected one such as 's', 'kg/min' or '%/K'")
    if reference is None:
        reference = values[len(values) // 2]
    elif not isinstance(reference, str):
        reference = exact(reference)
    if not _possible(reference, values):
        raise ValueError(f"the reference is {reference}, beyond {values[0]} to {values[-1]}: expected one within")
    return Parameter(tuple(values), unit, reference)


def _possible(reference, values):
    """Whether a word is one of the values, or a number within their range."""
    numbers = [value for value in values if not isinstance(value, str)]
    if isinstance(reference, str) or not numbers:
        return reference in values
    return min(numbers) <= reference <= max(numbers)


def _pleasant_step(length):
    """The largest of 1, 2 and 5 times a power of ten that leaves enough values."""
    power = math.floor(math.log10(float(length)))
    steps = [sympy.Integer(10) ** k * m for k in (power, power - 1, power - 2) for m in (5, 2, 1)]
    return next(step for step in steps if length / step >= FEWEST - 1)


def _over_decades(low, high):
    first, last = math.floor(math.log10(float(low))), math.ceil(math.log10(float(high)))
    values = [exact(m) * sympy.Integer(10) ** k for k in range(first, last + 1) for m in _PLEASANT]
    return [value for value in values if low <= value <= high]


def written(value: Number | str, unit: str = "") -> str:
    """Return a value with its unit, as it stands in a sentence.

    >>> written(sympy.Rational(5, 2), "kg/min")
    '2.5\\xa0kg/min'
    """
    if isinstance(value, str):
        return value
    text = f"{float(value):.6f}".rstrip("0").rstrip(".") if abs(value) < 10**6 else f"{float(value):g}"
    if float(text) != float(value):
        text = f"{float(value):.6g}"
    return f"{text}\N{NO-BREAK SPACE}{unit}" if unit else text


def as_text(value: Value) -> str:
    """Return a value as a text that `of_text` reads back exactly; a word stands in quotes.

    Raises ValueError for an expression that no text spells, as one of symbols that may be negative.

    >>> as_text(sympy.Rational(5, 2)), as_text(sympy.sqrt(2)), as_text("open")
    ('5/2', 'sqrt(2)', "'open'")
    """
    if isinstance(value, str):
        return f"'{value}'"
    if of_text(text := str(value)) != value:
        raise ValueError(f"the value {text} is not the same when it is read again: expected a number or a word")
    return text


def of_text(text: str) -> Value:
    """Return the value that `as_text` wrote; nothing in it is evaluated. Raises ValueError for what is none.

    >>> of_text("5/2") == sympy.Rational(5, 2), of_text("'5/2'")
    (True, '5/2')
    """
    if text.startswith("'"):
        return text[1:-1]
    return sympy.Rational(text) if re.fullmatch(r"-?[0-9]+(/[0-9]+)?", text) else parse(text)


def call(function: Callable[..., Any], values: Mapping[str, Any]) -> Any:
    """Call a function with those of the values that it names; raises ValueError for an unknown name."""
    names = list(inspect.signature(function).parameters)
    unknown = [name for name in names if name not in values]
    if unknown:
        raise ValueError(f"{unknown[0]!r} is not a parameter of the exercise: {did_you_mean(unknown[0], values)}")
    return function(**{name: values[name] for name in names})
