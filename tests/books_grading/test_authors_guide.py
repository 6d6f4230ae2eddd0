"""The author's guide is true: its calls are those of the functions, and a class can have its assignments."""

import pytest

import authors_guide
from exercisebook.judging import RIGHT
from exercisegrader import trial
from exercisegrader.assignment import Assignment
from exercisegrader.release import notebook
from exercisegrader.student import Student
from exercisegrader.student_side.answer_sheet import FORMS

ASSIGNMENTS = authors_guide.assignments()
STUDENTS = [f"s{number:03}" for number in range(24)]


@pytest.mark.parametrize("name", [*authors_guide.TOOLS, *authors_guide.METHODS, *authors_guide.kinds()])
def test_a_call_is_as_the_guide_says(name):
    said, words = authors_guide.rows().get(name, ("", ""))
    call = authors_guide.call(name)
    assert said == call, f"docs/authors.md has no row {call}: authors_guide.py beside this prints the rows"
    assert words


@pytest.mark.parametrize("kind", sorted({*ASSIGNMENTS, *authors_guide.kinds()}))
def test_each_kind_of_answers_has_an_assignment(kind):
    assert kind in [*ASSIGNMENTS], f"docs/authors.md has no assignment for {kind}: expected one below a line ### {kind}"
    assert kind in authors_guide.kinds(), f"docs/authors.md has an assignment for {kind}, which is no kind of answers"


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
