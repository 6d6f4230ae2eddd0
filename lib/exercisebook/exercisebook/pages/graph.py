"""Formulas as a graph: each quantity is a given, or has one formula of quantities that stand above it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from exercisebook.pages.formula import Formula


class Graph:
    """The givens of an exercise, and each formula of its physics once, in the order of thought.

    Arguments:
        givens: the names of what is given.
        formulas: {name: formula}, each of givens and of quantities above it.
        functions: those that the formulas call beside the general ones.
    """

    def __init__(self, givens: list[str], formulas: Mapping[str, Formula], functions: Mapping[str, Callable[..., Any]]):
        self.givens, self.formulas, self.functions = givens, dict(formulas), functions

    def values(self, givens: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values of all quantities. Raises ValueError where one has none."""
        found = dict(givens)
        for name, formula in self.formulas.items():
            found[name] = formula(found, self.functions)
        return found

    def changed(self, right: Mapping[str, Any], changes: Mapping[str, Formula | Any]) -> dict[str, Any]:
        """Return the values of all quantities where some of them are others: what follows from these follows.

        Arguments:
            right: the values without a change, as `values` returns them.
            changes: {name: another value, or a formula for it}. In its formula a quantity is what it would be by its
                own one, with the changes above it; what stands below it is what it is without a change.
        Raises:
            ValueError: where a quantity has no value then.

        >>> from exercisebook.pages.formula import read
        >>> graph = Graph(["a"], {"b": read("2*a", "a", {}), "c": read("b + a", "ab", {})}, {})
        >>> right = graph.values({"a": 3})
        >>> graph.changed(right, {"b": read("1/b", "abc", {})})["c"]
        19/6
        """
        found, moved = dict(right), set(changes)
        for name in (*self.givens, *self.formulas):
            formula = self.formulas.get(name)
            if formula and formula.names & moved:
                found[name] = formula(found, self.functions)
                moved.add(name)
            if name in changes:
                new, among = changes[name], found if formula else right  # two givens may be interchanged
                found[name] = new(among, self.functions) if isinstance(new, Formula) else new
        return found

    def sources(self, name: str) -> frozenset[str]:
        """Return the names of all quantities, givens and others, on which a quantity depends.

        >>> from exercisebook.pages.formula import read
        >>> graph = Graph(["a", "x"], {"b": read("2*a", "a", {}), "c": read("b + 1", "ab", {})}, {})
        >>> sorted(graph.sources("c"))
        ['a', 'b']
        """
        direct = self.formulas[name].names if name in self.formulas else frozenset()
        return direct.union(*map(self.sources, direct))
