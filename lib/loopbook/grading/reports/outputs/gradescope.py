"""The result of a submission in the format of Gradescope's autograders."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from loopbook.exercises.judging import RIGHT
from loopbook.exercises.response import MARKS
from loopbook.grading.reports.outputs import output
from loopbook.grading.reports.wording import (
    NO_JAIL,
    answer_in_words,
    explained,
    in_text,
    of_points,
    remarks,
    visible,
    without_jail,
)

if TYPE_CHECKING:
    from loopbook.grading.marking import Marked


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

    >>> from loopbook.grading.marking import Marked
    >>> from loopbook.grading.results import JudgedAnswer, JudgedExercise, Result
    >>> exercise = JudgedExercise("1", "Gain", 4, "", (), (JudgedAnswer("K", "right", "right", 2, "2 s"),))
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), (exercise,))
    >>> json.loads(results_json(Marked.of(result)))["tests"][0]["output"]
    '✓ K: right. Answer: 2'
    """
    result, total = mark.result, mark.total or 0
    visibility = "after_published" if reveal else "visible"
    lines = [NO_JAIL] if without_jail([result]) else []
    lines += [of_points(total, result.points), *remarks(result)]
    data = {
        "score": round(total, 2),
        "output": "\n".join(lines),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": visibility,
        "tests": [_test(exercise, visibility, reveal) for exercise in result.exercises],
    }
    return json.dumps(data, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _test(exercise, visibility, reveal):
    verdicts = exercise.answers
    return {
        "number": exercise.number,
        "name": in_text(exercise.title),
        "score": round(exercise.earned, 2),
        "max_score": round(exercise.points, 2),
        "status": "passed" if all(verdict.status == RIGHT for verdict in verdicts) else "failed",
        "output": "\n".join(_line(verdict, reveal) for verdict in verdicts),
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
