"""The fields of a form: for each kind of answers how it is typed, or chosen.

Nothing here comes from a key: a field looks alike for every answer that the kind can read.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import Any

from loopbook.exercises.forms.text import inline
from loopbook.exercises.kinds import Design, Expression, Kind, Number, Numbers, Poles, Settings, Word, Words
from loopbook.exercises.kinds.by_hand import Figure, Text
from loopbook.exercises.kinds.instrument_diagram import InstrumentDiagram
from loopbook.exercises.kinds.sequential_chart import SequentialChart

#: How a field is filled in: a line of text, several lines, one word or several of a list, words of a list in an order,
#: parts, each with its own line; or not in a page.
LINE, LINES, ONE, SEVERAL, ORDER, PARTS, ELSEWHERE = "line", "lines", "one", "several", "order", "parts", "elsewhere"
#: What stands for no word of a list, where several may be chosen.
NONE = "none"


@dataclass(frozen=True)
class Field:
    """A place for the answer to one asked quantity.

    Attributes:
        name: of the quantity.
        kind: of the answer, as authors call it, as "transfer_function".
        control: how it is filled in, one of the names above.
        asked: the quantity in words, as HTML.
        unit: beside the field.
        help: how an answer looks, as HTML; empty where that is plain.
        words: to choose from.
        parts: of a controller: (name, what it is, unit).
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
    weight: float = 1
    more: dict[str, Any] = field(default_factory=dict)

    @property
    def data(self) -> dict[str, Any]:
        """The field as JSON data."""
        said = {"name": self.name, "kind": self.kind, "control": self.control, "asked": self.asked}
        return said | {"unit": self.unit, "help": self.help, "words": self.words, "parts": self.parts} | self.more


def field_of(name: str, kind: Kind, weight: float = 1) -> Field:
    """Return the field for an asked quantity.

    Arguments:
        name: of the quantity.
        kind: its kind; words are in the order in which the kind has them.
        weight: what it counts.

    >>> field_of("Ti", Number(120, "s", "the integral time")).data["unit"]
    's'
    """
    said = {"asked": inline(kind.what), "unit": kind.unit} | _looks(kind)
    return Field(name, getattr(kind, "example", kind).maker, weight=weight, **said)


@functools.singledispatch
def _looks(kind: Kind) -> dict[str, Any]:
    """How a field for a kind of answers looks, as arguments of `Field`; each kind that has more to say registers how.

    A kind that is not known here is typed in lines, as its sentence on what is expected says.
    """
    return {"control": LINES, "asked": inline(kind.asked), "unit": "", "help": inline(f"Expected: {kind.expected}.")}


@_looks.register
def _(kind: Number) -> dict[str, Any]:
    return {"control": LINE}


@_looks.register
def _(kind: Numbers) -> dict[str, Any]:
    return {"control": LINE, "help": inline(kind.expected.removesuffix(f", in {kind.unit}"))}


@_looks.register
def _(kind: Poles) -> dict[str, Any]:
    return {"control": LINE, "help": inline(kind.expected)}


@_looks.register
def _(kind: Expression) -> dict[str, Any]:
    says = f"an expression in {', '.join(kind.symbols)}" if kind.symbols else "an expression"
    return {"control": LINE, "help": inline(says)}


@_looks.register
def _(kind: Word) -> dict[str, Any]:
    return {"control": ONE, "words": kind.among}


@_looks.register
def _(kind: Words) -> dict[str, Any]:
    if kind.ordered:
        return {"control": ORDER, "words": kind.among, "help": "in their order, with commas between them"}
    none = () if NONE in kind.among else (NONE,)
    return {"control": SEVERAL, "words": (*kind.among, *none), "help": "one, several, or none of them"}


@_looks.register
def _(kind: Settings) -> dict[str, Any]:
    form = {"any": "", "parallel": ", in parallel form", "serial": ", in serial form"}[kind.form]
    parts = [("Kp", "gain", kind.gain), ("Ti", "integral time", kind.time)]
    parts += [("Td", "derivative time", kind.time), ("Tf", "filter time", kind.time)]
    # where both forms are right, an answer must be able to say which one it has
    more = {"forms": ("parallel", "serial")} if kind.form == "any" else {}
    asked = {"asked": inline(kind.what + form), "help": "Leave empty what the controller does not have."}
    return {"control": PARTS, "parts": tuple(parts), "more": more} | asked


@_looks.register
def _(kind: Design) -> dict[str, Any]:
    inner = _looks(kind.example)
    demands = [inline(one.demand) for one in kind.criteria]
    return inner | {"more": inner.get("more", {}) | {"demands": demands}}


@_looks.register
def _(kind: SequentialChart) -> dict[str, Any]:
    says = "A line for each step and each transition, as `Fill: inlet on` and `Fill -> Heat: level >= 0.9`."
    return {"control": LINES, "asked": inline(kind.asked.replace(", as lines of text", "")), "help": inline(says)}


@_looks.register
def _(kind: InstrumentDiagram) -> dict[str, Any]:
    says = (
        "A line for each connection, or several in one, as `vessel -> LT1 -> LC1 -> LV1 -> outlet`; "
        "a pneumatic signal is `-//->`."
    )
    asked = kind.asked.replace(", as lines of connections", "")
    return {"control": LINES, "asked": inline(asked), "help": inline(says)}


@_looks.register
def _(kind: Text) -> dict[str, Any]:
    return {"control": LINES, "asked": inline(kind.asked)}


@_looks.register
def _(kind: Figure) -> dict[str, Any]:
    says = "A page has no place for a figure: this one is answered in JupyterLab."
    return {"control": ELSEWHERE, "asked": inline(kind.asked), "help": says}
