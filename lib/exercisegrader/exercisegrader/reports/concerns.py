"""What an instructor should look at, in the order of the points at stake."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisebook.judging import OPEN, UNJUDGED
from exercisegrader.reports.equal_answers import equal_answers
from exercisegrader.reports.pages import code, line, lines, said
from exercisegrader.reports.wording import answer_in_words, explained, remarks
from exercisegrader.results import MISSING, NOT_RUN, ODD, OWNER, STOPPED
from exercisegrader.submissions import BESIDE, FILE

if TYPE_CHECKING:
    from markupsafe import Markup

    from exercisegrader.marking import Marked

_BY_HAND = "To give points, enter them in marks.csv and grade again."
#: The kinds of concerns, as headings, and what to do about each. Where equal points are at stake in two of them, this
#: is their order.
ADVICE = {
    (NOT_RUNNING := "Notebooks that could not be run"): "The grade is an empty cell, and no zero. Repair the file, or "
    f"ask the student for another one, and grade again. {_BY_HAND}",
    (NOBODYS := "Files that were not graded"): "Somebody is missing, and one of these files may be theirs: give it a "
    "name or a folder that says whose it is, and grade again.",
    (TO_MARK := "Answers that wait for a mark"): "The grade is an empty cell until there are points. The folder "
    "to_mark has a page of them for each section, and beside it a table for the points: give both to whoever marks, "
    "put the table back where it was, and grade again.",
    (TO_DECIDE := "Marks and times that need a decision"): "It stays as it is until you say otherwise, in marks.csv or "
    "in the file that is named.",
    (CUT_SHORT := "Notebooks that were stopped before all answers were in"): "Open answers earn nothing. More time or "
    f"memory may help (--cell-seconds, --seconds, --megabytes). {_BY_HAND}",
    (FAILED := "Cells that failed, with answers left open"): "Open answers earn nothing. The cell may have worked only "
    f"after another one that is gone. {_BY_HAND}",
    (MISPLACED := "Answers that do not count where they stand"): "They have a name that is not asked, or are in a cell "
    f"that is not run; what is asked was left open and earns nothing. {_BY_HAND}",
    (UNREAD := "Answers that could not be judged"): f"They earn nothing, but you may see what was meant. {_BY_HAND}",
    (FLAGGED := "Answers that were judged and are unusual"): f"The verdict stands unless you say otherwise. {_BY_HAND}",
    (OF_ANOTHER := "Notebooks that say they are somebody else's"): "They were graded with the numbers of the student "
    "who handed them in. Ask whose work they are.",
    (TELLS_TOO_MUCH := "Notebooks that sent the grader something else than answers"): "They gain nothing by it: what "
    "could not be read does not count. Look at the notebook to see what it tried.",
    (EQUAL := "Equal answers where the numbers differ"): "The right answers of these students differ, so theirs should "
    "differ too. It is a reason to ask, not evidence.",
}


@dataclass(frozen=True)
class Case:
    """One reason to look.

    Attributes:
        students: the ids of those whom it concerns; none for a file of nobody.
        points: at stake for each of them.
        what: there is, for the summary.
    """

    students: tuple[str, ...]
    points: float
    what: Markup


def concerns(marks: Collection[Marked], complaints: Sequence[str] = ()) -> dict[str, list[Case]]:
    """Return what an instructor should look at by its kind, the costliest first; what costs nothing is not among it.

    Arguments:
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.
    """
    found: dict[str, list[Case]] = {}
    for kind, case in _cases(marks, complaints):
        found.setdefault(kind, []).append(case)
    costly = {kind: sorted(found[kind], key=lambda case: -case.points) for kind in ADVICE if kind in found}
    return dict(sorted(costly.items(), key=lambda one: -one[1][0].points))


def _cases(marks, complaints) -> Iterator[tuple[str, Case]]:
    """Pairs of a kind and a case."""
    results = [mark.result for mark in marks]
    points = max((result.points for result in results), default=0)
    not_run = [(one.file, one.says) for one in results if one.status == NOT_RUN]
    told = {f"{file}: {one}" for file, says in not_run for one in (says, says.removeprefix(FILE))}
    told |= {f"{one.file}: {one.chosen}" for one in results if one.chosen}
    graded = {one.file for one in results}
    if not results or any(result.status in (MISSING, NOT_RUN) for result in results):  # else nobody lacks a file
        for complaint in complaints:
            if complaint not in told and complaint.rpartition(BESIDE)[2] not in graded:
                yield NOBODYS, Case((), points, said(complaint))
    for mark in marks:
        for kind, at_stake, what in _of_one(mark):
            yield kind, Case((mark.result.student,), at_stake, what)
    yield from ((TO_MARK, case) for case in _to_mark(marks))
    yield from ((EQUAL, case) for case in _equal(results))


def _of_one(mark):
    """The cases of one submission, without its student. What a person has decided is none."""
    result, is_decided = mark.result, mark.by_hand is not None
    for look in mark.looks:
        yield TO_DECIDE, look.points, said(look.says)
    if result.status == MISSING:
        return
    notes = lines(*map(said, remarks(result)))
    if result.status == NOT_RUN:
        if mark.total is None:
            yield NOT_RUNNING, result.points, notes
        return
    left = [
        (one.judged.number, answer, one.judged.share(answer))
        for one in mark.exercises
        for answer in one.judged.answers
        if not is_decided and answer.name not in one.decided
    ]

    def left_open(exercise=""):
        return sum(share for number, answer, share in left if answer.status == OPEN and exercise in ("", number))

    if left_open() and (result.status == STOPPED or result.errors):
        yield CUT_SHORT if result.status == STOPPED else FAILED, left_open(), notes
    for number, answer, at_stake in left:
        given = _place(number, answer.name)
        if shown := answer_in_words(answer.answer):
            given = line(given, ": ", code(shown))
        if answer.status == UNJUDGED:
            yield UNREAD, at_stake, line(given, "; ", said(explained(answer)))
        if answer.look:
            yield FLAGGED, at_stake, line(given, f"; judged {answer.status}: ", said(answer.look))
    for look in result.looks if not is_decided else ():
        if look.kind == OWNER:
            yield OF_ANOTHER, result.points, said(look.says)
        elif look.kind == ODD:
            yield TELLS_TOO_MUCH, result.earned, said(look.says)
        elif at_stake := left_open(look.exercise):
            yield MISPLACED, at_stake, said(look.says)


def _to_mark(marks):
    """The cases of what waits for a mark: one for each quantity, whoever's answers these are."""
    found: dict[tuple[str, str], tuple[float, Markup, list[str]]] = {}
    for mark in marks:
        for exercise in mark.result.exercises:
            for answer in exercise.answers:
                if (place := (exercise.number, answer.name)) in mark.waiting:
                    what = _place(*place)
                    if answer.key:
                        what = line(what, "; to look for: ", said(answer.key))
                    found.setdefault(place, (exercise.share(answer), what, []))[2].append(mark.result.student)
    for points, what, students in found.values():
        yield Case(tuple(students), points, what)


def _equal(results):
    """The cases of equal answers: one for the same students."""
    found: dict[tuple[tuple[str, ...], tuple[str, ...]], list[tuple[float, Markup]]] = {}
    for one in equal_answers(results):
        what = line(_place(one.number, one.name), ": ", code(one.answer))
        found.setdefault((one.right, one.others), []).append((one.points, what))
    for (right, others), given in found.items():
        whose = f"right for {', '.join(right)}, not for {', '.join(others)}"
        points, answers = zip(*given, strict=True)
        yield Case((*right, *others), sum(points), lines(*answers, whose))


def _place(number, name):
    """A quantity of an exercise."""
    return line(f"{number} · ", code(name))
