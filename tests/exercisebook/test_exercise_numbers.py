"""Answers that are numbers, lists of numbers and poles: what is right, which mistakes are named, what is no answer."""

import math
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pint
import sympy

from exercisebook.authoring import number, numbers, poles
from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG, judge
from judged import assert_judged
from plainmath.expressions import s

X = sympy.Symbol("x")
PERIOD = number(120, "s", "the period")
SHARE = number(0.25, "", "the share")
ANGLE = number(math.pi / 3, "rad", "the angle")
P = poles([-1 + 2j, -1 - 2j, -3])
A = numbers([[0, 1], [-2, -3]], what="the matrix")
MINUS = number(-2, "K/%", "the slope")
ROOM = number(20, "°C", "the temperature")
DIFFERENCE = number(10, "K", "the rise")
TILES = number(4, "", "the number of whole tiles")
FOUR = number(4, "min")
PAIR, DOUBLE, TWO = poles([-1 + 2j, -1 - 2j]), poles([-2, -2]), poles([-1, -4])
PINT = pint.UnitRegistry(cache_folder=None)

#: Of each kind the ways to write its answer, between bars.
WRITTEN = [
    # as people write numbers and units
    (
        PERIOD,
        "120 s | 120 | 240/2 | 2min | 120\N{NO-BREAK SPACE}s | 120\N{THIN SPACE}s | T = 120 s | = 120 | 1/30 h"
        " | 2*60 s | 2 · 60 s | 1.2·10² | 1.2×10^2 s | 1,2e2 s | 120 seconds | 120 sec. | 120 secs | 2 Minutes"
        " | ca. 120 s | ~120 s | about 2 min | 120 s. | T_1 ≈ 120 s | T_1: 120 s | 2 min 0 s | 1 min and 60 s"
        " | 240/2 = 120 | 120 s = 2 min | 120,0 s | +120 | 120 s approx. | 0,0333333 h | 120s | 120 sec | 2.0 mins"
        " | ≈ 120 | 240/2 s | 1.2x10^2 | 1,2·10² s | 1 min 60 s",
    ),
    (number(90, "s"), "1 1/2 min | 1,5 min | 1½ min | 3/2 min | 1 min 30 s"),
    (number(1200, "kg"), "1 200 kg | 1.2 t | 1200kg | 1'200 kg | 1,200.0 kg | 1.200,0 kg | 1.2·10^3 kg"),
    (SHARE, "25 % | 25% | 1/4 | 25 percent | 25 per cent | 25 pct | 0,25 | .25 | 25 % of the range | 2.5·10^-1"),
    (ANGLE, "60 deg | 60° | 60 Degrees | 60 degree | π/3 | pi/3 | π/3 rad | 1,0472 rad"),
    (
        ROOM,
        "20 °C | 20 ℃ | 20 C | 20 deg C | 20 degC | 20 degrees Celsius | 20 C° | 20 degrees C | 20 celsius | 20,0 °C",
    ),
    (DIFFERENCE, "10 K"),
    (MINUS, "−2 K/% | - 2 K/%"),
    (number(2, "%/K"), "2 percent/K | 2 % per K | 2 percent per kelvin | 2 %/°C | 2%/K"),
    (number(0.5, "m³/s"), "0.5 m3/s | 0.5 m^3/s | 0.5 m**3/s | 0.5 m³ s⁻¹ | 0.5 m³·s⁻¹ | 0.5 m^3 s-1"),
    (number(3, "rad/s"), "3 rad/sec | 3/s | 3 1/s | 0.47746 Hz | 28.648 rpm | 3*pi/pi rad/s"),
    (number(12, "kg/min"), "12 kg per minute | 12 kg per min | 0.2 kg/s | 12kg/min | 12 Kg/min"),
    (number(5, "N m"), "5 Nm | 5 N m | 5 N*m | 5 N·m | 0.005 kNm"),
    (number(0), "zero | Zero | 0 | 0,0 | 0 % | none"),
    # numbers with units, worked out
    (number(1.5, "K/%"), "15 K / 10 % | 15 K/(10 %) | (45 K - 30 K)/(10 %) | 1,5e1 K / 10 % | 15 °C / 10 %"),
    (number(-0.75, "bar"), "8 bar - 8,75 bar | 8 bar - 875 kPa | 8 - 8.75 bar"),
    (number(58, "°C"), "60 °C - 2 K | 60 °C - 2 °C"),
    (number(35, "deg"), "90° - 55° = 35° | 180° - 145°"),
    (FOUR, "10 K / (2,5 K/min) | 14 L / 3,5 L/min | 2 min * 2 | 1/4 h - 11 min | 2 min + 120 s"),
    # what stands around a number
    (FOUR, "t_b - t_a = 4 min | > 4 min | at least 4 min | >= 240 s | after 4 min | it is 4 min | at 4 min"),
    (number(1.25), "factor 1,25 | a factor of 1.25 | 1.25 times | 1,25 times larger | by a factor of 5/4"),
    (TILES, "4 tiles | tile 4 | four tiles | 4 full tiles | 4 (whole tiles) | No. 4"),
    (number(41, "", "the number of the room"), "TC41 | room 41 | no. 41 | 41 (upstairs) | #41 | TC-41"),
    # rows and tables
    (
        A,
        "[[0, 1], [-2, -3]] | [0, 1; -2, -3] | [0 1; -2 -3] | [[0 1], [-2 -3]] | 0, 1; -2, -3 | [[0; 1]; [-2; -3]]"
        " | ((0, 1), (-2, -3))",
    ),
    (numbers([[0.5, -3], [4, 0]]), "[1/2 -3; 4 0] | [[0.5, -3], [4, 0]] | 1/2, -3; 4, 0"),
    (numbers([0.4, 0]), "[0,4; 0] | 0,4; 0 | 0.4, 0 | [0.4 0] | 0.4 and 0 | b1 = 0.4, b2 = 0 | (0.4, 0)"),
    (numbers([1.5, 3]), "1 1/2; 3"),  # a mixed fraction is no row
    (numbers([14, 10], "s"), "14 s, 10 s"),
    # poles
    (P, "-3, -1+2j, -1-2j | [-3, -1 + 2i, -1 - 2i]"),
    (
        PAIR,
        "-1 ± 2j | -1 +- 2i | -1 ± j2 | -1 +/- 2j | −1 ± 2i | s = -1 ± 2j | s_1,2 = -1 ± 2j | s1,2 = -1±2i"
        r" | -1 ± 2j rad/s | -1 \pm 2j | -1+2j and -1-2j | -1+2j; -1-2j | s1 = -1 + 2j, s2 = -1 - 2j"
        " | {-1+2i, -1-2i} | (-1+2j, -1-2j) | -1+j2, -1-j2 | -1 + 2*1j, -1 - 2*1j | -1,0 ± 2,0j"
        " | -1,0+2,0j; -1,0-2,0j | -1 ± j*sqrt(4) | -1 ± i√4 | -1 ± sqrt(-4) | -1±j·2",
    ),
    (poles([-0.5 + 1.3j, -0.5 - 1.3j]), "-0.5±j1.3 | -0,5 ± 1,3i | -1/2 ± 1.3j | -.5 ± 1.3j"),
    (poles([2j, -2j]), "±2j | +-j2 | ± 2i | 2j and -2j | j2, -j2 | 0 ± 2j"),
    (
        DOUBLE,
        "-2, -2 | -2 (double) | -2 double | double pole at -2 | a double pole at -2 | -2, twice | -2 (2x)"
        " | -2 and -2 | -2 (multiplicity 2)",
    ),
    (
        poles([-1, -1, -2]),
        "-1 (double), -2 | -1 (double) and -2 | -2; -1 (twice) | -2, -1, -1"
        " | s_{1,2} = -1, s_3 = -2 | s1 = s2 = -1, s3 = -2",
    ),
    (poles([-2, -4]), "s_1,2 = -3 ± 1 | s = -2 or s = -4 | s_1 = -2,\\ s_2 = -4 | [-2. -4.] | -2\n-4"),
    (TWO, "-1,-4 | -1 and -4 | s = -1 and s = -4 | s1=-1; s2=-4 | {-4, -1} | -1; -4"),
    (poles([]), "none | no zeros | There are no finite zeros. | []"),
]
#: Of each kind its answer as programs give it, and as lists.
GIVEN = [
    # as programs give numbers
    (
        PERIOD,
        [
            119.2,
            120 + 1e-15j,
            np.array(120),
            np.float32(120),
            np.int8(120),
            np.array("120"),
            np.array([[120]]),
            [120],
            Fraction(120),
            Decimal(120),
            mpmath.mpf(120),
            {120},
            {"a": 120}.values(),
            sympy.Integer(120),
            sympy.Eq(X, 120),
            {X: 120},
            [{X: 120}],
            sympy.FiniteSet(120),
            iter([120]),
        ],
    ),
    (SHARE, [PINT.Quantity(25, "percent")]),
    (DIFFERENCE, [PINT.Quantity(10, "delta_degC")]),
    (A, [[[0, 1], [-2, -3]], sympy.Matrix([[0, 1], [-2, -3]])]),
    (numbers([14, 10], "s"), [{"A": "14 s", "B": "10 s"}, range(14, 9, -4)]),
    (numbers([[0, 1], [-500, -3]]), [[[1e-10, 1], [-500, -3]]]),
    (
        P,
        [
            [-3, -1 - 2j, -1 + 2j],
            {-3: 1, -1 - 2j: 1, -1 + 2j: 1},
            np.roots(np.poly([-3, -1 - 2j, -1 + 2j])),
            ["-3", "-1 + 2j", "-1 - 2*I"],
            ["-3.0", "-1 + 2.0i", "-1 - 2i"],
            [[-3, -1 + 2j, -1 - 2j]],
            iter([-3, -1 + 2j, -1 - 2j]),
            [{s: -3}, {s: -1 + 2j}, sympy.Eq(s, -1 - 2j)],
            PINT.Quantity(np.array([-3, -1 + 2j, -1 - 2j]), "rad/s"),
        ],
    ),
    (PAIR, [["-1 ± 2j"], ["-1+2j", "-1+-2j"], ["-1 + j2", "-1 - j2"]]),
    # what is nearly right beside something large
    (poles([0, -1000, -1]), [[1e-7, -1000, -1]]),
    (poles([0, 0]), [[0, 1e-9]]),
    (poles([2j, -2j]), [[1e-15 + 2.01j, 1e-15 - 2.01j]]),
    (poles([-0.006 + 2j, -0.006 - 2j]), [[-0.0062 + 2.01j, -0.0062 - 2.01j]]),
    (number(0, "m", "the offset"), [0.005]),
]

JUDGED = [
    (PERIOD, "2 min", RIGHT, "converted from min"),
    (PERIOD, 118, WRONG, "off by a few percent, which is more than the rounding"),
    (PERIOD, 2, MISTAKE, "the value in min"),
    (PERIOD, 77, WRONG, "not right, though of about the right size; asked: the period, in s"),
    (PERIOD, "120,5", RIGHT, "read as 120.5"),
    (PERIOD, "two minutes", RIGHT, "read as 2 minutes, converted from minutes"),
    (PERIOD, PINT.Quantity(2, "min"), RIGHT, "converted from min"),
    (PERIOD, ..., OPEN, "not answered yet"),
    (PERIOD, None, OPEN, "not answered yet"),
    *(
        (PERIOD, given, UNJUDGED, says)
        for given, says in (
            ("2 kg", "not a unit of the same quantity"),
            (PINT.Quantity(2, "kg"), "not a unit of the same quantity"),
            ("2 minutes per second", "not a unit of the same quantity"),
            ("some minutes", "a number, in s"),
            (math.nan, "NaN"),
            (math.inf, "infinite"),
            (3j, "complex"),
            (120 + 0.01j, "complex"),
            ([1, 2], "there are 2 values"),
            (sympy.Symbol("T"), "there is still T"),
            (True, "truth value"),
            (np.ma.masked, "missing"),
            ("10 dozen s", "is not a number"),
            ("1 m^9^9^9", "a power that is no number"),
            ("1" * 5000, "5000 characters"),
            ("1,200", "1,200 may be 1.200 or 1200"),
            ("100 = 120 s", "two sides that differ"),
        )
    ),
    *(
        (PERIOD, text, UNJUDGED, "")
        for text in ("120 s 3", "1 2 0", "120 s or 130 s", "120 m", "12 0 s", "between 100 and 140")
    ),
    (PERIOD, "120 ± 5", RIGHT, "read as 120"),
    (PERIOD, "120 s (2 min)", RIGHT, "right"),
    (PERIOD, "120 s (3 min)", UNJUDGED, "two sides that differ"),
    (PERIOD, "T > 120 s", RIGHT, "read as 120 s"),
    (PERIOD, "plus 1 20/(2)", UNJUDGED, "a sign is missing"),
    (number(-1.2, "1/s"), "minus 1.2 1/s", RIGHT, "right"),
    (number(5.2, "bar"), "5.2 bar(g)", RIGHT, "right"),
    (numbers([1000, 0]), [1000, 9], WRONG, "1 of 2"),
    (SHARE, 25, MISTAKE, "in percent"),
    (ANGLE, 60, MISTAKE, "in deg"),
    (DIFFERENCE, "10 °C", UNJUDGED, "a temperature or a difference"),
    (DIFFERENCE, "10 degC", UNJUDGED, "a temperature or a difference"),
    (TILES, "4 tiles", RIGHT, "read as 4"),
    (TILES, "4 dozen", UNJUDGED, "is not a number"),
    (number(41), "TC41", UNJUDGED, "not a number"),
    (number(1.25), "1.25 times smaller", UNJUDGED, "not a number"),
    (number(1.7, "", "the ratio"), "4.609 dB", RIGHT, "converted from dB"),
    (number(1120, "N", "the force"), 1.12, MISTAKE, "in kN"),
    (number(12, "", "the number of batches", within=0), 13, WRONG, "not right"),
    (number(2, "%/K", "the slope"), 0.02, MISTAKE, "in 1/K"),
    (number(2, "K/%", "the slope"), 200, MISTAKE, "in K"),
    (number(0, "m", "the offset"), 0.02, WRONG, "not right"),
    # a single comma is a decimal one, and where zeros are at its end it is asked
    (number(1.364, "K/%"), "1,364 K/%", RIGHT, "right, read as 1.364 K/%"),
    (number(12375), "12,375", MISTAKE, "factor of 1000"),
    (number(99), "12,375", WRONG, "· read as 12.375"),
    # numbers with units, worked out
    (number(1.5, "K/%"), "15 K / 10 %", RIGHT, "right, read as 1.5"),
    (FOUR, "15 K / 11 %", UNJUDGED, "not a unit of the same quantity as min"),
    (FOUR, "8 min - 4", UNJUDGED, "a number without unit is not a unit of the same quantity"),
    *((FOUR, text, UNJUDGED, "") for text in ("2 min ** 2", f"{'(' * 1200}1 s{')' * 1200}", "1e300 min * 1e300")),
    # rows and tables
    (A, [[0, -2], [1, -3]], MISTAKE, "rows and columns"),
    (A, [0, 1, -2, -3], UNJUDGED, "expected 2 by 2"),
    (A, [[0, 1], [-2, 3]], MISTAKE, "3 of 4 numbers are right; row 2, column 2: the size is right, the sign is not"),
    (A, 5, UNJUDGED, "such as [[1, 2], [3, 4]]"),
    (numbers([14, 10], "s"), "14,0; 10,0", RIGHT, "right, read as [14, 10]"),
    (numbers([[0, 1], [-500, -3]]), [[4, 1], [-500, -3]], WRONG, "3 of 4"),
    # poles
    (P, [3, 1 - 2j, 1 + 2j], MISTAKE, "signs"),
    (P, [-3, -1 + 2j], MISTAKE, "a complex value never comes alone"),
    (P, [-3, -1 + 2j, -7], WRONG, "2 of 3"),
    (P, [-3.06, -1 - 2j, -1 + 2j], MISTAKE, "2 of 3 are right; one is off by a few percent"),
    (P, "none", WRONG, "the list is empty"),
    (P, {-3: 30}, UNJUDGED, "cannot occur 30 times"),
    (P, "", UNJUDGED, "is not a number"),
    (poles([-1 + 2.5j, -1 - 2.5j]), "-1 ± 2,5j", RIGHT, "right, read as -1 + 2.5j, -1 - 2.5j"),
    (poles([-2.5]), "-2,5", RIGHT, "read as -2.5"),
    (DOUBLE, "-2 (triple)", WRONG, "also more"),
    (poles([-1, -5]), "-1,5", WRONG, "none of these is right, and there should be more"),
    (poles([0, -1000, -1]), [-0.5, -1000, -1], MISTAKE, "2 of 3 are right; one should be exactly zero"),
    (poles([0, -100]), [0.9, -100], MISTAKE, "one should be exactly zero"),
    (poles([0, 0]), [0, 0.005], MISTAKE, "exactly zero"),
    (poles([-0.006 + 2j, -0.006 - 2j]), [2j, -2j], MISTAKE, "on the wrong side of the imaginary axis, or beside it"),
    (poles([-0.006 + 2j, -0.006 - 2j]), [0.01 + 2j, 0.01 - 2j], MISTAKE, "on the wrong side"),
    (
        poles([-0.001 + 1j, -0.001 - 1j]),
        [-0.005 + 1j, -0.005 - 1j],
        MISTAKE,
        "the real part, which damps",
    ),
]


def test_judging(subtests):
    given_as = [*((kind, ways.split(" | ")) for kind, ways in WRITTEN), *GIVEN]
    rightly = [(kind, given, RIGHT, "right") for kind, answers in given_as for given in answers]
    for kind, given, status, says in rightly + JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)


def test_the_mistakes_of_an_exercise_come_before_the_general_ones():
    assert judge("x", PERIOD, 2, [("Look again.", 2)]).says == "Look again."
