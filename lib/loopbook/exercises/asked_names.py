"""The names under which readers answer, matched with those that are asked: ``check(K_c=2)`` where `Kp` is asked."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from loopbook.exercises.kinds.settings import NAMES, Settings, parts_of, setting
from loopbook.exercises.notation import bare
from loopbook.exercises.reading import Unreadable
from loopbook.pid import PID

if TYPE_CHECKING:
    from loopbook.exercises.kinds import Kind

#: Names of one quantity in different books, without case and underscores. A name in two rows may be either.
SYNONYMS = (
    "k kp kc gain",
    "kp kc kprop proportionalgain controllergain",
    "ti taui integraltime resettime",
    "td taud derivativetime",
    "tau theta delay deadtime timedelay",
    "tau t tau1 t1 lag timeconstant",
    "tc tauc lambda",
    "ku kcu kcr ultimategain",
    "pu tu pcr ultimateperiod period p",
    "omega w frequency crossover",
    "zeta xi damping dampingratio",
    "gainmargin gm",
    "phasemargin pm",
    "delaymargin dm",
    "pole poles p",
    "zero zeros z",
    "settings controller pid pi c",
    "h g m tf transferfunction",
)


def matched(given: Iterable[str], asked: Iterable[str]) -> dict[str, str]:
    """Return which asked name each given one means: {given: asked}; a name that may mean none or several is left out.

    The same names come first, then those that differ in case, underscores and Greek letters, then those that other
    books use for the quantity. What is taken already is meant by no second name.

    >>> matched(["K_c", "tauI"], ["Kp", "Ti"])
    {'K_c': 'Kp', 'tauI': 'Ti'}
    >>> matched(["T", "θ"], ["T", "tau"])
    {'T': 'T', 'θ': 'tau'}
    >>> matched(["tau"], ["tau_1", "theta"])
    {}
    """
    given, asked, found = list(dict.fromkeys(given)), list(asked), {}
    rules: tuple[Callable[[str, str], bool], ...] = (str.__eq__, _same_spelling, _same_quantity)
    for means in rules:
        left, open_ = [name for name in given if name not in found], set(asked) - set(found.values())
        meant = {name: [one for one in asked if one in open_ and means(name, one)] for name in left}
        for name, ones in meant.items():
            rivals = [other for other in left if ones and ones[0] in meant[other]]
            if len(ones) == len(rivals) == 1:
                found[name] = ones[0]
    return {name: found[name] for name in given if name in found}


def as_asked(given: Mapping[str, Any], key: Mapping[str, Kind]) -> dict[str, Any]:
    """Return answers under the names that are asked; one that may mean none or several keeps its own.

    The settings of a controller may be given one by one where a controller is asked, and as a controller where they
    are asked one by one.

    >>> from loopbook.exercises.kinds import Number, Settings
    >>> from loopbook.pid import PID
    >>> as_asked({"Kc": 2, "Ti": "10 s"}, {"controller": Settings(PID(2, Ti=10))})
    {'controller': {'Kp': 2, 'Ti': '10 s'}}
    >>> as_asked({"pid": PID(2, Ti=10)}, {"Kp": Number(2), "Ti": Number(10)})
    {'Kp': 2, 'Ti': 10}
    """
    given = _with_a_controller(given, key)
    meant = matched(given, key)
    return _one_by_one({meant.get(name, name): answer for name, answer in given.items()}, key)


def by_name(alone: object, key: Mapping[str, Kind]) -> dict[str, Any]:
    """Return an answer without a name under that which is asked; nothing where several are, and it says not which.

    >>> from loopbook.exercises.kinds import Number
    >>> by_name("Kp = 2, Ti = 10 s", {"Kp": Number(2), "Ti": Number(10, "s")})
    {'Kp': '2', 'Ti': '10 s'}
    """
    if len(key) == 1:
        return dict.fromkeys(key, alone)
    if isinstance(alone, dict) and all(isinstance(name, str) for name in alone):
        return alone if set(as_asked(alone, key)) & set(key) else {}
    if isinstance(alone, PID) or (isinstance(alone, str) and re.search("[=:]|^ *PI", alone)):
        return {name: value for name, value in _one_by_one({"pid": alone}, key).items() if name in key}
    return {}


def _with_a_controller(given, key):
    """Answers in which the settings of the one controller that is asked are put together."""
    [controller, *others] = [name for name, kind in key.items() if _is_controller(kind)] or [None]
    parts = {name: setting(name) for name in given if setting(name) and name not in key}
    several = len(set(parts.values())) > 1 or (parts and not parts.keys() & matched(given, key).keys())
    if controller in (None, *given) or others or not several or "Kp" not in parts.values():
        return given
    if len(set(parts.values())) < len(parts):  # two names for one setting
        return given
    return {name: answer for name, answer in given.items() if name not in parts} | {
        controller: {parts[name]: given[name] for name in parts}
    }


def _one_by_one(given, key):
    """Answers in which a controller becomes its settings, where two or more of them are asked one by one."""
    asked = {setting(name): name for name, kind in key.items() if setting(name) in NAMES and not _is_controller(kind)}
    for name, answer in given.items():
        if len(asked) > 1 and name not in key and _same_quantity(name, "pid"):
            try:
                parts = parts_of(answer)[0]
            except Unreadable:
                continue
            if parts:
                settings = {asked[part]: value for part, value in parts.items() if part in asked}
                return settings | {other: value for other, value in given.items() if other != name}
    return dict(given)


def _is_controller(kind: Kind) -> bool:
    return isinstance(getattr(kind, "example", kind), Settings)


def _same_spelling(one: str, other: str) -> bool:
    return bare(one) == bare(other)


def _same_quantity(one: str, other: str) -> bool:
    pair = {bare(one), bare(other)}
    return any(pair <= set(row.split()) for row in SYNONYMS)
