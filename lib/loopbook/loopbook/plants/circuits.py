"""Electrical circuits: components, resistors together, and a lowpass filter."""

from __future__ import annotations

import sympy

from loopbook.plants.declarations import Balance, parameter, signal
from loopbook.plants.plant import Plant
from loopbook.types import Number
from plainmath.expressions import exact, t

__all__ = ["RCCircuit", "capacitor", "inductor", "resistor", "resistors_in_parallel", "resistors_in_series"]


def resistor(v: sympy.Expr, i: sympy.Expr, R: Number) -> sympy.Equality:
    """Ohm's law for a resistor of R [ohm]: voltage v [V], current i [A]. (Haugen, equation 3.38)

    >>> from loopbook.plants import signals
    >>> v, i = signals("v i")
    >>> resistor(v, i, 100)
    Eq(v(t), 100*i(t))
    """
    return sympy.Eq(v, exact(R) * i)


def capacitor(v: sympy.Expr, i: sympy.Expr, C: Number) -> sympy.Equality:
    """The current into a capacitor of C [F] changes its voltage. (Haugen, equation 3.39)

    >>> from loopbook.plants import signals
    >>> v, i = signals("v i")
    >>> capacitor(v, i, sympy.Symbol("C"))
    Eq(i(t), C*Derivative(v(t), t))
    """
    return sympy.Eq(i, exact(C) * sympy.diff(v, t))


def inductor(v: sympy.Expr, i: sympy.Expr, L: Number) -> sympy.Equality:
    """The voltage over an inductor of L [H] changes its current. (Haugen, equation 3.40)

    >>> from loopbook.plants import signals
    >>> v, i = signals("v i")
    >>> inductor(v, i, sympy.Symbol("L"))
    Eq(v(t), L*Derivative(i(t), t))
    """
    return sympy.Eq(v, exact(L) * sympy.diff(i, t))


def resistors_in_series(*resistances: Number) -> sympy.Expr:
    """The resistance of resistors in series: their sum. (Haugen, equation 3.36)

    >>> resistors_in_series(100, 300)
    400
    """
    return sympy.Add(*map(exact, resistances))


def resistors_in_parallel(*resistances: Number) -> sympy.Expr:
    """The resistance of resistors in parallel: their conductances add up. (Haugen, equation 3.37)

    >>> resistors_in_parallel(100, 300)
    75
    """
    return sympy.factor(1 / sympy.Add(*(1 / exact(R) for R in resistances)))


class RCCircuit(Plant):
    """A resistor and a capacitor as a lowpass filter. (Haugen, Example 3.5, equation 3.46)

    The book prints no values; these are ours.
    """

    R = parameter(1000, "ohm", "resistance")
    C = parameter(0.001, "F", "capacitance")
    v_in = signal(0, "V", "input voltage")
    v_out = signal(0, "V", "output voltage")

    charge = Balance(C * v_out, (v_in - v_out) / R)
    output, manipulated = v_out, v_in
    at_work = {v_in: 5, v_out: 5}
