"""In the list of pages at the side, the sections of the open page: places.js marks the one that is being read."""

import html
import re

from docutils import nodes
from search_index import text_of

CURRENT = re.compile(r'(<li class="[^"]*\bcurrent-page\b[^"]*"><a class="current reference internal" href="#">.*?</a>)')
ENOUGH = 3  # sections


def sections(toc):
    """Return the sections of a page, below its title: [(place, title), ...].

    Arguments:
        toc: the page's table of contents, as Sphinx keeps it.
    """
    found = []
    for item in toc.findall(nodes.list_item):
        reference = next(item.findall(nodes.reference), None)
        if reference is None or not reference.get("anchorname") or depth(item) != 2:
            continue
        found.append((reference["anchorname"].lstrip("#"), re.sub(r"\s+", " ", text_of(reference)).strip()))
    return found


def depth(item):
    """How many lists an item is in."""
    count = 0
    while item is not None:
        count += isinstance(item, nodes.bullet_list)
        item = item.parent
    return count


def add(app, pagename, templatename, context, doctree):
    """Put the sections below the page's own title."""
    tree = context.get("furo_navigation_tree")
    found = sections(app.env.tocs[pagename]) if tree and pagename in app.env.tocs else []
    if len(found) < ENOUGH:
        return
    links = "".join(f'<li><a href="#{place}">{html.escape(title)}</a></li>' for place, title in found)
    context["furo_navigation_tree"] = CURRENT.sub(
        lambda match: f'{match[1]}<ul class="here" aria-label="Sections of this page">{links}</ul>', tree, count=1
    )


def setup(app):
    """Join Sphinx, behind the theme, which makes the tree."""
    app.connect("html-page-context", add, priority=910)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
