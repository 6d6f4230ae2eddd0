"""The value of a syntax tree: in decimal numbers with their errors, and in as many digits as it takes.

A formula is worked out operation by operation, by one of three arithmetics. No symbol is ever manipulated, so that no
formula, however large or nested, can take long or fill the memory:

- `Decimals` works on arrays of decimal numbers, and is quick;
- `Bounded` has an error beside each value, which is not finite where a part of the formula leaves the range of decimal
  numbers, or loses its last digit;
- `Digits` works on one point, without a largest number, in as many digits as it takes.
"""

from __future__ import annotations

import ast
import functools
import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from exercisebook.grammar import CONSTANTS, Unreadable

#: The last digit of a decimal number.
LAST_DIGIT = 2.0**-52
#: A slope tells the error of a curved function, a power or a fraction while its argument is known to this.
KNOWN = 1e-6
#: An exponential, or a product, below this has lost its digits.
SMALLEST = 1e-300
#: The argument of an exponential, or of a sine, has so many binary digits before its point at most.
MOST_BITS = 1100
#: Larger powers are worked out as exponentials.
LARGEST_POWER = 1000

_COMPARES = {ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater, ast.GtE: np.greater_equal}
NO_PIECE = "the Piecewise has no value at some points: end it with (value, True)"


class NoValue(ArithmeticError):  # noqa: N818 - it is what became of the point
    """A formula has no value at a point, or none that can be worked out in reasonable time."""


def worked_out(node: ast.expr, by: Decimals | Digits, factors: Mapping[int, Any] | None = None) -> Any:
    """Return the value of a tree, by an arithmetic.

    Arguments:
        factors: {id of a node: a factor by which its value is multiplied}.
    """

    def value(node):
        match node:
            case ast.Constant(bool()):
                found = by.truth(node.value)
            case ast.Constant():
                found = by.number(node.value)
            case ast.Name():
                found = by.named(node.id)
            case ast.UnaryOp():
                found = value(node.operand)
                found = by.negative(found) if isinstance(node.op, ast.USub) else found
            case ast.BinOp(op=ast.BitAnd() | ast.BitOr()):
                found = by.both(type(node.op), value(node.left), value(node.right))
            case ast.BinOp():
                found = by.operation(type(node.op), value(node.left), value(node.right))
            case ast.Compare():
                found = by.compared(type(node.ops[0]), value(node.left), value(node.comparators[0]))
            case ast.Call(ast.Name("Piecewise")):
                found = by.in_pieces([tuple(piece.elts) for piece in node.args], value)
            case ast.Call():
                found = by.called(node.func.id, [value(argument) for argument in node.args])
        return by.times(found, factors[id(node)]) if factors and id(node) in factors else found

    return value(node)


def _complex(function):
    """A function that has complex values for some real arguments."""
    return lambda x: function(np.asarray(x, complex))


_OPERATIONS: dict[type[ast.operator], Callable[..., Any]] = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
    ast.Pow: lambda x, n: np.asarray(x, complex) ** n,
}  # fmt: skip
_OTHER_NAMES = {"ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "abs": "Abs"}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "exp": np.exp, "log": _complex(np.log), "log10": _complex(np.log10), "sqrt": _complex(np.sqrt),
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh,
    "asin": _complex(np.arcsin), "acos": _complex(np.arccos), "atan": np.arctan,
    "Abs": np.abs, "sign": np.sign, "re": np.real, "im": np.imag,
}  # fmt: skip
#: How much each function changes with its argument: of the argument and the value.
_SLOPES: dict[str, Callable[..., Any]] = {
    "exp": lambda x, v: v, "log": lambda x, v: 1 / x, "log10": lambda x, v: 1 / x, "sqrt": lambda x, v: 0.5 / v,
    "sin": lambda x, v: np.cos(x), "cos": lambda x, v: np.sin(x), "tan": lambda x, v: 1 + v**2,
    "sinh": lambda x, v: np.cosh(x), "cosh": lambda x, v: np.sinh(x), "tanh": lambda x, v: 1 - v**2,
    "asin": lambda x, v: 1 / np.sqrt(1 - np.asarray(x, complex) ** 2),
    "acos": lambda x, v: 1 / np.sqrt(1 - np.asarray(x, complex) ** 2),
    "atan": lambda x, v: 1 / (1 + x**2),
    "Abs": lambda x, v: 1.0, "re": lambda x, v: 1.0, "im": lambda x, v: 1.0,
}  # fmt: skip


#: Functions that turn within the same distance everywhere, and those that have another branch or end beside a value.
_TURNING = frozenset({"exp", "sin", "cos", "tan", "sinh", "cosh", "tanh"})
_BRANCHING = frozenset({"log", "log10", "sqrt", "asin", "acos", "atan"})


class Decimals:
    """Arrays of complex decimal numbers.

    Arguments:
        values: {symbol: array}.
    """

    def __init__(self, values: Mapping[str, Any]):
        self.values = values

    def truth(self, value: bool) -> Any:
        """A truth value that stands in the formula."""
        return value

    def number(self, value: complex) -> Any:
        """A number that stands in the formula; a real one is not complex, or its negative has another root."""
        value = complex(value)
        return np.complex128(value) if value.imag else np.float64(value.real)

    def named(self, name: str) -> Any:
        """The values of a symbol, or a constant."""
        return self.values[name] if name in self.values else CONSTANTS[name]

    def negative(self, value: Any) -> Any:
        """A value with the other sign."""
        return np.negative(value)

    def times(self, value: Any, factor: Any) -> Any:
        """A value times an exact factor."""
        return value * factor

    def operation(self, operator: type[ast.operator], left: Any, right: Any) -> Any:
        """A sum, product or power."""
        return _OPERATIONS[operator](left, right)

    def both(self, operator: type[ast.operator], left: Any, right: Any) -> Any:
        """Two conditions, both or one of which hold."""
        return np.logical_and(left, right) if operator is ast.BitAnd else np.logical_or(left, right)

    def compared(self, operator: type[ast.cmpop], left: Any, right: Any) -> Any:
        """Where a condition holds; real parts are compared."""
        return _COMPARES[operator](np.real(left), np.real(right))

    def called(self, name: str, parts: Sequence[Any]) -> Any:
        """The value of a function; steps and limiters look at real parts."""
        name = _OTHER_NAMES.get(name, name)
        if name in _FUNCTIONS:
            return _FUNCTIONS[name](*parts)
        reals = [np.real(part) for part in parts]
        if name == "Heaviside":
            return np.heaviside(reals[0], 0.5)
        result = reals[0]
        for part in reals[1:]:
            result = (np.minimum if name.lower() == "min" else np.maximum)(result, part)
        return result

    def in_pieces(self, pieces: Sequence[tuple[ast.expr, ...]], value: Callable[[ast.expr], Any]) -> Any:
        """The piece that holds at each point. Raises Unreadable where none does at one."""
        pairs = [(value(one), value(condition)) for one, condition in pieces]
        return self.chosen(pairs)

    @staticmethod
    def chosen(pairs: Sequence[tuple[Any, Any]]) -> Any:
        """Of pairs of a value and a condition the first one that holds."""
        shape = np.broadcast_shapes(*(np.shape(part) for pair in pairs for part in pair))
        conditions = [np.broadcast_to(np.asarray(condition, bool), shape) for _, condition in pairs]
        if not np.all(np.any(conditions, axis=0)):
            raise Unreadable(NO_PIECE)
        return np.select(conditions, [np.broadcast_to(value, shape) for value, _ in pairs], np.nan)


@functools.lru_cache(maxsize=1000)  # the numbers of a formula are asked for at all points, and in all its changes
def _is_as_written(value):
    """Whether a number of a machine is the decimal that it is written as."""
    return not math.isfinite(value) or Fraction(repr(value)) == value


class Bounded(Decimals):
    """The same with an error beside each value, as pairs; a condition has one where it cannot be told.

    An error is a bound: it is not finite where a slope does not tell it, as with an argument of which little is known.

    Arguments:
        in_s: an exponential that is nearly zero has lost its digits; in time, what has died away is zero.
    """

    def __init__(self, values: Mapping[str, Any], in_s: bool):
        super().__init__(values)
        self.in_s = in_s

    def truth(self, value: bool) -> Any:
        """A truth value that stands in the formula."""
        return value, 0.0

    def number(self, value: complex) -> Any:
        """A number that stands in the formula, as it is written: few decimals are numbers of a machine."""
        value = complex(value)
        is_exact = _is_as_written(value.real) and _is_as_written(value.imag)
        return super().number(value), 0.0 if is_exact else LAST_DIGIT * abs(value)

    def named(self, name: str) -> Any:
        """The values of a symbol, or a constant."""
        is_exact = name in self.values or CONSTANTS[name] == 1j
        return super().named(name), 0.0 if is_exact else LAST_DIGIT * abs(CONSTANTS[name])

    def negative(self, value: Any) -> Any:
        """A value with the other sign."""
        return np.negative(value[0]), value[1]

    def times(self, value: Any, factor: Any) -> Any:
        """A value times an exact factor."""
        return value[0] * factor, value[1] * np.abs(factor)

    def operation(self, operator: type[ast.operator], left: Any, right: Any) -> Any:
        """A sum, product or power."""
        (x, dx), (y, dy) = left, right
        found = _OPERATIONS[operator](x, y)
        size = np.abs(found)
        if operator in (ast.Add, ast.Sub):
            error = dx + dy + LAST_DIGIT * size
        elif operator is ast.Mult:
            error = _product(dx, np.abs(y)) + _product(dy, np.abs(x)) + _product(dx, dy) + LAST_DIGIT * size
        elif operator is ast.Div:
            below = np.abs(y)
            error = dx / below + dy * np.abs(x) / below / below + LAST_DIGIT * size
            error = np.where(_vague(y, dy), np.inf, error)
        else:
            error = self._of_power(left, right, size)
        if operator not in (ast.Add, ast.Sub):  # a product that is nearly zero has lost its digits
            is_zero = (x == 0) | ((y == 0) & (operator is ast.Mult))
            error = error + np.where((size < SMALLEST) & ~is_zero, SMALLEST, 0)
        return found, np.where(np.isfinite(found), error, np.inf)

    @staticmethod
    def _of_power(left, right, size):
        """The error of a power; a whole one has a bound even where little is known of what it is a power of."""
        (x, dx), (y, dy) = left, right
        bottom = np.abs(x)
        logarithm = np.abs(np.log(np.where(x == 0, 1, x).astype(complex)))
        rounding = _product(LAST_DIGIT * (1 + np.abs(y) * logarithm), size)
        relative = _product(dx / np.where(bottom == 0, 1, bottom), np.abs(y)) + _product(dy, logarithm)
        is_whole = (dy == 0) & (np.imag(y) == 0) & (np.real(y) == np.round(np.real(y)))
        lost = _vague(x, dx) | _vague(y, dy) | (relative > KNOWN) | (~is_whole & _on_cut("log", x, dx))
        whole = _product(dx, np.abs(y) * (bottom + dx) ** np.maximum(np.abs(y) - 1, 0))
        error = np.where(lost, np.inf, _product(relative, size))
        return np.where(is_whole & (np.real(y) >= 1), whole, error) + rounding

    def both(self, operator: type[ast.operator], left: Any, right: Any) -> Any:
        """Two conditions, both or one of which hold."""
        return super().both(operator, left[0], right[0]), left[1] + right[1]

    def compared(self, operator: type[ast.cmpop], left: Any, right: Any) -> Any:
        """Where a condition holds; real parts are compared."""
        error = left[1] + right[1]
        told = np.abs(np.real(left[0]) - np.real(right[0])) > error  # and not where the error is not finite
        return super().compared(operator, left[0], right[0]), np.where(told | (error == 0), 0.0, np.inf)

    def called(self, name: str, parts: Sequence[Any]) -> Any:
        """The value of a function; steps and limiters look at real parts."""
        name = _OTHER_NAMES.get(name, name)
        found = super().called(name, [value for value, _ in parts])
        (x, off), *others = parts
        size = np.abs(found)
        if name in _SLOPES:
            error = _product(off, np.abs(_SLOPES[name](x, found))) + LAST_DIGIT * size
            if name in _TURNING:
                steep = off * size if name in ("tan", "tanh") else 0  # they have poles
                bend = size if name == "exp" else 1 + size
                error = np.where((off > KNOWN) | (steep > KNOWN), np.inf, error + off * off * bend)
            elif name in _BRANCHING:
                error = np.where(_vague(x, off) | _on_cut(name, x, off), np.inf, error)
        elif name == "sign":
            turned = 2 * off / np.abs(x) if np.iscomplexobj(x) else 0.0
            error = np.where(off == 0, 0.0, np.where(np.abs(x) > off, turned, np.inf))
        elif name == "Heaviside":
            error = np.where((np.abs(np.real(x)) > off) | (off == 0), 0.0, np.inf)
        else:
            error = off + sum(one for _, one in others)
        if name == "exp":  # what has died away is nothing in time
            gone = (size < SMALLEST) & (off <= -KNOWN * np.real(x))
            error = np.where(gone, np.inf if self.in_s else SMALLEST, error)
        return found, np.where(np.isfinite(found), error, np.inf)

    def in_pieces(self, pieces: Sequence[tuple[ast.expr, ...]], value: Callable[[ast.expr], Any]) -> Any:
        """The piece that holds at each point; its error counts, and those of the conditions."""
        pairs = [(value(one), value(condition)) for one, condition in pieces]
        found = self.chosen([(one[0], condition[0]) for one, condition in pairs])
        error = self.chosen([(one[1], condition[0]) for one, condition in pairs])
        return found, error + sum(condition[1] for _, condition in pairs)


def _product(error, factor):
    """An error times a factor; of no error, nothing."""
    return np.where(error == 0, 0.0, error * factor)


def _vague(value, error):
    """Where little is known of a value."""
    return error > KNOWN * np.abs(value)


def _on_cut(name, x, error):
    """Where the other branch of a function may count; a real number is on the side that everybody means."""
    if not np.iscomplexobj(x):
        return np.False_
    if name == "atan":
        return (error > 0) & (np.abs(np.real(x)) <= error) & (np.abs(np.imag(x)) >= 1 - error)
    beyond = np.abs(np.real(x)) >= 1 - error if name in ("asin", "acos") else np.real(x) <= error
    return (error > 0) & (np.abs(np.imag(x)) <= error) & beyond


@functools.cache
def _numbers(digits):
    """The numbers of so many digits; they are nobody else's, whose own digits stay as they are."""
    return mpmath.MPContext()


class Digits:
    """Single numbers of so many digits, without a largest one.

    Arguments:
        values: {symbol: number}.
        digits: of each number.
    Raises:
        NoValue: while it works out a formula that has no value.
    """

    def __init__(self, values: Mapping[str, complex], digits: int):
        self.many = _numbers(digits)
        self.many.dps = digits
        self.values = {name: self.number(value) for name, value in values.items()}

    def truth(self, value: bool) -> Any:
        """A truth value that stands in the formula."""
        return value

    def number(self, value: complex) -> Any:
        """A number that stands in the formula, as it is written."""
        value = complex(value)
        real = self.many.mpf(repr(value.real))
        return self.many.mpc(real, self.many.mpf(repr(value.imag))) if value.imag else real

    def named(self, name: str) -> Any:
        """The value of a symbol, or a constant."""
        if name in self.values:
            return self.values[name]
        constants = {"pi": self.many.pi, "E": self.many.e, "e": self.many.e}
        return +constants[name] if name in constants else self.many.mpc(0, 1)

    def negative(self, value: Any) -> Any:
        """A value with the other sign."""
        return -value

    def times(self, value: Any, factor: Any) -> Any:
        """A value times a factor."""
        return value * factor

    def operation(self, operator: type[ast.operator], left: Any, right: Any) -> Any:
        """A sum, product or power."""
        if operator is ast.Add:
            return left + right
        if operator is ast.Sub:
            return left - right
        if operator is ast.Mult:
            return left * right
        if right == 0 and (operator is ast.Div or left == 0):
            raise NoValue
        return left / right if operator is ast.Div else self._power(left, right)

    def _power(self, base, exponent):
        if self.many.isint(exponent) and abs(exponent) <= LARGEST_POWER:
            if base == 0 and exponent < 0:
                raise NoValue
            return base ** int(self.many.re(exponent))
        if base == 0:
            if self.many.re(exponent) <= 0:
                raise NoValue
            return self.many.zero
        return self.called("exp", [exponent * self.many.log(base)])

    def both(self, operator: type[ast.operator], left: bool, right: bool) -> bool:
        """Two conditions, both or one of which hold."""
        return left and right if operator is ast.BitAnd else left or right

    def compared(self, operator: type[ast.cmpop], left: Any, right: Any) -> bool:
        """Whether a condition holds; real parts are compared."""
        left, right = self.many.re(left), self.many.re(right)
        return bool(
            {ast.Lt: left < right, ast.LtE: left <= right, ast.Gt: left > right, ast.GtE: left >= right}[operator]
        )

    def called(self, name: str, parts: Sequence[Any]) -> Any:
        """The value of a function; steps and limiters look at real parts."""
        name, x = _OTHER_NAMES.get(name, name), parts[0]
        match name:
            case "Abs":
                return abs(x)
            case "sign":
                return x / abs(x) if x else x
            case "re" | "im":
                return getattr(self.many, name)(x)
            case "Heaviside":
                real = self.many.re(x)
                return self.many.mpf(0.5 if not real else 1 if real > 0 else 0)
            case "Min" | "min" | "Max" | "max":
                return (min if name.lower() == "min" else max)(self.many.re(part) for part in parts)
        if name in ("log", "log10") and x == 0:
            raise NoValue
        if x and self.many.mag(x) > MOST_BITS:
            raise NoValue
        return getattr(self.many, name)(x)

    def in_pieces(self, pieces: Sequence[tuple[ast.expr, ...]], value: Callable[[ast.expr], Any]) -> Any:
        """The first piece that holds."""
        for one, condition in pieces:
            if value(condition):
                return value(one)
        raise NoValue


#: With so many digits a value is worked out twice, and then with so many.
_DIGITS = ((40, 200), (330, 1000))


def in_digits(tree: ast.expr, values: Mapping[str, complex]) -> complex:
    """Return the value of a formula at a point, worked out twice, with different numbers of digits.

    A value beyond the range of decimal numbers is infinite or zero.

    Raises NoValue where it has none, or none that so many digits tell.

    >>> in_digits(ast.parse("1 + 0*exp(1e9)", mode="eval").body, {})
    (1+0j)
    >>> in_digits(ast.parse("1 + 1e30 - 1e30", mode="eval").body, {})
    (1+0j)
    """
    is_zero = False
    for few, more in _DIGITS:
        try:
            one, other = (worked_out(tree, Digits(values, many)) for many in (few, more))
        except NoValue:
            raise
        except (ArithmeticError, TypeError, ValueError, RecursionError, MemoryError):
            raise NoValue from None
        off, size = abs(one - other), abs(other)
        if size and off <= 1e-12 * size:
            return _decimal(other)
        is_zero = bool(size * 10 ** ((more - few) // 2) <= abs(one))  # if more digits tell nothing else
    if is_zero:
        return 0j
    raise NoValue


def _decimal(value):
    try:
        return complex(value)
    except OverflowError:
        return complex(np.inf)
