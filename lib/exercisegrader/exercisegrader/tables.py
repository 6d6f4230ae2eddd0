"""Tables of comma-separated values as learning management systems and spreadsheets write and read them."""

from __future__ import annotations

import contextlib
import csv
import datetime
import io
import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisegrader import GradingError

if TYPE_CHECKING:
    from pathlib import Path

DELIMITERS = ",;\t"
#: The mark at the beginning of a file by which Excel knows UTF-8.
BOM = "\ufeff"
#: What a spreadsheet takes for the beginning of a formula; a semicolon begins a cell where the comma is decimal.
_FORMULA = re.compile(r"((?:^|;)\s*)(?=[=+\-@＝＋－＠])")
_HARMLESS = re.compile(r"-|[+-]?\d+(?:[.,]\d+)?")


def letters(name: str) -> str:
    """Letters and digits of a name, without accents, as small letters: what no system leaves out or changes.

    >>> letters("Müller-Lüdenscheidt, Anne")
    'mullerludenscheidtanne'
    """
    plain = unicodedata.normalize("NFKD", unicodedata.normalize("NFKD", name).casefold())
    return "".join(sign for sign in plain if sign.isalnum())


#: A time as Moodle writes it, in English and in the English of the United States.
_LONG_FORMS = ("%A, %d %B %Y, %I:%M %p", "%A, %B %d, %Y, %I:%M %p")


@dataclass(frozen=True)
class Table:
    """The rows of a file, as it has them.

    Attributes:
        file: its name.
        header: the heads of the columns.
        rows: pairs of the line on which a row begins, counted from one, and its cells; blank rows are left out.
        delimiter: between the cells.
        bom: whether the file begins with the mark by which Excel knows UTF-8.
        remarks: sentences on how it was read.
        fault: why the rows are no table with this delimiter, in a sentence; empty where they are one.
    """

    file: str
    header: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    delimiter: str = ","
    bom: bool = False
    remarks: tuple[str, ...] = ()
    fault: str = ""


def read(path: Path) -> Iterator[Table]:
    """Yield a table for each delimiter with which the file has a header, the likeliest first.

    A byte-order mark decides the encoding, UTF-8 or UTF-16; without one it is UTF-8, and where that cannot be,
    Windows-1252, in which Excel saves, if all letters then are printable, which a remark says. A first line "sep=;", as
    Excel reads it, is skipped.

    Raises GradingError for a file that cannot be read, or is no text.
    """
    text, bom, remarks = _text(path)
    above = 0
    if said := re.match(r"sep=(.)\r?\n", text):
        text, above = text[said.end() :], 1
    for delimiter in said[1] if said else DELIMITERS:
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
        try:
            header = tuple(_plain(cell) for cell in next(reader, []))
        except csv.Error:
            continue
        rows, fault = (), ""
        try:
            rows = tuple(_rows(reader, len(header), above))
        except csv.Error as why:
            fault = f"{path.name}, line {reader.line_num + above}: no table, {why}"
        yield Table(path.name, header, rows, delimiter, bom, remarks, fault)


def _rows(reader, width, above):
    line = reader.line_num + 1
    for row in reader:
        if any(cell.strip() for cell in row):
            yield line + above, (*row, *[""] * (width - len(row)))
        line = reader.line_num + 1  # a cell may have several lines: the next row begins below the last of them


def _text(path):
    """The text of a file, whether it has the mark of UTF-8, and remarks."""
    try:
        content = path.read_bytes()
    except OSError as problem:
        raise GradingError(f"the roster {path} cannot be read: {problem.strerror}") from None
    bom, remarks = content.startswith(b"\xef\xbb\xbf"), ()
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        text = content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        text = "" if wide or bom else _windows(content)
        if not text:
            raise GradingError(
                f"{path.name}, line {line}: no text in {'UTF-16' if wide else 'UTF-8'}; save the roster as CSV in UTF-8"
            ) from None
        sign = next(sign for sign in text if not sign.isascii())
        word = next(word for word in re.findall(r"\w+|\W", text) if sign in word)
        remarks = (
            f"{path.name} is no UTF-8 and was read as Windows-1252, as Excel saves it (line {line}: {word!r}); save it "
            "as CSV in UTF-8 where that is wrong",
        )
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise GradingError(f"{path.name}, line {line}: no text; save it as CSV")
    return text, bom, remarks


def _windows(content):
    """The text in Windows-1252; empty where that is no text either."""
    try:
        text = content.decode("cp1252")
    except UnicodeDecodeError:
        return ""
    strange = [sign for sign in text if not sign.isascii()]
    if re.search(r"[ÂÃ][^\x00-\x7f]", text):  # letters of UTF-8, some of which are damaged
        return ""
    return text if all(sign.isalpha() or sign in "’‘–" for sign in strange) else ""


def _plain(cell):
    """A cell without spaces around it, and with one kind of space in it."""
    return " ".join(cell.split())


def moment(text: str) -> datetime.datetime | None:
    """Return the time that a text says, to the second, with a zone where it says one; None for no text, or a dash.

    It is of the form of ISO 8601, or of one of Moodle's long forms in English; forms in which day and month could be
    mistaken are not read. Raises ValueError for any other text.

    >>> moment("Monday, 3 November 2025, 11:59 PM")
    datetime.datetime(2025, 11, 3, 23, 59)
    >>> moment("2025-11-03 23:59"), moment("-")
    (datetime.datetime(2025, 11, 3, 23, 59), None)
    """
    text = _plain(text)
    if text in ("", "-", "–"):
        return None
    if re.match(r"\d{4}-\d\d-\d\d[ T]\d", text):
        with contextlib.suppress(ValueError):
            return datetime.datetime.fromisoformat(text).replace(microsecond=0)
    for form in _LONG_FORMS:
        with contextlib.suppress(ValueError):
            return datetime.datetime.strptime(text, form)
    raise ValueError(f"{text!r} is no time: expected one as 2025-11-03 23:59")


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
    file = io.StringIO()
    writer = csv.writer(file, delimiter=delimiter, lineterminator="\n")
    writer.writerows([cell if k in trusted else guarded(cell) for k, cell in enumerate(row)] for row in rows)
    return BOM * bom + file.getvalue()
