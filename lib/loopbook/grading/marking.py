"""Marks: what a result counts, which the reports show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from loopbook.grading.results import MISSING, NOT_RUN, JudgedExercise, Result


@dataclass(frozen=True)
class MarkedExercise:
    """An exercise with what it counts.

    Attributes:
        judged: as the grader judged it.
        earned: its points; None while something in it waits for a person.
        comments, history: of the instructor, in sentences.
    """

    judged: JudgedExercise
    earned: float | None
    comments: tuple[str, ...] = ()
    history: tuple[str, ...] = ()


@dataclass(frozen=True)
class Marked:
    """A result with what it counts.

    Attributes:
        result: of the grader.
        exercises: a `MarkedExercise` for each of the result's.
        late: how late it is and what that costs, in a sentence; empty where it is on time.
        deduction: what that costs, in points.
        comments: of the instructor on the whole of it.
    """

    result: Result
    exercises: tuple[MarkedExercise, ...]
    late: str = ""
    deduction: float = 0
    comments: tuple[str, ...] = ()

    @classmethod
    def of(cls, result: Result) -> Self:
        """Return a result as the grader judged it, with nothing added."""
        return cls(result, tuple(MarkedExercise(one, one.earned) for one in result.exercises))

    @property
    def waiting(self) -> tuple[tuple[str, str], ...]:
        """Pairs of the number of an exercise and a quantity that wait for a person."""
        return ()

    @property
    def total(self) -> float | None:
        """The points; None, an empty cell, where nothing was handed in or run, and while something waits."""
        if self.result.status in (MISSING, NOT_RUN) or any(one.earned is None for one in self.exercises):
            return None
        return max(0.0, sum(one.earned or 0 for one in self.exercises) - self.deduction)
