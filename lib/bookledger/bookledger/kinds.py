"""What a book prints as a result: a number or several, a formula, the name of something, or a claim.

Each kind reads its text once, knows which computed values are of its kind and how they agree with the print, and writes
them for a reader.
"""

from __future__ import annotations

import decimal
import functools
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Self, TypeAlias

import sympy

from bookledger.evidence import Evidence
from bookledger.evidence import values as known
from bookledger.evidence.criteria import MAY, of_degree
from bookledger.evidence.sides import ROUNDING
from bookledger.evidence.values import NUMBER, half_unit, in_one_line
from bookledger.units import without_unit
from plainmath.tables import typeset

__all__ = ["KINDS", "Claim", "Complex", "Formula", "Name", "Number", "Printed", "Range", "Vector"]

INFINITE = {"oo": math.inf, "-oo": -math.inf}


@dataclass(frozen=True)
class Number:
    """A number as it is printed: its digits carry the tolerance, and an integer is exact unless it says how it is rounded.

    Attributes:
        text: as printed, such as "1.50", "2e-3" or "oo".
        value: the number itself.
        unit: as printed; empty where there is none.
        rounded_to: the unit of its last digit where the digits do not tell it, as "10" for a rounded 1500.
    """  # noqa: E501

    kind: ClassVar[str] = "number"
    text: str
    value: Fraction | float
    unit: str = ""
    rounded_to: str = ""

    @classmethod
    def read(cls, text: str, unit: str = "", rounded_to: str = "") -> Self:
        """Read a printed number, or raise ValueError."""
        if not NUMBER.fullmatch(text) and text not in INFINITE:
            raise ValueError(
                f"{text!r}, expected a number like 1.50 or 2e-3, or else a kind such as 'formula' or 'name'"
            )
        if rounded_to and not (_is_integer(text) and NUMBER.fullmatch(rounded_to) and Fraction(rounded_to) > 0):
            raise ValueError(f"{text!r} rounded to {rounded_to!r}, expected an integer that is rounded to a number")
        return cls(text, INFINITE[text] if text in INFINITE else Fraction(text), unit, rounded_to)

    def like(self, text: str) -> Self:
        """Read another number in the same unit, or raise ValueError."""
        return type(self).read(text, self.unit, self.rounded_to if _is_integer(text) else "")

    @property
    def is_finite(self) -> bool:
        """Whether it has digits."""
        return isinstance(self.value, Fraction)

    @property
    def tolerance(self) -> Fraction:
        """How far a value may lie from the print: half a unit of its last digit, rounding alone for an integer."""
        if self.rounded_to:
            return Fraction(self.rounded_to) / 2
        return ROUNDING * max(1, abs(self.value)) if _is_integer(self.text) else half_unit(self.text)

    def computed(self, value: object) -> Fraction | float:
        """Return a computed value, which may have a unit, as an exact number in the unit of the print.

        Raises TypeError for what is no real number, and ValueError for one with a unit of another kind.
        """
        return known.number(without_unit(value, self.unit))

    def agrees(self, value: Fraction | float) -> str:
        """Return "digits" where the value is within the tolerance of the print, otherwise nothing."""
        if not self.is_finite or isinstance(value, float):
            return "digits" if value == self.value else ""
        return "digits" if abs(value - self.value) <= self.tolerance else ""

    def is_coarser_than(self, other: Number) -> bool:
        """Whether it has fewer digits than another one, and so a wider tolerance."""
        if not (self.is_finite and other.is_finite):
            return False
        digits = [len(decimal.Decimal(number.text).as_tuple().digits) for number in (self, other)]
        return digits[0] < digits[1] and self.tolerance > other.tolerance

    def written(self, value: Fraction | float, *others: Number) -> str:
        """Return a computed value as text, four digits beyond the finest print, without trailing zeros."""
        return known.spelled_number(value, *(number.text for number in (self, *others)))

    def latex(self, text: str) -> str:
        """Return the text of a number as it is typeset."""
        return {"oo": r"$\infty$", "-oo": r"$-\infty$"}.get(text, text)


def _is_integer(text):
    return re.fullmatch(r"[+-]?\d+", text) is not None


@dataclass(frozen=True)
class _Several:
    """Several numbers as they are printed, each with the tolerance of its digits."""

    kind: ClassVar[str]
    form: ClassVar[str]  # as a reader of the ledger sees what is expected
    text: str
    parts: tuple[Number, ...]

    @classmethod
    def read(cls, text: str, unit: str = "", rounded_to: str = "") -> Self:
        """Read the printed numbers, or raise ValueError."""
        texts = cls._split(text)
        if not texts or not all(map(NUMBER.fullmatch, texts)):
            raise ValueError(f"{text!r}, expected a {cls.kind} like {cls.form}")
        return cls(text, tuple(Number.read(part, unit, rounded_to) for part in texts))

    @staticmethod
    def _split(text: str) -> list[str]:
        raise NotImplementedError

    def like(self, text: str) -> Self:
        """Read as many other numbers in the same unit, or raise ValueError."""
        return type(self).read(text, self.parts[0].unit, self.parts[0].rounded_to)

    def computed(self, value: Any) -> tuple[Fraction | float, ...]:
        """Return as many computed numbers, or raise TypeError."""
        values = tuple(value) if isinstance(value, Iterable) and not isinstance(value, str) else (value,)
        if len(values) != len(self.parts):
            raise TypeError(f"{in_one_line(repr(value))[:60]}: expected {len(self.parts)} numbers")
        return tuple(part.computed(own) for part, own in zip(self.parts, values, strict=True))

    def agrees(self, values: tuple[Fraction | float, ...]) -> str:
        """Return "digits" where every number is within its tolerance, otherwise nothing."""
        return "digits" if all(part.agrees(own) for part, own in zip(self.parts, values, strict=True)) else ""

    def written(self, values: tuple[Fraction | float, ...], *others: _Several) -> str:
        """Return the computed numbers as text."""
        return self._joined([part.written(own) for part, own in zip(self.parts, values, strict=True)])

    def _joined(self, texts: list[str]) -> str:
        return ", ".join(texts)

    def latex(self, text: str) -> str:
        """Return the text: numbers are written as they are."""
        return text


class Vector(_Several):
    """Numbers in a row."""

    kind = "vector"
    form = "0.5, 1.20, 3.0"

    @staticmethod
    def _split(text: str) -> list[str]:
        return [part.strip() for part in text.strip("[]()").split(",")]


class Range(_Several):
    """The two ends of a range, the lower one first."""

    kind = "range"
    form = "0.5 to 2.0"

    @staticmethod
    def _split(text: str) -> list[str]:
        ends = [part.strip() for part in text.split(" to ")]
        return ends if len(ends) == 2 else []

    def _joined(self, texts: list[str]) -> str:
        return " to ".join(texts)


class Complex(_Several):
    """A complex number."""

    kind = "complex"
    form = "-0.50 + 1.2i"

    @staticmethod
    def _split(text: str) -> list[str]:
        found = re.fullmatch(rf"({NUMBER.pattern})([+-])((?:{NUMBER.pattern})?)[ij]", text.replace(" ", ""))
        if not found:
            return []
        sign, size = re.fullmatch(r".*?([+-])([^+-]*(?:[eE][+-]?\d+)?)[ij]", text.replace(" ", "")).groups()
        return [found[1], f"{sign}{size or 1}".removeprefix("+")]

    def computed(self, value: Any) -> tuple[Fraction | float, ...]:
        """Return the real and the imaginary part, or raise TypeError."""
        try:
            return super().computed(sympy.sympify(value).as_real_imag())
        except (sympy.SympifyError, AttributeError):
            raise TypeError(f"{in_one_line(repr(value))[:60]}: expected a complex number") from None

    def _joined(self, texts: list[str]) -> str:
        real, imaginary = texts
        return f"{real} {'-' if imaginary.startswith('-') else '+'} {imaginary.removeprefix('-')}i"


@dataclass(frozen=True)
class Formula:
    """An expression or an equation as it is printed.

    Attributes:
        text: as Python writes it.
        value: the same as SymPy's.
        real: the symbols in it that may have either sign; all others are positive.
    """

    kind: ClassVar[str] = "formula"
    text: str
    value: known.Formula
    real: str = ""

    @classmethod
    def read(cls, text: str, real: str = "") -> Self:
        """Read a printed formula, or raise ValueError."""
        return cls(text, known.parse_formula(text, real), real)

    def like(self, text: str) -> Self:
        """Read another formula in the same symbols, or raise ValueError."""
        return type(self).read(text, self.real)

    def computed(self, value: object) -> known.Formula:
        """Return a computed formula in the ledger's symbols, or raise TypeError."""
        return known.formula(value, self.real)

    def agrees(self, value: known.Formula) -> str:
        """Return "proved" or "probed" where the formulas are equal, otherwise nothing."""
        return known.formula_agrees(value, self.text, self.real)

    def written(self, value: known.Formula, *others: Formula) -> str:
        """Return a computed formula as text."""
        return f"{value.lhs} = {value.rhs}" if isinstance(value, sympy.Equality) else str(value)

    def latex(self, text: str) -> str:
        """Return the text of a formula as it is typeset."""
        return _latex(text)


@functools.lru_cache(maxsize=4096)  # a report shows it as a page and as data
def _latex(text):
    try:
        return text if NUMBER.fullmatch(text) else typeset(known.parse_formula(text))
    except ValueError:  # what SymPy prints is not always what it reads
        return text


@dataclass(frozen=True)
class Name:
    """The name of something: a valve, a material, an entry of a table of words."""

    kind: ClassVar[str] = "name"
    text: str

    @classmethod
    def read(cls, text: str) -> Self:
        """Take a printed name."""
        return cls(text)

    def like(self, text: str) -> Self:
        """Take another name."""
        return type(self)(text)

    def computed(self, value: object) -> str:
        """Return a computed name in one line, or raise TypeError."""
        return known.name_of(value)

    def agrees(self, value: str) -> str:
        """Return "word" for the same name, whatever its case, otherwise nothing."""
        return "word" if value.casefold() == self.text.casefold() else ""

    def written(self, value: str, *others: Name) -> str:
        """Return the name."""
        return value

    def latex(self, text: str) -> str:
        """Return the name: it holds no formula."""
        return text


@dataclass(frozen=True)
class Claim:
    """A sentence that is true or false, and what the book says of it.

    Attributes:
        text: the sentence, in the ledger's words.
        says: whether the book says it is true.
        about: the quantities that it is about, which evidence must name, and no others.
        degree: the book's words of degree in it, whose criteria evidence must rest on.
        measures: the quantities by which the source judges what is said, each of which evidence must name.
    """

    kind: ClassVar[str] = "claim"
    text: str
    says: bool = True
    about: frozenset[str] = frozenset()
    degree: tuple[str, ...] = ()
    measures: tuple[str, ...] = ()

    def computed(self, value: object) -> Evidence:
        """Return the evidence.

        Raises TypeError for anything else, and ValueError for evidence about other quantities, by other measures, or
        by other words of degree than the claim's.
        """
        if not isinstance(value, Evidence):
            raise TypeError(f"{in_one_line(repr(value))[:60]}: hand over evidence, as greater(2.3, 1.6)")
        if value.quantities != self.about:
            raise ValueError(f"evidence about {_listed(value.quantities)}: the claim is about {_listed(self.about)}")
        for measure in self.measures:
            if not any(measure in quantity for quantity in value.quantities):
                raise ValueError(f"evidence about {_listed(value.quantities)}: the claim is judged by {measure}")
        of_the_claim = {of_degree(word) for word in self.degree}
        of_ours = {criterion for criterion in value.criteria if criterion.degrees and not criterion.published}
        if missing := of_the_claim - {*value.criteria} - ({MAY} if value.holds else set()):
            words = [word for word in self.degree if of_degree(word) in missing]
            raise ValueError(f"evidence without the criterion for {_listed(words)}, which the book says")
        if others := of_ours - of_the_claim:
            raise ValueError(
                f"evidence by the criterion {_listed(c.word for c in others)}: the book has no word for it"
            )
        return value

    def agrees(self, evidence: Evidence) -> str:
        """Return "evidence", or "probed", where it says of the sentence what the book says, otherwise nothing."""
        if evidence.holds is not self.says:
            return ""
        return "probed" if evidence.probed else "evidence"

    def written(self, evidence: Evidence, *others: Claim) -> str:
        """Return the evidence as text."""
        return evidence.told()

    def latex(self, text: str) -> str:
        """Return the sentence: it holds no formula."""
        return text


def _listed(words):
    return ", ".join(sorted(words)) or "nothing that it names"


#: What a book prints as a result.
Printed: TypeAlias = Number | Vector | Range | Complex | Formula | Name | Claim

#: The kinds by name, as the ledger writes them; a claim is known by its sentence.
KINDS: dict[str, Any] = {kind.kind: kind for kind in (Number, Vector, Range, Complex, Formula, Name)}
