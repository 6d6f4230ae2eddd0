"""A page of all that waits for a person: the answers to one question below each other, for the whole class."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisegrader.reports.outputs import output
from exercisegrader.reports.pages import page
from exercisegrader.reports.wording import in_text

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.results import JudgedAnswer, JudgedExercise


@output("to_mark.html", "what waits for a person, the answers to each question below each other")
def to_mark(grades: Grades) -> str:
    """Return the page for whoever marks."""
    # whether somebody's answer waits or not, its question has the place that it has in the assignment
    questions: dict[tuple[str, str], list[tuple[str, JudgedExercise, JudgedAnswer]]] = {}
    for mark in grades.marks:
        waiting = set(mark.waiting)
        for exercise in mark.result.exercises:
            for answer in exercise.answers:
                given = questions.setdefault((exercise.number, answer.name), [])
                if (exercise.number, answer.name) in waiting:
                    given.append((mark.result.student, exercise, answer))
    return page(
        "to_mark.html",
        f"{in_text(grades.title)}: to be marked",
        grades=grades,
        names={student.id: student.name for student in grades.students},
        questions=[given for given in questions.values() if given],
        count=sum(map(len, questions.values())),
    )
