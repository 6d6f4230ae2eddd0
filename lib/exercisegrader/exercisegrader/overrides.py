"""Marks by hand: the tables into which people write them, and what of these was changed when.

``marks.csv`` in the folder of the grades is the instructor's: student, exercise, quantity, points, comment, and
whatever columns are added. An empty quantity is the whole exercise, an empty exercise the whole notebook. Of several
rows for one place the last counts. The folder ``to_mark`` has a table of this form for each section, with a row,
without points, for each answer that waits for a person. Who marks there knows students by a code; what the instructor
says counts more. The grader adds rows to the tables of the sections, and changes and removes none.

``marks_history.csv`` has a row for each change: when the table was changed, from what, to what, and what the grader
itself said of that place then. So it is noticed when that becomes another one.
"""

from __future__ import annotations

import datetime
import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from exercisebook.judging import earned
from exercisegrader import GradingError, files, tables
from exercisegrader.imprint import sealed
from exercisegrader.reports.wording import number as written
from exercisegrader.tables import Faults, Sheet, read_sheet
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisegrader.assignment import Assignment
    from exercisegrader.results import Result
    from exercisegrader.student import Roll

#: The folder, among the grades, of what waits for a person.
TO_MARK = "to_mark"
COLUMNS = ("student", "exercise", "quantity", "points", "comment")
HISTORY = ("when", "student", "exercise", "quantity", "from", "to", "comment", "grader", "answer", "file")
#: A code has no vowels, so that it is no word, and no digits, which a spreadsheet would take for a number.
_LETTERS = "bcdfghjkmnpqrstvwxz"
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
        file: the table in which it stands, by its place in the folder of the grades.
    """

    points: float | None = None
    comment: str = ""
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Notice:
    """Why an instructor should see to a mark: it has lost its ground, or nobody knows how late something is.

    Attributes:
        points: that may hang on it.
        says: the reason, in a sentence.
    """

    points: float
    says: str


def code(secret: str, student: str) -> str:
    """Return what whoever marks knows a student by. Only who has the assignment's secret can tell whose it is.

    >>> code("a secret of many letters", "s1001")
    'bxzqbzbk'
    """
    number, found = int(sealed(secret, ["marks by hand", student]), 16), ""
    while len(found) < 8:  # two of a thousand have the same one in a class of fifty thousand
        number, place = divmod(number, len(_LETTERS))
        found += _LETTERS[place]
    return found


class Overrides:
    """The marks by hand in a folder of grades.

    Arguments:
        folder: of the grades.
        assignment: `Assignment`.
        roll: the ids of the students, and their codes.
        parts: {student: name of the table in which the answers of the student wait}.

    Attributes:
        marks: {place: `Mark`}, as `read` found them.
        withdrawn: how many marks were there before, and are not there now.
        former: those of whom there are marks and results, and who are no longer on the roster.
    """

    def __init__(self, folder: Path, assignment: Assignment, roll: Roll, parts: Mapping[str, str]):
        self.folder, self.path, self.history_path = folder, folder / "marks.csv", folder / "marks_history.csv"
        self.assignment, self.roll, self.parts = assignment, roll, parts
        self.marks: dict[Place, Mark] = {}
        self.withdrawn, self.former = 0, set[str]()
        self._parts: dict[str, dict[str, float]] = {}
        self._sheets: list[Sheet] = []
        self._noted: dict[Place, dict[str, str]] = {}

    def read(self, result_of: Callable[[str], Result | None]) -> None:
        """Read the marks, and note in the history what has changed since they were noted last.

        Changes for students without a result are noted later, when there is one.

        Arguments:
            result_of: returns the result of a student as it is now; None where there is none.
        Raises:
            GradingError: with all faults of the tables, each with its line; and where a table is gone and the history
                knows of marks in it that are nowhere else.
        """
        history = self._read_history()
        paths = [*sorted((self.folder / TO_MARK).glob("*.csv")), self.path]  # what comes last counts more
        self._sheets = [read_sheet(path, COLUMNS[:4], COLUMNS[4:]) for path in paths if path.exists()]
        self.marks = self._marks()
        self._demand_all_tables()
        if rows := self._changes(result_of):
            files.write(self.history_path, history.continued(rows))
            self._read_history()

    def _demand_all_tables(self):
        known = [(_file(row), place) for place, row in self._noted.items() if row["to"] or row["comment"]]
        gone = [file for file, place in known if place not in self.marks and not (self.folder / file).exists()]
        if gone:
            count = gone.count(gone[0])
            raise GradingError(
                f"{self.folder / gone[0]} is gone, and marks_history.csv knows {count} row{'s' * (count > 1)} of it: "
                "put the file back, or move the history away as well"
            )

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
        """Add a row without points, in the table of the section, for each place that has none yet.

        Whose it is says the code of the student. What is in a table stays as it is, byte for byte: the rows are written
        behind it. One that is saved meanwhile is not touched: the next run adds the rows.
        """
        have = {(sheet.table.path, place) for sheet in self._sheets for _, place, _ in self._placed(sheet)}
        more: dict[Path, list[dict[str, str]]] = {self.path: []}
        for student, *asked in waiting:
            path = self.folder / TO_MARK / f"{self.parts[student]}.csv"
            if (path, (student, *asked)) not in have:  # who has another section by now has a row in its table, too
                cells = code(self.assignment.secret, student), *asked
                more.setdefault(path, []).append(dict(zip(COLUMNS, cells, strict=False)))
        there = {sheet.table.path: sheet for sheet in self._sheets}
        for path, rows in more.items():
            sheet = there.get(path) or Sheet.new(path, COLUMNS)
            before, text = sheet.table.text.encode(), sheet.continued(rows).encode()
            if not path.exists():
                files.write(path, text)
            elif rows and path.read_bytes() == before:
                files.append(path, text[len(before) :])

    # ---------------------------------------------------------------------------------------------- the tables

    def _placed(self, sheet):
        """The rows that are about somebody: line, place and cells, in the words of the roster and the assignment."""
        numbers = {number.casefold(): number for number in self.assignment.exercises}
        for line, row in sheet.rows:
            student, number = row["student"], row["exercise"]
            known = self.roll.find(student) or student
            yield line, (known, numbers.get(number.casefold(), number), row["quantity"]), row

    def _marks(self):
        """The marks that count. Raises GradingError with all faults."""
        marks: dict[Place, Mark] = {}
        told: list[str] = []
        for sheet in self._sheets:
            file = sheet.table.path.relative_to(self.folder).as_posix()
            faults, own = Faults(file), {}
            for line, place, row in self._placed(sheet):
                if place[0] in self.roll.former:
                    self.former.add(place[0])
                elif says := self._fault(place) or self._fault_of_points(place, row["points"]):
                    faults.add(line, says)
                else:
                    own.pop(place, None)  # the last row counts, and is in its place
                    given = tables.number(row["points"])
                    points = given if given is None else min(given, self._most(place))
                    own[place] = line, Mark(points, row.get("comment", ""), file)
            for place, (line, mark) in own.items():
                before = marks.get(place, Mark())
                if mark.points is None:  # a row that is still empty takes nothing away
                    mark = replace(before, comment=mark.comment) if mark.comment else before
                elif sheet.table.path != self.path and before.points not in (None, mark.points):
                    at = where(*place[1:])
                    also = f"{before.file} says {written(before.points)}"
                    faults.add(line, f"{at}: the points are {written(mark.points)}, and {also}: expected one of them")
                marks[place] = mark
            told += faults.told()
        if told:
            raise GradingError("\n".join(told))
        return marks

    def _fault_of_points(self, place, text):
        """A sentence on points that a place cannot have; empty for others, and for none."""
        given, most = tables.number(text), self._most(place)
        if text and given is None:
            return f"the points are {text!r}: expected a number, or nothing"
        if given is not None and not 0 <= given <= most + ROUNDED:
            return f"the points are {text}: expected 0 to {written(most)} for {where(*place[1:])}"
        return ""

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
        sheet = read_sheet(self.history_path, HISTORY[:-1], HISTORY[-1:])
        self._noted = {(row["student"], row["exercise"], row["quantity"]): row for _, row in sheet.rows}
        return sheet

    def _changes(self, result_of):
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
            file = mark.file or _file(before)
            cells = _changed_at(self.folder / file), *place, before["to"], to, mark.comment, says, answer, file
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


def _file(noted):
    """The table that a row of the history is about; of older ones there is one alone."""
    return noted.get("file") or "marks.csv"


def _changed_at(path):
    """When a file was changed, in UTC; empty where it is gone."""
    if not path.exists():
        return ""
    seconds = int(path.stat().st_mtime)
    return f"{datetime.datetime.fromtimestamp(seconds, datetime.UTC):%Y-%m-%dT%H:%M:%SZ}"
