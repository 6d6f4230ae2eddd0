"""Masks on what books of control engineering ask: formulas of the course and the chapters, controllers, diagrams."""

from pathlib import Path

import pytest

from exercisebook.kinds import Expression
from exercisegrader.assignment import load
from hostile import targets
from hostile.masked import CONTROLLER_MASKS, HEDGES, HONEST, MASKS, SPOILED
from hostile.targets import target
from loopbook.exercises.bank import chapters, exercises
from loopbook.exercises.kinds import Settings, TransferFunction
from loopbook.exercises.kinds.instrument_diagram import InstrumentDiagram
from loopbook.pid import PID

COURSE = load(Path(__file__).parents[2] / "examples" / "course" / "air_heater.py")
LEVEL = InstrumentDiagram("vessel -> LT1 -> LC1 -> LV1 -> out", {"vessel": "vessel", "in": "pipe", "out": "pipe"})
#: Kinds, with a right and a wrong answer.
PAIRS = [
    (Settings(PID(2, 10)), "Kp = 2, Ti = 10", "Kp = 3, Ti = 10"),
    (TransferFunction("2*exp(-3*s)/(10*s + 1)"), "2*exp(-3*s)/(10*s + 1)", "2/(10*s + 1)"),
    (LEVEL, "vessel -> LT1 -> LC1 -> LV1 -> out", "vessel -> LT1 -> LC1 -> LV1 -> in"),
    (LEVEL, "vessel -> LT1 -> LC1 -> LV1 -> out", "vessel -> LT1 -> LC1 -//-> LV1 -> out"),
]
CONTROLLERS = [
    (Settings(PID(2, 10)), 3, 10),
    (Settings(PID(2)), 3, 10),
    (Settings(PID(2.5, 10, 1.6)), 2, 8),
    (Settings(PID(2, 8, 2, form="serial"), form="serial"), 2.5, 10),
    (COURSE.question("s1001", "3").key["pid"], 500, 1),
    (COURSE.question("s1001", "5").key["pid"], 500, 1),
]


def of_question(question):
    """The formulas that a question asks for, with their declared mistakes."""
    for name, kind in question.key.items():
        wrong = [str(value) for _, value in question.mistakes[name]]
        if isinstance(kind, Expression) and wrong:
            yield target(kind, *wrong)


OF_COURSE = [one for number in COURSE.exercises for one in of_question(COURSE.question("s1001", number))]
OF_CHAPTERS = [
    one
    for chapter in chapters()
    for exercise in exercises(chapter).values()
    for one in of_question(exercise.question("somebody"))
]


@pytest.mark.parametrize("mask", MASKS, ids=lambda mask: mask.name)
def test_a_masked_formula_earns_nothing(mask):
    targets.assert_masked_earns_nothing(mask, OF_COURSE + OF_CHAPTERS)


@pytest.mark.parametrize("mask", [mask for mask in MASKS if mask.hides], ids=lambda mask: mask.name)
def test_an_answer_without_a_value_is_never_right_and_is_looked_at(mask):
    targets.assert_looked_at(mask, OF_COURSE[0])


@pytest.mark.parametrize("name", SPOILED)
def test_a_right_answer_that_is_spoiled_unseen_earns_nothing(name):
    targets.assert_spoiled_earns_nothing(name, OF_COURSE[:1])


@pytest.mark.parametrize("form", HONEST)
def test_an_honest_form_stays_right(form):
    targets.assert_stays_right(form, OF_COURSE)


@pytest.mark.parametrize("mask", CONTROLLER_MASKS, ids=lambda mask: mask.name)
def test_a_masked_controller_earns_nothing(mask):
    for kind, Kp, Ti in CONTROLLERS:
        targets.assert_earns_nothing(kind, mask.wears(Kp, Ti))


@pytest.mark.parametrize("hedge", HEDGES)
def test_two_answers_in_one_earn_nothing(hedge):
    targets.assert_hedged_earns_nothing(hedge, PAIRS)


def test_of_two_answers_in_one_each_alone_is_judged():
    targets.assert_each_alone_is_judged(PAIRS)
