"""Canvas: its gradebook, the names in its downloads, its import of grades, feedback as comments, links to notebooks.

All of it is as https://github.com/instructure/canvas-lms does it, in the files named below.

**Gradebook** (lib/gradebook_exporter.rb). The heads are English in all languages of Canvas: Student, or LastName and
FirstName; ID, SIS User ID, SIS Login ID, Section; then the assignments, each as its title and number. Below are a row
without a student where marks are posted by hand, and the row "Points Possible"; the test student comes last. The
delimiter is a semicolon where the decimal sign is a comma.

**Names** (lib/content_zipper.rb). ``doejane_123_456_heater.ipynb``, or ``doejane_LATE_123_456_heater.ipynb``: the
sortable name in small letters without spaces and signs, the number of the student, the number of the file, and the
file's own name. Numbers of files grow. A student who hands in ``heater.ipynb`` again has ``heater-1.ipynb``, as in any
folder of Canvas (make_unique_filename in app/models/attachment.rb). From an anonymous assignment the name is
``anon_Ab3dE_456_heater.ipynb``.

**Grades** (lib/gradebook_importer.rb). A student is found by ID, then SIS User ID, SIS Login ID and name; an
assignment by the number in its head, then by its title; if there is none, Canvas asks. Delimiters and decimal signs are
found out. Of a byte-order mark nothing is known there, and before LastName it makes the header invalid: the file has
one only where the export has one, and no LastName.

**Feedback** (generate_comments_from_files in app/models/abstract_assignment.rb). "Upload Submissions" takes a zip file
of files with the names of the download, and attaches each to a comment. The attachment gets the name that the student
handed in, whatever it is: so it is a notebook here, too, with the feedback in it.

**Notebooks.** Canvas has no way to give each student a file of their own: files belong to a course, a group or an
assignment, and a comment with a file can only answer a file that was handed in.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from exercisegrader import lms, tables
from exercisegrader.lms import Claim, Known, Packed, System
from exercisegrader.reports.lines import of_exercise, overall
from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import in_text, number, visible
from exercisegrader.student import in_short
from exercisegrader.tables import as_text, letters, places

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.student import Student

#: A name ending in one of these is read as Canvas does: "Doe, John, Jr." is John Doe Jr.
_SUFFIX = re.compile(r"(?i)(sn?r\.?|senior|jn?r\.?|junior|ii|iii|iv|v|vi|esq\.?|esquire)")
_NUMBERS = re.compile(r"(?=_([0-9]{1,20})_([0-9]{1,20})_)")
_ANONYMOUS = re.compile(r"(?:LATE_)?anon_[0-9A-Za-z]+_[0-9]+_")
_TITLE = re.compile(r"(.*\S)\s*\(([0-9]+)\)")
#: The heads of what a row says of a student, and the fields that they are.
_HEADS = {
    "student": "sortable", "lastname": "last", "firstname": "first", "id": "canvas_id", "sisuserid": "sis_id",
    "sisloginid": "login", "integrationid": "integration", "rootaccount": "account", "section": "section",
}  # fmt: skip
_POINTS = "Points Possible"
#: What stands in the cell of a student who is excused.
EXCUSED = "EX"


@lms.system
class Canvas(System):
    """Canvas."""

    name, title, place = "canvas", "Canvas", "canvas"
    roster = "an export of Canvas's gradebook"
    ids = {"sis_id": "SIS User ID", "login": "SIS Login ID", "canvas_id": "ID"}  # noqa: RUF012 - read and never changed

    def columns(self, header: Sequence[str]) -> Mapping[str, int] | None:
        """Return where the fields are."""
        found = places(header, _HEADS)
        named = "sortable" in found or {"last", "first"} <= found.keys()
        return found if named and "canvas_id" in found and {"sis_id", "login", "section"} & found.keys() else None

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says; None for the rows of the assignments, and for the test student."""
        if "sortable" in cells:
            sortable = _unquoted(cells["sortable"])
        else:
            sortable = ", ".join(filter(None, (_unquoted(cells["last"]), _unquoted(cells["first"]))))
        fields = {field: cells.get(field, "") for field in ("canvas_id", "sis_id", "login", "section", "handed_in")}
        is_test = sortable == "Student, Test" and not fields["sis_id"]
        if sortable.startswith(_POINTS) or is_test or not any((sortable, *fields.values())):
            return None
        name = _spoken(sortable) or fields["canvas_id"]
        return {**fields, "sortable": sortable, "name": name, "handed_in": cells.get("handed_in", "")}

    def claim(self, name: str, known: Known) -> Claim | None:
        """Return whose a file of a download is.

        A number counts for a student only behind that student's name, where the roster tells how Canvas writes it.
        """
        if _ANONYMOUS.match(name):
            return Claim(reason="is from an anonymous download of Canvas, which does not say whose it is")
        numbers = list(_NUMBERS.finditer(name))
        if not numbers:
            return None
        found = [known.by("canvas_id", one[1]) for one in numbers]
        fitting = [
            [student for student in students if _fits(student, name[: one.start()])]
            for one, students in zip(numbers, found, strict=True)
        ]
        first = numbers[0]
        written = name[: first.start()]
        said = {"late": True if written.endswith("_LATE") else None, "upload": int(first[2])}
        if fitting[0]:
            return Claim(tuple(student for students in fitting for student in students), **said)
        if found[0]:
            return Claim(reason=f"has Canvas's number of {found[0][0].id} and another name")
        named = tuple(student for student in known.named(written.removesuffix("_LATE")) if not student.canvas_id)
        return Claim(named, f"has Canvas's number {first[1]}, which the roster does not have", **said)

    def remarks(self, students: Sequence[Student], title: str, points: float) -> Sequence[str]:
        """Return what keeps the grades from going where they belong."""
        table = students[0].table
        heads = _of_title(table.header, title) if table else []
        if len(heads) != 1:
            how_many = "two assignments or more" if heads else "no assignment"
            there = [said[1] for head in table.header if (said := _TITLE.fullmatch(head))] if table else []
            others = f" but {in_short([*map(repr, there)])}" if there and not heads else ""
            return (
                f"canvas_grades.csv: the gradebook of the roster has {how_many} called {title!r}{others}, so that "
                "Canvas will ask where the grades go; export it again once there is one",
            )
        said, excused = [], [one.id for one in students if one.row[heads[0]].strip().upper() == EXCUSED]
        if excused:
            are = "is" if len(excused) == 1 else "are"
            said.append(f"canvas_grades.csv: {in_short(excused)} {are} excused in Canvas, and so left")
        there = tables.number(_possible(table, heads[0]))
        if there is not None and abs(there - points) >= 0.005:
            said.append(
                f"canvas_grades.csv: {table.header[heads[0]]} has {number(there)} points in Canvas and "
                f"{number(points)} here, and grades are not scaled: change it in Canvas"
            )
        return said

    def pack(self, notebooks: Mapping[Student, Mapping[str, bytes]], assignment: str, secret: str) -> Packed:
        """Return a tree of folders whose names nobody can guess, and a table of links to them."""
        files, rows = {}, [["id", "name", "email", "login", "link"]]
        for student, own in notebooks.items():
            folder = _unguessable(student.id, assignment, secret)
            for name, content in own.items():
                files[f"links/{folder}/{name}"] = content
                rows.append([student.id, student.name, student.email, student.login, f"{folder}/{name}"])
        files["links.csv"] = as_text(rows, bom=True).encode()
        return Packed(
            files,
            "Canvas cannot give each student a file of their own: put the folder links on a web space that does not "
            "list its folders, and send each student the link of links.csv behind its address, as by mail merge.",
        )


def _fits(student, written):
    """Whether the student has the name in front of Canvas's number, as far as the roster tells."""
    return not student.sortable or letters(student.sortable) == letters(written.removesuffix("_LATE"))


def _unquoted(name):
    """A name that begins with an equals sign is exported as ="=...", lest a spreadsheet computes it."""
    return name[2:-1] if name.startswith('="') and name.endswith('"') and len(name) > 2 else name


def _spoken(sortable):
    """Doe, Jane as Jane Doe."""
    surname, *given = (part.strip() for part in sortable.split(",", 2))
    if len(given) == 2 and not _SUFFIX.fullmatch(given[1]):
        given = [" ".join(given)]
    return " ".join(filter(None, [*given[:1], surname, *given[1:]]))


def _of_title(header, title):
    """The places of the assignments with this title."""
    return [
        place
        for place, head in enumerate(header)
        if (said := _TITLE.fullmatch(head)) and letters(said[1]) == letters(title) != ""
    ]


def _possible(table, place):
    """The points of an assignment that the roster says; empty where it does not."""
    return next((row[place].strip() for _, row in table.rows if row[0].strip().startswith(_POINTS)), "")


def _unguessable(student, assignment, secret):
    """A name of 128 bits that only the secret's owner can make."""
    digest = hmac.new(secret.encode(), f"link of {assignment} for {student}".encode(), hashlib.sha256).digest()
    return base64.b32encode(digest[:16]).decode().rstrip("=").lower()


@output("canvas_grades.csv", "the grades as Canvas imports them, where the roster is a gradebook of Canvas")
def canvas_grades(grades: Grades) -> str | None:
    """Return the students' columns of the gradebook and the assignment's, a row for each student with a result.

    The head of the assignment's column is the gradebook's, with the number, where one has its title. A student without
    a grade here, and one who is excused, keeps the cell of the gradebook. Where a submission ran without a jail, the
    column is named so, and Canvas asks which assignment is meant. A text that a spreadsheet would run as a formula is
    guarded; Canvas finds the student by ID then. It is None where the roster is not of Canvas.
    """
    students, title, unsafe = grades.students, grades.title, grades.without_jail
    found, table = lms.of(students), students[0].table if students else None
    if not isinstance(found, Canvas) or table is None:
        return None
    columns = found.columns(table.header) or {}
    own_places = sorted(columns.values())
    heads = [] if unsafe else _of_title(table.header, title)
    own = heads[0] if len(heads) == 1 else None
    points = max((mark.result.points for mark in grades.marks), default=0)
    comma = table.delimiter == ";"
    head = table.header[own] if own is not None else f"{title} (graded without a jail)" if unsafe else title
    possible = (_possible(table, own) if own is not None else "") or _grade(points, comma)
    rows = [
        [*(table.header[place] for place in own_places), head],
        [f"    {_POINTS}", *[""] * (len(own_places) - 1), possible],
    ]
    for student, mark in grades.graded:
        there = student.row[own].strip() if own is not None else ""
        cell = there if mark.total is None or there.upper() == EXCUSED else _grade(mark.total, comma)
        rows.append([*(_unquoted(student.row[place]) for place in own_places), cell])
    return as_text(rows, table.delimiter, bom=table.bom and "last" not in columns)


def _grade(points, comma):
    return number(points).replace(".", ",") if comma else number(points)


@output("canvas_feedback.zip", 'the feedback as "Upload Submissions" of Canvas takes it, where the files came from it')
def canvas_feedback(grades: Grades) -> bytes | None:
    """Return a zip file with a notebook for each file of Canvas that was graded, under the file's name there.

    It is None where no file was of a download of Canvas.
    """
    files = {}
    for student, mark in grades.graded:
        name = mark.result.file.rpartition("/")[2]
        claim = Canvas().claim(name, Known([student]))
        if claim and claim.students:
            files[name] = _notebook(grades.title, student, mark, grades.reveal)
    return lms.zipped(files) if files else None


def _notebook(title, student, mark, reveal):
    """The feedback as a notebook: of HTML, a notebook that nobody trusts shows no formula, so it is text."""
    lines = [in_text(title), f"{student.name} ({student.id})", *overall(mark)]
    for one in mark.exercises:
        lines += ["", f"Exercise {one.judged.number} · {in_text(one.judged.title)}", *of_exercise(one, reveal)]
    source = "\n".join(f"    {visible(line)}" for line in lines)  # in Markdown, lines of code: no markup is in them
    cell = {"cell_type": "markdown", "id": "feedback", "metadata": {}, "source": source}
    notebook = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    return (json.dumps(notebook, ensure_ascii=False, indent=1) + "\n").encode()
