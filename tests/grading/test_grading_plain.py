"""Answers as plain data: what a student gives becomes JSON, which is judged as the answer itself."""

import json
import os
from fractions import Fraction

import control
import numpy as np
import pint
import pytest
import scipy.signal
import sympy
from hypothesis import example, given
from hypothesis import strategies as st

import test_exercises as bank_forms
from exercisebook.formulas import Formula
from exercisebook.judging import OPEN, RIGHT, UNJUDGED, judge
from exercisebook.reading import Unreadable
from exercisegrader.student_side import answer_sheet
from exercisegrader.student_side.plain import LONGEST_TEXT, MOST_VALUES, plain, unreadable
from loopbook import s, t
from loopbook.deadtime import System
from loopbook.exercises import bank, kinds
from loopbook.exercises.authoring import (
    number,
    poles,
    settings,
    transfer_function,
    word,
)
from loopbook.pid import PID

X, K = sympy.symbols("x K")
PINT = pint.UnitRegistry(cache_folder=None)


class Odd:
    """An answer whose methods fail."""

    def __getattr__(self, name):
        raise RuntimeError("no")


PLAIN = [
    (None, None),
    (..., None),
    (True, True),
    (np.False_, False),
    (sympy.true, True),
    (7, 7),
    (10**299, 10**299),
    (np.int8(7), 7),
    (sympy.Integer(7), 7),
    (2.5, 2.5),
    (np.float32(2.5), 2.5),
    (np.longdouble(2.5), 2.5),
    (sympy.Float(1 / 3), 1 / 3),
    (float("nan"), "nan"),
    (-np.inf, "-inf"),
    (sympy.oo, "inf"),
    (1 + 2j, "(1+2j)"),
    (3 + 0j, 3.0),
    (np.complex64(2j), "2j"),
    (sympy.Rational(5, 2), 2.5),
    (sympy.Rational(1, 3), "1/3"),
    (Fraction(-2, 7), "-2/7"),
    (sympy.sqrt(2) / 2, "sqrt(2)/2"),
    (sympy.pi, "pi"),
    (2 * sympy.I - 1, "-1 + 2*I"),
    (sympy.LambertW(1), float(sympy.LambertW(1).n())),
    ("2 min", "2 min"),
    (np.str_("2 min"), "2 min"),
    ((1, "a", [None, ...]), [1, "a", [None, None]]),
    (range(3), [0, 1, 2]),
    (iter([1, 2]), [1, 2]),
    ({"a": 1}.keys(), ["a"]),
    (np.array([[1, 2], [3, 4]]), [[1, 2], [3, 4]]),
    (np.array(5.0), 5.0),
    (np.array([1j, "x"], object), ["1j", "x"]),
    (sympy.Matrix([[1, X]]), [[1, "x"]]),
    (sympy.Tuple(1, X), [1, "x"]),
    ({3, 1, 10, 2}, [1, 2, 3, 10]),
    ({"b", "a"}, ["a", "b"]),
    (sympy.FiniteSet(2, 1), [1, 2]),
    (sympy.Eq(X, 3), 3),
    (sympy.Eq(sympy.Function("y")(t), t), "t"),
    ({X: 3}, 3),
    ([{X: 3}, {X: 4}], [3, 4]),
    ({-1: 2, -2 + 1j: 1, sympy.Rational(1, 3): 1}, {"-1": 2, "(-2+1j)": 1, "1/3": 1}),
    (2 * sympy.exp(-s) / (X * s + 1), "2*exp(-s)/(s*x + 1)"),
    (System(2 * sympy.exp(-s) / (5 * s + 1)), "2*exp(-s)/(5*s + 1)"),
    (control.tf([3], [5, 1]), "3.0/(5.0*s + 1.0)"),
    (scipy.signal.TransferFunction([3.0], [5.0, 1.0]), "0.6/(1.0*s + 0.2)"),
    (PID(sympy.Rational(1, 3), Ti=10), {"Kp": "1/3", "Ti": 10, "Td": 0, "Tf": 0, "form": "parallel"}),
    (PID(2, form="serial"), {"Kp": 2, "Ti": "inf", "Td": 0, "Tf": 0, "form": "serial"}),
    (PID(K, Ti=10), "K*(1 + 1/(10*s))"),
    (PINT.Quantity(2.5, "min"), "2.5 min"),
    (PINT.Quantity(np.array([1.0, 2.0]), "s"), ["1.0 s", "2.0 s"]),
    (PINT.Quantity(0.25, ""), "0.25 dimensionless"),
    (np.ma.masked, "nan"),
]


@pytest.mark.parametrize(("answer", "data"), PLAIN, ids=range(len(PLAIN)))
def test_an_answer_as_plain_data(answer, data):
    found = plain(answer)
    assert found == data
    assert type(found) is type(data)
    assert json.loads(json.dumps(found, allow_nan=False)) == data


def nested(depth):
    return [nested(depth - 1)] if depth else 1


CIRCLE = []
CIRCLE.append(CIRCLE)


NOT_PLAIN = [
    (lambda times: times, "a function cannot be handed in"),
    (np.sin, "a function cannot be handed in"),
    (object(), "of type object"),
    (b"1", "of type bytes"),
    (dict, "of type type"),
    (os, "of type module"),
    (10**300 * 10, "more than 300 digits"),
    (sympy.Rational(10**400, 7), "more than 300 digits"),
    ("x" * (LONGEST_TEXT + 1), "5001 characters"),
    (["x" * 5000] * 11, "characters"),
    (nested(9), "more than 8 lists in one another"),
    (CIRCLE, "more than 8 lists in one another"),
    (range(MOST_VALUES), "more than 2000 values"),
    (np.zeros(10**6), "more than 2000 values"),
    ([[1, 2, object()]], "of type object"),
    ({1: 2, "1": 3}, "two keys 1"),
    (control.tf([3], [5, 1], 0.1), "of type TransferFunction"),
    (sympy.MatrixSymbol("M", 2, 2), "neither an expression"),
]


@pytest.mark.parametrize(("answer", "says"), NOT_PLAIN, ids=range(len(NOT_PLAIN)))
def test_what_has_no_plain_form_is_said(answer, says):
    found = unreadable(plain(answer))
    assert says in found
    assert "\n" not in found


def test_an_object_that_fails_is_said():
    assert unreadable(plain([Odd()])) == "this fails when it is read, with RuntimeError"


def read(kind, given):
    try:
        return kind.read(given)
    except Unreadable:
        return None


def alike(one, other):
    """Whether two answers, as a kind read them, are the same, so that every verdict on them is."""
    if one is None or other is None or one[1] != other[1]:
        return False
    one, other = one[0], other[0]
    if isinstance(one, Formula):
        return isinstance(other, Formula) and one.text == other.text
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else type(one) is type(other) and one == other


@pytest.mark.parametrize("chapter", bank.chapters())
def test_plain_data_is_judged_as_the_answer_itself(chapter):
    for exercise in bank.exercises(chapter).values():
        for student in (None, "Ada", "Norbert"):
            question = exercise.question(student)
            for name, kind in question.key.items():
                form = eval(kind.asking, vars(answer_sheet))
                right = [bank_forms.key_as_given(kind), *bank_forms.other_forms(kind)]
                wrong = [*bank_forms.wrong_answers(kind), *(value for _, value in question.mistakes[name])]
                for answer in [*right, *wrong] if student is None else right:
                    data = plain(answer)
                    json.dumps(data, allow_nan=False)
                    assert form.written(form.read(data)[0]), f"{name} = {data}"
                    if not alike(read(kind, answer), read(kind, data)):
                        verdicts = [judge(name, kind, one, question.mistakes[name]).status for one in (answer, data)]
                        assert verdicts[0] == verdicts[1], f"{name} = {answer!r}, {data!r}"


@pytest.mark.parametrize("label", bank_forms.NOT_TO_BE_JUDGED)
def test_plain_data_of_what_cannot_be_judged_is_not_judged(label):
    answer = bank_forms.NOT_TO_BE_JUDGED[label]
    for kind in (number(1, "s"), transfer_function(1 / s), settings(PID(1)), word("a", ["a", "b"]), poles([-1])):
        if label != "empty list" or not isinstance(kind, kinds.Poles):
            assert judge("x", kind, plain(answer)).status in (UNJUDGED, OPEN)


def test_a_controller_as_plain_data_is_a_transfer_function_too():
    kind = transfer_function(PID(2, Ti=10).expr)
    assert judge("C", kind, plain(PID(2, Ti=10))).status == RIGHT
    assert judge("C", kind, {"Kp": "?", "form": "serial"}).status == UNJUDGED


@pytest.mark.parametrize("form", ["cascade", None, ["serial"], 3])
def test_a_form_of_controllers_that_there_is_not(form):
    assert judge("C", settings(PID(2, Ti=10)), {"Kp": 2, "Ti": 10, "form": form}).status == UNJUDGED


@pytest.mark.parametrize("text", ["50/pi", "50/π", "pi*50/pi**2", "50/pi s"])
def test_pi_is_a_number_and_no_unit(text):
    assert judge("x", number(50 / np.pi, "s"), text).status == RIGHT


leaves = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.complex_numbers(), st.text(max_size=20), st.binary(),
    st.fractions(), st.decimals(), st.just(...), st.just(object()), st.just(len), st.just(X), st.just(1 / s),
    st.just(PID(2)), st.just(sympy.zoo), st.just(np.array([[1, np.nan]])), st.just(np.datetime64("2020")),
    st.just(PINT.Quantity(1, "m")), st.builds(Odd), st.just(sympy.Eq(X, X + 1)), st.just(sympy.S.Reals),
    st.integers(10**290, 10**310), st.text("s0123456789.+-*/^()exp", max_size=200),
)  # fmt: skip
hashable = st.one_of(st.integers(), st.text(max_size=5), st.complex_numbers(), st.just(X), st.booleans())
anything = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.lists(inner), st.lists(inner).map(tuple), st.lists(inner).map(iter), st.dictionaries(hashable, inner),
        st.sets(hashable), st.lists(st.floats()).map(np.array),
    ),
    max_leaves=30,
)  # fmt: skip


@given(anything)
@example([[]] * 3000)
@example("\ud800")
def test_plain_data_of_anything_is_bounded_json(answer):
    text = json.dumps(plain(answer), allow_nan=False)
    assert len(text) < 10**6
    assert plain(json.loads(text)) == json.loads(text)
