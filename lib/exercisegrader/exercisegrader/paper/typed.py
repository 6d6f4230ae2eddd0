"""Answers that stood on paper, typed into a table: a row for each student, a column for each asked quantity."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from exercisebook.kinds.kind import ELSEWHERE
from exercisebook.question import Question
from exercisegrader import GradingError, tables
from exercisegrader.assignment import Assignment
from exercisegrader.released import Released
from exercisegrader.student import Roll, Student
from exercisegrader.submissions import Collection, Submission
from exercisegrader.tables import Faults, Table
from plainmath.validation import did_you_mean

#: The columns of a table beside those of the answers.
ID, NAME = "id", "name"


def columns(questions: Mapping[str, Question]) -> list[str]:
    """Return the heads of the columns for answers, as "1 Kp"; what cannot be typed, as a figure, has none."""
    return [
        f"{number} {name}"
        for number, question in questions.items()
        for name, kind in question.key.items()
        if kind.field["control"] != ELSEWHERE
    ]


def template(path: Path, heads: Sequence[str], students: Iterable[Student]) -> str:
    """Return the empty table, or what is there with a row for each student who has none.

    Arguments:
        path: of the table.
        heads: of the columns for answers.
        students: of the release.
    Raises:
        GradingError: for a file that cannot be read, or has other columns.
    """
    if not path.exists():
        rows = [[one.id, one.name, *[""] * len(heads)] for one in students]
        return tables.as_text([[ID, NAME, *heads], *rows], bom=True)
    table = _read(path, heads)
    there = {row[ID].casefold() for _, row in _rows(table)}
    new = [{ID: one.id, NAME: tables.guarded(one.name)} for one in students if one.id.casefold() not in there]
    return tables.Sheet(table, table.header).continued(new)


def collect(path: Path, students: Sequence[Student], assignment: Assignment, released: Released) -> Collection:
    """Return what was typed as submissions; a row without answers is none.

    Arguments:
        path: of the table.
        students: with the ids of the release.
        assignment: `Assignment`.
        released: its record.
    Raises:
        GradingError: with all faults of the table, each with its line.
    """
    first = students[0].id
    heads = columns({n: assignment.question(first, n, released.values(first, n)) for n in assignment.exercises})
    table, found = _read(path, heads), {}
    faults = Faults(path.name, table.faults)
    also = {one.roster_id: one.id for one in students if one.roster_id}
    roll, lines = Roll([one.id for one in students], also), {}
    for line, row in _rows(table):
        given = {head: text for head in heads if (text := row[head].removeprefix("'").strip())}
        if not (student := roll.find(row[ID])):
            if row[ID] or given:
                faults.add(
                    line, roll.fault(row[ID]) if row[ID] else "answers without an id: expected the one of the sheet"
                )
            continue
        if lines.setdefault(student, line) != line:
            faults.add(line, f"{student} has a row already, line {lines[student]}: expected one")
        if given:
            found[student] = _by_exercise(given)
    faults.demand_none()
    without = [one.id for one in students if one.id in found and one.id not in released.holders]
    if without:
        raise GradingError(f"{path.name} has answers of {without[0]}, to whom nothing was released: release again")
    return Collection(
        tuple(
            Submission(one, f"{path.name}, line {lines[one.id]}", handed_in=one.handed_in, answers=found[one.id])
            for one in students
            if one.id in found
        ),
        (),
    )


def _by_exercise(given: Mapping[str, str]) -> dict[str, dict[str, str]]:
    found: dict[str, dict[str, str]] = {}
    for head, text in given.items():
        number, _, name = head.partition(" ")
        found.setdefault(number, {})[name] = text
    return found


def _read(path: Path, heads: Sequence[str]) -> Table:
    """The table in a file. Raises GradingError where it has other columns."""
    best = max(tables.read(path), key=lambda table: len({*table.header} & {ID, *heads}))
    expected = [ID, *heads]
    for head in expected:
        if best.header.count(head) != 1:
            there = "are two columns" if head in best.header else "is no column"
            meant = did_you_mean(head, [one for one in best.header if one and one not in expected], otherwise="")
            raise GradingError(f"{path.name}, line 1: there {there} {head!r}{f': {meant}' if meant else ''}")
    for head in best.header:
        if head and head not in (*expected, NAME):
            raise GradingError(f"{path.name}, line 1: nothing is asked as {head!r}: {did_you_mean(head, heads)}")
    return best


def _rows(table: Table) -> Iterator[tuple[int, dict[str, str]]]:
    for line, cells in table.rows:
        yield line, dict(zip(table.header, map(str.strip, cells), strict=True))
