"""Units through a graph of formulas: each is checked by Pint, and what is converted is converted exactly.

A formula is written as in physics, ``A*h/q`` for m²·m/(L/min), and its numbers are those of the units: where two units
of one quantity meet, and where the declared unit is another than that which comes out, the formula gets the factor.
Temperatures in °C count as those in K, as differences and means of them do. What contains a symbol, or comes out of a
function of the author's, has no unit that is known here.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from exercisebook.pages.formula import Formula
from exercisebook.units import registry, spelled, with_powers

#: Functions of a number without unit, of an angle, and those whose value has the unit of what they are of.
_OF_RATIO = {"exp", "log", "ln", "log10", "log2", "asin", "acos", "atan"}
_OF_ANGLE = {"sin", "cos", "tan"}
_KEEPING = {"abs", "floor", "ceil", "round"}
_OF_EQUALS = {"min", "max", "sum", "atan2"}
_ANGLES = {"asin", "acos", "atan", "atan2"}
#: The unit of what has none that is known.
UNKNOWN = None


@functools.cache
def unit_of(text: str) -> Any:
    """Return Pint's unit for a text, as "kg/min"; °C is K."""
    text = with_powers(spelled(text)).replace("°C", "K").replace("dB", "dB_").replace("%", "percent_")
    return registry().parse_units("".join({"³": "**3", "²": "**2", "·": "*"}.get(sign, sign) for sign in text))


def converted(tree: ast.expr, units: Mapping[str, Any]) -> tuple[ast.expr, Any]:
    """Return a formula with the factors that its units need, and its own unit.

    Arguments:
        tree: of the formula.
        units: {name of a quantity: its unit, as `unit_of` returns it}; None where that is not known.
    Raises:
        ValueError: where units do not fit together.

    >>> units = {"V": unit_of("m³"), "q": unit_of("L/s"), "t": unit_of("min")}
    >>> tree, unit = converted(ast.parse("V/q + t", mode="eval").body, units)
    >>> ast.unparse(tree), factor(unit, "min")
    ('V / q + t * (3 / 50)', Fraction(50, 3))
    """
    return _converted(tree, units)


def factor(unit: Any, to: str) -> Fraction | float:
    """Return by what a number in a unit is multiplied to be one in another. Raises ValueError where none is."""
    return _factor(unit, unit_of(to))


@functools.cache
def _factor(unit, to):
    import pint

    parts = Fraction(1)
    match unit.dimensionality.get("[share]", 0), to.dimensionality.get("[share]", 0):  # a part of a whole, or percent
        case 0, 1:
            unit, parts = unit * unit_of("%"), Fraction(100)
        case 1, 0:
            unit, parts = unit / unit_of("%"), Fraction(1, 100)
    try:
        much = parts * registry().Quantity(Fraction(1), unit).to(to).magnitude
    except pint.PintError:
        raise ValueError(f"{_written(unit)} is not a unit of the same quantity as {_written(to)}") from None
    return much if much.denominator < 10**12 and abs(much) < 10**12 else float(much)  # angles contain pi


def _written(unit):
    powers = {str(name).replace("_", ""): power for name, power in unit._units.items()}
    words = [name if power == 1 else f"{name}^{power}" for name, power in powers.items()]
    return " ".join(words) or "a number without unit"


def times(tree: ast.expr, much: Fraction | float) -> ast.expr:
    """Return a formula with a factor."""
    if much == 1:
        return tree
    if isinstance(much, float):
        return ast.BinOp(tree, ast.Mult(), ast.Constant(much))
    number = ast.BinOp(ast.Constant(much.numerator), ast.Div(), ast.Constant(much.denominator))
    return ast.BinOp(tree, ast.Mult(), ast.Constant(much.numerator) if much.denominator == 1 else number)


def _in(tree, unit, to):
    """A formula in another unit; one whose unit is not known stays as it is."""
    return tree if unit is UNKNOWN or to is UNKNOWN else times(tree, _factor(unit, to))


def _converted(node, units):
    one = unit_of("")

    def like_first(parts):
        """Formulas in the unit of the first of them, and that unit; a zero has any unit."""
        found = [(*_converted(part, units), _is_zero(part)) for part in parts]
        known = [unit for _, unit, is_zero in found if not is_zero]
        to = next((unit for unit in known if unit is not UNKNOWN), UNKNOWN)
        trees = [tree if is_zero else _in(tree, unit, to) for tree, unit, is_zero in found]
        return trees, UNKNOWN if UNKNOWN in known else to

    match node:
        case ast.Constant(value):
            return node, one if isinstance(value, int | float) else UNKNOWN
        case ast.Name(name):
            return node, units.get(name, one if name == "pi" else UNKNOWN)
        case ast.BinOp(left, ast.Add() | ast.Sub() | ast.Mod() as op, right):
            (left, right), unit = like_first([left, right])
            return ast.BinOp(left, op, right), unit
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            (left, its), (right, other) = _converted(left, units), _converted(right, units)
            tree = ast.BinOp(left, op, right)
            if its is UNKNOWN or other is UNKNOWN:
                return tree, UNKNOWN
            return tree, its * other if isinstance(op, ast.Mult) else its / other
        case ast.BinOp(left, ast.FloorDiv() as op, right):
            (left, right), unit = like_first([left, right])
            return ast.BinOp(left, op, right), UNKNOWN if unit is UNKNOWN else one
        case ast.BinOp(left, op, right):
            (left, its), (right, power) = _converted(left, units), _converted(right, units)
            if its is UNKNOWN:
                return ast.BinOp(left, op, right), UNKNOWN
            if its == one:
                return ast.BinOp(left, op, _in(right, power, one)), one
            try:
                exponent = Fraction(str(Formula(ast.unparse(right), right, frozenset())({})))
                return ast.BinOp(left, op, right), its**exponent
            except (ValueError, KeyError):
                raise ValueError(f"{ast.unparse(node)} has a unit to a power that is no number") from None
        case ast.UnaryOp(op, operand):
            tree, unit = _converted(operand, units)
            return ast.UnaryOp(op, tree), unit
        case ast.Compare(left, operators, others):
            (first, *rest), _ = like_first([left, *others])
            return ast.Compare(first, operators, rest), UNKNOWN
        case ast.BoolOp(op, parts):
            return ast.BoolOp(op, [_converted(part, units)[0] for part in parts]), UNKNOWN
        case ast.IfExp(test, body, orelse):
            (body, orelse), unit = like_first([body, orelse])
            return ast.IfExp(_converted(test, units)[0], body, orelse), unit
        case ast.Call(ast.Name(name), arguments) if name in _OF_RATIO | _OF_ANGLE:
            to = unit_of("rad") if name in _OF_ANGLE else one
            trees = [_in(*_converted(part, units), to) for part in arguments]
            is_known = all(_converted(part, units)[1] is not UNKNOWN for part in arguments)
            return ast.Call(node.func, trees, []), (unit_of("rad") if name in _ANGLES else one) if is_known else UNKNOWN
        case ast.Call(ast.Name("sqrt"), [argument]):
            tree, unit = _converted(argument, units)
            return ast.Call(node.func, [tree], []), UNKNOWN if unit is UNKNOWN else unit ** Fraction(1, 2)
        case ast.Call(ast.Name(name), [argument, *rest]) if name in _KEEPING:
            tree, unit = _converted(argument, units)
            return ast.Call(node.func, [tree, *rest], []), unit
        case ast.Call(ast.Name(name), arguments) if name in _OF_EQUALS and len(arguments) > 1:
            trees, unit = like_first(arguments)
            return ast.Call(node.func, trees, []), unit_of("rad") if name == "atan2" else unit
        case ast.Call(func, arguments, keywords):
            trees = [_converted(part, units)[0] for part in arguments]
            named = [ast.keyword(part.arg, _converted(part.value, units)[0]) for part in keywords]
            return ast.Call(func, trees, named), UNKNOWN
    return node, UNKNOWN  # texts, lists and what is in them


def _is_zero(node):
    return isinstance(node, ast.Constant) and node.value == 0 and not isinstance(node.value, bool)
