"""Evidence holds for what is so and for nothing else, says when it is a near thing, and refuses what cannot fail."""

import decimal
import math
from fractions import Fraction

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from bookledger import evidence
from bookledger.evidence import (
    CRITERIA,
    Evidence,
    EvidenceError,
    about_equal,
    at_least,
    at_most,
    decreasing,
    different,
    equal,
    every,
    greater,
    increasing,
    less,
    most,
    much_greater,
    much_less,
    negligible,
    nonzero,
    not_negligible,
    positive,
    refused,
    roughly_equal,
    some,
    somewhat_greater,
    somewhat_less,
    visibly_greater,
    visibly_less,
    zero,
)
from bookledger.evidence.comparisons import within
from bookledger.evidence.criteria import of_degree
from draws import draws
from plainmath.expressions import s

K, T = sympy.symbols("K T", positive=True)
x = sympy.Symbol("x", real=True)
n = sympy.Symbol("n", integer=True)
f = sympy.Function("f")


#: A criterion as a subject adds it.
STEEP = evidence.Criterion("not steep", Fraction(2), "at most 2 %", "an example", published=True)


# One of each, which holds and says so.

TRUE = {
    "greater": (greater(2.31, 1.59, "Ms"), "Ms 2.31 > 1.59"),
    "less": (less(Fraction(1, 3), np.float64(0.5), "decay ratio"), "decay ratio 0.333 < 0.5"),
    "at most": (at_most(1, sympy.pi, "x [rad]"), "x 1 rad ≤ 3.14 rad"),
    "digits that keep apart": (greater(1.00012, 1.00011), "1.00012 > 1.00011"),
    "infinite": (greater(math.inf, 3, "gain margin"), "gain margin ∞ > 3"),
    "a symbol": (greater(2 * K, K, "gain"), "gain 2*K > K, proved"),
    "a square": (positive(x**2 + 1), "x**2 + 1 > 0, proved"),
    "equal numbers": (equal(0.1 * 3, Fraction(3, 10)), "0.3 = 0.3"),
    "equal formulas": (equal(K / (T * s + 1), (K / T) / (s + 1 / T)), "K/(T*s + 1) = K/(T*(s + 1/T)), proved"),
    "equal equations": (equal(sympy.Eq(K, T), sympy.Eq(T, K)), "Eq(K, T) = Eq(T, K), proved"),
    "equal texts": (equal("V 1", "V  1"), "V 1 = V 1"),
    "equal sets": (equal({"V1", "V2"}, ["V2", "V1"], "valves"), "valves V1, V2 = V1, V2"),
    "different": (different(K, T), "K ≠ T, proved"),
    "different rows": (different([1, 2], [2, 1]), "1, 2 ≠ 2, 1"),
    "nothing": (different(set(), {"V1"}, "valves"), "valves none ≠ V1"),
    "zero": (zero(sympy.sin(sympy.pi), "offset [m]"), "offset 0 = 0"),
    "degrees": (less(20, 31.5, "phase [°]"), "phase 20° < 31.5°"),
    "degrees Celsius": (less(20, 31.5, "T [°C]"), "T 20 °C < 31.5 °C"),
    "nonzero": (nonzero(0.25, "offset [m]"), "offset 0.25 m ≠ 0"),
    "about equal": (about_equal(41, 40, "T [s]"), "T 41 s about equal to 40 s (at most 5 % of the larger one apart)"),
    "roughly equal": (roughly_equal(1, 1.4), "1 roughly equal to 1.4 (less than half of the smaller one apart)"),
    "much greater": (much_greater(1, 0), "1 much larger than 0 (by half of the smaller one or more)"),
    "somewhat": (
        somewhat_less(10, 12, "T [s]"),
        "T 12 s somewhat larger than 10 s "
        "(by less than half of the smaller one, and by more than the 5 % that are about equal)",
    ),
    "visibly": (visibly_greater(11, 10), "11 visibly larger than 10 (more than 5 % of the larger one apart)"),
    "much less": (much_less(10, 15), "15 much larger than 10 (by half of the smaller one or more)"),
    "negligible": (negligible(-0.04, 1), "-0.04 negligible beside 1 (at most 5 % of what it is compared with)"),
    "not negligible": (
        not_negligible(0.06, 1),
        "0.06 not negligible beside 1 (at most 5 % of what it is compared with)",
    ),
    "on the limit, but for rounding": (at_least(0.3, 0.1 + 0.2), "0.3 ≥ 0.3"),
    "on the limit of a ratio": (about_equal(0.95, 1), "0.95 about equal to 1 (at most 5 % of the larger one apart)"),
    "large digits in order": (greater(1000000.4, 999999.7), "1.0000004e+6 > 999999.7"),
    "a row with digits in order": (increasing([1, 2.006, 2.0084]), "1 < 2.006 < 2.008"),
    "a row of formulas": (increasing([K, 2 * K, 3 * K], "gain"), "gain K < 2*K < 3*K, proved"),
    "at random points": (equal(sympy.Min(K, 10**15), K), "Min(1000000000000000, K) = K, at random points"),
    "a huge number": (greater(10**400, 1), "1e+400 > 1"),
    "about equal digits": (
        about_equal(1.99999884, 1.99999875, "T [K]"),
        "T 2 K about equal to 2 K (at most 5 % of the larger one apart)",
    ),
    "within": (within(Fraction(2), "tilt", "%", STEEP), "tilt 2 % ≤ 2 % (not steep: at most 2 %)"),
    "beyond": (within(Fraction(3), "tilt", "%", STEEP).turned(), "tilt 3 % > 2 % (not steep: at most 2 %)"),
    "increasing": (increasing([1, 2, 3.5], "Ms"), "Ms 1 < 2 < 3.5"),
    "decreasing": (decreasing(np.array([3, 2]), "offset [m]"), "offset 3 m > 2 m"),
    "every": (every({"K = 1": less(1, 2), "K = 2": less(2, 3)}), "K = 1: 1 < 2; K = 2: 2 < 3"),
    "and": (every(less(1, 2), equal(1, 1)), "1 < 2; 1 = 1"),
    "most": (
        most({"K = 1": less(1, 2), "K = 2": less(2, 3), "K = 3": less(4, 3)}),
        "in 2 of 3 cases; K = 1: 1 < 2; K = 2: 2 < 3",
    ),
    "some": (some({"K = 1": less(3, 2), "K = 2": less(2, 3)}), "in 1 of 2 cases; K = 2: 2 < 3"),
    "refused": (refused(float, "a"), "declined: could not convert string to float: 'a'"),
}  # fmt: skip


@pytest.mark.parametrize("name", TRUE)
def test_what_is_so_is_told_with_its_numbers(name):
    found, told = TRUE[name]
    assert found.holds
    assert found.told() == told
    assert repr(found) == f"holds: {told}"


@pytest.mark.parametrize("name", TRUE)
def test_turned_around_it_falls_and_twice_turned_it_stands(name):
    found, _ = TRUE[name]
    assert not found.turned().holds
    assert found.turned().told()
    if not isinstance(found, evidence.Cases):
        assert found.turned().turned() == found


FALSE = {
    "greater": greater(1, 1),
    "at least": at_least(1, 1.0000001),
    "a proved sign": greater(-K, T),
    "equal": equal(1, 1 + 1e-8),
    "equal formulas": equal(K, T),
    "formula and equation": equal(K, sympy.Eq(K, T)),
    "rows in another order": equal([1, 2], [2, 1]),
    "rows of another length": equal([1], [1, 1]),
    "a row of other kinds": equal(["1"], [1]),
    "the same row": different([1.0, K * (T + 1)], [1, K * T + K]),
    "rounding alone": greater(0.1 + 0.2, 0.3),
    "a decimal beside a formula": greater(
        sympy.sin(K) ** 2 * Fraction(3, 10) + sympy.cos(K) ** 2 * sympy.Rational(3, 10), 0.3
    ),
    "an integer that may be negative": equal(abs(n), n),
    "different": different({"a": 1}, {"a": 1}),
    "zero": zero(1e-300),
    "infinite and not": equal(math.inf, 1e308),
    "about equal to nothing": about_equal(1e-9, 0),
    "roughly is not half more": roughly_equal(3, 2),
    "roughly nothing": roughly_equal(1e-9, 0),
    "not much": much_greater(1.49, 1),
    "half more is not somewhat": somewhat_greater(3, 2),
    "five percent are not somewhat": somewhat_greater(1, 0.95),
    "less is not somewhat more": somewhat_greater(1, 1.2),
    "five percent are not seen": visibly_less(0.95, 1),
    "much of nothing": much_greater(0, 0),
    "just negligible": not_negligible(Fraction(1, 20), 1),
    "beyond": within(Fraction(21, 10), "tilt", "%", STEEP),
    "increasing": increasing([1, 3, 2]),
    "constant": decreasing([1, 1]),
    "every": every(less(1, 2), less(2, 1)),
    "half is not most": most(less(1, 2), less(2, 1)),
    "none of some": some(less(3, 2), less(2, 1)),
    "accepted": refused(float, 1),
}


@pytest.mark.parametrize("name", FALSE)
def test_what_is_not_so_does_not_hold(name):
    assert not FALSE[name].holds
    assert repr(FALSE[name]).startswith("does not hold: ")


def test_cases_that_fail_hold_when_they_are_turned_around():
    assert all(FALSE[name].turned().holds for name in ("every", "none of some", "half is not most", "increasing"))


@pytest.mark.parametrize(
    ("found", "told"),
    [
        (greater(1, 2, "Ms"), "Ms 1 not > 2"),
        (equal(1, 2, "poles"), "poles 1 ≠ 2"),
        (different(2, 2), "2 = 2"),
        (much_greater(1, 2), "1 not much larger than 2 (by half of the smaller one or more)"),
        (every({"K = 1": less(1, 2), "K = 2": less(4, 3)}), "in 1 of 2 cases; K = 2: 4 not < 3"),
        (increasing([1, 3, 2], "Ms"), "Ms 3 not < 2"),
        (refused(float, 1), "accepted"),
        (
            every({"P": about_equal(1, 2), "PI": about_equal(3, 5), "PID": about_equal(1, 1)}),
            "in 1 of 3 cases; P: 1 not about equal to 2; PI: 3 not about equal to 5 "
            "(at most 5 % of the larger one apart)",
        ),
        (every(*(less(n, 9) for n in range(6))), "in 6 of 6 cases; 2 < 9; 3 < 9; 4 < 9; 5 < 9; ..."),
    ],
)
def test_what_fails_is_told_by_its_counterexample(found, told):
    assert found.told() == told


# Near things.


@pytest.mark.parametrize(
    ("found", "near"),
    [
        (somewhat_greater(1.4, 1), True),  # half of the limit is a quarter
        (somewhat_greater(1.2, 1), False),
        (much_greater(1.6, 1), True),
        (much_greater(1.1, 1), False),
        (roughly_equal(1, 1.2), False),
        (roughly_equal(1, 1.3), True),
        (roughly_equal(1, 1.9), True),
        (about_equal(1, 1.04), True),
        (about_equal(1, 1.02), False),
        (about_equal(1, 1.09), True),
        (within(Fraction(1, 2), "tilt", "%", STEEP), False),
        (within(Fraction(3, 2), "tilt", "%", STEEP), True),
        (within(Fraction(3), "tilt", "%", STEEP), True),
        (within(Fraction(30), "tilt", "%", STEEP).turned(), False),
        (greater(1.02, 1), True),
        (greater(1.2, 1), False),
        (positive(1e-9), False),
        (greater(math.inf, 1), False),
        (equal(1, 1), False),
        (every(greater(2, 1), greater(1.01, 1)), True),
        (every(greater(1, 2), greater(1.01, 1)), False),
        (some(greater(2, 1), greater(1.01, 1)), False),
        (some(greater(1, 2), greater(1.01, 1)), True),
        (increasing([1, 1.01, 2]), True),
        (every(greater(1.01, 1), greater(1, 1.01)), True),
        (some(greater(1.01, 1), greater(1, 1.01)), True),
    ],
)
def test_a_near_thing_is_known(found, near):
    assert found.near is near
    assert found.data["near"] is near


# What is no evidence.


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: greater(True, 1), "a truth value, True"),
        (lambda: greater("2", 1), "'2' of type str"),
        (lambda: greater(math.nan, 1), "not a number"),
        (lambda: greater(None, 1), "NoneType"),
        (lambda: greater(1j, 0), "complex number"),
        (lambda: greater(K, T), "the sign of K - T is not known"),
        (lambda: positive(0.5 * K), "rounded decimals"),
        (lambda: equal(row := [1], row), "compared with itself"),
        (
            lambda: much_greater(-2, -0.1),
            "-2 beside -0.1: how much larger one is asks for numbers that are not negative",
        ),
        (lambda: roughly_equal(-2, -1), "numbers that are not negative"),
        (lambda: about_equal(math.inf, math.inf), "two infinite numbers have no ratio"),
        (lambda: greater(2 * K, sympy.Symbol("K", negative=True)), "two different symbols named K"),
        (lambda: equal([3 > 2], [True]), "a truth value, True"),
        (lambda: equal({"ok": True}, {"ok": True}), "a truth value, True"),
        (lambda: equal(str(3 > 2), "True"), "a truth value as text"),
        (lambda: equal(K, "K"), "K beside a text"),
        (lambda: equal(b"a", b"a"), "b'a'"),
        (lambda: equal([math.nan], [math.nan]), "not a number"),
        (lambda: equal(np.array(1.0), 1), "array(1.)"),
        (lambda: equal(sympy.Integral(f(x), (x, 0, 1)), sympy.Integral(f(1 - x), (x, 0, 1))), "is not decided"),
        (lambda: equal(f((K**2 - 1) / (K - 1)), f(K + 1)), "is not decided"),
        (lambda: positive(sympy.Integral(f(x), (x, 0, 1))), "is not known"),
        (lambda: increasing(3), "3 is not a row"),
        (lambda: refused(greater, K, T), "the sign of K - T is not known"),
        (lambda: refused(3), "3 cannot be called"),
        (lambda: greater(decimal.Decimal("sNaN"), 1), "evidence needs a real number"),
        (lambda: every(), "no case is given"),
        (lambda: every(True), "the case is True: expected evidence"),
        (lambda: every({"K = 1": 3 > 2}), "the case K = 1 is True: expected evidence"),
        (lambda: every([greater(2, 1)]), "expected evidence"),
        (lambda: increasing([1]), "at least two values"),
        (lambda: greater(2, 1, 3), "the quantity is 3"),
    ],
)
def test_what_cannot_fail_or_be_decided_is_refused_in_one_line(call, words):
    with pytest.raises(EvidenceError) as caught:
        call()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_evidence_is_no_truth_value():
    with pytest.raises(TypeError, match="not a truth value"):
        bool(greater(2, 1))
    with pytest.raises(TypeError, match="not a truth value"):
        all([greater(2, 1)])


# Against another route.

NUMBERS = st.fractions(0, 100, max_denominator=1000)


@settings(max_examples=draws(300))
@given(a=NUMBERS, b=NUMBERS)
def test_numbers_are_compared_as_the_words_say(a, b):
    assert greater(a, b).holds is (a > b) is less(b, a).holds is not at_most(a, b).holds
    assert much_greater(a, b).holds is (a > b and a - b >= b / 2)
    assert about_equal(a, b).holds is (20 * abs(a - b) <= max(a, b)) is about_equal(b, a).holds
    assert negligible(a, b).holds is (20 * a <= b)
    assert roughly_equal(a, b).holds is (a == b or 2 * abs(a - b) < min(a, b))


@settings(max_examples=draws(60), deadline=None)
@given(values=st.lists(NUMBERS, min_size=2, max_size=9))
def test_rows_are_compared_neighbour_by_neighbour(values):
    assert increasing(values).holds is (values == sorted(set(values)))
    assert decreasing(values).holds is increasing(values[::-1]).holds
    cases = {str(n): less(value, 50) for n, value in enumerate(values)}
    assert every(cases).holds is (max(values) < 50)
    assert some(cases).holds is (min(values) < 50)
    assert every(cases).holds is not some({name: case.turned() for name, case in cases.items()}).holds


# Criteria, and what carries them.


def test_each_criterion_has_its_word_its_number_and_its_reason():
    for criterion in CRITERIA:
        assert criterion.limit > 0
        assert all(len(text) > 2 for text in (criterion.word, criterion.meaning, criterion.reason))
    assert {c.word for c in CRITERIA if not c.published} == {"roughly equal", "much", "somewhat", "may", "in general"}


def test_evidence_names_the_criteria_that_it_rests_on():
    both = every(much_greater(1.2, 1), some(within(Fraction(0), "tilt", "%", STEEP), greater(2, 1)))
    assert [criterion.word for criterion in both.criteria] == ["much", "not steep", "may"]
    words = [word for criterion in CRITERIA for word in criterion.degrees]
    assert len(words) == len({*words})  # one criterion for each word of degree
    assert all(of_degree(word).degrees for word in words)
    assert greater(2, 1).criteria == ()


def test_data_is_plain_and_keeps_values_apart():
    found = greater(1 + 1e-8, 1, "Ms").data
    assert (found["left"], found["relation"], found["right"]) == ("1.00000001", ">", "1")
    assert about_equal(0.94999999, 1).data["left"] == "0.94999999"  # with fewer digits it would be on the limit
    assert equal(["V1, V2"], ["V1", "V2"]).data["right"] == ["V1", "V2"]
    assert every({"K = 1": equal(K, T)}).data["cases"][0]["of"] == "formulas"
    assert equal("a", "b").data["of"] == "texts"


def test_formulas_in_a_sentence_are_typeset_by_whom_it_is_told():
    assert greater(2 * K, K).told(lambda formula: f"<{formula}>") == "<2*K> > <K>, proved"


def test_all_that_is_offered_is_evidence_or_says_what_it_is():
    for name in evidence.__all__:
        assert getattr(evidence, name).__doc__ or name == "CRITERIA"
    assert all(isinstance(found, Evidence) for found, _ in TRUE.values())
