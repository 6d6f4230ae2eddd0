"""The fields of a form: what each kind of answers says of how it is typed, or chosen; `controls` makes HTML of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from exercisebook.forms.text import inline
from exercisebook.kinds.kind import Kind


@dataclass(frozen=True)
class Field:
    """A place for the answer to one asked quantity.

    Attributes:
        name: of the quantity.
        kind: of the answer, as authors call it, as "time_function".
        control: how it is filled in, one of the names in `kinds.kind`.
        asked: the quantity in words, as HTML.
        unit: beside the field.
        help: how an answer looks, as HTML; empty where that is plain.
        words: to choose from.
        parts: of something whole: (name, what it is, unit).
        symbols: of a formula, which is shown in two dimensions while it is typed.
        weight: what the quantity counts, where others count 1.
    """

    name: str
    kind: str
    control: str
    asked: str
    unit: str = ""
    help: str = ""
    words: tuple[str, ...] = ()
    parts: tuple[tuple[str, str, str], ...] = ()
    symbols: tuple[str, ...] = ()
    weight: float = 1
    more: dict[str, Any] = field(default_factory=dict)


def field_of(name: str, kind: Kind, weight: float = 1) -> Field:
    """Return the field for an asked quantity.

    Arguments:
        name: of the quantity.
        kind: its kind; words are in the order in which the kind has them.
        weight: what it counts.

    >>> from exercisebook.kinds import Number
    >>> field_of("T", Number(120, "s", "the period")).unit
    's'
    """
    said = {"asked": kind.what, "unit": kind.unit} | kind.field
    texts = {part: inline(said[part]) for part in ("asked", "help") if part in said}
    more = {part: tuple(map(inline, said)) for part, said in said.pop("more", {}).items()}
    return Field(name, getattr(kind, "example", kind).maker, weight=weight, **said | texts, more=more)
