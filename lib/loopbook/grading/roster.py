"""Rosters: who takes part, from a list of one's own or from what Canvas and Moodle export.

The columns are those that the systems write, in English. Canvas: Student (or LastName and FirstName), ID, SIS User ID,
SIS Login ID, Section, then the assignments; below the header a row without a student where marks are posted by hand,
and the row "Points Possible"; the test student last (lib/gradebook_exporter.rb and gradebook_importer.rb in
https://github.com/instructure/canvas-lms). Moodle's grading worksheet: Identifier ("Participant 12345"), Full name, ID
number or Email address ... (mod/assign/gradingtable.php and mod/assign/feedback/offline/importgradeslib.php in
https://github.com/moodle/moodle). Moodle's grades and participants: First name, Last name or Surname, ID number,
Username, Email address, Groups (grade/export/txt/grade_export_txt.php in the same).
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from loopbook.grading import GradingError

#: What an id may be: it is the name of a folder on any system, and part of a web address.
POSSIBLE_ID = re.compile(
    r"(?!(?i:con|prn|aux|nul|com\d|lpt\d)(?:\.|$))[A-Za-z0-9][A-Za-z0-9._@-]{0,99}(?<!\.)", re.ASCII
)

#: A name ending in one of these is read as Canvas does: "Doe, John, Jr." is John Doe Jr.
_SUFFIX = re.compile(r"(?i)(sn?r\.?|senior|jn?r\.?|junior|ii|iii|iv|v|vi|esq\.?|esquire)")


@dataclass(frozen=True)
class Student:
    """One who takes part.

    Attributes:
        id: what variants are drawn from and folders are named after; unique without regard to case.
        name: as it is shown.
        sortable: as it is sorted, "Doe, Jane"; Canvas puts it into the names of files.
        canvas_id: Canvas's number.
        sis_id: the number in the student information system; Moodle's "ID number".
        login: the name to log in with.
        section: section or groups.
        email: the address.
        moodle_id: the number in Moodle's "Participant 12345", which belongs to one assignment.

    What is not known is the empty text.

    >>> Student("s1001", "Jane Doe").email
    ''
    """

    id: str
    name: str
    sortable: str = ""
    canvas_id: str = ""
    sis_id: str = ""
    login: str = ""
    section: str = ""
    email: str = ""
    moodle_id: str = ""


@dataclass(frozen=True)
class _Format:
    """A kind of roster: the columns that tell it, what a row says, and the fields that give an id, the best first."""

    recognised: tuple
    fields: Callable
    ids: dict


def read_roster(path: str | Path) -> tuple[Student, ...]:
    """The students of a roster, in its order: a file of comma-, semicolon- or tab-separated values in UTF-8.

    It is one of your own with the columns id and name, and any of email, login, section, sis_id, canvas_id, moodle_id,
    sortable; or an export of Canvas's gradebook, a Moodle grading worksheet, or Moodle's grades or participants. Of an
    export, the id is the first that every student has: in Canvas SIS User ID, SIS Login ID, ID; in Moodle ID number,
    Username, the number in Identifier, Email address.

    Raises GradingError, with the line, for a file that is missing or no text, an unknown header, a roster without
    students, and an id that is empty, impossible or not unique.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "roster.csv")
    ...     _ = path.write_text("id,name\\ns1001,Jane Doe\\n", encoding="utf-8")
    ...     [student.name for student in read_roster(path)]
    ['Jane Doe']
    """
    path = Path(path)
    kind, rows = _rows(path, _text(path))
    found = [(line, fields) for line, row in rows if (fields := kind.fields(row)) is not None]
    if not found:
        raise GradingError(f"{path.name} has a header and no student")
    field = next((field for field in kind.ids if all(fields[field] for _, fields in found)), None)
    if field is None:
        last = list(kind.ids)[-1]
        line = next(line for line, fields in found if not fields[last])
        columns = f"; ids come from the first full of: {', '.join(kind.ids.values())}" if len(kind.ids) > 1 else ""
        raise GradingError(f"{path.name}, line {line}: a student without an id{columns}")
    students, lines = [], {}
    for line, fields in found:
        student = Student(**{**fields, "id": fields[field]})
        if not POSSIBLE_ID.fullmatch(student.id):
            raise GradingError(
                f"{path.name}, line {line}: {student.id[:120]!r} cannot be an id, which is made of letters without "
                "accents, digits and . _ @ -, begins with a letter or a digit, does not end in a dot, has at most 100 "
                "characters and is not a name of a device, as con"
            )
        first = lines.setdefault(student.id.casefold(), line)
        if first != line:
            raise GradingError(f"{path.name}, line {line}: the id {student.id!r} is already that of line {first}")
        students.append(student)
    return tuple(students)


def _text(path):
    """The text of the file."""
    try:
        content = path.read_bytes()
    except OSError as problem:
        raise GradingError(f"the roster {path} cannot be read: {problem.strerror}") from None
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        raise GradingError(f"{path.name}, line {line}: no text in UTF-8; save the roster as CSV in UTF-8") from None
    if "\0" in text:
        raise GradingError(
            f"{path.name}, line {text[: text.index(chr(0))].count(chr(10)) + 1}: no text; save it as CSV"
        )
    return text


def _rows(path, text):
    """The format, and the rows that are not blank as (line, {column: cell})."""
    for delimiter in ",;\t":
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
        try:
            header = [_column(cell) for cell in next(reader, [])]
        except csv.Error:
            continue
        kind = next((kind for kind in _FORMATS if any(columns <= set(header) for columns in kind.recognised)), None)
        if kind is None:
            continue
        try:
            return kind, _cells(reader, header)
        except csv.Error as problem:
            raise GradingError(f"{path.name}, line {reader.line_num}: no table, {problem}") from None
    raise GradingError(
        f"{path.name}, line 1: no header of a roster; expected the columns id and name, or an export in English of "
        "Canvas's gradebook or of Moodle's grading worksheet, grades or participants"
    )


def _cells(reader, header):
    """The rows below the header; of two columns with one name the first counts."""
    rows, line = [], reader.line_num + 1
    for row in reader:
        cells = [" ".join(cell.split()) for cell in row]
        if any(cells):
            cells += [""] * (len(header) - len(cells))
            rows.append((line, dict(reversed(list(zip(header, cells, strict=False))))))
        line = reader.line_num + 1  # a cell may have several lines: the next row begins below the last of them
    return rows


def _column(cell):
    """A column's name, where capitals and the kind of space do not matter."""
    return "_".join(cell.casefold().split())


def _canvas(row):
    """What a row of Canvas's gradebook says; None where it is not a student's."""
    if "student" in row:
        sortable = _unquoted(row["student"])
    else:
        sortable = ", ".join(filter(None, (_unquoted(row["lastname"]), _unquoted(row["firstname"]))))
    known = {"canvas_id": "id", "sis_id": "sis_user_id", "login": "sis_login_id", "section": "section"}
    fields = {field: row.get(column, "") for field, column in known.items()}
    if sortable.startswith("Points Possible") or sortable == "Student, Test" or not any((sortable, *fields.values())):
        return None
    return {**fields, "email": "", "sortable": sortable, "name": _spoken(sortable) or fields["canvas_id"]}


def _unquoted(name):
    """A name that begins with an equals sign is exported as ="=...", lest a spreadsheet computes it."""
    return name[2:-1] if name.startswith('="') and name.endswith('"') and len(name) > 2 else name


def _spoken(sortable):
    """Doe, Jane as Jane Doe."""
    surname, *given = (part.strip() for part in sortable.split(",", 2))
    if len(given) == 2 and not _SUFFIX.fullmatch(given[1]):
        given = [" ".join(given)]
    return " ".join(filter(None, [*given[:1], surname, *given[1:]]))


def _worksheet(row):
    """What a row of Moodle's grading worksheet says."""
    number = re.search(r"[0-9]+$", row["identifier"])
    fields = _moodle(row)
    return {**fields, "name": row.get("full_name") or row["identifier"], "moodle_id": number[0] if number else ""}


def _participant(row):
    """What a row of Moodle's grades or participants says."""
    first, last = row["first_name"], row.get("last_name") or row.get("surname", "")
    fields = _moodle(row)
    name = " ".join(filter(None, (first, last))) or fields["login"] or fields["email"]
    return {**fields, "name": name, "sortable": ", ".join(filter(None, (last, first)))}


def _moodle(row):
    known = {"sis_id": "id_number", "login": "username", "email": "email_address"}
    groups = row.get("groups") or row.get("group", "")
    return {field: row.get(column, "") for field, column in known.items()} | {"section": groups, "moodle_id": ""}


def _own(row):
    """What a row of a roster of one's own says."""
    fields = {field: row.get(field, "") for field in Student.__dataclass_fields__}
    return {**fields, "name": fields["name"] or fields["id"]}


_MOODLE_IDS = {"sis_id": "ID number", "login": "Username", "moodle_id": "Identifier", "email": "Email address"}

#: The first that is recognised counts.
_FORMATS = (
    _Format(
        ({"student", "id"}, {"lastname", "firstname", "id"}),
        _canvas,
        {"sis_id": "SIS User ID", "login": "SIS Login ID", "canvas_id": "ID"},
    ),
    _Format(({"identifier"},), _worksheet, _MOODLE_IDS),
    _Format(({"first_name", "last_name"}, {"first_name", "surname"}), _participant, _MOODLE_IDS),
    _Format(({"id", "name"},), _own, {"id": "id"}),
)
