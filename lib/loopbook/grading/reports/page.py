"""The frame of an HTML page that needs nothing but itself: style, texts of students, formulas as MathML."""

from __future__ import annotations

import functools
import html
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Sequence

from loopbook.exercises.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG
from loopbook.exercises.response import MARKS
from loopbook.grading.reports.wording import parts, visible

#: The colours of the statuses on a dark ground; those on a light one are the response's.
ON_DARK = {RIGHT: "#5fd3ae", MISTAKE: "#e8b04a", WRONG: "#ff9a6b", UNJUDGED: "#b8b8b8", OPEN: "#b8b8b8"}

_TAGS = {
    "math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub", "msup", "msubsup",
    "mover", "munder", "munderover", "mtable", "mtr", "mtd", "mstyle", "mpadded", "mphantom", "menclose",
}  # fmt: skip
_ATTRIBUTES = {
    "display", "stretchy", "fence", "form", "mathvariant", "displaystyle", "scriptlevel", "linebreak",
    "linethickness", "width", "columnalign", "minsize", "maxsize", "lspace", "rspace", "accent", "accentunder",
    "movablelimits", "notation",
}  # fmt: skip

_STYLE = """
:root { color-scheme: light dark; --ink: #1a1a1a; --ground: #ffffff; --quiet: #555555; --line: #cccccc; --box: #f4f4f4;
  LIGHT }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e8; --ground: #161616; --quiet: #b0b0b0; --line: #4a4a4a; --box: #222222;
    DARK }
}
body { margin: 0; color: var(--ink); background: var(--ground); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 50rem; margin: 0 auto; padding: 1rem 1.25rem 3rem; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0.5rem 0; }
h2 { font-size: 1.15rem; margin: 2rem 0 0.5rem; }
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
svg { max-width: 100%; height: auto; }
@media print {
  main { max-width: none; padding: 0; }
  h2 { break-after: avoid; }
  li, tr, svg { break-inside: avoid; }
}
"""


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
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">",
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


def marked(status: str, between: str = "") -> str:
    """Return a status as HTML: its sign, and its word, which says the same.

    Arguments:
        status: of a verdict.
        between: HTML between the two.
    """
    sign, kind = MARKS[status][0], f"status {_class(status)}"
    return f'<span class="{kind}" aria-hidden="true">{sign}</span> {between}<span class="{kind}">{status}</span>'


def listed(verdicts: Iterable[tuple[str, str]]) -> list[str]:
    """Return a list of pairs of a status and its line of HTML."""
    items = (f'<li class="{_class(status)}">{line}</li>' for status, line in verdicts)
    return ['<ul class="verdicts">', *items, "</ul>"]


def table(caption: str, head: Iterable[str], rows: Iterable[Sequence[str]], counts: Iterable[int] = ()) -> list[str]:
    """Return a table; its cells are HTML.

    Arguments:
        caption: what is in it.
        head: the columns' names.
        rows: of as many cells each; the first one names the row.
        counts: the numbers of the columns that hold numbers.
    """
    kind = {place: ' class="count"' for place in counts}
    heads = "".join(f'<th scope="col"{kind.get(place, "")}>{name}</th>' for place, name in enumerate(head))
    lines = ['<div class="wide" role="region" tabindex="0" aria-label="' + escaped(caption) + '">', "<table>"]
    lines += [f"<thead><tr>{heads}</tr></thead>", "<tbody>"]
    for first, *others in rows:
        cells = "".join(f"<td{kind.get(place, '')}>{cell}</td>" for place, cell in enumerate(others, 1))
        lines.append(f'<tr><th scope="row" class="quiet">{first}</th>{cells}</tr>')
    return [*lines, "</tbody>", "</table>", "</div>"]


def escaped(text: str) -> str:
    """Return a text as HTML shows it as it is.

    >>> escaped("<b>&amp;")
    '&lt;b&gt;&amp;amp;'
    """
    return html.escape(visible(text))


def of_student(text: str) -> str:
    """Return a text of a student, which may run from right to left, apart from what stands around it."""
    return f"<bdi>{escaped(text)}</bdi>"


def sentence(text: str) -> str:
    """Return a sentence as HTML, with its formulas between dollar signs as MathML.

    >>> sentence("here $c$ is < 4")
    'here <math display="inline"><mrow><mi>c</mi></mrow></math> is &lt; 4'
    """
    return "".join(_formula(piece) if place % 2 else html.escape(piece) for place, piece in enumerate(parts(text)))


@functools.lru_cache(maxsize=4096)
def _formula(latex):
    """A formula as MathML, or as code where it cannot be read.

    The converter does not escape what stands in a text of the formula, and hands on links and styles: what is not
    MathML is refused, and other attributes are dropped.
    """
    from latex2mathml.converter import convert

    try:
        tree = ElementTree.fromstring(convert(latex))
    except Exception:  # its errors have no common class
        return f"<code>{escaped(latex)}</code>"
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]
        if element.tag not in _TAGS:
            return f"<code>{escaped(latex)}</code>"
        for name in set(element.attrib) - _ATTRIBUTES:
            del element.attrib[name]
    return ElementTree.tostring(tree, encoding="unicode")
