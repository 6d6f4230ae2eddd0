"""What a book prints as a result, as the ledger has it, and the verdict on what a computation makes of it."""

from __future__ import annotations

import keyword
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

from bookledger.errors import LedgerError
from bookledger.evidence.comparisons import without_gaps
from bookledger.evidence.criteria import of_degree
from bookledger.evidence.values import in_one_line
from bookledger.kinds import KINDS, Claim, Formula, Name, Number, Printed
from bookledger.statuses import KEYS, Assumption, Computed, Status, status_of
from plainmath.tables import is_symbol, symbol, typeset
from plainmath.validation import did_you_mean

#: The sign of what does not hold, and the class under which a page shows it.
FAILS = ("✗", "fails")
_OF_A_RESULT = ("name", "label", "equation", "constant", "status")
_OF_A_CLAIM = ("claim", "says", "about", "degree", "measure")
_OF_A_PRINT = ("kind", "printed", "unit", "rounded_to")
_TRUTH = {"true": True, "false": False}


@dataclass(frozen=True)
class Language:
    """What a source declares for all of its results.

    Attributes:
        assumptions: by their names.
        measures: the quantities by which the source judges a word, such as "faster", by the word.
        real: the symbols of an entry that may have either sign.
    """

    assumptions: Mapping[str, Assumption] = field(default_factory=dict)
    measures: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    real: str = ""


@dataclass(frozen=True)
class Result:
    """What a book prints as a result, and what was done about it.

    Attributes:
        name: the argument of the check, and its place on a page.
        label: the same in words; empty where the name is a symbol.
        equation: its number, if it has one.
        unit: of a number.
        printed: the number, formula, name or claim.
        status: what was done.
        constant: why it does not depend on what the entry gives; empty where it does.
    """

    name: str
    label: str
    equation: str
    unit: str
    printed: Printed
    status: Status
    constant: str = ""

    @classmethod
    def read(cls, where: str, data: object, language: Language | None = None) -> Self:
        """Make a result of a TOML table, or raise LedgerError."""
        language = language or Language()
        known = [*_OF_A_RESULT, *_OF_A_CLAIM, *_OF_A_PRINT, *KEYS]
        if not isinstance(data, dict):
            raise LedgerError(f"{where}: a result is {data!r}, expected a table like {{ name = ..., printed = ... }}")
        for key, value in data.items():
            if key not in known:
                raise LedgerError(f"{where}: a result has the unknown key {key!r}, {did_you_mean(key, known)}")
            if not isinstance(value, str) or not value.strip():
                raise LedgerError(f"{where}: {key} is {value!r}, expected text in quotes (digits carry the tolerance)")
        data = {key: in_one_line(value) for key, value in data.items()}
        if "name" not in data:
            raise LedgerError(f"{where}: a result has no 'name': {data}")
        where, name = f"{where}, {data['name']}", data["name"]
        if not name.isidentifier() or keyword.iskeyword(name):
            raise LedgerError(f"{where}: expected a name that can be an argument in Python, as Q or T_s")
        for key in _OF_A_PRINT if "claim" in data else _OF_A_CLAIM:
            if key in data:
                raise LedgerError(f"{where}: a {'claim' if 'claim' in data else 'print'} has no use for {key!r}")
        if "claim" in data and "label" in data:
            raise LedgerError(f"{where}: a claim has no use for 'label'")
        printed = _claim(where, data, language) if "claim" in data else _printed(where, data, language)
        told = {key: value for key, value in data.items() if key in KEYS}
        status = status_of(where, printed, data.get("status", Computed.word), told, language.assumptions)
        texts = (data.get(key, "") for key in ("label", "equation", "unit"))
        return cls(name, *texts, printed, status, data.get("constant", ""))

    @property
    def is_checked(self) -> bool:
        """Whether there is something to compute: not for laboratory data, nor where what it takes is not printed."""
        return self.status.is_checked

    @property
    def title(self) -> str:
        """What a reader calls it: its label, or else its symbol."""
        return self.label or (self.name if is_symbol(self.name) else self.name.replace("_", " "))

    def judge(self, value: object) -> Verdict:
        """Return the verdict on a computed value, or on evidence.

        Raises TypeError, saying what the value is instead, where it is not of the result's kind.
        """
        value = self.printed.computed(value)
        how = self.status.judge(self.printed, value)
        return Verdict(self, self.printed.written(value, *self.status.others(self.printed)), how, value)


def _claim(where, data, language):
    """The claim of a TOML table."""
    if not data["claim"].endswith("."):
        raise LedgerError(f"{where}: the claim is {data['claim']!r}, expected a sentence with a full stop")
    if "about" not in data:
        raise LedgerError(f"{where}: the claim needs 'about', the quantities that evidence for it names")
    says = data.get("says", "true")
    if says not in _TRUTH:
        raise LedgerError(f"{where}: says is {says!r}, expected true or false")
    about, degree, measured = (_several(data.get(key, "")) for key in ("about", "degree", "measure"))
    for word in degree:
        if not of_degree(word) or word not in data["claim"].lower():
            raise LedgerError(f"{where}: the degree is {word!r}, expected a word of the claim that has a criterion")
    for word in measured:
        if word not in language.measures:
            raise LedgerError(f"{where}: the measure is {word!r}, {did_you_mean(word, language.measures)}")
    measures = tuple(measure for word in measured for measure in language.measures[word])
    return Claim(data["claim"], _TRUTH[says], frozenset(about), degree, measures)


def _several(text):
    return tuple(part.strip() for part in text.split(";") if part.strip())


def _printed(where, data, language):
    """What a TOML table prints."""
    if "printed" not in data:
        raise LedgerError(f"{where}: a result has no 'printed': {data}")
    kind = data.get("kind", Number.kind)
    if kind not in KINDS:
        raise LedgerError(f"{where}: the kind is {kind!r}, {did_you_mean(kind, KINDS)}")
    details = {Formula.kind: [language.real], Name.kind: []}
    try:
        return KINDS[kind].read(data["printed"], *details.get(kind, [data.get("unit", ""), data.get("rounded_to", "")]))
    except ValueError as error:
        raise LedgerError(f"{where}: printed is {error}") from None


@dataclass(frozen=True)
class Verdict:
    """What became of one result.

    Attributes:
        result: of the ledger.
        computed: the value, or the evidence, as text.
        how: how it was found to hold; empty where it does not hold.
        value: the number, formula or name, or the evidence; None where nothing can be computed.
    """

    result: Result
    computed: str
    how: str
    value: Any = None

    @property
    def holds(self) -> bool:
        """Whether the computation bears the status out."""
        return bool(self.how)

    @property
    def near(self) -> bool:
        """Whether the evidence hangs on the limit of a criterion, or on a few percent."""
        return self.is_claim and self.value is not None and self.value.near

    @property
    def is_claim(self) -> bool:
        """Whether the result is a sentence."""
        return isinstance(self.result.printed, Claim)

    @property
    def word(self) -> str:
        """The verdict in a word or two."""
        if not self.holds:
            return "does not hold"
        more = [text for text, so in (("at random points", self.how == "probed"), ("a near thing", self.near)) if so]
        return self.result.status.word + (f" ({', '.join(more)})" if more else "")

    @property
    def mark(self) -> tuple[str, str]:
        """A sign, and the class under which a page shows it."""
        return self.result.status.mark if self.holds else FAILS

    @property
    def complaint(self) -> str:
        """A sentence on what does not hold."""
        what = f"the evidence ({self.computed})" if self.is_claim else f"= {self.computed}"
        return f"{self.result.name} {what} {self.result.status.complaint(self.result.printed)}"

    @property
    def book(self) -> str:
        """What the book prints, as text: of a claim what it says of the sentence."""
        printed = self.result.printed
        if isinstance(printed, Claim):
            return "says so" if printed.says else "denies it"
        return f"{printed.text} {self.result.unit}".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The verdict as JSON data; `tex` has the texts that hold formulas again, those between dollar signs.

        What is empty is left out.
        """
        result, printed = self.result, self.result.printed
        typeset_texts = {"computed": printed.latex(self.computed)}
        if self.is_claim:
            typeset_texts["computed"] = self.value.told(typeset) if self.value is not None else ""
        else:
            typeset_texts["title"] = "" if result.label else symbol(result.name)
            typeset_texts["book"] = f"{printed.latex(printed.text)} {result.unit}".strip()
        plain = {"title": printed.text if self.is_claim else result.title, "book": self.book, "computed": self.computed}
        return {
            "name": result.name,
            "kind": printed.kind,
            **plain,
            "status": result.status.word,
            "word": self.word,
            "holds": self.holds,
            "how": self.how,
            **without_gaps(
                {
                    "equation": result.equation,
                    "tex": {key: text for key, text in typeset_texts.items() if text and text != plain[key]},
                    "evidence": self.value.data if self.is_claim and self.value is not None else None,
                }
            ),
        }
