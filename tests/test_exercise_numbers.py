"""Answers that are numbers, lists of numbers and poles: what is right, which mistakes are named, what is no answer."""

import math
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pint
import pytest
import sympy

from judged import assert_judged
from loopbook import s
from loopbook.exercises.authoring import number, numbers, poles
from loopbook.exercises.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG, judge

X = sympy.Symbol("x")
TI = number(120, "s", "the integral time")
GAIN = number(0.25, "", "the gain")
ANGLE = number(math.pi / 3, "rad", "the phase margin")
P = poles([-1 + 2j, -1 - 2j, -3])
A = numbers([[0, 1], [-2, -3]], what="the matrix")
MINUS = number(-2, "K/%", "the gain")
FLOW = number(0.5, "m³/s", "the flow")
OMEGA = number(3, "rad/s", "the frequency")
ROOM = number(20, "°C", "the temperature")
DIFFERENCE = number(10, "K", "the rise")
PINT = pint.UnitRegistry(cache_folder=None)

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
    (TI, 118, WRONG, "off by a few percent, which is more than the rounding"),
    (TI, 2, MISTAKE, "the value in min"),
    (TI, -120, MISTAKE, "sign"),
    (TI, 1 / 120, MISTAKE, "inverse"),
    (TI, 77, WRONG, "not right, though of about the right size; asked: the integral time, in s"),
    (TI, "2 kg", UNJUDGED, "not a unit of the same quantity"),
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
    (P, [-3, -1 - 2j, -1 + 2j], RIGHT, "right"),
    (P, {-3: 1, -1 - 2j: 1, -1 + 2j: 1}, RIGHT, "right"),
    (P, np.roots(np.poly([-3, -1 - 2j, -1 + 2j])), RIGHT, "right"),
    (P, ["-3", "-1 + 2j", "-1 - 2*I"], RIGHT, "right"),
    (P, [3, 1 - 2j, 1 + 2j], MISTAKE, "signs"),
    (P, [-3, -1 + 2j], MISTAKE, "a complex value never comes alone"),
    (P, [-3, -1 + 2j, -7], WRONG, "2 of 3"),
    (P, "none", UNJUDGED, "expected a list of numbers"),
    (A, [[0, 1], [-2, -3]], RIGHT, "right"),
    (A, sympy.Matrix([[0, 1], [-2, -3]]), RIGHT, "right"),
    (A, [[0, -2], [1, -3]], MISTAKE, "rows and columns"),
    (A, [0, 1, -2, -3], UNJUDGED, "expected 2 by 2"),
    (A, [[0, 1], [-2, 3]], MISTAKE, "3 of 4 numbers are right; row 2, column 2: the size is right, the sign is not"),
    (number(1.7, "", "the gain margin"), "4.609 dB", RIGHT, "converted from dB"),
    (number(1120, "N", "the force"), 1.12, MISTAKE, "in kN"),
    (number(12, "", "the number of batches", within=0), 13, WRONG, "not right"),
    (P, [-3.06, -1 - 2j, -1 + 2j], MISTAKE, "2 of 3 are right; one is off by a few percent"),
    (A, 5, UNJUDGED, "such as [[1, 2], [3, 4]]"),
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
    (TI, "2 minutes per second", UNJUDGED, "not a unit of the same quantity"),
    (TI, "10 dozen s", UNJUDGED, "is not a number"),
    (TI, "1 m^9^9^9", UNJUDGED, "is not a number"),
    (TI, "1" * 5000, UNJUDGED, "5000 characters"),
    (number(2, "%/K", "the gain"), 0.02, MISTAKE, "in 1/K"),
    (number(2, "K/%", "the gain"), 200, MISTAKE, "in K"),
    (number(0, "m", "the offset"), 0.005, RIGHT, "right"),
    (number(0, "m", "the offset"), 0.02, WRONG, "not right"),
    (TI, 120 + 0.01j, UNJUDGED, "complex"),
    (P, {-3: 30}, UNJUDGED, "cannot occur 30 times"),
    (P, ["-3.0", "-1 + 2.0i", "-1 - 2i"], RIGHT, "right"),
    # as programs give numbers
    *(
        (TI, one, RIGHT, "right")
        for one in (np.array(120), np.float32(120), np.int8(120), np.array("120"), np.array([[120]]))
    ),
    *((TI, one, RIGHT, "right") for one in (Fraction(120), Decimal(120), mpmath.mpf(120), {120}, {"a": 120}.values())),
    *((TI, one, RIGHT, "right") for one in (sympy.Eq(X, 120), {X: 120}, [{X: 120}], sympy.FiniteSet(120), iter([120]))),
    (TI, PINT.Quantity(2, "min"), RIGHT, "converted from min"),
    (TI, PINT.Quantity(2, "kg"), UNJUDGED, "not a unit of the same quantity"),
    (GAIN, PINT.Quantity(25, "percent"), RIGHT, "right"),
    (DIFFERENCE, PINT.Quantity(10, "delta_degC"), RIGHT, "right"),
    (number(0, "m"), np.ma.masked, UNJUDGED, "missing"),
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
    (P, "", UNJUDGED, "is not a number"),
    (poles([-2]), "-2,5", UNJUDGED, "decimal comma"),
    (poles([]), "[]", RIGHT, "right"),
    (numbers([1, 2], "s"), "[1,2]", RIGHT, "right"),
    (numbers([1, 2], "s"), "1 s, 2 s", RIGHT, "right"),
    (numbers([1, 2], "s"), range(1, 3), RIGHT, "right"),
    # what is nearly right beside something large
    (numbers([[0, 1], [-500, -3]]), [[4, 1], [-500, -3]], WRONG, "3 of 4"),
    (numbers([[0, 1], [-500, -3]]), [[1e-10, 1], [-500, -3]], RIGHT, "right"),
    (poles([0, -1000, -1]), [-0.5, -1000, -1], WRONG, "2 of 3"),
    (poles([0, -1000, -1]), [1e-7, -1000, -1], RIGHT, "right"),
    (poles([0, 0]), [0, 0.005], RIGHT, "right"),
]


@pytest.mark.parametrize(("kind", "given", "status", "says"), JUDGED, ids=range(len(JUDGED)))
def test_judging(kind, given, status, says):
    assert_judged(kind, given, status, says)


def test_the_mistakes_of_an_exercise_come_before_the_general_ones():
    assert judge("x", TI, 2, [("Look again.", 2)]).says == "Look again."
