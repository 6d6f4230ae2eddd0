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
from exercisebook.response import MARKS
from exercisegrader import lms
from exercisegrader.lms import Claim, Known, System
from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import (
    NO_JAIL,
    answer_in_words,
    explained,
    hints,
    in_text,
    of_points,
    remarks,
    visible,
    without_jail,
)
from exercisegrader.tables import letters

if TYPE_CHECKING:
    from exercisegrader.marking import Marked

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
        """Return where the fields are, the first column of a head for each."""
        found: dict[str, int] = {}
        for index, head in enumerate(header):
            if field := _HEADS.get(letters(head)):
                found.setdefault(field, index)
        return found if {"first", "last", "sis_id", "email"} <= found.keys() else None

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says; None for instructors and assistants."""
        if cells.get("role", "Student").casefold() not in ("student", ""):
            return None
        first, last = cells["first"], cells["last"]
        sortable = ", ".join(filter(None, (last, first)))
        time = re.sub(r" *(?:[+-][0-9]{4}|UTC)$", "", cells.get("handed_in", ""))
        return {**cells, "name": " ".join(filter(None, (first, last))), "sortable": sortable, "handed_in": time}

    def claim(self, name: str, known: Known, assignment: str) -> Claim | None:
        """Return that nobody can tell."""
        if not re.fullmatch(r"submission_[0-9]+(?:\..*)?", name):
            return None
        return Claim(reason="is from a download of Gradescope, which does not say whose it is")


@output("feedback/{student}/results.json", "the result of a student, as Gradescope takes it from an autograder")
def results_json(mark: Marked, reveal: bool = False) -> str:
    """Return a submission's `results.json`: the sum, and a test for each exercise.

    The format is https://gradescope-autograders.readthedocs.io/en/latest/specs/. All formats are said to be text,
    because Gradescope's default for the output above the tests is HTML. The sum is given beside the tests, which are
    rounded; Gradescope then takes the sum. With keys, everything is shown only once grades are published: a student
    may hand in again before that.

    Arguments:
        mark: of a submission.
        reveal: whether the keys are in it.

    >>> from exercisegrader.marking import Marked
    >>> from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
    >>> exercise = JudgedExercise("1", "Gain", 4, "", (), (JudgedAnswer("K", "right", "right", 2, "2 s"),))
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), (exercise,))
    >>> json.loads(results_json(Marked.of(result)))["tests"][0]["output"]
    '✓ K: right. Answer: 2'
    """
    result, total = mark.result, mark.total
    if total is None:  # while something waits for a person, the rest counts already
        total = max(0.0, sum(one.earned or 0 for one in mark.exercises) - mark.deduction) if mark.waiting else 0.0
    visibility = "after_published" if reveal else "visible"
    lines = [NO_JAIL] if without_jail([result]) else []
    lines += [
        of_points(total, result.points),
        *remarks(result),
        *hints(result),
        *filter(None, [mark.late]),
        *map(visible, mark.comments),
    ]
    if mark.waiting:
        where = dict.fromkeys(number for number, _ in mark.waiting)
        lines.append(f"Waiting for a mark by hand: exercise {', '.join(where)}.")
    data = {
        "score": round(total, 2),
        "output": "\n".join(lines),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": visibility,
        "tests": [_test(exercise, visibility, reveal) for exercise in mark.exercises],
    }
    return json.dumps(data, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _test(marked, visibility, reveal):
    exercise, verdicts = marked.judged, marked.judged.answers
    by_hand = map(visible, [*marked.history, *marked.comments])
    return {
        "number": exercise.number,
        "name": in_text(exercise.title),
        "score": round(marked.earned or 0, 2),
        "max_score": round(exercise.points, 2),
        "status": "passed" if all(verdict.status == RIGHT for verdict in verdicts) else "failed",
        "output": "\n".join([*(_line(verdict, reveal) for verdict in verdicts), *by_hand]),
        "output_format": "text",
        "visibility": visibility,
    }


def _line(verdict, reveal):
    status, says, answer = verdict.status, explained(verdict), answer_in_words(verdict.answer)
    line = f"{MARKS[status][0]} {verdict.name}: {status}"
    line += f", {in_text(says)}" if says else ""
    line = line if line.endswith((".", "?", "!")) else line + "."
    line += f" Answer: {answer}" if answer else ""
    return line + (f" Key: {visible(verdict.key)}" if reveal else "")
