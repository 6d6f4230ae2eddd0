"""Marks: what a result counts, with what a person has marked and what is deducted; the reports show these."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

from loopbook.exercises.judging import RIGHT, WAITING, earned
from loopbook.grading.lateness import Lateness
from loopbook.grading.overrides import Mark, points
from loopbook.grading.results import MISSING, NOT_RUN, JudgedExercise, Result

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
    """

    judged: JudgedExercise
    earned: float | None
    comments: tuple[str, ...] = ()
    history: tuple[str, ...] = ()
    waiting: tuple[str, ...] = ()
    is_by_hand: bool = False

    @classmethod
    def of(cls, judged: JudgedExercise, by_hand: Mapping[tuple[str, str], Mark] | None = None) -> Self:
        """Return an exercise with the marks by hand, {(exercise, quantity): mark}, of its student.

        The mark of a whole exercise counts more than those of its quantities.
        """
        by_hand = by_hand or {}
        whole = by_hand.get((judged.number, ""), _NONE)
        marks = {one.name: by_hand.get((judged.number, one.name), _NONE) for one in judged.answers}
        asked = sum(one.weight for one in judged.answers)
        sum_, comments, history, waiting = 0.0, [], [], []
        for one in judged.answers:
            mark, part = marks[one.name], earned(judged.points, one.weight, asked)
            if mark.points is not None:
                sum_ += mark.points
                was = f"{points(part if one.status == RIGHT else 0)} by the grader, "
                was = "" if one.status == WAITING else was
                history.append(f"{one.name}: {was}{_of(mark.points, part)} by hand{_quoted(mark)}")
            elif one.status == WAITING:
                waiting.append(one.name)
            else:
                sum_ += part if one.status == RIGHT else 0
            if mark.comment and mark.points is None:
                comments.append(f"{one.name}: {mark.comment}")
        if whole.points is not None:
            history.append(
                f"{_of(judged.earned, judged.points)} by the grader, {points(whole.points)} by hand{_quoted(whole)}"
            )
            return cls(judged, whole.points, tuple(comments), tuple(history), (), True)
        if whole.comment:
            comments.append(whole.comment)
        return cls(judged, None if waiting else sum_, tuple(comments), tuple(history), tuple(waiting))


@dataclass(frozen=True)
class Marked:
    """A result with what it counts.

    Attributes:
        result: of the grader.
        exercises: a `MarkedExercise` for each of the result's.
        late: how late it is and what that costs, in a sentence; empty where it is on time.
        deduction: what that costs, in points.
        comments: of the instructor on the whole of it.
        looks: why an instructor should see to it, in sentences, besides what the result says.
        by_hand: the points of the whole, where a person has marked it; nothing is deducted from these.
    """

    result: Result
    exercises: tuple[MarkedExercise, ...]
    late: str = ""
    deduction: float = 0
    comments: tuple[str, ...] = ()
    looks: tuple[str, ...] = ()
    by_hand: float | None = None

    @classmethod
    def of(
        cls,
        result: Result,
        by_hand: Mapping[tuple[str, str], Mark] | None = None,
        lateness: Lateness | None = None,
        looks: tuple[str, ...] = (),
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
        sum_ = sum(one.earned or 0 for one in exercises)
        comments = [whole.comment] if whole.comment and whole.points is None else []
        if whole.points is not None:
            said = f"{_of(sum_, result.points)} before, {points(whole.points)} by hand for all of it{_quoted(whole)}"
            comments.append(said)
        late = lateness.says
        if whole.points is not None and lateness.part:
            late += "; the points by hand for all of it stay as they are"
        deduction = 0.0 if whole.points is not None else lateness.part * sum_
        looks = (*looks, lateness.look) if lateness.look else looks
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


def _of(value, most):
    return f"{points(value)} of {points(most)} point{'' if most == 1 else 's'}"


def _quoted(mark):
    return f': "{mark.comment}"' if mark.comment else ""
