"""Figures are fetched when the reader comes near them, and those that a phone makes too small are marked."""

from docutils import nodes

#: A figure wider than so many pixels is a diagram whose letters are small already: on a phone it scrolls instead.
WIDE = 600


def is_wide(width):
    """Whether a figure of so many pixels, a number or "681px", cannot be read on a phone at the width of the page.

    >>> is_wide("681"), is_wide("582px"), is_wide(None)
    (True, False, False)
    """
    return float(str(width or 0).removesuffix("px")) > WIDE


def lazy(app, doctree):
    for image in doctree.findall(nodes.image):
        image["loading"] = "lazy"
        if is_wide(image.get("width")):
            image["classes"].append("wide")


def setup(app):
    app.connect("doctree-read", lazy)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
