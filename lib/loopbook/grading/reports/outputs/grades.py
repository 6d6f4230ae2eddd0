"""The table of grades, as learning management systems import it."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

from loopbook.grading.reports.outputs import output
from loopbook.grading.reports.wording import number, visible, without_jail

if TYPE_CHECKING:
    from loopbook.grading.marking import Marked
    from loopbook.grading.roster import Student

COLUMNS = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
#: What a spreadsheet takes for the beginning of a formula; a semicolon begins a cell where the comma is decimal.
_FORMULA = re.compile(r"((?:^|;)\s*)(?=[=+\-@＝＋－＠])")


@output("grades.csv", "the grades, as Canvas and Moodle import them")
def grades_csv(title: str, students: Iterable[Student], marks: Collection[Marked]) -> str:
    """Return the grades as CSV: a row for each student with a result, in the roster's order.

    Canvas imports it as it is: the header begins with Student and ID, then the SIS columns and Section, and what
    follows is an assignment, found by its title; a student is found by ID, then SIS User ID, SIS Login ID and name.
    (https://github.com/instructure/canvas-lms/blob/master/lib/gradebook_importer.rb)
    In Moodle's import of CSV, "map from" SIS User ID "to" ID number or from SIS Login ID to username, and the last
    column to the grade item. (https://docs.moodle.org/en/Grade_import, and grade/import/csv/classes/load_data.php)
    There is no row "Points Possible": Canvas needs none, and Moodle would take it for a student.

    - A student who handed in nothing, or nothing that could be run, has an empty cell, which both systems read as no
      grade: what it costs is the instructor's decision.
    - Where a roster has none of the three identifications of an LMS, SIS User ID is the student's id here.
    - A text that a spreadsheet would run as a formula gets an apostrophe in front, as OWASP suggests
      (https://owasp.org/www-community/attacks/CSV_Injection). Such a name or identification matches nobody in the
      LMS, one of the other columns does.
    - Where a submission ran without a jail, the column is named so; the LMS then asks which assignment is meant.

    Arguments:
        title: of the assignment; the name of the last column.
        students: the roster.
        marks: a `Marked` for each submission.

    >>> from types import SimpleNamespace as Student
    >>> ada = Student(id="s1", name="Ada", canvas_id="17", sis_id="", login="ada", section="A")
    >>> from loopbook.grading.marking import Marked, MarkedExercise
    >>> from loopbook.grading.results import Result
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), ())
    >>> print(grades_csv("Tuning", [ada], [Marked(result, (MarkedExercise(None, 8 / 3),))]))
    Student,ID,SIS User ID,SIS Login ID,Section,Tuning
    Ada,17,,ada,A,2.67
    <BLANKLINE>
    """
    by_student = {mark.result.student: mark for mark in marks}
    column = f"{title} (graded without a jail)" if without_jail(mark.result for mark in marks) else title
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow([*COLUMNS, _no_formula(column)])
    for student in students:
        if student.id in by_student:
            total = by_student[student.id].total
            sis_id = student.sis_id or ("" if student.canvas_id or student.login else student.id)
            told = (student.name, student.canvas_id, sis_id, student.login, student.section)
            writer.writerow([*map(_no_formula, told), "" if total is None else number(total)])
    return file.getvalue()


def _no_formula(text):
    return _FORMULA.sub(r"\1'", visible(text))
