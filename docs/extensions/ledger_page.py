"""The ledger as a page: every result that a book prints, what a computation makes of it, and the cell that shows it.

The directive `ledger-table` writes a table a source, `ledger-totals` counts. Both stand in the page without a script;
`_static/ledger.js` adds the search. What is computed is read from the stored outputs of the chapters.
"""

import functools
import html
import json
import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from docutils import nodes
from mathml import in_html
from slugs import check_anchor, ledger_anchor
from sphinx.util.docutils import SphinxDirective

from loopbook.ledger import errata, sources
from loopbook.ledger.report import MIME_TYPE
from loopbook.ledger.source import STATUSES

CHAPTERS = Path(__file__).parents[2] / "chapters"
PAGE = "ledger"
MEANINGS = {
    "reproduced": "computed and printed agree, to half a unit of the last printed digit",
    "corrected": "the book is wrong, and the computation says what is right",
    "reconstructed": "an input is not printed; one stated assumption supplies several results",
    "unreproduced": "all is known and it does not agree, or what it takes is not printed",
    "measured": "laboratory data, nothing to compute",
}
WIDE = 26  # letters of a formula that fit into a cell, on a phone too
COLUMNS = ("equation", "result", "book prints", "computed", "status")
_CELLS = re.compile(r"<td[^>]*>(.*?)</td>", re.DOTALL)


@dataclass(frozen=True)
class Row:
    """One result of the ledger, the verdict that a chapter stored on it, and its cells as the chapter shows them."""

    entry: object
    result: object
    verdict: dict
    name: str
    printed: str
    computed: str

    @property
    def note(self):
        """What a reader must know besides: the correction, the reason, the assumption."""
        row = self.result
        if row.status == "reconstructed":
            return f"Assuming {row.assuming}{f' (to within {row.within})' if row.within else ''}."
        correct = f"Correct is {row.correct}: " if row.correct else ""
        return correct + row.because + "." * bool(row.because)

    @property
    def words(self):
        """What a search finds the row by that its cells do not say: names and formulas as they are typed."""
        row = self.result
        formulas = (row.printed, self.verdict["computed"]) if row.kind == "formula" else ()
        return " ".join(dict.fromkeys([row.name, *formulas]))


@functools.cache
def stored(folder=CHAPTERS):
    """Return the checks in the stored chapters: {(source, entry): (chapter, verdicts, rows of cells)}."""
    found = {}
    for file in sorted(folder.glob("*.ipynb")):
        for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
            for output in cell.get("outputs", []):
                if check := output.get("data", {}).get(MIME_TYPE):
                    shown = "".join(output["data"]["text/html"]).partition("</thead>")[2].partition("</table>")[0]
                    cells = [_CELLS.findall(line) for line in shown.split("</tr>") if "<td" in line]
                    found[check["source"], check["entry"]] = (file.stem, check["verdicts"], cells)
    return found


@functools.cache
def titles(folder=CHAPTERS):
    """Return the titles of the chapters by their names, in their order."""
    found = {}
    for file in sorted(folder.glob("*.ipynb")):
        first = json.loads(file.read_text(encoding="utf-8"))["cells"][0]["source"]
        found[file.stem] = "".join(first).splitlines()[0].lstrip("# ")
    return found


def rows(entry, checks):
    """Return the rows of an entry, with what its chapter stored about each of its results."""
    _, verdicts, cells = checks[entry.source, entry.name]
    known = {verdict["name"]: (verdict, shown[-4:]) for verdict, shown in zip(verdicts, cells, strict=True)}
    found = []
    for result in entry.results:
        verdict, (name, printed, computed, _) = known[result.name]
        found.append(Row(entry, result, verdict, *map(_without_room, (name, printed, computed))))
    return found


def _without_room(cell):
    """A cell without the width that a notebook reserves for its formula."""
    return re.sub(r'<div style="min-width[^"]*">(.*)</div>', r"\1", cell)


def as_html(row, typeset=in_html, shared=False):
    """Return the lines of a table for a row; a note that it shares with the row after it stands below that one."""
    result = row.result
    equation = f"({html.escape(result.equation)})" if result.equation else ""
    mark = {"reproduced": "✓", "corrected": "✓", "reconstructed": "✓", "unreproduced": "≠"}.get(result.status, "–")
    label = f' aria-label="{result.name}"' if "$" in row.name else ""  # not every reader of a screen says formulas
    probed = " <small>at random points</small>" if row.verdict["how"] == "probed" else ""
    lines = [
        f'<tr id="{ledger_anchor(row.entry.source, row.entry.name, result.name)}" data-f="{html.escape(row.words)}"'
        + (" data-w>" if row.note else ">"),
        f'<td>{equation}<th scope="row"{label}>{_breakable(typeset(row.name))}',
        f"<td>{_framed(typeset(row.printed))}<td>{_framed(typeset(row.computed)) or '–'}",
        f'<td class="{result.status}">{mark} {result.status}{probed}',
    ]
    if row.note and not shared:
        note, correct = html.escape(row.note, quote=False), html.escape(result.correct, quote=False)
        note = note.replace(correct, f"<code>{correct}</code>", 1) if correct else note
        lines.append(f'<tr class="why"><td colspan="5">{note}')
    return "".join(lines)


def _breakable(name):
    """A name in words, which may be longer than its column."""
    return name.replace("_", "_<wbr>") if name.startswith("<code>") else name


def _framed(cell):
    """A cell whose formula scrolls within itself where it is wide; it is then reached by the keyboard too."""
    return (
        f'<div tabindex="0">{cell}</div>' if "<math" in cell and _width(ElementTree.fromstring(cell)) > WIDE else cell
    )


def _width(formula):
    """About how many letters wide a formula is."""
    widths = [_width(part) for part in formula]
    if formula.tag == "mfrac":
        return max(widths)
    return len((formula.text or "").strip()) + (0.75 if formula.tag in ("msub", "msup") else 1) * sum(widths)


def table(source, checks, address, typeset=in_html):
    """Return the table of a source. `address` makes a chapter's name the address of its page."""
    head = "".join(f'<th scope="col">{name}' for name in COLUMNS)
    parts = [
        f'<div class="ledger-frame" tabindex="0" role="region" aria-labelledby="ledger-{source.name}">',
        f'<table class="ledger" data-source="{source.name}">',
        f'<caption id="ledger-{source.name}">{html.escape(source.citation)}</caption>',
        f"<thead><tr>{head}</thead>",
    ]
    for entry in source:
        if not entry.results:
            continue
        chapter = checks[entry.source, entry.name][0]
        cell = f"{address(chapter)}#{check_anchor(entry.source, entry.name)}"
        found = rows(entry, checks)
        after = [row.note for row in found[1:]] + [""]
        parts += [
            f'<tbody id="{ledger_anchor(entry.source, entry.name)}" data-chapter="{chapter}">',
            f'<tr class="entry"><th scope="rowgroup" colspan="5"><a href="{cell}">{html.escape(entry.name)}</a>'
            f" · {html.escape(entry.title)} <small>chapter {titles()[chapter].partition(' ')[0]}</small>",
            *(as_html(row, typeset, row.note == note) for row, note in zip(found, after, strict=True)),
            "</tbody>",
        ]
    return "\n".join([*parts, "</table>", "</div>"])


def controls():
    """Return the form that narrows the tables; a page without its script does not show it."""

    def choice(label, name, options):
        made = "".join(f'<option value="{value}">{html.escape(text)}</option>' for value, text in options)
        return f'<label>{label} <select name="{name}"><option value="">all</option>{made}</select></label>'

    names = [(source.name, source.citation) for source in sources().values()]
    return "\n".join(
        [
            '<form id="ledger-search" role="search" aria-label="the ledger" hidden>',
            '<label class="wide">Search <input type="search" name="q" autocomplete="off" '
            'placeholder="10.2, Ziegler, exp(-tau*s)"></label>',
            choice("Source", "source", names),
            choice("Status", "status", [(status, status) for status in STATUSES]),
            choice("Chapter", "chapter", titles().items()),
            '<p aria-live="polite"><output></output> <button type="reset">Show all</button></p>',
            "</form>",
        ]
    )


def totals():
    """Return the numbers of results by source and status; each number shows its rows."""
    counted = errata.totals(sources())
    head = "".join(f'<th scope="col">{name}' for name in ("source", *STATUSES, "all"))
    lines = ['<div class="ledger-frame" tabindex="0" role="region" aria-label="totals">', '<table class="totals">']
    lines.append(f"<caption>Results by source and status</caption><thead><tr>{head}</thead><tbody>")
    for name, source in sources().items():
        numbers = [*counted[name].items(), ("", sum(counted[name].values()))]
        shown = "".join(
            f'<td><a href="?source={name}{f"&amp;status={status}" if status else ""}">{number}</a>'
            if number
            else "<td>0"
            for status, number in numbers
        )
        lines.append(f'<tr><th scope="row">{html.escape(source.citation)}{shown}')
    sums = {status: sum(row[status] for row in counted.values()) for status in STATUSES}
    shown = "".join(f'<td><a href="?status={status}">{number}</a>' for status, number in sums.items())
    lines.append(f'<tr><th scope="row">all{shown}<td>{sum(sums.values())}</tbody></table></div>')
    meanings = "".join(f'<dt class="{status}">{status}<dd>{MEANINGS[status]}' for status in STATUSES)
    return "\n".join(lines) + f'\n<dl class="statuses simple">{meanings}</dl>'


class LedgerNode(nodes.General, nodes.Element):
    """The place of the tables, which are written when the addresses of the pages are known."""


class Ledger(SphinxDirective):
    """`ledger-table`: the search, and all results."""

    def run(self):
        for source in sources().values():
            for file in {CHAPTERS / f"{entry.chapter}.ipynb" for entry in source}:
                self.env.note_dependency(str(file))
        return [LedgerNode()]


class Totals(SphinxDirective):
    """`ledger-totals`: the numbers of results by source and status."""

    def run(self):
        return [nodes.raw("", totals(), format="html")]


def visit(translator, node):
    """Write the search and the tables."""
    builder = translator.builder

    def address(chapter):
        return builder.get_relative_uri(builder.current_docname, f"chapters/{chapter}")

    translator.body.append(controls())
    translator.body += [table(source, stored(), address) for source in sources().values()]
    raise nodes.SkipNode


def add_assets(app, pagename, templatename, context, doctree):
    """The script and the look of the page, for this page alone."""
    if pagename == PAGE:
        app.add_css_file("ledger.css")
        app.add_js_file("ledger.js", loading_method="defer")


def setup(app):
    """Join Sphinx."""
    app.add_node(LedgerNode, html=(visit, None))
    app.add_directive("ledger-table", Ledger)
    app.add_directive("ledger-totals", Totals)
    app.connect("html-page-context", add_assets)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
