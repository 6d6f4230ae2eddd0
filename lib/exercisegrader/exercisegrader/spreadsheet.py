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

from exercisegrader import GradingError, tables
from exercisegrader.tables import BOM, Faults
from plainmath.validation import did_you_mean

_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)")


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
        sheet = cls(path, BOM, tuple(columns))
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
        is_complete = self.text in ("", BOM) or self.text.endswith(("\n", "\r"))
        return self.text + (self.newline if added and not is_complete else "") + added


def read(path: str | Path, columns: Collection[str], optional: Collection[str] = ()) -> Sheet:
    """Return the table in a file; further columns are kept.

    Arguments:
        path: of the file, in UTF-8.
        columns: those that are needed, in any order; capitals and spaces around a name do not matter.
        optional: others that are known.
    Raises:
        GradingError: with the line, for a file that cannot be read, is no table, or lacks a column.
    """
    header: tuple[str, ...] = ()
    for table in tables.read(path):
        header = max(header, tuple("_".join(head.split()).casefold() for head in table.header), key=len)
        if {*columns} <= {*header}:
            break
    else:
        raise GradingError(f"{Path(path).name}, line 1: {_missing(header, columns, optional)}")
    faults = Faults(table.path.name, table.faults)
    for column in (*columns, *optional):
        if header.count(column) > 1:
            faults.add(1, f"there are {header.count(column)} columns {column!r}: expected one")
    faults.demand_none()
    rows = [(line, dict(zip(header, map(str.strip, cells), strict=True))) for line, cells in table.rows]
    ends = re.search("\r\n|\n|\r", table.text)
    return Sheet(table.path, table.text, header, tuple(rows), table.delimiter, ends[0] if ends else "\r\n")


def _missing(header, columns, optional):
    """A sentence on the first column that is not there."""
    lacking = next(column for column in columns if column not in header)
    others = [name for name in header if name and name not in (*columns, *optional)]
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
