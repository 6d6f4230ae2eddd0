"""Permanent links: a place that a book numbers, and every figure, has an address that stays as long as the page.

`example-7-4`, `equation-10-15`, `figure-2-8`, `table-12-3` and `section-7-5` come from the numbers of the book, and
belong to the first place of a page that shows them: a figure before a section that is named after it, a section before
a row of a check. A figure without a number has the id of its cell, which a cell keeps for life. The titles of sections
are addresses, too, as everywhere on the web. tests/site/permanent_links.txt holds those that must not vanish.
"""

import re
from html import escape
from itertools import pairwise

from docutils import nodes
from slugs import slug

KINDS = ("example", "equation", "figure", "section", "table")
NUMBER = re.compile(r"\(?\b((?:[A-Z]\.)?\d+(?:\.\d+)*)([a-z]?)\b\)?")
HEAD = re.compile(rf"({'|'.join(KINDS)})s? (?=[(\dA-Z])", re.IGNORECASE)
FIGURE = "figure_places"  # of a cell's metadata: the names of its figure, and its title
#: Places that are no more, and the section that stands for them: {chapter: {the section's name: the places}}.
MOVED = {
    "02_block_diagrams": {"example-2-2": ["equation-2-11"]},
    "03_modeling": {"section-3-5": ["equation-3-21"]},
    "07_feedback": {
        "section-7-2": ["section-7-2-the-blocks-of-a-control-loop", "section-72--the-blocks-of-a-control-loop"],
        "section-7-2-2": ["section-7-2-2-the-measurement-filter", "section-722--the-measurement-filter"],
        "section-7-2-2-further": [
            "section-7-2-2-further-bandwidth-and-why-a-larger-filter-is-slower-and-smoother",
            "section-722-further--bandwidth-and-why-a-larger-filter-is-slower-and-smoother",
        ],
        "section-7-2-3": [
            "section-7-2-3-further",
            "section-7-2-3-scaling",
            "section-7-2-4-further",
            "section-723--scaling",
        ],
        "section-7-3-1": ["section-7-3-1-the-ideal-pid-controller", "section-731--the-ideal-pid-controller"],
        "section-7-3-1-further": [
            "section-7-3-1-further-the-terms-and-gains-on-other-panels",
            "section-731-further--the-terms-and-gains-on-other-panels",
        ],
        "section-7-3-2": ["section-7-3-2-what-the-terms-are-for", "section-732--what-the-terms-are-for"],
        "section-7-3-2-further": [
            "section-7-3-2-further-what-is-left-of-the-error-and-of-each-term",
            "section-732-further--what-is-left-of-the-error-and-of-each-term",
        ],
        "example-7-1": ["example-7-1-the-three-terms-at-work", "example-71--the-three-terms-at-work"],
        "section-7-3-3": ["section-7-3-3-reverse-or-direct-action", "section-733--reverse-or-direct-action"],
        "example-7-2": [
            "example-7-2-a-pump-in-the-outlet",
            "example-72--a-pump-in-the-outlet",
            "section-7-3-3-further",
            "section-7-3-3-further-the-sign-of-the-gain",
            "section-733-further--the-sign-of-the-gain",
        ],
        "example-7-3": [
            "example-7-3-three-ways-to-change-a-setpoint",
            "example-73--three-ways-to-change-a-setpoint",
        ],
        "example-7-4": ["example-7-4-wind-up", "example-74--wind-up"],
        "section-7-4-4-further": [
            "section-7-4-4-further-bumpless-transfer",
            "section-744-further--bumpless-transfer",
        ],
        "section-7-5": ["section-7-5-why-a-loop-can-become-unstable", "section-75--why-a-loop-can-become-unstable"],
        "example-7-5": [
            "example-7-5-too-much-gain-too-much-delay",
            "example-75--too-much-gain-too-much-delay",
        ],
        "a-filter-in-the-loop-costs-stability-section-7-2-2": [
            "section-7-2-2-a-filter-in-the-loop",
            "section-722--a-filter-in-the-loop",
        ],
    },
    "08_feedforward": {"example-8-1": ["equation-8-3", "equation-8-4"]},
    "10_tuning": {
        "section-10-5-4-further-an-adaptive-controller": [
            "section-10-5-4",
            "equation-10-38",
            "check-haugen-section-10-5-4",
        ],
    },
    "15_direct_synthesis": {
        "figure-12-1-block-diagram": [
            "check-seborg-figure-12-1-block-diagram",
            "figure-12-1-block-diagram-what-is-in-the-loop",
            "figure-121-block-diagram--what-is-in-the-loop",
        ],
        "equation-12-11": [
            "equation-12-11-pi-controller-for-a-lag-with-dead-time",
            "equation-12-11--pi-controller-for-a-lag-with-dead-time",
        ],
        "equation-12-30": [
            "equation-12-30-pid-controller-for-a-lag-with-dead-time",
            "equation-12-30--pid-controller-for-a-lag-with-dead-time",
        ],
        "equation-12-14": [
            "equation-12-14-pid-controller-for-two-lags-with-dead-time",
            "equation-12-14--pid-controller-for-two-lags-with-dead-time",
        ],
        "table-12-1": ["table-12-1-settings-for-fifteen-models", "table-121--settings-for-fifteen-models"],
        "internal-model-control-and-two-rows-by-hand-figure-12-2": [
            "figure-12-2-internal-model-control",
            "figure-122--internal-model-control",
        ],
        "example-12-1": [
            "example-12-1-pid-control-of-two-lags-with-dead-time",
            "example-121--pid-control-of-two-lags-with-dead-time",
        ],
        "figure-12-1-disturbance-responses": [
            "figure-12-1-disturbance-responses-candidate-controllers",
            "figure-121-disturbance-responses--candidate-controllers",
        ],
        "example-12-4": [
            "example-12-4-three-pi-controllers-and-a-fourth",
            "example-124--three-pi-controllers-and-a-fourth",
        ],
        "only-the-first-controller-recovers-slowly-figure-12-8": [
            "figure-12-8-responses-of-the-four-controllers",
            "figure-128--responses-of-the-four-controllers",
        ],
        "figure-12-8-further": ["figure-128-further"],
        "table-12-1-cell-by-cell": ["table-121-cell-by-cell"],
    },
    "16_tuning_relations": {
        "table-12-3": ["figure-cell-102", "figure-cell-103"],
        "figure-12-15-two-reaction-curves": ["check-seborg-figure-12-15"],
    },
    "17_dead_time_compensation": {"section-1": ["figure-cell-020"]},
    "18_integral_criteria": {"more-than-one-dead-time": ["figure-cell-134"]},
}


def names_of(title):
    """Return the places that a title claims: what the book calls it, number by number.

    >>> names_of("Example 7.4 · Anti wind-up"), names_of("Example 3.1, further · The tank that runs over")
    (['example-7-4'], ['example-3-1-further'])
    >>> names_of("Equations (4) and (5) · Marginal stability"), names_of("Equations 7.89 to 7.91")
    (['equation-4', 'equation-5'], ['equation-7-89', 'equation-7-90', 'equation-7-91'])
    >>> names_of("Equations (12-5) and (12-6) · The controller"), names_of("Equations (5-50) to (5-52)")
    (['equation-12-5', 'equation-12-6'], ['equation-5-50', 'equation-5-51', 'equation-5-52'])
    >>> names_of("Wind-up at a limit, and how to halt it (Example 7.4)"), names_of("Filters (Section 7.2.2, further)")
    (['example-7-4'], ['section-7-2-2-further'])
    >>> names_of("How much damping?")
    []
    """
    last = re.search(r" \(([A-Z][^()]*)\)$", title)
    named = last[1] if last and not HEAD.match(title) else title.partition(" · ")[0]
    head = re.sub(r"(?<=\d)-(?=\d)", ".", named)  # Seborg writes 12-5
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
        section["ids"] += [place for name in section["ids"] for place in moved.get(name, ())]


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
