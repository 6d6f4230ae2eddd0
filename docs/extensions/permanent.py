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
    "08_feedforward": {"example-8-1": ["equation-8-3", "equation-8-4"]},
    "10_tuning": {
        "section-10-5-4-further-an-adaptive-controller": [
            "section-10-5-4",
            "equation-10-38",
            "check-haugen-section-10-5-4",
        ],
    },
    "13_poles_and_zeros": {
        "lag-integrator-and-pid-controller-three-transfer-functions": [
            "transfer-function-three-that-come-back-again-and-again",
        ],
        "states-and-matrices-further-poles-are-eigenvalues": ["general-transfer-matrix-poles-are-eigenvalues"],
        "where-a-step-response-begins-and-ends": ["initial-and-final-values-where-a-step-response-begins-and-ends"],
        "first-order-a-response-settles-goes-on-or-grows": ["first-order-system-responses-g1-to-g6"],
        slug("Two standard forms: time constants, or poles and zeros"): [
            "understanding-transfer-functions-two-standard-forms"
        ],
        "a-pole-sets-a-rate-a-zero-the-shape": ["poles-and-zeros-what-they-do-to-the-response"],
        "two-paths-to-the-output-make-a-zero": ["zeros-two-paths-to-the-output"],
        "an-overshoot-needs-a-zero-slower-than-the-slowest-lag": [
            "figure-5-3-when-is-there-an-overshoot",
            "figure-53--when-is-there-an-overshoot",
        ],
        "two-lags-in-series": ["two-first-order-in-series"],
        "many-lags-in-series-the-more-the-flatter": [
            "n-first-order-in-series-the-more-lags-the-flatter",
            "figure-cell-087",
        ],
        slug("Second order: time constant and damping"): [slug("General 2nd order system: time constant and damping")],
        "second-order-further-the-cases-of-the-damping-and-a-table-of-transforms": [
            "general-2nd-order-system-further-the-five-cases-of-the-damping",
        ],
        "seven-rows-of-a-table-worked-out-table-3-1": [
            "table-3-1",
            "table-3-1-seven-rows-worked-out",
            "table-31--seven-rows-worked-out",
        ],
        "underdamped-responses-peak-overshoot-decay-and-period-equations-5-50-to-5-53": [
            "equations-5-50-to-5-53-peak-overshoot-decay-and-period",
            "figure-5-8-underdamped-responses",
            "figure-58--underdamped-responses",
        ],
        "complex-poles-further-control-makes-oscillations-and-avoids-them": [
            "complex-poles-in-practice-control-makes-oscillations-and-avoids-them",
        ],
        "a-closed-loop-direct-over-one-plus-loop": ["closed-loop-transfer-function-direct-over-one-plus-loop"],
        "sensitivity-function-further-what-feedback-does-to-the-error": [
            "sensitivity-function-s-what-feedback-does-to-the-error",
        ],
        "p-control-of-two-lags-less-offset-more-oscillations-closed-loop-example-1": [
            "closed-loop-example-1-p-control-of-two-lags",
        ],
        "pi-control-of-a-lag-further-without-and-with-dead-time-closed-loop-example-2": [
            "closed-loop-example-2-pi-control-of-a-lag",
        ],
        "with-a-dead-time-infinitely-many-poles": ["closed-loop-example-2-with-delay"],
        "pi-control-of-a-level-a-smaller-gain-oscillates-more-closed-loop-example-3": [
            "closed-loop-example-3-pi-control-of-a-level",
        ],
        "pi-control-of-a-level-further-its-period-and-a-dead-time": [
            "closed-loop-responses-the-level-s-setpoint-and-disturbance",
        ],
        "vary-the-gain-vary-the-integral-time": ["pi-control-of-an-integrator-vary-the-gain-vary-the-integral-time"],
        "with-a-dead-time-slow-oscillations-and-fast-ones": [
            "pi-control-of-an-integrator-with-delay-slow-oscillations-and-fast-ones",
        ],
        "two-rules-for-two-kinds-of-oscillation": ["summary-pi-control-of-an-integrating-process"],
        "what-poles-and-zeros-do-and-one-always": ["back-to-poles-and-zeros-what-they-do-and-one-always"],
        "a-zero-in-the-left-half-plane-doubles-the-slope": [
            "example-transfer-function-a-zero-in-the-left-half-plane",
            "example-transfer-function--a-zero-in-the-left-half-plane",
        ],
        "a-process-that-needs-control-and-resists-it": [
            "summary-poles-and-zeros-a-process-that-needs-control-and-resists-it",
        ],
    },
    "14_model_approximation": {
        "a-lag-much-shorter-than-another-is-nearly-a-dead-time": [
            "slide-second-order-system-one-lag-much-larger-than-the-other",
        ],
        "skogestad-s-half-rule-half-of-the-second-lag-becomes-dead-time": ["slide-skogestad-s-half-rule"],
        "two-lags-and-three-with-an-inverse-response-half-rule-examples-1-and-2": [
            "half-rule-example-1-two-lags",
            "half-rule-example-2-three-lags-and-an-inverse-response",
            "figure-cell-074",
        ],
        "an-integrating-process-keeps-its-slope-and-loses-half-a-lag-half-rule-example-3": [
            "half-rule-example-3-an-integrating-process",
        ],
        "an-integrating-process-further-the-proof": ["half-rule-example-3-further-the-proof"],
        "zeros-in-the-left-half-plane-five-rules": ["slide-approximation-of-zeros-in-the-left-half-plane"],
        "zeros-in-the-left-half-plane-further-what-happens-at-the-borders": [
            "approximation-of-zeros-further-what-happens-at-the-borders",
        ],
        "a-slow-zero-beside-a-slow-pole-the-model-depends-on-the-loop-example-e3": [
            "example-e3-a-slow-zero-beside-a-slow-pole",
            "example-e3--a-slow-zero-beside-a-slow-pole",
        ],
        "a-dead-time-as-a-fraction-wrong-until-it-is-over": ["slide-approximations-of-time-delay"],
        "a-dead-time-as-a-fraction-further-crossings-and-a-name": [
            "approximations-of-time-delay-further-crossings-and-a-name",
        ],
        "a-dead-time-as-a-fraction-further-how-accurate-for-how-large-n": ["how-accurate-for-how-large-n"],
        "a-model-from-data-least-squares-and-the-half-rule-beside-it": ["slide-obtaining-a-model-from-data"],
        "a-model-from-data-further-is-one-second-too-long": [
            "obtaining-a-model-from-data-further-is-one-second-too-long",
        ],
        "how-good-is-a-reduced-model-its-loop-nearly-keeps-what-it-promised": ["how-good-is-a-reduced-model"],
    },
    "15_direct_synthesis": {"figure-12-1-block-diagram": ["check-seborg-figure-12-1-block-diagram"]},
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
    >>> names_of("How much damping?")
    []
    """
    head = re.sub(r"(?<=\d)-(?=\d)", ".", title.partition(" · ")[0])  # Seborg writes 12-5
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
