"""Tables of comma-separated values, as learning management systems and spreadsheets write and read them.

A spreadsheet saves them with commas, semicolons or tabs, with decimal commas, and with a mark of UTF-8 in front. All
faults of a table are told in one run. What an instructor's spreadsheet saved stays as it is, byte for byte; rows are
added below in the same way.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from exercisegrader import GradingError
from plainmath.validation import did_you_mean

DELIMITERS = ",;\t"
#: The mark at the beginning of a file by which Excel knows UTF-8.
BOM = "\ufeff"
#: So many faults of a file are told.
MOST_FAULTS = 40
#: What a spreadsheet takes for the beginning of a formula; a semicolon begins a cell where the comma is decimal.
_FORMULA = re.compile(r"((?:^|;)\s*)(?=[=+\-@＝＋－＠])")
_HARMLESS = re.compile(r"-|[+-]?\d+(?:[.,]\d+)?")
_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)")


def letters(name: str) -> str:
    """Letters and digits of a name, without accents, as small letters: what no system leaves out or changes.

    >>> letters("Müller-Lüdenscheidt, Anne")
    'mullerludenscheidtanne'
    """
    plain = unicodedata.normalize("NFKD", unicodedata.normalize("NFKD", name).casefold())
    return "".join(sign for sign in plain if sign.isalnum())


class Faults:
    """The faults of a file, which are told all at once.

    >>> faults = Faults("marks.csv")
    >>> faults.add(3, "points are 'two': expected a number")
    >>> faults.demand_none()
    Traceback (most recent call last):
    ...
    exercisegrader.GradingError: marks.csv, line 3: points are 'two': expected a number
    """

    def __init__(self, name: str, found: Iterable[tuple[int, str]] = ()):
        """Take the name of the file, and faults that are known already."""
        self.name, self._found = name, list(found)

    def add(self, line: int, says: str) -> None:
        """Note a fault in a line."""
        self._found.append((line, says))

    def told(self) -> list[str]:
        """Return a sentence on each of them, and one on how many more there are."""
        more = len(self._found) - MOST_FAULTS
        told = [f"{self.name}, line {line}: {says}" for line, says in self._found[:MOST_FAULTS]]
        return told + ([f"{self.name}: {more} more such faults"] if more > 0 else [])

    def demand_none(self) -> None:
        """Raise GradingError with all of them, each in a line, where there is one."""
        if told := self.told():
            raise GradingError("\n".join(told))


def places(header: Sequence[str], heads: Mapping[str, str]) -> dict[str, int]:
    """Return where the columns are of which the letters of the head are known: {field: place of the first one}.

    >>> places(["Student", "SIS User ID", "Id"], {"sisuserid": "sis_id", "id": "canvas_id"})
    {'sis_id': 1, 'canvas_id': 2}
    """
    found: dict[str, int] = {}
    for place, head in enumerate(header):
        if field := heads.get(letters(head)):
            found.setdefault(field, place)
    return found


@dataclass(frozen=True)
class Table:
    """The rows of a file, as it has them.

    Attributes:
        path: of the file.
        text: all of it, as it is.
        header: the heads of the columns, without spaces around them.
        rows: pairs of the line on which a row begins, counted from one, and its cells; blank rows are left out.
        delimiter: between the cells.
        faults: pairs of a line and why it is no row of this table.
    """

    path: Path
    text: str
    header: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    delimiter: str = ","
    faults: tuple[tuple[int, str], ...] = ()

    @property
    def bom(self) -> bool:
        """Whether the file begins with the mark by which Excel knows UTF-8."""
        return self.text.startswith(BOM)


@dataclass(frozen=True)
class Sheet:
    """A table that an instructor keeps, of which the columns have names.

    Attributes:
        table: as it is.
        header: the names of its columns, in small letters.
        rows: pairs of the number of a line and {column: cell}.
    """

    table: Table
    header: tuple[str, ...]
    rows: tuple[tuple[int, dict[str, str]], ...] = ()

    @classmethod
    def new(cls, path: Path, columns: Sequence[str]) -> Sheet:
        """Return a table without rows, of which there is no file yet, as Excel opens it.

        >>> Sheet.new(Path("marks.csv"), ["student", "points"]).table.text
        '\\ufeffstudent,points\\r\\n'
        """
        return cls(Table(path, BOM + _written([columns], ",", "\r\n"), tuple(columns), ()), tuple(columns))

    def continued(self, rows: Iterable[Mapping[str, str]]) -> str:
        """Return the text with more rows, {column: cell}, below; where there are none, the text as it is.

        >>> table = Table(Path("marks.csv"), "student;points;mine\\ns2;1;", ("student", "points", "mine"), (), ";")
        >>> Sheet(table, table.header).continued([{"student": "s1", "points": "2"}])
        'student;points;mine\\ns2;1;\\ns1;2;\\n'
        """
        text, ends = self.table.text, re.search("\r\n|\n|\r", self.table.text)
        newline = ends[0] if ends else "\r\n"
        cells = [[row.get(column, "") for column in self.header] for row in rows]
        return (
            text
            + (newline if cells and text[-1] not in "\r\n" else "")
            + _written(cells, self.table.delimiter, newline)
        )


def read(path: str | Path) -> Iterator[Table]:
    """Yield a table for each delimiter with which the file has a header, the likeliest first.

    Raises GradingError for a file that cannot be read, or is no text in UTF-8.
    """
    path = Path(path)
    text = _text(path)
    for delimiter in DELIMITERS:
        reader = csv.reader(io.StringIO(text.removeprefix(BOM), newline=""), delimiter=delimiter, strict=True)
        try:
            header = tuple(" ".join(cell.split()) for cell in next(reader, []))
        except csv.Error:
            continue
        rows, faults, line = [], [], reader.line_num + 1
        try:
            for row in reader:
                if any(cell.strip() for cell in row[len(header) :]):
                    faults.append(
                        (line, f"there are {len(row)} cells below {len(header)} columns: put 'a{delimiter}b' in quotes")
                    )
                elif any(cell.strip() for cell in row):
                    rows.append((line, (*row, *[""] * len(header))[: len(header)]))
                line = reader.line_num + 1  # a cell may have several lines
        except csv.Error as problem:
            faults.append((reader.line_num, f"no table, {problem}"))
        yield Table(path, text, header, tuple(rows), delimiter, tuple(faults))


def read_sheet(path: str | Path, columns: Collection[str], optional: Collection[str] = ()) -> Sheet:
    """Return the table in a file; further columns are kept.

    Arguments:
        path: of the file, in UTF-8.
        columns: those that are needed, in any order; capitals and spaces around a name do not matter.
        optional: others that are known.
    Raises:
        GradingError: with the line, for a file that cannot be read, is no table, or lacks a column.
    """
    header: tuple[str, ...] = ()
    for table in read(path):
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
    return Sheet(table, header, tuple(rows))


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


def _text(path):
    try:
        content = path.read_bytes()
    except OSError as problem:
        raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
    try:
        text, damaged = content.decode("utf-8"), content.find(b"\0")
    except UnicodeDecodeError as problem:
        damaged = problem.start
    if damaged >= 0:
        line = content.count(b"\n", 0, damaged) + 1
        raise GradingError(f"{path.name}, line {line}: no text in UTF-8; save it as CSV UTF-8")
    return text


def guarded(text: str) -> str:
    """Return a cell that no spreadsheet runs as a formula: it gets an apostrophe in front, as OWASP suggests.

    (https://owasp.org/www-community/attacks/CSV_Injection)

    >>> guarded("=HYPERLINK(1)"), guarded("-"), guarded("-3.5")
    ("'=HYPERLINK(1)", '-', '-3.5')
    """
    shown = "".join(sign if sign.isprintable() or sign in "\r\n" else " " for sign in text.lstrip("\r\n\t"))
    return shown if _HARMLESS.fullmatch(shown.strip()) else _FORMULA.sub(r"\1'", shown)


def as_text(
    rows: Iterable[Sequence[str]], delimiter: str = ",", bom: bool = False, trusted: Collection[int] = ()
) -> str:
    """Return rows as comma-separated values, all cells `guarded`.

    Arguments:
        rows: with the header.
        delimiter: between the cells.
        bom: whether to begin with the mark by which Excel knows UTF-8.
        trusted: places of columns that are as they are, because only instructors write there.

    >>> as_text([["id", "name"], ["s1", "Doe, Jane"]])
    'id,name\\ns1,"Doe, Jane"\\n'
    """
    cells = [[cell if k in trusted else guarded(cell) for k, cell in enumerate(row)] for row in rows]
    return BOM * bom + _written(cells, delimiter, "\n")


def _written(rows, delimiter, newline):
    file = io.StringIO(newline="")
    csv.writer(file, delimiter=delimiter, lineterminator=newline).writerows(rows)
    return file.getvalue()
