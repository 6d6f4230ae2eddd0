"""No mask makes a wrong answer right, and honest answers stay right in any form."""

import pytest

from exercisebook.kinds import Expression, Number, Numbers, Poles, TimeFunction, Word, Words
from hostile import targets
from hostile.masked import CONTROLLER_MASKS, HEDGES, HONEST, MASKS, NUMBER_MASKS, ROW_MASKS, SPOILED
from hostile.targets import target

OWN = [
    target(
        Expression("1.9*exp(-30*s)/(7*s + 1)"),
        "1.9*exp(-7*s)/(30*s + 1)", "1.9/(7*s + 1)", "1.9*(1 - 15*s)/((1 + 15*s)*(7*s + 1))", "1.9", "0",
        "1.9*exp(-33*s)/(7*s + 1)", "1.9/((7*s + 1)*(30*s + 1))",
    ),
    target(Expression("0.4*exp(-3*s)/s"), "0.4/s", "0.4*exp(-3*s)/(s + 0.01)", "0.4/(s*(1 + 3*s))"),
    target(Expression("2.5*(1 + 1/(12*s))"), "2.5", "2.5 + 1/(12*s)", "2.5*(1 + 12*s)", "2.5/(12*s)"),
    target(
        Expression("3*(1 - 2*s)/((10*s + 1)*(4*s + 1))"),
        "3*(1 + 2*s)/((10*s + 1)*(4*s + 1))", "3*exp(-2*s)/((10*s + 1)*(4*s + 1))", "3*(1 - 2*s)/(14*s + 1)",
    ),
    target(
        Expression("K*exp(-tau*s)/(T*s + 1)"),
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
#: Kinds, with a right and a wrong answer.
PAIRS = [
    (Number(120, "s"), "120", "90"),
    (Number(2.5), "2.5", "4"),
    (Number(-5), "-5", "5"),
    (Number(5), "5", "-5"),
    (Numbers([1, 2, 3]), "[1, 2, 3]", "[1, 2, 4]"),
    (Poles([-1, -2]), "[-1, -2]", "[-1, -3]"),
    (Poles([-1.5]), "-1.5", "-4"),
    (Word("reverse", ["reverse", "direct"]), "reverse", "direct"),
    (Word("yes", ["yes", "no"]), "yes", "no"),
    (Word("no", ["yes", "no"]), "no", "yes"),
    (Word("V2", ["V1", "V2", "V3"]), "V2", "V1"),
    (Words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S2, S4", "S1"),
    (Words(["A", "B"], ["A", "B", "C"], ordered=True), "A, B", "B, A"),
    (Expression("2*exp(-3*s)/(10*s + 1)"), "2*exp(-3*s)/(10*s + 1)", "2/(10*s + 1)"),
    (Expression("K*Kp/(1 + K*Kp)"), "K*Kp/(1 + K*Kp)", "1/(1 + K*Kp)"),
    (Expression("K/T", symbols="K T Kp"), "K/T", "K/Kp"),
    (TimeFunction("3*t", until=10), "3*t", "2*t"),
]
NUMBERS = [
    (Number(120, "s"), "90"),
    (Number(12, "%"), "1.2"),
    (Number(4, what="the number of batches", within=0), "3"),
    (Number(-0.5), "0.5"),
    (Number(0), "2"),
]
ROWS = [
    (Numbers([1, 2, 4]), [1, 2, 3]),
    (Numbers([[0, 1], [-2, -3]]), [0, 1, -2, 3]),
    (Numbers([1, 0]), [1, 1]),
    (Poles([-1, -2]), [-1, -3]),
    (Poles([-2, -2]), [-2, -3]),
    (Poles([0]), [1]),
]


def each(masks):
    return pytest.mark.parametrize("mask", masks, ids=lambda mask: mask.name)


@each(MASKS)
def test_a_masked_formula_earns_nothing(mask):
    targets.assert_masked_earns_nothing(mask, OWN)


@each([mask for mask in MASKS if mask.hides])
def test_an_answer_without_a_value_is_never_right_and_is_looked_at(mask):
    targets.assert_looked_at(mask, OWN[0])


@pytest.mark.parametrize("name", SPOILED)
def test_a_right_answer_that_is_spoiled_unseen_earns_nothing(name):
    targets.assert_spoiled_earns_nothing(name, OWN[:2])


@pytest.mark.parametrize("form", HONEST)
def test_an_honest_form_stays_right(form):
    targets.assert_stays_right(form, OWN)


@each(NUMBER_MASKS)
def test_a_masked_number_earns_nothing(mask):
    for kind, wrong in NUMBERS:
        targets.assert_earns_nothing(kind, mask.wears(wrong, "x"))


@each(ROW_MASKS)
def test_a_masked_row_earns_nothing(mask):
    for kind, wrong in ROWS:
        targets.assert_earns_nothing(kind, mask.wears(wrong))


@pytest.mark.parametrize("hedge", HEDGES)
def test_two_answers_in_one_earn_nothing(hedge):
    targets.assert_hedged_earns_nothing(hedge, PAIRS)


def test_of_two_answers_in_one_each_alone_is_judged():
    targets.assert_each_alone_is_judged(PAIRS)


def test_the_corpus_has_no_name_twice_and_says_why():
    masks = [*MASKS, *NUMBER_MASKS, *ROW_MASKS, *CONTROLLER_MASKS]
    assert len({mask.name for mask in masks}) == len(masks)
    assert all(mask.why for mask in masks)
