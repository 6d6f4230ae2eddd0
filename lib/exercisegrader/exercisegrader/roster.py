"""Rosters: who takes part, from a list of one's own or from what a learning management system exports."""

from __future__ import annotations

import contextlib
import datetime
import re
from pathlib import Path

from exercisegrader import GradingError, lms, tables
from exercisegrader.student import Student, in_short
from exercisegrader.tables import Faults

#: What an id may be: it is the name of a folder on any system, and part of a web address.
POSSIBLE_ID = re.compile(
    r"(?!(?i:con|prn|aux|nul|com\d|lpt\d)(?:\.|$))[A-Za-z0-9][A-Za-z0-9._@-]{0,99}(?<!\.)", re.ASCII
)
#: What an instructor may add to any export.
_ADDED = {"handedin": "handed_in", "section": "section"}
#: A time as Moodle writes it, in English and in the English of the United States.
_LONG_FORMS = ("%A, %d %B %Y, %I:%M %p", "%A, %B %d, %Y, %I:%M %p")


def read_roster(path: str | Path) -> tuple[Student, ...]:
    """The students of a roster, in its order: a file of comma-, semicolon- or tab-separated values.

    It is one of your own with the columns id and name (`lms.own` says which others), or an export of a system in `lms`,
    to which columns "handed in" and "section" may be added; both in UTF-8. Of an export, the id of each student is in
    the first of the system's columns that is full in this row: in Canvas SIS User ID, SIS Login ID, ID; in Moodle ID
    number, Username, the number in Identifier, Email address. `lms.remarks` says where ids come from different columns.

    Raises GradingError with all that is wrong, a line for each fault: a file that is missing or no text, an unknown
    header, a roster without students; an id that is missing, impossible or not unique, a row with more cells than the
    header, a time that cannot be read.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "roster.csv")
    ...     _ = path.write_text("id,name\\ns1001,Jane Doe\\n", encoding="utf-8")
    ...     [student.name for student in read_roster(path)]
    ['Jane Doe']
    """
    table, system, columns = _recognised(Path(path))
    faults, students, lines = Faults(table.path.name, table.faults), [], {}
    for line, row in table.rows:
        cells = {name: " ".join(row[index].split()) for name, index in columns.items()}
        fields = system.student(cells)
        if fields is None:
            continue
        student, wrong = _student(system, fields, row, table)
        first = lines.setdefault(student.id.casefold(), line)
        if student.id and first != line:
            wrong.append(f"the id {student.id!r} is already that of line {first}")
        for says in wrong:
            faults.add(line, says)
        students.append(student)
    faults.demand_none()
    if not students:
        raise GradingError(f"{table.path.name} has a header and no student")
    return tuple(students)


def _recognised(path):
    """The table of a file, the system whose roster it is, and the places of the fields."""
    seen: tuple[str, ...] = ()
    for table in tables.read(path):
        seen = max(seen, table.header, key=len)
        exports = [one for one in lms.registered() if one.name != lms.OWN]
        others = [one for one in lms.registered() if one.name == lms.OWN]  # its heads may be in an export, too
        try:
            found = _fitting(exports, table) or _fitting(others, table)
        except GradingError as problem:
            raise GradingError(f"{path.name}, {problem}") from None
        if len(found) > 1:
            titles = " and of ".join(one.title for one, _ in found)
            raise GradingError(f"{path.name}, line 1: the header is that of {titles}: expected that of one of them")
        if found:
            system, columns = found[0]
            return table, system, {**tables.places(table.header, _ADDED), **columns}
    heads = [repr(head) for head in seen if head]
    says = f", {in_short(heads)}" if heads else ""
    *kinds, last = [one.roster for one in sorted(lms.registered(), key=lambda one: one.name != lms.OWN)]
    raise GradingError(f"{path.name}, line 1: no header of a roster{says}; expected {', '.join(kinds)} or {last}")


def _fitting(systems, table):
    """Pairs of a system whose roster it is, and the places of the fields."""
    return [(one, columns) for one in systems if (columns := one.columns(table.header)) is not None]


def _student(system, fields, row, table):
    """The student of a row, and what is wrong with it."""
    wrong = []
    known = {name: text for name, text in fields.items() if name in Student.__dataclass_fields__}
    id_from, known["id"] = next(
        ((words, fields[name]) for name, words in system.ids.items() if fields.get(name)), ("", "")
    )
    if not known["id"]:
        columns = f"; ids come from the first full of: {', '.join(system.ids.values())}" if len(system.ids) > 1 else ""
        wrong.append(f"a student without an id{columns}")
    elif not POSSIBLE_ID.fullmatch(known["id"]):
        wrong.append(
            f"{known['id'][:120]!r} cannot be an id, which is made of letters without accents, digits and . _ @ -, "
            "begins with a letter or a digit, does not end in a dot, has at most 100 characters and is not a name of a "
            "device, as con"
        )
    try:
        known["handed_in"] = moment(fields.get("handed_in", ""))
    except ValueError as problem:
        wrong.append(str(problem))
        known["handed_in"] = None
    first, last = fields.get("first", ""), fields.get("last", "")
    known["name"] = known.get("name") or f"{first} {last}".strip() or known["id"]
    known["sortable"] = known.get("sortable") or ", ".join(filter(None, (last, first)))
    return Student(**known, id_from=id_from, system=system.name, row=row, table=table), wrong


def moment(text: str) -> datetime.datetime | None:
    """Return the time that a text says, to the second, with a zone where it says one; None for no text, or a dash.

    It is of the form of ISO 8601, or of one of Moodle's long forms in English; forms in which day and month could be
    mistaken are not read. Raises ValueError for any other text.

    >>> moment("Monday, 3 November 2025, 11:59 PM")
    datetime.datetime(2025, 11, 3, 23, 59)
    >>> moment("2025-11-03 23:59"), moment("-")
    (datetime.datetime(2025, 11, 3, 23, 59), None)
    """
    text = " ".join(text.split())
    if text in ("", "-", "–"):
        return None
    if re.match(r"\d{4}-\d\d-\d\d[ T]\d", text):
        with contextlib.suppress(ValueError):
            return datetime.datetime.fromisoformat(text).replace(microsecond=0)
    for form in _LONG_FORMS:
        with contextlib.suppress(ValueError):
            return datetime.datetime.strptime(text, form)
    raise ValueError(f"{text!r} is no time: expected one as 2025-11-03 23:59")
