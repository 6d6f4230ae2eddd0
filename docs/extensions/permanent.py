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
BEHIND = re.compile(rf"\(((?:{'|'.join(KINDS)})s? (?=[(\dA-Z]).*)\)$", re.IGNORECASE)
HEAD = re.compile(rf"({'|'.join(KINDS)})s? (?=[(\dA-Z])", re.IGNORECASE)
TAIL = re.compile(rf"\((({'|'.join(map(str.title, KINDS))})s? [(\dA-Z].*)\)$")  # behind the words of a heading
FIGURE = "figure_places"  # of a cell's metadata: the names of its figure, and its title
#: Places and headings that are no more, and the section that stands for them: {chapter: {the section's name: these}}.
MOVED = {
    "01_introduction": {
        "section-1-1": ["section-1-1-control-by-feedback", "section-11--control-by-feedback"],
        "section-1-2": ["section-1-2-the-wood-chip-tank", "section-12--the-wood-chip-tank", "figure-cell-010"],
        "equation-1-1": ["equation-1-1-the-control-error", "equation-11--the-control-error"],
        "after-each-step-the-controller-brings-the-error-back-to-zero-figure-1-3": [
            "figure-1-3-the-level-control-system-at-work",
            "figure-13--the-level-control-system-at-work",
        ],
        "without-control-the-tank-runs-empty-and-a-gain-alone-leaves-an-error": ["what-if-nobody-controls"],
        "signs-noise-and-a-proof-that-no-error-is-left-figure-1-3": [
            "figure-1-3-what-exactly-happens",
            "figure-13--what-exactly-happens",
        ],
        "good-control-reduces-the-control-error-figure-1-4": [
            "figure-1-4-good-control-reduces-the-control-error",
            "figure-14--good-control-reduces-the-control-error",
        ],
        "section-1-4": [
            "section-1-4-things-to-think-about-computed",
            "section-14--things-to-think-about-computed",
        ],
    },
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
        "what-a-filter-costs-in-the-loop-section-7-2-2": [
            "section-7-2-2-a-filter-in-the-loop",
            "section-722--a-filter-in-the-loop",
        ],
    },
    "03_modeling": {
        "section-3-2": ["Section 3.2 · The Balance law"],
        "example-3-1": ["Section 3.3 · Mass balance", "Example 3.1 · A liquid tank"],
        "example-3-1-further": ["Example 3.1, further · The tank that runs over"],
        "example-3-2": ["Example 3.2 · A blending tank"],
        "example-3-2-further": ["Example 3.2, further · A model that is not linear"],
        "example-3-3": ["Section 3.4 · Energy balance", "Example 3.3 · A heated liquid tank"],
        "more-power-then-a-colder-inflow-figure-3-13": ["Figure 3.13 · Simulation of the heated tank"],
        "example-3-3-further": ["Example 3.3, further · Four tests of a model"],
        "section-3-5": ["equation-3-21", "Section 3.5 · Motion"],
        "example-3-4": ["Example 3.4 · A motor that moves a load"],
        "section-3-5-further": [
            "Section 3.5, further · Turning, and a mass that changes",
            "example-3-4-further",
            "Example 3.4, further · The same model by other ways",
        ],
        "section-3-6": ["Section 3.6 · Circuits"],
        "section-3-6-further": [
            "Section 3.6, further · Components, resistors together, and power",
            "example-3-5-further",
            "Example 3.5, further · A lowpass filter",
        ],
        "example-3-5": ["Example 3.5 · An RC circuit"],
        "exercises-further-a-filter-and-a-balance-seen-in-a-picture": [
            "Exercise, further · A balance seen in a picture"
        ],
    },
    "06_dynamics": {
        "section-6-2": ["Section 6.2 · The integrator"],
        "example-6-1": ["Example 6.1 · A liquid tank is an integrator"],
        "section-6-3": ["Section 6.3 · The time constant system"],
        "one-step-response-shows-both-parameters-figure-6-2": [
            "Figure 6.2 · Gain and time constant in a step response"
        ],
        "equation-6-14": ["Equation 6.14 · Reading off gain and time constant"],
        "example-6-2": ["Example 6.2 · A heated liquid tank is a time constant system"],
        "section-6-4": ["Section 6.4 · The time delay", "Figure 6.4 · The output is the input of a while ago"],
        "section-6-5": ["Section 6.5 · Two time constants in series"],
        "two-equal-lags-are-7-slower-than-the-sum-figure-6-5": [
            "Figure 6.5 · Is the estimate confirmed?",
            "figure-cell-116",
        ],
        "section-6-5-further": ["Section 6.5 · Second thoughts", "Example 6.2 · Is the heat loss negligible?"],
    },
    "04_laplace": {
        "example-4-1": ["example-4-1-the-transform-of-a-step", "example-41--the-transform-of-a-step"],
        "section-4-3": ["section-4-3-laplace-transform-pairs", "section-43--laplace-transform-pairs"],
        "section-4-4": ["section-4-4-properties", "section-44--properties"],
        "example-4-2": [
            "example-4-2-a-differential-equation-and-its-response",
            "example-42--a-differential-equation-and-its-response",
        ],
        "example-4-3": ["example-4-3-where-the-response-ends", "example-43--where-the-response-ends"],
        "what-the-pole-tells": ["four-poles"],
        "every-pair-returns-and-equal-lags-section-4-3": [
            "section-4-3-the-way-back-and-equal-lags",
            "section-43--the-way-back-and-equal-lags",
        ],
        "where-the-rules-come-from-section-4-4": [
            "section-4-4-where-the-rules-come-from",
            "section-44--where-the-rules-come-from",
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
        places = [place for name in section["ids"] for place in moved.get(name, ())]
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
