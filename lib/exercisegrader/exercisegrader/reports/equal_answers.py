"""Equal answers of students whose numbers differ: a sign that one was copied, and no proof."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from exercisebook.judging import MISTAKE, RIGHT, WRONG
from exercisegrader.reports.wording import answer_in_words

if TYPE_CHECKING:
    from exercisegrader.inside.plain import Plain
    from exercisegrader.results import Result

#: Equal wrong answers are a coincidence when they have fewer significant digits.
DIGITS = 3
#: A number, but not the one in a name such as S2.
_NUMBER = re.compile(r"(?<![\w.])((?:\d+\.?\d*|\.\d+))(?:[eE][+-]?\d+)?")


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

    They are those that are right for one student and not for another, whose key differs; and those that are wrong with
    at least three significant digits for several students, whose keys differ, unless a mistake explains it for
    all of them. Words and choices are never among them.

    Arguments:
        results: of submissions.
    """
    groups, order = {}, {}
    for result in results:
        for exercise in result.exercises:
            for verdict in exercise.answers:
                asked = exercise.number, verdict.name
                order.setdefault(asked, len(order))
                if verdict.status in (RIGHT, MISTAKE, WRONG) and (digits := significant_digits(verdict.answer)):
                    points = exercise.share(verdict)
                    group = groups.setdefault((asked, _one_form(verdict.answer)), (digits, points, []))
                    group[2].append((result.student, verdict))
    found = []
    for (asked, _), (digits, points, given) in groups.items():
        right = [(student, verdict.key) for student, verdict in given if verdict.status == RIGHT]
        others = [(student, verdict.key) for student, verdict in given if verdict.status != RIGHT]
        keys_of_right, keys_of_others = {key for _, key in right}, {key for _, key in others}
        crossed = any(key not in keys_of_right for key in keys_of_others) and bool(right)
        # the same mistake makes the same number, where it does not depend on those that differ
        is_explained = all(verdict.status in (RIGHT, MISTAKE) for _, verdict in given)
        shared = len(keys_of_others) > 1 and digits >= DIGITS and not is_explained
        if crossed or shared:
            answer = answer_in_words(given[0][1].answer)
            of = tuple(student for student, _ in right), tuple(student for student, _ in others)
            found.append(EqualAnswers(*asked, answer, points, *of))
    return sorted(found, key=lambda one: (order[one.number, one.name], one.answer))


def significant_digits(answer: Plain) -> int:
    """Return how many significant digits the longest number in an answer has; none where it is a word or a choice.

    >>> significant_digits(0.02340), significant_digits("2*exp(-3.25*s)"), significant_digits(["S2", "S4"])
    (3, 3, 0)
    >>> significant_digits(1500), significant_digits("reverse"), significant_digits({"-1.5": 2})
    (2, 0, 2)
    """
    if isinstance(answer, dict):
        return max(map(significant_digits, [*answer, *answer.values()]), default=0)
    if isinstance(answer, list):
        return max(map(significant_digits, answer), default=0)
    if answer is None or isinstance(answer, bool):
        return 0
    numbers = [Decimal(match[1]).normalize().as_tuple() for match in _NUMBER.finditer(str(answer))]
    return max((len(one.digits) for one in numbers), default=0)


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
