"""Documents as HTML: pages that need nothing but themselves, with formulas as MathML."""

from __future__ import annotations

import base64
import functools
import html
import urllib.parse
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable

from exercisebook import png
from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WAITING, WRONG
from exercisebook.response import MARKS
from exercisegrader.reports import document as of
from exercisegrader.reports.histogram import histogram_svg, histogram_words
from exercisegrader.reports.wording import parts, spaced, visible

#: The colours of the statuses on a dark ground; those on a light one are the response's.
ON_DARK = {
    RIGHT: "#5fd3ae",
    MISTAKE: "#e8b04a",
    WRONG: "#ff9a6b",
    UNJUDGED: "#b8b8b8",
    OPEN: "#b8b8b8",
    WAITING: "#a3b4ff",
}

_TAGS = {
    "math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub", "msup", "msubsup",
    "mover", "munder", "munderover", "mtable", "mtr", "mtd", "mstyle", "mpadded", "mphantom", "menclose",
}  # fmt: skip
_ATTRIBUTES = {
    "display", "stretchy", "fence", "form", "mathvariant", "displaystyle", "scriptlevel", "linebreak",
    "linethickness", "width", "columnalign", "minsize", "maxsize", "lspace", "rspace", "accent", "accentunder",
    "movablelimits", "notation",
}  # fmt: skip

#: Nothing runs and nothing is fetched; pictures are in the page itself.
_ALLOWED = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"

_STYLE = """
:root { color-scheme: light dark; --ink: #1a1a1a; --ground: #ffffff; --quiet: #555555; --line: #cccccc; --box: #f4f4f4;
  --link: #0b5394;
  LIGHT }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e8; --ground: #161616; --quiet: #b0b0b0; --line: #4a4a4a; --box: #222222;
    --link: #8ab8ff;
    DARK }
}
body { margin: 0; color: var(--ink); background: var(--ground); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 50rem; margin: 0 auto; padding: 1rem 1.25rem 3rem; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0.5rem 0; }
h2 { font-size: 1.15rem; margin: 2rem 0 0.5rem; }
h3 { font-size: 1rem; margin: 1.5rem 0 0.25rem; }
a { color: var(--link); }
code { font-family: ui-monospace, monospace; font-size: 0.95em; }
.quiet { color: var(--quiet); font-weight: normal; }
.warning { border: 2px solid var(--wrong); padding: 0.4rem 0.8rem; font-weight: bold; }
.verdicts { list-style: none; margin: 0; padding: 0; }
.verdicts li { border-left: 0.3rem solid var(--colour); background: var(--box); }
.verdicts li { margin: 0.4rem 0; padding: 0.4rem 0.8rem; }
.status { color: var(--colour); font-weight: bold; white-space: nowrap; }
.answer { color: var(--quiet); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: 0.5rem 0; overflow-wrap: normal; }
th, td { border-bottom: 1px solid var(--line); padding: 0.25rem 1rem 0.25rem 0; text-align: left; vertical-align: top; }
.count { text-align: right; white-space: nowrap; }
details { margin: 0.5rem 0; border-left: 0.3rem solid var(--line); padding: 0 0.8rem; }
summary { cursor: pointer; color: var(--quiet); }
svg, img { max-width: 100%; height: auto; }
img { display: block; background: #ffffff; margin: 0.4rem 0; }
@media print {
  main { max-width: none; padding: 0; }
  h2 { break-after: avoid; }
  li, tr, svg, img { break-inside: avoid; }
  details::details-content { content-visibility: visible; }
}
"""


def written(document: of.Document) -> str:
    """Return a document as a page."""
    body = [f"<h1>{inline(document.title)}</h1>", *(line for one in document.blocks for line in block(one))]
    return page(document.name, body)


def page(title: str, body: Iterable[str]) -> str:
    """Return a whole page; it asks the browser to run nothing and to fetch nothing.

    Arguments:
        title: in words.
        body: lines of HTML.
    """
    colours = {status: colour for status, (_, colour) in MARKS.items()}
    style = _STYLE.replace("LIGHT", _variables(colours)).replace("DARK", _variables(ON_DARK))
    style += "".join(f".{_class(status)} {{ --colour: var(--{_class(status)}); }}\n" for status in MARKS)
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en">',
        "<head>",
        '<meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<meta http-equiv="Content-Security-Policy" content="{_ALLOWED}">',
        f"<title>{escaped(title)}</title>",
        f"<style>{style}</style>",
        "</head>",
        "<body>",
        "<main>",
        *body,
        "</main>",
        "</body>",
        "</html>",
    ]
    return "\n".join(lines) + "\n"


def _variables(colours):
    return " ".join(f"--{_class(status)}: {colour};" for status, colour in colours.items())


def _class(status):
    return status.replace(" ", "-")


@functools.singledispatch
def block(block: of.Block) -> list[str]:
    """Return a block as lines of HTML; each kind of block registers how."""
    raise TypeError(f"{block!r:.80} is no block of a document")


@block.register
def _(heading: of.Heading) -> list[str]:
    return [f"<h{heading.level}>{inline(heading.text)}</h{heading.level}>"]


@block.register
def _(paragraph: of.Paragraph) -> list[str]:
    return [f"<p>{inline(paragraph.text)}</p>"]


@block.register
def _(caution: of.Caution) -> list[str]:
    return [f'<p class="warning">{inline(caution.text)}</p>']


@block.register
def _(listing: of.Listing) -> list[str]:
    kind = "ol" if listing.is_numbered else "ul"
    return [f"<{kind}>", *(f"<li>{inline(item)}</li>" for item in listing.items), f"</{kind}>"]


@block.register
def _(table: of.Table) -> list[str]:
    kind = {place: ' class="count"' for place in table.counts}
    heads = "".join(
        f'<th scope="col"{kind.get(place, "")}>{inline(name)}</th>' for place, name in enumerate(table.head)
    )
    lines = [f'<div class="wide" role="region" tabindex="0" aria-label="{escaped(table.caption)}">', "<table>"]
    lines += [f"<thead><tr>{heads}</tr></thead>", "<tbody>"]
    for first, *others in table.rows:
        cells = "".join(f"<td{kind.get(place, '')}>{inline(cell)}</td>" for place, cell in enumerate(others, 1))
        lines.append(f'<tr><th scope="row" class="quiet">{inline(first)}</th>{cells}</tr>')
    return [*lines, "</tbody>", "</table>", "</div>"]


@block.register
def _(verdicts: of.Verdicts) -> list[str]:
    return ['<ul class="verdicts">', *map(_judged, verdicts.answers), "</ul>"]


def _judged(one):
    line = _marked(one.status, f"{inline(of.Code(one.name))} ", one.word) + (
        f": {inline(one.says)}" if one.says else ""
    )
    line += "".join(f'<div class="answer">{inline(text)}</div>' for text in one.below)
    return f'<li class="{_class(one.status)}">{line}</li>'


@block.register
def _(histogram: of.Histogram) -> list[str]:
    return [histogram_svg(histogram.steps, histogram_words(histogram.steps))]


@block.register
def _(details: of.Details) -> list[str]:
    blocks = [line for one in details.blocks for line in block(one)]
    return [f"<details><summary>{inline(details.summary)}</summary>", *blocks, "</details>"]


@functools.singledispatch
def inline(text: of.Text) -> str:
    """Return a text as HTML; each kind of text registers how.

    >>> inline(("<b> & ", of.Strong(("so ", of.Said("x"))), of.Link("page", "feedback/a b/x.html")))
    '&lt;b&gt; &amp; <strong>so <bdi>x</bdi></strong><a href="feedback/a%20b/x.html">page</a>'
    """
    raise TypeError(f"{text!r:.80} is no text of a document")


@inline.register
def _(text: str) -> str:
    return html.escape(spaced(text))


@inline.register
def _(texts: tuple) -> str:
    return "".join(map(inline, texts))


@inline.register
def _(said: of.Sentence) -> str:
    return sentence(said.text)


@inline.register
def _(formula: of.Formula) -> str:
    return _formula(visible(formula.latex), "block" if formula.is_displayed else "inline")


@inline.register
def _(said: of.Said) -> str:
    return f"<bdi>{escaped(said.text)}</bdi>"


@inline.register
def _(code: of.Code) -> str:
    inside = escaped(code.text)
    return f"<code>{inside if inside.isascii() else f'<bdi>{inside}</bdi>'}</code>"


@inline.register
def _(strong: of.Strong) -> str:
    return f"<strong>{inline(strong.text)}</strong>"


@inline.register
def _(emphasis: of.Emphasis) -> str:
    return f"<em>{inline(emphasis.text)}</em>"


@inline.register
def _(quiet: of.Quiet) -> str:
    return f'<span class="quiet">{inline(quiet.text)}</span>'


@inline.register
def _(status: of.Status) -> str:
    return _marked(status.status)


@inline.register
def _(link: of.Link) -> str:
    return f'<a href="{html.escape(urllib.parse.quote(link.to))}">{inline(link.text)}</a>'


@inline.register
def _(picture: of.Picture) -> str:
    width, height = png.size(picture.content)
    data = base64.b64encode(picture.content).decode()
    shape = f'width="{width}" height="{height}"'
    return f'<img src="data:image/png;base64,{data}" {shape} alt="{escaped(picture.alt)}">'


@inline.register
def _(lines: of.Lines) -> str:
    return "<br>".join(map(inline, lines.texts))


def _marked(status, between="", word=""):
    """The sign of a status, some HTML, and its word or another one."""
    sign, kind = MARKS[status][0], f"status {_class(status)}"
    return (
        f'<span class="{kind}" aria-hidden="true">{sign}</span> {between}<span class="{kind}">{word or status}</span>'
    )


def escaped(text: str) -> str:
    """Return a text as HTML shows it as it is.

    >>> escaped("<b>&amp;")
    '&lt;b&gt;&amp;amp;'
    """
    return html.escape(visible(text))


def sentence(text: str) -> str:
    """Return a sentence as HTML, with its formulas between dollar signs as MathML.

    >>> sentence("here $c$ is < 4")
    'here <math display="inline"><mrow><mi>c</mi></mrow></math> is &lt; 4'
    """
    return "".join(_formula(piece) if place % 2 else html.escape(piece) for place, piece in enumerate(parts(text)))


@functools.lru_cache(maxsize=4096)
def _formula(latex, display="inline"):
    """A formula as MathML, or as code where it cannot be read.

    The converter does not escape what stands in a text of the formula, and hands on links and styles: what is not
    MathML is refused, and other attributes are dropped.
    """
    from latex2mathml.converter import convert

    try:
        tree = ElementTree.fromstring(convert(latex, display=display))
    except Exception:  # its errors have no common class
        return f"<code>{escaped(latex)}</code>"
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]
        if element.tag not in _TAGS:
            return f"<code>{escaped(latex)}</code>"
        for name in set(element.attrib) - _ATTRIBUTES:
            del element.attrib[name]
    return ElementTree.tostring(tree, encoding="unicode")
