"""Checks of arguments: what is let through, and one sentence for one fault."""

import inspect
import math
import re
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy
from sympy import I, Rational, Symbol, nan, oo

from plainmath import validation
from plainmath.validation import (
    did_you_mean,
    exact_in_range,
    exact_nonzero,
    exact_not_negative,
    exact_positive,
    exact_real,
    increasing,
    is_number,
    not_negative,
    number,
    one_of,
    positive,
    positive_numbers,
    real_numbers,
    whole,
)

K, NEGATIVE = Symbol("K"), Symbol("m", negative=True)


@pytest.mark.parametrize("value", [2, 2.0, np.float64(2), Fraction(2), Decimal(2), sympy.Integer(2), np.array(2)])
def test_numbers_of_any_kind_are_numbers(value):
    assert is_number(value)
    assert number("x", value) == positive("x", value) == not_negative("x", value) == 2.0


@pytest.mark.parametrize("value", ["2", True, None, math.nan, math.inf, 2j, K, I, oo, [2, 3], 10**400, object()])
def test_what_is_no_number(value):
    assert not is_number(value)
    with pytest.raises(ValueError, match=r"x is .*: expected a finite real number"):
        number("x", value)


@pytest.mark.parametrize("value", [3, np.int64(3), sympy.Integer(3)])
def test_whole_numbers(value):
    assert whole("n", value) == 3


@pytest.mark.parametrize("value", [0, -1, 2.0, "2", True, None, K])
def test_what_is_no_whole_number(value):
    with pytest.raises(ValueError, match=r"n is .*: expected a whole number, at least 1"):
        whole("n", value)


def test_symbols_are_let_through_unless_they_are_known_to_be_wrong():
    for check in (exact_real, exact_positive, exact_not_negative, exact_nonzero):
        assert check("K", K) == K
        assert check("K", 0.1) == Rational(1, 10)
    assert exact_positive("T", oo, infinite=True) == exact_not_negative("T", oo, infinite=True) == oo
    assert exact_not_negative("T", 0) == 0


def test_a_range_holds_its_ends_and_symbols_and_may_be_left():
    for value in (1, Rational(5, 2), 4, K):
        assert exact_in_range("x", value, 1, 4) == value
    assert exact_in_range("x", 5, 1, 4, extrapolate=True) == 5
    for value in (0.999, 5, NEGATIVE):
        with pytest.raises(ValueError, match=r"x is .*: expected 1 to 4; extrapolate=True leaves this range"):
            exact_in_range("x", value, 1, 4)


@pytest.mark.parametrize(
    ("check", "value", "expected"),
    [
        (exact_real, I, "x is I: expected a finite real number"),
        (exact_real, oo, "x is oo: expected a finite real number"),
        (exact_real, "2", "x is '2': expected a number or an expression"),
        (exact_real, nan, "x is nan: expected a number or an expression"),
        (exact_positive, 0, "x is 0: expected a positive number"),
        (exact_positive, NEGATIVE, "x is m: expected a positive number"),
        (exact_not_negative, -1, "x is -1: expected a number that is not negative"),
        (exact_not_negative, NEGATIVE, "x is m: expected a number that is not negative"),
        (exact_nonzero, 0, "x is 0: expected a number other than zero"),
    ],
)
def test_what_is_known_to_be_wrong_of_an_expression(check, value, expected):
    with pytest.raises(ValueError, match=f"^{expected}$"):
        check("x", value)
    with pytest.raises(ValueError, match="x is K: expected a finite real number"):
        exact_positive("x", K, symbols=False)


def test_arrays():
    assert positive_numbers("gains", [1, 2]).tolist() == [1, 2]
    assert positive_numbers("times", [0, 2], zero=True).tolist() == [0, 2]
    for values, expected in (
        ([1, 2j], "the gains are .*: expected real numbers"),
        (["a"], "the gains are .*: expected real numbers"),
        ([1, math.nan], "the gains contain nan: expected finite numbers"),
    ):
        with pytest.raises(ValueError, match=expected):
            real_numbers("gains", values)
    with pytest.raises(ValueError, match="the gains contain 0: expected positive numbers"):
        positive_numbers("gains", [1, 0])
    with pytest.raises(ValueError, match="the times contain -1: expected numbers that are not negative"):
        positive_numbers("times", [-1, 2], zero=True)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([0, 2, 1, 5], "the times go from 2 to 1: expected increasing numbers"),
        ([0, 1, 2, 2, 3], "the times go from 2 to 2: expected increasing numbers"),
        ([[0, 1], [2, 3]], "the times have the shape (2, 2): expected a row of numbers"),
        (5, "the times have the shape (): expected a row of numbers"),
        ([], "the times have the shape (0,): expected a row of numbers"),
        ([0, 1, 2, math.inf], "the times contain inf: expected finite numbers"),
        ("now", "the times are 'now': expected real numbers"),
    ],
)
def test_what_does_not_increase(values, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        increasing("times", values)


def test_increasing_numbers_become_an_array():
    assert increasing("times", [sympy.Rational(1, 2), 1, 2]).tolist() == [0.5, 1, 2]
    assert increasing("times", [3]).tolist() == [3]
    with pytest.raises(ValueError, match="the number of times is 3: expected 4 or more"):
        increasing("times", [0, 1, 2], least=4)


def test_the_module_says_which_functions_it_offers():
    own = {
        f.__name__ for f in vars(validation).values() if inspect.isfunction(f) and f.__module__ == validation.__name__
    }
    assert {name for name in own if not name.startswith("_")} == set(validation.__all__)


def test_one_of_several_words():
    assert one_of("kind", "PI", ("P", "PI")) == "PI"
    for word in ("PD", 3, None, ["PI"]):
        with pytest.raises(ValueError, match=r"kind is .*: expected one of P, PI"):
            one_of("kind", word, ("P", "PI"))


@pytest.mark.parametrize(
    ("name", "known", "says"),
    [
        ("Kpp", ["Ti", "Kp"], "did you mean 'Kp'?"),
        ("kp", ["Ti", "Kp"], "did you mean 'Kp'?"),
        ("load", ["Ti", "Kp"], "expected one of Ti, Kp"),
        ("load", [], "there are none"),
        (12.3, [12.4, "K"], "did you mean '12.4'?"),
    ],
)
def test_what_was_meant(name, known, says):
    assert did_you_mean(name, known) == says


def test_what_is_said_where_no_name_is_like_it():
    assert did_you_mean("load", ["Ti"], otherwise="expected a setting") == "expected a setting"
    assert did_you_mean("ti", ["Ti"], otherwise="expected a setting") == "did you mean 'Ti'?"
