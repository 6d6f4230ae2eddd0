"""The letters of an instrument's tag in a P&I diagram, and what they say: FC123 is the flow controller of loop 123.

The letters of the textbook's Table A.1 are marked so; the others are of the standards ISA-5.1 and ISO 3511, so that no
diagram of the collection needs a letter that is explained nowhere.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["LETTERS", "Letter", "Tag", "decode", "letter_table", "loops"]

FIRST, MODIFIER, FUNCTION, LIMIT = "first letter", "modifier", "function", "limit"


@dataclass(frozen=True)
class Letter:
    """What a letter means at one place of a tag.

    Attributes:
        letter: the letter.
        place: "first letter" (what is measured), "modifier" (of what is measured), "function" (what is done with it) or
            "limit" (at which an alarm or a switch reacts). The last three are the subsequent letters.
        meaning: in words, with a remark in brackets where there is one.
        source: "Table A.1" of the textbook, or the standard.
        noun: the meaning within a phrase, as "controller".
        adjective: the same before another function, as "indicating" in an indicating controller.
    """

    letter: str
    place: str
    meaning: str
    source: str
    noun: str = ""
    adjective: str = ""

    def __post_init__(self) -> None:
        plain = self.meaning.partition(" (")[0]
        object.__setattr__(self, "noun", self.noun or plain)
        object.__setattr__(self, "adjective", self.adjective or self.noun)

    @property
    def column(self) -> str:
        """Its column in the textbook's table: a modifier stands with the first letters, as it belongs to them."""
        return "as first letter" if self.place in (FIRST, MODIFIER) else "as subsequent letter"


#: Every meaning of every letter. Where a standard differs from the textbook, the textbook's meaning stands.
LETTERS = (
    Letter("A", FIRST, "analysis", "ISA-5.1"),
    Letter("D", FIRST, "density", "Table A.1"),
    Letter("E", FIRST, "voltage", "ISA-5.1"),
    Letter("F", FIRST, "flow", "Table A.1"),
    Letter("G", FIRST, "position", "Table A.1"),
    Letter("H", FIRST, "hand controlled", "Table A.1", noun="hand"),
    Letter("I", FIRST, "electrical current", "ISA-5.1"),
    Letter("J", FIRST, "power", "ISA-5.1"),
    Letter("K", FIRST, "time", "ISA-5.1 and ISO 3511"),
    Letter("L", FIRST, "level", "Table A.1"),
    Letter("M", FIRST, "moisture", "ISO 3511"),
    Letter("P", FIRST, "pressure", "Table A.1"),
    Letter("Q", FIRST, "quality", "Table A.1"),
    Letter("R", FIRST, "radiation", "ISA-5.1 and ISO 3511"),
    Letter("S", FIRST, "speed", "Table A.1"),
    Letter("T", FIRST, "temperature", "Table A.1"),
    Letter("V", FIRST, "viscosity", "Table A.1"),
    Letter("W", FIRST, "weight", "ISA-5.1 and ISO 3511"),
    Letter("X", FIRST, "unclassified quantity", "ISA-5.1 and ISO 3511"),
    Letter("D", MODIFIER, "difference", "Table A.1"),
    Letter("F", MODIFIER, "fraction (ratio)", "Table A.1"),
    Letter("Q", MODIFIER, "total", "ISA-5.1 and ISO 3511"),
    Letter("S", MODIFIER, "safety (before V and E)", "ISA-5.1"),
    Letter("A", FUNCTION, "alarm", "Table A.1"),
    Letter("C", FUNCTION, "controller", "Table A.1", adjective="controlling"),
    Letter("E", FUNCTION, "sensing element", "ISA-5.1 and ISO 3511"),
    Letter("G", FUNCTION, "gauge", "ISA-5.1"),
    Letter("I", FUNCTION, "indicator", "Table A.1", adjective="indicating"),
    Letter("Q", FUNCTION, "totalizer", "ISO 3511", adjective="totalizing"),
    Letter("R", FUNCTION, "recorder", "ISA-5.1 and ISO 3511", adjective="recording"),
    Letter("S", FUNCTION, "switch", "ISA-5.1 and ISO 3511", adjective="switching"),
    Letter("T", FUNCTION, "transmitter (sensor)", "Table A.1", adjective="transmitting"),
    Letter("V", FUNCTION, "valve", "Table A.1"),
    Letter("Y", FUNCTION, "function (e.g. mathematical)", "Table A.1", adjective="computing"),
    Letter("Z", FUNCTION, "secure control (e.g. interlock)", "Table A.1"),
    Letter("H", LIMIT, "high", "ISA-5.1 and ISO 3511"),
    Letter("L", LIMIT, "low", "ISA-5.1 and ISO 3511"),
)
AT = {(entry.letter, entry.place): entry for entry in LETTERS}
LAST = "EV"  # behind these two, which touch the process, there is no further function
LIMITED = "ASZ"  # what reacts at a limit


@dataclass(frozen=True)
class Tag:
    """What the tag of an instrument says.

    Attributes:
        text: the tag.
        parts: the meaning of each of its letters, in their order.
        loop: number of its loop, None where the tag has none.
        suffix: a letter behind the number, which tells those of one kind in a loop apart, as the valves TV1A and TV1B.
    """

    text: str
    parts: tuple[Letter, ...]
    loop: int | None
    suffix: str = ""

    def at(self, place: str) -> tuple[Letter, ...]:
        """The parts at one kind of place."""
        return tuple(part for part in self.parts if part.place == place)

    @property
    def measured(self) -> str:
        """What is measured or what starts the action, as "flow"."""
        return self.at(FIRST)[0].meaning

    @property
    def modifier(self) -> str:
        """What is made of the measured variable before, as "difference" or "fraction"; empty where nothing is."""
        return "".join(part.noun for part in self.at(MODIFIER))

    @property
    def functions(self) -> tuple[str, ...]:
        """What is done with it, as ("controller",) or ("indicator", "controller")."""
        return tuple(part.noun for part in self.at(FUNCTION))

    @property
    def limit(self) -> str:
        """At which limit it reacts, as "high" or "low-low"; empty where it reacts at none."""
        sides = [[part.noun for part in self.at(LIMIT) if part.letter == letter] for letter in "HL"]
        return " and ".join("-".join(side) for side in sides if side)

    @property
    def words(self) -> str:
        """The tag in words.

        >>> decode("PDT4").words
        'pressure difference transmitter of loop 4'
        """
        *before, last = self.at(FUNCTION)
        valve = last.letter == "V"  # one that is controlled is a control valve
        adjectives = ["control" if valve and part.letter == "C" else part.adjective for part in before]
        phrase = [self.limit, self.at(FIRST)[0].noun, self.modifier, *adjectives, last.noun, self.suffix]
        return " ".join(word for word in phrase if word) + ("" if self.loop is None else f" of loop {self.loop}")

    def __repr__(self) -> str:
        return f"{self.text}: {self.words}"

    def _repr_html_(self):
        rows = [(part.letter, part.place, part.meaning, part.source) for part in self.parts]
        rows += [(digits, "number", "of the loop", "") for digits in re.findall(r"\d+", self.text)]
        rows += [(self.suffix, "suffix", "which one of its kind in the loop", "")] * bool(self.suffix)
        return _table(("", "place", "meaning", "source"), rows, f"{self.text}: {self.words}")


def decode(tag: str) -> Tag:
    """Read the tag of an instrument.

    Arguments:
        tag: its capital letters and then perhaps the number of its loop, as "FC123", "PDT4" or "LT"; a hyphen may
            separate them, and a letter may follow the number.
    Returns:
        A `Tag`, with its ``words``, what is ``measured``, the ``modifier`` of that, the ``functions`` and the number of
        its ``loop``.
    Raises:
        ValueError: for a text of another form, a letter without a meaning where it stands, or a tag without function.
    Source:
        Haugen, Table A.1; letters beyond it from ISA-5.1 and ISO 3511 (`letter_table` says which).

    >>> decode("FC123")
    FC123: flow controller of loop 123
    >>> decode("FFC2").modifier, decode("LAH").limit, decode("LIC").functions
    ('fraction', 'high', ('indicator', 'controller'))
    """
    match = re.fullmatch(r"([A-Z]+)(?:-?([0-9]+)([A-Z]?))?", tag) if isinstance(tag, str) else None
    if not match:
        raise ValueError(f"a tag has capital letters and then perhaps a loop number, as FC123, not {tag!r}")
    letters, number, suffix = match.groups()
    return Tag(tag, tuple(_parts(tag, letters)), int(number) if number else None, suffix or "")


def _parts(tag, letters):
    """The meaning of each letter, by its place."""
    first, rest = letters[0], letters[1:]
    if (first, FIRST) not in AT:
        raise ValueError(f"{tag} begins with {first}, which {_known(first)}: a tag begins with one of {_at(FIRST)}")
    yield AT[first, FIRST]
    if rest and _is_modifier(first, rest):
        yield AT[rest[0], MODIFIER]
        rest = rest[1:]
    functions, limits = re.fullmatch(rf"(.*?)((?:(?<=[{LIMITED}])(?:H+L*|L+))?)", rest).groups()
    if not functions:
        raise ValueError(f"{tag} does not say what is done with what it measures: there must follow {_at(FUNCTION)}")
    for n, letter in enumerate(functions):
        if (letter, FUNCTION) not in AT:
            behind = letters[: len(letters) - len(limits) - len(functions) + n]
            raise ValueError(
                f"{tag} has {letter} behind {behind}, where it means nothing: expected one of {_at(FUNCTION)}"
            )
        if letter in functions[:n]:
            raise ValueError(f"{tag} names the function {letter}, {AT[letter, FUNCTION].noun}, twice")
        if letter in LAST and functions[n + 1 :]:
            raise ValueError(
                f"{tag} goes on behind {letter}, {AT[letter, FUNCTION].noun}, which is the last letter of a tag"
            )
        yield AT[letter, FUNCTION]
    yield from (AT[letter, LIMIT] for letter in limits)


def _is_modifier(first, rest):
    """Whether the letter behind the first one changes what is measured: it does so before a function."""
    if rest[0] == "S":  # elsewhere a switch
        return rest[1:] in ("V", "E")
    is_function = len(rest) == 1 and (rest, FUNCTION) in AT
    return (rest[0], MODIFIER) in AT and not is_function and first not in "HX"


def _known(letter):
    """What a letter means that cannot be the first one."""
    meanings = [entry.noun for entry in LETTERS if entry.letter == letter]
    return f"means {' or '.join(meanings)} only after another letter" if meanings else "has no meaning in a tag"


def _at(place):
    return ", ".join(entry.letter for entry in LETTERS if entry.place == place)


def loops(tags: Iterable[str]) -> dict[int, tuple[Tag, ...]]:
    """Sort tags by their loops: the number of a loop is the same in the tags of all its instruments.

    Arguments:
        tags: tags as `decode` takes them.
    Returns:
        ``{number: tags}``, each of them a `Tag`, in the order in which the numbers first occur.
    Raises:
        ValueError: for a tag without number, or one that `decode` does not accept.

    >>> {number: len(tags) for number, tags in loops(["FT123", "TT124", "FC123"]).items()}
    {123: 2, 124: 1}
    """
    if isinstance(tags, str) or not hasattr(tags, "__iter__"):
        raise ValueError(f"the tags are {tags!r}: expected a list of them, as ['FT123', 'FC123']")
    found = {}
    for tag in map(decode, tags):
        if tag.loop is None:
            raise ValueError(f"{tag.text} has no number, which would say what loop it belongs to")
        found[tag.loop] = (*found.get(tag.loop, ()), tag)
    return found


class LetterTable:
    """The table of the letters, as HTML and as text."""

    head = ("letter", "as first letter", "as subsequent letter")

    def __init__(self, entries: Iterable[Letter]):
        self.entries = tuple(entries)

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """A row for each letter: the letter and its meanings in the two columns."""
        letters = sorted({entry.letter for entry in self.entries})
        return [(letter, *(self._cell(letter, column) for column in self.head[1:])) for letter in letters]

    def _cell(self, letter, column):
        entries = [entry for entry in self.entries if entry.letter == letter and entry.column == column]
        return "; ".join(map(self._meaning, entries))

    def _meaning(self, entry):
        place = f"{entry.place}: " if entry.place in (MODIFIER, LIMIT) else ""
        added = " *" if entry.source != "Table A.1" and len({entry.source for entry in self.entries}) > 1 else ""
        return place + entry.meaning + added

    def __repr__(self) -> str:
        rows = [self.head, *self.rows]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
        return "\n".join(line.rstrip() for line in lines)

    def _repr_html_(self):
        return _table(self.head, self.rows)


def letter_table(source: str | None = None) -> LetterTable:
    """Return the table of the letters, to be shown as the value of a cell.

    Arguments:
        source: "Table A.1" for the textbook's letters alone; without it all, with a star at those that are not in it.
    Returns:
        A table with a row for each letter.
    Raises:
        ValueError: for a source that no letter has.

    >>> print(str(letter_table("Table A.1")).splitlines()[3])
    D       density; modifier: difference
    """
    known = sorted({entry.source for entry in LETTERS})
    if source is not None and source not in known:
        raise ValueError(f"the letters are of {', '.join(known)}, and not of {source!r}")
    return LetterTable(entry for entry in LETTERS if source in (None, entry.source))


def _table(head, rows, caption=""):
    left = 'style="text-align:left"'  # JupyterLab would align to the right
    lines = [f"<p><strong>{html.escape(caption)}</strong></p>"] * bool(caption)
    lines += ["<table>", "<thead><tr>" + "".join(f"<th {left}>{cell}</th>" for cell in head) + "</tr></thead>"]
    lines += [
        "<tr>" + "".join(f"<td {left}>{html.escape(cell, quote=False)}</td>" for cell in row) + "</tr>" for row in rows
    ]
    return "\n".join([*lines, "</table>"])
