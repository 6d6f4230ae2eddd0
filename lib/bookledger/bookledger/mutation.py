"""A stored notebook run again with other givens and other prints: what it hands over must follow the first alone.

    python -m bookledger.mutation --sources ledger/*.toml --notebooks chapters/*.ipynb

Nothing forbids a notebook to hand a printed number back to its check, by whatever detour. It is run again instead, each
in a process of its own, and what arrives at the checks is compared with what arrived before.

- *With other givens* (a few percent; the same number everywhere by the same share; a formula in its symbols and
  coefficients, not in its exponents) another value is asked of every number and formula, and other numbers in the
  evidence of every claim, of an entry that gives something. What cannot depend on that says why, as `constant`, and
  must not move. Names are not asked, because no small change reaches them, nor is what is quoted. Numbers of the book
  that nobody computes, such as laboratory data, are givens, too. A cell that fails with other givens is skipped,
  and what was not reached, or did not move, is tried in other ways, at last with one given alone.
- *With other prints* every value must stay what it was. A claim may follow `Entry.printed_value`, and so may what is
  fitted.
- *Without running* a value must be refused that is a little off, and evidence that is turned around, or handed to
  another claim of its entry.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import io
import itertools
import os
import re
import signal
import subprocess
import sys
import time
import warnings
from collections import UserDict
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias
from unittest import mock
from zlib import crc32

import sympy
from sympy.core.function import AppliedUndef

from bookledger.errors import Disagreement
from bookledger.evidence import Evidence
from bookledger.evidence.values import NUMBER, formulas_agree, in_one_line, parse_formula
from bookledger.kinds import Claim, Formula, Name, Number
from bookledger.results import Result
from bookledger.source import Entry, Given, Source
from bookledger.statuses import Fitted, Quoted, Reconstructed
from bookledger.stored import Stored, code

#: What becomes of an entry of a source.
Change: TypeAlias = Callable[[Source, str], Mapping[str, Any]]
_LABELS = {"quantity", "unit", "case", "holds", "near"}  # in the data of evidence: no values
_ROUNDING = Fraction(1, 10**7)
#: How long a cell may compute with other numbers, which may be hard ones, beyond ten times as long as at first.
SECONDS = 5
_WAYS = ("all", "no counts", "counts", "whole", "symbols", "numbers")


class Place(NamedTuple):
    """Where a value is handed over: the cell, the number of the check in it, and the result."""

    cell: int
    check: int
    source: str
    entry: str
    row: str

    def __str__(self) -> str:
        return f"{self.source}, {self.entry}: {self.row}"


# Other books.


def other_givens(source: Source, name: str, only: tuple[str, ...] = (), way: str = "all") -> Mapping[str, Any]:
    """Return an entry as if the book gave something else.

    Arguments:
        source, name: of the entry.
        only: the source and the name of the only entry that is changed, and perhaps of its only given; empty for all.
        way: "all", or all but "no counts", which are whole numbers without a unit; or "counts", which change by one,
            and numbers, but no formula; or of formulas the "symbols" alone, the "numbers" or the "whole".
    """
    table, own = source.tables[name], (source.name, name)
    if only[:2] not in ((), own):
        return table
    rows = [
        {**told, "printed": NUMBER.sub(_more, told["printed"])} if _is_measured(row) else told
        for row, told in zip(source[name].results, table.get("result", []), strict=True)
    ]
    given = table.get("given", {})
    changed = {key: _other(text, way) if only[2:] in ((), (key,)) else text for key, text in given.items()}
    return {**table, "given": changed, "result": rows}


def _is_measured(row):
    return isinstance(row.printed, Number) and not row.is_checked


def _other(text, way):
    given = Given.read("", text)
    if isinstance(given.value, sympy.Rational):
        if way != "all" and given.value.is_Integer and not given.unit:
            return str(given.value + (way == "counts"))
        return NUMBER.sub(_more, text, count=1)
    *left, right = given.value.args if isinstance(given.value, sympy.Equality) else [given.value]
    both = way in ("all", "no counts")
    numbers = way == "numbers" or (both and len(right.free_symbols) < 2)
    other = 2 * right if way == "whole" else _other_part(right, both or way == "symbols", numbers)
    changed = " = ".join(map(str, [*left, other]))
    try:
        return text if parse_formula(changed) == given.value else changed
    except ValueError:  # what SymPy prints is not always what it reads
        return text


def _share(number):
    """What a number is multiplied by, in thousandths: half a percent to 3 percent more, the same wherever it stands."""
    return 1005 + crc32(str(abs(Fraction(number))).encode()) % 26


def _more(found):
    return f"{Decimal(found[0]) * _share(found[0]) / 1000:f}"


def _other_part(part, symbols, numbers):
    match part:
        case sympy.Pow():
            return _other_part(part.base, symbols, numbers) ** part.exp
        case sympy.Rational():
            return part * sympy.Rational(_share(str(part)), 1000) if numbers and abs(part) != 1 else part
        case sympy.Symbol() | AppliedUndef() | sympy.Derivative() | sympy.Integral() | sympy.Subs():
            return part * sympy.prime(1 + crc32(str(part).encode()) % 9) if symbols else part
    return part.func(*(_other_part(inner, symbols, numbers) for inner in part.args)) if part.args else part


def other_prints(source: Source, name: str) -> Mapping[str, Any]:
    """Return an entry as if the book printed something else of each result that is checked, and denied its claims."""
    table = source.tables[name]
    rows = zip(source[name].results, table.get("result", []), strict=True)
    return {**table, "result": [_reprinted(row, told) if row.is_checked else told for row, told in rows]}


def _reprinted(row, told):
    if isinstance(row.printed, Claim):
        return {**told, "says": "false" if row.printed.says else "true"}
    other = {Name: "other than {}".format, Formula: _unlike_formula}.get(type(row.printed), _unlike)
    return {**told, **{key: other(told[key]) for key in ("printed", "correct", "computed") if key in told}}


def _unlike_formula(text):
    return re.sub(r"([^=]+)$", r"2*(\1) + unheard_of", text)


def _unlike(text):
    """A number, or several, with other digits, and as many."""
    other = re.sub("[1-9]", lambda digit: str(int(digit[0]) % 9 + 1), text)
    return other if other != text else "7"


class _Tables(UserDict):
    """The entries of a source, each changed when it is asked for."""

    def __init__(self, source, change):
        super().__init__(source.tables)
        self.changed = partial(change, source)

    def __getitem__(self, name):
        return self.changed(name)


# Running.


class Notebook:
    """A stored notebook, what it hands over, and what is wrong with that.

    Attributes:
        books: the sources by their names, as they are.
        failed: what the cells that failed in the last run said, by their labels.
    """

    def __init__(self, stored: Stored, books: Mapping[str, Source]):
        self.path, self.cells, self.books = stored.path.resolve(), code(stored.notebook), {**books}
        self.failed: dict[str, str] = {}
        self._opened: list[Source] = []  # the sources as the notebook sees them
        self._seconds: dict[int, float] = {}
        self.first = self.run()

    def run(self, change: Change | None = None, spared: bool = False) -> dict[Place, Any]:
        """Run all cells and return what they handed over.

        Arguments:
            change: what becomes of the entries; without one every check must hold.
            spared: whether `Entry.printed_value` is spared from it.
        """
        found: dict[Place, Any] = {}
        at = [0, 0]  # the cell, and the check in it
        read, printed_value = Source.read.__func__, Entry.printed_value

        def dressed(source):
            book = self.books[source.name]
            object.__setattr__(source, "tables", _Tables(book, change) if change else book.tables)
            source._read.clear()
            return source

        def opened(cls, name, content):
            self.books.setdefault(name, read(cls, name, content))
            self._opened.append(read(cls, name, content))
            return dressed(self._opened[-1])

        def checked(entry, /, **values):
            at[1] += 1
            found.update({Place(*at, entry.source, entry.name, row): value for row, value in values.items()})
            if not change and (failures := entry.compare(**values).failures):
                raise Disagreement(f"{entry.source}, {entry.name}: {failures[0].complaint}")

        def printed(entry, *names):
            return printed_value(self.books[entry.source][entry.name] if spared else entry, *names)

        for source in self._opened:
            dressed(source)
        self.failed, namespace = {}, {"__name__": "__main__"}
        with (
            mock.patch.object(Source, "read", classmethod(opened)),
            mock.patch.multiple(Entry, check=checked, printed_value=printed),
            mock.patch.object(sys, "path", [str(self.path.parent), *sys.path]),
            contextlib.chdir(self.path.parent),
            contextlib.redirect_stdout(io.StringIO()),
            contextlib.redirect_stderr(io.StringIO()),
            warnings.catch_warnings(action="ignore"),
        ):
            for n, (label, cell) in enumerate(self.cells):
                at[:], start = (n, 0), time.process_time()
                try:
                    with _limited(SECONDS + 10 * self._seconds.get(n, 60)):
                        exec(compile(cell.source, label, "exec"), namespace)
                except Exception as error:
                    self.failed[label] = in_one_line(f"{type(error).__name__}: {error}")
                self._seconds.setdefault(n, time.process_time() - start)
        return found

    def row(self, place: Place) -> Result:
        """Return the result at a place."""
        return next(row for row in self.books[place.source][place.entry].results if row.name == place.row)

    def moved(self, place: Place, found: Mapping[Place, Any]) -> bool | None:
        """Return whether another value than the first one was found; None where none was found."""
        try:
            one, other = ([*_leaves(self.row(place).printed.computed(run[place]))] for run in (self.first, found))
        except (KeyError, TypeError, ValueError):
            return None
        return len(one) != len(other) or any(map(_differ, one, other))

    def complaints(self) -> Iterator[str]:
        """Return what is wrong, a sentence for each fault."""
        if self.failed:
            return (f"{label} fails: {error}" for label, error in self.failed.items())
        proofs = (self._unchecked, self._with_other_givens, self._with_other_prints, self._without_running)
        return (complaint for proof in proofs for complaint in proof())

    def _unchecked(self):
        handed = {(place.source, place.entry) for place in self.first}
        for book in self.books.values():
            for name in (name for name, table in book.tables.items() if table.get("chapter") == self.path.stem):
                if (book.name, name) not in handed and any(row.is_checked for row in book[name].results):
                    yield f"{book.name}, {name}: nothing is handed over, expected a check"

    def _with_other_givens(self):
        rows = {
            place: row
            for place, row in ((place, self.row(place)) for place in self.first)
            if not (isinstance(row.printed, Name) or isinstance(row.status, Quoted))
            if row.constant or self.books[place.source][place.entry].inputs
        }
        seen: dict[Place, bool] = {}  # whether what was reached has moved
        why = ""
        for only, change in self._changes({place[2:4] for place in rows}):
            own = (place for place in rows if only in ((), place[2:4]))
            if any(place not in seen if rows[place].constant else not seen.get(place) for place in own):
                found = self.run(change)
                moved = {place: self.moved(place, found) for place in rows}
                seen |= {place: moves or seen.get(place, False) for place, moves in moved.items() if moves is not None}
                why = why or next((f": {label} fails, {error}" for label, error in self.failed.items()), "")
        for place, row in rows.items():
            if place not in seen:
                yield f"{place} is not reached with other givens{why}"
            elif row.constant and seen[place]:
                yield f"{place} moves with other givens, and is called constant: {row.constant}"
            elif not row.constant and not seen[place]:
                yield f"{place} is the same with other givens: expected another value, or `constant` and why"

    def _changes(self, entries):
        """The changes of all givens, of those of one entry, and of one given alone, each with its entry."""
        yield from (((), partial(other_givens, way=way)) for way in _WAYS)
        for source, name in sorted(entries):
            book, tried = self.books[source], [self.books[source].tables[name]]
            for given, way in itertools.product([(), *((key,) for key in book[name].inputs)], _WAYS):
                change = partial(other_givens, only=(source, name, *given), way=way)
                if (table := change(book, name)) not in tried:
                    tried.append(table)
                    yield (source, name), change

    def _with_other_prints(self):
        found = self.run(other_prints)
        moved = {place: self.moved(place, found) for place in self.first}
        rows = {place: self.row(place) for place in moved}
        may = {place for place, row in rows.items() if isinstance(row.printed, Claim) or isinstance(row.status, Fitted)}
        if again := {place for place in moved if moved[place] is None or (moved[place] and place in may)}:
            found = self.run(other_prints, spared=True)
            moved |= {place: self.moved(place, found) for place in again}
        for place, follows in moved.items():
            if follows is not False:
                does = "follows the print" if follows else "is not reached with other prints"
                yield f"{place} {does}: expected the same value whatever the book prints"

    def _without_running(self):
        for place, value in self.first.items():
            row = self.row(place)
            if not isinstance(row.printed, Claim):
                computed = row.printed.computed(value)
                if any(row.status.judge(row.printed, _beside(row.printed, computed, row, way)) for way in (1, -1)):
                    yield f"{place} may be another value, too: expected that its check refuses one"
                continue
            if _bears_out(value.turned(), row):
                yield f"{place} is borne out by evidence that is turned around, too"
            for other in self.books[place.source][place.entry].results:
                if other is not row and isinstance(other.printed, Claim) and _bears_out(value, other):
                    yield f"{place} has evidence that bears out {other.name}, too"


@contextlib.contextmanager
def _limited(seconds):
    """Raise TimeoutError after so many seconds of computing, where the system can."""

    def late(*_):
        raise TimeoutError("it computes too long")

    if not hasattr(signal, "setitimer"):
        yield
        return
    signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)


def _leaves(value):
    """The numbers, formulas and texts that a value is made of."""
    match value:
        case Evidence():
            yield from _leaves(value.data)
        case Mapping():
            yield from (leaf for key, part in value.items() if key not in _LABELS for leaf in _leaves(part))
        case tuple() | list():
            yield from (leaf for part in value for leaf in _leaves(part))
        case str() if NUMBER.fullmatch(value):
            yield Fraction(value)
        case _:
            yield value


def _differ(one, other):
    if isinstance(one, Fraction) and isinstance(other, Fraction):
        return abs(one - other) > _ROUNDING * max(abs(one), abs(other))
    if isinstance(one, sympy.Basic) and isinstance(other, sympy.Basic):
        return one != other and not formulas_agree(one, other)
    return one != other


def _beside(printed, value, row, way):
    """A value that is a little farther off than a result of that kind allows, or another formula or name."""
    match value:
        case tuple():
            return tuple(_beside(*pair, row, way) for pair in zip(printed.parts, value, strict=True))
        case sympy.Equality():
            return sympy.Eq(value.lhs, _beside(printed, value.rhs, row, way))
        case sympy.Basic():
            return 2 * value + sympy.Symbol("unheard_of")
        case Fraction():
            prints = [other for other in (printed, *row.status.others(printed)) if other.is_finite]
            assumed = [row.status.assuming.margin(printed)] if isinstance(row.status, Reconstructed) else []
            return value + way * Fraction(201, 100) * max([*assumed, *(other.tolerance for other in prints)])
    return f"other than {value}"


def _bears_out(evidence, row):
    try:
        return row.judge(evidence).holds
    except (TypeError, ValueError):
        return False


def main() -> int:
    """Complain about notebooks, a line for each fault; return 1 if there is one."""
    parser = argparse.ArgumentParser(prog="python -m bookledger.mutation", description=__doc__.partition("\n")[0])
    parser.add_argument("--sources", nargs="+", type=Path, required=True, help="ledgers as TOML files")
    parser.add_argument("--notebooks", nargs="+", type=Path, required=True, help="notebooks that check them")
    parser.add_argument("--evidence", default="bookledger.evidence", help="the module of their evidence")
    told = parser.parse_args()
    first, *others = told.notebooks
    if others:
        command = [sys.executable, "-X", "utf8", "-m", "bookledger.mutation", "--sources", *told.sources]
        command += ["--evidence", told.evidence]
        return max(subprocess.run([*command, "--notebooks", path], check=False).returncode for path in told.notebooks)
    os.environ["MPLBACKEND"] = "Agg"
    importlib.import_module(told.evidence)
    notebook, fault = Notebook(Stored.at(first), {path.stem: Source.open(path) for path in told.sources}), ""
    for fault in notebook.complaints():
        print(f"{first.stem}, {fault}", flush=True)
    return int(bool(fault))


if __name__ == "__main__":
    sys.exit(main())
