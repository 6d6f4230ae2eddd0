"""No mask makes a wrong answer right, and honest answers stay right in any form."""

import zlib
from pathlib import Path
from typing import NamedTuple

import pytest

from draws import draws
from exercisebook.judging import RIGHT, UNJUDGED, is_right, judge
from exercisegrader.assignment import load
from hostile.masked import CONTROLLER_MASKS, HEDGES, HONEST, MASKS, NUMBER_MASKS, ROW_MASKS, SPOILED, hedged
from loopbook.exercises.bank import chapters, exercises
from loopbook.exercises.kinds import (
    Expression,
    Kind,
    Number,
    Numbers,
    Poles,
    Settings,
    TimeFunction,
    TransferFunction,
    Word,
    Words,
)
from loopbook.exercises.kinds.instrument_diagram import InstrumentDiagram
from loopbook.pid import PID

AIR_HEATER = Path(__file__).parents[2] / "examples" / "course" / "air_heater.py"
COURSE = load(AIR_HEATER)


class Target(NamedTuple):
    """A question after a formula, its right answer, wrong ones, and a variable in all of them."""

    kind: Kind
    right: str
    wrong: tuple[str, ...]
    x: str


def target(kind, *wrong):
    return Target(kind, kind.key.text, wrong, kind.symbols[0])


OWN = [
    target(
        TransferFunction("1.9*exp(-30*s)/(7*s + 1)"),
        "1.9*exp(-7*s)/(30*s + 1)", "1.9/(7*s + 1)", "1.9*(1 - 15*s)/((1 + 15*s)*(7*s + 1))", "1.9", "0",
        "1.9*exp(-33*s)/(7*s + 1)", "1.9/((7*s + 1)*(30*s + 1))",
    ),
    target(TransferFunction("0.4*exp(-3*s)/s"), "0.4/s", "0.4*exp(-3*s)/(s + 0.01)", "0.4/(s*(1 + 3*s))"),
    target(TransferFunction("2.5*(1 + 1/(12*s))"), "2.5", "2.5 + 1/(12*s)", "2.5*(1 + 12*s)", "2.5/(12*s)"),
    target(
        TransferFunction("3*(1 - 2*s)/((10*s + 1)*(4*s + 1))"),
        "3*(1 + 2*s)/((10*s + 1)*(4*s + 1))", "3*exp(-2*s)/((10*s + 1)*(4*s + 1))", "3*(1 - 2*s)/(14*s + 1)",
    ),
    target(
        TransferFunction("K*exp(-tau*s)/(T*s + 1)"),
        "K/(T*s + 1)", "K*exp(-T*s)/(tau*s + 1)", "K*(1 - tau*s/2)/((1 + tau*s/2)*(T*s + 1))",
    ),
    target(Expression("T/(K*(Tc + delay))"), "T/(K*Tc)", "T/(K*delay)", "K*T/(Tc + delay)", "0"),
    target(Expression("K/(1 + K*K_p)"), "1/(1 + K*K_p)", "K", "1/K_p"),
    target(
        TimeFunction("3*(1 - exp(-(t - 4)/10))*Heaviside(t - 4)", until=60),
        "3*(1 - exp(-t/10))", "3*(1 - exp(-(t - 4)/10))", "3*(1 - exp(-(t - 10)/4))*Heaviside(t - 10)", "3", "0",
    ),
    target(TimeFunction("2*t - 8 + 8*exp(-t/4)", until=40), "2*t - 8", "2*t", "2*(1 - exp(-t/4))"),
]  # fmt: skip


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


def some(mask):
    """Targets for a mask, each with one of its wrong answers; others for other masks."""
    number, targets = zlib.crc32(mask.name.encode()), OF_COURSE + OWN + OF_CHAPTERS
    for k in range(draws(3)):
        one = targets[(number + 17 * k) % len(targets)]
        yield one, one.wrong[(number // len(targets) + k) % len(one.wrong)]


def assert_nothing_earned(kind, answer):
    verdict = judge("x", kind, answer)
    assert verdict.status != RIGHT, (verdict, kind.solution, answer)


@pytest.mark.parametrize("mask", MASKS, ids=lambda mask: mask.name)
def test_a_masked_formula_earns_nothing(mask):
    for one, wrong in some(mask):
        answer = mask.wears(wrong, one.x)
        assert not is_right(one.kind, answer), (one.kind.solution, answer)


@pytest.mark.parametrize("mask", [mask for mask in MASKS if mask.hides], ids=lambda mask: mask.name)
def test_an_answer_without_a_value_is_never_right_and_is_looked_at(mask):
    one = OF_COURSE[0]
    verdict = judge("H", one.kind, mask.wears(one.right, one.x))
    assert verdict.status != RIGHT, verdict
    assert verdict.look or verdict.status == UNJUDGED, verdict


@pytest.mark.parametrize("name", SPOILED)
def test_a_right_answer_that_is_spoiled_unseen_earns_nothing(name):
    for one in (OF_COURSE[0], OWN[0], OWN[1]):
        answer = SPOILED[name].replace("R", f"({one.right})").replace("X", one.x)
        assert not is_right(one.kind, answer), (one.kind.solution, answer)


@pytest.mark.parametrize("form", HONEST)
def test_an_honest_form_stays_right(form):
    for one in (*OF_COURSE, *OWN):
        answer = form.replace("R", f"({one.right})").replace("X", one.x)
        assert is_right(one.kind, answer), (one.kind.solution, answer)


def test_what_is_too_small_for_decimals_on_the_way_is_worked_out():
    kind = TransferFunction("K*exp(-tau*s)/(T*s + 1)")
    assert is_right(kind, f"({kind.key.text})*({kind.key.text})/({kind.key.text})")


@pytest.mark.parametrize("mask", NUMBER_MASKS, ids=lambda mask: mask.name)
def test_a_masked_number_earns_nothing(mask):
    for kind, wrong in (
        (Number(120, "s"), "90"),
        (Number(12, "%"), "1.2"),
        (Number(4, what="the number of batches", within=0), "3"),
        (Number(-0.5), "0.5"),
        (Number(0), "2"),
    ):
        assert_nothing_earned(kind, mask.wears(wrong, "x"))


@pytest.mark.parametrize("mask", ROW_MASKS, ids=lambda mask: mask.name)
def test_a_masked_row_earns_nothing(mask):
    for kind, wrong in (
        (Numbers([1, 2, 4]), [1, 2, 3]),
        (Numbers([[0, 1], [-2, -3]]), [0, 1, -2, 3]),
        (Numbers([1, 0]), [1, 1]),
        (Poles([-1, -2]), [-1, -3]),
        (Poles([-2, -2]), [-2, -3]),
        (Poles([0]), [1]),
    ):
        assert_nothing_earned(kind, mask.wears(wrong))


@pytest.mark.parametrize("mask", CONTROLLER_MASKS, ids=lambda mask: mask.name)
def test_a_masked_controller_earns_nothing(mask):
    for kind, Kp, Ti in (
        (Settings(PID(2, 10)), 3, 10),
        (Settings(PID(2)), 3, 10),
        (Settings(PID(2.5, 10, 1.6)), 2, 8),
        (Settings(PID(2, 8, 2, form="serial"), form="serial"), 2.5, 10),
        (COURSE.question("s1001", "3").key["pid"], 500, 1),
        (COURSE.question("s1001", "5").key["pid"], 500, 1),
    ):
        assert_nothing_earned(kind, mask.wears(Kp, Ti))


LEVEL = InstrumentDiagram("vessel -> LT1 -> LC1 -> LV1 -> out", {"vessel": "vessel", "in": "pipe", "out": "pipe"})
#: Kinds, with a right and a wrong answer.
PAIRS = [
    (Number(120, "s"), "120", "90"),
    (Number(2.5), "2.5", "4"),
    (Number(-5), "-5", "5"),
    (Number(5), "5", "-5"),
    (Numbers([1, 2, 3]), "[1, 2, 3]", "[1, 2, 4]"),
    (Poles([-1, -2]), "[-1, -2]", "[-1, -3]"),
    (Poles([-1.5]), "-1.5", "-4"),
    (Settings(PID(2, 10)), "Kp = 2, Ti = 10", "Kp = 3, Ti = 10"),
    (Word("reverse", ["reverse", "direct"]), "reverse", "direct"),
    (Word("yes", ["yes", "no"]), "yes", "no"),
    (Word("no", ["yes", "no"]), "no", "yes"),
    (Word("V2", ["V1", "V2", "V3"]), "V2", "V1"),
    (Words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S2, S4", "S1"),
    (Words(["A", "B"], ["A", "B", "C"], ordered=True), "A, B", "B, A"),
    (TransferFunction("2*exp(-3*s)/(10*s + 1)"), "2*exp(-3*s)/(10*s + 1)", "2/(10*s + 1)"),
    (Expression("K*Kp/(1 + K*Kp)"), "K*Kp/(1 + K*Kp)", "1/(1 + K*Kp)"),
    (Expression("K/T", symbols="K T Kp"), "K/T", "K/Kp"),
    (TimeFunction("3*t", until=10), "3*t", "2*t"),
    (LEVEL, "vessel -> LT1 -> LC1 -> LV1 -> out", "vessel -> LT1 -> LC1 -> LV1 -> in"),
    (LEVEL, "vessel -> LT1 -> LC1 -> LV1 -> out", "vessel -> LT1 -> LC1 -//-> LV1 -> out"),
]


@pytest.mark.parametrize("hedge", HEDGES)
def test_two_answers_in_one_earn_nothing(hedge):
    for kind, right, wrong in PAIRS:
        assert_nothing_earned(kind, hedged(hedge, right, wrong))


@pytest.mark.parametrize(("kind", "right", "wrong"), PAIRS, ids=lambda one: type(one).__name__)
def test_of_two_answers_in_one_each_alone_is_judged(kind, right, wrong):
    assert is_right(kind, right)
    assert not is_right(kind, wrong)


def test_the_corpus_has_no_name_twice_and_says_why():
    masks = [*MASKS, *NUMBER_MASKS, *ROW_MASKS, *CONTROLLER_MASKS]
    assert len({mask.name for mask in masks}) == len(masks)
    assert all(mask.why for mask in masks)
