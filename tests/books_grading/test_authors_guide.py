"""The author's guide is true: a class can have its assignments."""

import re
from pathlib import Path

import pytest

from exercisebook.judging import RIGHT
from exercisegrader import trial
from exercisegrader.assignment import Assignment
from exercisegrader.release import notebook
from exercisegrader.student import Student
from exercisegrader.student_side.answer_sheet import FORMS

GUIDE = (Path(__file__).parents[2] / "docs" / "authors.md").read_text(encoding="utf-8")
#: The assignments of the guide by the headings above them: {kind of answers: text of the module}.
ASSIGNMENTS = dict(
    re.findall(
        r"^### (\w+)\n.*?^```python\n(.*?)^```$",
        GUIDE.partition("\n## A whole assignment for each kind\n")[2],
        re.MULTILINE | re.DOTALL,
    )
)
STUDENTS = [f"s{number:03}" for number in range(24)]


@pytest.mark.parametrize("kind", ASSIGNMENTS)
def test_an_assignment_of_the_guide_asks_for_its_kind_and_surprises_nobody(kind):
    assignment = Assignment.of(ASSIGNMENTS[kind], kind)
    asked = [one.maker for number in assignment.exercises for one in assignment.question("s1", number).key.values()]
    assert kind in asked
    for found in trial.try_all(assignment, STUDENTS, seconds=60):
        assert not [one for one in found.surprises if one.level != trial.NOTE], trial.as_text(found)


@pytest.mark.parametrize("kind", ASSIGNMENTS)
def test_an_assignment_of_the_guide_can_be_released_and_answered(kind):
    assignment = Assignment.of(ASSIGNMENTS[kind], kind)
    made = notebook(assignment, Student("s1", "Ada"))
    assert any("sheet.answer(" in cell.source for cell in made.cells)
    for number in assignment.exercises:
        variant = trial.Variant("s1", 0, assignment.question("s1", number), 0.0)
        for name, one in variant.key.items():
            form = eval(one.asking, dict(FORMS))
            assert variant.judged(name, one.as_given).status == RIGHT
            assert form.read(one.as_given)
            assert (form.key, form.asking) == (None, one.asking)
