"""Values compared by another route than `evidence.values`: numbers by decimal arithmetic, formulas at random points.

A formula is evaluated with an elementary function in place of every unknown one, and nothing is proved.
"""

from __future__ import annotations

import ast
import functools
import math
import operator
import random
import re
from decimal import Context, Decimal, localcontext

import mpmath
import sympy
from sympy.integrals.manualintegrate import manualintegrate

_KNOWN = [
    "exp", "log", "sqrt", "Abs", "sign", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "re", "im", "Min", "Max", "factorial", "gamma", "Heaviside", "Derivative", "Integral", "Subs",
]  # fmt: skip
_CALLS = re.compile(r"(\w+)\s*\(")
_OPERATIONS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def same_number(value: str, told: str) -> bool:
    """Return whether a number lies within half a unit of the last digit of another."""
    if "oo" in (value, told):
        return value == told
    mantissa, _, exponent = told.lower().partition("e")
    half = Decimal(5).scaleb(int(exponent or 0) - len(mantissa.partition(".")[2]) - 1)
    return apart(value, told) <= half


def apart(value: str, printed: str) -> Decimal:
    """Return how far two numbers are apart."""
    with localcontext(Context(prec=200)):
        return abs(Decimal(value) - Decimal(printed))


def read(text: str, draw: int) -> sympy.Expr:
    """Return an expression with an elementary function in place of each unknown one: in every draw another."""
    return _evaluated(
        text, draw if any(name not in _KNOWN or name == "Integral" for name in _CALLS.findall(text)) else 0
    )


@functools.cache
def _evaluated(text, draw):
    def coefficients(name, number):
        dice = random.Random(f"{name} {draw}")
        return [sympy.Rational(dice.randint(1, 999), 500) for _ in range(number)]

    def of(node):
        match node:
            case ast.Constant(int() | float()):
                return sympy.Rational(ast.get_source_segment(text, node))
            case ast.Name("pi" | "oo" | "I" as name):
                return getattr(sympy, name)
            case ast.Name(name):
                return sympy.Symbol(name, positive=True) if name != "s" else sympy.Symbol("s")
            case ast.BinOp(left, operation, right):
                return _OPERATIONS[type(operation)](of(left), of(right))
            case ast.UnaryOp(ast.USub(), operand):
                return -of(operand)
            case ast.UnaryOp(ast.UAdd(), operand):
                return of(operand)
            case ast.Tuple(parts):
                return sympy.Tuple(*map(of, parts))
            case ast.Call(ast.Name("Integral"), [integrand, ast.Tuple([variable, *limits])]) if "oo" in ast.unparse(
                node
            ):
                # of a signal that is not known: the integrand somewhere, and which limits are infinite
                endless = [n for n, limit in enumerate(limits, start=2) if of(limit).is_infinite]
                return math.prod(endless) * of(integrand).subs(of(variable), sympy.Rational(draw + 1, 7))
            case ast.Call(ast.Name("Integral"), [integrand, ast.Tuple([variable, low, high])]):
                # term by term, and by rules, because the general method takes seconds for a sum of exponentials
                whole = manualintegrate(sympy.expand(of(integrand).doit()), of(variable))
                return whole.subs(of(variable), of(high)) - whole.subs(of(variable), of(low))
            case ast.Call(ast.Name(name), arguments) if name in _KNOWN:
                return getattr(sympy, name)(*map(of, arguments))
            case ast.Call(ast.Name(name), arguments):
                start, height, *rates = coefficients(name, 2 + len(arguments))
                exponent = sum(rate * of(argument) for rate, argument in zip(rates, arguments, strict=True))
                return start + height * sympy.exp(-exponent)
        raise ValueError(f"cannot read {text!r}")

    return of(ast.parse(text, mode="eval").body).doit()


@functools.cache
def same_formula(one: str, other: str, points: int) -> bool:
    """Return whether two formulas, or two equations, agree to 35 digits at so many random points."""
    if ("=" in one) != ("=" in other):
        return False
    alike, opposite = [], []
    for draw in range(4 * points):
        sides = []
        for text in (one, other):
            left, _, right = (part.strip() for part in text.partition("="))
            sides.append(read(left, draw) - (read(right, draw) if right else 0))
        if "oo" in (one, other):
            return sides[0] == sides[1]
        dice = random.Random(draw)
        point = {}
        for letter in sorted(sides[0].free_symbols | sides[1].free_symbols, key=str):
            point[letter] = sympy.Rational(dice.randint(1, 10**6), 10 ** dice.randint(3, 8))
            if letter.name == "s":
                point[letter] = point[letter] * sympy.I + dice.randint(-3, 3)
        values = [side.evalf(60, subs=point) for side in sides]
        if all(value.is_number and value.is_finite for value in values):
            with mpmath.workdps(60):
                a, b = (mpmath.mpc(*value.as_real_imag()) for value in values)
                limit = mpmath.mpf("1e-35") * (mpmath.mpf("1e-20") + abs(a) + abs(b))
                alike.append(abs(a - b) <= limit)
                # an equation may have its sides exchanged
                opposite.append("=" in one and abs(a + b) <= limit)
        if len(alike) == points:
            return all(alike) or all(opposite)
    return False
