"""The quantities of many variants of a page at once, as columns, and what becomes of one of them by a slip."""

from __future__ import annotations

import ast
import functools
import math
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook.pages.formula import NAMES, Formula
from exercisebook.parameters import Value
from exercisebook.timeout import limited

if TYPE_CHECKING:
    from exercisebook.pages.page import Page
    from exercisebook.pages.slips import Slip

#: With wrong values a function of an author's may search without end: it gets so long for all variants.
SECONDS = 2
_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide, ast.Pow: np.power,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.Eq: operator.eq, ast.NotEq: operator.ne,
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "exp": np.exp, "log": np.log, "ln": np.log, "log10": np.log10, "log2": np.log2, "sqrt": np.sqrt, "abs": np.abs,
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "min": lambda *all_: functools.reduce(np.minimum, all_),
    "max": lambda *all_: functools.reduce(np.maximum, all_),
}  # fmt: skip


class Columns:
    """The right values of all quantities in some variants.

    Arguments:
        page: the exercise.
        variants: the values of the givens in each.

    Attributes:
        right: {name: column}, an array of numbers or words, or a list of anything else.
    """

    def __init__(self, page: Page, variants: Sequence[Mapping[str, Value]]):
        self.page, self.rows = page, [page.quantities(one) for one in variants]
        self.right = {name: _column([row[name] for row in self.rows]) for name in self.rows[0]}

    @property
    def numbers(self) -> list[str]:
        """The names of the quantities that are numbers."""
        return [name for name, one in self.right.items() if isinstance(one, np.ndarray) and one.dtype == float]

    def by(self, slip: Slip, name: str) -> np.ndarray:
        """Return what a quantity is by a slip in each variant, NaN where it is none."""
        with np.errstate(all="ignore"):
            found = {one: self._value(formula, self.right) for one, formula in slip.items()}
            for one in self._between(frozenset(slip), name):
                found[one] = self._value(self.page.graph.formulas[one], self.right | found)
        column = found.get(name)
        if isinstance(column, np.ndarray) and column.dtype == float:
            return np.where(np.isfinite(column), column, math.nan)
        return np.full(len(self.rows), math.nan)

    @functools.lru_cache(maxsize=256)  # noqa: B019 - it lives as long as the search
    def _between(self, changed, name):
        """The quantities that follow from changed ones, and from which another follows, in their order."""
        moved, needed = {*changed}, {name} | self.page.sources(name)
        for one, formula in self.page.graph.formulas.items():
            if one not in changed and one in needed and formula.names & moved:
                moved.add(one)
        return [one for one in self.page.graph.formulas if one in moved - changed]

    def _value(self, formula, columns):
        try:
            found = _in_columns(formula.tree, columns)
            return np.broadcast_to(found, len(self.rows)).astype(float) if np.ndim(found) == 0 else found
        except TypeError:
            return self._by_rows(formula, columns)

    def _by_rows(self, formula: Formula, columns):
        """The column of a formula that calls what takes no columns."""

        def of(place):
            row = {one: self.rows[place][one] if columns[one] is self.right[one] else columns[one][place]
                   for one in formula.names}  # fmt: skip
            try:
                return formula(row, self.page.functions)
            except Exception:  # the functions of an author are for right values
                return math.nan

        try:
            return _column(limited(SECONDS, lambda: [*map(of, range(len(self.rows)))]))
        except TimeoutError:
            return np.full(len(self.rows), math.nan)


def _column(values):
    """Values as an array of numbers or words; as they are where they are neither."""
    if all(isinstance(value, str | bool) for value in values):
        return np.array(values)
    try:
        return np.array([*map(float, values)])
    except Exception:  # an expression, or what a function of an author's makes of a wrong value
        return values


def _in_columns(node, columns):
    """The column of a formula. Raises TypeError where it has what takes no columns."""
    match node:
        case ast.Constant(int() | float() | str() as value):
            return value if isinstance(value, str) else float(value)
        case ast.Name(name):
            value = columns[name] if name in columns else NAMES[name]
            if isinstance(value, np.ndarray | float):
                return value
        case ast.BinOp(left, op, right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_in_columns(left, columns), _in_columns(right, columns))
        case ast.UnaryOp(ast.USub(), operand):
            return -_in_columns(operand, columns)
        case ast.Call(ast.Name(name), arguments, []) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(_in_columns(one, columns) for one in arguments))
        case ast.IfExp(ast.Compare(left, [op], [right]), body, orelse) if type(op) in _OPERATORS:
            test = _OPERATORS[type(op)](_in_columns(left, columns), _in_columns(right, columns))
            return np.where(test, _in_columns(body, columns), _in_columns(orelse, columns))
        case ast.IfExp(ast.Name() as test, body, orelse):
            return np.where(_in_columns(test, columns), _in_columns(body, columns), _in_columns(orelse, columns))
    raise TypeError
