"""The sources as data: a TOML file each, read strictly, so that a slip of the pen is an error and not a hole."""

from __future__ import annotations

import keyword
import re
import sys
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import sympy

from bookledger.errors import Disagreement, LedgerError
from bookledger.evidence.values import NUMBER, in_one_line, parse_formula
from bookledger.kinds import KINDS, Claim, Number, Printed
from bookledger.report import Report, Verdict, described
from bookledger.statuses import KEYS, Computed, Status, status_of
from plainmath.tables import is_symbol
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from bookledger.evidence.values import Formula

_QUANTITY = re.compile(rf"(?P<number>{NUMBER.pattern})(\s+(?P<unit>([^\W\d]|[%°]|\(\w[\w/]*\))[\w%°·/^*()-]*))?")
_OF_A_RESULT = ("name", "label", "equation", "kind", "printed", "unit", "claim", "says", "status")
_TRUTH = {"true": True, "false": False}


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
    """

    name: str
    label: str
    equation: str
    unit: str
    printed: Printed
    status: Status

    @classmethod
    def read(cls, where: str, data: object) -> Self:
        """Make a result of a TOML table, or raise LedgerError."""
        known = [*_OF_A_RESULT, *KEYS]
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
            raise LedgerError(f"{where}: expected a name that can be an argument in Python, as Kp or y_s")
        printed = _claim(where, data) if "claim" in data else _printed(where, data)
        told = {key: value for key, value in data.items() if key in KEYS}
        status = status_of(where, printed, data.get("status", Computed.word), told)
        return cls(name, data.get("label", ""), data.get("equation", ""), data.get("unit", ""), printed, status)

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


def _claim(where, data):
    """The claim of a TOML table."""
    for key in ("printed", "kind", "unit", "label"):
        if key in data:
            raise LedgerError(f"{where}: a claim has no use for {key!r}")
    if not data["claim"].endswith("."):
        raise LedgerError(f"{where}: the claim is {data['claim']!r}, expected a sentence with a full stop")
    says = data.get("says", "true")
    if says not in _TRUTH:
        raise LedgerError(f"{where}: says is {says!r}, expected true or false")
    return Claim(data["claim"], _TRUTH[says])


def _printed(where, data):
    """The number, formula or name of a TOML table."""
    if "printed" not in data:
        raise LedgerError(f"{where}: a result has no 'printed': {data}")
    if "says" in data:
        raise LedgerError(f"{where}: what is not a claim has no use for 'says'")
    kind = data.get("kind", Number.kind)
    if kind not in KINDS:
        raise LedgerError(f"{where}: the kind is {kind!r}, {did_you_mean(kind, KINDS)}")
    try:
        return KINDS[kind].read(data["printed"])
    except ValueError as error:
        raise LedgerError(f"{where}: printed is {error}") from None


@dataclass(frozen=True)
class Slip:
    """A slip of the print that changes no result: a lost cross-reference, a word for another one.

    Attributes:
        printed: what stands there.
        correct: what it should be.
        because: how one knows.
        place: where in the section, if it must be said.
    """

    printed: str
    correct: str
    because: str
    place: str = ""

    @classmethod
    def read(cls, where: str, data: object) -> Self:
        """Make a slip of a TOML table, or raise LedgerError."""
        keys = ("printed", "correct", "because", "place")
        if not isinstance(data, dict) or not set(keys[:3]) <= set(data) <= set(keys):
            raise LedgerError(f"{where}: {data!r}, expected a table with printed, correct, because and perhaps place")
        for key, value in data.items():
            if not isinstance(value, str) or not value.strip():
                raise LedgerError(f"{where}: {key} is {value!r}, expected text in quotes")
        return cls(**{key: in_one_line(value) for key, value in data.items()})

    @property
    def sentence(self) -> str:
        """The slip in a sentence without its full stop."""
        place = f" ({self.place})" if self.place else ""
        return f"prints `{self.printed}`{place} for `{self.correct}`: {self.because}"


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
    misprints: tuple[Slip, ...] = ()
    damage: tuple[Slip, ...] = ()
    book: str = ""

    @classmethod
    def read(cls, source: str, name: str, data: object, book: str = "") -> Self:
        """Make an entry of a TOML table, or raise LedgerError; `book` is the short title of its source."""
        where = f"{source}, {name}"
        if not isinstance(data, dict):
            raise LedgerError(f"{where}: the entry is {data!r}, expected a table")
        known = ["title", "chapter", "given", "result", "misprint", "damage"]
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
        slips = []
        for key in ("misprint", "damage"):
            if not isinstance(data.get(key, []), list):
                raise LedgerError(f"{where}: {key} is {data[key]!r}, expected a list of tables")
            slips.append(tuple(Slip.read(f"{where}, {key}", slip) for slip in data.get(key, [])))
        return cls(source, in_one_line(name), title, chapter, MappingProxyType(inputs), results, *slips, book)

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

    def as_printed(self, *names: str) -> Any:
        """Return numbers of the book that nobody can compute, exactly as printed: one for one name, or a tuple.

        Those are laboratory data, and results of which the book does not print what they take.

        Raises LedgerError for the name of anything else.
        """
        unchecked = [row for row in self.results if not row.is_checked]
        return self._values_in_print("no number that only the book has", unchecked, names)

    def printed_value(self, *names: str) -> Any:
        """Return numbers of the book exactly as printed, for claims about the printed table itself.

        What a book reads from its own table is judged by the cells of that table. A number is never checked against
        itself: the rules for notebooks refuse a printed value that is handed back.

        Raises LedgerError for the name of what is not a number.

        >>> from loopbook.ledger import syder
        >>> syder["Table 1 (Hang et al.)"].printed_value("PID_Hang_servo_B", "PID_Hang_regulator_B")
        (181/100, 363/100)
        """
        return self._values_in_print("no printed number", self.results, names)

    def _values_in_print(self, what, results, names):
        """The printed numbers of some results, one for one name, or a tuple."""
        numbers = [row for row in results if isinstance(row.printed, Number) and row.printed.is_finite]
        rows = {row.name: row.printed.value for row in numbers}
        for name in names:
            if name not in rows:
                where = f"{self.source}, {self.name}"
                raise LedgerError(f"{where}: {name!r} is {what}, {did_you_mean(name, rows)}")
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
                verdicts.append(Verdict(row, "", row.status.word))
                continue
            value = values[row.name]
            try:
                verdicts.append(row.judge(value))
            except TypeError as error:
                raise LedgerError(f"{where}, {row.name}: expected {_a(row)}, got {error}") from None
            except ValueError as error:
                raise LedgerError(f"{where}, {row.name}: {error}") from None
            except Exception as error:  # whatever an object does that only pretends to be a number
                what = f"a {type(value).__name__} that fails with {type(error).__name__}: {error}"
                raise LedgerError(f"{where}, {row.name}: expected {_a(row)}, got {what}") from error
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


class _Entries(Mapping):
    """The entries of a book by name, each read when it is first asked for: a chapter uses a few of hundreds."""

    def __init__(self, source: str, title: str, tables: dict[str, Any]):
        self._source, self._title, self._tables, self._read = source, title, tables, {}

    def __getitem__(self, name: str) -> Entry:
        if name not in self._read:
            self._read[name] = Entry.read(self._source, name, self._tables[name], self._title)
        return self._read[name]

    def __contains__(self, name: object) -> bool:
        return name in self._tables

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)


@dataclass(frozen=True)
class Source:
    """A book: its entries in the order of the file, found by name; `title` is short, for headings."""

    name: str
    title: str
    citation: str
    entries: Mapping[str, Entry]

    @classmethod
    def read(cls, name: str, content: bytes) -> Self:
        """Read a source from the content of its TOML file with all its entries, or raise LedgerError."""
        source = cls.opened(name, content)
        list(source)
        return source

    @classmethod
    def opened(cls, name: str, content: bytes) -> Self:
        """Open a source, of which each entry is read when it is first asked for; LedgerError is raised then."""
        try:
            data = tomllib.loads(content.decode())
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
            raise LedgerError(f"{name}.toml is not valid TOML: {error}") from None
        head = data.pop("source", {})
        keys = {"title", "citation"}
        if not isinstance(head, dict) or set(head) != keys or not all(isinstance(head[key], str) for key in keys):
            raise LedgerError(f"{name}.toml: expected a table [source] with title and citation, and nothing else")
        title, citation = (in_one_line(head[key]) for key in ("title", "citation"))
        return cls(name, title, citation, _Entries(name, title, data))

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


def _a(row):
    return "evidence" if isinstance(row.printed, Claim) else f"a {row.printed.kind}"


def _show(report):
    """Display in a notebook, print elsewhere."""
    ipython = sys.modules.get("IPython")
    if ipython and ipython.get_ipython():
        ipython.display.display(report)
    else:
        print(report)
