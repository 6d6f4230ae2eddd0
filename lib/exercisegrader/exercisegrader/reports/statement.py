"""The statement of an exercise, in the Markdown of its author, as blocks of a document.

It knows what statements are made of: paragraphs, lists, tables, formulas, code, and stress. What else Markdown has
(HTML, links, pictures) is shown as it was typed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from exercisegrader.reports.document import (
    Block,
    Code,
    Emphasis,
    Formula,
    Inline,
    Listing,
    Paragraph,
    Strong,
    Table,
    Text,
)

_INLINE = re.compile(
    r"(?P<fence>`+)(?!`)(?P<code>.+?)(?<!`)(?P=fence)(?!`)"
    r"|\$\$(?P<displayed>[^$]+)\$\$|\$(?P<formula>[^$]+)\$"
    r"|\*\*(?P<strong>\S(?:.*?\S)?)\*\*(?!\*)|\*(?P<stressed>[^\s*](?:[^*]*[^\s*])?)\*"
    r"|\\(?P<sign>[!-/:-@\[-`{-~])"
)
#: White space, but for what keeps a number and its unit in one line.
_SPACE = re.compile(r"[^\S\N{NO-BREAK SPACE}]+")
_ITEM = re.compile(r"(?:[-*+]|(?P<number>\d{1,9}[.)]))(?:\s+|$)")
#: What begins a list below a line of text; another number than 1 is one of the text.
_FIRST = re.compile(r"(?:[-*+]|1[.)])\s+")
_RULE = re.compile(r"\|?\s*:?-+:?\s*(?:\|\s*:?-+:?\s*)*\|?")


def blocks(markdown: str) -> tuple[Block, ...]:
    """Return the blocks of a statement.

    >>> blocks("The gain is $K$.\\n\\n- `Kp`: the gain\\n- `Ti`: the *integral*\\n  time")[1].items[1]
    (Code(text='Ti'), ': the ', Emphasis(text=('integral',)), ' time')
    """
    return tuple(_found(markdown.expandtabs(4).splitlines()))


def text(markdown: str) -> Text:
    """Return a line of a statement as text.

    >>> text("a *lag* with $T < 4$ s, `a*b*c`")
    ('a ', Emphasis(text=('lag',)), ' with ', Formula(latex='T < 4', is_displayed=False), ' s, ', Code(text='a*b*c'))
    """
    return tuple(_pieces(_SPACE.sub(" ", markdown.strip())))


def _pieces(line: str) -> Iterator[str | Inline]:
    end = 0
    for match in _INLINE.finditer(line):
        if between := line[end : match.start()]:
            yield between
        end = match.end()
        kind = match.lastgroup
        inside = match[kind]
        if kind == "code":
            yield Code(inside.strip())
        elif kind in ("formula", "displayed"):
            yield Formula(inside.strip(), kind == "displayed")
        elif kind == "sign":
            yield inside
        else:
            yield (Strong if kind == "strong" else Emphasis)(tuple(_pieces(inside)))
    if rest := line[end:]:
        yield rest


def _found(lines):
    while lines:
        if not lines[0].strip():
            lines = lines[1:]
        elif len(lines) > 1 and "|" in lines[0] and "|" in lines[1] and _RULE.fullmatch(lines[1].strip()):
            rows, lines = _taken(lines, lambda line: "|" in line)
            yield _table([rows[0], *rows[2:]])
        elif match := _ITEM.match(lines[0].lstrip()):
            rows, lines = _taken(lines, str.strip)
            yield Listing(tuple(map(text, _items(rows))), is_numbered=bool(match["number"]))
        else:
            rows, lines = _taken(lines, lambda line: line.strip() and not _FIRST.match(line.lstrip()))
            yield Paragraph(text(" ".join(rows)))


def _taken(lines, belongs):
    """The lines at the beginning that belong together, and the rest."""
    count = next((place for place, line in enumerate(lines) if not belongs(line)), len(lines))
    return lines[:count], lines[count:]


def _items(lines):
    """The items of a list, each as one line."""
    items = []
    for line in map(str.strip, lines):
        if match := _ITEM.match(line):
            items.append(line[match.end() :])
        else:
            items[-1] += f" {line}"
    return items


def _table(lines):
    rows = [[text(cell) for cell in _cells(line)] for line in lines]
    width = max(map(len, rows))
    head, *others = [row + [""] * (width - len(row)) for row in rows]
    return Table("Table of the statement", head, others)


def _cells(line):
    """The cells of a row; a bar behind a backslash is one, and no end."""
    line = line.strip().removeprefix("|")
    cells = re.split(r"(?<!\\)\|", line.removesuffix("|") if not line.endswith("\\|") else line)
    return [cell.strip().replace("\\|", "|") for cell in cells]
