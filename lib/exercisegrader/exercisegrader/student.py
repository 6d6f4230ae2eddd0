"""Who takes part, as far as a roster tells."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import dataclass, field

from exercisegrader.tables import Table


@dataclass(frozen=True)
class Student:
    """One who takes part.

    Attributes:
        id: what variants are drawn from and folders are named after; unique without regard to case.
        name: as it is shown.
        sortable: as it is sorted, "Doe, Jane"; Canvas puts it into the names of files.
        canvas_id: Canvas's number.
        sis_id: the number in the student information system; Moodle's "ID number", Gradescope's "SID".
        login: the name to log in with.
        section: section or groups.
        email: the address.
        moodle_id: the number in Moodle's "Participant 12345", which belongs to one assignment.
        handed_in: when the student handed in, where the roster says it.
        roster_id: the id on the roster, where another one is kept from the release.
        id_from: the column from which the id is.
        system: the `lms.System` of the roster.
        row: the student's row, as the roster has it.
        table: the whole roster, as it is.

    What is not known is the empty text, or None.

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
    handed_in: datetime.datetime | None = None
    roster_id: str = field(default="", compare=False)
    id_from: str = field(default="", compare=False)
    system: str = field(default="", compare=False)
    row: tuple[str, ...] = field(default=(), compare=False, repr=False)
    table: Table | None = field(default=None, compare=False, repr=False)


def in_short(names: Sequence[str]) -> str:
    """Return a few of many names, in words.

    >>> in_short(["s1", "s2"]), in_short([f"s{k}" for k in range(60)])
    ('s1 and s2', 's0, s1, s2 and 57 more')
    """
    *most, last = names if len(names) <= 4 else [*names[:3], f"{len(names) - 3} more"]
    return f"{', '.join(most)} and {last}" if most else last
