"""A page for each student: the points, what became of each answer, and all that a complaint has to name."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from exercisebook import png
from exercisebook.judging import WAITING
from exercisegrader.reports import statement
from exercisegrader.reports.document import (
    Block,
    Caution,
    Code,
    Details,
    Document,
    Heading,
    Judged,
    Lines,
    Link,
    Listing,
    Paragraph,
    Picture,
    Quiet,
    Said,
    Sentence,
    Strong,
    Text,
    Verdicts,
    person,
)
from exercisegrader.reports.publishing import published
from exercisegrader.reports.wording import (
    NO_JAIL,
    answer_in_words,
    hints,
    in_text,
    number,
    of_points,
    remarks,
    verdict_and_reading,
    visible,
)
from exercisegrader.results import MISSING, NOT_RUN, OWNER

if TYPE_CHECKING:
    from exercisegrader.marking import Marked, MarkedExercise
    from exercisegrader.results import JudgedAnswer
    from exercisegrader.roster import Student
    from exercisegrader.student_side.plain import Plain

_COMPLAIN = (
    "Say which exercise and which quantity you mean, what you think is right, and why; show this page. It has the "
    "question with your numbers, your answer as it was read, and the file that was graded."
)
_COMPLAIN_OF_NOTHING = "Show this page: it names the file that was handed in, and what kept it from being graded."


@published("feedback/{student}/feedback", "the page of a student")
def feedback(
    title: str, student: Student, mark: Marked, reveal: bool = False, notebooks: Collection[str] = ()
) -> Document:
    """Return a student's page.

    Arguments:
        title: of the assignment.
        student: whose page it is.
        mark: of the submission.
        reveal: whether the keys are shown.
        notebooks: the ids of the students whose notebook was kept as it ran.
    """
    blocks = [Paragraph(person(student.name, student.id)), *_sums(mark), *_notebook(mark, student)]
    is_judged = mark.result.status not in (MISSING, NOT_RUN)
    for exercise in mark.exercises:
        if is_judged or exercise.comments or exercise.history:
            blocks += _exercise(exercise, reveal)
    if mark.result.status != MISSING:
        blocks += [Heading("If you disagree"), Paragraph(_COMPLAIN if is_judged else _COMPLAIN_OF_NOTHING)]
    if student.id in notebooks:
        link = Link("notebook as it ran", f"../../notebooks/{student.id}.html")
        blocks.append(Paragraph(("Your instructor has kept the ", link, ".")))
    return Document(Sentence(title), f"{in_text(title)} · {visible(student.name)}", tuple(blocks))


def _sums(mark: Marked) -> list[Block]:
    """The points, and what was taken off or is to come."""
    result, total = mark.result, mark.total
    known = sum(one.earned for one in mark.exercises if one.earned is not None) - mark.deduction
    if total is not None:
        blocks: list[Block] = [Paragraph(Strong(of_points(total, result.points)))]
    elif result.status in (MISSING, NOT_RUN):
        blocks = [Paragraph(Strong(f"no points yet, of {number(result.points)}"))]
    else:
        blocks = [
            Paragraph(
                (
                    Strong(f"{of_points(max(0.0, known), result.points)} so far"),
                    ": part of it waits for a mark by hand.",
                )
            )
        ]
    if mark.late:
        cost = f" ({number(mark.deduction)} points)" if mark.deduction else ""
        blocks.append(Paragraph((Said(f"{mark.late[0].upper()}{mark.late[1:]}"), f"{cost}.")))
    if mark.comments:
        blocks += [Heading("From your instructor"), Listing(tuple(map(Said, mark.comments)))]
    return blocks


def _notebook(mark: Marked, student: Student) -> list[Block]:
    """The file that was graded, and what became of it besides its answers."""
    result = mark.result
    blocks: list[Block] = [] if result.jailed else [Caution(NO_JAIL)]
    if result.owner and result.owner != student.id:
        owner, own = Code(result.owner), Code(student.id)
        blocks.append(
            Caution(
                (
                    "This is somebody else's notebook: it was made for ",
                    owner,
                    ", and graded with the numbers of ",
                    own,
                    ".",
                )
            )
        )
    elif doubts := [look.says for look in result.looks if look.kind == OWNER]:
        own = Code(student.id)
        blocks.append(
            Caution(("Of this notebook: ", Said("; ".join(doubts)), ". It was graded with the numbers of ", own, "."))
        )
    notes = [*remarks(result), *hints(result)]
    if not (notes or result.file):
        return blocks
    blocks.append(Heading("The notebook"))
    if result.file:
        done = "handed in" if result.status == NOT_RUN else "graded"
        blocks.append(Paragraph((f"The file that was {done}: ", Code(result.file))))
        if result.chosen:
            blocks.append(Paragraph(Said(f"It {result.chosen}.")))
    return [*blocks, Listing(tuple(map(Said, notes)))] if notes else blocks


def _exercise(marked: MarkedExercise, reveal: bool) -> list[Block]:
    judged = marked.judged
    earned = "waits for a mark" if marked.earned is None else of_points(marked.earned, judged.points)
    heading = (f"Exercise {judged.number} · ", Sentence(judged.title), " ", Quiet(f"({earned})"))
    lines = tuple(_line(one, one.name in marked.waiting, reveal) for one in judged.answers)
    blocks: list[Block] = [Heading(heading), Verdicts(lines)]
    if said := (*marked.comments, *marked.history):
        blocks += [Paragraph("From your instructor:"), Listing(tuple(map(Said, said)))]
    if question := _question(judged):
        blocks.append(Details("The question, with your numbers", question))
    return blocks


def _question(judged):
    """The statement and the numbers."""
    blocks = statement.blocks(judged.statement)
    if judged.given:
        given = [part for name, value in judged.given for part in (", ", Code(name), f" = {value}")]
        blocks = (*blocks, Paragraph(("Your numbers: ", *given[1:], ".")))
    return blocks


def _line(judged: JudgedAnswer, waits: bool, reveal: bool) -> Judged:
    says, reading = verdict_and_reading(judged)
    answer, below = answer_in_words(judged.answer), []
    if judged.status == WAITING:
        below.append(("Your answer: ", whole(judged.answer, judged.name)))
        says = says if waits else ""
    elif answer:
        reading = "" if reading == f"read as {answer}" else reading
        below.append(("Your answer: ", Code(answer), ", " if reading else "", Said(reading)))
        reading = ""
    if reading:
        below.append(Said(reading))
    if reveal and judged.key:
        below.append(("Key: ", Code(judged.key)))
    word = "marked by hand" if judged.status == WAITING and not waits else ""
    return Judged(judged.status, judged.name, Sentence(says) if says else "", tuple(below), word)


def whole(answer: Plain, name: str) -> Text:
    """Return what a person marks, as it was handed in: a figure, or a text with its lines."""
    if png.is_data(answer):
        return Picture(png.checked(answer), f"the figure that was handed in for {name}")
    return Lines(tuple(Said(line) for line in str(answer).splitlines() if line.strip()))
