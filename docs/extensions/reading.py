"""How a chapter is read: its core or all of it, on the screen and on paper, with its code or without, in what time.

A further section is folded below its heading, with the line that says what it holds. `_static/reading.js` switches what
is shown, and `_static/print.css` is the look on paper.
"""

import html
import re

from docutils import nodes

from loopbook.notebooks import FOLDED, FURTHER, has_sliders

#: Where `docs/pdf` puts the link to the PDF of the whole book, once that is there.
WHOLE_BOOK = "<!--the whole book-->"
#: What a reader chooses: the name of the choice, what it is about, and its values with their words.
CHOICES = {
    "show": ("Show", {"core": "the core", "all": "all"}),
    "code": ("Code", {"shown": "shown", "none": "hidden"}),
}
OF_HOW_WE_KNOW = "What was reconstructed, what was found by a second route, and what the source leaves unsaid."
#: Minutes for a word, a line of code, what a cell shows, a lesson, and to begin, as first readers have needed them.
WORD, LINE, OUTPUT, LESSON, BEGIN = 1 / 75, 1 / 10, 1 / 4, 3, 5


def is_further(section):
    """Whether a section may be skipped, by what its text begins with, as in the notebook."""
    first = first_of(section)
    begins = f"*{first.astext()}" if first and isinstance(first[0], nodes.emphasis) else ""
    return bool(FURTHER.search(f"## {section[0].astext()}\n{begins}"))


def first_of(section):
    """The first paragraph of a section."""
    return next(section.findall(nodes.paragraph), None)


def fold(section):
    """Fold what is below a heading. The line that stays says what it is: its own first one, or the titles below."""
    first = first_of(section)
    if first and first.astext().startswith("Further"):
        first.parent.remove(first)
        says = first.children
    else:
        below = [part[0].astext() for part in section if isinstance(part, nodes.section)]
        says = [nodes.Text(" · ".join(below) or OF_HOW_WE_KNOW)]
    section["classes"].append("further")
    section[1:1] = [raw('<details class="further"><summary>'), *says, raw("</summary>")]
    section.append(raw("</details>"))


def raw(text):
    """A piece of HTML."""
    return nodes.raw("", text, format="html")


def mark(app, doctree):
    """Fold the further sections of a chapter, and put the choices below the line that is below its title."""
    if not app.env.docname.startswith("chapters/"):
        return
    for section in list(doctree.findall(nodes.section)):
        if is_further(section):
            fold(section)
    for line in list(doctree.findall(lambda node: isinstance(node, nodes.paragraph) and "opening" in node["classes"])):
        line.parent.insert(line.parent.index(line) + 1, raw(choices()))


def choices():
    """The line of what a reader can choose, as HTML; without a script nobody sees it."""
    parts = []
    for name, (title, values) in CHOICES.items():
        button = f'<button type="button" name="{name}" value='
        buttons = "".join(f'{button}"{value}">{says}</button>' for value, says in values.items())
        parts.append(f'<span role="group" aria-label="{title}">{title} {buttons}</span>')
    paper = "".join(f'<button type="button" data-print="{v}">{says}</button>' for v, says in CHOICES["show"][1].items())
    parts.append(f'<span role="group" aria-label="Print">Print {paper}</span>')
    return f'<p class="switches">{"".join(parts)}{WHOLE_BOOK}</p>'


def minutes(cells):
    """Return how long the core of a notebook takes with code and lessons, without exercises, to five minutes."""
    inside, total = True, BEGIN
    for cell in cells:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            if source.startswith("## "):
                inside = not FURTHER.search(source) and not re.match("## (Exercises|What )", source)
            total += inside * WORD * len(re.findall(r"\w+", re.sub(r"\$[^$]*\$", "x", source)))
        elif inside:
            shown = [output for output in cell["outputs"] if "data" in output]
            is_read = FOLDED not in cell["metadata"].get("tags", [])
            total += LESSON if has_sliders(source) else OUTPUT * len(shown) + is_read * LINE * len(source.splitlines())
    return 5 * round(total / 5)


def on_the_sheets(title):
    """Return the style that prints a title, a piece of HTML, on every sheet but the first, where it is already."""
    words = html.unescape(re.sub(r"<[^>]*>", "", title)).replace("\\", r"\\").replace('"', r"\"")
    return (
        f'<style media="print">@page {{ @top-left {{ content: "{words}" }} }} '
        "@page:first { @top-left { content: none } }</style>"
    )


def add_title(app, pagename, templatename, context, doctree):
    """Put the title of a page on its sheets, and say of the captions at the side of which level they are."""
    if title := context.get("title"):
        context["metatags"] = context.get("metatags", "") + on_the_sheets(title)
    if tree := context.get("furo_navigation_tree"):
        context["furo_navigation_tree"] = tree.replace('role="heading"', 'role="heading" aria-level="2"')


def setup(app):
    """Join Sphinx."""
    app.add_css_file("print.css", media="print", priority=900)  # the last word, behind loopbook.css
    app.add_js_file("reading.js", loading_method="defer")
    app.connect("doctree-read", mark)
    app.connect("html-page-context", add_title, priority=900)  # behind the theme, which makes the tree
    return {"parallel_read_safe": True, "parallel_write_safe": True}
