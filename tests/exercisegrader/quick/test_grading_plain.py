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

from exercisebook.judging import UNJUDGED, judge
from exercisegrader.inside import answer_sheet
from exercisegrader.inside.plain import LONGEST_TEXT, MOST_VALUES, plain, unreadable
from judged import EVERY_KIND
from odd_answers import CIRCLE, Odd
from plainmath.expressions import s, t

X = sympy.Symbol("x")
PINT = pint.UnitRegistry(cache_folder=None)


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
    (control.tf([3], [5, 1]), "3.0/(5.0*s + 1.0)"),
    (scipy.signal.TransferFunction([3.0], [5.0, 1.0]), "0.6/(1.0*s + 0.2)"),
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
    ([Odd()], "this fails when it is read, with RuntimeError"),
]


@pytest.mark.parametrize(("answer", "says"), NOT_PLAIN, ids=range(len(NOT_PLAIN)))
def test_what_has_no_plain_form_is_said(answer, says):
    data = plain(answer)
    assert says in unreadable(data)
    assert "\n" not in unreadable(data)
    assert {judge("x", kind, data).status for kind in EVERY_KIND.values()} == {UNJUDGED}


@pytest.mark.parametrize("kind", EVERY_KIND.values(), ids=EVERY_KIND)
def test_plain_data_is_judged_as_the_answer_itself(kind):
    form = eval(kind.asking, vars(answer_sheet))
    for _, answer in (*kind.right_forms(), *kind.wrong_forms()):
        data = plain(answer)
        assert form.written(form.read(data)[0])
        assert judge("x", kind, data).status == judge("x", kind, answer).status, f"{answer!r}, {data!r}"


leaves = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.complex_numbers(), st.text(max_size=20), st.binary(),
    st.fractions(), st.decimals(), st.just(...), st.just(object()), st.just(len), st.just(X), st.just(1 / s),
    st.just(sympy.zoo), st.just(np.array([[1, np.nan]])), st.just(np.datetime64("2020")),
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
