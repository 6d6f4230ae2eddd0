"""The result of a submission: what the reports are written from, and what a resumed run does not grade again.

Each is a file of its own, which is there whole or not at all. It carries a fingerprint of all that it depends on, and a
seal, by which a file that was changed since is told from one as the grader wrote it.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Self

from exercisebook.judging import OPEN, RIGHT, earned, harmless
from exercisegrader import GradingError
from exercisegrader.files import write
from exercisegrader.imprint import sealed
from exercisegrader.student import in_short

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.assignment import Assignment
    from exercisegrader.events import Outcome
    from exercisegrader.inside.plain import Plain
    from exercisegrader.jail import Limits

#: What became of a submission: nothing handed in, nothing that could be run, run in part, run to its end.
MISSING, NOT_RUN, STOPPED, COMPLETE = "missing", "not run", "stopped", "complete"
#: Kinds of `Look`.
OWNER, ODD, UNASKED, NO_CODE = "owner", "odd lines", "unasked", "no code"
#: So many answers to what is not asked are told.
MOST_UNASKED = 20
#: An address of memory, in an error's text, differs from run to run.
ADDRESS = re.compile(r"\b0x[0-9a-fA-F]{6,}\b")


@dataclass(frozen=True)
class JudgedAnswer:
    """What became of the answer to one asked quantity.

    Attributes:
        name: of the quantity.
        status, says: of the `Verdict`.
        answer: as it came, as plain data.
        key: the right answer, as a text for people.
        weight: what it counts among the quantities of its exercise.
        look: why an instructor should see it; empty where there is no need.
        percent: of its points that it brings where it is not right.
    """

    name: str
    status: str
    says: str
    answer: Plain
    key: str
    weight: float = 1
    look: str = ""
    percent: float = 0

    @property
    def part(self) -> float:
        """The part of its points that it brings."""
        return 1.0 if self.status == RIGHT else self.percent / 100


@dataclass(frozen=True)
class JudgedExercise:
    """What became of the answers to one exercise.

    Attributes:
        number, title, points: of the exercise.
        statement: the question as the student saw it, below its heading, in Markdown.
        given: the student's own numbers that the statement shows, pairs of a name and a value with its unit.
        answers: a `JudgedAnswer` for each asked quantity.

    >>> answers = (JudgedAnswer("K", "right", "right", 2, "2"), JudgedAnswer("T", "wrong", "not right", 3, "4 s"))
    >>> JudgedExercise("1", "Gain", 4, "", (), answers).earned
    2.0
    """

    number: str
    title: str
    points: float
    statement: str
    given: tuple[tuple[str, str], ...]
    answers: tuple[JudgedAnswer, ...]

    @property
    def earned(self) -> float:
        """The points that its answers bring."""
        right = sum(one.weight * one.part for one in self.answers)
        return earned(self.points, right, sum(one.weight for one in self.answers))

    def share(self, answer: JudgedAnswer) -> float:
        """Return the points that one of its answers brings where it is right."""
        return earned(self.points, answer.weight, sum(one.weight for one in self.answers))

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> Self:
        """Return the exercise that JSON data says."""
        given = tuple((name, value) for name, value in data["given"])
        return cls(**data | {"given": given, "answers": tuple(JudgedAnswer(**one) for one in data["answers"])})


@dataclass(frozen=True)
class CellError:
    """An error that ended a cell: its number, counted from one, and a sentence."""

    cell: int
    says: str


@dataclass(frozen=True)
class Look:
    """Why an instructor should look at a submission.

    Attributes:
        kind: OWNER where it names another student, ODD where it told lines that are not answers, UNASKED where it
            answers what is not asked and leaves open what is, NO_CODE where what is left open stands in a cell that is
            not run.
        says: the reason, in a sentence.
        exercise: the one whose open answers may be meant; empty where it may be any.
    """

    kind: str
    says: str
    exercise: str = ""


@dataclass(frozen=True)
class Result:
    """The result of a submission.

    Attributes:
        assignment, student: its name, and the student's id.
        file: what was graded, by its name among the submissions; empty where there is nothing.
        jailed: whether it ran in a jail.
        fingerprint: of all that it depends on.
        status, says: "missing", "not run", "stopped" or "complete", and why.
        errors: of cells.
        looks: why an instructor should look at the submission.
        exercises: a `JudgedExercise` for each.
        owner: the student whom the notebook itself names; empty where it names none.
        chosen: how the file was chosen where there were several; empty where there was one.
    """

    assignment: str
    student: str
    file: str
    jailed: bool
    fingerprint: str
    status: str
    says: str
    errors: tuple[CellError, ...]
    looks: tuple[Look, ...]
    exercises: tuple[JudgedExercise, ...]
    owner: str = ""
    chosen: str = ""

    @property
    def points(self) -> float:
        """The points of all exercises."""
        return sum(one.points for one in self.exercises)

    @property
    def earned(self) -> float:
        """The points that the right answers bring."""
        return sum(one.earned for one in self.exercises)

    def as_json(self, secret: str) -> str:
        """Return it as JSON with a seal that this secret makes; `of_json` reads it."""
        data = json.loads(json.dumps(asdict(self)))  # tuples are lists there
        return json.dumps(data | {"seal": sealed(secret, data)}, indent=1, sort_keys=True) + "\n"

    @classmethod
    def of_json(cls, text: str, secret: str) -> Self:
        """Return the result that a text of `as_json` holds. Raises ValueError for any other text."""
        data = json.loads(text)
        if not isinstance(data, dict) or not hmac.compare_digest(str(data.pop("seal", "")), sealed(secret, data)):
            raise ValueError("its seal is broken")
        return cls(
            **data
            | {
                "errors": tuple(CellError(**one) for one in data["errors"]),
                "looks": tuple(Look(**one) for one in data["looks"]),
                "exercises": tuple(map(JudgedExercise.of_data, data["exercises"])),
            }
        )


def fingerprint(
    assignment: Assignment, numbers: object, content: bytes, label: str, problem: str, jailed: bool, limits: Limits
) -> str:
    """Return a text that differs where a result might.

    That is by the assignment, the numbers that were released, the submission, the jail, or its limits.
    """
    amounts = {name: float(amount) for name, amount in asdict(limits).items()}  # 60 s are 60.0 s
    parts = [assignment.fingerprint, numbers, hashlib.sha256(content).hexdigest(), label, problem, jailed, amounts]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def same_each_time(says: str) -> str:
    """Return a sentence without what differs from run to run."""
    return ADDRESS.sub("0x...", says)


#: Where answers stand that do not arrive.
_NOT_ARRIVED = "in a cell that is not run, in a comment or in a function that is not called, or without their names"


def looks(
    student: str,
    outcome: Outcome,
    exercises: Sequence[JudgedExercise],
    written: Mapping[str, Collection[str]] | None = None,
    doubts: Sequence[str] = (),
    if_empty: str = "",
) -> list[Look]:
    """Return why an instructor should look at a submission.

    Arguments:
        student: id.
        outcome: `events.Outcome`.
        exercises: as `judge.Judge.judge` returns them.
        written: what the text of the notebook answers, as `sources.answered` returns it.
        doubts: what speaks against the notebook, by its imprint.
        if_empty: what to say where it answers nothing at all.
    """
    others = [name for name in outcome.named if name != student]
    says_of_others = f"it names another student: {', '.join(map(harmless, others[:3]))}"
    found = [Look(OWNER, says) for says in ([says_of_others] if others else doubts)]
    if outcome.odd:
        lines = f"{outcome.odd} line{'s' if outcome.odd > 1 else ''}"
        found.append(Look(ODD, f"it told {lines} that could not be read as answers"))
    asked = {one.number: {answer.name for answer in one.answers} for one in exercises}
    open_names = {one.number: {answer.name for answer in one.answers if answer.status == OPEN} for one in exercises}
    left = {number for number, names in open_names.items() if names}
    if outcome.errors or outcome.stopped:
        written = {}  # what failed is told anyway
    for number, names in (written or {}).items():
        if open_names.get(number, set()) & {*names} or (number in left and "" in names):
            says = f"exercise {number} is answered in the text of the notebook alone, {_NOT_ARRIVED}"
            found.append(Look(NO_CODE, says, number))
    if if_empty and left and not (outcome.answers or found or outcome.refused or outcome.errors or outcome.stopped):
        found.append(Look(NO_CODE, if_empty))
    more = []
    for number, given in outcome.answers.items() if left else ():
        if number not in asked and given:
            says = f"it answers {harmless(repr(number))}, which is not an exercise of this assignment"
            more.append(Look(UNASKED, says))
        elif number in left and (extra := [name for name in given if name not in asked[number]]):
            named = in_short([harmless(repr(name)) for name in extra])
            says = f"in exercise {number} it answers {named}, which {'are' if extra[1:] else 'is'} not asked"
            more.append(Look(UNASKED, says, number))
    return [*found, *sorted(more, key=lambda look: look.says)[:MOST_UNASKED]]


class Results:
    """The results in a folder, a file a student.

    Arguments:
        folder: where they are.
        secret: of the assignment, for the seals.
    """

    def __init__(self, folder: Path, secret: str):
        self.folder, self.secret = folder, secret

    def _path(self, student):
        return self.folder / f"{student}.json"

    def of(self, student: str) -> Result | None:
        """Return the result of a student; None where there is none.

        Raises GradingError for a file that cannot be read, or is not as the grader wrote it.
        """
        path = self._path(student)
        if path.exists() and not path.is_file():
            raise GradingError(f"{path} is not a file: move it away")
        try:
            found = Result.of_json(path.read_text(encoding="utf-8"), self.secret)
            if found.student != student:
                raise ValueError("it is the result of somebody else")
        except FileNotFoundError:
            return None
        except OSError as problem:
            raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
        except (ValueError, TypeError, KeyError, RecursionError):
            raise GradingError(
                f"{path} is not as the grader of this assignment wrote it: grade again with --regrade; "
                "points that you give yourself belong into marks.csv"
            ) from None
        return found

    def if_whole(self, student: str) -> Result | None:
        """Return the result of a student; None where there is none, and where it is not as the grader wrote it."""
        try:
            return self.of(student)
        except GradingError:
            return None

    def demand_of(self, assignment: str, students: Iterable[str]) -> None:
        """Raise GradingError where a student's result is that of another assignment, which would be lost."""
        for student in students:
            try:
                other = json.loads(self._path(student).read_text(encoding="utf-8")).get("assignment", assignment)
            except (OSError, ValueError, AttributeError, RecursionError):  # `of` says what is wrong with it
                continue
            if other != assignment:
                raise GradingError(
                    f"{self.folder} holds results of the assignment {other!r}: expected a folder of its own for "
                    f"{assignment!r}"
                )

    def keep(self, found: Result) -> None:
        """Store a result."""
        write(self._path(found.student), found.as_json(self.secret))
