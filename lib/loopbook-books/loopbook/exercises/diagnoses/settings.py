"""Mistakes in the settings of a controller: which of them are right, and what is wrong with another."""

from __future__ import annotations

from typing import Any

import sympy

from exercisebook.diagnoses.background import Amount, Background
from exercisebook.diagnoses.finding import Finding, explained, recomputed
from exercisebook.diagnoses.numbers import (
    Case,
    found_in,
    in_general,
    others_asked,
    size_of,
    to_check,
    wrong_before,
)
from exercisebook.grammar import listed
from exercisebook.kinds.numeric import near
from loopbook.exercises.kinds.settings import NAMES, Settings, other_form
from loopbook.pid import PID


@explained.register
def _(kind: Settings, answer: Any, background: Background) -> Finding | None:
    mistake = recomputed(kind, answer, background)
    answer = kind.in_form_of_key(answer)
    if answer is None:
        return mistake
    if kind.like(PID(kind.key.Ti, kind.key.Kp, kind.key.Td, kind.key.Tf)).agrees(answer):
        return Finding("Kp and Ti are interchanged")
    had = kind.parts_near(answer)
    right = [name for name in NAMES if had[name] and getattr(kind.key, name) not in (0, sympy.oo)]
    wrong = [name for name in NAMES if not had[name]]
    says = [f"{listed(right)} {'are' if right[1:] else 'is'} right"] if right else []
    if mistake:
        return Finding("; ".join([*says, mistake.says]))
    found = {name: _in_part(kind, name, answer, background) for name in wrong}
    named = [f"{name} is not{one.says}" if one.is_bare else f"{name}: {one.says}" for name, one in found.items()]
    is_mistake = any(one.is_mistake for one in found.values())
    if not right and all(one.is_bare for one in found.values()):
        return None
    return Finding("; ".join(says + named), is_mistake)


def _in_part(kind, name, answer, background):
    """What is found in one of the settings, a number."""
    value, key = getattr(answer, name), getattr(kind.key, name)
    if key == sympy.oo:
        return Finding("no integral term is asked for")
    if value == sympy.oo:
        return Finding("the integral term is missing")
    if key == 0 or value == 0:
        what = {"Td": "a derivative term", "Tf": "a filter"}.get(name, "it")
        return Finding(f"{what} is not asked for" if key == 0 else f"{what} is missing")
    if (other := other_form(kind.key)) and near(value, float(getattr(other, name)), kind.within):
        return Finding(f"that is the {name} of the {other.form} form")
    had = kind.parts_near(answer)
    others = [
        Amount(float(getattr(kind.key, other)), _unit(kind, other), other, is_had=had[other])
        for other in NAMES
        if other != name and getattr(kind.key, other) not in (0, sympy.oo)
    ]

    def changed(likely):
        for how, other in background.changed_keys(likely):
            if isinstance(other, Settings) and other.key.form == kind.key.form and getattr(other.key, name).is_finite:
                yield float(getattr(other.key, name)), how

    case = Case(
        float(key),
        _unit(kind, name),
        name,
        kind.within,
        others + [amount for _, amount in others_asked(background)],
        background.givens,
        changed,
        wrong_before(background),
    )
    named = found_in(float(value), case) or in_general(float(value), case)
    if named.is_bare:
        return Finding(f"{size_of(float(value), case)}{to_check(case)}", is_mistake=False, is_bare=True)
    return named


def _unit(kind, name):
    return kind.gain if name == "Kp" else kind.time
