"""A page for each student: the points, what became of each answer, and what failed in the notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loopbook.exercises.response import MARKS
from loopbook.grading.reports import page
from loopbook.grading.reports.outputs import output
from loopbook.grading.reports.wording import (
    NO_JAIL,
    answer_in_words,
    code_in_markdown,
    explained,
    in_markdown,
    in_text,
    of_points,
    remarks,
    sentence_in_markdown,
    visible,
    without_jail,
)

if TYPE_CHECKING:
    from loopbook.grading.marking import Marked
    from loopbook.grading.roster import Student


@output("feedback/{student}/feedback.html", "the page of a student")
def feedback_html(title: str, student: Student, mark: Marked, reveal: bool = False) -> str:
    """Return a student's page as HTML that needs nothing but itself.

    Arguments:
        title: of the assignment.
        student: whose page it is.
        mark: of the submission.
        reveal: whether the keys are shown.
    """
    result = mark.result
    body = [f"<h1>{page.sentence(title)}</h1>"]
    body.append(f'<p>{page.of_student(student.name)} <span class="quiet">{page.escaped(student.id)}</span></p>')
    body.append(f"<p><strong>{of_points(mark.total or 0, result.points)}</strong></p>")
    if without_jail([result]):
        body.append(f'<p class="warning">{NO_JAIL}</p>')
    if notes := remarks(result):
        body.append("<h2>The notebook</h2>")
        body += ["<ul>", *(f"<li>{page.of_student(note)}</li>" for note in notes), "</ul>"]
    for exercise in result.exercises:
        earned = of_points(exercise.earned, exercise.points)
        heading = f"Exercise {page.escaped(exercise.number)} · {page.sentence(exercise.title)}"
        body.append(f'<h2>{heading} <span class="quiet">({earned})</span></h2>')
        body += page.listed((verdict.status, _line(verdict, reveal)) for verdict in exercise.answers)
    return page.page(f"{in_text(title)} · {visible(student.name)}", body)


def _line(verdict, reveal):
    """A verdict as HTML."""
    line = page.marked(verdict.status, f"<code>{page.escaped(verdict.name)}</code> ")
    if says := explained(verdict):
        line += f": {page.sentence(says)}"
    if answer := answer_in_words(verdict.answer):
        line += f'<div class="answer">Your answer: <code>{page.of_student(answer)}</code></div>'
    if reveal:
        line += f'<div class="answer">Key: <code>{page.escaped(verdict.key)}</code></div>'
    return line


@output("feedback/{student}/feedback.md", "the same as Markdown")
def feedback_markdown(title: str, student: Student, mark: Marked, reveal: bool = False) -> str:
    """Return a student's page as Markdown.

    Arguments:
        title: of the assignment.
        student: whose page it is.
        mark: of the submission.
        reveal: whether the keys are shown.
    """
    result = mark.result
    lines = [f"# {sentence_in_markdown(title)}", ""]
    lines += [f"{in_markdown(student.name)} ({in_markdown(student.id)})", ""]
    lines += [f"**{of_points(mark.total or 0, result.points)}**", ""]
    if without_jail([result]):
        lines += [f"**{NO_JAIL}**", ""]
    if notes := remarks(result):
        lines += ["## The notebook", "", *(f"- {in_markdown(note)}" for note in notes), ""]
    for exercise in result.exercises:
        heading = f"Exercise {in_markdown(exercise.number)} · {sentence_in_markdown(exercise.title)}"
        lines += [f"## {heading} ({of_points(exercise.earned, exercise.points)})", ""]
        for verdict in exercise.answers:
            status, says = verdict.status, explained(verdict)
            line = f"- {MARKS[status][0]} {code_in_markdown(verdict.name)} **{status}**"
            lines.append(line + (f": {sentence_in_markdown(says)}" if says else ""))
            if answer := answer_in_words(verdict.answer):
                lines.append(f"  - your answer: {code_in_markdown(answer)}")
            if reveal:
                lines.append(f"  - key: {code_in_markdown(verdict.key)}")
        lines.append("")
    return "\n".join(lines)
