"""Evidence judged again, from the data that a notebook stores with a check."""

from __future__ import annotations

import operator
import random
from collections.abc import Callable, Mapping
from decimal import Decimal
from typing import Any, TypeAlias

import sympy

from bookledger.evidence.probing import read, same_formula

#: Evidence as a notebook stores it.
Data: TypeAlias = Mapping[str, Any]
#: What a subject adds: what says whether such evidence holds, by its kind.
FURTHER: dict[str, Callable[[Data], bool]] = {}
_ORDER = {">": operator.gt, "<": operator.lt, "≥": operator.ge, "≤": operator.le}
_ROUNDING = Decimal("1e-9")


def speaks_for(evidence: Data, points: int) -> bool:
    """Return whether a piece of evidence holds, by its stored data; raise ValueError where that does not decide it."""
    match evidence["kind"]:
        case "every" | "some" as kind:
            holds = [speaks_for(case, points) for case in evidence["cases"]]
            return bool(holds) and (all if kind == "every" else any)(holds)
        case kind if kind in FURTHER:
            return FURTHER[kind](evidence)
        case "refusal":
            return bool(evidence["sentence"]) is evidence["is_refused"]
        case "ratio":
            return _by_ratio(evidence) is not evidence["contrary"]
        case "comparison" if evidence["relation"] in "=≠":
            equal = {"texts": operator.eq, "numbers": _nearly, "formulas": lambda *two: same_formula(*two, points)}
            return equal[evidence["of"]](evidence["left"], evidence["right"]) is (evidence["relation"] == "=")
        case "comparison":
            holds, left, right = _ORDER[evidence["relation"]], evidence["left"], evidence["right"]
            if evidence["of"] == "formulas":
                # for the noise around zero
                room = sympy.Float("1e-20") * {"≥": -1, "≤": 1}.get(evidence["relation"], 0)
                found = {bool(holds(value, room)) for value in _differences(left, right)}
                if len(found) > 1:
                    raise ValueError(f"{left} - {right} has either sign")
                return found == {True}
            return holds(_decimal(left), _decimal(right))
    raise ValueError(f"cannot judge {evidence}")


def _decimal(text):
    return Decimal({"oo": "Infinity", "-oo": "-Infinity"}.get(text, text))


def _nearly(left, right):
    a, b = _decimal(left), _decimal(right)
    return a == b or abs(a - b) <= _ROUNDING * max(abs(a), abs(b)) < Decimal("Infinity")


def _by_ratio(evidence):
    a, b, limit = (_decimal(evidence[key]) for key in ("left", "right", "limit"))
    match evidence["criterion"]:
        case "about equal":
            return a == b or abs(a - b) <= limit * max(abs(a), abs(b))
        case "negligible":
            return abs(a) <= limit * abs(b)
        case "roughly equal":
            return a == b or max(a, b) < (1 + limit) * min(a, b)
        case "much":
            return a > b and a >= (1 + limit) * b
        case "substantially":
            return a < b and a <= limit * b
    raise ValueError(f"cannot judge {evidence}")


def _differences(left, right):
    """The difference of two expressions at random points, where all symbols are positive."""
    found = []
    for draw in range(12):
        difference, dice = read(left, draw) - read(right, draw), random.Random(draw)
        symbols = sorted(difference.free_symbols, key=str)
        point = {x: sympy.Rational(dice.randint(1, 10**6), 10 ** dice.randint(3, 8)) for x in symbols}
        found.append(difference.evalf(30, subs=point))
    return found


def criteria(evidence: Data) -> set[str]:
    """Return the words of all criteria that a piece of evidence rests on."""
    return {evidence.get("criterion", "")}.union(*map(criteria, evidence.get("cases", [])))
