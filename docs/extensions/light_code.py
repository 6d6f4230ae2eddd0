"""Code in colours with an element only where there is a colour.

Names and punctuation look as the text around them does. With an element each they were two fifths of a chapter's page.
"""

from pygments.formatters import HtmlFormatter
from pygments.token import Name, Punctuation, Text, Whitespace
from sphinx.highlighting import PygmentsBridge

UNCOLOURED = {Name, Punctuation, Whitespace}


class LightFormatter(HtmlFormatter):
    """Pygments's own, for tokens of which those without a colour of their own are text."""

    def format_unencoded(self, tokensource, outfile):
        """Write the tokens as HTML."""
        super().format_unencoded(((Text if kind in UNCOLOURED else kind, text) for kind, text in tokensource), outfile)


def setup(app):
    """Join Sphinx."""
    PygmentsBridge.html_formatter = LightFormatter
    return {"parallel_read_safe": True, "parallel_write_safe": True}
