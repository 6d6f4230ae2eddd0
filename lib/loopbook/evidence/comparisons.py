"""Two values compared: numbers by size, formulas by proof, names by the word; strictly, or by a criterion."""

from __future__ import annotations

import functools
import math
import operator
import re
from collections.abc import Callable, Collection, Mapping, Set
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy

from loopbook.evidence.criteria import (
    MUCH,
    NEGLIGIBLE,
    NO_OVERSHOOT,
    SAME,
    SOMEWHAT,
    SUBSTANTIALLY,
    WELL_DAMPED,
    Criterion,
)
from loopbook.evidence.values import formulas_agree, in_one_line, number
from loopbook.expressions import exact

if TYPE_CHECKING:
    from loopbook.types import Number

#: What the sides of a comparison are: numbers, formulas, or names in a row.
Value: TypeAlias = Fraction | float | sympy.Expr | sympy.Equality | tuple
#: How a formula is written into a sentence.
Typeset: TypeAlias = Callable[[Any], str]

_HOLDS = {">": operator.gt, "<": operator.lt, "≥": operator.ge, "≤": operator.le}
_CONTRARY = {">": "≤", "≤": ">", "<": "≥", "≥": "<", "=": "≠", "≠": "="}
_ROUNDING = Fraction(1, 10**9)  # what floats that are equal may differ by, as a share of the larger one


class EvidenceError(ValueError):
    """What is no evidence: one sentence that names the value and what was expected."""


class Evidence:
    """What decides a claim.

    Attributes:
        holds: whether it speaks for the claim.
        near: whether a criterion with half or twice its limit would give another verdict.
        criteria: those it rests on.
        data: all of it as JSON data, from which it can be judged again.
    """

    holds: bool
    near: bool
    criteria: tuple[Criterion, ...] = ()
    data: dict[str, Any]

    def told(self, typeset: Typeset = str) -> str:
        """The evidence as a sentence with its numbers; `typeset` writes the formulas in it."""
        raise NotImplementedError

    def turned(self) -> Evidence:
        """The evidence for the contrary: with sides exchanged, or a counterexample added."""
        raise NotImplementedError

    def __bool__(self) -> bool:
        raise TypeError("evidence is no truth value: hand it to a check, or ask whether it `holds`")

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

    left: Value
    relation: str
    right: Value
    quantity: str = ""
    unit: str = ""
    criterion: Criterion | None = None

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criterion, if there is one."""
        return (self.criterion,) if self.criterion else ()

    @property
    def holds(self) -> bool:
        """Whether the relation is between the two values."""
        return self._is_so(self.right)

    def _is_so(self, right):
        if self.relation in "=≠":
            return bool(self._how) is (self.relation == "=")
        if isinstance(self.left, sympy.Basic) or isinstance(right, sympy.Basic):
            return _HOLDS[self.relation](_sign(self.left, right), 0)
        return _HOLDS[self.relation](self.left, right)

    @property
    def _how(self):
        """How the two are equal; empty where they are not."""
        return _equal(self.left, self.right)

    @property
    def near(self) -> bool:
        """Whether the verdict hangs on the limit, or on a few percent."""
        if self.criterion:
            return len({self._is_so(self.right * factor) for factor in (Fraction(1, 2), 1, 2)}) > 1
        if self.relation in "=≠" or not all(isinstance(side, Fraction) for side in (self.left, self.right)):
            return False
        return self.left != 0 != self.right and _apart(self.left, self.right) <= SAME.limit

    def turned(self) -> Comparison:
        """The same values in the contrary relation."""
        return replace(self, relation=_CONTRARY[self.relation])

    def told(self, typeset: Typeset = str) -> str:
        """The quantity, its values and the relation, as in "Ms 2.31 > 1.59"."""
        relation = self.relation if self.holds else {"=": "≠", "≠": "="}.get(self.relation, f"not {self.relation}")
        left, right = sides(self.left, self.right, self.unit, typeset)
        how = ", proved" if isinstance(self.left, sympy.Basic) or isinstance(self.right, sympy.Basic) else ""
        how = ", at random points" if how and self.relation == "=" and self._how == "probed" else how
        why = f" ({self.criterion.word}: {self.criterion.meaning})" if self.criterion else ""
        return f"{self.quantity} {left} {relation} {right}{how}{why}".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The values, with enough digits to judge them again."""
        left, right = written(self.left, self.right)
        told = {"quantity": self.quantity, "unit": self.unit, "criterion": self.criterion and self.criterion.word}
        return {
            "kind": "comparison", "of": _kind_of(self.left, self.right),
            "left": left, "relation": self.relation, "right": right,
            "holds": self.holds, "near": self.near, **without_gaps(told),
        }  # fmt: skip


@dataclass(frozen=True, repr=False)
class Ratio(Evidence):
    """Two numbers, and a criterion on how much larger one is than the other.

    Attributes:
        left, right: the numbers, none of them negative.
        quantity, unit: what is compared.
        criterion: SAME, SOMEWHAT, MUCH, SUBSTANTIALLY or NEGLIGIBLE.
        contrary: whether it is said not to be so.
    """

    left: Fraction | float
    right: Fraction | float
    quantity: str
    unit: str
    criterion: Criterion
    contrary: bool = False

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criterion."""
        return (self.criterion,)

    @property
    def holds(self) -> bool:
        """Whether the criterion says so."""
        return _BY_RATIO[self.criterion](self.left, self.right, self.criterion.limit) is not self.contrary

    @property
    def near(self) -> bool:
        """Whether half or twice the limit gives another verdict."""
        judge, limit = _BY_RATIO[self.criterion], self.criterion.limit
        return len({judge(self.left, self.right, limit * factor) for factor in (Fraction(1, 2), 1, 2)}) > 1

    def turned(self) -> Ratio:
        """The same numbers, for the contrary."""
        return replace(self, contrary=not self.contrary)

    def told(self, typeset: Typeset = str) -> str:
        """The numbers and the word for what is between them."""
        left, right = sides(self.left, self.right, self.unit, typeset)
        so = self.holds is not self.contrary
        word = {SOMEWHAT: "somewhat larger than", MUCH: "much larger than", NEGLIGIBLE: "negligible beside",
                SAME: "about equal to", SUBSTANTIALLY: "substantially smaller than"}[self.criterion]  # fmt: skip
        return f"{self.quantity} {left} {'' if so else 'not '}{word} {right} ({self.criterion.meaning})".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The values, with enough digits to judge them again."""
        left, right = written(self.left, self.right)
        return {
            "kind": "ratio", "left": left, "right": right, "criterion": self.criterion.word,
            "limit": written(self.criterion.limit)[0], "contrary": self.contrary,
            "holds": self.holds, "near": self.near, **without_gaps({"quantity": self.quantity, "unit": self.unit}),
        }  # fmt: skip


_BY_RATIO = {
    SAME: lambda a, b, limit: _apart(a, b) <= limit,
    NEGLIGIBLE: lambda a, b, limit: abs(a) <= limit * abs(b),
    SOMEWHAT: lambda a, b, limit: b < a < (1 + limit) * b,
    MUCH: lambda a, b, limit: a > b and a >= (1 + limit) * b,
    SUBSTANTIALLY: lambda a, b, limit: a <= limit * b,
}


def _apart(a, b):
    """How far two numbers are apart, as a share of the larger one."""
    if a == b:
        return 0
    return math.inf if math.inf in (abs(a), abs(b)) else abs(a - b) / max(abs(a), abs(b))


# ------------------------------------------------------------------------------------- which of two values is larger


def greater(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is the larger one.

    Arguments:
        left, right: real numbers of any kind, or expressions whose difference SymPy knows the sign of.
        quantity: what is compared, with its unit in brackets as on an axis: "settling time [s]".
    Raises:
        EvidenceError: for what is no real number, and where the sign of a difference is not known.

    >>> greater(2.31, 1.59, "Ms")
    holds: Ms 2.31 > 1.59
    >>> K = sympy.Symbol("K", positive=True)
    >>> greater(K + 1, K)
    holds: K + 1 > K, proved
    """
    return _compared(left, ">", right, quantity)


def less(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is the smaller one; otherwise as `greater`.

    >>> less(12, 31.4, "settling time [s]")
    holds: settling time 12 s < 31.4 s
    """
    return _compared(left, "<", right, quantity)


def at_least(left: Number, right: Number, quantity: str = "") -> Comparison:
    """Evidence that the first of two values is not the smaller one; otherwise as `greater`.

    >>> at_least(2, 2, "poles")
    holds: poles 2 ≥ 2
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

    >>> positive(-3, "gain [m/%]")
    does not hold: gain -3 m/% not > 0
    """
    return _compared(value, ">", 0, quantity)


def negative(value: Number, quantity: str = "") -> Comparison:
    """Evidence that a value is below zero; otherwise as `greater`.

    >>> T = sympy.Symbol("T", positive=True)
    >>> negative(-1 / T, "pole")
    holds: pole -1/T < 0, proved
    """
    return _compared(value, "<", 0, quantity)


def _compared(left, relation, right, quantity):
    return Comparison(_number_or_expression(left), relation, _number_or_expression(right), *_named(quantity))


@functools.cache
def _sign(left, right):
    """The sign of a difference of expressions, proved."""
    left, right = (sympy.Rational(x) if isinstance(x, Fraction) else sympy.sympify(x) for x in (left, right))
    difference = left - right
    for simpler in (sympy.factor, lambda x: sympy.factor(sympy.together(x)), sympy.simplify):
        found = simpler(difference)
        for sign, known in ((1, found.is_positive), (-1, found.is_negative), (0, found.is_zero)):
            if known:
                return sign
    raise EvidenceError(f"the sign of {difference} is not known: expected numbers, or symbols that decide it")


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
    if any(isinstance(side, Set | Mapping) for side in (left, right)):
        left, right = (sorted(_row(side)) if isinstance(side, Collection) else side for side in (left, right))
    return Comparison(_any(left), "=", _any(right), *_named(quantity))


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

    >>> nonzero(0.25, "control error [m]")
    holds: control error 0.25 m ≠ 0
    """
    return different(value, 0, quantity)


@functools.cache
def _equal(left, right):
    """How two values are equal: "exact", "proved", "probed", or empty where they are not."""
    if isinstance(left, tuple) or isinstance(right, tuple):
        return "exact" if left == right else ""
    if isinstance(left, sympy.Basic) or isinstance(right, sympy.Basic):
        left, right = (sympy.Rational(x) if isinstance(x, Fraction) else sympy.sympify(x) for x in (left, right))
        return formulas_agree(left, right)
    if math.inf in (abs(left), abs(right)):
        return "exact" if left == right else ""
    return "exact" if abs(left - right) <= _ROUNDING * max(abs(left), abs(right)) else ""


# ------------------------------------------------------------------------------------------------------- by a criterion


def about_equal(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that two numbers are the same but for 5 percent of the larger one.

    >>> about_equal(41, 40, "period [s]")
    holds: period 41 s about equal to 40 s (at most 5 % of the larger one apart)
    """
    return Ratio(_number(left), _number(right), *_named(quantity), SAME)


def negligible(value: Number, beside: Number, quantity: str = "") -> Ratio:
    """Evidence that a number is at most 5 percent of another one.

    >>> negligible(0.001, 0.5, "control error [m]")
    holds: control error 0.001 m negligible beside 0.5 m (at most 5 % of what it is compared with)
    """
    return Ratio(_number(value), _number(beside), *_named(quantity), NEGLIGIBLE)


def not_negligible(value: Number, beside: Number, quantity: str = "") -> Ratio:
    """Evidence that a number is more than 5 percent of another one, and so can be seen beside it.

    >>> not_negligible(0.1, 0.5, "control error [m]")
    holds: control error 0.1 m not negligible beside 0.5 m (at most 5 % of what it is compared with)
    """
    return negligible(value, beside, quantity).turned()


def somewhat_greater(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the larger one, but by less than half of the other.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> somewhat_greater(34, 28, "overshoot [%]")
    holds: overshoot 34 % somewhat larger than 28 % (by less than half of the smaller one)
    """
    return _by_ratio(left, right, quantity, SOMEWHAT)


def somewhat_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the smaller one, but not by half of it.

    >>> somewhat_less(28, 34, "phase margin [°]")
    holds: phase margin 34° somewhat larger than 28° (by less than half of the smaller one)
    """
    return _by_ratio(right, left, quantity, SOMEWHAT)


def much_greater(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the larger one by half of the other or more.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> much_greater(33, 30, "settling time [s]")
    does not hold: settling time 33 s not much larger than 30 s (by half of the smaller one or more)
    """
    return _by_ratio(left, right, quantity, MUCH)


def much_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is the smaller one, and the other larger by half of it or more.

    >>> much_less(10, 30, "settling time [s]")
    holds: settling time 30 s much larger than 10 s (by half of the smaller one or more)
    """
    return _by_ratio(right, left, quantity, MUCH)


def substantially_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is a fifth of the other one or less.

    Raises EvidenceError for negative numbers, of which no ratio speaks.

    >>> substantially_less(3, 30, "area [K s]")
    holds: area 3 K s substantially smaller than 30 K s (to a fifth or less)
    """
    return _by_ratio(left, right, quantity, SUBSTANTIALLY)


def not_substantially_less(left: Number, right: Number, quantity: str = "") -> Ratio:
    """Evidence that the first of two numbers is more than a fifth of the other one.

    >>> not_substantially_less(20, 30, "area [K s]")
    holds: area 20 K s not substantially smaller than 30 K s (to a fifth or less)
    """
    return substantially_less(left, right, quantity).turned()


def no_overshoot(overshoot: Number) -> Comparison:
    """Evidence that a step response stays below 102 percent of the step.

    Arguments:
        overshoot: as a fraction of the step.

    >>> no_overshoot(0.013)
    holds: overshoot 1.3 % ≤ 2 % (no overshoot: at most 2 % of the step)
    """
    return Comparison(100 * _number(overshoot), "≤", NO_OVERSHOOT.limit, "overshoot", "%", NO_OVERSHOOT)


def overshoots(overshoot: Number) -> Comparison:
    """Evidence that a step response rises above 102 percent of the step; `overshoot` is a fraction of the step.

    >>> overshoots(0.28).holds
    True
    """
    return no_overshoot(overshoot).turned()


def well_damped(decay_ratio: Number) -> Comparison:
    """Evidence that each peak of a response is at most a quarter of the one before it.

    >>> well_damped(0.11).holds, well_damped(0.4).holds
    (True, False)
    """
    return Comparison(_number(decay_ratio), "≤", WELL_DAMPED.limit, "decay ratio", "", WELL_DAMPED)


def _by_ratio(left, right, quantity, criterion):
    left, right = _number(left), _number(right)
    if left < 0 or right < 0:
        raise EvidenceError(f"{left} beside {right}: how much larger one is asks for numbers that are not negative")
    return Ratio(left, right, *_named(quantity), criterion)


# ------------------------------------------------------------------------------------------------------- reading values


def _number(value):
    try:
        return number(value)
    except TypeError as error:
        raise EvidenceError(f"evidence needs a real number, got {error}") from None


def _number_or_expression(value):
    try:
        return number(value)
    except TypeError as error:
        if isinstance(value, sympy.Expr):
            return _expression(value)
        raise EvidenceError(f"evidence needs a real number or an expression, got {error}") from None


def _expression(value):
    if value.has(sympy.Float):
        raise EvidenceError(f"{value} holds rounded decimals: give exact numbers")
    if value.has(sympy.nan, sympy.zoo, sympy.AccumBounds):
        raise EvidenceError(f"{value} has no value")
    return exact(value) if isinstance(value, sympy.Expr) else value


def _any(value):
    if isinstance(value, sympy.Equality):
        return _expression(value)
    if isinstance(value, Collection) and not isinstance(value, sympy.Basic):
        return _row(value)
    return _number_or_expression(value)


def _row(collection):
    """A collection as texts in a row; a mapping by its items."""
    if isinstance(collection, str):
        return (in_one_line(collection),)
    if isinstance(collection, Mapping):
        return tuple(f"{key}: {value}" for key, value in collection.items())
    return tuple(map(str, collection))


def _named(quantity):
    """A quantity and its unit, which is in brackets as on an axis."""
    if not isinstance(quantity, str):
        raise EvidenceError(f'the quantity is {quantity!r}: expected text, as "settling time [s]"')
    name, unit = re.fullmatch(r"(.*?)\s*(?:\[([^\[\]]*)\])?", in_one_line(quantity)).groups()
    return name, unit or ""


# ------------------------------------------------------------------------------------------------------- writing values


def sides(left: Value, right: Value, unit: str, typeset: Typeset = str) -> tuple[str, str]:
    """Two values as text, numbers with so many digits that they differ if they do, each with the unit."""
    texts = next(pair for digits in (3, 4, 6, 12) if (pair := _pair(left, right, digits, typeset)) or digits == 12)
    if texts is None:
        texts = tuple(_text(value, 12, typeset) for value in (left, right))
    space = "" if unit == "°" else " "
    return tuple(
        f"{text}{space}{unit}" if unit and isinstance(value, Fraction) and value else text
        for text, value in zip(texts, (left, right), strict=True)
    )


def _pair(left, right, digits, typeset):
    pair = tuple(_text(value, digits, typeset) for value in (left, right))
    return pair if pair[0] != pair[1] or isinstance(left, tuple | sympy.Basic) or _equal(left, right) else None


def _text(value, digits, typeset):
    if isinstance(value, tuple):
        return ", ".join(value) or "none"
    if isinstance(value, sympy.Basic):
        return typeset(value)
    return rounded(value, digits)


def rounded(value: Fraction | float, digits: int = 3) -> str:
    """A number with so many significant digits, without an exponent where it is of usual size.

    >>> rounded(Fraction(200, 3)), rounded(Fraction(1234)), rounded(Fraction(1, 3000)), rounded(math.inf)
    ('66.7', '1234', '0.000333', '∞')
    """
    if value in (math.inf, -math.inf):
        return "∞" if value > 0 else "-∞"
    if value == 0 or (value.denominator == 1 and abs(value) < 10**6):
        return str(value)
    if not Fraction(1, 10**4) <= abs(value) < 10**6:
        return f"{float(value):.{digits}g}"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    text = f"{float(round(value, places)):.{max(places, 0)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def written(*values: Value) -> tuple[str, ...]:
    """Values as data: numbers with as many digits as keep them apart, six at least."""
    for digits in (6, 9, 12, 15):
        texts = tuple(_as_data(value, digits) for value in values)
        if len(set(texts)) == len(set(map(str, values))):
            break
    return texts


def without_gaps(data: Mapping[str, Any]) -> dict[str, Any]:
    """The same data without what is empty."""
    return {key: value for key, value in data.items() if value not in (None, "", {}, [])}


def _kind_of(*values):
    if any(isinstance(value, tuple) for value in values):
        return "texts"
    return "formulas" if any(isinstance(value, sympy.Basic) for value in values) else "numbers"


def _as_data(value, digits):
    if isinstance(value, tuple):
        return ", ".join(value)
    if isinstance(value, sympy.Equality):
        return f"{value.lhs} = {value.rhs}"
    if isinstance(value, sympy.Basic):
        return str(value)
    return f"{float(value):.{digits}g}" if isinstance(value, Fraction) else ("oo" if value > 0 else "-oo")
