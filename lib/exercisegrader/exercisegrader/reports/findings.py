"""What the results of a class say: sums, hard exercises, common mistakes."""

from __future__ import annotations

import re
import statistics
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisebook.judging import MISTAKE, RIGHT, WAITING
from exercisegrader.reports.wording import STATUSES, verdict_and_reading
from exercisegrader.results import MISSING, NOT_RUN

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades

#: So many of the named mistakes are told.
MOST_MISTAKES = 15
#: A number in a sentence, but not the one in a name such as T_0.
_NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?!\w)")
#: Of fewer grades the mean and the median tell all.
FEWEST_QUARTERS = 8


@dataclass(frozen=True)
class Asked:
    """An asked quantity: how many answers have which status."""

    number: str
    name: str
    counts: Counter[str]

    @property
    def fraction(self) -> float | None:
        """The fraction of right answers; None where a person marks them."""
        return None if self.counts[WAITING] else self.counts[RIGHT] / self.counts.total()


@dataclass(frozen=True)
class Exercise:
    """An exercise with its mean points, None while somebody's wait for a mark."""

    number: str
    title: str
    points: float
    mean: float | None
    asked: tuple[Asked, ...]

    @property
    def fraction(self) -> float:
        """The mean as a fraction of the points."""
        return (self.mean or 0.0) / self.points if self.points else 0.0


class Findings:
    """What a summary tells of the points.

    Attributes:
        handed_in: the marks of those who handed something in.
        missing: the ids of those who did not, and `ungraded` of those without any result.
        counts: how many are missing, and so on, each with these words.
        late: the marks of those who were late or have an extension.
        points: of the assignment.
        sums: the points of those who have a grade, with their `mean`, `median` and the ends of the `middle` half.
        exercises: the hardest first.
        asked: their quantities, and `statuses` which the answers to these may have.
        mistakes: number of exercise, quantity, sentence and count, the most common first.
    """

    def __init__(self, grades: Grades):
        marks = grades.marks
        self.handed_in = [mark for mark in marks if mark.result.status != MISSING]
        self.missing: list[str] = [mark.result.student for mark in marks if mark.result.status == MISSING]
        graded = {mark.result.student for mark in marks}
        self.ungraded = [student.id for student in grades.students if student.id not in graded]
        not_run = sum(mark.result.status == NOT_RUN for mark in self.handed_in)
        waiting = sum(mark.total is None and mark.result.status != NOT_RUN for mark in self.handed_in)
        self.counts = [
            (len(self.missing), "missing"), (len(self.ungraded), "not graded yet"), (not_run, "not run"),
            (waiting, "waiting for a mark"),
        ]  # fmt: skip
        self.late = [mark for mark in marks if mark.late]
        self.points: float = max((mark.result.points for mark in marks), default=0)
        self.sums: list[float] = [mark.total for mark in marks if mark.total is not None]
        self.mean, self.median = (of(self.sums or [0.0]) for of in (statistics.fmean, statistics.median))
        run = [mark for mark in self.handed_in if mark.result.status != NOT_RUN]
        quarters = statistics.quantiles(self.sums) if len(self.sums) >= FEWEST_QUARTERS else []
        self.middle: list[float] = quarters[::2]
        self.exercises: list[Exercise] = _exercises(run)
        self.asked = [asked for one in self.exercises for asked in one.asked]
        self.statuses = [one for one in STATUSES if one != WAITING or any(each.counts[one] for each in self.asked)]
        self.mistakes: list[tuple[str, str, str, int]] = _mistakes([mark.result for mark in run])


def _exercises(marks):
    """The exercises, the hardest first; equal ones in their own order."""
    found = {}
    for mark in marks:
        for exercise in mark.exercises:
            found.setdefault(exercise.judged.number, []).append(exercise)
    exercises = []
    for number, given in found.items():
        counts = {}
        for exercise in given:
            for answer in exercise.judged.answers:
                counts.setdefault(answer.name, Counter(dict.fromkeys(STATUSES, 0)))[answer.status] += 1
        asked = tuple(Asked(number, name, count) for name, count in counts.items())
        earned, first = [exercise.earned for exercise in given], given[0].judged
        # on average those who wait would be left out, and those who left it open would not
        mean = None if None in earned else statistics.fmean(earned)
        exercises.append(Exercise(number, first.title, first.points, mean, asked))
    return sorted(exercises, key=lambda exercise: (exercise.mean is None, exercise.fraction))


def _mistakes(results):
    """The mistakes: one whose sentence names a student's own numbers is the same with those of another one."""
    sentences = {}
    for result in results:
        for exercise in result.exercises:
            for verdict in exercise.answers:
                if verdict.status == MISTAKE:
                    says, _ = verdict_and_reading(verdict)
                    kind = exercise.number, verdict.name, _NUMBER.sub("…", says)
                    sentences.setdefault(kind, []).append(says)
    most = sorted(sentences.items(), key=lambda item: (-len(item[1]), item[0]))[:MOST_MISTAKES]
    return [(*asked, says[0] if len(set(says)) == 1 else general, len(says)) for (*asked, general), says in most]
