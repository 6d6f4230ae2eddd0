"""Exercises that respond to answers.

>>> from loopbook.exercises import exercise
>>> len(exercise("10.1", student="Ada").statement) > 100
True
"""

from __future__ import annotations

from types import EllipsisType
from typing import TYPE_CHECKING

from loopbook.exercises import bank, naming, slips
from loopbook.exercises.errors import ExerciseError
from loopbook.exercises.progress import Collection, Progress
from loopbook.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.exercises.question import Question

__all__ = ["ExerciseError", "exercise", "progress", "student"]

slips.install()


def exercise(number: str, student: str | None = None) -> Question:
    """Return an exercise as a question: shown, it is the statement; ``.check(...)`` responds to answers.

    Arguments:
        number: chapter and place in it, as "10.3".
        student: a name, for numbers of one's own, the same every time. If not given, it is the name that
            `student` keeps, and without one the variant is the reference.
    Raises:
        ExerciseError: for an unknown number.
    """
    if not isinstance(number, str):
        raise ExerciseError(f"the exercise is {number!r}: expected chapter and place in it as text, such as '10.3'")
    known = bank.exercises(_chapter(number.partition(".")[0]))
    if number not in known:
        raise ExerciseError(f"there is no exercise {number!r}: {did_you_mean(number, known)}")
    try:
        return known[number].question(naming.known() if student is None else student)
    except (TypeError, ValueError) as error:
        raise ExerciseError(str(error)) from None


def progress(chapter: str | int | None = None, student: str | None = None) -> Progress | Collection:
    """Return which exercises are right so far; a file beside the notebook keeps it.

    Arguments:
        chapter: as "10"; all chapters if not given.
        student: whose progress, in numbers of one's own. If not given, that of the name that `student` keeps.

    >>> progress("10").right
    0
    """
    name = naming.known() if student is None else student
    if chapter is not None:
        return Progress.of(bank.exercises(_chapter(str(chapter))).values(), name)
    return Collection(
        tuple(
            (bank.title(one), module.removeprefix("ch"), Progress.of(bank.exercises(one).values(), name))
            for one, module in bank.chapters().items()
        )
    )


def student(name: str | EllipsisType | None = ...) -> naming.Student:
    """Say a name once: from then on the exercises beside this notebook have numbers of one's own.

    A small file beside the progress keeps the name. An exercise that is asked for with another ``student`` has the
    numbers of that one.

    Arguments:
        name: as "Mira"; None forgets the name. Without one, or with dots in its place, all stays as it is.
    Raises:
        ExerciseError: for what is no name.

    >>> student("")
    Traceback (most recent call last):
    loopbook.exercises.errors.ExerciseError: student is an empty text: expected a name, as in student('Mira')
    """
    try:
        if name is None:
            naming.forget()
        elif name is not ...:
            naming.keep(name)
    except (OSError, ValueError) as error:
        raise ExerciseError(str(error)) from None
    return naming.Student(naming.known())


def _chapter(name):
    name = name.lstrip("0")
    if name not in bank.chapters():
        raise ExerciseError(f"there is no chapter {name!r} with exercises: {did_you_mean(name, bank.chapters())}")
    return name
