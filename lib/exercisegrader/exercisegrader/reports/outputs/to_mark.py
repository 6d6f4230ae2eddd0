"""A page for whoever marks a section: the answers to one question below each other, and not whose they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisegrader.overrides import TO_MARK
from exercisegrader.reports.outputs import PART, output
from exercisegrader.reports.pages import page
from exercisegrader.reports.wording import in_text
from exercisegrader.student import parts

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.results import JudgedAnswer, JudgedExercise


@output(f"{TO_MARK}/{PART}.html", "what waits for a person, a page for each section, without names")
def to_mark(grades: Grades, part: str) -> str:
    """Return the page for whoever marks a section."""
    # whether somebody's answer waits or not, its question has the place that it has in the assignment
    questions: dict[tuple[str, str], list[tuple[str, JudgedExercise, JudgedAnswer]]] = {}
    part_of = parts(grades.students)
    for mark in sorted(grades.marks, key=lambda mark: mark.code):  # the order of the roster would tell whose it is
        waiting = set(mark.waiting) if part_of[mark.result.student] == part else ()
        for exercise in mark.result.exercises:
            for answer in exercise.answers:
                given = questions.setdefault((exercise.number, answer.name), [])
                if (exercise.number, answer.name) in waiting:
                    given.append((mark.code, exercise, answer))
    return page(
        "to_mark.html",
        f"{in_text(grades.title)}: to be marked, {part}",
        grades=grades,
        part=part,
        questions=[given for given in questions.values() if given],
        count=sum(map(len, questions.values())),
    )
