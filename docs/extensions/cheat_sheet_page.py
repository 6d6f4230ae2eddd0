"""The directive `cheat-sheet`: all formulas of the cheat sheet as a page of the site, with the PDF to download."""

import functools
import logging
import re
from pathlib import Path

from cheat_sheet.contents import LETTERS, TITLE, sections
from cheat_sheet.layout import draw
from docutils import nodes
from slugs import slug
from sphinx import addnodes
from sphinx.util.docutils import SphinxDirective

PAGE = "cheat_sheet"
FILE = "cheat_sheet.pdf"


def inline(text):
    """Return the nodes of a text with formulas between dollars."""
    pieces = re.split(r"\$(.*?)\$", text)
    return [nodes.math(piece, piece) if n % 2 else nodes.Text(piece) for n, piece in enumerate(pieces) if piece]


def paragraph(text):
    return nodes.paragraph("", "", *inline(text))


def table(header, rows):
    """Return the table of a section; without a header where it has none."""
    group = nodes.tgroup(cols=len(rows[0]))
    group += [nodes.colspec(colwidth=1) for _ in rows[0]]
    if header:
        group += nodes.thead("", table_row(header))
    group += nodes.tbody("", *map(table_row, rows))
    return nodes.table("", group, classes=["cheat-sheet"])


def table_row(cells):
    return nodes.row("", *(nodes.entry("", paragraph(cell)) for cell in cells))


parts = functools.cache(sections)


class CheatSheet(SphinxDirective):
    """Sections with their tables, and from each the way to its chapter."""

    def run(self):
        download = nodes.reference("", f"{TITLE}: the sheet as a PDF, A4", refuri=FILE, classes=["download"])
        letters = [nodes.list_item("", paragraph(line)) for line in LETTERS]
        return [nodes.paragraph("", "", download), nodes.bullet_list("", *letters), *map(self.section, parts())]

    def section(self, part):
        words = re.sub(r"\$.*?\$", "", part.title).strip(" ,")
        place = nodes.section("", nodes.title("", "", *inline(part.title)), ids=[slug(words)], names=[])
        place += table(part.header, part.cells())
        if part.note:
            place += paragraph(part.note)
        place += nodes.paragraph("", "", nodes.Text("Derived in "), self.chapter(part.chapter), nodes.Text("."))
        return place

    def chapter(self, name):
        """A link whose text is the title of the chapter's page."""
        target = {"refdoc": self.env.docname, "reftype": "doc", "refdomain": "std", "reftarget": f"/chapters/{name}"}
        return addnodes.pending_xref("", nodes.inline("", name), **target, refexplicit=False, refwarn=True)


def draw_file(app):
    """Put the PDF beside the page that links to it."""
    if app.builder.format == "html":
        logging.getLogger("fontTools").setLevel(logging.WARNING)  # which else tells of every table of every font
        draw(parts(), TITLE, LETTERS, Path(app.outdir) / FILE)


def with_the_page(app, doctree):
    """Draw the PDF in the process that has read the page: it knows the formulas, and others read meanwhile."""
    if app.env.docname == PAGE:
        draw_file(app)


def if_missing(app, exception):
    """Draw the PDF for a page that was not read again."""
    if exception is None and PAGE in app.env.found_docs and not (Path(app.outdir) / FILE).exists():
        draw_file(app)


def setup(app):
    """Tell Sphinx of the directive and of the file."""
    app.add_directive("cheat-sheet", CheatSheet)
    app.connect("doctree-read", with_the_page)
    app.connect("build-finished", if_missing)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
