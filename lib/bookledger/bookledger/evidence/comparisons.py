"""Two values compared: numbers by size, formulas by proof, names by the word; strictly, or by a criterion."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import sympy

from bookledger.evidence.criteria import (
    MUCH,
    NEGLIGIBLE,
    ROUGHLY,
    SAME,
    SOMEWHAT,
    VISIBLY,
    Criterion,
)
from bookledger.evidence.sides import (
    ROUNDING,
    EvidenceError,
    Side,
    Typeset,
    anything,
    data,
    equality,
    kind_of,
    numbers,
    numbers_or_expressions,
    order,
    proved,
    texts,
)
from bookledger.evidence.values import in_one_line

if TYPE_CHECKING:
    from plainmath.types import Number

_HOLDS = {">": (1,), "<": (-1,), "≥": (1, 0), "≤": (-1, 0)}  # the orders of two numbers between which it is
_CONTRARY = {">": "≤", "≤": ">", "<": "≥", "≥": "<", "=": "≠", "≠": "="}


class Evidence:
    """What decides a claim.

    Attributes:
        holds: whether it speaks for the claim.
        near: whether a criterion with half or twice its limit would give another verdict, or a few percent of a value.
        probed: whether an equality was found at random points, and not proved.
        room: how far two numbers are apart, as a share of the larger one; infinite for all else.
        criteria: those it rests on.
        quantities: the names of what it is about.
        divided: whether it has cases that hold, and others that do not.
        data: all of it as JSON data.
    """

    holds: bool
    near: bool
    probed: bool = False
    room: float = math.inf
    criteria: tuple[Criterion, ...] = ()
    quantities: frozenset[str] = frozenset()
    divided: bool = False
    data: dict[str, Any]

    def told(self, typeset: Typeset = str) -> str:
        """The evidence as a sentence with its numbers; `typeset` writes the formulas in it."""
        raise NotImplementedError

    def turned(self) -> Evidence:
        """The evidence for the contrary."""
        raise NotImplementedError

    def __bool__(self) -> bool:
        raise TypeError("evidence is not a truth value: hand it to a check, or ask whether it `holds`")

    def __repr__(self) -> str:
        return f"{'holds' if self.holds else 'does not hold'}: {self.told()}"


@dataclass(frozen=True, repr=False)
class Comparison(Evidence):
    """Two values, and the relation that is said to be between them.

    Attributes:
        left, right: the values.
        relation: one of > < ≥ ≤ = ≠.
        quantity, unit: what is compared.
        criterion: whose limit the value on the right is; None where it is a value of its own.
    """

    left: Side
    relation: str
    right: Side
    quantity: str = ""
    unit: str = ""
    criterion: Criterion | None = None

    def __post_init__(self) -> None:
        self._is_so(self.left, self.right)  # what cannot be decided is said at once

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criterion, if there is one."""
        return (self.criterion,) if self.criterion else ()

    @property
    def quantities(self) -> frozenset[str]:
        """The quantity."""
        return frozenset({self.quantity} - {""})

    @property
    def holds(self) -> bool:
        """Whether the relation is between the two values."""
        return self._is_so(self.left, self.right)

    def _is_so(self, left, right):
        if self.relation in "=≠":
            return bool(equality(left, right)) is (self.relation == "=")
        if isinstance(left, sympy.Basic):
            return proved(left, self.relation, right)
        return order(left, right) in _HOLDS[self.relation]

    @property
    def probed(self) -> bool:
        """Whether the two were found equal at random points alone."""
        return self.relation in "=≠" and equality(self.left, self.right) == "probed"

    @property
    def near(self) -> bool:
        """Whether the verdict hangs on the limit, or on a few percent."""
        if self.criterion:
            return len({self._is_so(self.left, self.right * factor) for factor in (Fraction(1, 2), 1, 2)}) > 1
        return self.left != 0 != self.right and self.room <= SAME.limit

    @property
    def room(self) -> float:
        """How far two numbers are apart of which one should be larger."""
        if self.relation in "=≠" or not all(isinstance(side, Fraction) for side in (self.left, self.right)):
            return math.inf
        return _apart(self.left, self.right)

    def turned(self) -> Comparison:
        """The same values in the contrary relation."""
        return replace(self, relation=_CONTRARY[self.relation])

    @property
    def sign(self) -> str:
        """The relation as it was found."""
        return self.relation if self.holds else {"=": "≠", "≠": "="}.get(self.relation, f"not {self.relation}")

    @property
    def way(self) -> str:
        """How it was found, where formulas are compared, as the end of a sentence."""
        if not isinstance(self.left, sympy.Basic):
            return ""
        return ", at random points" if self.probed else ", proved"

    def told(self, typeset: Typeset = str) -> str:
        """The quantity, its values and the relation, as in "width 2.31 > 1.59"."""
        left, right = texts([self.left, self.right], self.unit, typeset)
        why = f" ({self.criterion.word}: {self.criterion.meaning})" if self.criterion else ""
        return f"{self.quantity} {left} {self.sign} {right}{self.way}{why}".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The values, with enough digits to see the verdict in them."""
        left, right = data(self.left, self.right, decides=lambda *sides: self._is_so(*sides) is self.holds)
        named = {"quantity": self.quantity, "unit": self.unit, "criterion": self.criterion and self.criterion.word}
        return {
            "kind": "comparison", "of": kind_of(self.left, self.right),
            "left": left, "relation": self.relation, "right": right,
            "holds": self.holds, "near": self.near, **without_gaps(named),
        }  # fmt: skip


@dataclass(frozen=True, repr=False)
class Ratio(Evidence):
    """Two numbers, and a criterion on how much larger one is than the other.

    Attributes:
        left, right: the numbers.
        quantity, unit: what is compared.
        criterion: one of `_BY_RATIO`.
        contrary: whether it is said not to be so.
    """

    left: Fraction | float
    right: Fraction | float
    quantity: str
    unit: str
    criterion: Criterion
    contrary: bool = False

    def __post_init__(self) -> None:
        if abs(self.left) == abs(self.right) == math.inf:
            raise EvidenceError("two infinite numbers have no ratio: expected numbers to compare")
        if self.criterion in (ROUGHLY, MUCH, SOMEWHAT) and min(self.left, self.right) < 0:
            one, other = texts([self.left, self.right])
            raise EvidenceError(f"{one} beside {other}: how much larger one is asks for numbers that are not negative")

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criterion."""
        return (self.criterion,)

    @property
    def quantities(self) -> frozenset[str]:
        """The quantity."""
        return frozenset({self.quantity} - {""})

    @property
    def holds(self) -> bool:
        """Whether the criterion says so."""
        return self._is_so(self.left, self.right, self.criterion.limit) is not self.contrary

    def _is_so(self, left, right, limit):
        return _BY_RATIO[self.criterion](left, right, limit)

    def _with_limits(self, left, right):
        """The verdicts with half the limit, the limit, and twice the limit."""
        return [self._is_so(left, right, self.criterion.limit * factor) for factor in (Fraction(1, 2), 1, 2)]

    @property
    def room(self) -> float:
        """How far the numbers are apart."""
        return _apart(self.left, self.right)

    @property
    def near(self) -> bool:
        """Whether half or twice the limit gives another verdict."""
        return len(set(self._with_limits(self.left, self.right))) > 1

    def turned(self) -> Ratio:
        """The same numbers, for the contrary."""
        return replace(self, contrary=not self.contrary)

    def told(self, typeset: Typeset = str) -> str:
        """The numbers and the word for what is between them."""
        # what is about equal need not be told apart
        left, right = texts([self.left, self.right], self.unit, typeset, apart=self.criterion not in (SAME, NEGLIGIBLE))
        word = _WORDS[self.criterion] if self.holds is not self.contrary else f"not {_WORDS[self.criterion]}"
        return f"{self.quantity} {left} {word} {right} ({self.criterion.meaning})".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The values, with enough digits to see the verdict in them."""
        verdicts = self._with_limits(self.left, self.right)
        left, right = data(self.left, self.right, decides=lambda *sides: self._with_limits(*sides) == verdicts)
        return {
            "kind": "ratio", "left": left, "right": right, "criterion": self.criterion.word,
            "limit": data(self.criterion.limit)[0], "contrary": self.contrary,
            "holds": self.holds, "near": self.near, **without_gaps({"quantity": self.quantity, "unit": self.unit}),
        }  # fmt: skip


_ROOM = 1 + ROUNDING  # a limit is met where rounding alone is beyond it
_BY_RATIO = {
    SAME: lambda a, b, limit: _apart(a, b) <= limit * _ROOM,
    NEGLIGIBLE: lambda a, b, limit: abs(a) <= limit * abs(b) * _ROOM,
    ROUGHLY: lambda a, b, limit: order(a, b) == 0 or max(a, b) * _ROOM < (1 + limit) * min(a, b),
    MUCH: lambda a, b, limit: order(a, b) > 0 and a * _ROOM >= (1 + limit) * b,
    VISIBLY: lambda a, b, limit: a > b and _apart(a, b) > limit * _ROOM,
    SOMEWHAT: lambda a, b, limit: a > b and _apart(a, b) > SAME.limit * _ROOM and a * _ROOM < (1 + limit) * b,
}
_WORDS = {
    MUCH: "much larger than",
    NEGLIGIBLE: "negligible beside",
    SAME: "about equal to",
    ROUGHLY: "roughly equal to",
    VISIBLY: "visibly larger than",
    SOMEWHAT: "somewhat larger than",
}


def _apart(a, b):
    """How far two numbers are apart, as a share of the larger one."""
    if a == b:
        return 0
    return math.inf if math.inf in (abs(a), abs(b)) else abs(a - b) / max(abs(a), abs(b))


def without_gaps(data: Mapping[str, Any]) -> dict[str, Any]:
    """The same data without what is empty."""
    return {key: value for key, value in data.items() if value not in (None, "", {}, [])}


# ------------------------------------------------------------------------------------- which of two values is larger


def greater(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is the larger one.

    Arguments:
        left, right: real numbers of any kind, or expressions whose difference SymPy knows the sign of.
        quantity: what is compared, with its unit in brackets as on an axis: "cooling time [s]".
    Raises:
        EvidenceError: for what is no real number, and where the sign of a difference is not known.

    >>> greater(2.31, 1.59, "width")
    holds: width 2.31 > 1.59
    >>> K = sympy.Symbol("K", positive=True)
    >>> greater(K + 1, K)
    holds: K + 1 > K, proved
    """
    return _compared(left, ">", right, quantity)


def less(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is the smaller one; otherwise as `greater`.

    >>> less(12, 31.4, "cooling time [s]")
    holds: cooling time 12 s < 31.4 s
    """
    return _compared(left, "<", right, quantity)


def at_least(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is not the smaller one; otherwise as `greater`.

    >>> at_least(2, 2, "roots")
    holds: roots 2 ≥ 2
    """
    return _compared(left, "≥", right, quantity)


def at_most(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is not the larger one; otherwise as `greater`.

    >>> at_most(0.4, 0.3, "level error [m]")
    does not hold: level error 0.4 m not ≤ 0.3 m
    """
    return _compared(left, "≤", right, quantity)


def positive(value: Number, quantity: str = "") -> Comparison:
    """Evidence that a value is above zero; otherwise as `greater`.

    >>> positive(-3, "slope [m/s]")
    does not hold: slope -3 m/s not > 0
    """
    return _compared(value, ">", 0, quantity)


def negative(value: Number, quantity: str = "") -> Comparison:
    """Evidence that a value is below zero; otherwise as `greater`.

    >>> T = sympy.Symbol("T", positive=True)
    >>> negative(-1 / T, "root")
    holds: root -1/T < 0, proved
    """
    return _compared(value, "<", 0, quantity)


def _compared(left, relation, right, quantity):
    left, right = numbers_or_expressions(left, right)
    return Comparison(left, relation, right, *_named(quantity))


# ----------------------------------------------------------------------------------------- what is equal, and what not


def equal(left: object, right: object, quantity: str = "") -> Comparison:
    """Evidence that two values are equal: numbers to nine digits, formulas by proof, names and rows of them as such.

    Arguments:
        left, right: two numbers, two formulas or equations, two texts, or two collections of numbers and texts; where
            one is a set or a mapping, the order does not count.
        quantity: what is compared.
    Raises:
        EvidenceError: for what is none of these, for rounded decimals in a formula, and for a collection on both sides.

    >>> equal(0.1 + 0.2, 0.3)
    holds: 0.3 = 0.3
    >>> K, T = sympy.symbols("K T", positive=True)
    >>> equal(K / (T * K), 1 / T)
    holds: 1/T = 1/T, proved
    >>> equal({"V1", "V2"}, ["V1"], "valves")
    does not hold: valves V1, V2 ≠ V1
    """
    if left is right and isinstance(left, list | set | dict):
        raise EvidenceError(f"{in_one_line(repr(left))[:60]} is compared with itself: expected two computed values")
    left, right = anything(left, right)
    return Comparison(left, "=", right, *_named(quantity))


def different(left: object, right: object, quantity: str = "") -> Comparison:
    """Evidence that two values are not equal; otherwise as `equal`.

    >>> different(1, 2, "branches")
    holds: branches 1 ≠ 2
    """
    return equal(left, right, quantity).turned()


def zero(value: Number, quantity: str = "") -> Comparison:
    """Evidence that a value is exactly zero; for a rounded one ask whether it is `negligible`.

    >>> zero(sympy.sin(sympy.pi), "offset")
    holds: offset 0 = 0
    """
    return equal(value, 0, quantity)


def nonzero(value: Number, quantity: str = "") -> Comparison:
    """Evidence that a value is not zero.

    >>> nonzero(0.25, "deflection [m]")
    holds: deflection 0.25 m ≠ 0
    """
    return different(value, 0, quantity)


# ------------------------------------------------------------------------------------------------------- by a criterion


def about_equal(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that two numbers are the same but for 5 percent of the larger one.

    >>> about_equal(41, 40, "period [s]")
    holds: period 41 s about equal to 40 s (at most 5 % of the larger one apart)
    """
    return _by_ratio(left, right, quantity, SAME)


def roughly_equal(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the larger one of two numbers exceeds the smaller one by less than half of that.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> roughly_equal(0.21, 0.25, "ratio")
    holds: ratio 0.21 roughly equal to 0.25 (less than half of the smaller one apart)
    """
    return _by_ratio(left, right, quantity, ROUGHLY)


def negligible(value: Number, beside: Number, quantity: str = "") -> Ratio:
    """Evidence that a number is at most 5 percent of another one.

    >>> negligible(0.001, 0.5, "deflection [m]")
    holds: deflection 0.001 m negligible beside 0.5 m (at most 5 % of what it is compared with)
    """
    return _by_ratio(value, beside, quantity, NEGLIGIBLE)


def not_negligible(value: Number, beside: Number, quantity: str = "") -> Ratio:
    """Evidence that a number is more than 5 percent of another one, and so can be seen beside it.

    >>> not_negligible(0.1, 0.5, "deflection [m]")
    holds: deflection 0.1 m not negligible beside 0.5 m (at most 5 % of what it is compared with)
    """
    return negligible(value, beside, quantity).turned()


def much_greater(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the larger one by half of the other or more.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> much_greater(33, 30, "cooling time [s]")
    does not hold: cooling time 33 s not much larger than 30 s (by half of the smaller one or more)
    """
    return _by_ratio(left, right, quantity, MUCH)


def much_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the smaller one, and the other larger by half of it or more.

    >>> much_less(10, 30, "cooling time [s]")
    holds: cooling time 30 s much larger than 10 s (by half of the smaller one or more)
    """
    return _by_ratio(right, left, quantity, MUCH)


def somewhat_greater(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is larger by more than 5 percent and by less than half of the other.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> somewhat_greater(36, 30, "peak [K]")
    holds: peak 36 K somewhat larger than 30 K (by less than half of the smaller one, and by more than the 5 % that are about equal)
    """  # noqa: E501
    return _by_ratio(left, right, quantity, SOMEWHAT)


def somewhat_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the second of two numbers is somewhat larger; otherwise as `somewhat_greater`.

    >>> somewhat_less(10, 30, "peak [K]").holds
    False
    """
    return somewhat_greater(right, left, quantity)


def visibly_greater(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the larger one by more than 5 percent of it: for "seems".

    >>> visibly_greater(31, 30, "peak [K]")
    does not hold: peak 31 K not visibly larger than 30 K (more than 5 % of the larger one apart)
    """
    return _by_ratio(left, right, quantity, VISIBLY)


def visibly_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the second of two numbers is visibly larger; otherwise as `visibly_greater`.

    >>> visibly_less(12, 31.4, "cooling time [s]").holds
    True
    """
    return visibly_greater(right, left, quantity)


def within(value: Any, quantity: str, unit: str, criterion: Criterion) -> Comparison:
    """Return the evidence that a value, as `sides.numbers` returns it, is not above the limit of a criterion."""
    return Comparison(value, "≤", criterion.limit, quantity, unit, criterion)


def _by_ratio(left, right, quantity, criterion):
    return Ratio(*numbers(left, right), *_named(quantity), criterion)


def _named(quantity):
    """A quantity and its unit, which is in brackets as on an axis."""
    if not isinstance(quantity, str):
        raise EvidenceError(f'the quantity is {quantity!r}: expected text, as "cooling time [s]"')
    name, unit = re.fullmatch(r"(.*?)\s*(?:\[([^\[\]]*)\])?", in_one_line(quantity)).groups()
    return name, unit or ""
