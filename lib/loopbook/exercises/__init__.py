"""Exercises that respond to answers.

>>> from loopbook.exercises import exercise
>>> len(exercise("10.1", student="Ada").statement) > 100
True
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from loopbook.exercises import bank
from loopbook.exercises.progress import Progress
from loopbook.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.exercises.question import Question

__all__ = ["ExerciseError", "exercise", "progress"]


class ExerciseError(Exception):
    """A wrong use of the exercises, in one sentence."""

    def _render_traceback_(self):
        """Notebooks show the sentence alone: the place in the library's code helps no reader."""
        return [f"{type(self).__name__}: {self}"]


def exercise(number: str, student: str | None = None) -> Question:
    """Return an exercise as a question: shown, it is the statement; ``.check(...)`` responds to answers.

    Arguments:
        number: chapter and place in it, as "10.3".
        student: a name, for numbers of one's own, the same every time; the reference variant if not given.
    Raises:
        ExerciseError: for an unknown number.
    """
    if not isinstance(number, str):
        raise ExerciseError(f"the exercise is {number!r}: expected chapter and place in it as text, such as '10.3'")
    known = bank.exercises(_chapter(number.partition(".")[0]))
    if number not in known:
        raise ExerciseError(f"there is no exercise {number!r}: {did_you_mean(number, known)}")
    try:
        return known[number].question(student)
    except (TypeError, ValueError) as error:
        raise ExerciseError(str(error)) from None


def progress(chapter: str | int, student: str | None = None) -> Progress:
    """Return which exercises of a chapter are right so far, as "10"; a file beside the notebook keeps it."""
    return Progress.of(bank.exercises(_chapter(str(chapter))).values(), student)


def _chapter(name):
    name = name.lstrip("0")
    if name not in bank.chapters():
        raise ExerciseError(f"there is no chapter {name!r} with exercises: {did_you_mean(name, bank.chapters())}")
    return name
