"""What a book prints as a result: a number, a formula, the name of something, or a claim.

Each kind reads its text once, knows which computed values are of its kind and how they agree with the print, and writes
them for a reader.
"""

from __future__ import annotations

import decimal
import functools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Self, TypeAlias

import sympy

from bookledger.evidence import Evidence
from bookledger.evidence import values as known
from bookledger.evidence.values import NUMBER, half_unit, in_one_line
from plainmath.tables import typeset

__all__ = ["KINDS", "Claim", "Formula", "Name", "Number", "Printed"]

INFINITE = {"oo": math.inf, "-oo": -math.inf}


@dataclass(frozen=True)
class Number:
    """A number as it is printed: its digits carry the tolerance.

    Attributes:
        text: as printed, such as "1.50", "2e-3" or "oo".
        value: the number itself.
    """

    kind: ClassVar[str] = "number"
    text: str
    value: Fraction | float

    @classmethod
    def read(cls, text: str) -> Self:
        """Read a printed number, or raise ValueError."""
        if not NUMBER.fullmatch(text) and text not in INFINITE:
            raise ValueError(f"{text!r}, expected a number like 1.50 or 2e-3, or else a kind 'formula' or 'name'")
        return cls(text, INFINITE[text] if text in INFINITE else Fraction(text))

    @property
    def is_finite(self) -> bool:
        """Whether it has digits."""
        return isinstance(self.value, Fraction)

    def computed(self, value: object) -> Fraction | float:
        """Return a computed value as an exact number, or raise TypeError."""
        return known.number(value)

    def agrees(self, value: Fraction | float) -> str:
        """Return "digits" where the value is within half a unit of the last printed digit, otherwise nothing."""
        if not self.is_finite or isinstance(value, float):
            return "digits" if value == self.value else ""
        return "digits" if abs(value - self.value) <= half_unit(self.text) else ""

    def is_coarser_than(self, other: Number) -> bool:
        """Whether it has fewer digits than another one, and so a wider tolerance."""
        if not (self.is_finite and other.is_finite):
            return False
        digits = [len(decimal.Decimal(number.text).as_tuple().digits) for number in (self, other)]
        return digits[0] < digits[1] and half_unit(self.text) > half_unit(other.text)

    def written(self, value: Fraction | float, *others: Number) -> str:
        """Return a computed value as text, four digits beyond the finest print, without trailing zeros."""
        return known.spelled_number(value, *(number.text for number in (self, *others)))

    def latex(self, text: str) -> str:
        """Return the text of a number as it is typeset."""
        return {"oo": r"$\infty$", "-oo": r"$-\infty$"}.get(text, text)


@dataclass(frozen=True)
class Formula:
    """An expression or an equation as it is printed.

    Attributes:
        text: as Python writes it.
        value: the same as SymPy's.
    """

    kind: ClassVar[str] = "formula"
    text: str
    value: known.Formula

    @classmethod
    def read(cls, text: str) -> Self:
        """Read a printed formula, or raise ValueError."""
        return cls(text, known.parse_formula(text))

    def computed(self, value: object) -> known.Formula:
        """Return a computed formula in the ledger's symbols, or raise TypeError."""
        return known.formula(value)

    def agrees(self, value: known.Formula) -> str:
        """Return "proved" or "probed" where the formulas are equal, otherwise nothing."""
        return known.formula_agrees(value, self.text)

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
    """

    kind: ClassVar[str] = "claim"
    text: str
    says: bool = True

    def computed(self, value: object) -> Evidence:
        """Return the evidence, or raise TypeError for anything else."""
        if not isinstance(value, Evidence):
            raise TypeError(f"{in_one_line(repr(value))[:60]}: hand over evidence, as greater(2.3, 1.6)")
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


#: What a book prints as a result.
Printed: TypeAlias = Number | Formula | Name | Claim

#: The kinds by name, as the ledger writes them; a claim is known by its sentence.
KINDS: dict[str, Any] = {kind.kind: kind for kind in (Number, Formula, Name)}
