"""The summary for the instructor: what to look at first, and then how the class did."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from markupsafe import Markup

from exercisebook.judging import WAITING
from exercisegrader.reports.concerns import Case, Concern, concerns
from exercisegrader.reports.findings import Findings
from exercisegrader.reports.outputs import output, registered
from exercisegrader.reports.pages import Table, code, line, lines, link, page, person, said, sentence, status
from exercisegrader.reports.wording import STATUSES, counted, in_text, number, percent, without_jail
from exercisegrader.results import NOT_RUN

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.marking import Marked
    from exercisegrader.roster import Student

#: So many cases of one kind are told.
MOST_CASES = 100
#: The bar of the most common points (rem).
LONGEST_BAR = 20
#: The file of this summary.
OWN = "summary.html"


@output(OWN, "the summary for the instructor")
def summary(
    title: str,
    students: Sequence[Student],
    marks: Collection[Marked],
    complaints: Sequence[str] = (),
    notes: Sequence[str] = (),
    notebooks: Collection[str] = (),
    folder: Path | None = None,
) -> str:
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

    def named(id: str) -> Markup:
        """A student, with links to what there is of the submission."""
        shown = person(names.get(id, id), id)
        if id not in graded:
            return shown
        shown = link(shown, f"feedback/{id}/feedback.html")
        return line(shown, " · ", link("notebook", f"notebooks/{id}.html")) if id in notebooks else shown

    def whose(case: Case) -> Markup | str:
        return lines(*map(named, case.students)) if case.students else "nobody"

    def of_concern(concern: Concern) -> Table:
        rows = [(whose(case), number(case.points), case.what) for case in concern.cases[:MOST_CASES]]
        return Table(concern.title, ["student", "at stake", "what"], rows, [1])

    costly, harmless = concerns(marks, complaints)
    rows = [(whose(case), case.what) for case in harmless[:MOST_CASES]]
    return page(
        "summary.html",
        f"{in_text(title)}: summary",
        title=title,
        unsafe=without_jail(mark.result for mark in marks),
        found=found,
        counts=_counts(found),
        notes=notes,
        most=MOST_CASES,
        costly=[(concern, of_concern(concern)) for concern in costly],
        harmless=harmless,
        cases_of_harmless=Table("Harmless", ["student", "what"], rows),
        absent=[("Missing", [*map(named, found.missing)]), ("Not graded yet", [*map(named, found.ungraded)])],
        tables=[_late(marks, named), _by_hand(marks, named), _points(found), *_exercises(found)],
        files=_files(folder),
    )


def _counts(found):
    """How many there are of each."""
    not_run = sum(mark.result.status == NOT_RUN for mark in found.handed_in)
    waiting = sum(mark.total is None and mark.result.status != NOT_RUN for mark in found.handed_in)
    counts = {"missing": len(found.missing), "not graded yet": len(found.ungraded), "not run": not_run}
    counts["waiting for a mark"] = waiting
    return [counted(len(found.handed_in), "submission"), *(f"{n} {what}" for what, n in counts.items() if n)]


def _late(marks, named):
    rows = [(named(mark.result.student), number(mark.deduction), said(mark.late)) for mark in marks if mark.late]
    return Table("Late, and extensions", ["student", "points off", "why"], rows, [1])


def _by_hand(marks, named):
    rows = []
    for mark in marks:
        student = named(mark.result.student)
        for one in mark.exercises:
            if texts := (*one.comments, *one.history):
                grader, counts = number(one.judged.earned), "" if one.earned is None else number(one.earned)
                rows.append((student, one.judged.number, grader, counts, lines(*map(said, texts))))
        if mark.comments or mark.by_hand is not None:
            grader, counts = number(mark.result.earned), "" if mark.total is None else number(mark.total)
            rows.append((student, "all of it", grader, counts, lines(*map(said, mark.comments))))
    head = ["student", "exercise", "by the grader", "counts", "marks and comments"]
    return Table("Marks by hand", head, rows, [2, 3])


def _points(found):
    """The distribution of the points, with bars."""
    most = max((count for _, _, count in found.steps), default=0)
    bar = Markup('<span class="bar" style="width: {:.1f}rem"></span> {}')
    rows = [
        (f"{number(a)} to {number(b)}", bar.format(LONGEST_BAR * n / most, n) if n else "") for a, b, n in found.steps
    ]
    return Table("Points", ["points", "submissions"], rows if found.sums and found.points else [])


def _exercises(found):
    rows = [
        (
            line(f"{one.number} · ", sentence(one.title)),
            *(("", "") if one.mean is None else (percent(one.fraction), f"{number(one.mean)} of {number(one.points)}")),
        )
        for one in found.exercises
    ]
    asked = [asked for one in found.exercises for asked in one.asked]
    statuses = [one for one in STATUSES if one != WAITING or any(each.counts[one] for each in asked)]
    answers = [
        (
            one.number,
            code(one.name),
            "" if one.fraction is None else percent(one.fraction),
            *(one.counts[status] for status in statuses),
        )
        for one in asked
    ]
    head = ["exercise", "quantity", "in percent", *map(status, statuses)]
    mistakes = [(place, code(name), count, sentence(says)) for place, name, says, count in found.mistakes]
    return [
        Table("Exercises, the hardest first", ["exercise", "mean", "points"], rows, [1, 2]),
        Table("Answers", head, answers, range(2, len(head))),
        Table("Most common mistakes", ["exercise", "quantity", "how often", "mistake"], mistakes, [2]),
    ]


def _files(folder: Path | None) -> Table:
    there = [one for one in registered() if folder is None or one.is_for_each_student or (folder / one.file).exists()]
    return Table("Files", ["file", "what it is"], [(code(one.file), one.what) for one in there if one.file != OWN])
