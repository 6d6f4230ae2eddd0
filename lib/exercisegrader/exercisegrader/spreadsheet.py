"""Tables that an instructor keeps in a spreadsheet: read with all faults in one run, continued with nothing changed.

A spreadsheet saves them with commas, semicolons or tabs, with decimal commas, and with a mark of UTF-8 in front. What
it saved stays as it is, byte for byte; rows are added below in the same way.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from exercisegrader import GradingError
from plainmath.validation import did_you_mean

#: So many faults of a file are told.
MOST_FAULTS = 40
#: The mark by which a spreadsheet knows UTF-8.
MARK = "\N{ZERO WIDTH NO-BREAK SPACE}"
_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)")


class Faults:
    """The faults of a file, which are told all at once.

    >>> faults = Faults("marks.csv")
    >>> faults.add(3, "points are 'two': expected a number")
    >>> faults.demand_none()
    Traceback (most recent call last):
    ...
    exercisegrader.GradingError: marks.csv, line 3: points are 'two': expected a number
    """

    def __init__(self, name: str):
        self.name, self._found = name, []

    def add(self, line: int, says: str) -> None:
        """Note a fault in a line."""
        self._found.append(f"{self.name}, line {line}: {says}")

    def demand_none(self) -> None:
        """Raise GradingError with all of them, each in a line, where there is one."""
        if self._found:
            more = len(self._found) - MOST_FAULTS
            lines = self._found[:MOST_FAULTS] + ([f"{self.name}: {more} more such faults"] if more > 0 else [])
            raise GradingError("\n".join(lines))


@dataclass(frozen=True)
class Sheet:
    """A table with a header.

    Attributes:
        path: of the file.
        text: all of it, as it is.
        header: the names of its columns, in small letters.
        rows: pairs of the number of a line and {column: cell}; rows in which nothing is written are not among them.
        delimiter, newline: between two cells, and behind a row.
    """

    path: Path
    text: str
    header: tuple[str, ...]
    rows: tuple[tuple[int, dict[str, str]], ...] = ()
    delimiter: str = ","
    newline: str = "\r\n"

    @classmethod
    def new(cls, path: Path, columns: Sequence[str]) -> Sheet:
        """Return a table without rows, of which there is no file yet, as Excel opens it.

        >>> Sheet.new(Path("marks.csv"), ["student", "points"]).text
        '\\ufeffstudent,points\\r\\n'
        """
        sheet = cls(path, MARK, tuple(columns))
        return cls(path, sheet.continued([dict(zip(columns, columns, strict=True))]), tuple(columns))

    def continued(self, rows: Iterable[Mapping[str, str]]) -> str:
        """Return the text with more rows, {column: cell}, below; where there are none, the text as it is.

        >>> sheet = Sheet(Path("marks.csv"), "student;points;mine", ("student", "points", "mine"), (), ";", "\\n")
        >>> sheet.continued([{"student": "s1", "points": "2"}])
        'student;points;mine\\ns1;2;\\n'
        """
        file = io.StringIO(newline="")
        writer = csv.writer(file, delimiter=self.delimiter, lineterminator=self.newline)
        writer.writerows([row.get(column, "") for column in self.header] for row in rows)
        added = file.getvalue()
        is_complete = self.text in ("", MARK) or self.text.endswith(("\n", "\r"))
        return self.text + (self.newline if added and not is_complete else "") + added


def read(path: str | Path, columns: Collection[str], optional: Collection[str] = ()) -> Sheet:
    """Return the table in a file; further columns are kept.

    Arguments:
        path: of the file, in UTF-8.
        columns: those that are needed, in any order; capitals and spaces around a name do not matter.
        optional: others that are known.
    Raises:
        GradingError: with the line, for a file that cannot be read, is no table, or lacks a column; rows with more
            cells than the header are told all at once.
    """
    path = Path(path)
    text = _text(path)
    for delimiter in ",;\t":
        reader = csv.reader(io.StringIO(text.removeprefix(MARK), newline=""), delimiter=delimiter, strict=True)
        try:
            header = tuple("_".join(cell.split()).casefold() for cell in next(reader, ()))
        except csv.Error:
            continue
        if {*columns} <= {*header}:
            break
    else:
        raise GradingError(f"{path.name}, line 1: {_missing(text, columns, optional)}")
    faults = Faults(path.name)
    for column in (*columns, *optional):
        if header.count(column) > 1:
            faults.add(1, f"there are {header.count(column)} columns {column!r}: expected one")
    rows, line = [], reader.line_num + 1
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells[len(header) :]):
                faults.add(
                    line, f"there are {len(cells)} cells below {len(header)} columns: put 'a{delimiter}b' in quotes"
                )
            elif any(cells):
                cells += [""] * (len(header) - len(cells))
                rows.append((line, dict(zip(header, cells, strict=False))))
            line = reader.line_num + 1  # a cell may have several lines
    except csv.Error as problem:
        faults.add(reader.line_num, f"no table, {problem}")
    faults.demand_none()
    ends = re.search("\r\n|\n|\r", text)
    return Sheet(path, text, header, tuple(rows), delimiter, ends[0] if ends else "\r\n")


def _text(path):
    try:
        content = path.read_bytes()
    except OSError as problem:
        raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        raise GradingError(f"{path.name}, line {line}: no text in UTF-8; save it as CSV UTF-8") from None
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise GradingError(f"{path.name}, line {line}: no text; save it as CSV UTF-8")
    return text


def _missing(text, columns, optional):
    """A sentence on the first column that is not there."""
    first = text.removeprefix(MARK).splitlines()[:1] or [""]
    there = ["_".join(cell.strip(' "').split()).casefold() for cell in re.split("[,;\t]", first[0])]
    lacking = next((column for column in columns if column not in there), "")
    if not lacking:
        return f"no header: expected the columns {', '.join(columns)}"
    others = [name for name in there if name and name not in (*columns, *optional)]
    meant = did_you_mean(lacking, others, otherwise="")
    also = f" ({meant.removeprefix('did you mean ').rstrip('?')} is none)" if meant and others else ""
    return f"there is no column {lacking!r}{also}: expected the columns {', '.join(columns)}"


def number(text: str) -> float | None:
    """Return the number that a cell holds, with a decimal point or a decimal comma; None for any other text.

    >>> number("2,5"), number(" 3 "), number("two"), number("1e3")
    (2.5, 3.0, None, None)
    """
    text = text.strip()
    return float(text.replace(",", ".")) if _NUMBER.fullmatch(text) else None
