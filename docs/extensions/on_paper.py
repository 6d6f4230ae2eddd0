"""What a page needs to be printed: which sections are further reading, its title on every sheet, and a choice.

`_static/print.css` is the look on paper; a chapter prints its core, or all of it where the reader asks for that.
"""

import html
import re

from docutils import nodes

#: What a chapter ends with is further reading too, by its title.
LAST = "How we know"
#: Where `docs/pdf` puts the link to the PDF of the whole book, once that is there.
WHOLE_BOOK = "<!--the whole book-->"
CHOICE = (
    '<span class="print-choice">Print: <button type="button" data-print="core">the core</button>, '
    '<button type="button" data-print="all">all</button></span>' + WHOLE_BOOK
)


def is_further(section):
    """Whether a section says that it is further reading: its text begins with an emphasised "Further"."""
    first = next((part for part in section if isinstance(part, nodes.paragraph)), None)
    begins = first is not None and isinstance(first[0], nodes.emphasis) and first[0].astext().startswith("Further")
    return begins or section[0].astext().startswith(LAST)


def mark(app, doctree):
    """Mark the further sections of a chapter, and put the choice to the end of the line below its title."""
    if not app.env.docname.startswith("chapters/"):
        return
    for section in doctree.findall(nodes.section):
        if is_further(section):
            section["classes"].append("further")
    for line in doctree.findall(lambda node: isinstance(node, nodes.paragraph) and "opening" in node["classes"]):
        line += [nodes.Text(" · "), nodes.raw("", CHOICE, format="html")]


def on_the_sheets(title):
    """Return the style that prints a title, a piece of HTML, on every sheet but the first, where it is already."""
    words = html.unescape(re.sub(r"<[^>]*>", "", title)).replace("\\", r"\\").replace('"', r"\"")
    return (
        f'<style media="print">@page {{ @top-left {{ content: "{words}" }} }} '
        "@page:first { @top-left { content: none } }</style>"
    )


def add_assets(app, pagename, templatename, context, doctree):
    """The look on paper, for a page that has a title; its script only where there is a choice."""
    if title := context.get("title"):
        context["metatags"] = context.get("metatags", "") + on_the_sheets(title)
    if pagename.startswith("chapters/"):
        app.add_js_file("print.js", loading_method="defer")


def setup(app):
    """Join Sphinx."""
    app.add_css_file("print.css", media="print", priority=900)  # the last word, behind loopbook.css
    app.connect("doctree-read", mark)
    app.connect("html-page-context", add_assets)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
