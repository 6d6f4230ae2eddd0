"""Figures are fetched when the reader comes near them."""

from docutils import nodes


def lazy(app, doctree):
    for image in doctree.findall(nodes.image):
        image["loading"] = "lazy"


def setup(app):
    app.connect("doctree-read", lazy)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
