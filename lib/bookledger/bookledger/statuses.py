"""What was done about a result that a book prints: a small class for each deed, which knows when it holds."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from fractions import Fraction
from typing import Any, ClassVar, Self

from bookledger.errors import LedgerError
from bookledger.evidence.values import NUMBER, in_one_line
from bookledger.kinds import Claim, Number, Printed
from plainmath.validation import did_you_mean

__all__ = ["STATUSES", "Assumption", "Status"]


@dataclass(frozen=True)
class Assumption:
    """What takes the place of inputs that a book does not print; one serves several results, with one margin.

    Attributes:
        text: the assumption.
        parameters: how many values were chosen for the results that rest on it.
        within: how far a number may lie from its print, absolute or in percent; empty for half a unit of its last digit.
    """  # noqa: E501

    text: str
    parameters: int
    within: str = ""

    @classmethod
    def read(cls, where: str, data: object) -> Self:
        """Make an assumption of a TOML table, or raise LedgerError."""
        if not isinstance(data, dict) or not {"text", "parameters"} <= set(data) <= {"text", "parameters", "within"}:
            raise LedgerError(f"{where}: {data!r}, expected a table with text, parameters and perhaps within")
        text, parameters, within = data["text"], data["parameters"], data.get("within", "1")
        if not isinstance(text, str) or not text.strip():
            raise LedgerError(f"{where}: text is {text!r}, expected a sentence without its full stop")
        if not isinstance(parameters, int) or isinstance(parameters, bool) or parameters < 0:
            raise LedgerError(f"{where}: parameters is {parameters!r}, expected how many values were chosen, as 2")
        amount, percent = cls._parts(within) if isinstance(within, str) else ("", None)
        if not NUMBER.fullmatch(amount) or not 0 < Fraction(amount) < (100 if percent else float("inf")):
            raise LedgerError(f"{where}: within is {within!r}, expected a positive number, or a percentage below 100 %")
        return cls(in_one_line(text), parameters, data.get("within", ""))

    @staticmethod
    def _parts(within):
        return re.fullmatch(r"(.*?)(\s*%)?", within).groups()

    def judge(self, printed: Printed, value: Any) -> str:
        """Say how a number that rests on it agrees with its print; empty where it does not."""
        if not self.within or not isinstance(printed, Number):
            return printed.agrees(value)
        return "within" if abs(value - printed.value) <= self.margin(printed) else ""

    def margin(self, printed: Number) -> Fraction:
        """Return how far a value may lie from a print, at most; 0 where the digits alone say it."""
        amount, percent = self._parts(self.within or "0")
        return Fraction(amount) / 100 * abs(printed.value) if percent else Fraction(amount)


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
    def read(cls, where: str, printed: Printed, told: Mapping[str, Any]) -> Self:
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
class Divided(Observed):
    """A claim that holds by one measure or in one case, and fails by another."""

    word = "divided"
    meaning = "true by one measure or in one case and false by another, where the book names none"
    mark = ("±", "open")

    def _validate(self, where, printed):
        if not isinstance(printed, Claim):
            raise LedgerError(f"{where}: the status 'divided' is of claims only, got a {printed.kind}")

    def judge(self, printed: Printed, value: Any) -> str:
        """Say "evidence" where some of its cases hold and others do not."""
        return "evidence" if value.divided else ""

    def complaint(self, printed: Printed) -> str:
        """That the measures agree."""
        return f"is not divided: {printed.text}"


@dataclass(frozen=True)
class Reconstructed(Status):
    """Computed from an assumption in place of inputs that are not printed, which more results confirm than it took."""

    word = "reconstructed"
    meaning = "an input is not printed; one stated assumption supplies more results than it has free parameters"
    assuming: Assumption

    def judge(self, printed: Printed, value: Any) -> str:
        """Say how a value agrees within the margin of the assumption."""
        return self.assuming.judge(printed, value)

    @property
    def note(self) -> str:
        """The assumption, its free parameters and its margin."""
        within = f" to within {self.assuming.within}" if self.assuming.within else ""
        free = self.assuming.parameters
        return f"{self.word}{within}, assuming {self.assuming.text} ({free} free parameter{'s' * (free != 1)})"

    def complaint(self, printed: Printed) -> str:
        """The margin that is missed."""
        if self.assuming.within and isinstance(printed, Number):
            return f"is not within {self.assuming.within} of the printed {printed.text}"
        return super().complaint(printed)


@dataclass(frozen=True)
class Fitted(Reconstructed):
    """Computed from an assumption that was chosen for it."""

    word = "fitted"
    meaning = (
        "an assumption was chosen for this very result, or has as many free parameters as results: nothing is confirmed"
    )
    mark = ("~", "open")


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
        return "evidence" if isinstance(printed, Claim) else printed.like(self.found).agrees(value)

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
        return () if isinstance(printed, Claim) or not self.found else (printed.like(self.found),)


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
    """All that it takes is known, and the computation differs from the print."""

    word = "unreproduced"
    meaning = "all that it takes is known, and what is computed does not agree with the print; what was tried is said"
    mark = ("?", "open")
    key = "computed"
    computed: str
    because: str
    tried: str

    @property
    def note(self) -> str:
        """The reason, as far as it is known, and what was tried."""
        return f"{super().note}; tried: {self.tried}"


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
        """Where it was measured, or what is missing."""
        return f"{self.word}: {self.because}"


@dataclass(frozen=True)
class NotComputable(Measured):
    """The text does not print what it takes."""

    word = "not computable"
    meaning = "the text does not print what it takes to compute it"


_ORDER = (
    Computed, Quoted, Observed, Divided, Reconstructed, Fitted, Corrected, Damaged, Unreproduced, NotComputable,
    Measured,
)  # fmt: skip
#: All statuses by their words, in the order in which pages count them.
STATUSES: dict[str, type[Status]] = {status.word: status for status in _ORDER}
KEYS = tuple(dict.fromkeys(field.name for status in STATUSES.values() for field in fields(status)))


def status_of(
    where: str, printed: Printed, word: str, told: Mapping[str, str], assumptions: Mapping[str, Assumption]
) -> Status:
    """Return the status that the ledger tells of a result, or raise LedgerError."""
    if word not in STATUSES:
        raise LedgerError(f"{where}: the status is {word!r}, {did_you_mean(word, STATUSES)}")
    if (name := told.get("assuming")) is None:
        return STATUSES[word].read(where, printed, told)
    if name not in assumptions:
        raise LedgerError(f"{where}: no assumption {name!r} is declared, {did_you_mean(name, assumptions)}")
    return STATUSES[word].read(where, printed, {**told, "assuming": assumptions[name]})


def _value(where, key, text, printed):
    """See to it that a further value is of the kind of the print, and not coarser."""
    try:
        value = printed.like(text) if not isinstance(printed, Claim) else None
    except ValueError as error:
        raise LedgerError(f"{where}: {key} is {error}") from None
    if isinstance(value, Number) and value.is_coarser_than(printed):
        raise LedgerError(f"{where}: {key} is {text!r}, expected as many digits as in {printed.text!r}")
