"""Equal answers of students whose numbers differ: a sign that one was copied, and no proof."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisebook.judging import MISTAKE, RIGHT, WRONG
from exercisegrader.reports.wording import answer_in_words

if TYPE_CHECKING:
    from exercisegrader.results import Result

#: A digit of a number, and not one in a name such as S2.
_NUMBER = re.compile(r"(?<![\w.])\.?\d")


@dataclass(frozen=True)
class EqualAnswers:
    """One answer to one quantity, given by several students whose keys differ.

    Attributes:
        number: of the exercise.
        name: of the quantity.
        answer: in words.
        points: that it brings where it is right.
        right, others: the ids of the students for whom it is right, and of those for whom it is not.
    """

    number: str
    name: str
    answer: str
    points: float
    right: tuple[str, ...]
    others: tuple[str, ...]


def equal_answers(results: Iterable[Result]) -> list[EqualAnswers]:
    """Return the equal answers that are worth a look, in the order of the exercises.

    They are those that are right for one student and not for another, whose key differs. Words and choices are never
    among them, and not what is wrong for all: it brings nobody anything, and the same mistake may make the same number.

    Arguments:
        results: of submissions.
    """
    groups, order = {}, {}
    for result in results:
        for exercise in result.exercises:
            for verdict in exercise.answers:
                asked = exercise.number, verdict.name
                order.setdefault(asked, len(order))
                if verdict.status in (RIGHT, MISTAKE, WRONG) and _NUMBER.search(str(verdict.answer)):
                    group = groups.setdefault((asked, _one_form(verdict.answer)), (exercise.share(verdict), []))
                    group[1].append((result.student, verdict))
    found = []
    for (asked, _), (points, given) in groups.items():
        right = [(student, verdict.key) for student, verdict in given if verdict.status == RIGHT]
        others = [(student, verdict.key) for student, verdict in given if verdict.status != RIGHT]
        if right and {key for _, key in others} - {key for _, key in right}:
            answer = answer_in_words(given[0][1].answer)
            of = tuple(student for student, _ in right), tuple(student for student, _ in others)
            found.append(EqualAnswers(*asked, answer, points, *of))
    return sorted(found, key=lambda one: (order[one.number, one.name], one.answer))


def _one_form(answer):
    """An answer in a form that is the same for the same numbers: 2, 2.0 and "2 "."""
    if isinstance(answer, dict):
        return frozenset((_one_form(name), _one_form(value)) for name, value in answer.items())
    if isinstance(answer, list):
        return tuple(_one_form(value) for value in answer)
    text = "".join(str(answer).split())
    try:
        return repr(float(text))
    except (ValueError, OverflowError):
        return text
