"""What was done about a result that a book prints: a small class for each deed, which knows when it holds."""

from __future__ import annotations

import re
from dataclasses import MISSING, dataclass, fields
from fractions import Fraction
from typing import Any, ClassVar, Self

from bookledger.errors import LedgerError
from bookledger.evidence.values import NUMBER
from bookledger.kinds import Claim, Name, Number, Printed
from plainmath.validation import did_you_mean

__all__ = ["STATUSES", "Status"]


@dataclass(frozen=True)
class Status:
    """What was done about a result. The ledger must say its fields; one with a default may be missing.

    Attributes:
        word: the name of the status.
        meaning: what it says, for a reader.
        mark: a sign, and the class under which a page shows it; a tick is for agreement alone.
        is_checked: whether there is something to compute.
    """

    word: ClassVar[str]
    meaning: ClassVar[str]
    mark: ClassVar[tuple[str, str]] = ("✓", "agrees")
    is_checked: ClassVar[bool] = True

    @classmethod
    def read(cls, where: str, printed: Printed, told: dict[str, str]) -> Self:
        """Make the status of what the ledger tells of it, or raise LedgerError."""
        own = {field.name: field.default is MISSING for field in fields(cls)}
        for key in KEYS:
            if key in told and key not in own:
                raise LedgerError(f"{where}: the status {cls.word!r} has no use for {key!r}")
            if key not in told and own.get(key):
                raise LedgerError(f"{where}: the status {cls.word!r} needs {key!r}")
        status = cls(**told)
        status._validate(where, printed)
        return status

    def _validate(self, where, printed):
        pass

    def judge(self, printed: Printed, value: Any) -> str:
        """Say how a computed value of the result's kind bears the status out; empty where it does not."""
        return printed.agrees(value)

    @property
    def note(self) -> str:
        """What a reader must know besides. Empty where there is nothing."""
        return ""

    def complaint(self, printed: Printed) -> str:
        """What a value that does not hold fails to do."""
        if isinstance(printed, Claim):
            return f"does not say that it is {'true' if printed.says else 'false'}: {printed.text}"
        return f"does not agree with the printed {printed.text}"

    def others(self, printed: Printed) -> tuple[Printed, ...]:
        """Further values of the result's kind that the ledger holds."""
        return ()


@dataclass(frozen=True)
class Computed(Status):
    """Derived or computed."""

    word = "computed"
    meaning = "derived or computed from what the book gives, and equal to the print"


@dataclass(frozen=True)
class Quoted(Status):
    """Taken from the page that it is checked against."""

    word = "quoted"
    meaning = "a constant or a definition that the library took from that very page: checked for consistency only"
    mark = ("=", "quoted")
    library: str

    @property
    def note(self) -> str:
        """The name of what holds it, with its module."""
        return f"quoted by {self.library}"


@dataclass(frozen=True)
class Observed(Status):
    """Seen on a model, in an example or by a criterion of ours."""

    word = "observed"
    meaning = "seen on a model, in an example or by a criterion of ours, where the book has none"
    on: str

    @property
    def note(self) -> str:
        """Where it was observed."""
        return f"observed on {self.on}"


@dataclass(frozen=True)
class Reconstructed(Status):
    """Computed from an assumption in place of an input that is not printed."""

    word = "reconstructed"
    meaning = "an input is not printed; one stated assumption supplies several results"
    assuming: str
    within: str = ""

    def _validate(self, where, printed):
        is_word = isinstance(printed, Claim | Name)  # which has no margin
        if is_word is bool(self.within):
            verb = "has no use for" if is_word else "needs"
            raise LedgerError(f"{where}: the status 'reconstructed' of a {printed.kind} {verb} 'within'")
        if self.within:
            self.margin(printed, where)

    def margin(self, printed: Printed, where: str = "") -> Fraction:
        """How far a number may lie from the print: `within`, absolute or in percent of the print."""
        amount, percent = re.fullmatch(r"(.*?)(\s*%)?", self.within).groups()
        if not isinstance(printed, Number) or not printed.is_finite:
            raise LedgerError(f"{where}: {printed.text!r} cannot be reconstructed, expected a number")
        if not NUMBER.fullmatch(amount) or not 0 < Fraction(amount) < (100 if percent else float("inf")):
            raise LedgerError(
                f"{where}: within is {self.within!r}, expected a positive number, or a percentage below 100 %"
            )
        if percent and not printed.value:
            raise LedgerError(f"{where}: within is {self.within!r} of 0, expected a positive number")
        return Fraction(amount) / 100 * abs(printed.value) if percent else Fraction(amount)

    def judge(self, printed: Printed, value: Any) -> str:
        """Say "within" where a number is within its margin; what is not a number agrees as usual."""
        if not self.within:
            return printed.agrees(value)
        return "within" if abs(value - printed.value) <= self.margin(printed) else ""

    @property
    def note(self) -> str:
        """The assumption."""
        return f"reconstructed{f' to within {self.within}' if self.within else ''}, assuming {self.assuming}"

    def complaint(self, printed: Printed) -> str:
        """The margin that is missed."""
        return (
            f"is not within {self.within} of the printed {printed.text}" if self.within else super().complaint(printed)
        )


class Contrary(Status):
    """What was found instead of the print: a value that agrees, where the print does not.

    Of a claim it is a sentence, and evidence contradicts the claim.
    """

    key: ClassVar[str]  # under which the ledger tells it
    because: str

    @property
    def found(self) -> str:
        """What the value must agree with."""
        return getattr(self, self.key)

    def _validate(self, where, printed):
        if self.found:
            _value(where, self.key, self.found, printed)

    def judge(self, printed: Printed, value: Any) -> str:
        """Say how the value agrees with what was found; empty where it does not, or where the print holds too."""
        if printed.agrees(value):
            return ""
        return "evidence" if isinstance(printed, Claim) else type(printed).read(self.found).agrees(value)

    @property
    def note(self) -> str:
        """The reason, as far as it is known."""
        return f"{self.word}: {self.because}"

    def complaint(self, printed: Printed) -> str:
        """What it takes to differ from the print."""
        if isinstance(printed, Claim):
            return f"bears out what is {self.word}: {printed.text}"
        return f"must agree with {self.found} and not with the printed {printed.text} to be {self.word}"

    def others(self, printed: Printed) -> tuple[Printed, ...]:
        """What was found."""
        return () if isinstance(printed, Claim) or not self.found else (type(printed).read(self.found),)


@dataclass(frozen=True)
class Corrected(Contrary):
    """The print is wrong."""

    word = "corrected"
    meaning = "the book is wrong, and the computation says what is right"
    mark = ("≠", "differs")
    key = "correct"
    correct: str
    because: str


@dataclass(frozen=True)
class Damaged(Corrected):
    """Our copy of the text is wrong."""

    word = "damaged"
    meaning = "our copy of the text is damaged here: no error of the authors"


@dataclass(frozen=True)
class Unreproduced(Contrary):
    """The print and the computation differ, and nobody knows why."""

    word = "unreproduced"
    meaning = "all is known and it does not agree, or what it takes is not printed"
    mark = ("?", "open")
    key = "computed"
    because: str
    computed: str = ""  # what it takes may not be printed: then there is nothing to compare

    @property
    def is_checked(self) -> bool:
        """Whether something can be computed."""
        return bool(self.computed)


@dataclass(frozen=True)
class Measured(Status):
    """Laboratory data."""

    word = "measured"
    meaning = "laboratory data, nothing to compute"
    mark = ("–", "open")
    is_checked = False
    because: str

    @property
    def note(self) -> str:
        """Where it was measured."""
        return f"measured: {self.because}"


#: All statuses by their words, in the order in which pages count them.
STATUSES: dict[str, type[Status]] = {
    status.word: status
    for status in (Computed, Quoted, Observed, Reconstructed, Corrected, Damaged, Unreproduced, Measured)
}
KEYS = tuple(dict.fromkeys(field.name for status in STATUSES.values() for field in fields(status)))


def status_of(where: str, printed: Printed, word: str, told: dict[str, str]) -> Status:
    """Return the status that the ledger tells of a result, or raise LedgerError."""
    if word not in STATUSES:
        raise LedgerError(f"{where}: the status is {word!r}, {did_you_mean(word, STATUSES)}")
    return STATUSES[word].read(where, printed, told)


def _value(where, key, text, printed):
    """See to it that a further value is of the kind of the print, and not coarser."""
    try:
        value = type(printed).read(text) if not isinstance(printed, Claim) else None
    except ValueError as error:
        raise LedgerError(f"{where}: {key} is {error}") from None
    if isinstance(value, Number) and value.is_coarser_than(printed):
        raise LedgerError(f"{where}: {key} is {text!r}, expected as many digits as in {printed.text!r}")
