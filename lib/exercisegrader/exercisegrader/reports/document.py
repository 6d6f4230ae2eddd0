"""A document as what it says: blocks of texts, each of a type that tells how it is shown and who may have written it.

It is built once; `page` writes it as HTML and `markdown` as Markdown. Nothing in it is markup: both writers show a text
as it is, so that no text of a student, nor one of an instructor, becomes anything but that text. A text is a `str`, an
`Inline`, or a tuple of texts, one behind the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field


class Inline:
    """A part of a line."""


class Block:
    """A part of a page: one block is shown below the other."""


#: Plain words, typed ones, or several of these, one behind the other.
Text = str | Inline | tuple


@dataclass(frozen=True)
class Sentence(Inline):
    """A sentence with formulas between dollar signs."""

    text: str


@dataclass(frozen=True)
class Formula(Inline):
    """A formula in LaTeX; on a line of its own where it is displayed."""

    latex: str
    is_displayed: bool = False


@dataclass(frozen=True)
class Said(Inline):
    """A text that a student may have written, apart from what stands around it: it may run from right to left."""

    text: str


@dataclass(frozen=True)
class Code(Inline):
    """A name, a number or an answer, letter by letter, whoever wrote it."""

    text: str


@dataclass(frozen=True)
class Strong(Inline):
    """What is to be seen first."""

    text: Text


@dataclass(frozen=True)
class Emphasis(Inline):
    """What is stressed."""

    text: Text


@dataclass(frozen=True)
class Quiet(Inline):
    """What may be skipped."""

    text: Text


@dataclass(frozen=True)
class Status(Inline):
    """The status of an answer: its sign, and its word, which says the same."""

    status: str


@dataclass(frozen=True)
class Link(Inline):
    """A link to another file of the folder of the grades.

    Attributes:
        text: where it leads, in words.
        to: the path from the file that holds it; anything else than a path is a ValueError.
    """

    text: Text
    to: str

    def __post_init__(self) -> None:
        if not self.to or self.to[0] in "/\\":
            raise ValueError(f"a link leads to {self.to!r}: expected the path from one file to another")


@dataclass(frozen=True)
class Picture(Inline):
    """A picture, which a page holds and a text only names.

    Attributes:
        content: a PNG file, of `exercisebook.png`.
        alt: what it is, in words.
    """

    content: bytes = field(repr=False)
    alt: str


@dataclass(frozen=True)
class Lines(Inline):
    """Texts of one place, each on a line of its own."""

    texts: tuple[Text, ...]


@dataclass(frozen=True)
class Heading(Block):
    """A heading, of level 2, or of level 3 below one of level 2."""

    text: Text
    level: int = 2


@dataclass(frozen=True)
class Paragraph(Block):
    """A text."""

    text: Text


@dataclass(frozen=True)
class Caution(Block):
    """A text that nobody should miss."""

    text: Text


@dataclass(frozen=True)
class Listing(Block):
    """A list; numbered, or with dots."""

    items: tuple[Text, ...]
    is_numbered: bool = False


@dataclass(frozen=True)
class Table(Block):
    """A table.

    Attributes:
        caption: what is in it, in words.
        head: the names of the columns.
        rows: of as many cells each, else it is a ValueError; the first one names the row.
        counts: the numbers of the columns that hold numbers.
    """

    caption: str
    head: Sequence[Text]
    rows: Sequence[Sequence[Text]]
    counts: frozenset[int] = field(default=frozenset())

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.head):
                raise ValueError(f"a row of the table {self.caption!r} has {len(row)} cells: expected {len(self.head)}")


@dataclass(frozen=True)
class Judged:
    """What became of an answer, as a line of `Verdicts`.

    Attributes:
        status: of the answer.
        name: of the quantity.
        says: why; empty where there is nothing to say.
        below: more, each on a line of its own.
        word: for the status, where its own one does not hold any more.
    """

    status: str
    name: str
    says: Text = ""
    below: tuple[Text, ...] = ()
    word: str = ""


@dataclass(frozen=True)
class Verdicts(Block):
    """What became of the answers to an exercise."""

    answers: tuple[Judged, ...]


@dataclass(frozen=True)
class Histogram(Block):
    """The distribution of the points: triples of lower end, upper end and count."""

    steps: tuple[tuple[float, float, int], ...]


@dataclass(frozen=True)
class Details(Block):
    """Blocks that are folded until somebody asks for them, and printed.

    Attributes:
        summary: what they are.
        blocks: at least one.
    """

    summary: Text
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Document:
    """A document that needs nothing but itself.

    Attributes:
        title: its heading.
        name: the title of its window, in words.
        blocks: what is in it.
    """

    title: Text
    name: str
    blocks: tuple[Block, ...]


def person(name: str, id: str) -> Text:
    """Return a student as a text: the name, and behind it the id."""
    return Said(name), " ", Quiet(f"({id})")
