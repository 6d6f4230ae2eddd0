"""Reading expressions from text, exact numbers, and the verdict whether two expressions are equal."""

import fractions
import random

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    Abs,
    Derivative,
    DiracDelta,
    Eq,
    Function,
    Heaviside,
    I,
    Integral,
    Max,
    Rational,
    Subs,
    cos,
    exp,
    expand,
    factor,
    factorial,
    gamma,
    log,
    oo,
    pi,
    sin,
    sqrt,
    symbols,
    tan,
    together,
)

from draws import draws
from plainmath.expressions import agreement, exact, function_of, parse, s, t

K, T, T1, T2, a, x = symbols("K T T1 T2 a x", positive=True)
n = symbols("n", integer=True, positive=True)
y, u = Function("y"), Function("u")
quick = settings(deadline=None, max_examples=draws(40))


# ------------------------------------------------------------------------------------------------ parse


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("1.5", Rational(3, 2)),
        ("2e-3", Rational(1, 500)),
        ("1_000", 1000),
        (".5 + 5.", Rational(11, 2)),
        ("0.1 + 0.2", Rational(3, 10)),
        ("-2**2", -4),
        ("+2 - -3", 5),
        ("K/(T*s + 1)", K / (T * s + 1)),
        ("K*exp(-t/T)/T", K * exp(-t / T) / T),
        ("sqrt(x**2)", x),
        ("y(t) + u(t)", y(t) + u(t)),
        ("Derivative(y(t), t, t)", y(t).diff(t, 2)),
        ("Derivative(y(t), (t, 2))", y(t).diff(t, 2)),
        ("Subs(Derivative(y(t), t), t, 0)", Subs(y(t).diff(t), t, 0)),
        ("Integral(u(x), (x, 0, t))", Integral(u(x), (x, 0, t))),
        ("k*DiracDelta(t)", symbols("k", positive=True) * DiracDelta(t)),
        ("pi*oo", oo),
        ("I**2", -1),
        ("a +\n   x", a + x),
    ],
)
def test_parse_reads_mathematics(text, meaning):
    assert parse(text) == meaning


def test_parse_keeps_a_bracket_as_it_is_written():
    assert str(parse("4*(s - 1)/(s + 3)")) == "4*(s - 1)/(s + 3)"


@pytest.mark.parametrize(
    "text",
    [
        "a.b", "().__class__", "a[0]", "lambda x: x", "[x for x in y]", "{1}", "{1: 2}", "'a'", "f'{a}'", "b'a'",
        "True", "None", "...", "1j", "a if b else c", "a and b", "not a", "~a", "a == b", "a < b", "(a := 1)",
        "await a",
        "f(*a)", "f(**a)", "f(b=1)", "f()(x)", "K % T", "K // T", "K @ T", "K ^ T", "__import__('os')",
        "__import__(os)",
        "__class__", "open('file')", "0x1F", "0b11",
    ],
)  # fmt: skip
def test_parse_refuses_what_is_no_mathematics_and_names_it(text):
    with pytest.raises(ValueError, match=r"^cannot read .* as an expression: ") as refusal:
        parse(text)
    assert repr(text) in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "text",
    ["", "  ", "K/", "2s", "1.5.2", "a b", "a; b", "1e5K", "x²", "a\0b", "(" * 1000, "-" * 9000 + "a", 3, None, b"a"],
)
def test_parse_refuses_what_is_no_sentence(text):
    with pytest.raises(ValueError, match="expected something like"):
        parse(text)


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9", "2**10000", "((10**900)**900)**900", "(s + 1)**(10**9)", "1000000**1000.5", "1e1000000000",
        "1e-1000000000", "factorial(10**9)", "gamma(10**8)",
    ],
)  # fmt: skip
def test_parse_refuses_numbers_that_would_fill_the_memory(text):
    with pytest.raises(ValueError, match=r"too large|out of range"):
        parse(text)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("1/0", "has no value"), ("0/0", "has no value"), ("log(0)", "has no value"), ("oo - oo", "has no value"),
        ("exp()", "wrong arguments"), ("sin(1, 2)", "wrong arguments"), ("Subs(y(t), t)", "wrong arguments"),
        ("Derivative(y(t), 2)", "wrong arguments"), ("Integral(u(x), 3)", "wrong arguments"),
        ("s(T*s + 1)", "a product needs its"), ("t(1)", "a product needs its"),
        ("1,5", "is not a number"), ("(1, 2) + 1", "is not a number"), ("sin((1, 2))", "is not a number"),
    ],
)  # fmt: skip
def test_parse_says_what_is_wrong(text, why):
    with pytest.raises(ValueError, match=why):
        parse(text)


leaves = st.sampled_from([s, t, K, T, sympy.Integer(2), Rational(3, 7), pi])
expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(lambda pair: pair[0] + pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] * pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] / (pair[1] ** 2 + 1)),
        inner.map(lambda e: exp(-e)),
        inner.map(lambda e: y(e)),
    ),
    max_leaves=5,
)


@quick
@given(expressions)
def test_parse_reads_what_sympy_writes(expression):
    assert agreement(parse(str(expression)), expression) == "proved"


# ------------------------------------------------------------------------------------------------ agreement


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (K / (T * s + 1), (K / T) / (s + 1 / T)),
        (sin(x) ** 2 + cos(x) ** 2, 1),
        (tan(x), sin(x) / cos(x)),
        (gamma(n + 1), factorial(n)),
        (sqrt(2) + sqrt(3), sqrt(5 + 2 * sqrt(6))),
        (expand((s + 1) ** 20), (s + 1) ** 20),
        (sqrt(x**2), x),
        (0.1 * K, K / 10),
        (0.1 + 0.2, 0.3),
        (oo, oo),
        (DiracDelta(t) + exp(-t), exp(-t) + DiracDelta(t)),
        (Derivative(y(t) + u(t), t), y(t).diff(t) + u(t).diff(t)),
        (Integral(u(x), (x, 0, t)), Integral(u(a), (a, 0, t))),
        (Integral(exp(-x), (x, 0, t)), 1 - exp(-t)),
        (y((t + 1) ** 2), y(t**2 + 2 * t + 1)),
    ],
)
def test_agreement_is_proved(one, other):
    assert agreement(one, other) == "proved"


def test_agreement_is_probed_where_sympy_finds_no_proof():
    assert agreement(Heaviside(t - 1) * Heaviside(t - 2), Heaviside(t - 2)) == "probed"


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (K / (T * s + 1), K / (T * s - 1)),
        (K / (T * s + 1), K / (T * s + 1 + Rational(1, 10**9))),
        (K / (T * s + 1), K * (1 + Rational(1, 10**9)) / (T * s + 1)),
        (exp(-t / T), exp(-t / (T + Rational(1, 10**9)))),
        (1, 1 + 1e-9),
        (1, 1 + Rational(1, 10**40)),
        (pi, Rational(314159265358979323846264338327950288, 10**35)),
        # small quantities are no less different than large ones
        (K / 10**23, 2 * K / 10**23),
        (Rational(1, 10**50), 0),
        # a limiter or a switch shows at large values, a fast exponential at small ones
        (Max(x, 100000), 100000),
        (exp(-(10**6) * t), 0),
        (Heaviside(t - 1), 1),
        (sqrt(s**2), s),
        (log(s**2), 2 * log(s)),
        (Abs(symbols("r", real=True)), symbols("r", real=True)),
        (y(t), u(t)),
        (y(0), y(t)),
        (y(t**2), y(t) ** 2),
        (DiracDelta(t), DiracDelta(t, 1)),
        (DiracDelta(t - 1), DiracDelta(t)),
    ],
)
def test_agreement_is_refuted(one, other):
    assert agreement(one, other) == "different"


def test_letters_with_different_assumptions_are_different():
    assert agreement(symbols("x"), x) == "different"
    assert agreement(symbols("x", real=True), x) == "different"


def test_agreement_survives_complex_points_and_towers_of_exponentials():
    free = symbols("b")
    assert agreement(Max(symbols("r", real=True), 1) + free, 1 + free) == "different"
    assert agreement(exp(exp(exp(x))), exp(exp(exp(x))) + 1) == "different"
    assert agreement(sin(exp(x)) ** 2 + cos(exp(x)) ** 2, 1) == "proved"
    with pytest.raises(ValueError, match="no value at any point"):
        agreement(Heaviside(free - 1), 1)


@pytest.mark.parametrize("value", ["x", None, [1], True, Eq(x, 1), sympy.Matrix([1]), float("nan")])
def test_agreement_refuses_what_is_no_expression(value):
    with pytest.raises(ValueError, match="expected a number or an expression"):
        agreement(value, 1)


@pytest.mark.parametrize("pair", [(oo, 1), (oo, -oo), (1 / x, oo)])
def test_agreement_refuses_the_infinite(pair):
    with pytest.raises(ValueError, match="cannot compare"):
        agreement(*pair)


@quick
@given(expressions, st.randoms(use_true_random=False))
def test_another_way_to_write_it_is_never_different(expression, dice):
    shuffled = sympy.Add(*dice.sample(terms := list(sympy.Add.make_args(expand(expression))), len(terms)))
    for other in (shuffled, factor(expression), together(expression), parse(str(expression))):
        assert agreement(expression, other) == "proved"


@quick
@given(expressions, st.integers(1, 12))
def test_another_value_is_always_different(expression, digits):
    assert agreement(expression, expression + Rational(1, 10**digits)) == "different"


# ------------------------------------------------------------------------------------------------ exact numbers


@pytest.mark.parametrize(
    ("number", "meant"),
    [
        (0.1, Rational(1, 10)),
        (0.1 + 0.2, Rational(3, 10)),
        (1 / 3, Rational(1, 3)),
        (-2 / 7, Rational(-2, 7)),
        (1 + 1e-9, Rational(10**9 + 1, 10**9)),
        (1e-20, Rational(1, 10**20)),
        (np.float64(0.35), Rational(7, 20)),
        (np.float32(0.1), Rational(1, 10)),
        (np.int64(3), 3),
        (fractions.Fraction(22, 7), Rational(22, 7)),
        (sympy.Float("0.12345678901234567890", 20), Rational(12345678901234567890, 10**20)),
        (1.5 + 2j, Rational(3, 2) + 2 * I),
        (float("inf"), oo),
        (0.5 * s**2.0, s**2 / 2),
    ],
)
def test_exact_means_the_number(number, meant):
    assert exact(number) == meant


@quick
@given(st.integers(1, 10**9), st.integers(0, 9))
def test_exact_keeps_every_decimal(digits, places):
    assert exact(digits / 10**places) == Rational(digits, 10**places)


def test_function_of_knows_its_variable():
    assert function_of(s, 0.5 / s) == 1 / (2 * s)
    with pytest.raises(ValueError, match=r"t/s contains t: expected a function of s"):
        function_of(s, t / s)
    for other in (symbols("t"), symbols("t", positive=True), symbols("s", positive=True)):
        with pytest.raises(ValueError, match="is another symbol than plainmath's: import s and t from there"):
            function_of(t, 1 + other)


def test_the_points_of_the_probing_are_always_the_same():
    random.seed(1)
    first = agreement(Heaviside(t - 1) ** 2, Heaviside(t - 1))
    random.seed(2)
    assert agreement(Heaviside(t - 1) ** 2, Heaviside(t - 1)) == first == "probed"


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (exp(T) - 2 * sympy.cosh(T), -exp(-T)),
        (sympy.gamma(T + 1), sympy.factorial(T)),
        (exp(-T * s) * sympy.cosh(T * s), (1 + exp(-2 * T * s)) / 2),
        (sympy.Abs(s) ** 2, s * sympy.conjugate(s)),
        (K * (1 - exp(-t / 5)), K - K * exp(-t / 5)),
        ((exp(T) + T) ** 2, exp(2 * T) + 2 * T * exp(T) + T**2),
    ],
)
def test_identities_hold_also_where_their_terms_are_huge_or_tiny(one, other):
    assert agreement(one, other) in ("proved", "probed")
