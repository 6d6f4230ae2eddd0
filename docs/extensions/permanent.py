"""Permanent links: a place that a book numbers, and every figure, has an address that stays as long as the page.

`example-7-4`, `equation-10-15`, `figure-2-8`, `table-12-3` and `section-7-5` come from the numbers of the book, and
belong to the first place of a page that shows them: a figure before a section that is named after it, a section before
a row of a check. A figure without a number has the id of its cell, which a cell keeps for life. The titles of sections
are addresses, too, as everywhere on the web. tests/site/permanent_links.txt holds those that must not vanish.
"""

import re
import tomllib
from html import escape
from itertools import pairwise
from pathlib import Path

from docutils import nodes
from slugs import slug

KINDS = ("example", "equation", "figure", "section", "table")
NUMBER = re.compile(r"\(?\b((?:[A-Z]\.)?\d+(?:\.\d+)*)([a-z]?)\b\)?")
BEHIND = re.compile(rf"\(((?:{'|'.join(KINDS)})s? (?=[(\dA-Z]).*)\)$", re.IGNORECASE)
HEAD = re.compile(rf"({'|'.join(KINDS)})s? (?=[(\dA-Z])", re.IGNORECASE)
FIGURE = "figure_places"  # of a cell's metadata: the names of its figure, and its title
#: {chapter: {the name of a section: the places and the headings that are no more, and for which it stands}}.
MOVED = tomllib.loads(Path(__file__).with_name("moved.toml").read_text("utf-8"))


def names_of(title):
    """Return the places that a title claims: what the book calls it, number by number, in front or in brackets behind.

    >>> names_of("Example 7.4 · Anti wind-up"), names_of("Example 3.1, further · The tank that runs over")
    (['example-7-4'], ['example-3-1-further'])
    >>> names_of("Equations (4) and (5) · Marginal stability"), names_of("Equations 7.89 to 7.91")
    (['equation-4', 'equation-5'], ['equation-7-89', 'equation-7-90', 'equation-7-91'])
    >>> names_of("Equations (12-5) and (12-6) · The controller"), names_of("Equations (5-50) to (5-52)")
    (['equation-12-5', 'equation-12-6'], ['equation-5-50', 'equation-5-51', 'equation-5-52'])
    >>> names_of("How much damping?"), names_of("Two loops, one valve (Section 11.1)")
    ([], ['section-11-1'])
    """
    behind = BEHIND.search(title)
    head = re.sub(r"(?<=\d)-(?=\d)", ".", behind[1] if behind else title.partition(" · ")[0])  # Seborg writes 12-5
    kind = HEAD.match(head)
    if not kind:
        return []
    numbers = [match[1] + match[2] for match in NUMBER.finditer(head, kind.end())]
    for first, last in pairwise(numbers):
        if re.search(rf"{re.escape(first)}\)? (to|–) \(?{re.escape(last)}", head):
            numbers += between(first, last)
    rest = re.sub(r"\b(and|to)\b", " ", NUMBER.sub(" ", head[kind.end() :]))
    more = f"-{slug(rest)}" if slug(rest) else ""
    return [f"{kind[1].lower()}-{slug(number)}{more}" for number in sorted(set(numbers), key=number_key)]


def addresses(old):
    """The places of an old heading, both of them; a place is itself.

    >>> addresses("Example 3.5, further · A lowpass filter"), addresses("equation-3-21")
    (['example-3-5-further-a-lowpass-filter', 'example-35-further--a-lowpass-filter'], ['equation-3-21'])
    """
    return [slug(old), re.sub(r"[^\w -]", "", old.lower()).replace(" ", "-")] if " " in old else [old]


def number_key(number):
    return [int(part) if part.isdigit() else 0 for part in re.split(r"\D+", number)], number


def between(first, last):
    """The numbers from one to another, where only their last parts differ.

    >>> between("7.89", "7.91"), between("3.9", "4.2")
    (['7.90'], [])
    """
    (head, _, begin), (other, _, end) = first.rpartition("."), last.rpartition(".")
    if head != other or not (begin.isdigit() and end.isdigit()):
        return []
    return [f"{head}.{n}" if head else str(n) for n in range(int(begin) + 1, int(end))]


def title_of(words):
    """The title of a figure, from its description: what is before the first colon.

    >>> title_of("Figure 2.8 · Position of the mass: y; F against t [s]")
    'Figure 2.8 · Position of the mass'
    """
    return words.partition(": ")[0]


def figures(cells):
    """Return the places of the figures of a chapter: {id of the cell: [name, ...]}, the first is its own.

    Arguments:
        cells: of the notebook, with the ids that they are stored with.
    """
    found, taken = {}, set()
    for cell in cells:
        if words := description(cell):
            names = [n for n in names_of(title_of(words)) if n.startswith("figure-") and n not in taken]
            names = names or [f"figure-{cell['id']}"]
            taken |= set(names)
            found[cell["id"]] = names
    return found


def description(cell):
    """The words for the figure that a cell shows, nothing if there is none; what an exercise shows is its own."""
    if cell["cell_type"] != "code" or cell["source"].startswith("exercise("):
        return None
    pictures = [o for o in cell["outputs"] if "image/png" in o.get("data", {})]
    return pictures[0]["metadata"]["image/png"]["alt"] if pictures else None


def headings(cells):
    """The titles of the sections in the cells of a notebook."""
    lines = (line for cell in cells if cell["cell_type"] == "markdown" for line in cell["source"].splitlines())
    return [line.lstrip("# ") for line in lines if re.match(r"#{2,4} ", line)]


def taken(cells):
    """The names that figures and sections of a notebook have: what is left is for its checks."""
    of_figures = {name for names in figures(cells).values() for name in names}
    return of_figures | {name for title in headings(cells) for name in names_of(title)}


def name_sections(app, doctree):
    """Give the sections of a chapter their names, before the tables of contents are made of them."""
    if not app.env.docname.startswith("chapters/"):
        return
    known = {name for cell in doctree.findall(nodes.container) for name in of_cell(cell).get("names", ())}
    for section in doctree.findall(nodes.section):
        names = [name for name in names_of(section[0].astext()) if name not in known]
        known |= set(names)
        section["ids"][:0] = [name for name in names if name not in section["ids"]]
        moved = MOVED.get(app.env.docname.removeprefix("chapters/"), {})
        places = dict.fromkeys(one for name in section["ids"] for old in moved.get(name, ()) for one in addresses(old))
        section["ids"] += [place for place in places if place not in section["ids"]]


def of_cell(cell):
    """What stored.py has noted of the figure of a cell, {} if it has none."""
    return (cell.get("cell_metadata") or {}).get(FIGURE, {})


def frame(names, chapter, label):
    """What is before and after a lesson that takes the place of a figure: its name, and the way to the figure.

    Arguments:
        names: of the figure's place.
        chapter: name of the notebook.
        label: of the link, for who hears it alone.
    """
    spans = "".join(f'<span id="{name}"></span>' for name in names)
    below = f'<p class="figure-links">{links(names[0], chapter, escape(label))}</p>'
    return f"```{{raw}} html\n{spans}\n```", f"```{{raw}} html\n{below}\n```"


def links(name, chapter, label):
    """The link to a figure, and the way to its code, as HTML."""
    link = f'<a class="headerlink" href="#{name}" title="Link to this figure">¶</a>'
    return f'{link} <a href="../figures/{chapter}.html#{name}" aria-label="{label}">Figure and code</a>'


def frame_figures(app, doctree, docname):
    """Put each figure of a chapter into a frame that has its name, a link to it, and the way to its code."""
    for cell in list(doctree.findall(nodes.container)):
        noted = of_cell(cell)
        image = next(cell.findall(nodes.image), None) if noted else None
        if image is None:
            continue
        first, *others = noted["names"]
        more = "".join(f'<span id="{name}"></span>' for name in others)
        place = image.parent.index(image)
        below = f"<figcaption>{links(first, docname.removeprefix('chapters/'), noted['label'])}</figcaption></figure>"
        image.parent.insert(place + 1, nodes.raw("", below, format="html"))
        image.parent.insert(place, nodes.raw("", f'<figure class="single" id="{first}">{more}', format="html"))


def setup(app):
    """Join Sphinx, before what reads the titles."""
    app.connect("doctree-read", name_sections, priority=400)
    app.connect("doctree-resolved", frame_figures)
    app.add_css_file("places.css")
    return {"parallel_read_safe": True, "parallel_write_safe": True}
