"""Marks by hand: what an instructor writes into ``marks.csv``, and what of it was changed when.

The file lies in the folder of the grades: student, exercise, quantity, points, comment, and whatever columns are added.
An empty quantity is the whole exercise, an empty exercise the whole notebook. Of several rows for one place the last
counts. The grader adds a row, without points, for each answer that waits for a person; it changes and removes none.

``marks_history.csv`` beside it has a row for each change: when the file was changed, from what, to what, and what the
grader itself said of that place then. So it is noticed when that becomes another one.
"""

from __future__ import annotations

import datetime
import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from exercisebook.judging import earned
from exercisegrader import GradingError, files, tables
from exercisegrader.reports.wording import number as written
from exercisegrader.tables import Faults, Sheet, read_sheet
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisegrader.assignment import Assignment
    from exercisegrader.results import Result
    from exercisegrader.student import Roll

COLUMNS = ("student", "exercise", "quantity", "points", "comment")
HISTORY = ("when", "student", "exercise", "quantity", "from", "to", "comment", "grader", "answer")
#: Points are written with two decimals: 1.34 of 4/3 points are all of them.
ROUNDED = 0.005

#: Where a mark belongs: student, exercise and quantity, the latter two perhaps empty.
Place: TypeAlias = tuple[str, str, str]


@dataclass(frozen=True)
class Mark:
    """What a person says of a place.

    Attributes:
        points: None where there are none: then it is a comment alone.
        comment: for the student.
    """

    points: float | None = None
    comment: str = ""


@dataclass(frozen=True)
class Notice:
    """Why an instructor should see to a mark: it has lost its ground, or nobody knows how late something is.

    Attributes:
        points: that may hang on it.
        says: the reason, in a sentence.
    """

    points: float
    says: str


class Overrides:
    """The marks by hand in a folder of grades.

    Arguments:
        folder: of the grades.
        assignment: `Assignment`.
        roll: the ids of the students.

    Attributes:
        marks: {place: `Mark`}, as `read` found them.
        withdrawn: how many marks were there before, and are not there now.
        former: those of whom there are marks and results, and who are no longer on the roster.
    """

    def __init__(self, folder: Path, assignment: Assignment, roll: Roll):
        self.path, self.history_path = folder / "marks.csv", folder / "marks_history.csv"
        self.assignment, self.roll = assignment, roll
        self.marks: dict[Place, Mark] = {}
        self.withdrawn, self.former = 0, set[str]()
        self._parts: dict[str, dict[str, float]] = {}
        self._sheet = Sheet.new(self.path, COLUMNS)
        self._noted: dict[Place, dict[str, str]] = {}

    def read(self, result_of: Callable[[str], Result | None]) -> None:
        """Read the marks, and note in the history what has changed since they were noted last.

        Changes for students without a result are noted later, when there is one.

        Arguments:
            result_of: returns the result of a student as it is now; None where there is none.
        Raises:
            GradingError: with all faults of the file, each with its line; and where the file is gone and the history
                knows of marks in it.
        """
        history = self._read_history()
        if self.path.exists():
            self._sheet = read_sheet(self.path, COLUMNS[:4], COLUMNS[4:])
            changed = _changed_at(self.path)
        else:
            if known := sum(bool(row["to"] or row["comment"]) for row in self._noted.values()):
                raise GradingError(
                    f"{self.path} is gone, and marks_history.csv knows {known} row{'s' * (known > 1)} of it: put the "
                    "file back, or move the history away as well"
                )
            self._sheet, changed = Sheet.new(self.path, COLUMNS), ""
        self.marks = self._marks()
        if rows := self._changes(changed, result_of):
            files.write(self.history_path, history.continued(rows))
            self._read_history()

    def of(self, student: str) -> dict[tuple[str, str], Mark]:
        """Return the marks of a student: {(exercise, quantity): mark}."""
        return {place[1:]: mark for place, mark in self.marks.items() if place[0] == student}

    def changed_since(self, result: Result) -> list[Notice]:
        """Return where a mark by hand has lost its ground.

        That is where the student has given another answer since, and where the grader now says another thing of it.
        """
        found = []
        for (exercise, quantity), mark in self.of(result.student).items():
            noted = self._noted.get((result.student, exercise, quantity))
            if mark.points is None or not noted or not noted["grader"]:
                continue
            says, answer = judged(result, exercise, quantity)
            most = self._most((result.student, exercise, quantity))
            about = f"{where(exercise, quantity)}: marked by hand with {written(mark.points)}"
            if answer != noted["answer"]:
                found.append(Notice(most, f"{about}, and the answer has changed since"))
            elif says != noted["grader"]:
                found.append(Notice(most, f"{about} when the grader said {noted['grader']!r}; now it says {says!r}"))
        return found

    def add(self, waiting: Iterable[Place]) -> None:
        """Add a row without points for each place that has none yet.

        What is in the file stays as it is, byte for byte: the rows are written behind it. A file that is saved
        meanwhile is not touched: the next run adds the rows.
        """
        have = {place for _, place, _ in self._placed()}
        rows = [dict(zip(COLUMNS, place, strict=False)) for place in waiting if place not in have]
        there, text = self._sheet.table.text.encode(), self._sheet.continued(rows).encode()
        if not self.path.exists():
            files.write(self.path, text.decode())
        elif rows and self.path.read_bytes() == there:
            files.append(self.path, text[len(there) :])

    # ------------------------------------------------------------------------------------------------- the file

    def _placed(self):
        """The rows that are about somebody: line, place and cells, in the words of the roster and the assignment."""
        numbers = {number.casefold(): number for number in self.assignment.exercises}
        for line, row in self._sheet.rows:
            student, number = row["student"], row["exercise"]
            known = self.roll.find(student) or student
            yield line, (known, numbers.get(number.casefold(), number), row["quantity"]), row

    def _marks(self):
        """The marks that count. Raises GradingError with all faults."""
        faults, marks = Faults(self.path.name), {}
        for line, place, row in self._placed():
            if place[0] in self.roll.former:
                self.former.add(place[0])
                continue
            says = self._fault(place)
            if not says:
                given, most = tables.number(row["points"]), self._most(place)
                if row["points"] and given is None:
                    says = f"the points are {row['points']!r}: expected a number, or nothing"
                elif given is not None and not 0 <= given <= most + ROUNDED:
                    says = f"the points are {row['points']}: expected 0 to {written(most)} for {where(*place[1:])}"
                else:
                    marks.pop(place, None)  # the last row counts, and is in its place
                    marks[place] = Mark(given if given is None else min(given, most), row.get("comment", ""))
            if says:
                faults.add(line, says)
        faults.demand_none()
        return marks

    def _fault(self, place):
        """A sentence on an unknown place; empty for a known one."""
        student, number, quantity = place
        exercises = self.assignment.exercises
        if student not in self.roll.ids:
            return self.roll.fault(student)
        if not number:
            return f"the quantity {quantity!r} has no exercise: expected its number" if quantity else ""
        if number not in exercises:
            return f"there is no exercise {number!r}: {did_you_mean(number, exercises)}"
        if quantity and quantity not in (known := self._quantities(student, number)):
            return f"exercise {number} asks for no {quantity!r}: {did_you_mean(quantity, known)}"
        return ""

    def _most(self, place):
        """The points that a place may have."""
        student, number, quantity = place
        if quantity:
            return self._quantities(student, number)[quantity]
        return self.assignment.exercises[number].points if number else self.assignment.points

    def _quantities(self, student, number):
        """{quantity: points} of an exercise; the names are the same for all students."""
        if number not in self._parts:
            question = self.assignment.question(student, number)
            weights = {name: question.exercise.weights.get(name, 1) for name in question.key}
            asked = sum(weights.values())
            parts = {name: earned(question.exercise.points, weight, asked) for name, weight in weights.items()}
            self._parts[number] = parts
        return self._parts[number]

    # ---------------------------------------------------------------------------------------------- the history

    def _read_history(self):
        if not self.history_path.exists():
            return Sheet.new(self.history_path, HISTORY)
        sheet = read_sheet(self.history_path, HISTORY)
        self._noted = {(row["student"], row["exercise"], row["quantity"]): row for _, row in sheet.rows}
        return sheet

    def _changes(self, when, result_of):
        """The rows of the history for what has changed; counts what was withdrawn."""
        rows = []
        for place in dict.fromkeys([*self.marks, *self._noted]):
            before, mark = self._noted.get(place, {"to": "", "comment": ""}), self.marks.get(place, Mark())
            if place[0] not in self.roll.ids:
                continue
            was, to = tables.number(before["to"]), "" if mark.points is None else written(mark.points)
            if (was, before["comment"]) == (tables.number(to), mark.comment):
                continue
            result = result_of(place[0])
            if result is None and place in self.marks:
                continue
            self.withdrawn += was is not None and mark.points is None
            says, answer = judged(result, *place[1:]) if result else ("", "")
            cells = when, *place, before["to"], to, mark.comment, says, answer
            rows.append(dict(zip(HISTORY, cells, strict=True)))
        return rows


def judged(result: Result, exercise: str, quantity: str) -> tuple[str, str]:
    """Return what the grader says of a place of a result, and a short text that differs where the answer does.

    Of a quantity it is the status of its answer, of more the points; an empty quantity is the whole exercise, an empty
    exercise the whole notebook.
    """
    within = [one for one in result.exercises if one.number == exercise or not exercise]
    answers = [one for item in within for one in item.answers if one.name == quantity or not quantity]
    text = json.dumps([result.status if not exercise else "", *(one.answer for one in answers)], sort_keys=True)
    mark = hashlib.sha256(text.encode()).hexdigest()[:8]
    if quantity:
        return (answers[0].status if answers else "not asked"), mark
    says = f"{written(sum(one.earned for one in within))} of {written(sum(one.points for one in within))}"
    return (says if exercise or result.status == "complete" else f"{result.status}, {says}"), mark


def where(exercise: str, quantity: str) -> str:
    """Return a place in words.

    >>> where("1", "K"), where("1", ""), where("", "")
    ('exercise 1, K', 'exercise 1', 'the whole notebook')
    """
    return f"exercise {exercise}" + (f", {quantity}" if quantity else "") if exercise else "the whole notebook"


def _changed_at(path):
    """When a file was changed, in UTC."""
    seconds = int(path.stat().st_mtime)
    return f"{datetime.datetime.fromtimestamp(seconds, datetime.UTC):%Y-%m-%dT%H:%M:%SZ}"
