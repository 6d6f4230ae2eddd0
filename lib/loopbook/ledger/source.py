"""The sources as data: a TOML file each, read strictly, so that a slip of the pen is an error and not a hole."""

from __future__ import annotations

import decimal
import keyword
import re
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, fields
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import sympy

from loopbook.ledger.compare import (
    INFINITE,
    KINDS,
    NUMBER,
    READ,
    Disagreement,
    LedgerError,
    agrees,
    half_unit,
    in_one_line,
    parse_formula,
    spelled,
)
from loopbook.ledger.report import Report, Verdict, described
from loopbook.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.ledger.compare import Formula

#: What each status needs beside the printed value.
STATUSES = {
    "reproduced": (),
    "corrected": ("correct", "because"),
    "reconstructed": ("assuming", "within"),
    "unreproduced": ("computed", "because"),
    "measured": ("because",),
}
_QUANTITY = re.compile(rf"(?P<number>{NUMBER.pattern})(\s+(?P<unit>([^\W\d]|[%°]|\(\w[\w/]*\))[\w%°·/^*()-]*))?")


@dataclass(frozen=True)
class Result:
    """One number, formula or name that a book prints as a result."""

    name: str
    printed: str
    equation: str = ""
    kind: str = "number"
    unit: str = ""
    status: str = "reproduced"
    correct: str = ""
    because: str = ""
    assuming: str = ""
    within: str = ""
    computed: str = ""

    @classmethod
    def read(cls, where: str, data: object) -> Self:
        """Make a result of a TOML table, or raise LedgerError."""
        known = [f.name for f in fields(cls)]
        if not isinstance(data, dict):
            raise LedgerError(f"{where}: a result is {data!r}, expected a table like {{ name = ..., printed = ... }}")
        for key, value in data.items():
            if key not in known:
                raise LedgerError(f"{where}: a result has the unknown key {key!r}, {did_you_mean(key, known)}")
            if not isinstance(value, str) or not value.strip():
                raise LedgerError(f"{where}: {key} is {value!r}, expected text in quotes (digits carry the tolerance)")
        for key in ("name", "printed"):
            if key not in data:
                raise LedgerError(f"{where}: a result has no {key!r}: {data}")
        result = cls(**{key: in_one_line(value) for key, value in data.items()})
        result._validate(f"{where}, {result.name}")
        return result

    def _validate(self, where):
        if not self.name.isidentifier() or keyword.iskeyword(self.name):
            raise LedgerError(f"{where}: expected a name that can be an argument in Python, as Kp or y_s")
        if self.kind not in KINDS:
            raise LedgerError(f"{where}: the kind is {self.kind!r}, {did_you_mean(self.kind, KINDS)}")
        if self.status not in STATUSES:
            raise LedgerError(f"{where}: the status is {self.status!r}, {did_you_mean(self.status, STATUSES)}")
        needed = set(STATUSES[self.status]) - ({"within"} if self.kind == "name" else set())  # a word has no margin
        if self.status == "unreproduced" and not self.computed:  # what it takes is not printed: nothing to compare
            needed.remove("computed")
        for key in ("correct", "because", "assuming", "within", "computed"):
            if bool(getattr(self, key)) != (key in needed):
                verb = "needs" if key in needed else "has no use for"
                raise LedgerError(f"{where}: the status {self.status!r} {verb} {key!r}")
        for key in ("printed", "correct", "computed"):
            if text := getattr(self, key):
                self._validate_value(f"{where}: {key}", text)
                if self.kind == "number" and _coarser(text, self.printed):
                    raise LedgerError(f"{where}: {key} is {text!r}, expected as many digits as in {self.printed!r}")
        if self.within:
            self.margin(where)

    def _validate_value(self, where, text):
        if self.kind == "number" and not NUMBER.fullmatch(text) and text not in INFINITE:
            raise LedgerError(
                f"{where} is {text!r}, expected a number like 1.50 or 2e-3, or else a kind 'formula' or 'name'"
            )
        if self.kind == "formula":
            try:
                parse_formula(text)
            except ValueError as error:
                raise LedgerError(f"{where}: {error}") from None

    @property
    def is_checked(self) -> bool:
        """Whether there is something to compute: not for laboratory data, nor where what it takes is not printed."""
        return self.status != "measured" and (self.status != "unreproduced" or bool(self.computed))

    def margin(self, where: str = "") -> Fraction:
        """How far a reconstructed number may lie from the print: `within`, absolute or in percent of the print."""
        amount, percent = re.fullmatch(r"(.*?)(\s*%)?", self.within).groups()
        if self.kind != "number" or not NUMBER.fullmatch(self.printed):
            raise LedgerError(f"{where}: {self.printed!r} cannot be reconstructed, expected a number")
        if not NUMBER.fullmatch(amount) or not 0 < Fraction(amount) < (100 if percent else float("inf")):
            raise LedgerError(
                f"{where}: within is {self.within!r}, expected a positive number, or a percentage below 100 %"
            )
        if percent and not Fraction(self.printed):
            raise LedgerError(f"{where}: within is {self.within!r} of 0, expected a positive number")
        return Fraction(amount) / 100 * abs(Fraction(self.printed)) if percent else Fraction(amount)

    def judge(self, value: object) -> Verdict:
        """Return the verdict on a computed value.

        Raises TypeError, saying what the value is instead, where it is not of the result's kind.
        """
        value = READ[self.kind](value)
        printed_holds = agrees(self.kind, value, self.printed)
        match self.status:
            case "corrected" | "unreproduced":
                how = agrees(self.kind, value, self.correct or self.computed)
                holds = bool(how) and not printed_holds
            case "reconstructed" if self.within:
                how = "within"
                holds = abs(value - Fraction(self.printed)) <= self.margin()
            case _:
                how, holds = printed_holds, bool(printed_holds)
        texts = [text for text in (self.printed, self.correct, self.computed) if text]
        return Verdict(self, spelled(self.kind, value, *texts), holds, how if holds else "")


def _coarser(text, printed):
    """Whether a number is given with fewer digits than printed, and so with a wider tolerance."""
    if not NUMBER.fullmatch(text) or not NUMBER.fullmatch(printed):
        return False
    digits = [len(decimal.Decimal(number).as_tuple().digits) for number in (text, printed)]
    return digits[0] < digits[1] and half_unit(text) > half_unit(printed)


@dataclass(frozen=True)
class Given:
    """An input of an example: its exact value, its unit, and both as the ledger writes them."""

    value: Formula
    unit: str
    text: str

    @classmethod
    def read(cls, where: str, text: object) -> Self:
        """Read a number with its unit, an expression or an equation, or raise LedgerError."""
        if not isinstance(text, str) or not text.strip():
            raise LedgerError(f'{where} is {text!r}, expected text in quotes, as "1.5 s" or "K/(T*s + 1)"')
        text = in_one_line(text)
        if quantity := _QUANTITY.fullmatch(text):
            return cls(sympy.Rational(quantity["number"]), quantity["unit"] or "", text)
        try:
            return cls(parse_formula(text), "", text)
        except ValueError as error:
            raise LedgerError(f"{where}: {error}") from None


@dataclass(frozen=True)
class Entry:
    """A worked example, section, table or figure of a book, with its inputs and the results that it prints."""

    source: str
    name: str
    title: str
    chapter: str
    inputs: MappingProxyType[str, Given]
    results: tuple[Result, ...]

    @classmethod
    def read(cls, source: str, name: str, data: object) -> Self:
        """Make an entry of a TOML table, or raise LedgerError."""
        where = f"{source}, {name}"
        if not isinstance(data, dict):
            raise LedgerError(f"{where}: the entry is {data!r}, expected a table")
        known = ["title", "chapter", "given", "result"]
        for key in data:
            if key not in known:
                raise LedgerError(f"{where}: the entry has the unknown key {key!r}, {did_you_mean(key, known)}")
        for key in ("title", "chapter"):
            if not isinstance(data.get(key), str) or not data[key].strip():
                raise LedgerError(f"{where}: {key} is {data.get(key)!r}, expected text")
        given, result = data.get("given", {}), data.get("result", [])
        if not isinstance(given, dict) or not isinstance(result, list):
            raise LedgerError(f"{where}: expected `given` to be a table and `result` a list of tables")
        inputs = {key: Given.read(f"{where}, given {key}", text) for key, text in given.items()}
        results = tuple(Result.read(where, row) for row in result)
        names = [row.name for row in results]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise LedgerError(f"{where}: {', '.join(twice)} is a result twice, expected every name once")
        title, chapter = in_one_line(data["title"]), data["chapter"]
        return cls(source, in_one_line(name), title, chapter, MappingProxyType(inputs), results)

    def given(self, *names: str) -> Any:
        """Return inputs of the example as exact numbers or expressions: one for one name, a tuple for several.

        Raises LedgerError for a name that the example does not give.

        >>> from loopbook.ledger import haugen
        >>> haugen["Figure 6.2"].given("K", "T")
        (2, 5)
        """
        for name in names:
            if not isinstance(name, str) or name not in self.inputs:
                where = f"{self.source}, {self.name}"
                raise LedgerError(f"{where}: {name!r} is not given, {did_you_mean(name, self.inputs)}")
        values = tuple(self.inputs[name].value for name in names)
        return values[0] if len(values) == 1 else values

    def measured(self, *names: str) -> Any:
        """Return laboratory data of the example as exact numbers: one for one name, a tuple for several.

        Raises LedgerError for a name that is no result with the status "measured" and a number.
        """
        rows = {row.name: row.printed for row in self.results if row.status == "measured" and row.kind == "number"}
        for name in names:
            if name not in rows:
                where = f"{self.source}, {self.name}"
                raise LedgerError(f"{where}: {name!r} is no measured number, {did_you_mean(name, rows)}")
        values = tuple(sympy.Rational(rows[name]) for name in names)
        return values[0] if len(values) == 1 else values

    @property
    def givens(self) -> dict[str, Formula]:
        """All inputs of the example by name: exact numbers, expressions and equations."""
        return {name: given.value for name, given in self.inputs.items()}

    def compare(self, /, **values: object) -> Report:
        """Return a Report on computed values, one for each result that can be computed.

        Raises LedgerError for a result that is missing or unknown, and for a value that cannot be judged.
        """
        where = f"{self.source}, {self.name}"
        expected = [row.name for row in self.results if row.is_checked]
        if not self.results:
            raise LedgerError(f"{where}: the book prints no result here, nothing to check")
        for name in values:
            if name not in expected:
                raise LedgerError(f"{where}: {name!r} is not a result to check, {did_you_mean(name, expected)}")
        if missing := [name for name in expected if name not in values]:
            raise LedgerError(f"{where}: nothing was given for {', '.join(missing)}, expected {', '.join(expected)}")
        verdicts = []
        for row in self.results:
            if not row.is_checked:
                verdicts.append(Verdict(row, "", True, row.status))
                continue
            value = values[row.name]
            try:
                verdicts.append(row.judge(value))
            except TypeError as error:
                raise LedgerError(f"{where}, {row.name}: expected a {row.kind}, got {error}") from None
            except ValueError as error:
                raise LedgerError(f"{where}, {row.name}: {error}") from None
            except Exception as error:  # whatever an object does that only pretends to be a number
                what = f"a {type(value).__name__} that fails with {type(error).__name__}: {error}"
                raise LedgerError(f"{where}, {row.name}: expected a {row.kind}, got {what}") from error
        return Report(self, tuple(verdicts))

    def check(self, /, **values: object) -> None:
        """Show how computed values compare with the book's, and raise Disagreement where one does not hold."""
        report = self.compare(**values)
        _show(report)
        if failures := report.failures:
            more = f" (and {len(failures) - 1} more)" if failures[1:] else ""
            raise Disagreement(f"{self.source}, {self.name}: {failures[0].complaint}{more}")

    def __repr__(self) -> str:
        return described(self)

    def _repr_html_(self):
        return described(self, as_html=True)


@dataclass(frozen=True)
class Source:
    """A book: its entries in the order of the file, found by name."""

    name: str
    citation: str
    entries: MappingProxyType[str, Entry]

    @classmethod
    def read(cls, name: str, content: bytes) -> Self:
        """Read a source from the content of its TOML file, or raise LedgerError."""
        try:
            data = tomllib.loads(content.decode())
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
            raise LedgerError(f"{name}.toml is not valid TOML: {error}") from None
        head = data.pop("source", {})
        if not isinstance(head, dict) or set(head) != {"citation"} or not isinstance(head["citation"], str):
            raise LedgerError(f'{name}.toml: expected a table [source] with citation = "..." and nothing else')
        entries = {key: Entry.read(name, key, entry) for key, entry in data.items()}
        return cls(name, in_one_line(head["citation"]), MappingProxyType(entries))

    def __getitem__(self, name: str) -> Entry:
        if not isinstance(name, str) or name not in self.entries:
            raise LedgerError(f"{self.name} has no entry {name!r}, {did_you_mean(name, self.entries)}")
        return self.entries[name]

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries.values())

    def __contains__(self, name: object) -> bool:
        return name in self.entries

    def __len__(self) -> int:
        return len(self.entries)

    def __repr__(self) -> str:
        return f"{self.name}: {self.citation} ({len(self.entries)} entries)"


def _show(report):
    """Display in a notebook, print elsewhere."""
    ipython = sys.modules.get("IPython")
    if ipython and ipython.get_ipython():
        ipython.display.display(report)
    else:
        print(report)
