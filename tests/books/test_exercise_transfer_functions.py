"""Answers that are transfer functions, and what is said of wrong ones and of wrong settings beside the givens."""

import pytest
import sympy

from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG, judge
from judged import assert_is_tried_in_its_forms, assert_judged, assert_suffers_no_harm
from loopbook import s
from loopbook.deadtime import System
from loopbook.exercises.authoring import answers, between, exercise, number, settings, transfer_function
from loopbook.pid import PID

H = transfer_function(3 * sympy.exp(-2 * s) / (5 * s + 1))
KINDS = [
    H,
    transfer_function("K/(T*s + 1)", symbols="K T"),
    settings(PID(2, Ti=10)),
    settings(PID(2, Ti=10), "%/K", "min", form="serial"),
]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.asking)
def test_it_is_tried_in_its_forms_and_no_answer_does_it_harm(kind):
    assert_suffers_no_harm(kind)
    assert_is_tried_in_its_forms(kind)


@pytest.mark.parametrize(
    ("given", "status", "says"),
    [
        ("0.6*exp(-2*s)/(s + 0.2)", RIGHT, "right"),
        (System(3 * sympy.exp(-2 * s) / (5 * s + 1)), RIGHT, "right"),
        (3 / (5 * s + 1), MISTAKE, "dead time is missing"),
        (3 * sympy.exp(2 * s) / (5 * s + 1), MISTAKE, "sign in the exponent"),
        (3 * (1 - s) / (1 + s) / (5 * s + 1), MISTAKE, "Pade"),
        (3 * sympy.exp(-2 * s) / (5 * s + 1) / s, MISTAKE, "a factor s is missing in it"),
        (3 * s * sympy.exp(-2 * s) / (5 * s + 1), MISTAKE, "factor s too many"),
        (sympy.exp(2 * s) * (5 * s + 1) / 3, MISTAKE, "inverse"),
        ("3*exp(-120*s)/(300*s + 1)", MISTAKE, "unit of time"),
        ("3/(tau*s + 1)", UNJUDGED, "'tau' is not a symbol"),
        ("0", WRONG, "that is 0, and the right one is not"),
    ],
)
def test_judging(given, status, says):
    assert_judged(H, given, status, says)


@exercise("1.1", title="A tank", points=1)
def tank(
    K=between(1, 9, "K/%", reference=3), T=between(10, 90, "s", reference=40), tau=between(1, 20, "s", reference=8)
):
    """A tank with {K}, {T}, {tau}."""
    return answers(
        pid=settings(PID(T / (2 * K * tau), T), "%/K", "s", "the settings"),
        H=transfer_function(K * sympy.exp(-tau * s) / (T * s + 1)),
        M=transfer_function(K / (T * s + 1 + K)),
        gain=number(K / (1 + K), "", "the gain of the loop"),
        T_M=number(T / (1 + K), "s", "the time constant of the loop"),
    )


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"pid": [2.5, 40]}, "Ti is right; that is what comes out without the 3\xa0K/%"),
        ({"pid": [0.8333, 8]}, "Kp is right; Ti: that is the same number as the 8\xa0s of the question"),
        ({"pid": PID(0.8333)}, "Kp is right; Ti: the integral term is missing"),
        ({"pid": PID(0.8333, 40, 5)}, "a derivative term is not asked for"),
        ({"pid": PID(40, 0.8333)}, "Kp and Ti are interchanged"),
        ({"H": "3*exp(-40*s)/(8*s + 1)"}, "with 40\xa0s and 8\xa0s interchanged"),
        ({"H": "3*exp(-8*s)/(40*s - 1)"}, "one sign is wrong"),
        ({"H": "3*exp(-8*s)/(37*s + 1)"}, "its static gain and dead time are right, but its poles are not"),
        ({"H": "3*exp(-5*s)/(40*s + 1)"}, "its static gain and poles are right, but its dead time is not"),
        ({"H": "3*exp(-8*s)/(s + 40)"}, "its poles are one divided by those that it should have"),
        ({"H": "7*exp(-8*s)/(40*s + 1)"}, "it is right but for a constant factor"),
        ({"H": "3*exp(-8*s)/(40*s + 1)/(5*s + 1)"}, "it has too many poles"),
        ({"M": "3/(40*s + 1 - 3)", "gain": -1.5}, "gain: this is right for what you have for"),
        ({"M": "3/(40*s + 1 + 9)", "T_M": 4}, "T_M: this is right for what you have for"),
    ],
)
def test_responses(given, says):
    assert says in repr(tank.question().check(**given))


def test_a_dead_time_of_several_digits_leaves_no_poles_behind():
    says = judge("H", transfer_function("exp(-15*s)/s"), "exp(-5.4*s)/s").says
    assert says.startswith("its gain at low frequencies and poles are right, but its dead time is not")


def test_rounding_does_not_choose_between_two_corners_that_change_a_formula_alike():
    said = set()
    for gain in range(1, 8):
        kind = transfer_function(f"{gain}*(480*s + 12)*exp(-6*s)/(20*s + 4/5)")
        says = judge("F", kind, f"35*{gain} + 5*{gain}*(480*s + 12)*exp(-6*s)/(20*s + 4/5)").says
        said.add(says.partition(" · ")[0])
    assert len(said) == 1
