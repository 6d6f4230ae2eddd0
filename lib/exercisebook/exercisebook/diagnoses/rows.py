"""Mistakes in rows and tables of numbers, and in poles: which of them are right, and what is wrong with another."""

from __future__ import annotations

from typing import Any

import numpy as np

from exercisebook.diagnoses.background import Amount, Background
from exercisebook.diagnoses.finding import Finding, explained, of_another, recomputed
from exercisebook.diagnoses.numbers import NEARBY, Case, found_in
from exercisebook.kinds import Numbers, Poles

_PLACES = ("first", "second", "third", "fourth", "fifth", "sixth")


@explained.register
def _(kind: Numbers, answer: Any, background: Background) -> Finding | None:
    if found := of_another(kind, answer, background):
        return found
    says = kind.hint(answer)
    if found := recomputed(kind, answer, background):
        return found
    found, key = np.atleast_1d(np.squeeze(answer)), np.atleast_1d(np.squeeze(kind.key))
    right = kind.near_each(found, key)
    if key.size > 1 and kind.near_each(np.sort(found, axis=None), np.sort(key, axis=None)).all():
        return Finding("the numbers are right, but they are in another order")
    off = np.argwhere(~right)
    for place in map(tuple, off):
        others = [
            Amount(float(value), kind.unit, f"the number for {_place(where)}", is_had=bool(right[where]))
            for where, value in np.ndenumerate(key)
            if where != place
        ]
        case = Case(float(key[place]), kind.unit, _place(place), kind.within, others, background.givens)
        mistake = found_in(float(found[place]), case)
        if mistake:
            says = f"{says}; " if says else ""
            return Finding(f"{says}{_place(place)}: {mistake.says}")
    if says and len(off) <= 2:
        says += f"; look at {' and '.join(_place(tuple(place)) for place in off)}"
    return Finding(says, is_mistake=False) if says else None


def _place(where):
    if len(where) == 2:
        return f"row {where[0] + 1}, column {where[1] + 1}"
    return f"the {_PLACES[where[0]]} number" if where[0] < len(_PLACES) else f"number {where[0] + 1}"


@explained.register
def _(kind: Poles, answer: Any, background: Background) -> Finding | None:
    if not len(answer):
        return Finding("the list is empty", is_mistake=False)
    if found := recomputed(kind, answer, background):
        return found
    key = kind.key
    right = kind.matched(answer)
    left = [key[k] for k in range(len(key)) if k not in right.values()]
    wrong = [answer[k] for k in range(len(answer)) if k not in right]
    slip = next((says for value in wrong for says in _slips(value, left, kind)), "")
    counted = f"{len(right)} of {len(key)} {'is' if len(right) == 1 else 'are'} right" if right else ""
    if len(answer) == len(key):
        says = "; ".join(part for part in (counted, slip) if part)
        return Finding(says, is_mistake=bool(slip)) if says else None
    if len(answer) > len(key):
        more = "all that are asked for are there, but also more" if len(right) == len(key) else "these are too many"
        return Finding("; ".join(part for part in (more, slip) if part), is_mistake=False)
    if wrong:
        missing = "one or more are missing" if right else "none of these is right, and there should be more"
        return Finding("; ".join(part for part in (missing, counted, slip) if part), bool(slip))
    conjugate = any(np.isclose(value, np.conj(key[k])) for k in right.values() if key[k].imag for value in left)
    if conjugate:
        return Finding("what is there is right, but a complex value never comes alone: its mirror image is missing")
    multiple = any(np.isclose(value, key[k]) for k in right.values() for value in left)
    if multiple:
        return Finding("what is there is right, but one of them counts several times")
    return Finding("what is there is right, but something is missing", is_mistake=False)


def _slips(value, left, kind):
    """What is wrong with one value, compared with those that nothing agrees with."""

    def is_near(one, other):
        return abs(one - other) <= max(kind.within, 0.01) * abs(other)

    for one in left:
        if one == 0:
            if abs(value) <= kind.within * (np.max(np.abs(kind.key)) or 1):
                yield "one should be exactly zero: an integrator has its pole nowhere else"
            continue
        for wrong, says in (
            (-one, "one has the wrong sign"),
            (-np.conj(one), "one has the wrong sign of its real part"),
            (np.conj(one), "one has the wrong sign of its imaginary part"),
            (1 / one, "one is the inverse of what it should be: a time instead of its inverse"),
            (-1 / one, "one is a time constant: a time constant of T makes the value -1/T"),
            (one.imag + 1j * one.real, "of one, real part and imaginary part are interchanged"),
        ):
            if is_near(value, wrong) and not is_near(value, one):
                yield says
        if is_near(value, one):
            is_beside = kind.sides([value]) != kind.sides([one])
            wrong_side = "one is on the wrong side of the imaginary axis, or beside it: is that part stable?"
            yield wrong_side if is_beside else "of one the real part, which damps, is not right"
        elif abs(value - one) <= NEARBY * abs(one):
            yield "one is off by a few percent, which is more than rounding explains"
        if one.imag and abs(value.real - one.real) <= kind.within * abs(one):
            yield "of one the real part is right, the imaginary part is not"
        if one.imag and abs(value.imag - one.imag) <= kind.within * abs(one):
            yield "of one the imaginary part is right, the real part is not"
