"""The record of the releases of an assignment: which numbers each student was given, and who that was.

It lies beside the module, ``heater.released.json``. Numbers that were released stay: a range that is mended later
holds for those who have none yet. The record is signed with the assignment's secret, so that a number that was edited,
or the record of another assignment, is told and never graded by.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Self

from exercisebook.grammar import listed
from exercisebook.judging import harmless
from exercisebook.parameters import as_text
from exercisegrader import GradingError
from exercisegrader.files import write
from exercisegrader.imprint import Imprint, peek, proofs, sealed
from exercisegrader.student import in_short

if TYPE_CHECKING:
    from pathlib import Path

    from exercisebook.question import Question
    from exercisegrader.assignment import Assignment
    from exercisegrader.student import Student
    from exercisegrader.submissions import Submission

#: {exercise: {parameter: text}}, as `parameters.as_text` writes the values.
Numbers = Mapping[str, Mapping[str, str]]

#: By what somebody is the same person, the surest first; a name alone is not enough.
SURE = ("canvas_id", "sis_id", "login", "email")
_IN_WORDS = {
    "canvas_id": "Canvas's number",
    "sis_id": "the SIS id",
    "login": "the login",
    "email": "the e-mail address",
}
#: So many notebooks are looked into first, and all of them where one of these is doubtful.
SAMPLE = 25
#: So many are never most of a class: what a few hand in is their own matter.
FEW = 3
_OTHER_ASSIGNMENT = "it was released for the assignment"
_OTHER_STUDENT = "it was released to another student:"
_OTHER_NUMBERS = "it was released with other numbers in"
_ADVICE = {
    _OTHER_ASSIGNMENT: "Take the submissions of {0}",
    _OTHER_STUDENT: "Take the roster of the release: this one gives other ids, or is of another class",
    _OTHER_NUMBERS: "Put {0}.released.json of their release beside {0}.py, or the ranges of then back into it",
}
_PUT_BACK = "put the one of the release back, from a copy"


@dataclass(frozen=True)
class Holder:
    """One to whom an assignment was released.

    Attributes:
        id: under which that was.
        known: name, canvas_id, sis_id, login and email, as far as the roster told.
        numbers: {exercise: {parameter: text}}.
    """

    id: str
    known: Mapping[str, str]
    numbers: Numbers

    @property
    def called(self) -> str:
        """The name, or the id where none is known."""
        return self.known.get("name", self.id)


@dataclass(frozen=True)
class Released:
    """The record of an assignment's releases.

    Attributes:
        assignment: its name.
        holders: {id: `Holder`}, in the order of their releases.
        path: of the record; None where there is none.
    """

    assignment: str
    holders: Mapping[str, Holder] = field(default_factory=dict)
    path: Path | None = None

    @classmethod
    def of(cls, assignment: Assignment) -> Self:
        """Return the record beside an assignment; an empty one, without a path, where there is none.

        Raises GradingError for a record that is damaged, was changed, or is that of another assignment or secret.
        """
        path = assignment.record
        try:
            text = path.read_text(encoding="utf-8-sig") if path else ""
        except FileNotFoundError:
            text = ""
        except UnicodeDecodeError:
            raise GradingError(f"{path} is damaged, it is no text: {_PUT_BACK}") from None
        except OSError as problem:
            raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
        if path is None or (not text and not path.exists()):
            return cls(assignment.name)
        return cls(assignment.name, _holders(text, path, assignment), path)

    def numbers(self, student: str) -> dict[str, dict[str, str]]:
        """Return the numbers of a student, {exercise: {parameter: text}}; none for one without a release."""
        holder = self.holders.get(student)
        return {number: dict(texts) for number, texts in holder.numbers.items()} if holder else {}

    def values(self, student: str, number: str) -> Mapping[str, str] | None:
        """Return the numbers of a student in an exercise, {parameter: text}; None where none were released."""
        return self.numbers(student).get(number)

    def with_release(self, student: Student, numbers: Numbers) -> Self:
        """Return the record with one more release; exercises of earlier ones that are gone from the module stay."""
        before = self.holders.get(student.id, Holder(student.id, {}, {}))
        told = {name: value for name in ("name", *SURE) if (value := getattr(student, name))}
        holder = Holder(student.id, {**before.known, **told}, {**before.numbers, **numbers})
        return replace(self, holders={**self.holders, student.id: holder})

    def write(self, path: Path, secret: str) -> None:
        """Write the record, signed with a secret; raises GradingError where that is not possible."""
        students = {one.id: {**one.known, "numbers": one.numbers} for one in self.holders.values()}
        data = {"assignment": self.assignment, "secret": _trace(secret), "students": students}
        signed = data | {"signature": sealed(secret, data)}
        write(path, json.dumps(signed, ensure_ascii=False, indent=1) + "\n")

    def identified(self, students: Iterable[Student]) -> tuple[tuple[Student, ...], tuple[str, ...]]:
        """Return the students of a roster with the ids under which they were released to, and sentences on changes.

        Somebody is the same person by Canvas's number, or else, where one of the two is not known, by the SIS id, the
        login, or the e-mail address; or by the id, where nothing of these speaks against it.

        Raises GradingError for contradictions: one row that fits two persons, two rows that fit one.
        """
        students, index = tuple(students), self._index()
        found = [self._holder_of(student, index) for student in students]
        kept = tuple(
            replace(student, id=holder.id, roster_id=student.id) if holder and holder.id != student.id else student
            for student, holder in zip(students, found, strict=True)
        )
        rows: dict[str, Student] = {}
        for student, one in zip(students, kept, strict=True):
            other = rows.setdefault(one.id.casefold(), student)
            if other is not student:
                raise GradingError(
                    f"the roster has {other.name} ({other.id}) and {student.name} ({student.id}), and by "
                    f"{self.assignment}.released.json both are {one.id}: correct the roster"
                )
        return kept, tuple(_on_ids(students, kept, found))

    def _index(self):
        """Those to whom was released, by what is known of them: {(field, text): holders}."""
        index = defaultdict(list)
        for holder in self.holders.values():
            for name in SURE:
                index[name, _plain(holder.known.get(name) or holder.id)].append(holder)
        return index

    def _holder_of(self, student, index):
        """The one to whom was released who is this student; None where there is none."""
        found = {}
        for name in SURE:
            said = _plain(getattr(student, name))
            for holder in index.get((name, said), ()) if said else ():
                found.setdefault(holder.id, (holder, name))
        if len(found) > 1:
            (one, by), (other, besides) = list(found.values())[:2]
            raise GradingError(
                f"{student.name} ({student.id} on the roster) is by {_IN_WORDS[by]} {one.id}, and by "
                f"{_IN_WORDS[besides]} {other.id}: correct the roster"
            )
        by_id = self.holders.get(student.id)
        for holder, by in [*found.values(), *([(by_id, "")] if by_id and not found else [])]:
            first = next((name for name in SURE if holder.known.get(name) and getattr(student, name)), "")
            if first and _plain(holder.known[first]) != _plain(getattr(student, first)):
                same = _IN_WORDS[by] if by else "the id"
                raise GradingError(
                    f"{student.name} ({student.id} on the roster) is by {same} {holder.id} ({holder.called}), and by "
                    f"{_IN_WORDS[first]} somebody else: correct the roster"
                )
            return holder
        return None

    def differences(self, assignment: Assignment, students: Sequence[Student]) -> tuple[str, ...]:
        """Return sentences on what is no longer as it was released.

        Arguments:
            assignment: as it is now.
            students: whose notebooks there are, with the ids of `identified`.
        """
        if self.path is None and assignment.record is None:
            return ()
        if self.path is None:
            return (
                f"{assignment.record.name} is not beside {assignment.name}.py: all numbers are drawn from the secret, "
                "which gives those of the release only if nothing has changed in the ranges since",
            )
        holders = [self.holders[one.id] for one in students if one.id in self.holders]
        without = [one.id for one in students if one.id not in self.holders]
        found: list[str] = []
        ranges: list[str] = []
        if without:
            found.append(
                f"{self.path.name} has no numbers of {in_short(without)}: nothing was released to them, and their "
                "numbers are drawn from the secret"
            )
        released = dict.fromkeys(number for holder in holders for number in holder.numbers)
        for number in [*released, *assignment.exercises]:
            if number not in assignment.exercises:
                found.append(f"exercise {number} was released and is gone from {assignment.name}.py: it is not graded")
        for number, exercise in assignment.exercises.items():
            having = [holder for holder in holders if number in holder.numbers]
            lacking = [holder.id for holder in holders if number not in holder.numbers]
            if lacking:
                found.append(
                    f"exercise {number} is not in the notebooks that {in_short(lacking)} got: it has been added since, "
                    "and its numbers are drawn from the secret"
                )
            found += _on_parameters(number, exercise, having)
            if names := _other_draws(assignment, number, having):
                ranges.append(f"{listed(names)} in exercise {number}")
        if ranges:
            found.append(
                f"other ranges than at the release: {', '.join(ranges)}; those who were released to keep their numbers"
            )
        return tuple(dict.fromkeys(found))

    def misfits(self, assignment: Assignment, imprint: Imprint) -> tuple[str, ...]:
        """Return the exercises that a notebook was released with in other numbers than those by which it is graded.

        Arguments:
            assignment: of which the notebook is.
            imprint: of the notebook; one without proofs fits.
        """
        numbers = self.numbers(imprint.student)
        for number in imprint.numbers or {}:
            if number not in numbers and number in assignment.exercises:
                numbers[number] = texts(assignment.question(imprint.student, number))
        proof = proofs(assignment.secret, imprint.student, numbers)
        return tuple(n for n, one in (imprint.numbers or {}).items() if n in proof and proof[n] != one)

    def doubts(self, assignment: Assignment, student: str, imprint: Imprint | None) -> tuple[str, ...]:
        """Return what speaks against a notebook, in sentences: it is another's, of another assignment or release.

        Arguments:
            assignment: that is graded.
            student: id of the one who handed it in.
            imprint: of the notebook; None where it has none.
        """
        if imprint is None:
            return ()
        if imprint.assignment != assignment.name:
            return (f"{_OTHER_ASSIGNMENT} {harmless(imprint.assignment)}",)
        if imprint.student != student:
            return (f"{_OTHER_STUDENT} {harmless(imprint.student)}",)
        others = self.misfits(assignment, imprint)
        which = f"exercise{'' if len(others) == 1 else 's'} {listed(others)}" if others else ""
        return (f"{_OTHER_NUMBERS} {which}",) if others else ()

    def demand_fitting(self, assignment: Assignment, submissions: Sequence[Submission]) -> None:
        """Raise GradingError where most notebooks are others': of other students, of another assignment or release.

        Arguments:
            assignment: that is graded.
            submissions: with the students whose they are by the roster.
        """
        readable = [one for one in submissions if not one.problem]
        some = readable[:: max(1, len(readable) // SAMPLE)]
        doubted = self._doubted(assignment, some)
        if any(doubted.values()) and len(some) < len(readable):
            doubted = self._doubted(assignment, readable)
        doubtful = {label: says for label, says in doubted.items() if says}
        if len(doubtful) >= FEW and 2 * len(doubtful) > len(doubted):  # a few of a class hurt themselves alone
            label, says = next(iter(doubtful.items()))
            advice = next(advice for begins, advice in _ADVICE.items() if says.startswith(begins))
            raise GradingError(
                f"{len(doubtful)} of {len(doubted)} notebooks are not those that were released to these students, and "
                f"nothing is graded. Of {label}, for example: {says}. {advice.format(assignment.name)}"
            )

    def _doubted(self, assignment, submissions):
        """What speaks against each of the notebooks that can be read: {label: a sentence, or an empty text}."""
        found = {}
        for one in submissions:
            with contextlib.suppress(GradingError):
                found[one.label] = "".join(self.doubts(assignment, one.student.id, peek(one.read()))[:1])
        return found


def texts(question: Question) -> dict[str, str]:
    """Return the values of a question as texts, {parameter: text}."""
    return {name: as_text(value) for name, value in question.values.items()}


def _holders(text, path, assignment):
    """What a record says, once it is sure that it is the record of this assignment, as it was written."""
    try:
        data = json.loads(text)
        students = data["students"]
        signature, trace, name = data["signature"], data["secret"], data["assignment"]
        holders = {
            one: Holder(one, {name: said for name, said in rest.items() if name != "numbers"}, rest["numbers"])
            for one, rest in students.items()
        }
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise GradingError(f"{path} is damaged: {_PUT_BACK}") from None
    if name != assignment.name:
        raise GradingError(
            f"{path} is the record of {name!r}, and the assignment is {assignment.name!r}: expected the record of its "
            "own releases; put it back, from a copy"
        )
    secret = assignment.secret
    if trace != _trace(secret):
        raise GradingError(
            f"the SECRET of {assignment.name}.py is not the one with which {path.name} was written: put the SECRET of "
            "the release back"
        )
    del data["signature"]
    if not hmac.compare_digest(str(signature), sealed(secret, data)):
        raise GradingError(f"{path} was changed since it was written: {_PUT_BACK}")
    return holders


def _trace(secret):
    """What tells this secret from others, and nothing of it."""
    return hmac.new(secret.encode(), b"the secret of a record", hashlib.sha256).hexdigest()[:16]


def _plain(text):
    return text.strip().casefold()


def _on_ids(students, kept, found):
    """Sentences on ids that the roster has changed, and on names that are others."""
    changed = [(one, other) for one, other in zip(students, kept, strict=True) if one.id != other.id]
    if changed:
        ids = in_short([f"{other.id} (now {one.id})" for one, other in changed])
        yield f"the roster gives other ids than at the release; those of the release are kept: {ids}"
    for student, holder in zip(students, found, strict=True):
        sure = holder and any(holder.known.get(name) and getattr(student, name) for name in SURE)
        if holder and not sure and holder.called not in (holder.id, student.name):
            yield f"{holder.id} was {holder.called} at the release, and is {student.name} on the roster"


def _on_parameters(number, exercise, holders):
    """Sentences on parameters that have come, or are gone, since the release."""
    new = {name: [one.id for one in holders if name not in one.numbers[number]] for name in exercise.parameters}
    for name, lacking in new.items():
        if lacking:
            yield (
                f"exercise {number}: the parameter {name} has been added since the release to {in_short(lacking)}; it "
                "is in no notebook of theirs, and drawn from the secret"
            )
    for name in dict.fromkeys(name for one in holders for name in one.numbers[number]):
        if name not in exercise.parameters:
            yield f"exercise {number}: the parameter {name} was released and is gone: it is ignored"


def _other_draws(assignment, number, holders):
    """The parameters of which some would have other numbers if they were released to today."""
    names = {}
    for holder in holders:
        try:
            drawn, had = texts(assignment.question(holder.id, number)), holder.numbers[number]
        except GradingError:  # nobody new could be released to; those who were are graded
            return list(holder.numbers[number])
        names |= dict.fromkeys(name for name, text in drawn.items() if had.get(name, text) != text)
    return list(names)
