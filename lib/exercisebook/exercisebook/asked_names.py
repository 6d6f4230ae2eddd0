"""The names under which readers answer, matched with those that are asked: ``check(t_1=2)`` where `T1` is asked."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from exercisebook.grammar import Unreadable, bare
from exercisebook.wholes import WHOLES

if TYPE_CHECKING:
    from exercisebook.kinds import Kind

#: Names of one quantity in different books, a row for each, without case and underscores. A name in two rows may be
#: either.
SYNONYMS: list[str] = []


def also_called(*rows: str) -> None:
    """Say which names are those of one quantity in different books.

    Arguments:
        rows: names with spaces between them, in small letters and without underscores.
    """
    SYNONYMS.extend(rows)


def matched(given: Iterable[str], asked: Iterable[str]) -> dict[str, str]:
    """Return which asked name each given one means: {given: asked}; a name that may mean none or several is left out.

    The same names come first, then those that differ in case, underscores and Greek letters, then those that other
    books use for the quantity. What is taken already is meant by no second name.

    >>> matched(["t_1", "θ"], ["T1", "theta"])
    {'t_1': 'T1', 'θ': 'theta'}
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

    The parts of a `Whole` may be given one by one where it is asked, and as a whole where they are asked one by one.

    >>> from exercisebook.kinds import Number
    >>> as_asked({"t_1": 2}, {"T1": Number(2)})
    {'T1': 2}
    """
    given = _put_together(given, key)
    meant = matched(given, key)
    return _one_by_one({meant.get(name, name): answer for name, answer in given.items()}, key)


def by_name(alone: object, key: Mapping[str, Kind]) -> dict[str, Any]:
    """Return an answer without a name under that which is asked; nothing where several are, and it says not which.

    >>> from exercisebook.kinds import Number
    >>> by_name({"K": 2, "T": "10 s"}, {"K": Number(2), "T": Number(10, "s")})
    {'K': 2, 'T': '10 s'}
    """
    if len(key) == 1:
        return dict.fromkeys(key, alone)
    if isinstance(alone, dict) and all(isinstance(name, str) for name in alone):
        return alone if set(as_asked(alone, key)) & set(key) else {}
    for whole in WHOLES:
        if whole.is_one(alone) or (isinstance(alone, str) and re.search("[=:]", alone)):
            one_by_one = _one_by_one({whole.called: alone}, key)
            if found := {name: value for name, value in one_by_one.items() if name in key}:
                return found
    return {}


def _put_together(given, key):
    """Answers in which the parts of the one whole that is asked are put together."""
    [name, *others] = [name for name, kind in key.items() if kind.whole] or [None]
    if name in (None, *given) or others:
        return given
    whole = key[name].whole
    parts = {other: whole.part(other) for other in given if whole.part(other) and other not in key}
    several = len(set(parts.values())) > 1 or (parts and not parts.keys() & matched(given, key).keys())
    if not several or whole.parts[0] not in parts.values():
        return given
    if len(set(parts.values())) < len(parts):  # two names for one part
        return given
    return {other: answer for other, answer in given.items() if other not in parts} | {
        name: {parts[other]: given[other] for other in parts}
    }


def _one_by_one(given, key):
    """Answers in which a whole becomes its parts, where two or more of them are asked one by one."""
    for whole in WHOLES:
        asked = {whole.part(name): name for name, kind in key.items() if not kind.whole}
        asked = {part: asked[part] for part in whole.parts if part in asked}
        for name, answer in given.items():
            if len(asked) > 1 and name not in key and _same_quantity(name, whole.called):
                try:
                    parts = whole.parts_of(answer)[0]
                except Unreadable:
                    continue
                if parts:
                    one_by_one = {asked[part]: value for part, value in parts.items() if part in asked}
                    return one_by_one | {other: value for other, value in given.items() if other != name}
    return dict(given)


def _same_spelling(one: str, other: str) -> bool:
    return bare(one) == bare(other)


def _same_quantity(one: str, other: str) -> bool:
    pair = {bare(one), bare(other)}
    return any(pair <= set(row.split()) for row in SYNONYMS)
