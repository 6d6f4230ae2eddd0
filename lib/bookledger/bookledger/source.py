"""The sources as data: a TOML file each, read strictly, so that a slip of the pen is an error and not a hole."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import sympy

from bookledger.errors import Disagreement, LedgerError
from bookledger.evidence.values import NUMBER, in_one_line, parse_formula
from bookledger.kinds import Claim, Number
from bookledger.report import LEFT, Report
from bookledger.results import Language, Result, Verdict
from bookledger.statuses import Assumption
from bookledger.units import unit_of
from plainmath.tables import aligned, is_symbol, marked, symbol, typeset
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from bookledger.evidence.values import Formula

_QUANTITY = re.compile(rf"(?P<number>{NUMBER.pattern})(\s+(?P<unit>([^\W\d]|[%°]|\(\w[\w/]*\))[\w%°·/^*()-]*))?")


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
    def read(cls, where: str, text: object, real: str = "") -> Self:
        """Read a number with its unit, an expression or an equation, or raise LedgerError."""
        if not isinstance(text, str) or not text.strip():
            raise LedgerError(f'{where} is {text!r}, expected text in quotes, as "1.5 s" or "K/(T*s + 1)"')
        text = in_one_line(text)
        if quantity := _QUANTITY.fullmatch(text):
            return cls(sympy.Rational(quantity["number"]), quantity["unit"] or "", text)
        try:
            return cls(parse_formula(text, real), "", text)
        except ValueError as error:
            raise LedgerError(f"{where}: {error}") from None

    @property
    def typeset(self) -> str:
        """The text, a formula as LaTeX."""
        return self.text if isinstance(self.value, sympy.Rational) else typeset(self.value)


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
    def read(cls, source: str, name: str, data: object, book: str = "", language: Language | None = None) -> Self:
        """Make an entry of a TOML table, or raise LedgerError.

        Arguments:
            source, book: the name and the short title of the source.
            name, data: of the entry.
            language: what the source declares for all entries.
        """
        where = f"{source}, {name}"
        if not isinstance(data, dict):
            raise LedgerError(f"{where}: the entry is {data!r}, expected a table")
        known = ["title", "chapter", "real", "given", "result", "misprint", "damage"]
        for key in data:
            if key not in known:
                raise LedgerError(f"{where}: the entry has the unknown key {key!r}, {did_you_mean(key, known)}")
        for key in ("title", "chapter"):
            if not isinstance(data.get(key), str) or not data[key].strip():
                raise LedgerError(f"{where}: {key} is {data.get(key)!r}, expected text")
        real = data.get("real", "")
        if not isinstance(real, str):
            raise LedgerError(f'{where}: real is {real!r}, expected symbols that may have either sign, as "K v"')
        language = replace(language or Language(), real=real)
        given, result = data.get("given", {}), data.get("result", [])
        if not isinstance(given, dict) or not isinstance(result, list):
            raise LedgerError(f"{where}: expected `given` to be a table and `result` a list of tables")
        inputs = {key: Given.read(f"{where}, given {key}", text, real) for key, text in given.items()}
        results = tuple(Result.read(where, row, language) for row in result)
        names = [row.name for row in results]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise LedgerError(f"{where}: {', '.join(twice)} is a result twice, expected every name once")
        about: dict[frozenset[str], Result] = {}
        for row in results:
            if isinstance(row.printed, Claim) and (other := about.setdefault(row.printed.about, row)) is not row:
                two = f"{other.name} and {row.name} are about the same"
                raise LedgerError(f"{where}: {two}, expected a quantity of its own for each claim")
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

        >>> from bookledger import EXAMPLE
        >>> Source.open(EXAMPLE)["Example 2.1"].given("k", "d")
        (3/5, 1/4)
        """
        for name in names:
            if not isinstance(name, str) or name not in self.inputs:
                where = f"{self.source}, {self.name}"
                raise LedgerError(f"{where}: {name!r} is not given, {did_you_mean(name, self.inputs)}")
        values = tuple(self.inputs[name].value for name in names)
        return values[0] if len(values) == 1 else values

    def quantity(self, *names: str) -> Any:
        """Return numbers of the example with their units, as SymPy's quantities: what is computed from them has one.

        Raises LedgerError for a name that the example does not give, and ValueError for a unit such as °C.

        >>> from bookledger import EXAMPLE
        >>> Source.open(EXAMPLE)["Example 2.1"].quantity("k")
        3*watt/(5*kelvin*meter)
        """
        values = tuple(self.given(name) * unit_of(self.inputs[name].unit) for name in names)
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
        itself: `bookledger.mutation` finds a value that follows the print.

        Raises LedgerError for the name of what is not a number.

        >>> from bookledger import EXAMPLE
        >>> Source.open(EXAMPLE)["Table 2.1"].printed_value("k_brick", "k_wool")
        (3/5, 1/25)
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
        slips = [f"misprint: the book {slip.sentence}" for slip in self.misprints]
        slips += [f"damaged: our copy {slip.sentence}" for slip in self.damage]
        return Report(self.source, self.name, self.heading, tuple(verdicts), tuple(slips))

    def check(self, /, **values: object) -> None:
        """Show how computed values compare with the book's, and raise Disagreement where one does not hold."""
        report = self.compare(**values)
        _show(report)
        if failures := report.failures:
            more = f" (and {len(failures) - 1} more)" if failures[1:] else ""
            raise Disagreement(f"{self.source}, {self.name}: {failures[0].complaint}{more}")

    @property
    def heading(self) -> str:
        """The short title of the book, the name of the entry and its title."""
        return f"{self.book or self.source}, {self.name} · {self.title}"

    def __repr__(self) -> str:
        rows = [(name, "=" if "=" not in given.text else ":", given.text) for name, given in self.inputs.items()]
        return "\n".join([self.heading, *aligned(rows)])

    def _repr_html_(self):
        lines = [f"<p><strong>{marked(self.heading)}</strong></p>"]
        if self.inputs:
            cells = [(marked(_written(name)), marked(given.typeset)) for name, given in self.inputs.items()]
            rows = [f"<tr><td {LEFT}>{name}</td><td {LEFT}>{given}</td></tr>" for name, given in cells]
            lines += ["<table>", *rows, "</table>"]
        return "\n".join(lines)


def _written(name):
    """The name of a given as a formula where it is a letter with words as its indices.

    >>> _written("T_hin_new"), _written("w_after"), _written("K_p_at_w_max"), _written("height")
    ('$T_{hin,new}$', '$w_{after}$', 'K p at w max', 'height')
    """
    letter, *indices = name.split("_")
    if not indices or not is_symbol(letter) or not {"at", "of"}.isdisjoint(indices):
        return symbol(name)
    return f"${sympy.latex(sympy.Symbol(letter))}_{{{','.join(indices)}}}$"


@dataclass(frozen=True)
class Source:
    """A book: its entries in the order of the file, found by name; `title` is short, for headings.

    Each entry is read when it is first asked for, and one that is malformed raises LedgerError then; `list(source)`
    reads all of them.
    """

    name: str
    title: str
    citation: str
    tables: Mapping[str, Any] = field(repr=False)
    language: Language = field(default_factory=Language, repr=False)
    _read: dict[str, Entry] = field(default_factory=dict, compare=False)

    @classmethod
    def open(cls, path: Path | str) -> Self:
        """Open a source that is a TOML file; its name is that of the file."""
        path = Path(path)
        try:
            content = path.read_bytes()
        except OSError as error:
            raise LedgerError(f"{path} cannot be read: {error.strerror}") from None
        return cls.read(path.stem, content)

    @classmethod
    def read(cls, name: str, content: bytes) -> Self:
        """Read a source from the content of its TOML file."""
        try:
            data = tomllib.loads(content.decode())
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
            raise LedgerError(f"{name}.toml is not valid TOML: {error}") from None
        head = data.pop("source", {})
        keys = {"title", "citation"}
        if not isinstance(head, dict) or set(head) != keys or not all(isinstance(head[key], str) for key in keys):
            raise LedgerError(f"{name}.toml: expected a table [source] with title and citation, and nothing else")
        title, citation = (in_one_line(head[key]) for key in ("title", "citation"))
        assumptions, measures = data.pop("assumption", {}), data.pop("measure", {})
        if not isinstance(assumptions, dict) or not isinstance(measures, dict):
            raise LedgerError(f"{name}.toml: expected tables [assumption.NAME] and a table [measure]")
        for word, measure in measures.items():
            if not isinstance(measure, str) or not measure.strip():
                raise LedgerError(f"{name}.toml: the measure of {word!r} is {measure!r}, expected quantities in quotes")
        language = Language(
            {key: Assumption.read(f"{name}.toml, assumption {key}", table) for key, table in assumptions.items()},
            {word: tuple(part.strip() for part in measure.split(";")) for word, measure in measures.items()},
        )
        return cls(name, title, citation, MappingProxyType(data), language)

    def __getitem__(self, name: str) -> Entry:
        if not isinstance(name, str) or name not in self.tables:
            raise LedgerError(f"{self.name} has no entry {name!r}, {did_you_mean(name, self.tables)}")
        if name not in self._read:
            self._read[name] = Entry.read(self.name, name, self.tables[name], self.title, self.language)
        return self._read[name]

    def __iter__(self) -> Iterator[Entry]:
        return (self[name] for name in self.tables)

    def __contains__(self, name: object) -> bool:
        return name in self.tables

    def __len__(self) -> int:
        return len(self.tables)

    def __repr__(self) -> str:
        return f"{self.name}: {self.citation} ({len(self)} entries)"


def _a(row):
    return "evidence" if isinstance(row.printed, Claim) else f"a {row.printed.kind}"


def _show(report):
    """Display in a notebook, print elsewhere."""
    ipython = sys.modules.get("IPython")
    if ipython and ipython.get_ipython():
        ipython.display.display(report)
    else:
        print(report)
