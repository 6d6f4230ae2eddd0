"""The result of a submission: what the reports are written from, and what a resumed run does not grade again.

Each is a file of its own, which is there whole or not at all. It carries a fingerprint of all that it depends on.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from loopbook.exercises.judging import harmless
from loopbook.grading import GradingError
from loopbook.grading.files import write

if TYPE_CHECKING:
    from pathlib import Path

    from loopbook.grading.assignment import Assignment
    from loopbook.grading.events import Outcome
    from loopbook.grading.jail import Limits

#: An address of memory, in an error's text, differs from run to run.
ADDRESS = re.compile(r"\b0x[0-9a-fA-F]{6,}\b")


def fingerprint(assignment: Assignment, content: bytes, label: str, problem: str, jailed: bool, limits: Limits) -> str:
    """Return a text that differs where a result might: by the assignment, the submission, the jail, or its limits."""
    amounts = {name: float(amount) for name, amount in asdict(limits).items()}  # 60 s are 60.0 s
    parts = [assignment.fingerprint, hashlib.sha256(content).hexdigest(), label, problem, jailed, amounts]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def result(
    assignment: str,
    student: str,
    label: str,
    mark: str,
    jailed: bool,
    outcome: Outcome,
    exercises: Sequence[Mapping[str, Any]],
) -> dict[str, Any]:
    """Return the result of a submission, as JSON data.

    Arguments:
        assignment: its name.
        student: id.
        label: name of the file; empty where there is none.
        mark: the fingerprint.
        outcome: `events.Outcome`.
        exercises: as `judge.Judge.judge` returns them.
    """
    status = "missing" if not label else "not run" if outcome.refused else "stopped" if outcome.stopped else "complete"
    return {
        "assignment": assignment,
        "student": student,
        "file": label,
        "jailed": jailed,
        "fingerprint": mark,
        "status": status,
        "says": _same_each_time(outcome.refused or outcome.stopped),
        "errors": [{"cell": cell, "says": _same_each_time(says)} for cell, says in outcome.errors],
        "looks": looks(student, outcome, exercises),
        "exercises": exercises,
        "points": sum(one["points"] for one in exercises),
        "earned": sum(one["earned"] for one in exercises),
    }


def looks(student: str, outcome: Outcome, exercises: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return why an instructor should look at a submission, in sentences."""
    found = []
    others = [name for name in outcome.named if name != student]
    if others:
        found.append(f"it names another student: {', '.join(map(harmless, others[:3]))}")
    if outcome.odd:
        found.append(f"it told {outcome.odd} lines that are not answers")
    asked = {one["number"]: {verdict["name"] for verdict in one["verdicts"]} for one in exercises}
    for number, given in outcome.answers.items():
        if number not in asked:
            found.append(f"it answers {harmless(repr(number))}, which is not an exercise of this assignment")
        elif extra := [name for name in given if name not in asked[number]]:
            found.append(f"in exercise {number} it answers {harmless(repr(extra[0]))}, which is not asked")
    return sorted(found)[:20]


def _same_each_time(says):
    return ADDRESS.sub("0x...", says)


class Results:
    """The results in a folder, a file a student."""

    def __init__(self, folder: Path):
        self.folder = folder

    def _path(self, student):
        return self.folder / f"{student}.json"

    def of(self, student: str) -> dict[str, Any] | None:
        """Return the result of a student; None where there is none that is whole."""
        try:
            stored = json.loads(self._path(student).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as problem:
            raise GradingError(f"{self._path(student)} cannot be read ({problem}): remove it") from None
        return stored

    def demand_of(self, assignment: str, students: Iterable[str]) -> None:
        """Raise GradingError where a student's result is that of another assignment, which would be lost."""
        for student in students:
            other = (self.of(student) or {}).get("assignment", assignment)
            if other != assignment:
                raise GradingError(
                    f"{self.folder} holds results of the assignment {other!r}: expected a folder of its own for "
                    f"{assignment!r}"
                )

    def keep(self, found: Mapping[str, Any]) -> None:
        """Store a result."""
        write(self._path(found["student"]), json.dumps(found, indent=1, sort_keys=True) + "\n")
