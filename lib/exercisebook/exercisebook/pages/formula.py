"""Formulas of a page as text: what they may say, and what they are for given values.

The grammar is that of Python's expressions, as far as an author needs it: arithmetic, comparisons, ``a if b else c``,
texts, lists, and calls of functions that are known by name. It is read by `ast` and worked out here; nothing of it ever
runs as Python.
"""

from __future__ import annotations

import ast
import contextlib
import math
import operator
import pkgutil
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy

from plainmath.expressions import s, t
from plainmath.validation import did_you_mean

_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Mod: operator.mod,
    ast.FloorDiv: operator.floordiv,
}


def _are_equal(one, other):
    """Whether two values are equal; 0.5 is one half, whether it is exact or not."""
    if is_number(one) and is_number(other):
        return float(one) == float(other)
    return one == other


_COMPARISONS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: _are_equal,
    ast.NotEq: lambda one, other: not _are_equal(one, other),
    ast.In: lambda one, others: any(_are_equal(one, other) for other in others),
    ast.NotIn: lambda one, others: not any(_are_equal(one, other) for other in others),
}


def is_number(value: object) -> bool:
    """Return whether a value is a number, and no expression with symbols."""
    return isinstance(value, int | float) or (isinstance(value, sympy.Expr) and value.is_number)


def _of_numbers(number: Callable[..., float], symbolic: Callable[..., sympy.Expr]) -> Callable[..., Any]:
    """A function that makes numbers of numbers, and expressions of expressions."""

    def function(*arguments):
        if not all(map(is_number, arguments)):
            return symbolic(*arguments)
        return number(*map(float, arguments))

    return function


def _sqrt(value):
    root = sympy.sqrt(value) if isinstance(value, sympy.Rational) else None
    if root is not None and root.is_Rational:
        return root  # exact where it can be
    return math.sqrt(value) if is_number(value) and value >= 0 else sympy.sqrt(value)


def _whole(of: Callable[[Any], Any]) -> Callable[[Any], sympy.Integer]:
    return lambda value: sympy.Integer(of(value))


def _rounded(value, digits=0):
    scale = sympy.Integer(10) ** int(digits)
    return sympy.Integer(math.floor(value * scale + sympy.Rational(1, 2))) / scale


#: What formulas know beside the givens, by name.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "exp": _of_numbers(math.exp, sympy.exp),
    "log": _of_numbers(math.log, sympy.log),
    "ln": _of_numbers(math.log, sympy.log),
    "log10": _of_numbers(math.log10, lambda value: sympy.log(value, 10)),
    "log2": _of_numbers(math.log2, lambda value: sympy.log(value, 2)),
    "sqrt": _sqrt,
    "sin": _of_numbers(math.sin, sympy.sin),
    "cos": _of_numbers(math.cos, sympy.cos),
    "tan": _of_numbers(math.tan, sympy.tan),
    "asin": _of_numbers(math.asin, sympy.asin),
    "acos": _of_numbers(math.acos, sympy.acos),
    "atan": _of_numbers(math.atan, sympy.atan),
    "atan2": _of_numbers(math.atan2, sympy.atan2),
    "abs": abs,
    "min": min,
    "max": max,
    "sum": sum,
    "floor": _whole(math.floor),
    "ceil": _whole(math.ceil),
    "round": _rounded,
    "symbols": lambda names, real=False: sympy.symbols(names, **({"real": True} if real else {"positive": True})),
    "Piecewise": lambda *parts: sympy.Piecewise(*map(tuple, parts)),
    "Heaviside": sympy.Heaviside,
    "sorted": sorted,
}
#: What they may call besides, each with the place where it is; it is imported when a formula calls it.
LIBRARY: dict[str, str] = {}
NAMES: dict[str, Any] = {"pi": math.pi, "I": sympy.I, "s": s, "t": t, "True": True, "False": False}


@dataclass(frozen=True)
class Formula:
    """A formula, which has a value for given values of its names.

    Attributes:
        text: as the author wrote it.
        tree: what Python's parser makes of it, with conversions of units where it needs some.
        names: of the quantities in it.
    """

    text: str
    tree: ast.expr
    names: frozenset[str]

    def __call__(self, values: Mapping[str, Any], functions: Mapping[str, Callable[..., Any]] | None = None) -> Any:
        """Return the value of the formula.

        Arguments:
            values: of its names.
            functions: those that a page has beside the general ones.
        Raises:
            ValueError: where it has none, as a quotient by zero.
        """
        known = FUNCTIONS | (functions or {})

        def called(name):
            return known[name] if name in known else pkgutil.resolve_name(LIBRARY[name])

        def value(node):
            match node:
                case ast.Constant(int() | float() as number) if not isinstance(number, bool):
                    return sympy.Rational(repr(number)) if isinstance(number, float) else sympy.Integer(number)
                case ast.Constant(constant):
                    return constant
                case ast.Name(name):
                    return values[name] if name in values else NAMES[name]
                case ast.BinOp(left, op, right):
                    return _OPERATORS[type(op)](value(left), value(right))
                case ast.UnaryOp(ast.USub(), operand):
                    return -value(operand)
                case ast.UnaryOp(ast.Not(), operand):
                    return not value(operand)
                case ast.BoolOp(ast.And(), parts):
                    return all(bool(value(part)) for part in parts)
                case ast.BoolOp(_, parts):
                    return any(bool(value(part)) for part in parts)
                case ast.Compare(left, operators, others):
                    one = value(left)
                    for op, other in zip(operators, map(value, others), strict=True):
                        if not _COMPARISONS[type(op)](one, other):
                            return False
                        one = other
                    return True
                case ast.IfExp(test, body, orelse):
                    return value(body) if value(test) else value(orelse)
                case ast.Call(ast.Name(name), arguments, keywords):
                    return called(name)(*map(value, arguments), **{one.arg: value(one.value) for one in keywords})
                case ast.List(parts) | ast.Tuple(parts):
                    return [value(part) for part in parts]
                case ast.Dict(keys, parts):
                    return {value(key): value(part) for key, part in zip(keys, parts, strict=True)}
                case ast.Subscript(of, place):
                    key = value(place)
                    return value(of)[int(key) if isinstance(key, sympy.Integer) else key]
                case ast.Attribute(of, name):
                    return getattr(value(of), name)
            raise AssertionError(ast.dump(node))

        try:
            return value(self.tree)
        except (ArithmeticError, ValueError, TypeError, LookupError, AttributeError) as error:
            raise ValueError(f"{self.text} has no value: {error}") from error

    def with_tree(self, tree: ast.expr) -> Formula:
        """Return the same formula with another tree."""
        return Formula(self.text, tree, self.names)


def _explained(text):
    """Why a text is likely to be no formula; empty where that is not known."""
    if re.search(r"(?<![=<>!])=(?!=)", text.partition("(")[0]):
        return "two sides are compared by =="
    return "every product needs a *" if re.search(r"[\w)] +[\w(]", text) else ""


_KNOWN_NODES = (
    ast.Constant, ast.Name, ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.Call, ast.List, ast.Tuple,
    ast.Dict, ast.Subscript, ast.Attribute,
)  # fmt: skip


def read(text: str, known: Mapping[str, Any], functions: Mapping[str, Any]) -> Formula:
    """Return the formula that a text spells.

    Arguments:
        text: as ``K*T/(T + delay)``.
        known: the names of quantities that it may use.
        functions: those that it may call beside the general ones.
    Raises:
        ValueError: for anything else, with the part that cannot be read.

    >>> read("2*sqrt(a) if a > 1 else 'small'", {"a": ""}, {})({"a": sympy.Integer(9)})
    6
    >>> read("a*b", {"a": ""}, {})
    Traceback (most recent call last):
    ValueError: a*b: there is no 'b': expected one of a
    """
    try:
        tree = ast.parse(" ".join(text.split()), mode="eval").body
    except SyntaxError as error:
        raise ValueError(f"{text}: cannot be read, {_explained(text) or error.msg}") from None
    if isinstance(tree, ast.Tuple) and not text.lstrip().startswith("("):
        raise ValueError(f"{text}: there is a comma: expected a decimal point, or a list in brackets, [1, 2]")

    def refuse(why):
        raise ValueError(f"{text}: {why}")

    names = set()

    def look(node):
        match node:
            case ast.Name(name):
                if name not in known and name not in NAMES:
                    refuse(f"there is no {name!r}: {did_you_mean(name, known)}")
                names.update({name} & {*known})
                return
            case ast.Call(ast.Name(name), arguments, keywords):
                every = {**FUNCTIONS, **LIBRARY, **functions}
                if name not in every:
                    refuse(f"there is no function {name!r}: {did_you_mean(name, every)}")
                for part in (*arguments, *(one.value for one in keywords)):
                    look(part)
                return
            case ast.Call():
                refuse(f"{ast.unparse(node.func)} is no function that a formula may call")
            case ast.Attribute(_, name) if name.startswith("_"):
                refuse(f"{name!r} is no name of a quantity")
        operators = [getattr(node, "op", None), *getattr(node, "ops", ())]
        known_operators = (*_OPERATORS, *_COMPARISONS, ast.USub, ast.Not, ast.And, ast.Or)
        if isinstance(getattr(node, "op", None), ast.BitXor):
            refuse("^ is no power: expected **")
        if not isinstance(node, _KNOWN_NODES) or any(op and type(op) not in known_operators for op in operators):
            refuse(f"{ast.unparse(node)} is nothing that a formula may say")
        for part in ast.iter_child_nodes(node):
            if isinstance(part, ast.expr):
                look(part)

    look(tree)
    return Formula(text, tree, frozenset(names))


def number(text: str) -> sympy.Rational:
    """Return the exact number that a text spells. Raises ValueError for another text.

    >>> number("0.28"), number("5/2")
    (7/25, 5/2)
    """
    try:
        return sympy.Rational(text)
    except (TypeError, ValueError):
        raise ValueError(f"{text!r} is no number: expected one such as 12, 0.5 or 5/2") from None


def word(text: str) -> sympy.Rational | str:
    """Return the number that a text spells, or the text itself.

    >>> word("1.5"), word("open")
    (3/2, 'open')
    """
    with contextlib.suppress(ValueError):
        return number(text)
    return text
