"""Formulas as functions of numbers: read once, and worked out wherever they are compared."""

from __future__ import annotations

import ast
import contextlib
import copy
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook.arithmetic import Bounded, Decimals, NoValue, in_digits, worked_out
from exercisebook.grammar import CONSTANTS, Unreadable, read, shortened
from exercisebook.reading import spelled

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: A value is as it should be where its error is no more than this fraction of it; in time, of the largest one.
SURE = 1e-10
#: Of points that are worked out in many digits, so many parts of the formula, all points together.
MOST_IN_DIGITS = 30_000
#: At first, so many points are worked out in many digits.
FEW_IN_DIGITS = 8
#: What decides by the place in the plane of s, and so is no part of a transfer function.
DECIDING = frozenset({"Abs", "abs", "sign", "re", "im", "Heaviside", "Min", "Max", "min", "max", "Piecewise"})
#: The values of a formula are kept for so many sets of points.
MOST_KEPT = 4


class Formula:
    """A formula in some symbols, as a function of arrays of values.

    Arguments:
        given: text, in Python's notation or as people write formulas; a number; an expression of SymPy; or something
            that has one as its ``expr``, or is a linear system with one input and one output.
        symbols: the names that may occur.
        time: the unit of t, in which times with a unit are read.
    Attributes:
        text: the formula in Python's notation, where ``^`` is a power too.
        remark: how it was read, where it was given in another notation.
        tree: its syntax tree.
    Raises:
        Unreadable: for anything else, in a sentence.

    >>> Formula("2*exp(-3*s)/(10*s + 1)", "s")(s=0)
    array(2.+0.j)
    """

    def __init__(self, given: object, symbols: str | Iterable[str] = (), time: str = ""):
        self.symbols = symbols.split() if isinstance(symbols, str) else list(symbols)
        found = read(spelled(given), self.symbols, time)
        self.tree, self.text = found.tree, found.text
        self.remark = f"read as {found.text}" if found.is_other else ""
        self._kept: list[tuple[Mapping[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray]] = []
        self.rounded: list[Any] = []

    def with_tree(self, tree: ast.expr) -> Formula:
        """The same with another tree, as a mistake makes one of the key; its text is that of this one."""
        other = copy.copy(self)
        other.tree, other._kept, other.rounded = tree, [], []
        return other

    def __call__(self, **values: ArrayLike) -> np.ndarray:
        """Return the values of the formula where its symbols have these values, complex; NaN where it has none.

        A point at which any part of the formula is beyond the range of decimal numbers has no value here; `values_at`
        works such points out in more digits.
        """
        found, error = self.with_errors(values)
        return np.where(np.isfinite(error), found, np.nan)

    def changed(self, factors: Mapping[int, Any], values: Mapping[str, Any]) -> np.ndarray:
        """Return its values where some of its parts are multiplied by factors: quick, and without a look at errors.

        Arguments:
            factors: {id of a node of the tree: factor, or an array of them}.
            values: {symbol: array}.
        """
        with np.errstate(all="ignore"):
            return np.asarray(self._tried(Decimals(values), factors), complex)

    def values_at(self, points: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return its values at points, as many digits as it takes; NaN where it has none, infinite where it is huge.

        Arguments:
            points: {symbol: array}; they are not to be changed, as the values are kept.

        >>> import numpy as np
        >>> Formula("1 + 0*exp(1e9*s)", "s").values_at({"s": np.array([-1.0, 0.5])})
        array([1.+0.j, 1.+0.j])
        """
        return self._told_at(points, MOST_IN_DIGITS)[0]

    def told_at(self, points: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Return the same, where it takes many digits at a few of the points alone; and at which points that is.

        Other points have the value NaN as well.
        """
        return self._told_at(points, 0)

    def in_decimals_at(self, points: Mapping[str, np.ndarray], places: np.ndarray) -> bool:
        """Whether decimal numbers tell its values at all of some places: elsewhere, `changed` is not to be trusted.

        Arguments:
            points: {symbol: array}, as of `told_at`.
            places: where, of the shape of the values.
        """
        self.told_at(points)
        (sure,) = (one[3] for one in self._kept if one[0] is points)
        return bool(sure[places].all())

    def _told_at(self, points, most):
        kept = next((one for one in self._kept if one[0] is points), None)
        if kept is None:
            shape = np.broadcast_shapes(*(np.shape(values) for values in points.values()))
            found, error = (np.broadcast_to(one, shape) for one in self.with_errors(points))
            with np.errstate(all="ignore"):
                size = np.abs(np.where(np.isfinite(found), found, 0))
                size = np.max(size) if [*self.symbols] == ["t"] else size  # a function of time is seen as a whole
                told = np.asarray(np.isfinite(found) & (error <= SURE * size))
            kept = points, np.asarray(np.where(told, found, np.nan)), told, told.copy()
            unsure = np.argwhere(~told)
            self._work_out(*kept[:3], unsure[:: max(1, len(unsure) // FEW_IN_DIGITS)][:FEW_IN_DIGITS])
            self._kept = [*self._kept[1 - MOST_KEPT :], kept]
        _, found, told, _ = kept
        if most and not told.all():
            self._work_out(*kept[:3], np.argwhere(~told)[: most // sum(1 for _ in ast.walk(self.tree))])
            told[...] = True
        return found, told

    def _work_out(self, points, found, told, places):
        """Fill in the values at some places."""
        for place in map(tuple, places):
            told[place] = True
            at = {name: complex(np.broadcast_to(values, told.shape)[place]) for name, values in points.items()}
            with contextlib.suppress(NoValue):
                found[place] = in_digits(self.tree, at)

    @property
    def decides(self) -> str:
        """The function by which it decides on the values of its symbols, as Abs or Piecewise; empty where none does."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Call) and node.func.id in DECIDING and not is_number(node):
                return node.func.id
        return ""

    def with_errors(self, values: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
        """Return its values in decimal numbers, and how far each may be off: not finite where that cannot be told."""
        with np.errstate(all="ignore"):
            found, error = self._tried(Bounded(values, "s" in self.symbols), None)
            return np.asarray(found, complex), np.asarray(error, float)

    def _tried(self, by, factors):
        try:
            return worked_out(self.tree, by, factors)
        except Unreadable:
            raise
        except RecursionError:
            raise Unreadable("the expression is very long: expected a simpler one") from None
        except (ArithmeticError, TypeError, ValueError):
            raise Unreadable(f"{shortened(self.text)} has no value: expected another expression") from None


def value_of(tree: ast.expr) -> complex:
    """Return the value of a tree without symbols; NaN where it has none. Raises Unreadable for a Piecewise without one.

    >>> value_of(Formula("1/3").tree)
    (0.3333333333333333+0j)
    """
    return complex(Formula("1").with_tree(tree).values_at({}))


def is_number(node: ast.expr) -> bool:
    """Whether a part of a formula has the same value everywhere, by its form.

    >>> is_number(Formula("sqrt(2)/3").tree), is_number(Formula("0*s", "s").tree)
    (True, False)
    """
    found = getattr(node, "is_number", None)
    if found is None:
        match node:
            case ast.Name():
                found = node.id in CONSTANTS
            case ast.Call():
                found = all(map(is_number, node.args))
            case _:
                found = all(is_number(part) for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr))
        node.is_number = found  # it is asked of each part of a part
    return found
