"""Transfer functions."""

from __future__ import annotations

import ast
import collections
import functools
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import mpmath
import sympy

from exercisebook.kinds.formula import Expression, in_other_time
from plainmath.expressions import parse, s

if TYPE_CHECKING:
    from loopbook.types import Number


#: A pole is on the imaginary axis where its real part is below this fraction of the other one.
ON_AXIS = 1e-12
#: The longest dead time is so many times the unit of all of them, at most.
MOST_SHORTEST = 200
#: A coefficient that is smaller than this part of the largest one is none.
TRACE = 1e-30


class TransferFunction(Expression):
    """A transfer function in s, with or without symbols; dead time is exact.

    >>> H = TransferFunction(2 * sympy.exp(-3 * s) / (10 * s + 1))
    >>> H.agrees(H.read("0.2*exp(-3*s)/(s + 0.1)")[0])
    True
    """

    always = frozenset({"s"})

    def __init__(
        self,
        key: Number | str,
        what: str = "the transfer function",
        symbols: str = "",
        within: float = 0.01,
        unit: str = "",
    ):
        super().__init__(key, what, symbols, within, unit)

    def agrees(self, answer: Any) -> bool:
        """Whether both have the same values, are as proper, and have as many poles on each side of the imaginary axis.

        A small term that is unstable, or improper, changes no value by much, but it is another system.
        """
        if not super().agrees(answer):
            return False
        own, other = (_structure(ast.unparse(one.tree)) for one in (self.key, answer))
        return own is None or other is None or own == other

    def mistakes(self) -> Iterator[tuple[str, Any]]:
        """Those of an expression, a forgotten dead time, its sign, and an s too many or too few."""
        yield from super().mistakes()
        if self.expr.has(sympy.exp):
            if without := self.expr.replace(sympy.exp, lambda _: sympy.S.One):
                yield "the dead time is missing", without
            yield (
                "the sign in the exponent of the dead time is wrong: a delay is exp of something negative times s",
                self.expr.replace(sympy.exp, lambda x: sympy.exp(-x)),
            )
            for order in (1, 2):
                yield (
                    "that is a Pade approximation of the dead time; the exact one is asked for",
                    self.expr.replace(sympy.exp, lambda x, n=order: _pade(x, n)),
                )
        yield "there is a factor s too many: compare with the transform of a response to a step", self.expr * s
        yield "a factor s is missing in it, or it is the transform of a step response", self.expr / s
        yield from in_other_time(self, "s")


def _pade(x, order):
    if order == 1:
        return (1 + x / 2) / (1 - x / 2)
    return (1 + x / 2 + x**2 / 12) / (1 - x / 2 + x**2 / 12)


@functools.lru_cache(maxsize=200)
def _structure(text):
    """By how much it is proper, and how many poles are left of the imaginary axis, on it, right of it, and zero.

    Empty for what is no rational function with dead times above; None with other symbols than s, and for what SymPy
    cannot work out.
    """
    try:
        expr = parse(text)
        if expr.free_symbols - {s}:
            return None
        exps = {one: one.args[0].coeff(s) for one in expr.atoms(sympy.exp)}
        shortest, delay = functools.reduce(sympy.gcd, exps.values(), sympy.Integer(0)), sympy.Dummy()
        if any(one.args[0] != many * s for one, many in exps.items()):
            return ()
        if any(abs(many / shortest) > MOST_SHORTEST for many in exps.values()):
            return None
        powers = {one: delay ** (-many / shortest) for one, many in exps.items()}  # a dead time has no pole
        above, below = sympy.fraction(sympy.cancel(sympy.together(expr.xreplace(powers))))
        below = sympy.cancel(below / delay ** sympy.Poly(below, delay).monoms()[-1][0])  # above it stands as well
        if delay in below.free_symbols or not (below.is_polynomial(s) and above.is_polynomial(s, delay)):
            return ()
        above, below = (_without_traces(sympy.Poly(one, s)) for one in (above.subs(delay, sympy.Rational(2, 3)), below))
        sides = collections.Counter()
        for factor, times in below.sqf_list()[1]:
            for pole in factor.nroots(n=20, maxsteps=200):
                sides[0 if pole == 0 else 2 + _side(pole)] += times
        return above.degree() - below.degree(), sorted(sides.items())
    except (ValueError, ArithmeticError, sympy.PolynomialError, NotImplementedError, mpmath.libmp.NoConvergence):
        return None


def _without_traces(polynomial):
    """A polynomial without coefficients that are nothing beside the others in decimal numbers."""
    largest = max(map(abs, polynomial.all_coeffs()))
    found = {powers: one for powers, one in polynomial.terms() if abs(one) > TRACE * largest}
    return sympy.Poly(found, s) if found else polynomial


def _side(pole):
    real, imaginary = pole.as_real_imag()
    return 0 if abs(real) <= ON_AXIS * abs(imaginary) else int(sympy.sign(real))
