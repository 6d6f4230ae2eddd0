"""What of a formula is right: on which symbols it depends, and in time its beginning and its end.

All of it is worked out from values of the formula at some points, for the key and the answer alike. What cannot be told
from them is not said.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import sympy

from exercisebook.diagnoses.background import Background
from exercisebook.diagnoses.finding import Finding
from exercisebook.grammar import listed
from exercisebook.kinds import Expression, TimeFunction

#: Two facts are the same up to this fraction, or what is asked if that is more.
SAME = 0.01
#: A part of a function of time counts where it goes over this share of the whole way.
SEEN = 0.1
#: Values of symbols, none of them simple.
_USUAL = np.array([0.61, 0.83, 1.12, 1.34, 1.71])


@functools.singledispatch
def of(kind: Expression, answer: Any, background: Background) -> Finding | None:
    """Return what is right and what is not in a wrong formula."""
    return constant(kind, answer, background) or _dependence(kind, answer)


@of.register
def _(kind: TimeFunction, answer: Any, background: Background) -> Finding | None:
    if found := constant(kind, answer, background):
        return found
    if part := _right_part(kind, answer):
        return part
    if isinstance(answer, np.ndarray):
        return None
    pairs = _in_time(kind, answer)
    time_constants = "on the way from the one to the other it is not right: look at the time constants"
    return facts_listed(kind, pairs, time_constants if len(pairs) > 1 else "")


def facts_listed(kind: Expression, pairs: Mapping[str, tuple[Any, Any]], otherwise: str = "") -> Finding | None:
    """Return a sentence on facts, pairs of found and right by their names."""
    known = {name: pair for name, pair in pairs.items() if all(one is not None for one in pair)}
    right = [name for name, (found, key) in known.items() if same(found, key, kind)]
    wrong = [name for name in known if name not in right]
    right = [name for name in right if np.size(known[name][0])]  # no zeros at all are nothing to speak of
    if not right and not wrong:
        return None
    are = f"its {listed(right)} {_are(right)} right" if right else ""
    not_ = f"its {listed(wrong)} {_are(wrong)} not" + ("" if right else " right") if wrong else otherwise
    says = ", but ".join(part for part in (are, not_) if part)
    for name, one in (("poles", "pole"), ("zeros", "zero")):
        if name in wrong and (counted := len(known[name][0]) - len(known[name][1])):
            says += f"; it has too {'many' if counted > 0 else 'few'} {one}s"
    return Finding(says, is_mistake=False, is_bare=not right) if says else None


def _are(names):
    return "are" if len(names) > 1 or names[0] in ("poles", "zeros") else "is"


def same(one: Any, other: Any, kind: Expression) -> bool:
    """Return whether two facts, numbers or rows of them, are the same but for what rounding leaves."""
    one, other = np.atleast_1d(one), np.atleast_1d(other)
    if one.shape != other.shape:
        return False
    scale = np.max(np.abs(other), initial=0.0)
    allowed = max(SAME, kind.within) * np.maximum(np.abs(other), 0.01 * scale) + 1e-9 * scale
    return bool(np.all(np.abs(one - other) <= allowed))


# --------------------------------------------------------------------------------------------------------- constants


def constant(kind: Expression, answer: Any, background: Background) -> Finding | None:
    """Return whether a formula is right but for a factor or a term without symbols, s and t."""
    with np.errstate(all="ignore"):
        key, found = _values(kind, answer)
        known = np.isfinite(key) & np.isfinite(found) & (key != 0)
        if np.sum(known) < 5 or np.any(found[np.isfinite(key) & (key == 0)]):  # it has begun too early, or not ended
            return None
        ratio, difference = found[known] / key[known], found[known] - key[known]
    if np.ptp(ratio.real) + np.ptp(ratio.imag) < 1e-6 * np.abs(ratio[0]) and abs(ratio[0] - 1) > 1e-6:
        factor = float(ratio[0].real)
        named = _factor_named(factor, background)
        return Finding(f"it is right but for a constant factor{named}; everything else in it is right")
    size = np.max(np.abs(key[known]))
    if "t" in kind.symbols and np.ptp(difference.real) < 1e-6 * size < np.abs(difference[0]):
        return Finding("it is right but for a constant that is added, or is missing: look where it begins and ends")
    return None


def _values(kind, answer):
    """The values of key and answer at the points of comparison."""
    points = kind.points()
    return np.broadcast_arrays(kind.key(**points), answer if isinstance(answer, np.ndarray) else answer(**points))


def _factor_named(factor, background):
    sign = " and the sign" if factor < 0 else ""
    for given in background.givens:
        if given.value not in (0, 1) and _is_factor(factor, given.value):
            return f" as large as the {given.words} of the question{sign}"
    names = {2: "2", 60: "60", 100: "100", 1000: "1000", 10: "10", 4: "4", math.pi: "π", 2 * math.pi: "2π"}
    for value, name in names.items():
        if _is_factor(factor, value):
            return f" of {name}{sign}"
    return sign


def _is_factor(factor, value):
    return any(abs(abs(factor) / abs(one) - 1) < 1e-3 for one in (value, 1 / value))


def _dependence(kind, answer):
    """In which symbols a formula is right, up to a factor or a term without them."""
    names = [name for name in kind.symbols if name not in ("s", "t")]
    if len(names) < 2:
        return None
    points = {name: values[:24] for name, values in kind.points().items()}

    def varied(formula, name):
        """Values in a table: in a column another value of one symbol, in a row others of the rest."""
        grid = {other: np.asarray(values)[:, None] for other, values in points.items()}
        grid[name] = np.asarray(points[name])[None, :]
        return np.broadcast_to(formula(**grid), (24, 24))

    in_factor, in_term, absent, there = [], [], [], []
    for name in names:
        with np.errstate(all="ignore"):
            key, found = varied(kind.key, name), varied(answer, name)
            ratio, difference = found / key, found - key
        if not (np.isfinite(ratio).all() and np.isfinite(difference).all()):
            return None
        if np.all(np.ptp(np.abs(key), axis=1) <= 1e-9 * np.abs(key[:, 0])):
            continue
        there.append(name)
        if np.all(np.ptp(np.abs(found), axis=1) <= 1e-9 * np.abs(found[:, 0])):
            absent.append(name)
        if np.all(np.abs(ratio - ratio[:, :1]) <= 1e-6 * np.abs(ratio[:, :1])):
            in_factor.append(name)
        if np.all(np.abs(difference - difference[:, :1]) <= 1e-6 * np.abs(key)):
            in_term.append(name)
    if absent:
        return Finding(f"it does not depend on {listed(absent)}, but it should", is_mistake=False)
    limits = [
        f"for a very {size} {name}"
        for name in names
        for size, value in (("small", 1e-7), ("large", 1e7))
        if _is_right_at(kind, answer, {name: value})
    ]
    if limits:
        return Finding(f"it is right {listed(limits[:3])}, but not otherwise", is_mistake=False)
    right = in_factor or in_term
    if right:
        off = [name for name in there if name not in right]
        says = f"it depends on {listed(right)} in the right way"
        return Finding(says + (f"; look at {listed(off)}" if off else ""), is_mistake=False)
    return None


# ----------------------------------------------------------------------------------------------------- facts in time


def _is_right_at(kind, answer, limit):
    """Whether a formula has the values of the key at a limit, where that is neither zero nor infinite."""
    usual = {name: (1 + 0.1 * place) * np.roll(_USUAL, place) for place, name in enumerate(kind.symbols)} | limit
    with np.errstate(all="ignore"):
        key, found = (formula(**usual) for formula in (kind.key, answer))
        size = np.abs(key)
        is_finite = np.all(np.isfinite(key) & (size > 1e-3) & (size < 1e3))
        return bool(is_finite and np.all(np.abs(found - key) <= 1e-3 * size))


def _right_part(kind, answer):
    """Whether a function in pieces is right at first, or at last."""
    if kind.expr is None or not kind.expr.has(sympy.Piecewise, sympy.Heaviside, sympy.Min, sympy.Max):
        return None
    key, found = (values.real[kind.times > 1e-2 * kind.until] for values in _values(kind, answer))
    is_right = np.abs(found - key) <= kind.within * np.nanmax(np.abs(key))
    first, last = int(np.argmin(is_right)), int(np.argmin(is_right[::-1]))
    if first and np.ptp(key[:first]) > SEEN * np.ptp(key):
        return Finding("it is right at first, but from some moment on it is not", is_mistake=False)
    if last and np.ptp(key[-last:]) > SEEN * np.ptp(key):
        return Finding("it is right from some moment on, but not before", is_mistake=False)
    return None


def _in_time(kind, answer):
    """Beginning, initial slope and end of two functions of time."""
    begin, early, late = 1e-9 * kind.until, 1e-6 * kind.until, 1e3 * kind.until

    def value(formula, time):
        return float(np.real(formula(t=np.array([time]))).ravel()[0])

    def slope(formula):
        return (value(formula, early) - value(formula, begin)) / early

    def end(formula):
        one, *others = (value(formula, factor * late) for factor in (1, 1.37, 2.11))
        is_at_rest = np.isfinite(one) and all(abs(one - other) <= 1e-6 * size for other in others)
        return one - mean if is_at_rest else None

    known = np.broadcast_to(kind.key(t=kind.times), kind.times.shape).real
    mean = float(np.nanmean(known))  # what counts is the way that the function goes
    size = float(np.nanmax(np.abs(known - mean))) or abs(mean)
    facts = {}
    for name, fact in (
        ("initial value", lambda one: value(one, begin) - mean),
        ("initial slope", slope),
        ("final value", end),
    ):
        pair = fact(answer), fact(kind.key)
        if pair[1] is not None and (pair[0] is None or not np.isfinite(pair[0])):
            continue
        facts[name] = tuple(None if one is None else _rounded(one, size) for one in pair)
    begins = facts.get("initial value")
    if begins and not same(*begins, kind):  # then the slope says little
        facts.pop("initial slope", None)
    return facts


def _rounded(value, size):
    """A value, zero where it is no more than a trace beside the size of the function."""
    return 0.0 if abs(value) < 1e-6 * size else value
