"""The texts of exercises as HTML: Markdown with formulas, which become MathML.

>>> html("The mass is $m$.")
'<p>The mass is <math><mi>m</mi></math>.</p>'
"""

from __future__ import annotations

import functools
import html as _html
import re
from collections.abc import Callable
from typing import Any

from markdown_it import MarkdownIt

from exercisebook.forms import mathml

#: What a text brings into a page that has headings of its own and leads nowhere else.
_BEYOND = ["autolink", "heading", "image", "lheading", "link", "reference"]


def escaped(text: str) -> str:
    """Return a text as HTML shows it, also as the value of an attribute."""
    return _html.escape(text, quote=True)


def formula(latex: str, display: bool = False) -> str:
    r"""Return a formula as MathML, or as code where it cannot be translated.

    >>> formula(r"\frac{1}{")
    '<code>\\frac{1}{</code>'
    """
    try:
        return mathml.convert(latex, display)
    except ValueError:
        return f"<code>{escaped(latex)}</code>"


def sentence(text: str) -> str:
    """Return a sentence of a response as HTML; what is between two dollars is a formula.

    >>> sentence("the mass $m$ is < 2")
    'the mass <math><mi>m</mi></math> is &lt; 2'
    """
    if text.count("$") % 2:
        return escaped(text)
    return "".join(formula(part) if is_formula else escaped(part) for part, is_formula in mathml.formulas(text))


def html(text: str, bare: bool = False) -> str:
    r"""Return Markdown as HTML. What HTML would take for its own shows as it is.

    Arguments:
        text: Markdown.
        bare: whether headings, links and pictures show as they are typed, too.

    >>> html("$$a\n- b$$")
    '<div class="math block" tabindex="0"><math display="block"><mi>a</mi><mo>−</mo><mi>b</mi></math></div>'
    >>> html("# [a](b.html)", bare=True)
    '<p># [a](b.html)</p>'
    """
    # a line of a formula that begins with a minus begins no list
    text = re.sub(r"\$\$.+?\$\$", lambda found: found[0].replace("\n", " "), text, flags=re.DOTALL)
    return _markdown(bare).render(text).strip()


def inline(text: str) -> str:
    """Return a line of Markdown as HTML, without a paragraph around it.

    >>> inline("the mass, in `kg`")
    'the mass, in <code>kg</code>'
    """
    return _markdown(bare=False).renderInline(text)


@functools.cache
def _markdown(bare: bool) -> Any:
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table").disable(_BEYOND if bare else [])
    markdown.inline.ruler.before("escape", "formula", _read)
    markdown.core.ruler.push("formula_alone", _alone)
    rules: dict[str, Callable[..., str]] = {
        "formula": lambda self, tokens, index, options, env: _written(tokens[index]),
        "table_open": lambda *_: '<div class="table" tabindex="0"><table>\n',
        "table_close": lambda *_: "</table></div>\n",
    }
    for name, rule in rules.items():
        markdown.add_render_rule(name, rule)
    return markdown


def _read(state: Any, silent: bool) -> bool:
    """Read a formula between dollars, single or double ones."""
    if state.src[state.pos] != "$":
        return False
    sign = "$$" if state.src.startswith("$$", state.pos) else "$"
    begin = state.pos + len(sign)
    end = _end(state.src, begin, sign)
    if end <= begin:
        return False
    if not silent:
        token = state.push("formula", "", 0)
        token.content, token.meta = state.src[begin:end], {"display": sign == "$$", "alone": False}
    state.pos = end + len(sign)
    return True


def _end(source, position, sign):
    """Where a formula ends; a dollar within braces ends none. -1 where it does not end."""
    depth = 0
    while position < len(source):
        letter = source[position]
        if letter == "\\":
            position += 1
        elif letter in "{}":
            depth += 1 if letter == "{" else -1
        elif depth == 0 and source.startswith(sign, position):
            return position
        position += 1
    return -1


def _alone(state: Any) -> None:
    """A paragraph that is a formula and nothing else is no paragraph."""
    for before, token, after in zip(state.tokens, state.tokens[1:], state.tokens[2:], strict=False):
        if before.type == "paragraph_open" and token.type == "inline":
            parts = [one for one in token.children if one.type != "softbreak" and one.content.strip()]
            if len(parts) == 1 and parts[0].type == "formula" and parts[0].meta["display"]:
                before.hidden = after.hidden = parts[0].meta["alone"] = True


def _written(token):
    if not token.meta["display"]:
        return formula(token.content)
    # it scrolls within itself where it is too wide, so that it must be reached by keyboard
    tag = "div" if token.meta["alone"] else "span"
    return f'<{tag} class="math block" tabindex="0">{formula(token.content, True)}</{tag}>'
