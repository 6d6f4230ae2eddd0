"""Who takes part, as far as a roster tells."""

from __future__ import annotations

import datetime
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from exercisegrader.tables import Table
from plainmath.validation import did_you_mean


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


def parts(students: Sequence[Student]) -> dict[str, str]:
    """Return the name of the files for whoever marks a student's section, by the student's id.

    It is "all" in a class without sections, and "others" for those who have none in a class with some.
    """
    rest = "others" if any(student.section for student in students) else "all"
    return {one.id: re.sub(r"\W+", "_", one.section).strip("_")[:80] or rest for one in students}


class Roll:
    """The ids of a roster, as they are found in tables of an instructor: without regard to capitals.

    Arguments:
        ids: of the roster.
        also: {another id of a student: id}.
        graded: the ids of those of whom there are results; who is no longer on the roster is one of the `former`.

    >>> roll = Roll(["s1", "s2"], {"a17": "s1"}, ["s9"])
    >>> roll.find("A17"), roll.find("s3"), roll.former
    ('s1', None, {'s9'})
    """

    def __init__(self, ids: Collection[str], also: Mapping[str, str] | None = None, graded: Collection[str] = ()):
        self.ids, self.former = ids, {*graded} - {*ids}
        self._known = {other.casefold(): id for other, id in (*(also or {}).items(), *((id, id) for id in ids))}

    def find(self, said: str) -> str | None:
        """Return the id that is meant; None where it is none of the roster's."""
        return self._known.get(said.casefold())

    def fault(self, said: str) -> str:
        """Return a sentence on what is no id."""
        meant = did_you_mean(said, [*self.ids, *self._known], "expected an id")
        return f"there is no student {said!r} on the roster: {meant}"


def in_short(names: Sequence[str]) -> str:
    """Return a few of many names, in words.

    >>> in_short(["s1", "s2"]), in_short([f"s{k}" for k in range(60)])
    ('s1 and s2', 's0, s1, s2 and 57 more')
    """
    *most, last = names if len(names) <= 4 else [*names[:3], f"{len(names) - 3} more"]
    return f"{', '.join(most)} and {last}" if most else last
