"""Formulas as a graph: each quantity is a given, or has one formula of quantities that stand above it."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
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

    def changed(
        self, right: Mapping[str, Any], changes: Mapping[str, Formula | Any], asked: Iterable[str] = ()
    ) -> dict[str, Any]:
        """Return the values of quantities where some of them are others: what follows from these follows.

        Arguments:
            right: the values without a change, as `values` returns them.
            changes: {name: another value, or a formula for it}. In its formula a quantity is what it would be by its
                own one, with the changes above it, unless two are interchanged; what stands below it is what it is
                without a change.
            asked: those whose values are of use; of all if there are none.
        Raises:
            ValueError: where a quantity has no value then.

        >>> from exercisebook.pages.formula import read
        >>> graph = Graph(["a"], {"b": read("2*a", "a", {}), "c": read("b + a", "ab", {})}, {})
        >>> right = graph.values({"a": 3})
        >>> graph.changed(right, {"b": read("1/b", "abc", {})})["c"]
        19/6
        """
        found, moved, needed = dict(right), set(changes), self._needed(frozenset(asked or self.formulas))
        for name in (*self.givens, *self.formulas):
            formula = self.formulas.get(name)
            if formula and formula.names & moved and name in needed:
                found[name] = formula(found, self.functions)
                moved.add(name)
            if name in changes:
                new = changes[name]
                if isinstance(new, Formula):
                    others = [changes[one] for one in new.names & changes.keys() - {name}]
                    is_swapped = any(isinstance(other, Formula) and name in other.names for other in others)
                    new = new(found if formula and not is_swapped else right, self.functions)
                found[name] = new
        return found

    @functools.lru_cache(maxsize=64)  # noqa: B019 - the graphs live as long as the program
    def _needed(self, asked):
        return asked.union(*map(self.sources, asked))

    def sources(self, name: str) -> frozenset[str]:
        """Return the names of all quantities, givens and others, on which a quantity depends.

        >>> from exercisebook.pages.formula import read
        >>> graph = Graph(["a", "x"], {"b": read("2*a", "a", {}), "c": read("b + 1", "ab", {})}, {})
        >>> sorted(graph.sources("c"))
        ['a', 'b']
        """
        direct = self.formulas[name].names if name in self.formulas else frozenset()
        return direct.union(*map(self.sources, direct))
