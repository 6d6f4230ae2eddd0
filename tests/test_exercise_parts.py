"""What exercises are made of: units, formulas, parameters, kinds of answers, judging, responses, progress."""

import itertools
import json
import math
import os
import subprocess
import sys
import time
import types
from decimal import Decimal
from fractions import Fraction

import control
import mpmath
import numpy as np
import pint
import pytest
import scipy.signal
import sympy
import sympy.physics.control
from hypothesis import given
from hypothesis import strategies as st

from loopbook import exercises, s, t
from loopbook.deadtime import System
from loopbook.exercises import bank, formulas, judging, units
from loopbook.exercises.authoring import (
    Exercise,
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    numbers,
    poles,
    settings,
    time_function,
    transfer_function,
    word,
    words,
)
from loopbook.exercises.formulas import Formula
from loopbook.exercises.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG, Verdict, judge
from loopbook.exercises.progress import FILE
from loopbook.exercises.reading import Unreadable
from loopbook.exercises.response import Response
from loopbook.exercises.timeout import limited
from loopbook.pid import PID

# Units.


@pytest.mark.parametrize(
    ("value", "unit", "to", "expected"),
    [
        (2, "min", "s", 120),
        (1, "m³/s", "L/min", 60_000),
        (1, "m^3/s", "m³/h", 3600),
        (5, "%", "", 0.05),
        (1, "%/K", "1/°C", 0.01),
        (20, "°C", "K", 293.15),
        (1, "K/%", "°C/%", 1),
        (0.5, "Hz", "rad/s", math.pi),
        (180, "deg", "rad", math.pi),
        (1, "1/s", "Hz", 1),
        (3, "kJ/(kg K)", "J/(kg K)", 3000),
    ],
)
def test_units_convert(value, unit, to, expected):
    assert units.convert(value, unit, to) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "apples",
        "s**99999",
        "s^-12",
        "__import__",
        "()",
        "m" * 50,
        "1/",
        "s;m",
        3,
        None,
        "2 s",
        "m^9^9^9",
        "(m^9)^9",
        "m²²²",
        "%**%",
        "(m)**(m)",
        "1 2",
        "1 m",
    ],
)
def test_what_is_no_unit(text):
    assert not units.is_unit(text)


@pytest.mark.parametrize("unit", ["s", "1/s", "%", "", "°C", "K", "rad/s", "kg/min", "%/K", "K/%", "m³/s", "rad", "Hz"])
def test_neighbours_are_other_values_of_the_same_quantity(unit):
    for other, converted in units.neighbours(unit).items():
        assert units.convert(converted(3.0), other, to=unit) == pytest.approx(3.0)
        assert converted(3.0) != pytest.approx(3.0)


# Formulas.

READABLE = {
    "2*exp(-3*s)/(10*s + 1)": 2 * sympy.exp(-3 * s) / (10 * s + 1),
    "e^(-2*s)/s^2": sympy.exp(-2 * s) / s**2,
    "sqrt(s + 4)*pi": sympy.sqrt(s + 4) * sympy.pi,
    "Piecewise((1, (s > 2) & (s < 5)), (s, True))": sympy.Piecewise((1, (s > 2) & (s < 5)), (s, True)),
    "Heaviside(s - 1)*Max(s, 2)": sympy.Heaviside(s - 1) * sympy.Max(s, 2),
    "-s**-1 + .5": -1 / s + sympy.Rational(1, 2),
}


@pytest.mark.parametrize("text", READABLE)
def test_a_formula_has_the_values_of_the_expression(text):
    points = np.array([0.3, 3.0, 7.0])
    meant = [complex(READABLE[text].subs(s, point)) for point in points]
    assert Formula(text, "s")(s=points) == pytest.approx(meant)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("2s", "with * for every product"),
        ("s(s + 1)", "a product needs its *"),
        ("K/(T*s + 1)", "'K' is no letter of this answer"),
        ("S", "did you mean s?"),
        ("exb(s)", "did you mean exp?"),
        ("", "empty"),
        ("(", "cannot be read"),
        ("0,5*s", "a decimal point"),
        ("s" * 5000, "characters"),
        ("+".join(["s"] * 1900), "very long"),
        ("-" * 3000 + "s", "expected"),
        ("(" * 3000, "expected"),
        ("9" * 500, "out of range"),
        ("1e999*s", "out of range"),
        ("__import__('os').system('true')", "cannot be read"),
        ("().__class__", "cannot be read"),
        ("[s for s in (1,)]", "cannot be read"),
        ("lambda: s", "cannot be read"),
        ("s if s else s", "cannot be read"),
        ("s := 2", "cannot be read"),
        ("f'{s}'", "cannot be read"),
        ("exp(s, s)", "2 arguments"),
        ("exp(x=s)", "one function of a value"),
        ("Heaviside()", "no arguments"),
        ("'s'", "is no number"),
        ("True", "is no number"),
        (None, "neither"),
        (..., "neither"),
        ("1 < s < 3", "compares twice"),
        ("Piecewise(s)", "pairs of a value and a condition"),
        ("Piecewise((1, s, 2))", "comma"),
        ("exp(*s)", "one function"),
        (True, "truth value"),
        (object(), "neither an expression"),
        ([s], "neither an expression"),
        (sympy.Matrix([s]), "neither an expression"),
        (sympy.Function("f")(s), "'f' is no function"),
        (sympy.Add(*(s**k for k in range(1500))), "very long"),
    ],
)
def test_what_is_no_formula_is_said(given, says):
    with pytest.raises(Unreadable) as caught:
        Formula(given, "s")
    assert says in str(caught.value)
    assert len(str(caught.value)) < 250


BOMBS = [
    "2**2**2**2**2**9", "10**10**10**10", "(s**1000)**1000", "exp(exp(exp(exp(exp(s)))))", "9e300**9e300",
    "*".join(["(1 + s)"] * 200), "+".join(["s**999"] * 200), "tan(" * 80 + "s" + ")" * 80, "1/0", "0**-1", "log(0)",
    "exp(1e9*s)", "sqrt(-1)**1e300",
]  # fmt: skip


@pytest.mark.parametrize("text", BOMBS)
def test_no_formula_hangs_or_fills_the_memory(text):
    key = Formula("2/(10*s + 1)", "s")
    assert not formulas.agree(key, Formula(text, "s"), formulas.points_for("s"), 0.01)


@given(st.text(alphabet="s0123456789.+-*/^()exp, K[]'=:<%_", max_size=40))
def test_any_text_is_judged(text):
    assert judge("H", H, text).says


KEY = Formula("2*exp(-10*s/3)/(10*s + 1)", "s")


@pytest.mark.parametrize(
    "given",
    [
        "2*exp(-3.33*s)/(10*s + 1)",
        "0.2*exp(-3.34*s)/(s + 0.1)",
        "1/((5*s + 0.5)*exp(10*s/3))",
        System(2 * sympy.exp(-10 * s / 3) / (10 * s + 1)),
        sympy.sympify("2*exp(-10*s/3)/(10*s + 1)"),
        "2.01*exp(-3.35*s)/(9.95*s + 1)",
    ],
)
def test_rounded_numbers_and_other_forms_agree(given):
    assert formulas.agree(KEY, Formula(given, "s"), formulas.points_for("s"), 0.01)


@pytest.mark.parametrize(
    "given",
    [
        "2/(10*s + 1)",
        "2*exp(-3.5*s)/(10*s + 1)",
        "2.1*exp(-10*s/3)/(10*s + 1)",
        "2*exp(-10*s/3)/(10.5*s + 1)",
        "2*exp(-10*s/3)/(10*s + 1.05)",
        "2*exp(10*s/3)/(10*s + 1)",
        "2*(1 - 5*s/3)/(1 + 5*s/3)/(10*s + 1)",
        "2*exp(-10*s/3)/(10*s - 1)",
        "2*exp(-10*s/3)/(10*s + 1)**2",
        "0",
        "2",
        "1e300**2",
    ],
)
def test_other_formulas_do_not(given):
    assert not formulas.agree(KEY, Formula(given, "s"), formulas.points_for("s"), 0.01)


def test_a_formula_must_have_values_at_many_points():
    expected, found = np.ones(10), np.full(10, np.nan)
    found[:2] = 1
    assert not formulas.near_everywhere(expected, found, 0.1 * expected)
    found[:4] = 1
    assert formulas.near_everywhere(expected, found, 0.1 * expected)
    nothing = np.full(10, np.nan)
    assert not formulas.near_everywhere(expected, nothing, 0.1 * expected)
    assert not formulas.near_everywhere(nothing, nothing, nothing)


@pytest.mark.parametrize(
    ("key", "given"),
    [
        ("exp(-3*s)", "exp(-s)*exp(-s)*exp(-s)"),
        ("exp(-3*s) - exp(-4*s)", "exp(-3*s)*(1 - exp(-s))"),
        ("s", "(s + 1) - 1"),
    ],
)
def test_an_exact_answer_may_have_another_form(key, given):
    points = formulas.points_for("s")
    assert formulas.agree(Formula(key, "s"), Formula(given, "s"), points, within=0)
    assert not formulas.agree(Formula(key, "s"), Formula(f"({given})*1.0000001", "s"), points, within=0)


def test_a_piece_counts_only_where_it_holds():
    piecewise = Formula("Piecewise((exp(1000*t), t < 0.1), (Min(t, 2), True))", "t")
    assert piecewise(t=np.array([0.001, 1.0, 5.0])) == pytest.approx([math.e, 1, 2])
    assert Formula("max(t, 2, 3)", "t")(t=np.array([1.0, 5.0])) == pytest.approx([3, 5])


def test_a_system_of_python_control_is_a_formula():
    key = Formula("2/(10*s + 1)", "s")
    assert formulas.agree(key, Formula(control.tf([2], [10, 1]), "s"), formulas.points_for("s"), 0.01)


# Parameters.


def test_the_draws_are_the_same_on_every_machine():
    one = between(2, 6, "s")
    assert [str(one.draw(text)) for text in ("a", "b", "c", "d")] == DRAWN
    program = "from loopbook.exercises.authoring import between; print([str(between(2, 6).draw(x)) for x in 'abcd'])"
    result = subprocess.run([sys.executable, "-R", "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.strip() == str(DRAWN)


DRAWN = ["11/2", "11/2", "3", "3"]


def test_over_decades_the_values_grow_by_a_ratio():
    assert [float(value) for value in between(1, 40).values] == [
        1,
        1.2,
        1.5,
        2,
        2.5,
        3,
        4,
        5,
        6,
        8,
        10,
        12,
        15,
        20,
        25,
        30,
        40,
    ]


@given(st.floats(1e-3, 1e4), st.floats(1.2, 1e4))
def test_a_range_has_values_that_a_person_would_choose(low, ratio):
    parameter = between(low, low * ratio)
    assert len(parameter.values) >= 6
    for value in parameter.values:
        assert low * (1 - 1e-9) <= value <= low * ratio * (1 + 1e-9)
        assert len(f"{float(value):.10g}".replace(".", "").strip("0")) <= 6


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: between(6, 2), "the smaller one first"),
        (lambda: between(2, 6, "apples"), "no unit"),
        (lambda: between(2, 6, step=10), "leaves no choice"),
        (lambda: between(2, 6, step=0), "the step is 0"),
        (lambda: between(2, 6, reference=7), "the reference is 7"),
        (lambda: between(2, 6, reference="many"), "the reference is many"),
        (lambda: choice("hot", "cold", reference="warm"), "the reference is warm"),
        (lambda: choice("one"), "at least two"),
        (lambda: answers(), "at least one quantity"),
        (lambda: number(2, "apples", "the gain"), "the unit of the gain"),
        (lambda: settings(PID(2), form="ideal"), "form is 'ideal'"),
        (lambda: design(number(2)), "no criteria"),
    ],
)
def test_what_an_author_writes_wrongly_is_said(make, says):
    with pytest.raises(ValueError, match="expected") as caught:
        make()
    assert says in str(caught.value)


# Answers.

PI = settings(PID(2, Ti=10), gain="%/K", what="the settings")
PARALLEL = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings", form="parallel")
ANY = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings")
TI = number(120, "s", "the integral time")
GAIN = number(0.25, "", "the gain")
ANGLE = number(math.pi / 3, "rad", "the phase margin")
H = transfer_function(3 * sympy.exp(-2 * s) / (5 * s + 1))
Y = time_function(1 - sympy.exp(-t / 5), until=25, what="the response")
METRES = time_function(2 * (1 - sympy.exp(-t / 5)), until=25, unit="m", what="the level")
BOX = expression(sympy.sympify("pi*r**2*h"), "the volume", unit="m³")
pi_r2_h = sympy.pi * sympy.Symbol("r") ** 2 * sympy.Function("h")(t)
LONG = time_function(1 - sympy.exp(-t / 5) + sympy.exp(-50 * t) / 300, until=2500, what="the response")
P = poles([-1 + 2j, -1 - 2j, -3])
A = numbers([[0, 1], [-2, -3]], what="the matrix")
STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
ROUTE = words(["fill", "heat", "empty"], ["fill", "heat", "empty", "wait"], "the steps", ordered=True)
ACTION = word("reverse", ["reverse", "direct"], "the action")
TRUE = word("yes", ["yes", "no"], "whether it is stable")
OFFSET = design(number(2, what="a gain"), criterion("the offset", lambda K: 1 / (1 + K), below=0.4))

X = sympy.Symbol("x")
FORM = sympy.sympify("K*T/(K + 1)")
GAIN_OF_K = expression(FORM, "the gain")
LAG = transfer_function(3 / (5 * s + 1))
MINUS = number(-2, "K/%", "the gain")
FLOW = number(0.5, "m³/s", "the flow")
OMEGA = number(3, "rad/s", "the frequency")
ROOM = number(20, "°C", "the temperature")
DIFFERENCE = number(10, "K", "the rise")
OFFSET_Y = time_function(60 + 3 * (1 - sympy.exp(-t / 5)), until=25, unit="°C", what="the reading")
PINT = pint.UnitRegistry(cache_folder=None)
DAMPER = design(number(2000, "g", "the mass"), criterion("the mass", lambda m: m, above=1500, below=2500, unit="g"))
STABLE_MINUTES = design(
    settings(PID(1, Ti=120)), criterion("the integral time", lambda pid: pid.Ti, above=100, below=130)
)
STABLE = design(
    settings(PID(1)),
    criterion("the loop is stable", lambda pid: pid.Kp < 3),
    criterion("the gain", lambda pid: pid.Kp, above=0.5),
)

JUDGED = [
    (TI, 120, RIGHT, "right"),
    (TI, "2 min", RIGHT, "converted from min"),
    (TI, "120 s", RIGHT, "right"),
    (TI, "120", RIGHT, "right"),
    (TI, "240/2", RIGHT, "right"),
    (TI, [120], RIGHT, "right"),
    (TI, sympy.Integer(120), RIGHT, "right"),
    (TI, 120 + 1e-15j, RIGHT, "right"),
    (TI, 119.2, RIGHT, "right"),
    (TI, 118, WRONG, "keep more digits"),
    (TI, 2, MISTAKE, "the value in min"),
    (TI, -120, MISTAKE, "sign"),
    (TI, 1 / 120, MISTAKE, "inverse"),
    (TI, 77, WRONG, "not right; asked: the integral time, in s"),
    (TI, "2 kg", UNJUDGED, "no unit of the same quantity"),
    (TI, "120,5", UNJUDGED, "comma"),
    (TI, "two minutes", UNJUDGED, "a number, in s"),
    (TI, math.nan, UNJUDGED, "NaN"),
    (TI, math.inf, UNJUDGED, "infinite"),
    (TI, 3j, UNJUDGED, "complex"),
    (TI, [1, 2], UNJUDGED, "there are 2 values"),
    (TI, sympy.Symbol("T"), UNJUDGED, "there is still T"),
    (TI, True, UNJUDGED, "truth value"),
    (TI, ..., OPEN, "not answered yet"),
    (TI, None, OPEN, "not answered yet"),
    (GAIN, "25 %", RIGHT, "converted"),
    (GAIN, 25, MISTAKE, "in percent"),
    (GAIN, 4, MISTAKE, "inverse"),
    (ANGLE, 60, MISTAKE, "in deg"),
    (ANGLE, "60 deg", RIGHT, "converted"),
    (H, "0.6*exp(-2*s)/(s + 0.2)", RIGHT, "right"),
    (H, 3 / (5 * s + 1), MISTAKE, "dead time is missing"),
    (H, 3 * sympy.exp(2 * s) / (5 * s + 1), MISTAKE, "sign in the exponent"),
    (H, 3 * (1 - s) / (1 + s) / (5 * s + 1), MISTAKE, "Pade"),
    (H, 3 * sympy.exp(-2 * s) / (5 * s + 1) / s, MISTAKE, "factor s"),
    (H, sympy.exp(2 * s) * (5 * s + 1) / 3, MISTAKE, "inverse"),
    (H, "3/(tau*s + 1)", UNJUDGED, "'tau' is no letter"),
    (H, System(3 * sympy.exp(-2 * s) / (5 * s + 1)), RIGHT, "right"),
    (Y, "1 - exp(-0.2*t)", RIGHT, "right"),
    (Y, lambda times: 1 - np.exp(-times / 5), RIGHT, "right"),
    (Y, lambda time: 1 - math.exp(-time / 5), RIGHT, "right"),
    (Y, sympy.exp(-t / 5) - 1, MISTAKE, "sign"),
    (Y, "exp(-0.2*t)", WRONG, "the response"),
    (Y, "1 - exp(-0.2*t) + exp(-2000*t)/1e6", RIGHT, "right"),
    (LONG, "1 - exp(-t)*exp(0.8*t)", RIGHT, "right"),
    (LONG, "0*t", WRONG, "the response"),
    (Y, lambda times: "much", UNJUDGED, "no numbers"),
    (P, [-3, -1 - 2j, -1 + 2j], RIGHT, "right"),
    (P, {-3: 1, -1 - 2j: 1, -1 + 2j: 1}, RIGHT, "right"),
    (P, np.roots(np.poly([-3, -1 - 2j, -1 + 2j])), RIGHT, "right"),
    (P, ["-3", "-1 + 2j", "-1 - 2*I"], RIGHT, "right"),
    (P, [3, 1 - 2j, 1 + 2j], MISTAKE, "signs"),
    (P, [-3, -1 + 2j], WRONG, "2 is not their number: count a multiple one several times"),
    (P, [-3, -1 + 2j, -7], WRONG, "2 of 3"),
    (P, "none", UNJUDGED, "expected a list of numbers"),
    (A, [[0, 1], [-2, -3]], RIGHT, "right"),
    (A, sympy.Matrix([[0, 1], [-2, -3]]), RIGHT, "right"),
    (A, [[0, -2], [1, -3]], MISTAKE, "rows and columns"),
    (A, [0, 1, -2, -3], UNJUDGED, "expected 2 by 2"),
    (A, [[0, 1], [-2, 3]], WRONG, "3 of 4"),
    (PI, PID(2, Ti=10), RIGHT, "right"),
    (PI, PID(2, Ti=10, form="serial"), RIGHT, "right"),
    (PI, {"Kp": "2 %/K", "Ti": "10 s"}, RIGHT, "right"),
    (PI, {"Kp": 2, "Ti": "1 min"}, WRONG, "Kp is right, Ti is not"),
    (PI, (2, 10), RIGHT, "right"),
    (PI, PID(-2, Ti=10), MISTAKE, "sign of Kp"),
    (PI, PID(0.5, Ti=10), MISTAKE, "inverted"),
    (PI, PID(50, Ti=10), MISTAKE, "proportional band"),
    (PI, PID(2, Ti=0.2), MISTAKE, "integral gain"),
    (PI, {"Kp": 2, "Ki": 3}, UNJUDGED, "Ki is no setting"),
    (PI, 2, UNJUDGED, "no controller"),
    (PI, PID(2), WRONG, "Kp is right, Ti is not"),
    (ANY, PID(2, Ti=8, Td=2, form="serial"), RIGHT, "right"),
    (PARALLEL, PID(2, Ti=8, Td=2, form="serial"), MISTAKE, "asked is its parallel form"),
    (PARALLEL, PID(2, Ti=8, Td=2), MISTAKE, "numbers of the serial form"),
    (PARALLEL, PID(2.5, Ti=1.6, Td=10), MISTAKE, "exchanged"),
    (ACTION, " REVERSE", RIGHT, "right"),
    (ACTION, "direct", WRONG, "the action"),
    (ACTION, "backwards", UNJUDGED, "reverse or direct"),
    (ACTION, 1, UNJUDGED, "no text"),
    (TRUE, True, RIGHT, "right"),
    (STEPS, {"s2", "s4"}, RIGHT, "right"),
    (STEPS, "S2", WRONG, "missing"),
    (STEPS, ["S2", "S4", "S1"], WRONG, "more besides"),
    (STEPS, [], WRONG, "empty"),
    (STEPS, ["S2", "S9"], UNJUDGED, "none of the words"),
    (ROUTE, ["empty", "heat", "fill"], MISTAKE, "opposite order"),
    (ROUTE, ["heat", "fill", "empty"], WRONG, "order"),
    (ROUTE, {"heat", "fill", "empty"}, UNJUDGED, "a set has no order"),
    (OFFSET, 5, RIGHT, "right"),
    (OFFSET, 1, WRONG, "the offset is 0.5; asked is at most 0.4"),
    (OFFSET, 1.499, RIGHT, "right"),
    (BOX, pi_r2_h, RIGHT, "right"),
    (BOX, "r^2*pi*h(t)", RIGHT, "right"),
    (Y, "3-0,000625*t", UNJUDGED, "comma as a point"),
    (Y, "4(1+t)", UNJUDGED, "every product needs one"),
    (Y, "Piecewise((1 - exp(-t/5), t < 15))", UNJUDGED, "no value at some points"),
    (Y, "1 - exp(-12*t)", MISTAKE, "unit of time"),
    (METRES, "200*(1 - exp(-t/5))", MISTAKE, "the values in cm"),
    (H, "3*exp(-120*s)/(300*s + 1)", MISTAKE, "unit of time"),
    (ACTION, True, UNJUDGED, "True is a truth value: expected reverse or direct"),
    (STEPS, "S2 and S4", RIGHT, "right"),
    (STEPS, "S2 S4", RIGHT, "right"),
    (number(1.7, "", "the gain margin"), "4.609 dB", RIGHT, "converted from dB"),
    (number(1120, "N", "the force"), 1.12, MISTAKE, "in kN"),
    (number(12, "", "the number of batches", within=0), 13, WRONG, "not right"),
    (P, [-3.06, -1 - 2j, -1 + 2j], WRONG, "they are close"),
    (A, 5, UNJUDGED, "such as [[1, 2], [3, 4]]"),
    (STABLE_MINUTES, PID(1, Ti=2), WRONG, "that would be right in min"),
    (OFFSET, 1.49, WRONG, "the offset is 0.4016; asked is at most 0.4"),
    (DAMPER, 2, WRONG, "that would be right in kg; asked: the mass, in g"),
    (STABLE, PID(2), RIGHT, "right"),
    (STABLE, PID(9), WRONG, "asked is that the loop is stable"),
    (STABLE, PID(0.1), WRONG, "the gain is 0.1; asked is at least 0.5"),
    # as people write numbers and units
    *(
        (TI, text, RIGHT, "right")
        for text in ("2min", "120\N{NO-BREAK SPACE}s", "120\N{THIN SPACE}s", "Ti = 120 s", "= 120")
    ),
    *((TI, text, RIGHT, "right") for text in ("1/30 h", "2*60 s", "1.2·10²", "1.2×10^2 s", "2 · 60 s", "120 seconds")),
    (MINUS, "\N{MINUS SIGN}2 K/%", RIGHT, "right"),
    (MINUS, "- 2 K/%", RIGHT, "right"),
    *((FLOW, f"0.5 {unit}", RIGHT, "right") for unit in ("m3/s", "m^3/s", "m**3/s", "m³ s⁻¹", "m³·s⁻¹", "m^3 s-1")),
    *(
        (OMEGA, text, RIGHT, "right")
        for text in ("3 rad/sec", "3/s", "3 1/s", "0.47746 Hz", "28.648 rpm", "3*pi/pi rad/s")
    ),
    *((ROOM, f"20 {unit}", RIGHT, "right") for unit in ("°C", "℃", "C", "deg C", "degC")),
    (DIFFERENCE, "10 K", RIGHT, "right"),
    (DIFFERENCE, "10 °C", UNJUDGED, "a temperature or a difference"),
    (DIFFERENCE, "10 degC", UNJUDGED, "a temperature or a difference"),
    (TI, "2 minutes per second", UNJUDGED, "no unit of the same quantity"),
    (TI, "10 dozen s", UNJUDGED, "is no number"),
    (TI, "1 m^9^9^9", UNJUDGED, "is no number"),
    (TI, "1" * 5000, UNJUDGED, "5000 characters"),
    (number(2, "%/K", "the gain"), 0.02, MISTAKE, "in 1/K"),
    (number(2, "K/%", "the gain"), 200, MISTAKE, "in K"),
    (number(0, "m", "the offset"), 0.005, RIGHT, "right"),
    (number(0, "m", "the offset"), 0.02, WRONG, "close"),
    (TI, 120 + 0.01j, UNJUDGED, "complex"),
    (P, {-3: 30}, UNJUDGED, "cannot occur 30 times"),
    (H, 3 * s * sympy.exp(-2 * s) / (5 * s + 1), MISTAKE, "factor s too many"),
    (Y, lambda times: np.where(times < 3, np.nan, 1 - np.exp(-times / 5)), UNJUDGED, "no finite value at some times"),
    (expression(sympy.Symbol("q_2i") * sympy.Symbol("ζ")), "q_2i*ζ", RIGHT, "right"),
    (P, ["-3.0", "-1 + 2.0i", "-1 - 2i"], RIGHT, "right"),
    (PARALLEL, PID(2.5, Ti=10, Td=1.6, form="serial"), WRONG, "not right"),
    (STEPS, ["S4", "S2", "S2"], RIGHT, "right"),
    (OFFSET, 1.5, RIGHT, "right"),
    # as programs give numbers
    *(
        (TI, one, RIGHT, "right")
        for one in (np.array(120), np.float32(120), np.int8(120), np.array("120"), np.array([[120]]))
    ),
    *((TI, one, RIGHT, "right") for one in (Fraction(120), Decimal(120), mpmath.mpf(120), {120}, {"a": 120}.values())),
    *((TI, one, RIGHT, "right") for one in (sympy.Eq(X, 120), {X: 120}, [{X: 120}], sympy.FiniteSet(120), iter([120]))),
    (TI, PINT.Quantity(2, "min"), RIGHT, "converted from min"),
    (TI, PINT.Quantity(2, "kg"), UNJUDGED, "no unit of the same quantity"),
    (GAIN, PINT.Quantity(25, "percent"), RIGHT, "right"),
    (DIFFERENCE, PINT.Quantity(10, "delta_degC"), RIGHT, "right"),
    (number(0, "m"), np.ma.masked, UNJUDGED, "missing"),
    # formulas in other spellings and forms
    *(
        (GAIN_OF_K, text, RIGHT, "right")
        for text in ("y = K*T/(K+1)", "y(t) = K·T/(1 + K)", "K*T÷(K+1)", "K*T/(K−1+2)")
    ),
    *((GAIN_OF_K, one, RIGHT, "right") for one in (sympy.Eq(X, FORM), {FORM}, {X: FORM}, np.array(FORM), iter([FORM]))),
    (expression(sympy.sympify("theta*a**2/tau")), "θ*a²/τ", RIGHT, "right"),
    (expression(sympy.log(10) * X), "2.302585*x", RIGHT, "right"),
    (expression(sympy.log(X) / sympy.log(10)), "log10(x)", RIGHT, "right"),
    (Y, "1 - np.exp(-t/5)", RIGHT, "right"),
    (Y, sympy.Eq(sympy.Function("y")(t), 1 - sympy.exp(-t / 5)), RIGHT, "right"),
    (LAG, control.ss([[-0.2]], [[1]], [[0.6]], [[0]]), RIGHT, "right"),
    (LAG, scipy.signal.StateSpace([[-0.2]], [[1]], [[0.6]], [[0]]), RIGHT, "right"),
    (LAG, scipy.signal.ZerosPolesGain([], [-0.2], 0.6), RIGHT, "right"),
    (LAG, scipy.signal.TransferFunction([3], [5, 1]), RIGHT, "right"),
    (LAG, sympy.physics.control.TransferFunction(3, 5 * s + 1, s), RIGHT, "right"),
    (
        transfer_function(7 / (3 * s + 1) ** 5),
        control.ss(control.tf([7 / 3**5], np.poly([-1 / 3] * 5))),
        RIGHT,
        "right",
    ),
    (LAG, control.tf([3], [5, 1], 0.1), UNJUDGED, "neither an expression"),
    (LAG, control.tf([[[3], [1]]], [[[5, 1], [5, 1]]]), UNJUDGED, "neither an expression"),
    # lists in other forms
    *(
        (P, one, RIGHT, "right")
        for one in ("-3, -1+2j, -1-2j", "[-3, -1 + 2i, -1 - 2i]", "-3; -1+2j; -1-2j", [[-3, -1 + 2j, -1 - 2j]])
    ),
    *(
        (P, one, RIGHT, "right")
        for one in (iter([-3, -1 + 2j, -1 - 2j]), [{s: -3}, {s: -1 + 2j}, sympy.Eq(s, -1 - 2j)])
    ),
    (P, PINT.Quantity(np.array([-3, -1 + 2j, -1 - 2j]), "rad/s"), RIGHT, "right"),
    (P, "", UNJUDGED, "is no number"),
    (poles([-2]), "-2,5", UNJUDGED, "decimal comma"),
    (poles([]), "[]", RIGHT, "right"),
    (numbers([1, 2], "s"), "[1,2]", RIGHT, "right"),
    (numbers([1, 2], "s"), "1 s, 2 s", RIGHT, "right"),
    (numbers([1, 2], "s"), range(1, 3), RIGHT, "right"),
    (PI, "2, 10", RIGHT, "right"),
    (PI, [[2, 10]], RIGHT, "right"),
    (PI, (2, np.array([10, 11])), UNJUDGED, "2 values"),
    (settings(PID(2)), (2, "inf"), RIGHT, "right"),
    *(
        (ACTION, one, RIGHT, "right")
        for one in ("reverse.", "'Reverse'", ["reverse"], {"reverse"}, np.array("reverse"))
    ),
    *((TRUE, one, RIGHT, "right") for one in (np.True_, sympy.true)),
    (ACTION, "-", UNJUDGED, "none of the words"),
    (word("cascade control", ["cascade control", "feedforward"]), "cascade-control", RIGHT, "right"),
    (word("2", ["1", "2"]), 2, RIGHT, "right"),
    (word("+", ["+", "-"]), "-", WRONG, "not right"),
    *(
        (STEPS, one, RIGHT, "right")
        for one in ("S2; S4", "{S2, S4}", np.array(["S2", "S4"]), {"S2": 1, "S4": 1}.keys())
    ),
    (ROUTE, "fill -> heat → empty", RIGHT, "right"),
    # what is nearly right beside something large
    (expression(1000 + X), "1000", WRONG, "not right"),
    (expression(1000 + X), "1000 - x", WRONG, "not right"),
    (expression(X), "x + Max(x - 5, 0)", WRONG, "not right"),
    (OFFSET_Y, "60 + 3*(1 - exp(-t/5))", RIGHT, "right"),
    (OFFSET_Y, "60.5 + 3*(1 - exp(-t/5))", RIGHT, "right"),
    (OFFSET_Y, "60 + 3*(1 - exp(-t/5.04))", RIGHT, "right"),
    (OFFSET_Y, "60", WRONG, "the reading"),
    (OFFSET_Y, "60 + 3.4*(1 - exp(-t/5))", WRONG, "the reading"),
    (OFFSET_Y, "60 + 3*(1 - exp(-t/7))", WRONG, "the reading"),
    (Y, "1 - exp(-t/5) + exp(-1000*t)/2", WRONG, "the response"),
    (Y, "1 - exp(-t/5) + 0.5*sin(pi*(t*120/25 - 0.382))*Heaviside(t - 1)", WRONG, "the response"),
    (numbers([[0, 1], [-500, -3]]), [[4, 1], [-500, -3]], WRONG, "3 of 4"),
    (numbers([[0, 1], [-500, -3]]), [[1e-10, 1], [-500, -3]], RIGHT, "right"),
    (poles([0, -1000, -1]), [-0.5, -1000, -1], WRONG, "2 of 3"),
    (poles([0, -1000, -1]), [1e-7, -1000, -1], RIGHT, "right"),
    (poles([0, 0]), [0, 0.005], RIGHT, "right"),
]


@pytest.mark.parametrize(("kind", "given", "status", "says"), JUDGED, ids=range(len(JUDGED)))
def test_judging(kind, given, status, says):
    verdict = judge("x", kind, given)
    assert verdict.status == status, verdict
    assert says in verdict.says


def test_the_mistakes_of_an_exercise_come_before_the_general_ones():
    assert judge("x", TI, 2, [("Look again.", 2)]).says == "Look again."


class Liar:
    """An answer whose methods all fail."""

    def _fails(self, *_):
        raise RuntimeError("no")

    __eq__ = __float__ = __complex__ = __repr__ = __str__ = __iter__ = __len__ = __getattr__ = __array__ = _fails
    __hash__ = None


ALL = (TI, GAIN, H, Y, P, A, PI, ACTION, STEPS, OFFSET, expression(sympy.Symbol("K") * 2))


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: type(kind).__name__)
def test_an_answer_that_fails_in_every_way_is_not_judged(kind):
    assert judge("x", kind, Liar()).status == UNJUDGED


class Interrupting:
    """An answer whose methods end the program."""

    def _ends(self, *_):
        raise SystemExit

    def _interrupts(self, *_):
        raise KeyboardInterrupt

    __complex__ = __float__ = _ends
    __getattr__ = _interrupts


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: type(kind).__name__)
def test_an_answer_cannot_end_the_program(kind):
    assert judge("x", kind, Interrupting()).status == UNJUDGED


def test_a_function_cannot_end_the_program():
    assert judge("y", Y, exit).status == UNJUDGED


@pytest.mark.parametrize("make", [lambda: (time.sleep(0.001) for _ in itertools.count()), lambda: EndlessNumber()])
def test_an_endless_answer_is_not_judged(make, monkeypatch):
    monkeypatch.setattr(judging, "SECONDS", 0.1)
    verdict = judge("x", TI, make())
    assert verdict.status == UNJUDGED
    assert "takes too long" in verdict.says


class EndlessNumber:
    """A number that never comes to an end."""

    def __complex__(self):
        while True:
            time.sleep(0.001)


def test_of_an_endless_list_the_beginning_is_read():
    assert "there are 10000 values" in judge("x", TI, itertools.count()).says


@pytest.mark.parametrize(
    "given",
    ["$\\href{javascript:alert(1)}{x}$", "\ud800", "two\nlines", sympy.Symbol("$x$"), sympy.Symbol("x" * 10**5)],
)
@pytest.mark.parametrize("kind", ALL, ids=lambda kind: type(kind).__name__)
def test_what_is_quoted_of_an_answer_is_harmless(kind, given):
    says = judge("x", kind, given).says
    assert "$" not in says
    assert "\n" not in says
    assert len(says) <= 400
    assert says.encode("utf-8")


def test_a_long_chain_of_functions_is_no_formula():
    for text in ("lambda:" * 400 + "s", "s if " * 500 + "s", "not " * 500 + "s"):
        with pytest.raises(Unreadable):
            Formula(text, "s")


def test_a_design_that_takes_too_long_is_not_judged():
    def slow(_):
        while True:
            time.sleep(0.01)

    verdict = judge("x", design(number(1), criterion("the overshoot", slow, below=1)), 2)
    assert verdict.status == UNJUDGED
    assert "too long" in verdict.says


def test_of_a_design_that_fails_a_condition_nothing_else_is_said():
    unstable = criterion("the loop is stable", lambda pid: pid.Kp < 3)
    asked = design(settings(PID(1)), unstable, criterion("the gain", lambda pid: pid.Kp, below=5))
    assert judge("x", asked, PID(9)).says == "asked is that the loop is stable, and it is not so"


def test_a_limited_computation_is_stopped():
    seen = []

    def endless():
        while True:
            try:
                seen.append(len(seen))
                time.sleep(0.001)
            except Exception:  # it does not want to be stopped
                pass

    with pytest.raises(TimeoutError):
        limited(0.05, endless)
    time.sleep(0.2)
    stopped_at = len(seen)
    time.sleep(0.1)
    assert len(seen) == stopped_at


def test_a_limited_computation_raises_what_it_raises():
    with pytest.raises(ZeroDivisionError):
        limited(1, lambda: 1 / 0)
    with pytest.raises(RuntimeError, match="stopped by SystemExit"):
        limited(1, sys.exit)


# Writing an exercise.


@exercise("99.1", title="A tank", points=4, where=lambda A, q: q < A)
def tank(A=between(2, 8, "m²", reference=4), q=between(1, 5, "m³/s", reference=2), kind=choice("open", "closed")):
    r"""A tank that is {kind} has an area of {A}. An inflow of {q} begins; $\frac{{{q}}}{{{A}}}$ is {H}."""
    return answers(rate=number(q / A, "m/s", "the rate of the level"), H=transfer_function(q / (A * s)))


@tank.shows
def _(A, q):
    return {"H": q / (A * s)}


@tank.mistake("Half of it is missing for an area of {A}.")
def _(A, q):
    return {"rate": q / A / 2}


def test_a_question():
    question = tank.question()
    assert question.given("A") == 4
    assert question.given("A", "q") == (4, 2)
    assert question.statement.startswith("**Exercise 99.1 · A tank** (4 points)")
    assert "an area of 4\N{NO-BREAK SPACE}m². An inflow of 2\N{NO-BREAK SPACE}m³/s" in question.statement
    assert r"is $\frac{0.5}{s}$." in question.statement
    assert "- `rate`: the rate of the level, in m/s" in question.statement
    with pytest.raises(ValueError, match="gives no 'V': expected 'A', 'q', 'kind', 'H'"):
        question.given("V")


def accuracies(x=between(1, 9)):
    """A statement about {x}."""
    return answers(a=number(x, within=0), b=number(x), c=number(x), d=word("yes", ["yes", "no"]))


def test_what_is_shown_has_decimals_where_few_digits_write_them():
    one = Exercise("99.2", "Decimals", 1, lambda: True, key_of_one)
    one.shows(lambda: {"x": sympy.Rational(5, 2) * s + sympy.Rational(1, 3)})
    assert r"$2.5 s + \frac{1}{3}$" in one.question().statement


def test_the_statement_says_the_accuracy():
    statement = Exercise("99.2", "Accuracies", 1, lambda: True, accuracies).question().statement
    assert statement.endswith("\n\n*Accuracy: 1\N{NO-BREAK SPACE}%; `a`: exact*")


def test_a_response():
    question = tank.question()
    response = question.check(rate=0.25, H="0.5/s")
    assert [verdict.status for verdict in response.verdicts] == [MISTAKE, RIGHT]
    assert "an area of 4\N{NO-BREAK SPACE}m²" in response.verdicts[0].says
    assert (response.earned, response.is_right) == (2, False)
    assert repr(response).splitlines()[0] == "≈ Exercise 99.1 · A tank: 1 of 2 right"
    assert 'role="status"' in response._repr_html_()
    assert question.check(rate="0.5 m/s", H=1 / (2 * s)).is_right
    assert repr(question.check()).startswith("… Exercise 99.1 · A tank: not answered yet")
    assert "did you mean rate?" in repr(question.check(rat=3))
    assert "by their names" in repr(question.check(3))


def test_html_of_a_reader_is_shown_and_not_run():
    text = tank.question().check(H="<script>alert(1)</script>")._repr_html_()
    assert "<script>" not in text


def test_signs_of_formulas_outside_of_formulas_are_none():
    response = Response("1.1", (Verdict("x", WRONG, r"of $\zeta$ and \(x\)"),), 1)
    assert r"of $\zeta$ and <span>\</span>(x<span>\</span>)" in response._repr_html_()
    response = Response("1.1", (Verdict("x", WRONG, "costs 3 $"),), 1)
    assert "costs 3 <span>$</span>" in response._repr_html_()


def test_any_name_can_be_given():
    response = tank.question().check(**{"self": 1, "alone": 2, "$x$": 3, "\ud800": 4})
    assert "self is not asked" in repr(response)
    assert "$" not in repr(response)
    assert repr(response).encode()


def test_a_student_has_one_name_in_any_spelling():
    assert tank.question("Zoe\u0308").values == tank.question("Zo\u00eb").values
    assert tank.question("\ud800").values
    with pytest.raises(ValueError, match="empty text: expected"):
        tank.question(" ")


def key_of_numbers(x=between(1, 9)):
    """A statement about {x}."""
    return {"y": x}


def key_of_apples(x=between(1, 9)):
    """A statement about {x}."""
    return answers(y="apples")


def key_of_one(x=between(1, 9)):
    """A statement about {x}."""
    return answers(y=x)


def test_a_choice_of_words_and_numbers():
    assert choice("none", 3, reference=3).reference == 3
    assert choice("none", 3).reference == "none"


def test_a_key_that_is_no_answers():
    with pytest.raises(ValueError, match=r"exercise 99\.2 returns .*: expected answers"):
        Exercise("99.2", "A key", 1, lambda: True, key_of_numbers).question().check(y=3)


def test_a_mistake_in_what_is_not_asked():
    one = Exercise("99.2", "A mistake", 1, lambda: True, key_of_one)
    one.mistake("Wrong.")(lambda x: {"z": x + 1})
    with pytest.raises(ValueError, match=r"a mistake of exercise 99\.2 is in 'z': expected 'y'"):
        one.question().check(y=3)


def test_a_function_of_the_author_that_fails():
    one = Exercise("99.2", "A mistake", 1, lambda: True, key_of_one)
    one.mistake("Wrong.")(lambda T: {"y": T})
    with pytest.raises(ValueError, match=r"a mistake of exercise 99\.2 fails for x = \d.*: 'T' is no parameter"):
        one.question().check(y=3)
    with pytest.raises(ValueError, match=r"the key of exercise 99\.2 fails for x = \d.*: 'apples' is a text"):
        Exercise("99.2", "A key", 1, lambda: True, key_of_apples).question().check(y=3)


def test_a_condition_on_what_is_no_parameter():
    with pytest.raises(ValueError, match="'T' is no parameter of the exercise: expected x"):
        Exercise("99.2", "A condition", 1, lambda T: T > 1, key_of_one).question()


def test_variants_are_the_same_every_time_and_differ():
    one, other = (tank.question(name).values for name in ("Ada", "Norbert"))
    assert one == tank.question.__wrapped__(tank, "Ada").values
    assert one != other
    for k in range(100):
        values = tank.question(f"{k}").values
        assert values["q"] < values["A"]


def test_two_exercises_of_one_number():
    module = types.ModuleType("assignment")
    module.one, module.other = tank, Exercise("99.1", "Another", 1, lambda: True, tank.key)
    with pytest.raises(ValueError, match=r"two exercises 99\.1 in assignment"):
        bank.collected(module)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: exercises.exercise("10.99"), "there is no exercise '10.99': expected one of 10.1"),
        (lambda: exercises.exercise("99.1"), "there is no chapter '99'"),
        (lambda: exercises.exercise(10.1), "the exercise is 10.1: expected chapter and place in it as text"),
        (lambda: exercises.exercise("10.1", student=""), "empty text"),
        (lambda: exercises.exercise("10.1", student=3), "student is 3"),
        (lambda: exercises.progress("B"), "there is no chapter 'B'"),
    ],
)
def test_a_reader_is_told_what_there_is(make, says):
    with pytest.raises(exercises.ExerciseError) as caught:
        make()
    assert says in str(caught.value)


# Progress.


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder of one's own, where progress is kept."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("LOOPBOOK_PROGRESS", raising=False)
    return tmp_path / FILE


def test_progress_survives_a_restart(desk):
    assert exercises.progress("10").right == 0
    question = exercises.exercise("10.1")
    question.check(K=77)
    assert not json.loads(desk.read_text())["answered"]["10.1"]
    assert question.check(**{name: kind.key for name, kind in question.key.items()}).is_right
    program = "from loopbook.exercises import progress; print(progress('10'))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.startswith("1 of ")
    question.check(K=77)  # what was right once stays so
    assert exercises.progress("10").right == 1
    assert exercises.progress("10", student="Ada").right == 0
    assert "✓ Exercise 10.1" in exercises.progress("10")._repr_html_()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"\xff\xfe",
        b"[" * 100_000,
        b" " * 2_000_000,
        b'{"answered": 3}',
        b'{"answered": {"10.1": "yes"}}',
    ],
)
def test_a_damaged_file_is_ignored_with_a_warning(desk, content):
    desk.write_bytes(content)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert exercises.progress("10").right == 0
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        exercises.exercise("10.1").check(K=77)
    assert json.loads(desk.read_text()) == {"answered": {"10.1": False}}


def test_a_folder_that_cannot_be_written_is_said(desk):
    desk.mkdir()
    with pytest.warns(UserWarning, match="cannot be stored|damaged"):
        exercises.exercise("10.1").check(K=77)
    assert [file.name for file in desk.parent.iterdir()] == [desk.name]


def test_a_link_leads_to_the_file(desk):
    stored = desk.with_name("elsewhere.json")
    stored.write_bytes(b"\xef\xbb\xbf" + b'{"answered": {"10.2": true}}')  # as an editor may save it
    desk.symlink_to(stored)
    exercises.exercise("10.1").check(K=77)
    assert desk.is_symlink()
    assert json.loads(stored.read_text()) == {"answered": {"10.1": False, "10.2": True}}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes")
def test_a_pipe_is_no_file(desk):
    os.mkfifo(desk)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert exercises.progress("10").right == 0


def test_what_is_not_answered_leaves_no_trace(desk):
    exercises.exercise("10.1").check(K=...)
    assert not desk.exists()
