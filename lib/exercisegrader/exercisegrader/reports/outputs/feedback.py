"""A page for each student: the points, what became of each answer, and all that a complaint has to name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisegrader.reports.outputs import output
from exercisegrader.reports.pages import page
from exercisegrader.reports.wording import (
    answer_in_words,
    hints,
    in_text,
    number,
    of_points,
    remarks,
    verdict_and_reading,
)
from exercisegrader.results import MISSING, NOT_RUN, OWNER

if TYPE_CHECKING:
    from exercisegrader.marking import Marked
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.student import Student


@output("feedback/{student}/feedback.html", "the page of a student")
def feedback(grades: Grades, student: Student, mark: Marked) -> str:
    """Return a student's page."""
    result, is_run = mark.result, mark.result.status not in (MISSING, NOT_RUN)
    return page(
        "feedback.html",
        f"{in_text(grades.title)} · {student.name}",
        grades=grades,
        student=student,
        mark=mark,
        sum=_sum(mark, is_run),
        waits=is_run and mark.total is None,
        is_run=is_run,
        answer_in_words=answer_in_words,
        verdict_and_reading=verdict_and_reading,
        is_anothers=result.owner not in ("", student.id),
        doubts="; ".join(look.says for look in result.looks if look.kind == OWNER),
        notes=[*remarks(result), *hints(result)],
        exercises=[one for one in mark.exercises if is_run or one.comments or one.history],
    )


def _sum(mark, is_run):
    """The points, or what is known of them."""
    points = mark.result.points
    if mark.total is not None:
        return of_points(mark.total, points)
    if not is_run:
        return f"no points yet, of {number(points)}"
    return f"{of_points(mark.known, points)} so far"
