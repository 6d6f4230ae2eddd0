"""Your own: a roster with the columns id and name, folders named by ids, plain grades, folders on a shared drive."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from exercisegrader import GradingError, lms
from exercisegrader.lms import Claim, Known, Packed, System
from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import number
from exercisegrader.tables import as_text, letters, places

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.student import Student

#: The words by which a column is known, without regard to capitals, accents, spaces and signs.
SYNONYMS = {
    "id": "id, student id, student number, student no, matriculation number, registration number, SID",
    "name": "name, full name, student name, student",
    "first": "first name, given name, forename",
    "last": "last name, surname, family name",
    "email": "e-mail, mail, e-mail address",
    "login": "login, user name, NetID",
    "section": "section, sections, group, groups",
    "handed_in": "handed in, handed in at, submitted at, submission time, last modified (submission)",
    "sortable": "sortable, sortable name",
    "sis_id": "SIS id, SIS user id",
    "canvas_id": "Canvas id",
    "moodle_id": "Moodle id",
}
_FIELDS = {letters(word): field for field, words in SYNONYMS.items() for word in words.split(", ")}
#: What names of folders cannot have, or should not, on some drive.
_NOT_IN_NAMES = re.compile(r"[\x00-\x1f\x7f/\\:*?\"<>|#%~]+")


def is_id(head: str) -> bool:
    """Whether a column with this head is one of ids.

    >>> is_id("Student-ID"), is_id("ID number")
    (True, False)
    """
    return _FIELDS.get(letters(head)) == "id"


@lms.system
class Own(System):
    """A roster of one's own, and folders by id."""

    name, title, place = lms.OWN, "your own roster", "drive"
    roster = "the columns id and name, or words for them as Student ID and First name"
    ids = {"id": "id"}  # noqa: RUF012 - read and never changed

    def columns(self, header: Sequence[str]) -> Mapping[str, int] | None:
        """Return where the fields are, by `SYNONYMS`.

        Raises GradingError where two columns could be the same field.
        """
        found = places(header, _FIELDS)
        if "id" not in found or not {"name", "first", "last"} & found.keys():
            return None
        for place, head in enumerate(header):
            field = _FIELDS.get(letters(head))
            if field and found[field] != place:
                first, words = header[found[field]], field.replace("_", " ")
                raise GradingError(f"line 1: {first!r} and {head!r} could both be the {words}: rename one of them")
        return found

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says; a name beside a first name is a last name, as in "First name, Name"."""
        if "first" in cells and "last" not in cells:
            return {**cells, "name": "", "last": cells.get("name", "")}
        return cells

    def claim(self, name: str, known: Known) -> Claim | None:
        """Return whose a folder, or a notebook, named by an id is."""
        own = re.sub(r"(?i)\.ipynb$", "", name)
        students = known.by("id", name) or known.by("id", own) or known.by("roster_id", own)
        if not students and (drive := re.fullmatch(r"(.*)\(([^()]+)\)", name)):
            students = [one for one in known.by("id", drive[2]) if _folder(one) == name]
        return Claim(tuple(students)) if students else None

    def pack(self, notebooks: Mapping[Student, Mapping[str, bytes]], assignment: str, secret: str) -> Packed:
        """Return folders named by name and id, and a table of them."""
        files, rows = {}, [["folder", "id", "name", "email"]]
        for student, own in notebooks.items():
            folder = _folder(student)
            rows.append([folder, student.id, student.name, student.email])
            for name, content in own.items():
                files[f"{folder}/{name}"] = content
        files["folders.csv"] = as_text(rows, bom=True).encode()
        return Packed(
            files,
            "Copy the folders to the drive and share each with its student, whom folders.csv names; filled-in "
            "notebooks in the same folders are what grade takes.",
        )


def _folder(student):
    """The name of a student's folder on a shared drive."""
    name = " ".join(_NOT_IN_NAMES.sub(" ", student.name).split()).strip(" .")[:80]
    return f"{name.strip(' .')} ({student.id})".strip()


@output("grades.csv", "the grades by id, for any table")
def grades_csv(grades: Grades) -> str:
    """Return the grades as CSV: id, name and points of each student with a result, in the roster's order.

    A student who handed in nothing, or nothing that could be run, has an empty cell: what it costs is the instructor's
    decision. It begins with the mark by which Excel knows UTF-8. Where a submission ran without a jail, the head says
    so.

    >>> from types import SimpleNamespace as Student
    >>> from exercisegrader.marking import Marked, MarkedExercise
    >>> from exercisegrader.reports.outputs import Grades
    >>> from exercisegrader.results import Result
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), ())
    >>> mark = Marked(result, (MarkedExercise(None, 8 / 3),))
    >>> print(grades_csv(Grades("Tuning", [Student(id="s1", name="Ada")], [mark]))[1:])
    id,name,points
    s1,Ada,2.67
    <BLANKLINE>
    """
    head = "points (graded without a jail)" if grades.without_jail else "points"
    rows = [[one.id, one.name, "" if mark.total is None else number(mark.total)] for one, mark in grades.graded]
    return as_text([["id", "name", head], *rows], bom=True)


@output("feedback.zip", "the page of each student as a file by id, where the roster is your own")
def feedback_zip(grades: Grades) -> bytes | None:
    """Return a zip file with a page of feedback for each student, named by the id.

    It is None where the roster is that of a system with a form of its own.
    """
    found, pages = lms.of(grades.students), grades.pages
    if not pages or (found and not isinstance(found, Own)):
        return None
    return lms.zipped({f"{student}.html": content for student, content in pages.items()})
