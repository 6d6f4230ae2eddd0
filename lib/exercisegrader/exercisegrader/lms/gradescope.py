"""Gradescope: its roster, and results in the format of its autograders.

The roster ("Download Roster") has First Name, Last Name, SID, Email and Role; the grades have the first four, Sections,
and Submission Time, which is that of the course's zone, as is the due date. Its downloads of submissions do not say in
their names whose they are; its autograders are run for one submission, see examples/autograder. It cannot give each
student a file of their own.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from exercisebook.judging import RIGHT
from exercisegrader import lms
from exercisegrader.lms import Claim, Known, System
from exercisegrader.reports.lines import of_exercise, overall
from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import in_text
from exercisegrader.tables import places

if TYPE_CHECKING:
    from exercisegrader.marking import Marked
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.student import Student

_HEADS = {
    "firstname": "first", "lastname": "last", "sid": "sis_id", "email": "email", "role": "role", "section": "section",
    "sections": "section", "submissiontime": "handed_in",
}  # fmt: skip


@lms.system
class Gradescope(System):
    """Gradescope."""

    name, title = "gradescope", "Gradescope"
    roster = "an export of Gradescope's roster or grades"
    ids = {"sis_id": "SID", "email": "Email"}  # noqa: RUF012 - read and never changed

    def columns(self, header: Sequence[str]) -> Mapping[str, int] | None:
        """Return where the fields are."""
        found = places(header, _HEADS)
        return found if {"first", "last", "sis_id", "email"} <= found.keys() else None

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says; None for instructors and assistants."""
        if cells.get("role", "Student").casefold() not in ("student", ""):
            return None
        return {**cells, "handed_in": re.sub(r" *(?:[+-][0-9]{4}|UTC)$", "", cells.get("handed_in", ""))}

    def claim(self, name: str, known: Known) -> Claim | None:
        """Return that nobody can tell."""
        if not re.fullmatch(r"submission_[0-9]+(?:\..*)?", name):
            return None
        return Claim(reason="is from a download of Gradescope, which does not say whose it is")


@output("feedback/{student}/results.json", "the result of a student, as Gradescope takes it from an autograder")
def results_json(grades: Grades, student: Student, mark: Marked) -> str:
    """Return a submission's `results.json`: the sum, and a test for each exercise.

    The format is https://gradescope-autograders.readthedocs.io/en/latest/specs/. All formats are said to be text,
    because Gradescope's default for the output above the tests is HTML. The sum is given beside the tests, which are
    rounded; Gradescope then takes the sum. With keys, everything is shown only once grades are published: a student
    may hand in again before that.

    >>> from exercisegrader.marking import Marked
    >>> from exercisegrader.reports.outputs import Grades
    >>> from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
    >>> exercise = JudgedExercise("1", "Gain", 4, "", (), (JudgedAnswer("K", "right", "right", 2, "2 s"),))
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), (exercise,))
    >>> json.loads(results_json(Grades("Tuning", (), ()), None, Marked.of(result)))["tests"][0]["output"]
    '✓ K: right. Answer: 2'
    """
    visibility = "after_published" if grades.reveal else "visible"
    data = {
        "score": round(mark.known, 2),
        "output": "\n".join(overall(mark)),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": visibility,
        "tests": [_test(exercise, visibility, grades.reveal) for exercise in mark.exercises],
    }
    return json.dumps(data, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _test(marked, visibility, reveal):
    exercise = marked.judged
    return {
        "number": exercise.number,
        "name": in_text(exercise.title),
        "score": round(marked.known, 2),
        "max_score": round(exercise.points, 2),
        "status": "passed" if all(one.status == RIGHT for one in exercise.answers) else "failed",
        "output": "\n".join(of_exercise(marked, reveal)),
        "output_format": "text",
        "visibility": visibility,
    }
