"""The table of a term: what each student has in each assignment, and in all of them.

A folder holds a folder with the grades of each assignment, of which ``points.csv`` is read. For an examination on paper
that may be a table of one's own with the columns id, total, and possible. ``term.toml`` may say what counts how; else
each assignment counts as many points as it has::

    weights = {air_heater = 40, closed_loop = 60}
    drop = {lowest = 1, of = ["air_heater", "closed_loop"]}  # the lowest in percent, of these or of all
    excused = {s1013 = ["air_heater"]}
"""

from __future__ import annotations

import tomllib
from pathlib import Path

from exercisegrader import GradingError, tables
from exercisegrader.marking import GRADED, WAITS
from exercisegrader.reports.outputs.points import ID, JAILLESS, NAME, POSSIBLE, SECTION, STATE, TOTAL
from exercisegrader.reports.wording import number
from exercisegrader.results import MISSING, NOT_RUN
from exercisegrader.student import in_short
from plainmath.validation import did_you_mean

#: States of a student in an assignment, besides those in its table; and what is said of them.
EXCUSED, UNKNOWN = "excused", "not in the table"
_SAYS = {
    MISSING: "missing, which counts as nothing",
    WAITS: "waiting for a mark: no total yet",
    NOT_RUN: "not run: no total yet",
    UNKNOWN: "not in its points.csv: no total before there is a row, or [excused] in term.toml says so",
}
_SETTINGS = {"weights": {}, "drop": {"lowest": 0, "of": []}, "excused": {}}


class Term:
    """The assignments in a folder, and what ``term.toml`` says of them.

    Arguments:
        folder: with a folder for each assignment.
    Raises:
        GradingError: where there is none, with the faults of a table, and for a setting that is none.

    Attributes:
        points: {assignment: its points}, in the order of the weights, or of the names.
        students: {id: (name, section)}.
    """

    def __init__(self, folder: Path):
        self.students: dict[str, tuple[str, str]] = {}
        self._without_jail, self._ids = False, dict[str, str]()
        self._cells = {}
        for path in sorted(folder.glob("*/points.csv")):
            try:
                self._cells[path.parent.name] = self._read(path)
            except GradingError as problem:
                raise GradingError(f"{path.parent}: {problem}") from None
        if not self._cells:
            raise GradingError(f"{folder} has no grades: expected a folder for each assignment, with its points.csv")
        self.points = {name: max((one[2] for one in own.values()), default=0.0) for name, own in self._cells.items()}
        path = folder / "term.toml"
        try:
            said = tomllib.loads(path.read_text(encoding="utf-8-sig")) if path.exists() else {}
            self._weights, self._drop, self._excused = _settings(said, self.points, self.students)
        except (OSError, ValueError) as problem:
            raise GradingError(f"{path}: {problem}") from None
        self.points = {name: self.points[name] for name in self._weights}

    def _read(self, path):
        """The table of an assignment as {id: (state, points, points possible)}; notes who the students are."""
        sheet = tables.read_sheet(path, [ID, TOTAL, POSSIBLE], [NAME, SECTION, STATE])
        self._without_jail |= JAILLESS in sheet.table.header
        faults, cells = tables.Faults(path.name), {}
        for line, row in sheet.rows:
            student = self._ids.setdefault(row[ID].casefold(), row[ID])  # a list of one's own may have other capitals
            points, possible = tables.number(row[TOTAL]), tables.number(row[POSSIBLE])
            if not possible or (points is None and row[TOTAL]):
                faults.add(line, f"{row[TOTAL]!r} of {row[POSSIBLE]!r}: expected numbers, the first perhaps none")
            elif not student or student in cells:
                faults.add(line, f"the id is {student!r}: expected one, and each once")
            else:
                cells[student] = (row.get(STATE) or WAITS) if points is None else GRADED, points or 0.0, possible
                name, section = self.students.get(student, ("", ""))
                self.students[student] = row.get(NAME) or name, row.get(SECTION) or section
        faults.demand_none()
        return cells

    def of(self, student: str) -> tuple[dict[str, tuple[str, float, float]], list[str], float | None]:
        """Return what a student has: {assignment: (state, points, points possible)}, what is dropped, and the total.

        The total is in percent; None where something is not decided, or nothing counts.
        """
        cells = {name: self._cells[name].get(student, (UNKNOWN, 0.0, self.points[name])) for name in self.points}
        cells |= {name: (EXCUSED, *cells[name][1:]) for name in self._excused.get(student, ())}
        counting = [name for name in cells if cells[name][0] != EXCUSED and self._weights[name]]
        counts = {name: cells[name][1] / cells[name][2] for name in counting}
        droppable = sorted((name for name in counts if name in (self._drop["of"] or counts)), key=counts.__getitem__)
        dropped = droppable[: min(int(self._drop["lowest"]), len(droppable) - 1)] if droppable else []
        weights = {name: self._weights[name] for name in counts if name not in dropped}
        if not counts or any(cells[name][0] not in (GRADED, MISSING) for name in counts):
            return cells, [], None
        return cells, dropped, 100 * sum(weights[name] * counts[name] for name in weights) / sum(weights.values())

    def table(self) -> str:
        """Return the table as CSV: a row for each student, with a column for each assignment, and the total."""
        points = [f"{name} of {number(points)}" for name, points in self.points.items()]
        head = [ID, NAME, SECTION, *points, "dropped", "total in percent"]
        rows = [[*head, JAILLESS] if self._without_jail else head]
        for student, who in self.students.items():
            cells, dropped, total = self.of(student)
            shown = [number(points) if state == GRADED else state for state, points, _ in cells.values()]
            rows.append([student, *who, *shown, ", ".join(dropped), "" if total is None else number(total)])
        return tables.as_text(rows, bom=True)

    def notes(self) -> list[str]:
        """Return sentences on what is missing, waits, or is not known."""
        found: dict[tuple[str, str], list[str]] = {}
        for student in self.students:
            for name, (state, *_) in self.of(student)[0].items():
                if state in _SAYS:
                    found.setdefault((name, state), []).append(student)
        return [f"{name}: {in_short(who)} {_SAYS[state]}" for (name, state), who in sorted(found.items())]


def _settings(said, assignments, students):
    """What is said of weights, of the drop, and of who is excused. Raises ValueError for what is none of it."""

    def demand(names, known, what):
        for name in names:
            if name not in known:
                raise ValueError(f"there is no {what} {name!r}: {did_you_mean(str(name), known)}")

    demand(said, _SETTINGS, "setting")
    for name, value in said.items():
        if not isinstance(value, dict):
            raise ValueError(f"{name} is {value!r}: expected a table")
    weights, drop, excused = (usual | said.get(name, {}) for name, usual in _SETTINGS.items())
    demand(weights, assignments, "assignment")
    demand(drop, _SETTINGS["drop"], "setting")
    demand(excused, students, "student")
    for name, names in [("of", drop["of"]), *excused.items()]:
        if not isinstance(names, list):
            raise ValueError(f"{name} is {names!r}: expected names of assignments, in brackets")
        demand(names, assignments, "assignment")
    if without := [name for name in assignments if weights and name not in weights]:
        raise ValueError(f"{without[0]} has no weight: expected one, 0 where it does not count")
    for name, value in [("lowest", drop["lowest"]), *weights.items()]:
        if type(value) not in (int, float) or not 0 <= value < float("inf"):
            raise ValueError(f"{name} is {value!r}: expected a number from 0")
    return weights or assignments, drop, excused
