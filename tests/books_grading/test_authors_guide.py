"""The author's guide is true: its page, and the pages for each kind, are assignments that a class can have."""

import re
from pathlib import Path

import pytest

from exercisebook.judging import RIGHT
from exercisegrader import trial
from exercisegrader.assignment import Assignment, load
from exercisegrader.inside.answer_sheet import FORMS
from exercisegrader.release import notebook
from exercisegrader.student import Student
from loopbook.exercises.kinds import MAKERS

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "docs" / "authors.md").read_text(encoding="utf-8")
SOURCE = re.search(r"^````markdown\n(.*?)^````$", GUIDE, re.MULTILINE | re.DOTALL)[1]
PAGE = Assignment.of(SOURCE, "heater", Path("heater.md"))
KINDS = load(ROOT / "examples" / "kinds" / "kinds.md")
STUDENTS = [f"s{number:03}" for number in range(12)]
EXERCISES = [(PAGE, number) for number in PAGE.exercises] + [(KINDS, number) for number in KINDS.exercises]


def test_each_usual_kind_has_a_page():
    asked = {one.maker for number in KINDS.exercises for one in KINDS.question("s1", number).key.values()}
    assert {*MAKERS} - asked <= {"sequential_chart", "instrument_diagram", "span"}


@pytest.mark.parametrize(("assignment", "number"), EXERCISES)
def test_a_page_of_the_guide_surprises_nobody(assignment, number):
    for found in trial.try_all(trial.only(assignment, [number]), STUDENTS, seconds=120):
        assert not [one for one in found.surprises if one.level != trial.NOTE], trial.as_text(found)


def test_a_key_that_is_not_what_another_way_makes_is_said_in_the_trial():
    wrong = Assignment.of(SOURCE.replace("t = A*h/(q/2)/2", "t = A*h/q/2"), "heater", Path("heater.md"))
    (found, *_) = trial.try_all(wrong, STUDENTS, seconds=120)
    assert [one.says for one in found.surprises if one.level == trial.WRONG] == [
        "the check t = A*h/q/2 does not hold, in all 12 variants"
    ]


@pytest.mark.parametrize(("assignment", "number"), EXERCISES)
def test_a_page_of_the_guide_can_be_released_and_answered(assignment, number):
    made = notebook(assignment, Student("s1", "Ada"))
    assert any("sheet.answer(" in cell.source for cell in made.cells)
    variant = trial.Variant("s1", 0, assignment.question("s1", number), 0.0)
    for name, one in variant.key.items():
        form = eval(one.asking, dict(FORMS))
        assert one.by_hand or variant.judged(name, one.as_given).status == RIGHT
        assert one.by_hand or form.read(one.as_given)
        assert (form.key, form.asking) == (None, one.asking)
