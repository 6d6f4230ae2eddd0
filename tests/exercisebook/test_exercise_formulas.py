"""Formulas in an answer: read without running them, evaluated at points, and compared there."""

import math
import types

import control
import numpy as np
import pytest
import scipy.signal
import sympy
import sympy.physics.control

from exercisebook.agreement import agree
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable
from exercisebook.points import points_for
from plainmath.expressions import s

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
        ("1/2s", "set brackets, or a *"),
        ("s(s", "ends too early"),
        ("K/(T*s + 1)", "'K' is not a symbol of this answer"),
        ("S", "did you mean 's'?"),
        ("exb(s)", "did you mean 'exp'?"),
        ("", "empty"),
        ("(", "ends too early"),
        ("0,5,5*s", "a decimal point"),
        (sympy.Symbol("s") ^ sympy.Symbol("t"), "in Python ^ is no power"),
        ("s" * 5000, "characters"),
        ("+".join(["s"] * 1900), "very long"),
        ("-" * 3000 + "s", "expected"),
        ("(" * 3000, "expected"),
        ("9" * 500, "out of range"),
        ("1e999*s", "out of range"),
        ("__import__('os').system('true')", "cannot be read"),
        ("().__class__", "cannot be read"),
        ("[s for s in (1,)]", "expected an expression"),
        ("lambda: s", "cannot be read"),
        ("s if s else s", "cannot be read"),
        ("s := 2", "cannot be read"),
        ("f'{s}'", "cannot be read"),
        ("exp(s, s)", "2 arguments"),
        ("exp(x=s)", "cannot be read from '=s)' on"),
        ("Heaviside()", "no arguments"),
        ("'s'", "cannot be read"),
        ("True", "is not a symbol"),
        (None, "neither"),
        (..., "neither"),
        ("1 < s < 3", "compares"),
        ("Piecewise(s)", "pairs of a value and a condition"),
        ("Piecewise((1, s, 2))", "pairs of a value and a condition"),
        ("exp(*s)", "cannot be read"),
        (True, "truth value"),
        (object(), "neither an expression"),
        ([s], "neither an expression"),
        (sympy.Matrix([s]), "neither an expression"),
        (control.tf([3], [5, 1], 0.1), "neither an expression"),
        (control.tf([[[3], [1]]], [[[5, 1], [5, 1]]]), "neither an expression"),
        (sympy.Function("f")(s), "'f' is not a known function"),
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
    assert not agree(key, Formula(text, "s"), points_for(key), 0.01)


def test_a_piece_counts_only_where_it_holds():
    piecewise = Formula("Piecewise((exp(1000*t), t < 0.1), (Min(t, 2), True))", "t")
    assert piecewise(t=np.array([0.001, 1.0, 5.0])) == pytest.approx([math.e, 1, 2])
    assert Formula("max(t, 2, 3)", "t")(t=np.array([1.0, 5.0])) == pytest.approx([3, 5])


LAG = 3 / (5 * s + 1)


@pytest.mark.parametrize(
    ("system", "expr"),
    [
        (control.tf([3], [5, 1]), LAG),
        (control.ss([[-0.2]], [[1]], [[0.6]], [[0]]), LAG),
        (control.ss(control.tf([7 / 3**5], np.poly([-1 / 3] * 5))), 7 / (3 * s + 1) ** 5),
        (scipy.signal.StateSpace([[-0.2]], [[1]], [[0.6]], [[0]]), LAG),
        (scipy.signal.ZerosPolesGain([], [-0.2], 0.6), LAG),
        (scipy.signal.TransferFunction([3], [5, 1]), LAG),
        (sympy.physics.control.TransferFunction(3, 5 * s + 1, s), LAG),
        (types.SimpleNamespace(expr=LAG), LAG),
    ],
)
def test_a_linear_system_is_a_formula(system, expr):
    key = Formula(expr, "s")
    assert agree(key, Formula(system, "s"), points_for(key), 0.01)


def test_a_long_chain_of_functions_is_no_formula():
    for text in ("lambda:" * 400 + "s", "s if " * 500 + "s", "not " * 500 + "s"):
        with pytest.raises(Unreadable):
            Formula(text, "s")
