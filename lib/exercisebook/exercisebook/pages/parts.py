"""The text of a page by its parts: a title, the statement, and sections with tables, lists and lines of formulas."""

from __future__ import annotations

import functools
import itertools
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from plainmath.validation import did_you_mean

SECTIONS = ("Given", "Formulas", "Asked", "Mistakes", "Hints", "Solution", "Insight", "Check")
_HEADING = re.compile(r"(\S+)\s+(.+)\s+\(([\d.]+) points?\)")
_BULLET = re.compile(r"\s*(?:[-*]|\d+[.)])\s+")


class PageError(ValueError):
    """What is wrong in a page, with its file and line."""

    def __init__(self, file: str, line: int, says: str):
        super().__init__(f"{file}:{line}: {says}")


@dataclass(frozen=True)
class Part:
    """A part of a page.

    Attributes:
        file: of the page, for errors.
        line: its first one, from 1.
        source: its Markdown.
    """

    file: str
    line: int
    source: str

    @property
    def text(self) -> str:
        """The Markdown without empty lines around it."""
        return self.source.strip()

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the rows of its tables: the line, and the texts of the cells."""
        cells: list[str] | None = None
        for token in _tokens(self.source):
            if token.type == "tbody_open":
                cells = []
            elif token.type == "tbody_close":
                cells = None
            elif cells is not None and token.type == "tr_open":
                cells, line = [], token.map[0]
            elif cells is not None and token.type == "inline":
                cells.append(token.content.strip("` "))
            elif cells is not None and token.type == "tr_close":
                yield self.line + line, cells

    def lines(self) -> Iterator[tuple[int, str, int]]:
        """Yield the formulas of its blocks of code, without what follows #, each with its lines.

        A line that is indented belongs to that above.

        Returns:
            The first line, the text, and the last line.
        """
        for token in _tokens(self.source):
            if token.type != "fence":
                continue
            found: list[tuple[int, str, int]] = []
            for number, line in enumerate(token.content.splitlines(), self.line + token.map[0] + 1):
                text = re.sub(r"(^|\s)#.*", "", line).rstrip()
                if found and text.startswith(" "):
                    found[-1] = (found[-1][0], f"{found[-1][1]} {text.strip()}", number)
                elif text:
                    found.append((number, text, number))
            yield from found

    def items(self) -> Iterator[tuple[int, str]]:
        """Yield the items of its lists, each with its line and without its mark."""
        lines = self.source.splitlines()
        for token in _tokens(self.source):
            if token.type == "list_item_open" and token.level == 1:
                first, last = token.map
                text = "\n".join(lines[first:last])
                yield (
                    self.line + first,
                    "\n".join(line.strip() for line in _BULLET.sub("", text, 1).splitlines()).strip(),
                )


@dataclass(frozen=True)
class PageText:
    """A page by its parts.

    Attributes:
        number, title, points: from its heading, as "# 10.1 A model by ruler (2 points)".
        statement: what is above the sections.
        sections: {name: part}.
    """

    file: str
    line: int
    number: str
    title: str
    points: float
    statement: Part
    sections: dict[str, Part]

    def section(self, name: str) -> Part:
        """Return a section; an empty one where the page has none of this name."""
        return self.sections.get(name, Part(self.file, self.line, ""))


@dataclass(frozen=True)
class Front:
    """The text above the first page of a file, where pages are an assignment.

    Attributes:
        title, introduction: of the assignment.
        settings: the values of its block of TOML.
    """

    title: str
    introduction: str
    settings: dict[str, Any]


def read(source: str, file: str) -> tuple[Front | None, list[PageText]]:
    """Return the front of a text of pages, if it has one, and the pages, each with a heading of its own.

    Raises `PageError` for what is no page.
    """
    lines, tokens = source.splitlines(), _tokens(source)
    headings = [
        (token.map[0], token.tag, following.content)
        for token, following in itertools.pairwise(tokens)
        if token.type == "heading_open" and token.tag in ("h1", "h2")
    ]
    if not headings or headings[0][1] != "h1":
        raise PageError(file, 1, "there is no heading: expected '# 10.1 A model by ruler (2 points)'")
    ends = [place for place, *_ in headings[1:]] + [len(lines)]
    front, found = None, []
    has_front = [tag for _, tag, _ in headings[:2]] == ["h1", "h1"] and not _HEADING.fullmatch(headings[0][2])
    for (place, tag, words), end in zip(headings, ends, strict=True):
        part = Part(file, place + 2, "\n".join(lines[place + 1 : end]))
        if has_front and place == headings[0][0]:
            front = _front(words, part)
        elif tag == "h1":
            found.append(_begun(file, place + 1, words, part))
        elif words not in SECTIONS:
            raise PageError(file, place + 1, f"there is no section {words!r}: {did_you_mean(words, SECTIONS)}")
        elif words in found[-1].sections:
            raise PageError(file, place + 1, f"there are two sections {words}: expected one")
        else:
            found[-1].sections[words] = part
    return front, found


def _front(title, part):
    blocks = [token for token in _tokens(part.source) if token.type == "fence" and token.info.strip() == "toml"]
    lines, settings = part.source.splitlines(), {}
    for block in reversed(blocks):
        first, last = block.map
        del lines[first:last]
        try:
            settings |= tomllib.loads(block.content)
        except tomllib.TOMLDecodeError as error:
            raise PageError(part.file, part.line + first, f"this is not TOML, {error}") from None
    return Front(title, "\n".join(lines).strip(), settings)


def _begun(file, line, words, part):
    """A page with its heading and statement, still without sections."""
    heading = _HEADING.fullmatch(words)
    if not heading:
        says = f"the heading is {words!r}: expected number, title and points, as '10.1 A model by ruler (2 points)'"
        raise PageError(file, line, says)
    if not part.text:
        raise PageError(file, line, f"exercise {heading[1]} has no statement: expected one below its heading")
    points = float(heading[3])
    return PageText(file, line, heading[1], heading[2], int(points) if points.is_integer() else points, part, {})


@functools.lru_cache(maxsize=256)
def _tokens(source) -> list[Any]:
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark").enable("table").parse(source)
