"""Pages that load little: code has few elements, and figures are fetched when the reader comes near them.

Names, punctuation and operators look as the text around them does. With an element each they were half of a chapter's
page, and the three around each function that a section names a tenth.
"""

import re

from docutils import nodes
from pygments.formatters import HtmlFormatter
from pygments.token import Name, Operator, Punctuation, Text, Whitespace
from sphinx.highlighting import PygmentsBridge

UNCOLOURED = {Name, Operator, Punctuation, Whitespace}
LINKED = re.compile(r' title="[\w.]+"><code class="xref py py-obj[^>]*><span class="pre">([^<]*)</span></code>')
#: What docutils calls every frame, of those of a notebook's cells, which have names of their own.
FRAME = re.compile(r'(<div class="cell[^"]*?) docutils container(?=[ "])')
#: A figure wider than so many pixels is a diagram whose letters are small already: on a phone it scrolls instead.
WIDE = 600


def is_wide(width):
    """Whether a figure of so many pixels, a number or "681px", cannot be read on a phone at the width of the page.

    >>> is_wide("681"), is_wide("582px"), is_wide(None)
    (True, False, False)
    """
    return float(str(width or 0).removesuffix("px")) > WIDE


def lazy(app, doctree):
    """Let the figures of a page wait for the reader, and mark those that a phone would make too small."""
    for image in doctree.findall(nodes.image):
        image["loading"] = "lazy"
        if is_wide(image.get("width")):
            image["classes"].append("wide")


class LightFormatter(HtmlFormatter):
    """Pygments's own, for tokens of which those without a colour of their own are text."""

    def format_unencoded(self, tokensource, outfile):
        """Write the tokens as HTML."""
        super().format_unencoded(((Text if kind in UNCOLOURED else kind, text) for kind, text in tokensource), outfile)


def lighten(app, pagename, templatename, context, doctree):
    """Make names of functions and frames of cells light, and leave out what keeps an empty first line of code."""
    if pagename.startswith(("chapters/", "solutions/")):
        body = LINKED.sub(r'><code class="py-obj">\1</code>', context["body"])
        context["body"] = FRAME.sub(r"\1", body.replace("<pre><span></span>", "<pre>"))


def setup(app):
    """Join Sphinx."""
    PygmentsBridge.html_formatter = LightFormatter
    app.connect("doctree-read", lazy)
    app.connect("html-page-context", lighten)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
