"""Trying an assignment before it is released: what in it would surprise a student, or an instructor.

Each exercise is answered as a class might: with its key in many forms, with its declared mistakes, with the key of
another student, and with answers that should be wrong; over many variants, in bounded time. An answer takes the way
of a student's: from objects of Python to plain data, and from there to the judge. `checks` has what is checked.
"""

from __future__ import annotations

import dataclasses
import itertools
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter, process_time
from typing import TYPE_CHECKING

from exercisebook.grammar import listed, shortened
from exercisebook.parameters import written
from exercisebook.timeout import limited
from exercisegrader import GradingError
from exercisegrader.release import asked
from exercisegrader.trial.checks import LEVELS, NOTE, ODD, OF_ALL, OF_ONE, WRONG, Seen, Variant, in_short
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisegrader.assignment import Assignment

__all__ = [
    "LEVELS", "NOTE", "ODD", "WRONG", "Surprise", "Trial", "Variant", "as_text", "ids", "one_variant",
    "only", "report", "try_all",
]  # fmt: skip

#: What an exercise may take (s), and the functions of its author for one variant.
PATIENCE, PATIENCE_WITH_KEY = 20.0, 10.0
LONGEST_PROBLEM = 300


@dataclass(frozen=True)
class Surprise:
    """Something that would surprise: how bad it is, a sentence, and with whose variant and which answer to see it."""

    level: str
    says: str
    student: str = ""
    example: str = ""


@dataclass(frozen=True)
class Trial:
    """What came of trying an exercise.

    Attributes:
        variants: how many were tried.
        surprises: the worst one first.
        lacks: what the exercise does without, some of "hints" and "a solution".
    """

    number: str
    title: str
    variants: int
    surprises: tuple[Surprise, ...]
    lacks: tuple[str, ...] = ()

    @property
    def level(self) -> str:
        """The level of the worst surprise; empty where there is none."""
        return self.surprises[0].level if self.surprises else ""


def try_all(
    assignment: Assignment,
    students: Sequence[str],
    seconds: float = PATIENCE,
    follow: Callable[[int], object] = lambda variants: None,
) -> Iterator[Trial]:
    """Yield the `Trial` of each exercise.

    Arguments:
        assignment: `Assignment`; its functions run in this process.
        students: their ids, a variant each.
        seconds: what an exercise may take; what was tried until then counts.
        follow: is told how many variants are done, of all exercises together.

    >>> from exercisegrader.assignment import Assignment
    >>> text = '''"Springs"
    ... SECRET = "a secret of many letters"
    ... from exercisebook.authoring import answers, between, exercise, number
    ... @exercise("1", title="A spring")
    ... def spring(k=between(100, 900, "N/m"), x=between(2, 9, "cm")):
    ...     "A spring of {k} is {x} longer than at rest. How large is the force in it?"
    ...     return answers(F=number(k * x / 100, "N", "the force"))
    ... '''
    >>> first = next(try_all(Assignment.of(text, "springs"), ["s1", "s2"]))
    >>> first.number, first.variants, first.level
    ('1', 2, '')
    """
    done = 0
    for number in assignment.exercises:
        attempt = _Attempt(assignment, number)
        for place, student in enumerate(students):
            if not attempt.is_made(place, student, seconds, len(students)):
                break
            follow(done + place + 1)
        yield attempt.trial(students[0])
        done += len(students)
        follow(done)


class _Attempt:
    """An exercise that is being tried: the variants so far, and what was seen in them, how often and where first."""

    def __init__(self, assignment, number):
        self.assignment, self.number, self.exercise = assignment, number, assignment.exercises[number]
        self.variants, self.asked, self.begin = [], 0, perf_counter()
        self.counts, self.first = Counter(), {}

    def is_made(self, place, student, seconds, many):
        """Try a variant; whether there was time for it."""
        if place and perf_counter() - self.begin > seconds:
            says = f"only {place} of {many} variants were tried in {seconds:g} s: --seconds allows more"
            self.note(Seen(NOTE, says))
            return False
        self.asked += 1
        begin = process_time()
        try:
            question = limited(PATIENCE_WITH_KEY, self.complete, student)
        except TimeoutError:
            self.note(Seen(WRONG, f"the key takes longer than {PATIENCE_WITH_KEY:g} s"), student)
        except Exception as problem:  # the functions are the author's
            # the values of the variant are in the sentence, between "for" and a colon
            what = re.sub(r" (?:for|of \w+ for student) [^:]*(?=:)", "", str(problem), count=1)
            self.note(Seen(WRONG, shortened(what, LONGEST_PROBLEM)), student)
        else:
            self.variants.append(Variant(student, place, question, process_time() - begin, self.assignment.credit))
            for seen in itertools.chain.from_iterable(check(self.variants[-1]) for check in OF_ONE):
                self.note(seen, student)
        return True

    def complete(self, student):
        question = self.assignment.question(student, self.number)
        question.key, question.mistakes, question.background  # noqa: B018 - they are worked out once, and may fail
        return question

    def note(self, seen, student=""):
        self.counts[seen.level, seen.says] += 1
        self.first.setdefault((seen.level, seen.says), (student, seen))

    def trial(self, student):
        """What came of it, with what all variants together show, and what else would stop a release."""
        if self.variants:
            for seen in itertools.chain.from_iterable(check(self.variants) for check in OF_ALL):
                self.note(seen)
        if self.variants and not any(level == WRONG for level, _ in self.counts):
            try:
                asked(self.assignment, student, self.number)
            except GradingError as problem:
                self.note(Seen(WRONG, shortened(str(problem), LONGEST_PROBLEM)), student)
        lacks = {"hints": self.exercise.rungs, "a solution": self.exercise.worked}
        missing = tuple(name for name, what in lacks.items() if not what)
        return Trial(self.number, self.exercise.title, self.asked, self.surprises(), missing)

    def surprises(self):
        """What was seen often enough, the worst first, and of that what was seen most often."""
        made = []
        for (level, says), count in self.counts.items():
            student, seen = self.first[level, says]
            if count >= seen.least * self.asked:
                if student and self.asked > 1:
                    says += f", in {'all' if count >= self.asked else f'{count} of'} {self.asked} variants"
                made.append((LEVELS.index(level), -count, Surprise(level, says, student, seen.example)))
        return tuple(surprise for *_, surprise in sorted(made, key=lambda one: one[:2]))


def ids(known: Sequence[str], count: int) -> list[str]:
    """Return ids for so many variants: those of a class first, and then others, s0001, s0002, ...

    >>> ids(["ada", "s0002"], 4)
    ['ada', 's0002', 's0001', 's0003']
    """
    made = (f"s{number:04}" for number in range(1, len(known) + count + 1))
    return [*dict.fromkeys([*known, *made])][:count]


def only(assignment: Assignment, numbers: Collection[str]) -> Assignment:
    """Return an assignment with some of its exercises; with all, where none is named. Raises GradingError."""
    for number in numbers:
        if number not in assignment.exercises:
            hint = did_you_mean(number, assignment.exercises)
            raise GradingError(f"there is no exercise {number!r} in {assignment.name}: {hint}")
    chosen = {number: one for number, one in assignment.exercises.items() if not numbers or number in numbers}
    return dataclasses.replace(assignment, exercises=chosen)


def report(trials: Sequence[Trial]) -> str:
    """Return what came of trying an assignment, as lines: the exercises with the worst surprises first."""
    order = sorted(trials, key=lambda one: LEVELS.index(one.level) if one.level else len(LEVELS))
    lines = [as_text(trial) for trial in order if trial.surprises]
    fine = [trial.number for trial in trials if trial.level not in (WRONG, ODD)]
    if fine:
        lines.append("nothing surprising" + (f" in {listed(fine)}" if len(fine) < len(trials) else ""))
    lacking: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for trial in trials:
        lacking[trial.lacks].append(trial.number)
    lines += [f"without {listed(what)}: {listed(numbers)}" for what, numbers in lacking.items() if what]
    return "\n".join([*lines, f"{min(trial.variants for trial in trials)} variants of each exercise were tried"])


def as_text(trial: Trial) -> str:
    """Return a trial as lines for people."""
    lines = [f"Exercise {trial.number} · {trial.title}" + ("" if trial.surprises else ": nothing surprising")]
    for one in trial.surprises:
        lines.append(f"  {one.level:10}  {one.says}")
        if seen := ": ".join(filter(None, [one.student, one.example])):
            lines.append(f"{'':14}{seen}")
    return "\n".join(lines)


def one_variant(assignment: Assignment, student: str, number: str) -> str:
    """Return what a student sees and is told, as lines: the texts, and the answers of a trial with their verdicts.

    Raises GradingError where the variant fails.
    """
    variant = Variant(student, 0, asked(assignment, student, number), 0.0, assignment.credit)
    question = variant.question
    units = {name: parameter.unit for name, parameter in question.exercise.parameters.items()}
    given = [f"{name} = {written(value, units[name])}" for name, value in question.values.items()]
    lines = [str(question.statement), "", f"{student}: {', '.join(given)}"]
    lines += [line for name in variant.by_hand for line in ("", f"{name}: a person marks it")]
    for name, kind in variant.key.items():
        lines += ["", f"{name}: the key is {kind.solution}"]
        tried = [*kind.right_forms(), *((f"mistake: {text}", value) for text, value in variant.mistakes[name])]
        tried += kind.wrong_forms()
        for how, answer in tried:
            told = variant.judged(name, answer)
            brings = f", {told.percent:g} % of the points" if told.percent else ""
            lines += [f"  {told.status:10}  {in_short(answer)} ({how}){brings}"]
            lines += [f"{'':14}{told.says}"] if told.says != told.status else []
    for rung, text in enumerate(question.rungs, start=1):
        lines += ["", f"hint {rung}: {text}"]
    if question.exercise.worked:
        lines += ["", "solution:", question.solved().text]
    if insight := question.exercise.insight:
        lines += ["", f"insight: {question.filled_in(insight, also={})}"]
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")
