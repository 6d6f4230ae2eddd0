"""Moodle: its grading worksheet, grades and participants, the names in its downloads, feedback files for each student.

All of it is as https://github.com/moodle/moodle does it, in the files named below. The heads of its tables, and its
times, are in the language of whoever exports them; here they are English.

**Grading worksheet** (mod/assign/gradingtable.php): Identifier ("Participant 12345"), Full name, ID number or Email
address ..., Grade, Maximum grade, Last modified (submission), Last modified (grade), Feedback comments. It is filled in
and goes back by "Upload grading worksheet" (mod/assign/feedback/offline), which finds its columns by their heads, in
the language of whoever uploads it, and a student by the number alone; takes no grade where that is empty or above the
maximum; and keeps a grade that is newer than "Last modified (grade)". Its reader (lib/csvlib.class.php) takes a
byte-order mark away.

**Grades and participants** (grade/export/txt/grade_export_txt.php): First name, Last name, ID number, Username, Email
address, Groups. Grades for such a roster are a table for "Import" in the gradebook (grade/import/csv): map its column
of identification, then the last one to the item.

**Names** (mod/assign/classes/downloader.php). The folder of a submission is ``Jane Doe_12345_assignsubmission_file``,
in older versions with one more underscore at the end, and without folders the file
``Jane Doe_12345_assignsubmission_file_heater.ipynb``. The number is that of the grading worksheet; an underscore in the
name becomes a space, and of an anonymous submission the name is Participant. They say nothing of lateness: the
worksheet does.

**Files for each student** (mod/assign/feedback/file/importziplib.php). "Upload multiple feedback files in a zip" takes
files with the same names and hands each to its student, who needs to have handed in nothing: so an assignment with the
feedback type "Feedback files" hands out notebooks, too.
"""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from exercisegrader import GradingError, lms, tables
from exercisegrader.lms import Claim, Known, Packed, System, own
from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import number, visible
from exercisegrader.student import in_short
from exercisegrader.tables import as_text, places

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.student import Student

_NAME = re.compile(r"([^_]*)_([0-9]{1,20})_assignsubmission_[a-z]+(?:_.*)?", re.DOTALL)
#: The heads of its tables, and the fields that they are.
_HEADS = {
    "identifier": "moodle_id", "fullname": "name", "firstname": "first", "lastname": "last", "surname": "last",
    "idnumber": "sis_id", "username": "login", "emailaddress": "email", "groups": "section", "group": "section",
    "grade": "grade", "maximumgrade": "maximum", "lastmodifiedsubmission": "handed_in", "lastmodifiedgrade": "graded",
    "feedbackcomments": "comments",
}  # fmt: skip
#: What of them is in the export of grades and of participants.
_OF_CLASS = ("first", "last", "section", "sis_id", "login", "email")


@lms.system
class Moodle(System):
    """Moodle."""

    name, title, place = "moodle", "Moodle", "moodle"
    roster = "an export of Moodle's grading worksheet, grades or participants"
    ids = {  # noqa: RUF012 - read and never changed
        "sis_id": "ID number", "login": "Username", "moodle_id": "Identifier", "email": "Email address"
    }  # fmt: skip

    def columns(self, header: Sequence[str]) -> Mapping[str, int] | None:
        """Return where the fields are."""
        found = places(header, _HEADS)
        if "moodle_id" in found and {"graded", "grade"} & found.keys():  # the grading worksheet
            return {field: index for field, index in found.items() if field not in ("first", "last")}
        known = {"first", "last"} <= found.keys() and {"sis_id", "login", "email"} & found.keys()
        if known and not any(map(own.is_id, header)):
            return {field: found[field] for field in _OF_CLASS if field in found}
        return None

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says."""
        if "moodle_id" not in cells:
            known = cells["first"] or cells["last"]
            return cells if known else {**cells, "name": cells.get("login") or cells.get("email", "")}
        said = re.search(r"[0-9]+$", cells["moodle_id"])
        name = cells.get("name") or cells["moodle_id"]
        return {**cells, "name": name, "moodle_id": said[0] if said else ""}

    def claim(self, name: str, known: Known) -> Claim | None:
        """Return whose a folder or a file of a download is."""
        parts = _NAME.fullmatch(name)
        if parts is None:
            return None
        students = known.by("moodle_id", parts[2]) or known.named(parts[1])
        return Claim(tuple(students), "has a name and a number of Moodle that the roster does not have")

    def remarks(self, students: Sequence[Student], title: str, points: float) -> Sequence[str]:
        """Return what keeps the grades from going where they belong."""
        columns = _columns(students)
        if "moodle_id" not in columns:
            return (
                "moodle_grades.csv is for the import of the gradebook: with the grading worksheet of the assignment as "
                "the roster, it would be that worksheet, filled in",
            )
        if "maximum" not in columns:
            return (
                "moodle_grades.csv: the worksheet has no maximum grade: set the assignment in Moodle to grades in "
                "points, because a scale takes none",
            )
        said = {tables.number(student.row[columns["maximum"]]) for student in students} - {None}
        other = sorted(there for there in said if abs(there - points) > 0.005)
        if not other:
            return ()
        return (
            f"moodle_grades.csv: the assignment has {number(other[0])} points in Moodle and {number(points)} "
            "here, and grades are not scaled: change it in Moodle, and take its worksheet again",
        )

    def pack(self, notebooks: Mapping[Student, Mapping[str, bytes]], assignment: str, secret: str) -> Packed:
        """Return a zip file of feedback files. Raises GradingError where a student's number is not known."""
        unknown = [student.id for student in notebooks if not student.moodle_id]
        if unknown:
            raise GradingError(
                f"Moodle hands out files by the numbers of a grading worksheet, and there is none of "
                f"{in_short(unknown)}: take the worksheet of the assignment as the roster"
            )
        zipped = {
            f"{_prefix(student, student.moodle_id)}_{name}": content
            for student, files in notebooks.items()
            for name, content in files.items()
        }
        return Packed(
            {f"{assignment}_for_moodle.zip": lms.zipped(zipped)},
            "In the assignment whose worksheet is the roster, with Feedback files among its feedback types, choose "
            '"Upload multiple feedback files in a zip": each student finds their own there.',
        )


def _columns(students):
    table = students[0].table if students else None
    return (Moodle().columns(table.header) if table else None) or {}


def _prefix(student, identifier):
    """The beginning of the names of a student's files: the importer looks at the number alone."""
    name = " ".join(re.sub(r"[\x00-\x1f\x7f_/\\:*?\"<>|]+", " ", student.name).split()).strip(" .~")
    return f"{name[:80] or 'Participant'}_{identifier}_assignsubmission_file"


@output("moodle_grades.csv", "the grades as Moodle takes them, where the roster is its worksheet or another table")
def moodle_grades(grades: Grades) -> str | None:
    """Return the grading worksheet of the roster, filled in; of another table of Moodle, one for its gradebook.

    In the worksheet, what has no grade here, and all other cells, are as they were; what the instructor has said, and
    what lateness costs, takes the place of the comments, which are HTML there. Where a submission ran without a jail,
    there is no worksheet, whose columns cannot say so, and the column of the other table does. It is None where the
    roster is not of Moodle.
    """
    students, unsafe = grades.students, grades.without_jail
    if not isinstance(lms.of(students), Moodle) or students[0].table is None:
        return None
    table, columns = students[0].table, _columns(students)
    if "grade" in columns and "moodle_id" in columns and not unsafe:
        marks = {student.id: mark for student, mark in grades.graded}
        rows = [_filled(student.row, marks.get(student.id), columns) for student in students]
        return as_text([table.header, *rows], table.delimiter, table.bom, {columns.get("comments", -1)})
    shown = sorted(columns[field] for field in columns if field in ("moodle_id", "name", "first", "last", *Moodle.ids))
    head = f"{grades.title} (graded without a jail)" if unsafe else grades.title
    rows = [[*(table.header[place] for place in shown), head]]
    for student, mark in grades.graded:
        grade = "" if mark.total is None else number(mark.total)
        rows.append([*(" ".join(student.row[place].split()) for place in shown), grade])
    return as_text(rows, bom=table.bom)


def _filled(row, mark, columns):
    """A row of the worksheet with its grade and comments."""
    row = list(row)
    if mark and mark.total is not None:
        row[columns["grade"]] = number(mark.total)
    if mark and "comments" in columns:
        said = [*filter(None, [mark.late]), *mark.comments]
        said += [
            f"Exercise {exercise.judged.number}: {sentence}"
            for exercise in mark.exercises
            for sentence in (*exercise.history, *exercise.comments)
        ]
        if said:
            row[columns["comments"]] = html.escape(" · ".join(map(visible, said)), quote=False)
    return row


@output("moodle_feedback.zip", 'the feedback as Moodle takes it by "Upload multiple feedback files in a zip"')
def moodle_feedback(grades: Grades) -> bytes | None:
    """Return a zip file with a page of feedback for each student whose number in Moodle is known.

    That is the number of the file that was graded, else that of the roster. It is None where no number is known.
    """
    files, pages = {}, grades.pages
    for student, mark in grades.graded:
        names = [found[2] for part in mark.result.file.split("/") if (found := _NAME.fullmatch(part))]
        identifier = names[0] if names else student.moodle_id
        if identifier and student.id in pages:
            files[f"{_prefix(student, identifier)}_feedback.html"] = pages[student.id]
    return lms.zipped(files) if files else None
