"""Pages that need nothing but themselves, written by the templates beside this module.

What a template is told is text, whoever wrote it: it is escaped, in one line, with all that cannot be seen spelled out.
HTML is only what a template holds, and what the functions of this module return.
"""

from __future__ import annotations

import base64
from pathlib import Path
from typing import TYPE_CHECKING

import jinja2
from markupsafe import Markup, escape

from exercisebook import png
from exercisebook.forms import text as of_forms
from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WAITING, WRONG
from exercisebook.response import MARKS
from exercisegrader.reports import wording

if TYPE_CHECKING:
    from exercisegrader.inside.plain import Plain

#: The colours of the statuses on a dark ground; those on a light one are the response's.
ON_DARK = {
    RIGHT: "#5fd3ae",
    MISTAKE: "#e8b04a",
    WRONG: "#ff9a6b",
    UNJUDGED: "#b8b8b8",
    OPEN: "#b8b8b8",
    WAITING: "#a3b4ff",
}


def page(template: str, window: str, **told: object) -> str:
    """Return a page.

    Arguments:
        template: its name.
        window: the title of the window, in words.
        told: what the template asks for, by name.
    """
    return _TEMPLATES.get_template(template).render(told, window=window)


def line(*texts: object) -> Markup:
    """Return texts and pieces of HTML, one behind the other, as HTML.

    >>> line("<b> & ", said("x"), " ", code("K"))
    Markup('&lt;b&gt; &amp; <bdi>x</bdi> <code>K</code>')
    """
    return Markup("").join(map(_shown, texts))


def lines(*texts: object) -> Markup:
    """Return texts of one place, each on a line of its own."""
    return Markup("<br>").join(map(_shown, texts))


def said(text: str) -> Markup:
    """Return a text that a student may have written, apart from what is beside it: it may run from right to left."""
    return Markup("<bdi>{}</bdi>").format(wording.visible(text))


def code(text: str) -> Markup:
    """Return a name, a number or an answer, letter by letter, whoever wrote it."""
    shown = wording.visible(text)
    return Markup("<code>{}</code>").format(shown if shown.isascii() else said(shown))


def sentence(text: str) -> Markup:
    """Return a sentence with its formulas between dollar signs.

    >>> sentence("here $c$ is < 4")
    Markup('here <math><mi>c</mi></math> is &lt; 4')
    """
    return Markup(of_forms.sentence(wording.spaced(text)))


def statement(markdown: str) -> Markup:
    """Return the statement of an exercise; of its Markdown, HTML, headings, links and pictures show as they are typed.

    >>> statement("A lag of $T$.")
    Markup('<p>A lag of <math><mi>T</mi></math>.</p>')
    """
    return Markup(of_forms.html(wording.spelled_out(markdown.expandtabs(4), but="\n\N{NO-BREAK SPACE}"), bare=True))


def several_lines(text: str) -> Markup:
    """Return a text with its lines, as it is to be seen in an element that keeps these."""
    return escape(wording.spelled_out(text.replace("\r\n", "\n"), but="\n\t"))


def picture(content: bytes, alt: str) -> Markup:
    """Return a picture, which the page itself holds.

    Arguments:
        content: a PNG file, of `exercisebook.png`.
        alt: what it is, in words.
    """
    image = Markup('<img src="data:image/png;base64,{}" width="{}" height="{}" alt="{}">')
    return image.format(base64.b64encode(content).decode(), *png.size(content), wording.visible(alt))


def handed_in(answer: Plain, name: str) -> Markup:
    """Return what a person marks, as it was handed in: a figure, or a text with its lines."""
    if png.is_data(answer):
        return picture(png.checked(answer), f"the figure that was handed in for {name}")
    return lines(*(said(one) for one in str(answer).splitlines() if one.strip()))


def _shown(value: object) -> str:
    return value if isinstance(value, Markup) else wording.spaced(str(value))


_TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
    autoescape=True,
    finalize=_shown,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)
_FILTERS = (
    said, code, sentence, statement, several_lines, handed_in, wording.number, wording.percent, wording.visible,
)  # fmt: skip
_TEMPLATES.filters |= {function.__name__: function for function in _FILTERS}
_TEMPLATES.globals |= {
    "marks_of": MARKS,
    "on_dark": ON_DARK,
    "no_jail": wording.NO_JAIL,
    "of_points": wording.of_points,
    "counted": wording.counted,
}
