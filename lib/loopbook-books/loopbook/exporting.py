"""Exercises of the bank or of an assignment, in variants, for other systems."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from exercisebook.credit import NOTHING, Credit
from exercisebook.errors import ExerciseError
from exercisegrader import assignment
from loopbook.exercises.bank import BANK
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.question import Question

#: What names of chapters and exercises look like.
FORM = "expected a chapter as 10, or an exercise as 3.4"


@dataclass(frozen=True)
class Chosen:
    """What is exported.

    Attributes:
        title: of it all.
        numbers: of the exercises, in their order.
        question: returns the variant of an exercise for a text.
        credit: what is worth something though it is not right.
        is_assignment: whether the keys are nobody's but the instructor's.
    """

    title: str
    numbers: Sequence[str]
    question: Callable[[str, str], Question]
    credit: Credit = NOTHING
    is_assignment: bool = False

    def variants(self, count: int, follow: Callable[[int, int], None] = lambda *_: None) -> Iterator[list[Question]]:
        """Yield so many variants of each exercise; `follow` is told how many were before it, and of how many."""
        for done, number in enumerate(self.numbers):
            follow(done, len(self.numbers))
            yield [self.question(f"variant {k}", number) for k in range(1, count + 1)]


def chosen(names: Sequence[str]) -> Chosen:
    """Return the exercises that names stand for.

    Arguments:
        names: chapters of the bank and numbers of exercises, as "10" and "3.4"; all of the bank, if there is none; or
            a single file with an assignment.
    Raises:
        ExerciseError, GradingError: for what is none of these.

    >>> chosen(["9", "10.1"]).numbers[-2:]
    ['9.9', '10.1']
    """
    if any(Path(name).suffix in (".md", ".py") for name in names):
        if len(names) > 1:
            raise ExerciseError(f"there are {len(names)} names: expected a single assignment, or exercises of the bank")
        given = assignment.load(names[0])
        return Chosen(given.title, [*given.exercises], given.question, given.credit, True)
    known = {chapter: [*BANK.exercises(chapter)] for chapter in BANK.chapters()}
    known |= {number: [number] for numbers in [*known.values()] for number in numbers}
    for name in names:
        if name not in known:
            raise ExerciseError(f"there is no chapter or exercise {name!r}: {did_you_mean(name, known, FORM)}")
    numbers = [number for name in names or BANK.chapters() for number in known[name]]
    title = BANK.title(names[0]) if len(names) == 1 and "." not in names[0] else "Exercises in process control"
    return Chosen(title, list(dict.fromkeys(numbers)), lambda text, number: BANK.exercise(number, text))
