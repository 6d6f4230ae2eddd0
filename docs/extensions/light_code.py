"""Code with few elements: those of a colour, and one for a name that is a link.

Names, punctuation and operators look as the text around them does. With an element each they were half of a chapter's
page, and the three around each function that a section names a tenth.
"""

import re

from pygments.formatters import HtmlFormatter
from pygments.token import Name, Operator, Punctuation, Text, Whitespace
from sphinx.highlighting import PygmentsBridge

UNCOLOURED = {Name, Operator, Punctuation, Whitespace}
LINKED = re.compile(r' title="[\w.]+"><code class="xref py py-obj[^>]*><span class="pre">([^<]*)</span></code>')


class LightFormatter(HtmlFormatter):
    """Pygments's own, for tokens of which those without a colour of their own are text."""

    def format_unencoded(self, tokensource, outfile):
        """Write the tokens as HTML."""
        super().format_unencoded(((Text if kind in UNCOLOURED else kind, text) for kind, text in tokensource), outfile)


def lighten(app, pagename, templatename, context, doctree):
    """Make the names of functions in a chapter light."""
    if pagename.startswith(("chapters/", "solutions/")):
        context["body"] = LINKED.sub(r'><code class="py-obj">\1</code>', context["body"])


def setup(app):
    """Join Sphinx."""
    PygmentsBridge.html_formatter = LightFormatter
    app.connect("html-page-context", lighten)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
