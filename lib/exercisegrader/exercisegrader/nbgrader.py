"""An assignment for courses that run nbgrader: its source notebook, with cells of nbgrader's schema 3.

What is lost there: nbgrader puts the hidden tests back into the student's notebook and runs both in one process. The
keys stand in that process and the comparison happens in it, so that code of the student can read or replace them. All
students get the same numbers, and a feedback page made by nbgrader shows the hidden tests with the keys.

Source of the schema and of the marks in the cells: jupyter/nbgrader, nbgrader/nbgraderformat/v3.json and the
preprocessors clearsolutions.py and clearhiddentests.py, version 0.9.6.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from nbformat import v4

from exercisebook import judging
from exercisebook.kinds.kind import literal
from exercisegrader.inside.plain import unreadable
from exercisegrader.release import answer_call, asked, bare, set_up, statement_cells, wrapped

if TYPE_CHECKING:
    from nbformat import NotebookNode

    from exercisebook.kinds import Kind
    from exercisegrader.assignment import Assignment

SCHEMA = 3
_HOW_TO_ANSWER = "Assign your answers to the names that are listed, in the place of the comment, and run the cell."


def source(assignment: Assignment, student_id: str | None = None) -> NotebookNode:
    """Return the source notebook of an assignment, for ``nbgrader generate_assignment``.

    An exercise is a locked statement, a cell with the solution between nbgrader's marks, and a locked cell whose
    hidden tests judge and end in the points. What cannot be written into a cell is graded by hand: designs, whose
    criteria are functions, and formulas with pieces; so are figures and texts.

    Arguments:
        student_id: whose variant; the reference variant if not given, as all students of nbgrader get one source.
    Raises:
        GradingError: where a variant fails.
    """
    questions = {number: asked(assignment, student_id, number) for number in assignment.exercises}
    parts = [f"# {assignment.title}", assignment.introduction, _HOW_TO_ANSWER]
    cells = [(v4.new_markdown_cell("\n\n".join(part for part in parts if part)), _locked("introduction"))]
    for k, code in enumerate(set_up(assignment.title, student_id or "", questions), start=1):
        cells.append((v4.new_code_cell(code), _locked(f"sheet-{k}")))
    for place, (number, question) in enumerate(questions.items(), start=1):
        cells += _cells(f"exercise-{place}", number, question)
    made = bare([cell for cell, _ in cells])
    for cell, (_, marks) in zip(made.cells, cells, strict=True):
        cell.metadata["nbgrader"] = marks
    return made


def earned(
    taken: Mapping[str, Any], points: float, weights: Mapping[str, float] | None = None, /, **key: Kind
) -> float:
    """Return the points that answers earn, and print what became of each; the hidden tests end in this call.

    Arguments:
        taken: {quantity: plain data}, from `AnswerSheet.taken`.
        points: of these quantities together.
        weights: {quantity: what it counts}; the others count 1.
        key: a kind with its key for each quantity.

    >>> from exercisebook.authoring import number
    >>> earned({"Ti": 10, "Kp": "much"}, 4, Ti=number(10, "s"), Kp=number(2))
    Ti: right
    Kp: 'much' is a text that is not a number: expected a number
    2.0
    """
    verdicts = [judging.judge(name, kind, taken.get(name)) for name, kind in key.items()]
    for one in verdicts:
        print(f"{one.name}: {unreadable(taken.get(one.name)) or one.says}")
    right = _weight([verdict.name for verdict in verdicts if verdict.is_right], weights or {})
    return judging.earned(points, right, _weight(key, weights or {}))


def _weight(names, weights):
    """What some quantities count together."""
    return sum(weights.get(name, 1) for name in names)


def _cells(grade_id, number, question):
    """The cells of an exercise, each with its marks."""
    for k, cell in enumerate(statement_cells(question)):
        yield cell, _locked(f"{grade_id}-statement" if k == 0 else f"{grade_id}-data")
    calls = {name: kind.making and f"authoring.{kind.making}" for name, kind in question.key.items()}
    judged = {name: kind for name, kind in question.key.items() if calls[name]}
    others = {name: kind for name, kind in question.key.items() if not calls[name]}
    points, weights = question.exercise.points, question.exercise.weights
    asked = _weight(question.key, weights)
    if judged:
        part = judging.earned(points, _weight(judged, weights), asked)
        yield v4.new_code_cell(_solved(number, judged)), _marks(grade_id, solution=True)
        counted = {name: weights[name] for name in judged if name in weights}
        test = v4.new_code_cell(_hidden_tests(number, {name: calls[name] for name in judged}, part, counted))
        yield test, _marks(f"{grade_id}-test", grade=True, locked=True, points=part)
    if others:
        part = judging.earned(points, _weight(others, weights), asked)
        by_hand = _marks(f"{grade_id}-by-hand", grade=True, solution=True, points=part)
        yield v4.new_code_cell(_solved(number, others)), by_hand


def _locked(grade_id):
    return _marks(grade_id, locked=True)


def _marks(grade_id, grade=False, solution=False, locked=False, points=None):
    marks = {
        "schema_version": SCHEMA, "grade_id": grade_id, "grade": grade, "solution": solution, "locked": locked,
        "task": False,
    }  # fmt: skip
    return marks | ({"points": points} if grade else {})


def _solved(number, key):
    """The cell in which quantities are answered, with the solution between nbgrader's marks."""
    lines = [" = ".join([*key, "..."]), "### BEGIN SOLUTION"]
    lines += [wrapped(f"{name} = {kind.as_code()}") for name, kind in key.items()]
    lines += ["### END SOLUTION", answer_call(number, {name: name for name in key})]
    return "\n".join(lines)


def _hidden_tests(number, calls, points, weights):
    lines = [f"# The answers to exercise {number} are judged here.", "### BEGIN HIDDEN TESTS"]
    # by its module: the student may have a number or poles of another meaning
    lines.append("from exercisebook import authoring")
    lines.append("from exercisegrader.nbgrader import earned")
    arguments = [f"sheet.taken({literal(number)})", repr(points), *([literal(weights)] if weights else [])]
    arguments += [f"{name}={call}" for name, call in calls.items()]
    return "\n".join([*lines, wrapped(f"earned({', '.join(arguments)})"), "### END HIDDEN TESTS"])
