"""Formulas in two dimensions: LaTeX of the syntax tree that `grammar.read` returns, as it was typed."""

from __future__ import annotations

import ast
import re

import sympy

#: How tightly a part of a formula holds together; one that does so less tightly than its place needs has brackets.
_SUM, _NEGATIVE, _QUOTIENT, _PRODUCT, _POWER, _WHOLE = range(6)
_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Lt: r"\lt", ast.LtE: r"\le", ast.Gt: r"\gt", ast.GtE: r"\ge",
          ast.BitAnd: r"\text{ and }", ast.BitOr: r"\text{ or }"}  # fmt: skip
#: Functions that are not printed as they are called; a logarithm without a base is the natural one here.
_CALLS = {"exp": "e^{%s}", "sqrt": r"\sqrt{%s}", "abs": r"\left|%s\right|", "Abs": r"\left|%s\right|"}
_NAMES = {"log": r"\ln", "log10": r"\log_{10}", "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan",
          "Min": r"\min", "Max": r"\max", "sign": r"\operatorname{sgn}", "re": r"\operatorname{Re}",
          "im": r"\operatorname{Im}", "Heaviside": r"\operatorname{step}"}  # fmt: skip


def latex(tree: ast.expr) -> str:
    """Return a formula in LaTeX: fractions as fractions, no sign of a product where none is needed; "" of no formula.

    >>> latex(ast.parse("2*T_i*exp(-t/3)/(4*s + 1)", mode="eval").body)
    '\\\\frac{2 T_{i} e^{-t/3}}{4 s + 1}'
    """
    try:
        return _written(tree)[0]
    except (RecursionError, ValueError):
        return ""


def symbol(name: str) -> str:
    """Return a symbol in LaTeX; a word is upright, as its letters would be a product otherwise.

    >>> symbol("tau_1"), symbol("Kp")
    ('\\\\tau_{1}', '\\\\mathrm{Kp}')
    """
    return re.sub(r"^[A-Za-z]{2,}", r"\\mathrm{\g<0>}", sympy.latex(sympy.Symbol(name)))


def _written(node, in_line=False):
    """A part and how tightly it holds together; in an exponent a fraction is in the line."""
    match node:
        case ast.Constant(bool()):
            return r"\text{otherwise}", _WHOLE
        case ast.Constant(value):
            return _number(value)
        case ast.Name(name):
            return symbol(name), _WHOLE
        case ast.UnaryOp(sign, part):
            text, holds = _written(part, in_line)
            return (text, holds) if isinstance(sign, ast.UAdd) else _negative(text, holds)
        case ast.BinOp(left, ast.Mult() | ast.Div() as sign, right):
            text, holds = _written(left, in_line)
            if holds != _NEGATIVE:
                return _joined(text, holds, sign, right, in_line)
            return _negative(*_joined(text[1:], _PRODUCT, sign, right, in_line))  # a minus is that of the whole product
        case ast.BinOp(left, ast.Pow(), right):
            return f"{_within(*_written(left, in_line), _WHOLE)}^{{{_written(right, in_line=True)[0]}}}", _POWER
        case ast.BinOp(left, sign, right) | ast.Compare(left, [sign], [right]):
            second = _within(*_written(right, in_line), _QUOTIENT)
            return f"{_written(left, in_line)[0]} {_SIGNS[type(sign)]} {second}", _SUM
        case ast.Call(ast.Name("Piecewise"), pieces):
            rows = (" & ".join(_written(part, in_line)[0] for part in piece.elts) for piece in pieces)
            return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}", _SUM
        case ast.Call(ast.Name(name), parts):
            inside = ", ".join(_written(part, in_line or name == "exp")[0] for part in parts)
            return _CALLS.get(name, _NAMES.get(name, f"\\{name}") + r"\left(%s\right)") % inside, _POWER
    raise ValueError(f"{type(node).__name__} is no part of a formula")


def _within(text, holds, least):
    return text if holds >= least else rf"\left({text}\right)"


def _negative(text, holds):
    """A minus before a part; that of a fraction in the line would be taken for one of its numerator alone."""
    return f"-{_within(text, holds, _QUOTIENT)}", _SUM if holds == _QUOTIENT else _NEGATIVE


def _joined(first, holds, sign, right, in_line):
    """A product or a fraction; a product has a dot where digits would run together, or where there are words."""
    second, tight = _written(right, in_line)
    if isinstance(sign, ast.Div) and not in_line:
        return rf"\frac{{{first}}}{{{second}}}", _PRODUCT
    first = _within(first, holds, _PRODUCT)
    if isinstance(sign, ast.Div):
        return f"{first}/{_within(second, tight, _POWER)}", _QUOTIENT
    second = _within(second, tight, _PRODUCT)
    runs_on = second[0].isdigit() or (first[-1].isdigit() and second.startswith(r"\frac"))
    return first + (r" \cdot " if runs_on or r"\mathrm" in first + second else " ") + second, _PRODUCT


def _number(value):
    """A number as it is typed, but for a power of ten."""
    if isinstance(value, complex):
        return f"{_number(value.imag)[0]} j", _PRODUCT
    digits, _, exponent = repr(value).removesuffix(".0").partition("e")
    if not exponent:
        return digits, _WHOLE
    power = f"10^{{{int(exponent)}}}"
    return (power, _POWER) if digits == "1" else (rf"{digits} \cdot {power}", _PRODUCT)
