"""What the results of a class say: sums, hard exercises, common mistakes, submissions that need a look."""

from __future__ import annotations

import re
import statistics
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from loopbook.exercises.judging import MISTAKE, RIGHT, UNJUDGED
from loopbook.grading.reports.equal_answers import equal_answers
from loopbook.grading.reports.wording import STATUSES, answer_in_words, explained, remarks, without_jail

if TYPE_CHECKING:
    from loopbook.grading.marking import Marked
    from loopbook.grading.roster import Student

#: So many of the named mistakes are told.
MOST_MISTAKES = 15
#: A number in a sentence, but not the one in a name such as T_0.
_NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?!\w)")
#: Into at most so many steps the points are divided.
MOST_STEPS = 12


@dataclass(frozen=True)
class Asked:
    """An asked quantity: how many answers have which status."""

    number: str
    name: str
    counts: Counter[str]

    @property
    def fraction(self) -> float:
        """The fraction of right answers."""
        return self.counts[RIGHT] / self.counts.total()


@dataclass(frozen=True)
class Exercise:
    """An exercise with its mean points."""

    number: str
    title: str
    points: float
    mean: float
    asked: tuple[Asked, ...]

    @property
    def fraction(self) -> float:
        """The mean as a fraction of the points."""
        return self.mean / self.points if self.points else 0.0


class Findings:
    """All that a summary tells.

    Arguments:
        students: the roster.
        marks: a `Marked` for each submission.
        complaints: sentences on what was handed in and could not be assigned to a student.

    Attributes:
        handed_in: the results of those who handed something in; means are over those of them that count.
        missing: the ids of those who did not, and `ungraded` of those without any result.
        looks: pairs of an id and the reasons why somebody should look at the submission.
        mistakes: number of exercise, quantity, sentence and count, the most common first.
        equal: equal answers where the keys differ.
        unjudged: number of exercise, quantity, id, answer in words and sentence of each answer that was not judged.
    """

    def __init__(self, students: Sequence[Student], marks: Collection[Marked], complaints: Iterable[object] = ()):
        results = [mark.result for mark in marks]
        self.names = {student.id: student.name for student in students}
        self.complaints = tuple(map(str, complaints))
        self.no_jail = without_jail(results)
        self.handed_in = [result for result in results if result.status != "missing"]
        self.missing: list[str] = [result.student for result in results if result.status == "missing"]
        graded = {result.student for result in results}
        self.ungraded = [student.id for student in students if student.id not in graded]
        self.points: float = max((result.points for result in results), default=0)
        self.sums: list[float] = [mark.total for mark in marks if mark.total is not None]
        self.looks: list[tuple[str, list[str]]] = [
            (result.student, reasons) for result in self.handed_in if (reasons := _reasons(result))
        ]
        self.exercises: list[Exercise] = _exercises(self.handed_in)
        self.mistakes: list[tuple[str, str, str, int]] = _mistakes(self.handed_in)
        self.equal = equal_answers(self.handed_in)
        self.unjudged: list[tuple[str, str, str, str, str]] = _unjudged(self.handed_in)

    def name(self, student: str) -> str:
        """The name of a student, by the id."""
        return self.names.get(student, student)

    @property
    def mean(self) -> float:
        """The mean of the sums."""
        return statistics.fmean(self.sums)

    @property
    def median(self) -> float:
        """The median of the sums."""
        return statistics.median(self.sums)

    @property
    def steps(self) -> list[tuple[float, float, int]]:
        """The distribution: triples of lower end, upper end and how many sums are from the one up to below the other.

        The last step holds the full points too.
        """
        width = _width(self.points)
        count = max(1, -int(-self.points // width))
        # rounding: three thirds of a point are one
        places = Counter(min(count - 1, int(round(earned / width, 9))) for earned in self.sums)
        return [(k * width, min((k + 1) * width, self.points), places[k]) for k in range(count)]


def _width(points):
    """The width of a step, a round number.

    >>> _width(10), _width(24), _width(100)
    (1, 2, 10)
    """
    scale = 0.001
    while scale < 1e9:
        for step in (1, 2, 5):
            width = round(step * scale, 3)
            if width * MOST_STEPS >= points:
                return int(width) if width == int(width) else width
        scale *= 10
    return points


def _reasons(result):
    return [*result.looks, *remarks(result)]


def _exercises(results):
    """The exercises, the hardest first; equal ones in their own order."""
    found = {}
    for result in results:
        for exercise in result.exercises:
            found.setdefault(exercise.number, []).append(exercise)
    exercises = []
    for number, given in found.items():
        counts = {}
        for exercise in given:
            for verdict in exercise.answers:
                counts.setdefault(verdict.name, Counter(dict.fromkeys(STATUSES, 0)))[verdict.status] += 1
        asked = tuple(Asked(number, name, count) for name, count in counts.items())
        mean = statistics.fmean(exercise.earned for exercise in given)
        exercises.append(Exercise(number, given[0].title, given[0].points, mean, asked))
    return sorted(exercises, key=lambda exercise: exercise.fraction)


def _unjudged(results):
    """The answers that were not judged, in the order of the exercises."""
    found, order = [], {}
    for result in results:
        for exercise in result.exercises:
            for verdict in exercise.answers:
                asked = exercise.number, verdict.name
                place = order.setdefault(asked, len(order))
                if verdict.status == UNJUDGED:
                    answer = answer_in_words(verdict.answer)
                    found.append((place, (*asked, result.student, answer, explained(verdict))))
    return [one for _, one in sorted(found, key=lambda pair: pair[0])]


def _mistakes(results):
    """The mistakes: one whose sentence names a student's own numbers is the same with those of another one."""
    sentences = {}
    for result in results:
        for exercise in result.exercises:
            for verdict in exercise.answers:
                if verdict.status == MISTAKE:
                    kind = exercise.number, verdict.name, _NUMBER.sub("…", verdict.says)
                    sentences.setdefault(kind, []).append(verdict.says)
    most = sorted(sentences.items(), key=lambda item: (-len(item[1]), item[0]))[:MOST_MISTAKES]
    return [(*asked, says[0] if len(set(says)) == 1 else general, len(says)) for (*asked, general), says in most]
