"""The result of a submission in the format of Gradescope's autograders."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

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


@output("feedback/{student}/results.json", "the result of a student, as Gradescope takes it from an autograder")
def results_json(result: Mapping[str, Any], reveal: bool = False) -> str:
    """Return a submission's `results.json`: the sum, and a test for each exercise.

    The format is https://gradescope-autograders.readthedocs.io/en/latest/specs/. All formats are said to be text,
    because Gradescope's default for the output above the tests is HTML. The sum is given beside the tests, which are
    rounded; Gradescope then takes the sum. With keys, everything is shown only once grades are published: a student
    may hand in again before that.

    Arguments:
        result: of a submission, as data.
        reveal: whether the keys are in it.

    >>> verdict = {"name": "K", "status": "right", "says": "right", "answer": 2, "key": "2 s"}
    >>> exercise = {"number": "1", "title": "Gain", "points": 4, "earned": 4, "verdicts": [verdict]}
    >>> result = {"student": "s1", "jailed": True, "status": "complete", "says": "", "errors": [], "points": 4}
    >>> json.loads(results_json(result | {"earned": 4, "exercises": [exercise]}))["tests"][0]["output"]
    '✓ K: right. Answer: 2'
    """
    visibility = "after_published" if reveal else "visible"
    lines = [NO_JAIL] if without_jail([result]) else []
    lines += [of_points(result["earned"], result["points"]), *remarks(result)]
    data = {
        "score": round(result["earned"], 2),
        "output": "\n".join(lines),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": visibility,
        "tests": [_test(exercise, visibility, reveal) for exercise in result["exercises"]],
    }
    return json.dumps(data, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _test(exercise, visibility, reveal):
    verdicts = exercise["verdicts"]
    return {
        "number": exercise["number"],
        "name": in_text(exercise["title"]),
        "score": round(exercise["earned"], 2),
        "max_score": round(exercise["points"], 2),
        "status": "passed" if all(verdict["status"] == RIGHT for verdict in verdicts) else "failed",
        "output": "\n".join(_line(verdict, reveal) for verdict in verdicts),
        "output_format": "text",
        "visibility": visibility,
    }


def _line(verdict, reveal):
    status, says, answer = verdict["status"], explained(verdict), answer_in_words(verdict["answer"])
    line = f"{MARKS[status][0]} {verdict['name']}: {status}"
    line += f", {in_text(says)}" if says else ""
    line = line if line.endswith((".", "?", "!")) else line + "."
    line += f" Answer: {answer}" if answer else ""
    return line + (f" Key: {visible(verdict['key'])}" if reveal else "")
