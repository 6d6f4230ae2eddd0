"""Documents as Markdown, in which every text shows as it is."""

from __future__ import annotations

import functools
import re
import urllib.parse

from exercisebook.response import MARKS
from exercisegrader.reports import document as of
from exercisegrader.reports.histogram import histogram_text
from exercisegrader.reports.wording import parts, spaced, visible

#: What Markdown would take for more than text, wherever it stands: signs, and parts of addresses.
_SIGN = re.compile(r"[\\`*_{}\[\]<>#|~$&^@]|:(?=//)|^/|^\.(?=\w)|(?<=www)\.")
#: What begins a list or underlines a heading, at the beginning of a line.
_BEGINNING = re.compile(r"^(?=[-+=])|(?<=^)(\d{1,9})(?=[.)])")


def written(document: of.Document) -> str:
    """Return a document as Markdown."""
    lines = [f"# {_line(document.title)}", ""]
    return "\n".join([*lines, *(line for one in document.blocks for line in block(one))])


@functools.singledispatch
def block(block: of.Block) -> list[str]:
    """Return a block as lines of Markdown, the last of them empty; each kind of block registers how."""
    raise TypeError(f"{block!r:.80} is no block of a document")


@block.register
def _(heading: of.Heading) -> list[str]:
    return [f"{'#' * heading.level} {_line(heading.text)}", ""]


@block.register
def _(paragraph: of.Paragraph) -> list[str]:
    return [_line(paragraph.text), ""]


@block.register
def _(caution: of.Caution) -> list[str]:
    return [f"**{_line(caution.text)}**", ""]


@block.register
def _(listing: of.Listing) -> list[str]:
    signs = (f"{place}." if listing.is_numbered else "-" for place in range(1, len(listing.items) + 1))
    return [*(f"{sign} {_line(item)}" for sign, item in zip(signs, listing.items, strict=True)), ""]


@block.register
def _(table: of.Table) -> list[str]:
    rows = [[inline(cell, in_table=True).strip() for cell in row] for row in (table.head, *table.rows)]
    head, *others = ["| " + " | ".join(row) + " |" for row in [rows[0], ["---"] * len(table.head), *rows[1:]]]
    return [head, *others, ""]


@block.register
def _(verdicts: of.Verdicts) -> list[str]:
    lines = []
    for one in verdicts.answers:
        says = f": {inline(one.says)}" if one.says else ""
        lines.append(f"- {MARKS[one.status][0]} {inline(of.Code(one.name))} **{one.word or one.status}**{says}")
        lines += [f"  - {_line(text)}" for text in one.below]
    return [*lines, ""]


@block.register
def _(histogram: of.Histogram) -> list[str]:
    return ["```text", *histogram_text(histogram.steps), "```", ""]


@block.register
def _(details: of.Details) -> list[str]:
    blocks = [line for one in details.blocks for line in block(one)]
    lines = [f"**{_line(details.summary)}**", "", *blocks[:-1]]
    return [*(f"> {line}".rstrip() for line in lines), ""]


@functools.singledispatch
def inline(text: of.Text, in_table: bool = False) -> str:
    """Return a text as Markdown, in a cell of a table or elsewhere; each kind of text registers how.

    >>> print(inline(("<b> & ", of.Strong(("so ", of.Said("*x*"))), of.Link("page", "feedback/a b/x.html"))))
    \\<b\\> \\& **so \\*x\\***[page](feedback/a%20b/x.html)
    """
    raise TypeError(f"{text!r:.80} is no text of a document")


@inline.register
def _(text: str, in_table: bool = False) -> str:
    return _SIGN.sub(r"\\\g<0>", spaced(text))


@inline.register
def _(texts: tuple, in_table: bool = False) -> str:
    return "".join(inline(text, in_table) for text in texts)


@inline.register
def _(sentence: of.Sentence, in_table: bool = False) -> str:
    pieces = parts(sentence.text)
    return "".join(inline(of.Formula(one) if place % 2 else one, in_table) for place, one in enumerate(pieces))


@inline.register
def _(formula: of.Formula, in_table: bool = False) -> str:
    written = {"<": r"\lt ", ">": r"\gt "} | ({"|": r"\vert "} if in_table else {})
    latex = re.sub(r"([<>|]) ?", lambda sign: written.get(sign[1], sign[0]), visible(formula.latex))
    sign = "$$" if formula.is_displayed and not in_table else "$"
    return f"{sign}{latex}{sign}"


@inline.register
def _(said: of.Said, in_table: bool = False) -> str:
    return inline(visible(said.text))


@inline.register
def _(code: of.Code, in_table: bool = False) -> str:
    line = visible(code.text)
    if not line:
        return ""
    fence = "`" * (1 + max((len(run) for run in re.findall("`+", line)), default=0))
    room = " " if line.startswith("`") or line.endswith("`") else ""
    text = f"{fence}{room}{line}{room}{fence}"
    return text.replace("|", "\\|") if in_table else text


@inline.register
def _(strong: of.Strong, in_table: bool = False) -> str:
    return _around("**", inline(strong.text, in_table))


@inline.register
def _(emphasis: of.Emphasis, in_table: bool = False) -> str:
    return _around("*", inline(emphasis.text, in_table))


@inline.register
def _(quiet: of.Quiet, in_table: bool = False) -> str:
    return inline(quiet.text, in_table)


@inline.register
def _(status: of.Status, in_table: bool = False) -> str:
    return status.status


@inline.register
def _(link: of.Link, in_table: bool = False) -> str:
    return f"[{inline(link.text, in_table)}]({urllib.parse.quote(link.to)})"


@inline.register
def _(picture: of.Picture, in_table: bool = False) -> str:
    return inline(f"{picture.alt} (a picture, on the page)")


@inline.register
def _(lines: of.Lines, in_table: bool = False) -> str:
    return "; ".join(inline(text, in_table) for text in lines.texts)


def _around(sign, text):
    """Signs of stress around a text, which neither begins nor ends with a space inside of them."""
    inside = text.strip()
    return text.replace(inside, f"{sign}{inside}{sign}", 1) if inside else text


def _line(text):
    """A text as a line of its own, which begins no list and underlines nothing."""
    return _BEGINNING.sub(lambda found: f"{found[1] or ''}\\", inline(text).strip())
