"""When two formulas are the same but for rounding: each number counts, and no value is no agreement."""

import ast
import math
import random

import numpy as np
import pytest
import sympy

from draws import draws
from exercisebook.agreement import agree
from exercisebook.arithmetic import NoValue, in_digits
from exercisebook.authoring import answers, exercise, expression, number, time_function
from exercisebook.formulas import Formula
from exercisebook.freedoms import freedoms
from exercisebook.judging import RIGHT, UNJUDGED, WRONG, is_right, judge
from exercisebook.points import points_for
from plainmath.expressions import s

DELAYED = "2*exp(-8*s)/(10*s + 1)"
LAGS = "3*exp(-2*s)/((20*s + 1)*(5*s + 1))"
PREDICTOR = "(4*s + 1)*(10*s + 1)/(4*s*(10*s + 1) + (1 - exp(-8*s))*(8*s + 2))"

RIGHT_FORMS = [
    (DELAYED, "2.019*exp(-7.93*s)/(10.09*s + 1)"),
    (DELAYED, "0.201*exp(-8*s)/(s + 0.0995)"),
    ("(330*s + 1)/(85*s + 1)", "3.88*(s + 0.00303)/(s + 0.0118)"),
    (LAGS, "exp(-2*s)*(4/(20*s + 1) - 1/(5*s + 1))"),
    ("2/(20*s + 1)**2", "2/((20.2*s + 1)*(19.8*s + 1))"),
    ("2/(20*s + 1)**4", "2/(160000*s**4 + 32000*s**3 + 2400*s**2 + 80*s + 1)"),
    ("2.5*(1 + 1/(12*s) + 3*s)", "2.5 + 0.208/s + 7.5*s"),
    ("4/3*exp(-10*s/3)", "1.33*exp(-3.33*s)"),
    (PREDICTOR, "(4.02*s + 1)*(9.95*s + 1)/(4.02*s*(9.95*s + 1) + (1 - exp(-8.05*s))*(8*s + 2))"),
]
WRONG_FORMS = [
    (DELAYED, "0.2*exp(-8*s)/(s + 0.103)"),
    (DELAYED, "2*exp(-8*s)"),
    (DELAYED, "2*exp(-8*s)/(1000*s - 988*s + 1)"),
    (DELAYED, "(100*s - 97.9*s)/s*exp(-8*s)/(10*s + 1)"),
    (DELAYED, "0*s"),
    (DELAYED, "1e300**2"),
    (LAGS, "3*exp(-2*s)/(100*s**2 + 25.6*s + 1)"),
    (LAGS, "3*exp(-7*s)/(20*s + 1)"),
    ("2.5*(1 + 1/(12*s))", "2.5*(1 + 1/(12.3*s))"),
    (PREDICTOR, "(10*s + 1)/(10*s)"),
    ("(80*s + 3)/(s*(s + 0.1))", "(80*s + 3)/(s*(s + 0.12))"),
    # numbers that make a difference are one number, in whatever form
    ("2.9*exp(-9*s)/(35*s + 1)", "2.9*exp(-9*s)/(110.25*s - 73.5*s + 1)"),
    ("2.9*exp(-9*s)/(35*s + 1)", "2.9*exp(-9*s)/(110.25*s - 73.5*(s + 1) + 74.5)"),
    ("2.9*exp(-9*s)/(35*s + 1)", "2.9*exp(-9*s)/((110.25*s*(s + 2) - 73.5*s*(s + 2))/(s + 2) + 1)"),
    ("2.9*exp(-9*s)/(35*s + 1)", "2.9*exp(-30*s + 20.6*s)/(35*s + 1)"),
    ("2.9*exp(-9*s)/(35*s + 1)", "2.9*exp(-30*s)*exp(20.6*s)/(35*s + 1)"),
    ("2.9*exp(-9*s)/(35*s + 1)", "(8.9*exp(-9*s) - 5.85*exp(-9*s))/(35*s + 1)"),
    ("5*x", "15*x - 9.8*x"),
]


#: What is the key for positive values of v alone.
FOR_POSITIVE = ["-k*Abs(v)", "-k*sqrt(v**2)", "-k*Max(v, 0)", "-k*v*Heaviside(v)", "-k*v*sign(v)", "-k*v**2/abs(v)"]
FOR_POSITIVE += ["-k*(v**4)**(1/4)", "-k*Piecewise((v, v > 0), (77, True))"]


@pytest.mark.parametrize("given", FOR_POSITIVE)
def test_a_symbol_may_be_negative_where_it_is_said(given):
    assert is_right(expression("-k*v"), given)
    assert not is_right(expression("-k*v", real="v"), given)


def test_the_size_of_a_symbol_is_no_symbol_of_either_sign():
    drag = expression("-k*v*Abs(v)", real="v")
    assert is_right(drag, "-k*sqrt(v**2)*v")
    assert not is_right(drag, "-k*v**2")
    v = sympy.Symbol("v", real=True)
    assert not is_right(expression(-2 * v), "-2*Abs(v)")
    with pytest.raises(ValueError, match="real='v'"):
        expression("-k*v*Abs(v)")


EACH = [
    "2*exp(-{}*s)/(10*s + 1)", "{}/(7*s + 1)", "2/({}*s + 1)", "(1 - {}*s)/(1 + s)**2", "1/(s - {})", "1/(s**2 + {})",
    "1/({}*s + 1)**3", "k*exp(-{}*x)", "{}*sqrt(k/x)", "2*sqrt(k*x)*{}", "{}/sqrt(k)", "x/({}*sqrt(k))",
    "({}*k + x)**2", "k*({} - exp(-x/y))", "{}*k - x",
]  # fmt: skip


@pytest.mark.parametrize("key", EACH)
@pytest.mark.parametrize("value", [1, 3])
def test_each_number_has_its_tolerance_also_where_it_is_one(key, value):
    kind = expression(key.format(value))
    for seed in range(5):
        kind.draw_from(f"{seed}")
        assert is_right(kind, key.format(1.009 * value))
        assert not is_right(kind, key.format(1.011 * value))


GROWING = [
    ("exp(t/2)", "exp(t/2) - 1"),
    ("exp(t/2)", "2*sinh(t/2)"),
    ("20 + exp(t/3)", "exp(t/3)"),
    ("5*exp(t/3) - 4", "5*exp(t/3) + 4"),
    ("t**3", "t**3 + 50"),
    ("2*(1 - exp(-t/5))", "2*(1 - exp(-t/5)) - 1000*exp(-10000*t)"),
    ("2*(1 - exp(-t/5))", "2*(1 - exp(-t/5)) + Heaviside(t - 29.9)"),
    ("2*(1 - exp(-t/5))", "2*(1 - exp(-t/5)) + exp(100*(t - 30))"),
]


@pytest.mark.parametrize(("key", "given"), GROWING)
def test_the_first_moment_counts_of_a_function_that_grows_and_the_last_one(key, given):
    kind = time_function(key, until=30)
    for seed in range(5):
        kind.draw_from(f"{seed}")
        assert is_right(kind, key)
        assert not is_right(kind, given)


IN_TIME = ["5*(1 - exp(-(t - {0})/8))*Heaviside(t - {0})", "5*Heaviside(t - {})", "3*cos(t/{})", "2*exp(-t/{})"]


@pytest.mark.parametrize("key", IN_TIME)
@pytest.mark.parametrize("value", [1, 9])
def test_a_moment_has_its_tolerance_at_every_draw(key, value):
    kind = time_function(key.format(value), until=30)
    for seed in range(5):
        kind.draw_from(f"{seed}")
        assert is_right(kind, key.format(1.009 * value))
        assert not is_right(kind, key.format(1.012 * value))


@pytest.mark.parametrize(
    "spike",
    [
        "1e6*exp(-((t - 70.123)/0.01)**2)",
        "500*(Heaviside(t - 50) - Heaviside(t - 50.01))",
        "50*(Heaviside(t - 8.92) - Heaviside(t - 9.08))",
    ],
)
def test_a_spike_between_the_times_is_seen(spike):
    kind = time_function("20*(1 - exp(-(t - 9)/15))*Heaviside(t - 9)", until=100)
    for seed in range(3):
        kind.draw_from(f"{seed}")
        assert is_right(kind, "20*(1 - exp(-(t - 9.05)/15))*Heaviside(t - 9.05)")
        assert not is_right(kind, f"20*(1 - exp(-(t - 9)/15))*Heaviside(t - 9) + {spike}")


@pytest.mark.parametrize(("key", "given"), RIGHT_FORMS)
def test_each_number_may_be_rounded_in_any_form(key, given):
    kind = expression(key)
    for seed in range(5):
        kind.draw_from(f"{seed}")
        assert is_right(kind, given)


@pytest.mark.parametrize(("key", "given"), WRONG_FORMS)
def test_one_wrong_number_is_wrong_wherever_the_points_are(key, given):
    kind = expression(key)
    for seed in range(5):
        kind.draw_from(f"{seed}")
        assert not is_right(kind, given)


def test_the_accuracy_is_that_of_the_author():
    given = "2*exp(-8.2*s)/(10*s + 1)"
    assert is_right(expression(DELAYED, within=0.03), given)
    assert not is_right(expression(DELAYED, within=0.02), given)


@pytest.mark.parametrize(
    ("key", "given"),
    [
        (DELAYED, "1/(5*s + 1/2)*exp(-s)**8"),
        ("exp(-3*s) - exp(-4*s)", "exp(-3*s)*(1 - exp(-s))"),
        ("s", "(s + 1) - 1"),
    ],
)
def test_an_exact_answer_may_have_another_form(key, given):
    assert is_right(expression(key, within=0), given)
    assert not is_right(expression(key, within=0), f"({given})*1.0000001")


def test_an_exact_dead_time_is_exact():
    assert not is_right(expression(DELAYED, within=0), "2*exp(-8.00001*s)/(10*s + 1)")


def _lags(dice):
    """A transfer function with gain, lags and dead time of two digits, and its parameters."""
    gain, lag = (math.exp(dice.uniform(-2, 5)) for _ in range(2))
    other, delay = lag * math.exp(dice.uniform(-3, -0.5)), lag * math.exp(dice.uniform(-3, 2))
    return tuple(float(f"{value:.2g}") for value in (gain, lag, other, delay))


def _in_forms(gain, lag, other, delay):
    """The same with numbers of three digits, in five forms."""
    gain_of_s, delayed = gain / lag / other, f"exp(-{delay:.3g}*s)"
    yield f"{gain:.3g}*{delayed}/(({lag:.3g}*s + 1)*({other:.3g}*s + 1))"
    yield f"{gain:.3g}*{delayed}/({lag * other:.3g}*s**2 + {lag + other:.3g}*s + 1)"
    yield f"{gain_of_s:.3g}*{delayed}/((s + {1 / lag:.3g})*(s + {1 / other:.3g}))"
    yield f"{gain_of_s:.3g}*{delayed}/(s**2 + {1 / lag + 1 / other:.3g}*s + {1 / lag / other:.3g})"
    yield f"{100 * gain:.3g}/100/({lag:.3g}*s + 1)/(1 + {other:.3g}*s)*{delayed}"


@pytest.mark.parametrize("seed", range(draws(90)))
def test_random_keys_are_right_in_three_digits_and_wrong_with_one_number_off(seed):
    dice = random.Random(seed)
    numbers = _lags(dice)
    gain, lag, other, delay = map(sympy.Rational, map(str, numbers))
    key = expression(gain * sympy.exp(-delay * s) / ((lag * s + 1) * (other * s + 1)))
    key.draw_from(f"{seed}")
    for text in _in_forms(*numbers):
        assert is_right(key, text), text
    for place in range(4):
        off = [*numbers]
        off[place] *= 1 + dice.choice((-1, 1)) * dice.uniform(0.02, 0.03)
        first, *_ = _in_forms(*off)
        assert not is_right(key, first), first


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("5*x/(2*y)", ["5 * x / (2 * y)"]),
        ("1/(40*s + 4)", ["40 * s", "1 / (40 * s + 4)"]),
        ("(2*s + 1)**2", ["2 * s", "(2 * s + 1) ** 2"]),
        ("(1 - s)/(s + 1)**2", ["1", "1", "(1 - s) / (s + 1) ** 2"]),
        ("2*sqrt(x*y)", ["2 * sqrt(x * y)"]),
        ("x**(1/3)", ["1 / 3", "x ** (1 / 3)"]),
        ("sqrt(2)*s**3", ["sqrt(2) * s ** 3"]),
        ("x - 3*exp(y/4 - 0.5)", ["x", "y / 4", "0.5", "3 * exp(y / 4 - 0.5)"]),
        ("pi*x**2 + (1000 - 998)*y", ["pi * x ** 2", "(1000 - 998) * y"]),
    ],
)
def test_what_belongs_together_is_one_number(text, found):
    assert [ast.unparse(one.node) for one in freedoms(Formula(text, "s x y").tree)] == found


# Functions of time.

STEP = time_function("3*(1 - exp(-(t - 4)/10))*Heaviside(t - 4)", until=60)
SUM = time_function("2*exp(-t/20) + 0.0337*exp(-t/3)", until=60)
READING = time_function("60 + 3*(1 - exp(-t/5))", until=25)


@pytest.mark.parametrize(
    ("kind", "given", "right"),
    [
        (STEP, "3.02*(1 - exp(-(t - 3.97)/10.05))*Heaviside(t - 3.97)", True),
        (STEP, "Heaviside(t - 4)*(3 - 4.48*exp(-t/10))", True),
        (STEP, "0 for t < 4, 3 - 3*exp(-0.1*(t - 4)) for t > 4", True),
        (STEP, "3*(1 - exp(-(t - 4)/10.3))*Heaviside(t - 4)", False),
        (STEP, "3*(1 - exp(-(t - 4.1)/10))*Heaviside(t - 4.1)", False),
        (STEP, "3*(1 - exp(-(t - 4)/10))", False),
        (STEP, "3.06*(1 - exp(-(t - 4)/10))*Heaviside(t - 4)", False),
        (STEP, lambda times: np.where(times < 4, 0, 3 * (1 - np.exp(-(times - 4) / 10.02))), True),
        (STEP, lambda times: np.where(times < 4, 0, 3 * (1 - np.exp(-(times - 4) / 10.4))), False),
        (SUM, "2*exp(-t/20) + 0.03*exp(-t/3)", True),
        (SUM, "2*exp(-t/20) + 0.04*exp(-t/3)", False),
        (SUM, "2*exp(-t/20)", False),
        (READING, "60.3 + 3*(1 - exp(-t/5))", True),
        (READING, "60 + 3.1*(1 - exp(-t/5))", False),
        # what a limiter compares are values whose numbers may be rounded
        (expression("Min(8*theta/3, T)"), "Min(2.67*theta, T)", True),
        (expression("Min(8*theta/3, T)"), "Min(2.8*theta, T)", False),
        (time_function("Min(8*t/3, 10)", until=20), "Min(2.667*t, 10)", True),
        (time_function("Min(8*t/3, 10)", until=20), "Min(2.67*t, 10)", True),
        (time_function("Min(8*t/3, 10)", until=20), "Min(2.8*t, 10)", False),
        (time_function("Max(0, 7*(t-3)/9)", until=20), "Max(0, 0.778*(t-3))", True),
        (time_function("Max(0, 7*(t-3)/9)", until=20), "Max(0, 0.8*(t-3))", False),
    ],
)
def test_functions_of_time_and_of_limiters(kind, given, right):
    for seed in range(3):
        kind.draw_from(f"{seed}")
        assert is_right(kind, given) is right


@pytest.mark.parametrize("constant", ["0", "3", "1.5", 0, lambda times: 0 * times])
def test_a_constant_is_no_mistake_of_units_or_numbers(constant):
    assert judge("y", STEP, constant).status == WRONG
    assert judge("H", expression(DELAYED), "0").status == WRONG


# Values.


MASKS = (
    "W + 0*exp(3e5*s) | W + 0*exp(1e9/s) | W*exp(3e5*s)/exp(3e5*s) | W*exp(3e5*s)**0 | W + 1/exp(3e5*s**2 + 9)"
    " | W + 0*sinh(1e5*s) | (W) + 1e30 - 1e30 | W + 1e-300*s"
)


@pytest.mark.parametrize("mask", MASKS.split(" | "))
def test_a_mask_does_not_make_a_wrong_formula_right_nor_a_right_one_wrong(mask):
    kind = expression("1.9*exp(-30*s)/(7*s + 1)")
    wrong = ("1.9*exp(-7*s)/(30*s + 1)", "1.9/(7*s + 1)", "1.9*exp(-33*s)/(7*s + 1)")
    assert not any(is_right(kind, mask.replace("W", one)) for one in wrong)
    if "1/exp" not in mask:
        assert is_right(kind, mask.replace("W", "1.9*exp(-30*s)/(7*s + 1)"))


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("1.9*exp(-30*s)/(7*s + 1) + 0*exp(exp(exp(exp(9 + s**2))))", "this has no value at s = "),
        ("1.9*exp(-30*s)/(7*s + 1)/(0*s + 1 - 1)", "no finite value"),
        ("1.9*exp(-30*s)/(7*s + 1) + 0*Abs(s)", "Abs of s is in it, which is in no transfer function"),
        ("Piecewise((1.9*exp(-30*s)/(7*s + 1), s < 1), (0, True))", "Piecewise of s is in it"),
        ("1.9*exp(-30*s)/(7*s + 1)*Heaviside(s + 1e9)", "Heaviside of s"),
    ],
)
def test_what_cannot_be_compared_is_not_right_and_is_looked_at(given, says):
    verdict = judge("H", expression("1.9*exp(-30*s)/(7*s + 1)"), given)
    assert verdict.status in (WRONG, UNJUDGED)
    assert says in verdict.says
    assert bool(verdict.look) is (verdict.status == WRONG)


def test_a_product_that_is_nearly_zero_is_worked_out_in_digits():
    key = "3*exp(-60*s)/(10*s + 1)"
    assert is_right(expression(key), f"({key})*({key})/({key})")
    assert not is_right(expression(key), f"{key} + 5*1e-200*1e-200*1e200*1e200")


def test_a_power_of_zero_is_zero_for_positive_exponents_alone():
    for exponent in ("I", "(-1/2)", "(-2)"):
        assert judge("H", expression(DELAYED), f"{DELAYED} + 0*(s - s)**{exponent}").status != RIGHT
    assert is_right(expression(DELAYED), f"{DELAYED} + (s - s)**0.5")


def test_an_ordinary_verdict_is_not_looked_at():
    for given in ("1.9*exp(-30*s)/(7*s + 1)", "1.9/(7*s + 1)", "Abs(-1.9)*exp(-30*s)/(7*s + 1)", "K"):
        assert judge("H", expression("1.9*exp(-30*s)/(7*s + 1)"), given).look == ""


def test_digits_are_worked_out_until_they_tell():
    def value(text):
        return in_digits(Formula(text).tree, {})

    assert value("1e300 + 2 - 1e300") == 2
    assert value("exp(1e6)*exp(-1e6 + 1)") == pytest.approx(math.e)
    assert value("exp(1e6) - exp(5e5)**2") == 0
    assert value("exp(1e6)") == math.inf
    assert value("sin(1e22)") == pytest.approx(math.sin(1e22))
    assert value("Piecewise((exp(exp(exp(9))), 2 < 1), (Max(3, 2), True))") == 3
    for text in ("1/0", "0**-1", "log(0)", "exp(exp(exp(exp(9))))", "0*exp(exp(exp(exp(9))))", "9.0**9**9**9**9"):
        with pytest.raises(NoValue):
            value(text)


@pytest.mark.parametrize("text", ["0*log(0)", "tan(pi/2)*0", "sqrt(-4)", "atan(2) + asin(0.3)", "sign(-3)*Min(4, 5)"])
def test_both_arithmetics_have_the_same_values(text):
    formula = Formula(text)
    try:
        exact = in_digits(formula.tree, {})
    except NoValue:
        exact = math.nan
    found = complex(formula())
    assert found == pytest.approx(exact, nan_ok=True, abs=1e-12) or (np.isnan(found) and text.startswith("tan"))


# Points.


def test_points_are_those_of_the_seed_and_the_key_has_values_there():
    for text in (DELAYED, LAGS, PREDICTOR, "exp(-3000*s)/s", "1e-4/(1e4*s + 1)", "exp(-s*T)/(T*s + K)"):
        key = Formula(text, "s K T")
        points = points_for(key, "a secret")
        assert np.isfinite(key(**points)).all()
        assert len(points["s"]) == 120
        assert np.array_equal(points["s"], points_for(key, "a secret")["s"])
        assert not np.isin(points["s"], points_for(key, "another")["s"]).any()


def test_the_points_of_a_graded_question_come_from_what_its_student_is_drawn_from():
    @exercise("1.1", title="A lag", points=1)
    def lag():
        """What is it?"""
        return answers(H=expression("2/(3*s + 1)"))

    def points(text):
        return lag.question(text).key["H"].points()["s"]

    assert np.array_equal(points("drawn from a secret"), points("drawn from a secret"))
    assert not np.isin(points("drawn from a secret"), points("drawn from another")).any()


@pytest.mark.parametrize("text", ["0", "4 + 0*s", "exp(1e9*s)*exp(-1e9*s)", "s**40", "sqrt(s)*1e180"])
def test_a_key_without_ordinary_points_agrees_with_itself(text):
    key = Formula(text, "s")
    points = points_for(key)
    assert agree(key, Formula(text, "s"), points, within=0.01)
    assert not agree(key, Formula(f"1.1*({text}) + s**3", "s"), points, within=0.01)


# What is read, and what is said.


@pytest.mark.parametrize(
    ("kind", "given"),
    [
        (number(4), "4 # 3"),
        (expression("K/T"), "K/T # K/Kp"),
        (expression("K/T", symbols="K Kp T"), "K/Kp = K/T"),
        (expression("K", symbols="K Kp"), "x = Kp = K"),
        (expression(DELAYED), f"{DELAYED}%"),
    ],
)
def test_of_two_answers_in_one_none_is_chosen(kind, given):
    assert judge("x", kind, given).status == UNJUDGED


def test_two_sides_of_a_number_are_one_number_with_its_sign():
    assert is_right(number(64, "min"), "3840 s = 64 min")
    assert is_right(number(-5), "-10/2 = -5")
    for given in ("5 = -5", "-5 = 5"):
        assert "two sides that differ" in judge("x", number(5), given).says


def test_numbers_lose_no_digits():
    assert not is_right(number(0), "1 + 1e30 - 1e30")
    assert is_right(number(1), "1 + 1e30 - 1e30")
    assert judge("x", number(1), "1 + 0*nan").status == UNJUDGED


def test_the_accuracy_is_said_in_words():
    assert expression(DELAYED).precision == "in any form, each number in it to 1\N{NO-BREAK SPACE}%"
    assert expression("K/T", within=0).precision == "in any form, exact, for positive symbols"
    assert expression("k*v", real="v").precision.endswith(", v of either sign")
    assert "to the decimal of the largest that is added" in STEP.precision
