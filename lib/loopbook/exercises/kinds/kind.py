"""What all kinds of asked quantities have in common."""

from __future__ import annotations

import inspect
import itertools
import json
import re
from collections.abc import Iterable, Iterator, MappingView
from typing import Any, Self

import sympy
from sympy.core.function import AppliedUndef

from loopbook.exercises import units
from loopbook.exercises.reading import Unreadable

#: What is left of an answer cell that nobody has filled in.
NOT_ANSWERED = "not answered yet"
#: Of what gives one value after another, so many are read.
MOST_VALUES = 10_000


class Kind:
    """An asked quantity: its key, and how an answer is read, compared and responded to.

    Arguments:
        key: the right answer.
        unit: of the answer; none for a number without unit.
        what: the quantity in words, with its article, as "the integral time".
        within: how far a number may be off, as a fraction of it.
    """

    #: How an answer looks, for one that cannot be judged.
    expected: str = "an answer"
    #: The arguments that say how an answer looks. None of them comes from the key.
    FORM: tuple[str, ...] = ("unit",)
    key: Any
    within: float
    key, unit, what = None, "", "the value"

    def __init__(self, key: object, unit: str = "", what: str = "the value", within: float = 0.01):
        if not units.is_unit(unit):
            raise ValueError(f"the unit of {what} is {unit!r}: expected one such as 's', 'kg/min' or '%/K'")
        self.unit, self.what, self.within = unit, what, within
        self.key = self.read(key)[0]

    @classmethod
    def without_key(cls, *parts: Any, **named: Any) -> Self:
        """Return a kind that reads answers and has nothing to compare them with.

        Arguments:
            parts, named: those of the constructor that are in `FORM`.

        >>> from loopbook.exercises.kinds import Number
        >>> Number.without_key("s").read("2 min")
        (120.0, 'converted from min')
        """
        given = dict(zip(cls.FORM, parts, strict=False)) | named
        if unknown := [name for name in named if name not in cls.FORM] or parts[len(cls.FORM) :]:
            raise ValueError(f"{unknown[0]!r} says nothing about a form: expected {', '.join(cls.FORM)}")
        kind = object.__new__(cls)
        kind.__dict__ |= cls._usual_form() | given
        return kind

    @classmethod
    def _usual_form(cls):
        parameters = inspect.signature(cls).parameters
        return {name: parameters[name].default for name in cls.FORM}

    @property
    def maker(self) -> str:
        """The name of the function for authors that makes such a kind, as "transfer_function"."""
        return re.sub("(?<!^)(?=[A-Z])", "_", type(self).__name__).lower()

    @property
    def asking(self) -> str:
        """The call, as code, that makes a kind of this form without the key; nothing in it comes from the key.

        >>> from loopbook.exercises.kinds import Number
        >>> Number(2.5, "K/%", "the gain").asking
        'number("K/%")'
        """
        usual = self._usual_form()
        said = {name: getattr(self, name) for name in self.FORM if getattr(self, name) != usual[name]}
        named = [f"{name}={literal(value)}" if name != self.FORM[0] else literal(value) for name, value in said.items()]
        return f"{self.maker}({', '.join(named)})"

    def like(self, value: Any) -> Self:
        """The same quantity with another key, as a mistake has one."""
        other = object.__new__(type(self))
        other.__dict__ |= self.__dict__
        other.key = other.read(value)[0]
        return other

    @property
    def asked(self) -> str:
        """The quantity with its unit, as in a sentence."""
        return f"{self.what}, in {self.unit}" if self.unit else self.what

    def written(self, answer: Any) -> str:
        """An answer, as it was read, as a text for people."""
        return str(answer)

    @property
    def solution(self) -> str:
        """The key as a text for people."""
        return self.written(self.key)

    @property
    def accuracy(self) -> str:
        """How near an answer must be, in words; empty where that is no question."""
        return "exact" if self.within == 0 else f"{100 * self.within:g}\N{NO-BREAK SPACE}%"

    def read(self, given: object) -> tuple[Any, str]:
        """Return the answer as it is compared, and a remark on how it was understood, which may be empty.

        Reading looks at the form alone, never at the key. Raises Unreadable in a sentence.
        """
        raise NotImplementedError

    def agrees(self, answer: Any) -> bool:
        """Whether an answer, as it was read, is right."""
        raise NotImplementedError

    def mistakes(self) -> Iterable[tuple[str, Any]]:
        """The mistakes that can be recognised in every exercise: pairs of a sentence and a wrong value, as read."""
        return ()

    def hint(self, answer: Any) -> str:
        """Return a sentence on a wrong answer that nothing else explains; it may be empty."""
        return ""

    def is_value(self, answer: Any, wrong: Any) -> bool:
        """Whether an answer, as it was read, is the value of a mistake."""
        return self.like(wrong).agrees(answer)

    def in_other_units(self, answer: Any) -> Iterable[tuple[str, Any]]:
        """What an answer would be if it had been given in another unit: pairs of the unit and the value."""
        return ()


def literal(value: object) -> str:
    """Return plain data as code.

    >>> literal(("heating", "cooling")), literal(True)
    ('["heating", "cooling"]', 'True')
    """
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(literal, value))}]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def with_unit(text: str, unit: str) -> str:
    """Return a text with a unit behind it."""
    return f"{text}\N{NO-BREAK SPACE}{unit}" if unit else text


def answered(given: object) -> Any:
    """Return what was given; raises Unreadable where that is nothing yet."""
    if given is None or given is Ellipsis:
        raise Unreadable(NOT_ANSWERED)
    return given


def in_a_row(given: object) -> list[Any] | None:
    """Return the values of a list, tuple, array, matrix or range as a list; None where there is no row of values."""
    if isinstance(given, sympy.MatrixBase):
        return given.tolist()
    if isinstance(given, sympy.Tuple | list | tuple | range | Iterator | MappingView):
        return list(itertools.islice(given, MOST_VALUES))
    if hasattr(given, "tolist") and hasattr(given, "ndim"):
        return given.tolist() if given.ndim else None
    return None


def alone(given: object) -> Any:
    """Return the value that stands alone in a row, a set, an array, or an equation for a letter; others as they are.

    >>> alone([{sympy.Symbol("x"): 3}]), alone(sympy.Eq(sympy.Symbol("x"), 3)), alone([1, 2])
    (3, 3, [1, 2])
    """
    if isinstance(given, sympy.Equality) and isinstance(given.lhs, sympy.Symbol | AppliedUndef):
        return given.rhs
    if isinstance(given, dict) and len(given) == 1 and isinstance(next(iter(given)), sympy.Symbol | AppliedUndef):
        return next(iter(given.values()))
    if isinstance(given, set | frozenset | sympy.FiniteSet):
        given = list(given)
    elif getattr(given, "ndim", None) == 0 and hasattr(given, "tolist") and not hasattr(given, "units"):
        return given.tolist()
    row = in_a_row(given)
    if row is None:
        return given
    return alone(row[0]) if len(row) == 1 else row


def listed_in(text: str) -> list[str]:
    """Return the parts of a text that lists several: "[1, 2]" or "1; 2".

    >>> listed_in("[-1,-2]"), listed_in("-1 + 2j; -3"), listed_in("1,5")
    (['-1', '-2'], ['-1 + 2j', '-3'], ['1,5'])
    """
    text = text.strip()
    inside = text.strip("[]{}")
    separator = r";|,\s" if inside == text else "[;,]"
    parts = [part.strip() for part in re.split(separator, inside) if part.strip()]
    return parts if text else [text]
