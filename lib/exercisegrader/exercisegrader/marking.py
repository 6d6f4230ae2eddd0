"""Marks: what a result counts, with what a person has marked and what is deducted; the reports show these.

`Marking` brings together what they come from: results, ``marks.csv``, the due date, extensions.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Self

from exercisebook.judging import WAITING
from exercisegrader.lateness import IN_TIME, Lateness, lateness, read_extensions
from exercisegrader.overrides import TO_MARK, Mark, Notice, Overrides, code
from exercisegrader.reports.wording import counted, number, of_points
from exercisegrader.results import MISSING, NOT_RUN, JudgedExercise, Result
from exercisegrader.student import Roll, parts

if TYPE_CHECKING:
    from exercisegrader.assignment import Assignment
    from exercisegrader.student import Student
    from exercisegrader.submissions import Submission

#: What there is of a student, besides `results.MISSING` and `results.NOT_RUN`.
GRADED, WAITS = "graded", "waits"
_NONE = Mark()


@dataclass(frozen=True)
class MarkedExercise:
    """An exercise with what it counts.

    Attributes:
        judged: as the grader judged it.
        earned: its points; None while something in it waits for a person.
        comments: of the instructor, for the student.
        history: how the points came about, where a person has marked, in sentences.
        waiting: the quantities that wait for a person.
        is_by_hand: whether a person has marked the whole of it.
        decided: the quantities of which a person has said what they are worth.
        so_far: its points while something in it waits.
        by_quantity: the points that a person has given to single quantities.
    """

    judged: JudgedExercise
    earned: float | None
    comments: tuple[str, ...] = ()
    history: tuple[str, ...] = ()
    waiting: tuple[str, ...] = ()
    is_by_hand: bool = False
    decided: tuple[str, ...] = ()
    so_far: float = 0.0
    by_quantity: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, judged: JudgedExercise, by_hand: Mapping[tuple[str, str], Mark] | None = None) -> Self:
        """Return an exercise with the marks by hand, {(exercise, quantity): mark}, of its student.

        The mark of a whole exercise counts more than those of its quantities.
        """
        by_hand = by_hand or {}
        whole = by_hand.get((judged.number, ""), _NONE)
        sum_, comments, history, waiting, by_quantity = 0.0, [], [], [], {}
        for one in judged.answers:
            mark, part = by_hand.get((judged.number, one.name), _NONE), judged.share(one)
            by_grader = part * one.part
            if mark.points is not None:
                sum_ += mark.points
                by_quantity[one.name] = mark.points
                said = "" if one.status == WAITING else f"{number(by_grader)} by the grader, "
                history.append(f"{one.name}: {said}{of_points(mark.points, part)} by hand{_quoted(mark)}")
                continue
            sum_ += by_grader
            if one.status == WAITING:
                waiting.append(one.name)
            if mark.comment:
                comments.append(f"{one.name}: {mark.comment}")
        if whole.points is not None:
            by_grader = of_points(judged.earned, judged.points)
            history.append(f"{by_grader} by the grader, {number(whole.points)} by hand{_quoted(whole)}")
            sum_, waiting = whole.points, []
        elif whole.comment:
            comments.append(whole.comment)
        earned, is_by_hand = None if waiting else sum_, whole.points is not None
        decided = tuple(one.name for one in judged.answers if is_by_hand or one.name in by_quantity)
        return cls(
            judged, earned, tuple(comments), tuple(history), tuple(waiting), is_by_hand, decided, sum_, by_quantity
        )

    def by_place(self) -> Iterator[tuple[str, str]]:
        """Yield the points of the exercise and of each of its quantities, as text, by number and name."""
        yield self.judged.number, "" if self.earned is None else number(self.earned)
        for one in self.judged.answers:
            points = self.by_quantity.get(one.name, self.judged.share(one) * one.part)
            yield f"{self.judged.number} {one.name}", "" if one.name in self.waiting else number(points)

    @property
    def known(self) -> float:
        """Its points; while something waits, the rest counts already."""
        return self.so_far if self.earned is None else self.earned


@dataclass(frozen=True)
class Marked:
    """A result with what it counts.

    Attributes:
        result: of the grader.
        exercises: a `MarkedExercise` for each of the result's.
        late: how late it is and what that costs, in a sentence; empty where it is on time.
        deduction: what that costs, in points.
        comments: of the instructor on the whole of it.
        looks: why an instructor should see to it, besides what the result says.
        by_hand: the points of the whole, where a person has marked it; nothing is deducted from these.
        code: what whoever marks knows the student by.
    """

    result: Result
    exercises: tuple[MarkedExercise, ...]
    late: str = ""
    deduction: float = 0
    comments: tuple[str, ...] = ()
    looks: tuple[Notice, ...] = ()
    by_hand: float | None = None
    code: str = ""

    @classmethod
    def of(
        cls,
        result: Result,
        by_hand: Mapping[tuple[str, str], Mark] | None = None,
        lateness: Lateness | None = None,
        looks: tuple[Notice, ...] = (),
    ) -> Self:
        """Return a result with what was added to it.

        Arguments:
            result: of the grader.
            by_hand: {(exercise, quantity): mark} of the student; an empty quantity is the whole exercise, an empty
                exercise the whole notebook.
            lateness: of the submission.
            looks: why an instructor should see to it.
        """
        by_hand, lateness = by_hand or {}, lateness or Lateness()
        exercises = tuple(MarkedExercise.of(one, by_hand) for one in result.exercises)
        whole = by_hand.get(("", ""), _NONE)
        sum_ = sum(one.known for one in exercises)
        comments = [whole.comment] if whole.comment and whole.points is None else []
        if whole.points is not None:
            before = of_points(sum_, result.points)
            comments.append(f"{before} before, {number(whole.points)} by hand for all of it{_quoted(whole)}")
        late = lateness.says
        if whole.points is not None and lateness.part:
            late += "; the points by hand for all of it stay as they are"
        deduction = 0.0 if whole.points is not None else lateness.part * sum_
        if lateness.look and whole.points is None:
            looks = (*looks, Notice(max(sum_, result.earned), lateness.look))
        return cls(result, exercises, late, deduction, tuple(comments), looks, whole.points)

    @property
    def waiting(self) -> tuple[tuple[str, str], ...]:
        """Pairs of the number of an exercise and a quantity that wait for a person."""
        if self.by_hand is not None:
            return ()
        return tuple((one.judged.number, name) for one in self.exercises for name in one.waiting)

    @property
    def total(self) -> float | None:
        """The points; None, an empty cell, while something waits, and where nothing was handed in or could be run.

        A person may mark the whole of it, or each exercise as a whole: then these are the points.
        """
        if self.by_hand is not None:
            return self.by_hand
        if self.result.status in (MISSING, NOT_RUN) and not all(one.is_by_hand for one in self.exercises):
            return None
        if any(one.earned is None for one in self.exercises):
            return None
        return max(0.0, sum(one.earned or 0 for one in self.exercises) - self.deduction)

    @property
    def state(self) -> str:
        """What there is: GRADED where there are points, `results.MISSING`, `results.NOT_RUN`, or WAITS for a mark."""
        if self.total is not None:
            return GRADED
        return self.result.status if self.result.status in (MISSING, NOT_RUN) else WAITS

    @property
    def known(self) -> float:
        """The points; while something waits for a person, the rest counts already."""
        if self.total is not None or self.result.status in (MISSING, NOT_RUN):
            return self.total or 0.0
        return max(0.0, sum(one.known for one in self.exercises) - self.deduction)


class Marking:
    """What results are marked with: the marks by hand in a folder of grades, the due date, and extensions.

    Arguments:
        folder: of the grades.
        assignment: `Assignment`.
        students: the roster.
        extensions: the file that grants them; None where there is none.
        also: {another id of a student, as the roster may have it: id}.
    Raises:
        GradingError: with all faults of the extensions.
    """

    def __init__(
        self,
        folder: Path,
        assignment: Assignment,
        students: Sequence[Student],
        extensions: Path | None = None,
        also: Mapping[str, str] | None = None,
    ):
        self.assignment = assignment
        self.extensions: dict[str, datetime.datetime] = {}
        self._idle: list[str] = []
        graded = [path.stem for path in (folder / "results").glob("*.json")]
        ids = [student.id for student in students]
        self.codes = {student: code(assignment.secret, student) for student in (*ids, *graded)}
        roll = Roll(ids, {**(also or {}), **{code: student for student, code in self.codes.items()}}, graded)
        if extensions:
            self.extensions, self._idle = read_extensions(extensions, roll, assignment.name, assignment.policy)
        self.overrides = Overrides(folder, assignment, roll, parts(students))
        self._at: dict[str, datetime.datetime | None] = {}

    def read(self, result_of: Callable[[str], Result | None]) -> None:
        """Read the marks by hand, and note what has changed; `Overrides.read` says more."""
        self.overrides.read(result_of)

    def marked(self, results: Sequence[Result], submissions: Mapping[str, Submission]) -> list[Marked]:
        """Return the results with what they count, and add a row, where `Overrides.add` says, for each that waits.

        Arguments:
            results: in the order of the roster.
            submissions: {student: submission}.
        Raises:
            GradingError: where the file cannot be written.
        """
        self._at = {student: submission.handed_in for student, submission in submissions.items()}
        marks = [self._marked(result, submissions.get(result.student)) for result in results]
        asked = dict.fromkeys(
            (one.number, answer.name) for result in results for one in result.exercises for answer in one.answers
        )
        unordered = sorted(marks, key=lambda mark: mark.code)  # the order of the roster would tell whose it is
        self.overrides.add((one.result.student, *place) for place in asked for one in unordered if place in one.waiting)
        return marks

    def _marked(self, result, submission):
        late, until = Lateness(), self.extensions.get(result.student)
        if submission and result.status != MISSING:
            late = lateness(self.assignment.policy, submission.handed_in, submission.late, until)
        by_hand, changed = self.overrides.of(result.student), self.overrides.changed_since(result)
        return replace(Marked.of(result, by_hand, late, tuple(changed)), code=self.codes[result.student])

    def notes(self, marks: Sequence[Marked]) -> list[str]:
        """Return sentences on what was applied."""
        found, policy = [], self.assignment.policy
        handed_in = [mark for mark in marks if mark.result.status != MISSING]
        if policy is not None:
            late = [mark for mark in handed_in if mark.late and not mark.late.startswith(IN_TIME)]
            unknown = [one for mark in handed_in if not mark.late and self._at.get(one := mark.result.student) is None]
            found.append(f"D{str(policy)[1:]}. {counted(len(late), 'submission')} came late.")
            if until := self.extensions:
                found[-1] += f" {counted(len(until), 'student')} {'has' if len(until) == 1 else 'have'} an extension."
            if unknown:
                found.append(
                    f"Of {counted(len(unknown), 'submission')} nothing says when it was handed in: it counts as in "
                    "time. A column handed_in in the roster says it."
                )
        found += self._idle
        by_hand = sum(mark.points is not None for mark in self.overrides.marks.values())
        if by_hand:
            found.append(f"{counted(by_hand, 'mark')} by hand.")
        if waiting := sum(len(mark.waiting) for mark in marks):
            found.append(
                f"{counted(waiting, 'answer')} to be marked: the folder {TO_MARK} has a page of them and a table for "
                "the points, for each section, without names."
            )
        if former := self.overrides.former:
            found.append(
                f"There are marks of {', '.join(sorted(former))}, no longer on the roster: they stay where they are."
            )
        if self.overrides.withdrawn:
            found.append(f"{counted(self.overrides.withdrawn, 'mark')} by hand withdrawn since the last time.")
        return found


def _quoted(mark):
    return f': "{mark.comment}"' if mark.comment else ""
