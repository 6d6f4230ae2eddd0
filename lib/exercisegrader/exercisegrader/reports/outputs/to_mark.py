"""A page of all that waits for a person: the answers to one question below each other, for the whole class."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from exercisebook.judging import earned
from exercisegrader.reports import statement
from exercisegrader.reports.document import (
    Block,
    Caution,
    Code,
    Details,
    Document,
    Heading,
    Listing,
    Paragraph,
    Quiet,
    Said,
    Sentence,
    person,
)
from exercisegrader.reports.outputs.feedback import whole
from exercisegrader.reports.publishing import published
from exercisegrader.reports.wording import NO_JAIL, counted, in_text, of_points, without_jail

if TYPE_CHECKING:
    from exercisegrader.marking import Marked
    from exercisegrader.results import JudgedAnswer, JudgedExercise
    from exercisegrader.roster import Student

_HOW = (
    *(
        "Each answer has a row in ",
        Code("marks.csv"),
        ", which a spreadsheet opens: fill in the points, and a comment ",
    ),
    "for the student where there is one to make. Then grade again; what has points is no longer here.",
)


@published("to_mark", "what waits for a person, the answers to each question below each other")
def to_mark(title: str, students: Sequence[Student], marks: Sequence[Marked]) -> Document:
    """Return the page for whoever marks.

    Arguments:
        title: of the assignment.
        students: the roster.
        marks: a `Marked` for each submission.
    """
    names = {student.id: student.name for student in students}
    questions: dict[tuple[str, str], list[tuple[str, JudgedExercise, JudgedAnswer]]] = {}
    for exercise, answer, student in _waiting(marks):
        questions.setdefault((exercise.number, answer.name), []).append((student, exercise, answer))
    count = counted(sum(map(len, questions.values())), "answer")
    blocks: list[Block] = [Caution(NO_JAIL)] if without_jail(mark.result for mark in marks) else []
    blocks.append(Paragraph(f"{count} to {counted(len(questions), 'question')}."))
    if questions:
        blocks.append(Paragraph(_HOW))
    for (of, name), given in sorted(questions.items(), key=lambda item: _place(marks, *item[0])):
        blocks += _question(of, name, given, names)
    name = f"{in_text(title)}: to be marked"
    return Document((Sentence(title), ": to be marked"), name, tuple(blocks))


def _waiting(marks) -> Iterator[tuple[JudgedExercise, JudgedAnswer, str]]:
    for mark in marks:
        waiting = {*mark.waiting}
        for one in mark.exercises:
            for answer in one.judged.answers:
                if (one.judged.number, answer.name) in waiting:
                    yield one.judged, answer, mark.result.student


def _place(marks, number, name):
    """The place of a quantity among those of the assignment."""
    asked = [(one.judged.number, answer.name) for one in marks[0].exercises for answer in one.judged.answers]
    return asked.index((number, name)) if (number, name) in asked else len(asked)


def _question(of, name, given, names) -> Iterator[Block]:
    """The answers to one question."""
    first, exercise, answer = given[0]
    weights = sum(one.weight for one in exercise.answers)
    most = earned(exercise.points, answer.weight, weights)
    yield Heading((f"Exercise {of} · ", Sentence(exercise.title), " · ", Code(name)))
    yield Paragraph(f"{counted(len(given), 'answer')}, each worth at most {of_points(most, exercise.points)}.")
    if answer.key:
        yield Paragraph(("To look for: ", Said(answer.key)))
    yield Details(f"The question, with the numbers of {first}", tuple(statement.blocks(exercise.statement)))
    for student, judged, one in given:
        yield Heading(person(names.get(student, student), student), level=3)
        numbers = [part for name, value in judged.given for part in (", ", Code(name), f" = {value}")]
        remark = one.says.partition(" · ")[2]
        about = [*numbers[1:], *([", " if numbers else "", remark] if remark else [])]
        if about:
            yield Paragraph(Quiet(tuple(about)))
        yield Paragraph(whole(one.answer, one.name))
        yield Listing((("row of ", Code("marks.csv"), ": ", Code(f"{student},{judged.number},{one.name},,")),))
