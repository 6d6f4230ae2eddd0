"""What is missing in a plant's class, said in one sentence as soon as the class is made."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import t
from loopbook.plants.declarations import name_of

__all__ = ["refuse_gaps"]


def refuse_gaps(cls: Any, states: list[sympy.Expr], inputs: list[sympy.Expr], laws: int) -> None:
    """Refuse a class of plants whose laws and quantities do not fit together.

    Arguments:
        cls: the class.
        states, inputs: its signals, as its laws have them.
        laws: the number of its laws that do not follow from others.
    Raises:
        ValueError: for what is not declared, not used or not determined.
    """
    if not laws:
        raise ValueError(f"{cls.__name__} has no law: expected a Balance or a Lag for each state")
    used = set(cls.measured)
    for name, formula in _formulas(cls):
        used |= _words_of(cls, name, formula)
    for x in cls.quantities:
        if x not in used:
            raise ValueError(f"{cls.__name__} declares {name_of(x)}, which no law contains and which is not measured")
    highest = [name_of(x) for x in states if x.diff(t) not in states]
    if len(highest) != laws:
        raise ValueError(f"{cls.__name__} has {laws} laws for the states {', '.join(highest)}: expected one for each")
    _refuse_others(f"{cls.__name__} has {cls.output} for output", [cls.output], [*states, *cls.measured])
    _refuse_others(f"{cls.__name__} has {cls.manipulated} for manipulated", [cls.manipulated], inputs)
    _refuse_others(f"{cls.__name__} has limits for a signal that is no state", cls.limits, states)
    _refuse_others(f"{cls.__name__} is at work by other signals", cls.at_work, [*inputs, *states])


def _formulas(cls):
    """What a class says: (name, equation or formula)."""
    yield from ((name, law.equation) for name, law in cls.laws.items())
    yield from ((name_of(x), formula) for x, formula in cls.measured.items())
    yield from ((f"the range of {name_of(x)}", sympy.Tuple(*limits)) for x, limits in cls.limits.items())


def _words_of(cls, name, formula):
    """The quantities in a formula, all of them declared."""
    inside = (formula.free_symbols - {t}) | {x.func(t) for x in formula.atoms(AppliedUndef)}
    for x in sorted(inside - set(cls.quantities), key=str):
        how = f"{x} = parameter(...)" if x.is_Symbol else f"{name_of(x)} = signal(...)"
        raise ValueError(f"{cls.__name__}: {name} contains {x}, which is not declared: expected {how}")
    for x in sorted(inside & set(cls.measured), key=str):
        raise ValueError(f"{cls.__name__}: {name} contains {x}, which is measured: expected {cls.measured[x]}")
    if formula.has(sympy.Subs) or any(x.expr.args != (t,) for x in formula.atoms(sympy.Derivative)):
        raise ValueError(f"{cls.__name__}: {name} has a delayed rate of change: expected delayed signals alone")
    return inside


def _refuse_others(what: str, chosen: Iterable[Any], among: list[sympy.Expr]) -> None:
    if not {*chosen} <= {*among}:
        raise ValueError(f"{what}: expected one of {', '.join(map(name_of, among))}")
