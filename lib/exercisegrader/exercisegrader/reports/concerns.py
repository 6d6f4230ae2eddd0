"""What an instructor should look at, in the order of the points at stake."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from markupsafe import Markup

from exercisebook.judging import OPEN, UNJUDGED
from exercisegrader.reports.equal_answers import equal_answers
from exercisegrader.reports.pages import code, line, lines, said
from exercisegrader.reports.wording import answer_in_words, explained, remarks
from exercisegrader.results import MISSING, NO_CODE, NOT_RUN, ODD, OWNER, STOPPED, UNASKED
from exercisegrader.submissions import BESIDE, FILE

if TYPE_CHECKING:
    from exercisegrader.marking import Marked
    from exercisegrader.results import JudgedAnswer, JudgedExercise

_BY_HAND = Markup("To give points, enter them in <code>marks.csv</code> and grade again.")


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


@dataclass(frozen=True)
class Concern:
    """Reasons of one kind.

    Attributes:
        title: of them.
        advice: what the instructor can do.
        cases: the costliest first, in the order of the roster.
    """

    title: str
    advice: Markup | str
    cases: tuple[Case, ...] = field(default=())

    @property
    def points(self) -> float:
        """The points at stake in the costliest of its cases."""
        return max((case.points for case in self.cases), default=0)


NOBODYS = Concern(
    "Files that were not graded",
    "Somebody is missing, and one of these files may be theirs: give it a name or a folder that says whose it is, and "
    "grade again.",
)
NOT_RUNNING = Concern(
    "Notebooks that could not be run",
    "The grade is an empty cell. Repair the file or ask for another one, and grade again. " + _BY_HAND,
)
TO_MARK = Concern(
    "Answers that wait for a mark",
    Markup(
        "The grade is an empty cell until there are points in <code>marks.csv</code>. They are all on "
        '<a href="to_mark.html">one page</a>, those to one question below each other.'
    ),
)
TO_DECIDE = Concern(
    "Marks and times that need a decision",
    Markup("It stays as it is until you say otherwise, in <code>marks.csv</code> or in the file that is named."),
)
CUT_SHORT = Concern(
    "Notebooks that were stopped before all answers were in",
    Markup(
        "Open answers earn nothing. More time or memory may help (<code>--cell-seconds</code>, <code>--seconds</code>, "
        "<code>--megabytes</code>). "
    )
    + _BY_HAND,
)
FAILED = Concern(
    "Cells that failed, with answers left open",
    "Open answers earn nothing. The cell may have worked only after another one that is gone. " + _BY_HAND,
)
MISPLACED = Concern(
    "Answers that do not count where they stand",
    "They have a name that is not asked, or are in a cell that is not run; what is asked was left open and earns "
    "nothing. " + _BY_HAND,
)
UNREAD = Concern("Answers that could not be judged", "They earn nothing, but you may see what was meant. " + _BY_HAND)
FLAGGED = Concern(
    "Answers that were judged and are unusual",
    "The verdict stands unless you say otherwise. " + _BY_HAND,
)
OF_ANOTHER = Concern(
    "Notebooks that say they are somebody else's",
    "They were graded with the numbers of the student who handed them in. Ask whose work they are.",
)
TELLS_TOO_MUCH = Concern(
    "Notebooks that sent the grader something else than answers",
    "They gain nothing by it: what could not be read does not count. Look at the notebook to see what it tried.",
)
EQUAL = Concern(
    "Equal answers where the numbers differ",
    "The right answers of these students differ, so theirs should differ too. It is a reason to ask, not evidence.",
)
#: Where equal points are at stake in two of them, this is their order.
_ORDER = (
    NOT_RUNNING, NOBODYS, TO_MARK, TO_DECIDE, CUT_SHORT, FAILED, MISPLACED, UNREAD, FLAGGED, OF_ANOTHER, TELLS_TOO_MUCH,
    EQUAL,
)  # fmt: skip


def concerns(marks: Collection[Marked], complaints: Sequence[str] = ()) -> tuple[list[Concern], list[Case]]:
    """Return what an instructor should look at, the costliest first, and the cases that cost nothing.

    Arguments:
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.
    """
    found: dict[Concern, list[Case]] = {}
    harmless: list[Case] = []
    for concern, case in _cases(marks, complaints):
        if concern:
            found.setdefault(concern, []).append(case)
        else:
            harmless.append(case)
    costly = [
        Concern(one.title, one.advice, tuple(sorted(found[one], key=lambda case: -case.points)))
        for one in _ORDER
        if one in found
    ]
    return sorted(costly, key=lambda one: -one.points), harmless


def share(exercise: JudgedExercise, answer: JudgedAnswer) -> float:
    """Return the points that one answer brings where it is right."""
    return exercise.points * answer.weight / sum(one.weight for one in exercise.answers)


def _cases(marks, complaints) -> Iterator[tuple[Concern | None, Case]]:
    results = [mark.result for mark in marks]
    points = max((result.points for result in results), default=0)
    somebody_is_missing = not results or any(result.status == MISSING for result in results)
    not_run = [(one.file, one.says) for one in results if one.status == NOT_RUN]
    told = {f"{file}: {one}" for file, says in not_run for one in (says, says.removeprefix(FILE))}
    owner = {one.file: one.student for one in results if one.file}
    chosen = {f"{one.file}: {one.chosen}": one.student for one in results if one.chosen}
    for complaint in complaints:
        what = said(complaint)
        if complaint in chosen:
            yield None, Case((chosen[complaint],), 0, what)
        elif student := owner.get(complaint.rpartition(BESIDE)[2]):
            yield None, Case((student,), 0, what)
        elif complaint not in told:
            yield (NOBODYS, Case((), points, what)) if somebody_is_missing else (None, Case((), 0, what))
    for mark in marks:
        for concern, at_stake, what in _of_one(mark):
            yield concern, Case((mark.result.student,), at_stake, what)
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
        yield None if mark.total is not None else NOT_RUNNING, result.points, notes
        return
    left = [
        (one.judged, answer)
        for one in mark.exercises
        for answer in one.judged.answers
        if not is_decided and answer.name not in one.decided
    ]
    if notes:
        at_stake = sum(share(exercise, answer) for exercise, answer in left if answer.status == OPEN)
        concern = CUT_SHORT if result.status == STOPPED else FAILED if result.errors else None
        yield concern if at_stake else None, at_stake, notes
    for exercise, answer in left:
        at_stake, given = share(exercise, answer), _place(exercise.number, answer.name)
        if shown := answer_in_words(answer.answer):
            given = line(given, ": ", code(shown))
        if answer.status == UNJUDGED:
            yield UNREAD, at_stake, line(given, "; ", said(explained(answer)))
        if answer.look:
            yield FLAGGED, at_stake, line(given, f"; judged {answer.status}: ", said(answer.look))
    for look in result.looks:
        left_open = sum(
            share(exercise, answer)
            for exercise, answer in left
            if answer.status == OPEN and look.exercise in ("", exercise.number)
        )
        concern, at_stake = {
            OWNER: (OF_ANOTHER, result.points),
            ODD: (TELLS_TOO_MUCH, result.earned),
            UNASKED: (MISPLACED if left_open else None, left_open),
            NO_CODE: (MISPLACED if left_open else None, left_open),
        }.get(look.kind, (None, 0))
        yield None if is_decided else concern, at_stake, said(look.says)


def _to_mark(marks):
    """The cases of what waits for a mark: one for each quantity, whoever's answers these are."""
    found: dict[tuple[str, str], tuple[float, Markup, list[str]]] = {}
    for mark in marks:
        waiting = set(mark.waiting)
        for exercise in mark.result.exercises:
            for answer in exercise.answers:
                if (place := (exercise.number, answer.name)) in waiting:
                    what = _place(*place)
                    if answer.key:
                        what = line(what, "; to look for: ", said(answer.key))
                    found.setdefault(place, (share(exercise, answer), what, []))[2].append(mark.result.student)
    for points, what, students in found.values():
        yield Case(tuple(students), points, what)


def _equal(results):
    """The cases of equal answers."""
    shares = {
        (exercise.number, answer.name): share(exercise, answer)
        for result in results
        for exercise in result.exercises
        for answer in exercise.answers
    }
    found: dict[tuple[tuple[str, ...], tuple[str, ...]], list[tuple[float, Markup]]] = {}
    for one in equal_answers(results):
        what = line(_place(one.number, one.name), ": ", code(one.answer))
        found.setdefault((one.right, one.others), []).append((shares[one.number, one.name], what))
    for (right, others), given in found.items():
        whose = f"right for {', '.join(right)}, not for {', '.join(others)}" if right else "wrong for all"
        points, answers = zip(*given, strict=True)
        yield Case((*right, *others), sum(points), lines(*answers, whose))


def _place(number, name):
    """A quantity of an exercise."""
    return line(f"{number} · ", code(name))
