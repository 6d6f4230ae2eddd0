"""A page for each student: the points, what became of each answer, and all that a complaint has to name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisebook.judging import WAITING
from exercisegrader.reports.outputs import output
from exercisegrader.reports.pages import code, handed_in, line, page, said, sentence
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
    from markupsafe import Markup

    from exercisegrader.marking import Marked
    from exercisegrader.reports.outputs import Grades
    from exercisegrader.results import JudgedAnswer
    from exercisegrader.student import Student


@output("feedback/{student}/feedback.html", "the page of a student")
def feedback(grades: Grades, student: Student, mark: Marked) -> str:
    """Return a student's page."""
    result, is_run = mark.result, mark.result.status not in (MISSING, NOT_RUN)
    told = [one for one in mark.exercises if is_run or one.comments or one.history]
    return page(
        "feedback.html",
        f"{in_text(grades.title)} · {student.name}",
        grades=grades,
        student=student,
        mark=mark,
        sum=_sum(mark, is_run),
        waits=is_run and mark.total is None,
        is_run=is_run,
        is_anothers=result.owner not in ("", student.id),
        doubts="; ".join(look.says for look in result.looks if look.kind == OWNER),
        notes=[*remarks(result), *hints(result)],
        exercises=[
            (one, [_verdict(a, a.name in one.waiting, grades.reveal) for a in one.judged.answers]) for one in told
        ],
    )


def _sum(mark, is_run):
    """The points, or what is known of them."""
    points = mark.result.points
    if mark.total is not None:
        return of_points(mark.total, points)
    if not is_run:
        return f"no points yet, of {number(points)}"
    return f"{of_points(mark.known, points)} so far"


@dataclass(frozen=True)
class _Verdict:
    """What became of an answer: its status, a word where that of the status does not hold any more, why, and more."""

    status: str
    word: str
    name: str
    says: Markup | str
    below: list[Markup]


def _verdict(judged: JudgedAnswer, waits: bool, reveal: bool) -> _Verdict:
    says, reading = verdict_and_reading(judged)
    answer, below = answer_in_words(judged.answer), []
    if judged.status == WAITING:
        below.append(line("Your answer: ", handed_in(judged.answer, judged.name)))
        says = says if waits else ""
    elif answer:
        reading = "" if reading == f"read as {answer}" else reading
        shown = line("Your answer: ", code(answer))
        below.append(line(shown, ", ", said(reading)) if reading else shown)
        reading = ""
    if reading:
        below.append(said(reading))
    if reveal and judged.key:
        below.append(line("Key: ", code(judged.key)))
    word = "marked by hand" if judged.status == WAITING and not waits else ""
    return _Verdict(judged.status, word, judged.name, sentence(says), below)
