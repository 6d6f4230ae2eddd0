"""The summary for the instructor: what to look at first, and then how the class did."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from exercisebook.judging import WAITING
from exercisegrader.reports.concerns import Case, Concern, concerns
from exercisegrader.reports.document import (
    Block,
    Caution,
    Code,
    Details,
    Document,
    Heading,
    Histogram,
    Lines,
    Link,
    Listing,
    Paragraph,
    Said,
    Sentence,
    Status,
    Table,
    Text,
    person,
)
from exercisegrader.reports.findings import Findings
from exercisegrader.reports.outputs import registered
from exercisegrader.reports.publishing import published
from exercisegrader.reports.wording import NO_JAIL, STATUSES, counted, in_text, number, percent, without_jail
from exercisegrader.results import NOT_RUN

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.marking import Marked
    from exercisegrader.roster import Student

#: So many cases of one kind are told.
MOST_CASES = 100
#: The files of this summary.
OWN = ("summary.html", "summary.md")


@published("summary", "the summary for the instructor")
def summary(
    title: str,
    students: Sequence[Student],
    marks: Collection[Marked],
    complaints: Sequence[str] = (),
    notes: Sequence[str] = (),
    notebooks: Collection[str] = (),
    folder: Path | None = None,
) -> Document:
    """Return the summary.

    Arguments:
        title: of the assignment.
        students: the roster.
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.
        notes: sentences on how the class was graded.
        notebooks: the ids of the students whose notebook was kept as it ran.
        folder: of the grades; where it is given, files that are not there are not told.
    """
    found = Findings(students, marks)
    graded, names = {mark.result.student for mark in marks}, {student.id: student.name for student in students}

    def named(id: str) -> Text:
        """A student, with links to what there is of the submission."""
        if id not in graded:
            return person(names.get(id, id), id)
        shown: Text = Link(person(names.get(id, id), id), f"feedback/{id}/feedback.html")
        return (shown, " · ", Link("notebook", f"notebooks/{id}.html")) if id in notebooks else shown

    blocks: list[Block] = []
    if without_jail(mark.result for mark in marks):
        blocks.append(Caution(NO_JAIL))
    blocks += [Paragraph(line) for line in _overview(found)]
    if notes:
        blocks += [Heading("How the class was graded"), Listing(tuple(map(Said, notes)))]
    blocks += _to_look_at(*concerns(marks, complaints), named)
    for heading, ids in (("Missing", found.missing), ("Not graded yet", found.ungraded)):
        if ids:
            blocks += [Heading(heading), Listing(tuple(map(named, ids)))]
    blocks += [*_late(marks, named), *_by_hand(marks, named)]
    if found.sums and found.points:
        blocks += [Heading("Points"), Histogram(tuple(found.steps))]
    blocks += [*_exercises(found), *_files(folder)]
    return Document((Sentence(title), ": summary"), f"{in_text(title)}: summary", tuple(blocks))


def _overview(found):
    """Lines on how many there are, and how they did."""
    many = [counted(len(found.handed_in), "submission")]
    not_run = sum(mark.result.status == NOT_RUN for mark in found.handed_in)
    waiting = sum(mark.total is None and mark.result.status != NOT_RUN for mark in found.handed_in)
    counts = {"missing": len(found.missing), "not graded yet": len(found.ungraded), "not run": not_run}
    counts["waiting for a mark"] = waiting
    lines = [", ".join([*many, *(f"{count} {what}" for what, count in counts.items() if count)]) + "."]
    if found.sums:
        mean = f"Mean {number(found.mean)}, median {number(found.median)}"
        lines.append(f"{mean} of {number(found.points)} points, over {counted(len(found.sums), 'grade')}.")
    return lines


def _to_look_at(costly: list[Concern], harmless: list[Case], named) -> list[Block]:
    blocks: list[Block] = [Heading("To look at")]
    if costly:
        blocks.append(Paragraph("In the order of the points at stake for a student."))
    for concern in costly:
        blocks += [Heading(concern.title, level=3), Paragraph(concern.advice)]
        rows = [(_whose(case, named), number(case.points), case.what) for case in concern.cases[:MOST_CASES]]
        blocks.append(Table(concern.title, ["student", "at stake", "what"], rows, counts=frozenset({1})))
        blocks += _more(concern.cases)
    if not costly:
        blocks.append(Paragraph("Nothing." if not harmless else "Nothing that may cost points."))
    if harmless:
        rows = [(_whose(case, named), case.what) for case in harmless[:MOST_CASES]]
        table = Table("Harmless", ["student", "what"], rows)
        count = counted(len(harmless), "remark")
        blocks.append(
            Details(
                f"{count} that cost nothing" if len(harmless) > 1 else f"{count} that costs nothing",
                (table, *_more(harmless)),
            )
        )
    return blocks


def _whose(case: Case, named) -> Text:
    return Lines(tuple(map(named, case.students))) if case.students else "nobody"


def _more(cases: Sequence[Case]) -> list[Block]:
    more = len(cases) - MOST_CASES
    return [Paragraph(f"There are {more} more, on the pages of the students.")] if more > 0 else []


def _late(marks, named) -> list[Block]:
    rows = [(named(mark.result.student), number(mark.deduction), Said(mark.late)) for mark in marks if mark.late]
    if not rows:
        return []
    head = ["student", "points off", "why"]
    return [Heading("Late, and extensions"), Table("Late, and extensions", head, rows, counts=frozenset({1}))]


def _by_hand(marks, named) -> list[Block]:
    rows = []
    for mark in marks:
        student = named(mark.result.student)
        for one in mark.exercises:
            if said := (*one.comments, *one.history):
                grader, counts = number(one.judged.earned), "" if one.earned is None else number(one.earned)
                rows.append((student, one.judged.number, grader, counts, Lines(tuple(map(Said, said)))))
        if mark.comments or mark.by_hand is not None:
            grader, counts = number(mark.result.earned), "" if mark.total is None else number(mark.total)
            rows.append((student, "all of it", grader, counts, Lines(tuple(map(Said, mark.comments)))))
    if not rows:
        return []
    head = ["student", "exercise", "by the grader", "counts", "marks and comments"]
    return [Heading("Marks by hand"), Table("Marks by hand", head, rows, counts=frozenset({2, 3}))]


def _exercises(found: Findings) -> list[Block]:
    if not found.exercises:
        return []
    rows = [
        (
            (f"{one.number} · ", Sentence(one.title)),
            *(("", "") if one.mean is None else (percent(one.fraction), f"{number(one.mean)} of {number(one.points)}")),
        )
        for one in found.exercises
    ]
    head: list[Text] = ["exercise", "mean", "points"]
    blocks: list[Block] = [
        Heading("Exercises, the hardest first"),
        Table("Exercises", head, rows, counts=frozenset({1, 2})),
    ]
    asked = [asked for one in found.exercises for asked in one.asked]
    statuses = [status for status in STATUSES if status != WAITING or any(one.counts[status] for one in asked)]
    answers = [
        (
            one.number,
            Code(one.name),
            "" if one.fraction is None else percent(one.fraction),
            *(str(one.counts[status]) for status in statuses),
        )
        for one in asked
    ]
    head = ["exercise", "quantity", "in percent", *map(Status, statuses)]
    blocks += [Heading("Answers"), Table("Answers", head, answers, counts=frozenset(range(2, len(head))))]
    if found.mistakes:
        mistakes = [(place, Code(name), str(count), Sentence(says)) for place, name, says, count in found.mistakes]
        head = ["exercise", "quantity", "how often", "mistake"]
        blocks += [
            Heading("Most common mistakes"),
            Table("Most common mistakes", head, mistakes, counts=frozenset({2})),
        ]
    return blocks


def _files(folder: Path | None) -> list[Block]:
    there = [one for one in registered() if folder is None or one.is_for_each_student or (folder / one.file).exists()]
    rows = [(Code(one.file), one.what) for one in there if one.file not in OWN]
    return [
        Heading("Files"),
        Details("What was written, and what for", (Table("Files", ["file", "what it is"], rows),)),
    ]
