"""What is missing in a plant's class, said in one sentence as soon as the class is made."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from loopbook.plants.declarations import name_of
from plainmath.expressions import t
from plainmath.validation import did_you_mean

__all__: list[str] = []  # nothing that a user of the package would call


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
    _refuse_role(cls, "output", [*states, *cls.measured])
    _refuse_role(cls, "manipulated", inputs)
    for x in _others(cls.limits, states):
        raise ValueError(f"{cls.__name__} has limits for {x}, which is not a state: {_one_of(states)}")
    for x in _others(cls.at_work, [*inputs, *states]):
        raise ValueError(
            f"{cls.__name__} is at work by {x}, which is neither an input nor a state: {_one_of(inputs + states)}"
        )


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
    for x in sorted((x for x in formula.atoms(AppliedUndef) if x.func(t) in cls.measured), key=str):
        instead = cls.measured[x.func(t)].subs(t, x.args[0])
        raise ValueError(
            f"{cls.__name__}: {name} contains {_in_words(x)}, which is measured: expected {_in_words(instead)}"
        )
    if formula.has(sympy.Subs) or any(x.expr.args != (t,) for x in formula.atoms(sympy.Derivative)):
        raise ValueError(f"{cls.__name__}: {name} has a delayed rate of change: expected delayed signals alone")
    return inside


def _in_words(formula):
    """A formula as a class states it: T for T(t), delayed(T, 5) for T(t - 5)."""
    delays = {x: t - x.args[0] for x in formula.atoms(AppliedUndef)}
    words = {x: f"delayed({name_of(x)}, {delay})" if delay else name_of(x) for x, delay in delays.items()}
    return str(formula.xreplace({x: sympy.Symbol(word) for x, word in words.items()}))


def _refuse_role(cls: Any, role: str, among: list[sympy.Expr]) -> None:
    """Refuse an output or a manipulated input that is none."""
    chosen, names = getattr(cls, role), list(map(name_of, among))
    if isinstance(chosen, str):
        meant = f"expected the signal {chosen}" if chosen in names else did_you_mean(chosen, names)
        raise ValueError(f"{cls.__name__}: {role} is the text {chosen!r}: {meant}")
    if chosen is None and among:
        raise ValueError(f"{cls.__name__} names no {role}: expected {role} = {' or '.join(names)}")
    if chosen not in among:
        raise ValueError(f"{cls.__name__} has {chosen} for {role}: {_one_of(among)}")


def _others(chosen: Iterable[Any], among: list[sympy.Expr]) -> list[Any]:
    return [x for x in chosen if x not in among]


def _one_of(among: list[sympy.Expr]) -> str:
    return f"expected one of {', '.join(map(name_of, among))}" if among else "no signal of its laws could be one"
