"""The summary for the instructor, as HTML and as Markdown."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from loopbook.grading.reports import page
from loopbook.grading.reports.findings import Findings
from loopbook.grading.reports.histogram import histogram_svg, histogram_text, histogram_words
from loopbook.grading.reports.outputs import output
from loopbook.grading.reports.wording import (
    NO_JAIL,
    STATUSES,
    code_in_markdown,
    counted,
    in_markdown,
    in_text,
    number,
    percent,
    sentence_in_markdown,
)

if TYPE_CHECKING:
    from loopbook.grading.marking import Marked
    from loopbook.grading.roster import Student

_EQUAL = "The numbers of these students differ, so that their answers should. That is a reason to look, and no proof."
_LEFT_ALONE = "Files that were left alone"
_UNJUDGED = "Not judged"
_WHY_UNJUDGED = "These answers earn nothing, because they could not be judged. You may see what was meant."
#: So many of the answers that were not judged are told.
MOST_UNJUDGED = 100
_NONE = "Nothing."


@output("summary.html", "the summary for the instructor")
def summary_html(
    title: str, students: Sequence[Student], marks: Collection[Marked], complaints: Iterable[object] = ()
) -> str:
    """Return the summary as a page that needs nothing but itself.

    Arguments:
        title: of the assignment.
        students: the roster.
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.
    """
    found = Findings(students, marks, complaints)
    body = [f"<h1>{page.sentence(title)}: summary</h1>"]
    if found.no_jail:
        body.append(f'<p class="warning">{NO_JAIL}</p>')
    body += [f"<p>{line}</p>" for line in _overview(found)]
    if found.sums and found.points:
        body += ["<h2>Points</h2>", histogram_svg(found.steps, histogram_words(found.steps))]

    body.append("<h2>To look at</h2>")
    rows = [(_student(found, one), "<br>".join(map(page.of_student, reasons))) for one, reasons in found.looks]
    body += page.table("Submissions to look at", ["student", "why"], rows) if rows else [f"<p>{_NONE}</p>"]
    if found.complaints:
        body += [f"<h2>{_LEFT_ALONE}</h2>", "<ul>"]
        body += [*(f"<li>{page.of_student(complaint)}</li>" for complaint in found.complaints), "</ul>"]
    for heading, ids in _absent(found):
        body += [f"<h2>{heading}</h2>", f"<p>{', '.join(_student(found, one) for one in ids)}</p>"]

    body.append("<h2>Equal answers where the numbers differ</h2>")
    body.append(f"<p>{_EQUAL if found.equal else _NONE}</p>")
    if found.equal:
        rows = [
            (
                page.escaped(one.number),
                f"<code>{page.escaped(one.name)}</code>",
                f"<code>{page.of_student(one.answer)}</code>",
                *(", ".join(_student(found, student) for student in ids) for ids in (one.right, one.others)),
            )
            for one in found.equal
        ]
        body += page.table("Equal answers", ["exercise", "quantity", "answer", "right for", "not right for"], rows)

    if found.exercises:
        rows = [
            (
                f"{page.escaped(one.number)} · {page.sentence(one.title)}",
                percent(one.fraction),
                f"{number(one.mean)} of {number(one.points)}",
            )
            for one in found.exercises
        ]
        body.append("<h2>Exercises, the hardest first</h2>")
        body += page.table("Exercises", ["exercise", "mean", "points"], rows, counts=(1, 2))
        rows = [
            (
                page.escaped(asked.number),
                f"<code>{page.escaped(asked.name)}</code>",
                percent(asked.fraction),
                *(str(asked.counts[status]) for status in STATUSES),
            )
            for one in found.exercises
            for asked in one.asked
        ]
        head = ["exercise", "quantity", "in percent", *map(page.marked, STATUSES)]
        body += ["<h2>Answers</h2>", *page.table("Answers", head, rows, counts=range(2, len(head)))]
    if found.unjudged:
        rows = [
            (
                page.escaped(exercise),
                f"<code>{page.escaped(name)}</code>",
                _student(found, student),
                f"<code>{page.of_student(answer)}</code>" if answer else "",
                page.of_student(says),
            )
            for exercise, name, student, answer, says in found.unjudged[:MOST_UNJUDGED]
        ]
        body += [f"<h2>{_UNJUDGED}</h2>", f"<p>{_WHY_UNJUDGED}{_more(found)}</p>"]
        body += page.table(_UNJUDGED, ["exercise", "quantity", "student", "answer", "why"], rows)
    if found.mistakes:
        rows = [
            (page.escaped(exercise), f"<code>{page.escaped(name)}</code>", str(count), page.sentence(says))
            for exercise, name, says, count in found.mistakes
        ]
        head = ["exercise", "quantity", "how often", "mistake"]
        body += ["<h2>Most common mistakes</h2>", *page.table("Most common mistakes", head, rows, counts=(2,))]
    return page.page(f"{in_text(title)}: summary", body)


@output("summary.md", "the same as Markdown")
def summary_markdown(
    title: str, students: Sequence[Student], marks: Collection[Marked], complaints: Iterable[object] = ()
) -> str:
    """Return the summary as Markdown, with the distribution in text.

    Arguments:
        title: of the assignment.
        students: the roster.
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.
    """
    found = Findings(students, marks, complaints)
    lines = [f"# {sentence_in_markdown(title)}: summary", ""]
    if found.no_jail:
        lines += [f"**{NO_JAIL}**", ""]
    for line in _overview(found):
        lines += [line, ""]
    if found.sums and found.points:
        lines += ["## Points", "", "```text", *histogram_text(found.steps), "```", ""]

    lines += ["## To look at", ""]
    lines += [f"- {_named(found, one)}: {'; '.join(map(in_markdown, reasons))}" for one, reasons in found.looks]
    lines += [""] if found.looks else [_NONE, ""]
    if found.complaints:
        lines += [f"## {_LEFT_ALONE}", ""]
        lines += [*(f"- {in_markdown(complaint)}" for complaint in found.complaints), ""]
    for heading, ids in _absent(found):
        lines += [f"## {heading}", "", ", ".join(_named(found, one) for one in ids), ""]

    lines += ["## Equal answers where the numbers differ", "", _EQUAL if found.equal else _NONE, ""]
    if found.equal:
        rows = [
            (
                in_markdown(one.number),
                _code(one.name),
                _code(one.answer),
                *(", ".join(_named(found, student) for student in ids) for ids in (one.right, one.others)),
            )
            for one in found.equal
        ]
        lines += _table(["exercise", "quantity", "answer", "right for", "not right for"], rows)

    if found.exercises:
        rows = [
            (
                f"{in_markdown(one.number)} · {_cell(one.title)}",
                percent(one.fraction),
                f"{number(one.mean)} of {number(one.points)}",
            )
            for one in found.exercises
        ]
        lines += ["## Exercises, the hardest first", "", *_table(["exercise", "mean", "points"], rows)]
        rows = [
            (
                in_markdown(asked.number),
                _code(asked.name),
                percent(asked.fraction),
                *(str(asked.counts[status]) for status in STATUSES),
            )
            for one in found.exercises
            for asked in one.asked
        ]
        lines += ["## Answers", "", *_table(["exercise", "quantity", "in percent", *STATUSES], rows)]
    if found.unjudged:
        rows = [
            (
                in_markdown(exercise),
                _code(name),
                _named(found, student),
                _code(answer) if answer else "",
                in_markdown(says),
            )
            for exercise, name, student, answer, says in found.unjudged[:MOST_UNJUDGED]
        ]
        lines += [f"## {_UNJUDGED}", "", f"{_WHY_UNJUDGED}{_more(found)}", ""]
        lines += _table(["exercise", "quantity", "student", "answer", "why"], rows)
    if found.mistakes:
        rows = [
            (in_markdown(exercise), _code(name), str(count), _cell(says))
            for exercise, name, says, count in found.mistakes
        ]
        lines += ["## Most common mistakes", "", *_table(["exercise", "quantity", "how often", "mistake"], rows)]
    return "\n".join(lines)


def _overview(found):
    """Lines on how many there are, and how they did."""
    many = [counted(len(found.handed_in), "submission")]
    many += [f"{len(found.missing)} missing"] if found.missing else []
    many += [f"{len(found.ungraded)} not graded yet"] if found.ungraded else []
    lines = [", ".join(many) + "."]
    if found.sums:
        mean = f"Mean {number(found.mean)}, median {number(found.median)}"
        lines.append(f"{mean} of {number(found.points)} points, over the submissions.")
    return lines


def _more(found):
    """What is said where not all of the answers that were not judged are told."""
    more = len(found.unjudged) - MOST_UNJUDGED
    return f" There are {more} more, on the pages of the students." if more > 0 else ""


def _absent(found):
    """Headings with the ids of those of whom there is nothing to judge."""
    return [pair for pair in (("Missing", found.missing), ("Not graded yet", found.ungraded)) if pair[1]]


def _student(found, student):
    return f'{page.of_student(found.name(student))} <span class="quiet">{page.escaped(student)}</span>'


def _named(found, student):
    return f"{in_markdown(found.name(student))} ({in_markdown(student)})"


def _cell(sentence):
    """A sentence with formulas in a table: a bar in a formula would end the cell."""
    return sentence_in_markdown(sentence.replace("|", r"\vert ") if "$" in sentence else sentence)


def _code(text):
    """Code in a table: a bar would end the cell even there."""
    return code_in_markdown(text).replace("|", "\\|")


def _table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return [*("| " + " | ".join(line) + " |" for line in lines), ""]
