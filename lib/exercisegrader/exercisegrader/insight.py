"""What a class tells: how hard each question is, for whom, and when; mistakes that no page knows; whose numbers.

All of it is made of results that are there, or of the progress that readers of the pages save. A mistake is proposed
where one slip explains different wrong numbers of several students, more than would by chance: each has numbers of her
own, so that what a slip gives with the numbers of the others says what chance does.
"""

from __future__ import annotations

import datetime
import itertools
import json
import math
import re
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from exercisebook.diagnoses.background import follows
from exercisebook.diagnoses.numbers import WIDEST, are_recognised, half_units, is_recognised, rounded
from exercisebook.errors import ExerciseError
from exercisebook.forms import Sheet
from exercisebook.grammar import Unreadable
from exercisebook.judging import MISTAKE, WAITING, WRONG, harmless
from exercisebook.kinds import Number
from exercisebook.pages.columns import Columns
from exercisebook.pages.page import Page
from exercisebook.pages.slips import line, slips
from exercisebook.parameters import written
from exercisebook.question import Question
from exercisegrader import GradingError, tables
from exercisegrader.assignment import Assignment
from exercisegrader.judge import judged
from exercisegrader.released import Released
from exercisegrader.results import MISSING, NOT_RUN, JudgedExercise, Results
from exercisegrader.student import Student, in_short

#: A mistake is one of so many students with as many different numbers, and chance makes it with this probability.
FEWEST, CHANCE = 3, 0.01
#: What a slip gives with the numbers of so many others is compared, too.
OTHERS = 16
#: So many slips of a question are tried, for so long of the processor's time; the plainer ones come first.
MOST, SECONDS = 80_000, 20
#: Around the value of a slip, within this factor, other answers tell how dense they lie there.
_AROUND = 1.5
#: A question is harder for some numbers where chance says so with this probability.
HARDER = 0.05
#: Of fewer students nothing is told but the mean.
FEW = 10
#: A larger file is no progress that a page has saved.
_LARGEST = 1_000_000
_FOLLOWS = follows("").partition(" for ,")[0]
_POSTED = re.compile(r"(?:([^\W\d]\w*)\s*=\s*)?(?<![\w.])([-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)")


@dataclass(frozen=True)
class Attempt:
    """What somebody has answered in one exercise.

    Attributes:
        student: id, or the name of a file.
        judged: the answers with their verdicts.
        question: in the student's numbers.
        attempts, hints: how many there were, where a page has counted them.
    """

    student: str
    judged: JudgedExercise
    question: Question
    attempts: int = 0
    hints: int = 0


def of_results(assignment: Assignment, folder: Path, students: Sequence[Student]) -> list[Attempt]:
    """Return what those who handed in have answered.

    Arguments:
        assignment: `Assignment`.
        folder: of the grades.
        students: the roster.
    Raises:
        GradingError: where the results or the record are not those of the assignment.
    """
    released, results = Released.of(assignment), Results(folder / "results", assignment.secret)
    found = []
    for student in released.identified(students)[0]:
        result = results.of(student.id)
        if result and result.status not in (MISSING, NOT_RUN):
            for one in result.exercises:
                if one.number in assignment.exercises:
                    values = released.values(student.id, one.number)
                    found.append(Attempt(student.id, one, assignment.question(student.id, one.number, values)))
    return found


def of_progress(assignment: Assignment, folder: Path) -> tuple[list[Attempt], list[str]]:
    """Return what volunteers have answered in the pages, by the files that these saved, and what could not be read.

    Arguments:
        assignment: with exercises of the pages, ``EXERCISES = [exercise("7.1")]``.
        folder: with the files, loopbook-progress.json under any names.
    """
    found, remarks = [], []
    for path in sorted(folder.glob("*.json")):
        try:
            if path.stat().st_size > _LARGEST:
                raise ValueError
            for key, one in dict(json.loads(path.read_text(encoding="utf-8-sig"))["tried"]).items():
                number, _, name = key.partition(" ")
                if number in assignment.exercises:
                    question = assignment.exercises[number].question(name or None)
                    answers = judged(question, Sheet(question).given(one["answers"]))
                    found.append(Attempt(path.stem, answers, question, int(one["attempts"]), int(one["hints"])))
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError, ExerciseError):
            remarks.append(f"{path.name} holds no progress that can be read: expected a file that a page has saved")
    return found, remarks


# -------------------------------------------------------------------------------------------------------- questions


@dataclass
class Item:
    """An asked quantity, as a class answers it.

    Attributes:
        number, name: of exercise and quantity.
        parts: {student: part of its points}.
        discrimination: the correlation with all the rest; None for too few, or where nothing differs.
        says: for which numbers it is harder, in sentences.
    """

    number: str
    name: str
    parts: dict[str, float]
    discrimination: float | None = None
    says: list[str] = field(default_factory=list)

    @property
    def mean(self) -> float:
        """The mean part of its points."""
        return float(np.mean([*self.parts.values()]))

    @property
    def is_few(self) -> bool:
        """Whether there are too few answers, or too few wrong ones, to tell more than the mean."""
        return len(self.parts) < FEW or sum(part < 1 for part in self.parts.values()) < FEWEST


def items(attempts: Sequence[Attempt]) -> list[Item]:
    """Return the questions that the grader has judged, in their order, with what is told of them."""
    parts: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
    for one in attempts:
        for answer in one.judged.answers:
            if answer.status != WAITING:
                parts[one.judged.number, answer.name][one.student] = answer.part
    found = [Item(*place, of) for place, of in parts.items()]
    sums: dict[str, float] = defaultdict(float)
    for item in found:
        for student, part in item.parts.items():
            sums[student] += part
    questions = {(one.student, one.judged.number): one.question for one in attempts}
    tests = sum(len(questions[next(iter(item.parts)), item.number].values) for item in found)
    for item in found:
        own = np.array([*item.parts.values()])
        rest = np.array([sums[student] for student in item.parts]) - own
        if item.is_few:
            continue
        if np.ptp(own) and np.ptp(rest):
            item.discrimination = float(np.corrcoef(own, rest)[0, 1])
        values = [questions[student, item.number].values for student in item.parts]
        for name in values[0]:
            item.says += _harder(name, [one.get(name) for one in values], own, HARDER / tests)
    return found


def _harder(name: str, values: Sequence[Any], parts: np.ndarray, chance: float) -> Iterator[str]:
    """Yield for which values of a parameter a question is harder, where it is so by more than chance."""
    groups: dict[str, list[float]] = {}
    if all(isinstance(one, str) for one in values):
        words = [f"'{one}'" for one in values]
    elif any(one is None or isinstance(one, str) for one in values):
        return
    else:
        middle = float(np.median([float(one) for one in values]))
        words = [f"above {middle:g}" if one > middle else f"up to {middle:g}" for one in values]
    for word, part in zip(words, parts, strict=True):
        groups.setdefault(word, []).append(part)
    if len(groups) > 1 and np.ptp(parts) and stats.kruskal(*groups.values()).pvalue <= chance:
        shown = sorted(groups.items(), reverse=True)
        each = [f"{100 * np.mean(of):.0f} % for {word} ({len(of)})" for word, of in shown]
        yield f"differs with {name}: {', '.join(each)}"


def by_day(attempts: Sequence[Attempt], at: Mapping[str, datetime.datetime | None]) -> list[tuple[str, int, float]]:
    """Return for each day on which somebody handed in how many did, and their mean part of the points."""
    earned: dict[str, list[JudgedExercise]] = defaultdict(list)
    for one in attempts:
        earned[one.student].append(one.judged)
    days: dict[str, list[float]] = defaultdict(list)
    for student, exercises in earned.items():
        if when := at.get(student):
            points = sum(one.points for one in exercises)
            days[when.date().isoformat()].append(sum(one.earned for one in exercises) / points)
    return [(day, len(parts), float(np.mean(parts))) for day, parts in sorted(days.items())]


# --------------------------------------------------------------------------------------------------------- mistakes


@dataclass(frozen=True)
class Proposal:
    """A mistake that several have made and no page knows.

    Attributes:
        number, name: of exercise and quantity.
        line: the change, as the section Mistakes of a page has it.
        numbers: {student: number that it explains}.
        wrong: how many wrong numbers nothing else explains.
    """

    number: str
    name: str
    line: str
    numbers: Mapping[str, float]
    wrong: int

    def __str__(self) -> str:
        shown = in_short([f"{student} {number:g}" for student, number in self.numbers.items()])
        return f"- `{self.line}` …\n  ({self.number} {self.name}: {len(self.numbers)} of {self.wrong} wrong, {shown})"


def mined(
    attempts: Sequence[Attempt], follow: Callable[[int, int], object] = lambda done, total: None
) -> list[Proposal]:
    """Return the mistakes that explain different wrong numbers of several students and that their pages do not know.

    Exercises that are no pages have no formulas and are left out, and so are answers that are no single number.

    Arguments:
        attempts: of a class.
        follow: is called with how many questions are looked at, and how many there are.
    """
    places: dict[tuple[str, str], list[tuple[Attempt, float]]] = defaultdict(list)
    everybody: dict[str, list[Question]] = defaultdict(list)
    for one in attempts:
        everybody[one.judged.number].append(one.question)
        for name, number in _unexplained(one):
            places[one.judged.number, name].append((one, number))
    places = {place: wrong for place, wrong in places.items() if _are_several(number for _, number in wrong)}
    found = []
    for done, ((number, name), wrong) in enumerate(places.items(), start=1):
        found += _mined(number, name, wrong, everybody[number], CHANCE / len(places))
        follow(done, len(places))
    return found


def _are_several(numbers):
    return len({f"{number:.4g}" for number in numbers}) >= FEWEST


def _unexplained(attempt: Attempt) -> Iterator[tuple[str, float]]:
    """The wrong numbers that the page does not explain, and that are none of the question."""
    question = attempt.question
    if not isinstance(question.exercise, Page):
        return
    copied = [amount.value for amount in question.background.givens]
    copied += [kind.key for kind in question.key.values() if type(kind) is Number]
    for answer in attempt.judged.answers:
        kind = question.key.get(answer.name)
        if type(kind) is not Number or answer.status not in (WRONG, MISTAKE) or answer.says.startswith(_FOLLOWS):
            continue
        try:
            number = kind.read(answer.answer)[0]
        except Unreadable:
            continue
        known = any(kind.is_value(number, wrong) for _, wrong in question.mistakes[answer.name])
        if not known and math.isfinite(number) and not any(is_recognised(number, one) for one in copied):
            yield answer.name, number


def _mined(number, name, wrong, everybody, chance):
    """The mistakes in one quantity, the surest first, each without the answers that those before it explain."""
    exercise, kinds = wrong[0][0].question.exercise, [one.question.key[name] for one, _ in wrong]
    others = everybody[:: max(1, len(everybody) // OTHERS)]
    columns = Columns(exercise, [one.values for one in (*(one.question for one, _ in wrong), *others)])
    key, numbers = np.array([kind.key for kind in kinds]), np.array([number for _, number in wrong])
    within = np.maximum([kind.within for kind in kinds], WIDEST) * np.abs(key)
    if name not in columns.numbers or not np.allclose(columns.right[name][: len(wrong)], key, rtol=1e-9):
        return
    halves, tried, found, began = half_units(numbers), set(), [], time.process_time()
    factors = [text for text, times in Counter(f"{ratio:.2g}" for ratio in numbers / key).items() if times >= FEWEST]
    for count, slip in enumerate(itertools.islice(slips(exercise, name, columns.numbers, factors), MOST)):
        if count % 50 == 0 and time.process_time() - began > SECONDS:
            break
        values = columns.by(slip, name)
        own = np.where(np.abs(values[: len(wrong)] - key) > within, values[: len(wrong)], math.nan)
        with np.errstate(over="ignore"):
            tried.add(own.astype(np.float32).tobytes())
        hits = are_recognised(numbers, halves, own)
        if np.count_nonzero(hits) >= FEWEST and _are_several(numbers[hits]):
            found.append((slip, hits, _by_chance(numbers, halves, own, values[len(wrong) :], hits)))
    left = np.ones(len(wrong), bool)
    while True:
        sure = [
            (stats.binom.sf(np.sum(hits & left) - 1, np.sum(left), by_chance), place)
            for place, (_, hits, by_chance) in enumerate(found)
            if _are_several(numbers[hits & left])
        ]
        p, place = min(sure, default=(1, None))
        if p > chance / len(tried):
            return
        slip, hits, _ = found[place]
        explained = {one.student: number for (one, number), is_hit in zip(wrong, hits & left, strict=True) if is_hit}
        yield Proposal(number, name, line(slip), explained, int(np.sum(left)))
        left &= ~hits


def _by_chance(numbers, halves, own, others, hits):
    """How likely a wrong number is the value of a slip by chance: of the others' numbers, and by those around it."""
    strange = np.abs(others - own[:, None]) > 0.01 * np.abs(own[:, None])
    of_others = (0.5 + np.sum(are_recognised(numbers[:, None], halves[:, None], others) & strange)) / (
        1 + np.sum(strange)
    )
    with np.errstate(all="ignore"):
        near = np.sum(np.abs(np.log(numbers / own)) < math.log(_AROUND)) - np.sum(hits)
    return min(1.0, max(of_others, (0.5 + max(near, 0)) / len(numbers) * WIDEST / math.log(_AROUND)))


# ------------------------------------------------------------------------------------------------------------ whose


def whose(assignment: Assignment, posted: str) -> list[tuple[str, str, str]]:
    """Return whose numbers were posted: id and name of all whom they fit, and the numbers of the exercise in words.

    Arguments:
        assignment: whose record says which numbers each was given.
        posted: a text with numbers, with or without their names, as "K=2.4, T=31"; right answers are numbers, too.
    Raises:
        GradingError: for a text without numbers, and without a record.
    """
    said = [(name, float(number.replace(",", "."))) for name, number in _POSTED.findall(posted)]
    if not said:
        raise GradingError(f"{harmless(posted)!r} has no number: expected numbers as K=2.4, T=31")
    released = Released.of(assignment)
    if not released.holders:
        raise GradingError(f"there is no record of a release of {assignment.name}: nobody has numbers yet")
    found = []
    for holder in released.holders.values():
        for number in filter(assignment.exercises.__contains__, holder.numbers):
            question = assignment.question(holder.id, number, holder.numbers[number])
            own = {name: float(value) for name, value in question.values.items() if not isinstance(value, str)}
            own |= {name: kind.key for name, kind in question.key.items() if type(kind) is Number}
            if all(any(name in ("", one) and _is_same(said, its) for one, its in own.items()) for name, said in said):
                units = {name: one.unit for name, one in question.exercise.parameters.items()}
                given = ", ".join(f"{name} = {written(question.values[name], units[name])}" for name in units)
                found.append((holder.id, holder.called, f"exercise {number}, {given}"))
    return found


def _is_same(said, own):
    return abs(said - own) <= 1e-9 * abs(own) or rounded(said, own)


# ----------------------------------------------------------------------------------------------------------- report


def report(
    attempts: Sequence[Attempt], days: Sequence[tuple[str, int, float]], proposals: Sequence[Proposal]
) -> tuple[str, str]:
    """Return what a class tells as a text, and as comma-separated values."""
    rows = [["exercise", "quantity", "answered", "mean", "discrimination", "attempts", "hints", "remark"]]
    lines = [f"{len({one.student for one in attempts})} students", f"{'question':24} mean  discrimination"]
    for item in items(attempts):
        own = [one for one in attempts if one.judged.number == item.number]
        tries, hints = (f"{np.mean(numbers):.2g}" if any(numbers) else ""
                        for numbers in ([one.attempts for one in own], [one.hints for one in own]))  # fmt: skip
        with_rest = f"{item.discrimination:.2f}" if item.discrimination is not None else "too few" * item.is_few
        share, remark = f"{item.mean:.2f}", "; ".join(item.says)
        rows.append([item.number, item.name, str(len(item.parts)), share, with_rest, tries, hints, remark])
        lines.append(f"{f'{item.number} {item.name}':24} {100 * item.mean:3.0f} %  {with_rest:>7}  {remark}".rstrip())
    for day, count, mean in days:
        rows.append(["", "", str(count), f"{mean:.2f}", "", "", "", f"handed in on {day}"])
    if days:
        lines += ["", "Handed in: " + ", ".join(f"{day} {n}, {100 * mean:.0f} %" for day, n, mean in days)]
    for one in proposals:
        rows.append([one.number, one.name, str(len(one.numbers)), "", "", "", "", f"propose: {one.line}"])
    if proposals:
        lines += ["", "Mistakes that explain several wrong numbers; with a sentence they are lines of the page:"]
        lines += map(str, proposals)
    return "\n".join(lines), tables.as_text(rows, bom=True)
