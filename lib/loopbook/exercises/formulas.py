"""Formulas as functions of numbers, and compared by their values in bounded time.

A formula is worked out over arrays of decimal numbers, operation by operation. No symbol is ever manipulated, so that
no formula, however large or nested, can take long or fill the memory.
"""

from __future__ import annotations

import ast
import copy
import math
import random
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from loopbook.exercises.reading import CONSTANTS, Unreadable, shortened, spelled, understood

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: The part of the points at which an answer must have a value: some forms leave the range of decimal numbers early.
FEWEST = 0.3
#: The fraction by which forms of one expression differ: their digits may cancel.
EXACT = 1e-9
#: An exponential below this has lost its digits.
SMALLEST = 1e-300


def _complex(function):
    """A function that has complex values for some real arguments."""
    return lambda x: function(np.asarray(x, complex))


_OPERATORS = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
    ast.Pow: lambda x, n: np.asarray(x, complex) ** n,
    ast.BitAnd: np.logical_and, ast.BitOr: np.logical_or,
    ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater, ast.GtE: np.greater_equal,
}  # fmt: skip
_FUNCTIONS = {
    "exp": np.exp, "log": _complex(np.log), "ln": _complex(np.log), "log10": _complex(np.log10),
    "sqrt": _complex(np.sqrt),
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh,
    "asin": _complex(np.arcsin), "acos": _complex(np.arccos), "atan": np.arctan,
    "arcsin": _complex(np.arcsin), "arccos": _complex(np.arccos), "arctan": np.arctan,
    "Abs": np.abs, "abs": np.abs, "sign": np.sign, "re": np.real, "im": np.imag,
}  # fmt: skip


class Formula:
    """A formula in some symbols, as a function of arrays of values.

    Arguments:
        given: text, in Python's notation or as people write formulas; a number; an expression of SymPy; or something
            that has a transfer function, as a `PID`, a `System`, or a system of python-control with one input and
            one output.
        symbols: the names that may occur.
    Attributes:
        text: the formula in Python's notation, where ``^`` is a power too.
        remark: how it was read, where it was given in another notation.
        literals: its numbers other than 1 and exponents, by their places in the tree.
    Raises:
        Unreadable: for anything else, in a sentence.

    >>> Formula("2*exp(-3*s)/(10*s + 1)", "s")(s=0)
    array(2.+0.j)
    """

    def __init__(self, given: object, symbols: str | Iterable[str] = ()):
        self.symbols = symbols.split() if isinstance(symbols, str) else list(symbols)
        self.text = spelled(given)
        source, tree = understood(self.text, self.symbols)
        self.text, self.remark = (source, f"read as {source}") if source else (self.text, "")
        self._set(tree)

    def with_tree(self, tree: ast.expr) -> Formula:
        """The same with another tree, as a mistake makes one of the key; its text is that of this one."""
        other = copy.copy(self)
        other._set(tree)
        return other

    def _set(self, tree):
        self.tree = tree
        nodes = list(ast.walk(tree))
        exponents = {id(node.right) for node in nodes if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)}
        numbers = [node for node in nodes if isinstance(node, ast.Constant) and type(node.value) is not bool]
        self.literals = [id(node) for node in numbers if node.value != 1 and id(node) not in exponents]

    def __call__(self, changed: int | None = None, by: float = 1.0, /, **values: ArrayLike) -> np.ndarray:
        """Return the values of the formula where its symbols have these values, complex; NaN where it has none.

        A point at which any part of the formula is beyond the range of decimal numbers has no value.

        Arguments:
            changed, by: one of the literals, and a factor by which it is multiplied.
        """
        beyond = np.zeros((), bool)

        def work_out(node):
            nonlocal beyond
            match node:
                case ast.Constant(bool()):
                    return node.value
                case ast.Constant():
                    return complex(node.value) * (by if id(node) == changed else 1)
                case ast.Name():
                    return values[node.id] if node.id in self.symbols else CONSTANTS[node.id]
                case ast.UnaryOp():
                    value = work_out(node.operand)
                    return np.negative(value) if isinstance(node.op, ast.USub) else value
                case ast.Compare():
                    sides = (np.real(work_out(side)) for side in (node.left, node.comparators[0]))
                    return _OPERATORS[type(node.ops[0])](*sides)
                case ast.Call(ast.Name("Piecewise")):
                    return piecewise(node.args)
                case ast.BinOp():
                    value = _OPERATORS[type(node.op)](work_out(node.left), work_out(node.right))
                case ast.Call():
                    value = called(node.func.id, [work_out(argument) for argument in node.args])
                    if node.func.id == "exp" and "s" in self.symbols:  # in time, what has died away is zero
                        beyond = beyond | (np.abs(value) < SMALLEST)
            beyond = beyond | ~np.isfinite(value)
            return value

        def piecewise(pieces):
            nonlocal beyond
            before = beyond  # a piece counts only where it holds
            pairs = [[work_out(part) for part in piece.elts] for piece in pieces]
            beyond = before
            shape = np.broadcast_shapes(*(np.shape(part) for pair in pairs for part in pair))
            conditions = [np.broadcast_to(np.asarray(condition, bool), shape) for _, condition in pairs]
            if not np.all(np.any(conditions, axis=0)):
                raise Unreadable("the Piecewise has no value at some points: end it with (value, True)")
            return np.select(conditions, [np.broadcast_to(value, shape) for value, _ in pairs], np.nan)

        try:
            with np.errstate(all="ignore"):
                found = np.asarray(work_out(self.tree), complex)
                return np.where(beyond, np.nan, found)
        except Unreadable:
            raise
        except RecursionError:
            raise Unreadable("the expression is very long: expected a simpler one") from None
        except (ArithmeticError, TypeError, ValueError):
            raise Unreadable(f"{shortened(self.text)} has no value: expected another expression") from None


def called(name: str, parts: Sequence[np.ndarray]) -> np.ndarray:
    """The value of a function of several parts; steps and limiters look at real parts."""
    if name in _FUNCTIONS:
        return _FUNCTIONS[name](*parts)
    reals = [np.real(part) for part in parts]
    if name == "Heaviside":
        return np.heaviside(reals[0], 0.5)
    limit = np.minimum if name.lower() == "min" else np.maximum
    result = reals[0]
    for part in reals[1:]:
        result = limit(result, part)
    return result


def agree(key: Formula, given: Formula, points: Mapping[str, np.ndarray], within: float) -> bool:
    """Whether a formula has the values of the key, as far as its numbers may be rounded.

    At each point the difference may be the fraction `within`, or what the key changes when each of its numbers is
    wrong by that fraction.

    Arguments:
        key, given: `Formula` in the same symbols.
        points: {symbol: array of values}.

    >>> points = points_for("s")
    >>> key = Formula("2*exp(-3*s)/(10*s + 1)", "s")
    >>> agree(key, Formula("0.2*exp(-3*s)/(s + 0.1)", "s"), points, within=0.01)
    True
    >>> agree(key, Formula("2/(10*s + 1)", "s"), points, within=0.01)
    False
    """
    shape = np.broadcast_shapes(*(np.shape(values) for values in points.values()))
    expected, found = (np.broadcast_to(one(**points), shape) for one in (key, given))
    allowed = np.maximum(within * np.abs(expected), rounding(key, expected, points, within))
    return near_everywhere(expected, found, allowed + EXACT * np.abs(expected))


def near_everywhere(expected: np.ndarray, found: np.ndarray, allowed: np.ndarray) -> bool:
    """Whether values differ by no more than is allowed wherever both have one, and they have one at many points."""
    known = np.isfinite(expected) & np.isfinite(allowed)
    judged = known & np.isfinite(found)
    enough = judged.any() and np.sum(judged) >= FEWEST * np.sum(known)
    return bool(enough and np.all(np.abs(found[judged] - expected[judged]) <= allowed[judged]))


def rounding(
    key: Formula,
    expected: np.ndarray,
    points: Mapping[str, np.ndarray],
    within: float,
    seen: Callable[[np.ndarray], np.ndarray] = np.asarray,
) -> np.ndarray:
    """Return by how much what is seen of the key may change when each of its numbers is wrong by that fraction."""
    changes = [np.abs(seen(key(literal, 1 + within, **points) - expected)) for literal in key.literals]
    return np.sum(changes, axis=0) if changes else np.zeros(np.shape(expected))


def points_for(symbols: str | Iterable[str]) -> dict[str, np.ndarray]:
    """Return values of symbols at which formulas are compared: {symbol: array}, the same every time.

    The symbol s takes complex values of nine orders of magnitude in the right half-plane; others are positive numbers,
    two of three near one and the others of eight orders of magnitude.
    """
    symbols = symbols.split() if isinstance(symbols, str) else list(symbols)
    dice = random.Random(7)
    # no simple number, at which a value might not exist
    sizes = 1.0137 * 10 ** (np.arange(-30, 25) / 6)
    angles = np.exp(1j * np.radians([0, 40, 85]))
    ranges = [1.2 if k % 3 else 9 for k in range(165)]
    points = {name: np.array([math.exp(dice.uniform(-a, a)) for a in ranges]) for name in sorted(symbols)}
    return points | ({"s": np.outer(sizes, angles).ravel()} if "s" in symbols else {})
