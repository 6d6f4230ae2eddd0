"""Answers that are formulas and functions of time."""

import math

import numpy as np
import sympy
from hypothesis import given
from hypothesis import strategies as st

from exercisebook.authoring import expression, time_function
from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG, judge
from judged import assert_judged
from plainmath.expressions import s, t

X = sympy.Symbol("x")
H = expression(3 * sympy.exp(-2 * s) / (5 * s + 1))
Y = time_function(1 - sympy.exp(-t / 5), until=25, what="the response")
LATER = time_function(sympy.Heaviside(t - 3) * (1 - sympy.exp(-(t - 3) / 5)), until=25, what="the response", time="s")
METRES = time_function(2 * (1 - sympy.exp(-t / 5)), until=25, unit="m", time="s", what="the level")
BOX = expression(sympy.sympify("pi*r**2*h"), "the volume", unit="m³")
pi_r2_h = sympy.pi * sympy.Symbol("r") ** 2 * sympy.Function("h")(t)
LONG = time_function(1 - sympy.exp(-t / 5) + sympy.exp(-50 * t) / 300, until=2500, what="the response")
FORM = sympy.sympify("K*T/(K + 1)")
RATIO = expression(FORM, "the ratio")
OFFSET_Y = time_function(60 + 3 * (1 - sympy.exp(-t / 5)), until=25, unit="°C", what="the reading")

JUDGED = [
    (H, "0.6*exp(-2*s)/(s + 0.2)", RIGHT, "right"),
    (H, 3 / (5 * s + 1), WRONG, "not right"),
    (H, sympy.exp(2 * s) * (5 * s + 1) / 3, MISTAKE, "inverse"),
    (H, "3/(tau*s + 1)", UNJUDGED, "'tau' is not a symbol"),
    (Y, "1 - exp(-0.2*t)", RIGHT, "right"),
    (Y, lambda times: 1 - np.exp(-times / 5), RIGHT, "right"),
    (Y, lambda time: 1 - math.exp(-time / 5), RIGHT, "right"),
    (Y, sympy.exp(-t / 5) - 1, MISTAKE, "sign"),
    (Y, "exp(-0.2*t)", WRONG, "its initial value and final value are not right"),
    (Y, "1 - exp(-0.2*t) + exp(-2000*t)/1e6", RIGHT, "right"),
    (LONG, "1 - exp(-t)*exp(0.8*t)", RIGHT, "right"),
    (LONG, "0*t", WRONG, "its initial value is right, but its initial slope and final value"),
    (Y, lambda times: "much", UNJUDGED, "no numbers"),
    (BOX, pi_r2_h, RIGHT, "right"),
    (BOX, "r^2*pi*h(t)", RIGHT, "right"),
    (Y, "3-1,500*t", UNJUDGED, "comma as a point"),
    (Y, "1 - e^(-0,2t)", RIGHT, "read as 1 - e**(-0.2*t)"),
    (Y, "1/2t", UNJUDGED, "may be .../(2*t) or (.../2)*t"),
    (H, r"\frac{3}{5s+1} e^{-2s}", RIGHT, "read as 3/(5*s + 1)*e**(-2*s)"),
    (H, "3/(5s+1) e^(-2s) K", UNJUDGED, "without a unit"),  # or a factor
    # units behind numbers, and behind the whole
    (H, "3/(5s+1) e^(-2s) K/%", UNJUDGED, "the text ends in K/%: expected an expression in s, without a unit"),
    (H, "3 K/%/(5s+1) e^(-2s)", UNJUDGED, "'K' is not a symbol"),
    (H, "3/(5S+1)*exp(-2S)", UNJUDGED, "did you mean 's'"),
    (H, "3m/(5s+1)*exp(-2s)", UNJUDGED, "'m' is not a symbol"),
    (H, "20 + 0.5t", UNJUDGED, "'t' is not a symbol"),
    (METRES, "2 m (1 - e^(-t/5 s))", RIGHT, "right, read as 2*(1 - e**(-t/5))"),
    (METRES, "2 m - 2 m e^(-t/(5 s))", RIGHT, "right, read as 2 - 2*e**(-t/5)"),
    (METRES, "200 cm*(1 - exp(-t/(5 s)))", RIGHT, "read as 200*(1 - exp(-t/5))*(1/100)"),
    (METRES, "2 m (1 - e^(-t/5))", RIGHT, "right"),
    (METRES, "2 m*(1 - exp(-t/(5 min)))", MISTAKE, "unit of time"),
    (METRES, "2 - 2 m e^(-t/(5 s))", UNJUDGED, "meter is not a unit of the same quantity as a number without unit"),
    (METRES, "2 kg*(1 - exp(-t/(5 s)))", UNJUDGED, "kilogram is not a unit of the same quantity as meter"),
    (METRES, "2 - 2t/s", UNJUDGED, "not a unit of the same quantity"),
    (METRES, "2(1 - e^(-t/(5 s))) m", RIGHT, "right"),
    (METRES, "2(1 - e^(-t/5)) m", RIGHT, "read as 2*(1 - e**(-t/5))"),
    (METRES, "200*(1 - exp(-t/5)) cm", RIGHT, "converted from cm"),
    (METRES, "2*(1 - exp(-t/5)) [m]", RIGHT, "right"),
    (METRES, "2*(1 - exp(-t/5)) kg", UNJUDGED, "not a unit of the same quantity"),
    (METRES, "2 s", UNJUDGED, "not a unit of the same quantity"),
    (METRES, "200*(1 - exp(-t/5))", MISTAKE, "the values in cm"),
    (Y, "1 - exp(-12*t)", MISTAKE, "unit of time"),
    # functions in pieces
    *(
        (LATER, text, RIGHT, "right, read as Piecewise")
        for text in (
            "0 for t < 3, 1 - e^(-(t-3)/5) for t > 3",
            "0 for t<3; 1-e^(-(t-3)/5) for t>=3",
            "y = 0 for t < 3 and y = 1 - e^(-(t-3)/5) for t > 3",
            "0 until 3 s, 1 - e^(-(t-3)/5) from 3 s on",
            "1 - exp(-(t-3)/5) for t >= 3, 0 otherwise",
            "0 if t < 3 else 1 - exp(-(t-3)/5)",
            "0 (t<3), 1-e^(-(t-3)/5) (t>3)",
            "0 for 0 <= t < 3,0 and 1-e^(-(t-3,0)/5) after",
            "0 before 3 s, then 1-e^(-(t-3)/5)",
        )
    ),
    (LATER, "(1 - e^(-(t-3)/5)) θ(t-3)", RIGHT, "Heaviside(t - 3)"),
    (LATER, "1 - e^(-(t-3)/5) for t < 3, 0 after", WRONG, "read as Piecewise"),
    (LATER, "1 - e^(-(t-3)/5) for t > 3", UNJUDGED, "what is it before t = 3?"),
    (LATER, "0 for t < 3", UNJUDGED, "what is it after t = 3?"),
    (LATER, "0 for t < 3, 1 - e^(-(t-3)/5) for t > 4", UNJUDGED, "what is it from t = 3 to 4?"),
    (LATER, "0 for t < 0.05 min, 1 - e^(-(t-3)/5) for t > 0.05 min", RIGHT, "t < 3"),
    (LATER, "0 for t < 3 min, 1 - e^(-(t-3)/5) for t > 3 min", MISTAKE, "t < 180"),
    (Y, "0 for t < 0 s, 1 - e^(-t/5) otherwise", UNJUDGED, "which unit 0 s is in is not known"),
    (LATER, "1 for t < 3, stop after", UNJUDGED, "not a symbol"),
    (LATER, "for t < 3, for t > 3", UNJUDGED, ""),
    (LATER, "0 for t < 3, " * 9, UNJUDGED, ""),
    (Y, "Piecewise((1 - exp(-t/5), t < 15))", UNJUDGED, "no value at some points"),
    (Y, lambda times: np.where(times < 3, np.nan, 1 - np.exp(-times / 5)), UNJUDGED, "no finite value at some times"),
    # formulas in other spellings and forms
    *((RATIO, one, RIGHT, "right") for one in (sympy.Eq(X, FORM), {FORM}, {X: FORM}, np.array(FORM), iter([FORM]))),
    (expression(sympy.Symbol("q_2i") * sympy.Symbol("ζ")), "q_2i*ζ", RIGHT, "right"),
    (expression(sympy.log(10) * X), "2.302585*x", RIGHT, "right"),
    (expression(sympy.log(X) / sympy.log(10)), "log10(x)", RIGHT, "right"),
    (Y, "1 - np.exp(-t/5)", RIGHT, "right"),
    (Y, sympy.Eq(sympy.Function("y")(t), 1 - sympy.exp(-t / 5)), RIGHT, "right"),
    # what is nearly right beside something large
    (expression(1000 + X), "1000", MISTAKE, "a term is missing: look for one with x"),
    (expression(1000 + X), "1000 - x", MISTAKE, "one sign is wrong: look at the term with x"),
    (expression(X), "x + Max(x - 5, 0)", WRONG, "not right"),
    (OFFSET_Y, "60.5 + 3*(1 - exp(-t/5))", RIGHT, "right"),
    (OFFSET_Y, "60 + 3*(1 - exp(-t/5.04))", RIGHT, "right"),
    (OFFSET_Y, "60", WRONG, "its initial value is right"),
    (OFFSET_Y, "60 + 3.4*(1 - exp(-t/5))", WRONG, "its initial value is right, but"),
    (
        OFFSET_Y,
        "60 + 3*(1 - exp(-t/7))",
        WRONG,
        "its initial value and final value are right, but its initial slope is not",
    ),
    (Y, "1 - exp(-t/5) + exp(-1000*t)/2", WRONG, "its final value is right, but its initial value is not"),
    (Y, "1 - exp(-t/5) + 0.5*sin(pi*(t*120/25 - 0.382))*Heaviside(t - 1)", WRONG, "initial slope are right"),
]


def test_judging(subtests):
    for kind, answer, status, says in JUDGED:
        with subtests.test(f"{answer!r:.60}"):
            assert_judged(kind, answer, status, says)


@given(st.text(alphabet="s0123456789.+-*/^()exp, K[]'=:<%_", max_size=40))
def test_any_text_is_judged(text):
    assert judge("H", H, text).says
