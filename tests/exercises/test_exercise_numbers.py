"""Answers that are numbers, lists of numbers and poles: what is right, which mistakes are named, what is no answer."""

import math
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pint
import pytest
import sympy

from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG, judge
from judged import assert_judged
from loopbook import s
from loopbook.exercises.authoring import number, numbers, poles

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
    (TI, "120,5", RIGHT, "read as 120.5"),
    (TI, "two minutes", RIGHT, "read as 2 minutes, converted from minutes"),
    (TI, "some minutes", UNJUDGED, "a number, in s"),
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
    (P, "none", WRONG, "the list is empty"),
    *((poles([]), text, RIGHT, "right") for text in ("none", "no zeros", "There are no finite zeros.", "[]")),
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
    # as people write numbers
    *(
        (TI, text, RIGHT, "right")
        for text in (
            "120s",
            "120 sec",
            "120 sec.",
            "120 secs",
            "2 Minutes",
            "2.0 mins",
            "ca. 120 s",
            "~120 s",
            "≈ 120",
            "about 2 min",
            "120 s.",
            "Ti ≈ 120 s",
            "T_i: 120 s",
            "240/2 s",
            "120.0",
            "1.2e2",
            "1,2e2 s",
            "1.2x10^2",
            "1,2·10² s",
            "2 min 0 s",
            "1 min 60 s",
            "1 min and 60 s",
            "240/2 = 120",
            "120 s = 2 min",
            "120,0 s",
            "+120",
            "120 s approx.",
            "0,0333333 h",
        )
    ),
    *(
        (number(90, "s"), text, RIGHT, "right")
        for text in ("1 1/2 min", "1.5 min", "1,5 min", "1½ min", "3/2 min", "1 min 30 s", "90 seconds")
    ),
    *(
        (number(1200, "kg"), text, RIGHT, "right")
        for text in ("1 200 kg", "1.2 t", "1200kg", "1'200 kg", "1,200.0 kg", "1.200,0 kg", "1.2·10^3 kg")
    ),
    *(
        (GAIN, text, RIGHT, "right")
        for text in (
            "1/4",
            "25%",
            "25 percent",
            "25 per cent",
            "0,25",
            ".25",
            "25 pct",
            "25 % of the range",
            "2.5·10^-1",
        )
    ),
    *(
        (ANGLE, text, RIGHT, "right")
        for text in ("60°", "60 degrees", "60 degree", "60 Degrees", "π/3", "pi/3", "π/3 rad", "1,0472 rad")
    ),
    *(
        (ROOM, text, RIGHT, "right")
        for text in ("20 degrees C", "20 degrees Celsius", "20 C°", "20°C", "20 celsius", "20,0 °C")
    ),
    *(
        (number(2, "%/K"), text, RIGHT, "right")
        for text in ("2 percent/K", "2 % per K", "2 percent per kelvin", "2 %/°C", "2%/K")
    ),
    *(
        (number(12, "kg/min"), text, RIGHT, "right")
        for text in ("12 kg/min", "12 kg per minute", "12 kg per min", "0.2 kg/s", "12kg/min", "12 Kg/min")
    ),
    *((number(5, "N m"), text, RIGHT, "right") for text in ("5 Nm", "5 N m", "5 N*m", "5 N·m", "0.005 kNm")),
    *((number(0), text, RIGHT, "right") for text in ("zero", "Zero", "0", "0,0", "0 %")),
    *(
        (TI, text, UNJUDGED, "")
        for text in (
            "1,200",
            "100 = 120 s",
            "120 ± 5",
            "120 s 3",
            "1 2 0",
            "120 s or 130 s",
            "120 m",
            "12 0 s",
            "between 100 and 140",
        )
    ),
    *(
        (number(4, "", "the number of whole batches"), text, RIGHT, "read as")
        for text in ("4 batches", "batch 4", "four batches", "4 full batches", "4 (whole batches)", "No. 4")
    ),
    (number(4, "", "the number of whole batches"), "4 dozen", UNJUDGED, "is not a number"),
    # a single comma is a decimal one, and where zeros are at its end it is asked
    (number(1.364, "K/%"), "1,364 K/%", RIGHT, "right, read as 1.364 K/%"),
    (number(12.375), "12,375", RIGHT, "right, read as 12.375"),
    (number(12375), "12,375", MISTAKE, "factor of 1000"),
    (number(99), "12,375", WRONG, "· read as 12.375"),
    (number(1.5, "s"), "1,500 s", UNJUDGED, "1,500 may be 1.500 or 1500"),
    # numbers with units, worked out
    *(
        (number(1.5, "K/%"), text, RIGHT, "right, read as 1.5")
        for text in ("15 K / 10 %", "15 K/(10 %)", "(45 K - 30 K)/(10 %)", "1,5e1 K / 10 %", "15 °C / 10 %")
    ),
    *((number(-0.75, "bar"), text, RIGHT, "right") for text in ("8 bar - 8,75 bar", "8 bar - 875 kPa", "8 - 8.75 bar")),
    *((number(58, "°C"), text, RIGHT, "right") for text in ("60 °C - 2 K", "60 °C - 2 °C")),
    *((number(35, "deg"), text, RIGHT, "right") for text in ("90° - 55° = 35°", "180° - 145°", "90°-55°")),
    *(
        (number(4, "min"), text, RIGHT, "right")
        for text in ("10 K / (2,5 K/min)", "14 L / 3,5 L/min", "2 min * 2", "1/4 h - 11 min", "2 min + 120 s")
    ),
    *(
        (number(4, "min"), text, UNJUDGED, says)
        for text, says in (
            ("15 K / 11 %", "do not make min"),
            ("8 min - 4", "do not make min"),
            ("2 min ** 2", ""),
            ("2 min or 3 min", ""),
            (" + ".join(["1 s"] * 30), ""),
            ("(" * 120 + "1 s" + ")" * 120 + " * 2", ""),
            ("1e300 min * 1e300", ""),
        )
    ),
    # what stands around a number
    *(
        (number(4, "min"), text, RIGHT, "right")
        for text in ("theta - theta_m = 4 min", "> 4 min", "at least 4 min", ">= 240 s", "after 4 min", "it is 4 min")
    ),
    *(
        (number(1.25), text, RIGHT, "right")
        for text in ("factor 1,25", "a factor of 1.25", "1.25 times", "1,25 times larger", "by a factor of 5/4")
    ),
    *(
        (number(41, "", "the number of the loop"), text, RIGHT, "read as 41")
        for text in ("TC41", "loop 41", "no. 41", "41 (pressure)", "#41", "TC-41")
    ),
    *((numbers([41, 42]), text, RIGHT, "right") for text in ("41, 42", "41 and 42")),
    (number(41), "TC41", UNJUDGED, "not a number"),
    (number(8, "s"), "at 8 s", RIGHT, "right"),
    (number(1.25), "1.25 times smaller", UNJUDGED, "not a number"),
    (number(0), "none", RIGHT, "right"),
    (numbers([14, 10], "s"), {"A": "14 s", "B": "10 s"}, RIGHT, "right"),
    (numbers([14, 10], "s"), "14,0; 10,0", RIGHT, "right, read as [14, 10]"),
    (poles([-1 + 2.5j, -1 - 2.5j]), "-1 ± 2,5j", RIGHT, "right, read as -1 + 2.5j, -1 - 2.5j"),
    # poles as people write them
    *(
        (poles([-1 + 2j, -1 - 2j]), text, RIGHT, "right")
        for text in (
            "-1 ± 2j",
            "-1 +- 2i",
            "-1±2j",
            "-1 ± j2",
            "-1 +/- 2j",
            "−1 ± 2i",
            "s = -1 ± 2j",
            "s_1,2 = -1 ± 2j",
            "s1,2 = -1±2i",
            "-1 ± 2j rad/s",
            r"-1 \pm 2j",
            "-1+2j and -1-2j",
            "-1+2j; -1-2j",
            "s1 = -1 + 2j, s2 = -1 - 2j",
            "[-1+2j, -1-2j]",
            "{-1+2i, -1-2i}",
            "(-1+2j, -1-2j)",
            "-1+j2, -1-j2",
            "-1 + 2*1j, -1 - 2*1j",
            "-1,0 ± 2,0j",
            "-1,0+2,0j; -1,0-2,0j",
            "-1 ± j*sqrt(4)",
            "-1 ± i√4",
            "-1 ± sqrt(-4)",
            "-1±j·2",
        )
    ),
    *(
        (poles([-1 + 2j, -1 - 2j]), one, RIGHT, "right")
        for one in (["-1 ± 2j"], ["-1+2j", "-1+-2j"], ["-1 + j2", "-1 - j2"], ("-1 + 2i", "-1 - 2i"))
    ),
    *(
        (poles([-0.5 + 1.3j, -0.5 - 1.3j]), text, RIGHT, "right")
        for text in ("-0.5±j1.3", "-0,5 ± 1,3i", "-1/2 ± 1.3j", "-.5 ± 1.3j")
    ),
    *(
        (poles([2j, -2j]), text, RIGHT, "right")
        for text in ("±2j", "+-j2", "± 2i", "2j, -2j", "j2, -j2", "2j and -2j", "0 ± 2j")
    ),
    *(
        (poles([-2, -2]), text, RIGHT, "right")
        for text in (
            "-2, -2",
            "-2 (double)",
            "-2 double",
            "double pole at -2",
            "a double pole at -2",
            "-2 (twice)",
            "-2, twice",
            "-2 (2x)",
            "-2; -2",
            "-2 and -2",
            "-2 (multiplicity 2)",
        )
    ),
    *(
        (poles([-1, -1, -2]), text, RIGHT, "right")
        for text in ("-1 (double), -2", "-1 (double) and -2", "-2; -1 (twice)", "-2, -1, -1")
    ),
    *(
        (poles([-1, -4]), text, RIGHT, "right")
        for text in ("-1, -4", "-1,-4", "-1 and -4", "s = -1 and s = -4", "s1=-1; s2=-4", "{-4, -1}", "-1; -4")
    ),
    (poles([-1 + 2j, -1 - 2j]), "-1 + 2j", MISTAKE, "its mirror image is missing"),
    (poles([-1 + 2j, -1 - 2j]), "1 ± 2j", MISTAKE, "signs"),
    (poles([-2, -2]), "-2 (triple)", WRONG, "also more"),
    (poles([-1, -5]), "-1,5", WRONG, "none of these is right, and there should be more"),
    # rows and tables in a text
    *(
        (A, text, RIGHT, "right")
        for text in (
            "[[0, 1], [-2, -3]]",
            "[0, 1; -2, -3]",
            "[0 1; -2 -3]",
            "[[0 1] [-2 -3]]".replace("] [", "], ["),
            "0, 1; -2, -3",
            "[[0; 1]; [-2; -3]]",
            "((0, 1), (-2, -3))",
        )
    ),
    *(
        (numbers([0.4, 0]), text, RIGHT, "right")
        for text in ("[0,4; 0]", "0,4; 0", "0.4, 0", "[0.4 0]", "0.4 and 0", "b1 = 0.4, b2 = 0", "(0.4, 0)")
    ),
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
    (poles([-2.5]), "-2,5", RIGHT, "read as -2.5"),
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


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)


def test_the_mistakes_of_an_exercise_come_before_the_general_ones():
    assert judge("x", TI, 2, [("Look again.", 2)]).says == "Look again."


@pytest.mark.parametrize("text", ["[1/2 -3; 4 0]", "[[0.5, -3], [4, 0]]", "1/2, -3; 4, 0"])
def test_a_table_in_a_text(text):
    table = numbers([[0.5, -3], [4, 0]])
    assert table.agrees(table.read(text)[0])


def test_a_mixed_fraction_is_no_row():
    assert numbers([1.5, 3]).read("1 1/2; 3")[0].tolist() == [1.5, 3]
