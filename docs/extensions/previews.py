"""What a page says of itself to search engines and to who shares a link: a description, and a picture.

The description is the page's first sentences; those of a chapter are its question. The picture of a chapter is its
first figure, of the other pages _static/preview.png. Whoever reads these tags wants whole addresses: LOOPBOOK_SITE says
where the site is going to be, such as https://control.example.edu/book/.
"""

import html
import re

import single_figures
from docutils import nodes
from search_index import text_of

LONGEST = 300  # letters of a description
DEFAULT = (
    "Process control from the books, computed: chapters with live lessons, exercises that answer, checked results."
)
PICTURE = ("_static/preview.png", "loopbook: the lesson of the front page, an oven to tune by two sliders", 1200, 630)


def description(doctree):
    """Return the first sentences of a page, as many as there is room for."""
    paragraphs = doctree.findall(lambda node: isinstance(node, nodes.paragraph) and not node["classes"])
    inside = (nodes.table, nodes.list_item, nodes.Admonition)
    for paragraph in paragraphs:
        text = re.sub(r"\s+", " ", text_of(paragraph)).strip()
        if len(text) > 40 and not any(isinstance(part, inside) for part in ancestors(paragraph)):
            return shortened(text)
    return DEFAULT


def ancestors(node):
    while node.parent is not None:
        node = node.parent
        yield node


def shortened(text):
    """Return whole sentences of a text, or what fits of the first.

    >>> shortened("One. " + "Two is long " * 40)
    'One.'
    """
    if len(text) <= LONGEST:
        return text
    end = max(text.rfind(sign, 0, LONGEST) for sign in (". ", "? ", "! "))
    return text[: end + 1] if end > 0 else text[: text.rfind(" ", 0, LONGEST)] + " …"


def picture(pagename):
    """Return the picture of a page: its address in the site, its words, its width and height."""
    chapter = pagename.removeprefix("chapters/")
    figures = single_figures.of_chapter(chapter) if chapter != pagename else []
    if not figures:
        return PICTURE
    first = figures[0]
    return f"_images/{first.picture}", first.words, 2 * first.width, 2 * first.height


def add_tags(app, pagename, templatename, context, doctree):
    """Put the tags into the head of a page."""
    said = description(doctree) if doctree is not None else DEFAULT
    site = app.config.html_baseurl
    address, words, width, height = picture(pagename)
    title = html.unescape(re.sub(r"<[^>]+>", "", context.get("title", ""))) or "loopbook"
    tags = {
        ("name", "description"): said,
        ("property", "og:type"): "book" if pagename == app.config.root_doc else "article",
        ("property", "og:site_name"): "loopbook",
        ("property", "og:title"): title,
        ("property", "og:description"): said,
        ("property", "og:image"): f"{site}{address}" if site else context["pathto"](address, True),
        ("property", "og:image:width"): str(width),
        ("property", "og:image:height"): str(height),
        ("property", "og:image:alt"): words,
        ("name", "twitter:card"): "summary_large_image",
    }
    if site:
        tags["property", "og:url"] = context.get("pageurl", site)
    lines = [f'<meta {kind}="{name}" content="{html.escape(text)}">' for (kind, name), text in tags.items()]
    context["metatags"] = context.get("metatags", "") + "\n".join(["", *lines])


def setup(app):
    """Join Sphinx."""
    app.connect("html-page-context", add_tags)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
