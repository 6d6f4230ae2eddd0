"""The ledger as a page: every result that a book prints, what a computation makes of it, and the cell that shows it.

The directive `ledger-table` writes a table for each source, `ledger-totals` counts. Both are in the page without a
script; `_static/ledger.js` adds the search. What is computed is the data that the chapters store with their checks.
"""

import functools
import html
import json
from pathlib import Path

import checks
from docutils import nodes
from mathml import in_html
from slugs import check_anchor, ledger_anchor
from sphinx.util.docutils import SphinxDirective

from loopbook.evidence import CRITERIA
from loopbook.ledger import errata, sources
from loopbook.ledger.statuses import STATUSES

CHAPTERS = Path(__file__).parents[2] / "chapters"
PAGE = "ledger"


@functools.cache
def stored(folder=CHAPTERS):
    """Return the checks in the stored chapters: {(source, entry): (chapter, verdicts by name)}."""
    found = {}
    for file in sorted(folder.glob("*.ipynb")):
        for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
            for output in cell.get("outputs", []):
                if check := output.get("data", {}).get(checks.MIME_TYPE):
                    verdicts = {verdict["name"]: verdict for verdict in check["verdicts"]}
                    found[check["source"], check["entry"]] = (file.stem, verdicts)
    return found


@functools.cache
def titles(folder=CHAPTERS):
    """Return the titles of the chapters by their names, in their order."""
    found = {}
    for file in sorted(folder.glob("*.ipynb")):
        first = json.loads(file.read_text(encoding="utf-8"))["cells"][0]["source"]
        found[file.stem] = "".join(first).splitlines()[0].lstrip("# ")
    return found


def note(result):
    """Return what a reader must know of a result besides: the correction, the reason, the assumption."""
    status = result.status
    if correct := getattr(status, "correct", ""):
        shown = correct if result.printed.kind == "claim" else f"`{correct}`:"
        return f"Correct is: {shown} {status.because}."
    text = status.note
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def row(entry, result, verdict, formulas=in_html, shared=False):
    """Return the lines of a table for a result; a note that it shares with the result after it is below that one."""
    # what a search finds the row by that its cells do not say: the name and formulas as they are typed
    typed = (verdict["book"], verdict["computed"]) if "tex" in verdict else ()
    words = html.escape(" ".join(dict.fromkeys([result.name, *typed])))
    about = note(result)
    place = ledger_anchor(entry.source, entry.name, result.name)
    line = f'<tr id="{place}" data-f="{words}"{" data-w" if about else ""}>{checks.cells(verdict, formulas)}'
    return line + (f'\n<tr class="why"><td colspan="5">{checks.code(about)}' if about and not shared else "")


def table(source, stored_checks, address, formulas=in_html):
    """Return the table of a source. `address` makes a chapter's name the address of its page."""
    head = "".join(f'<th scope="col">{name}' for name in checks.COLUMNS)
    parts = [
        f'<div class="ledger-frame" tabindex="0" role="region" aria-labelledby="ledger-{source.name}">',
        f'<table class="ledger" data-source="{source.name}">',
        f'<caption id="ledger-{source.name}">{html.escape(source.citation)}</caption>',
        f"<thead><tr>{head}</thead>",
    ]
    for entry in source:
        if not entry.results:
            continue
        chapter, verdicts = stored_checks[entry.source, entry.name]
        cell = f"{address(chapter)}#{check_anchor(entry.source, entry.name)}"
        notes = [note(result) for result in entry.results]
        shared = [one == other for one, other in zip(notes, [*notes[1:], ""], strict=True)]
        parts += [
            f'<tbody id="{ledger_anchor(entry.source, entry.name)}" data-chapter="{chapter}">',
            f'<tr class="entry"><th scope="rowgroup" colspan="5"><a href="{cell}">{html.escape(entry.name)}</a>'
            f" · {html.escape(entry.title)} <small>chapter {titles()[chapter].partition(' ')[0]}</small>",
            *(
                row(entry, result, verdicts[result.name], formulas, same)
                for result, same in zip(entry.results, shared, strict=True)
            ),
            *(
                f'<tr class="slip"><td colspan="5">Misprint: the book {checks.code(s.sentence)}.'
                for s in entry.misprints
            ),
            *(f'<tr class="slip"><td colspan="5">Damaged: our copy {checks.code(s.sentence)}.' for s in entry.damage),
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
            choice("What was done", "status", [(status, status) for status in STATUSES]),
            choice("Chapter", "chapter", titles().items()),
            '<p aria-live="polite"><output></output> <button type="reset">Show all</button></p>',
            "</form>",
        ]
    )


def totals():
    """Return the numbers of results by source and by what was done; each number shows its rows."""
    counted = errata.totals(sources())
    head = "".join(f'<th scope="col">{name}' for name in ("source", *STATUSES, "all"))
    lines = ['<div class="ledger-frame" tabindex="0" role="region" aria-label="totals">', '<table class="totals">']
    lines.append(f"<caption>Results by source and by what was done</caption><thead><tr>{head}</thead><tbody>")
    for name, source in sources().items():
        numbers = [*counted[name].items(), ("", sum(counted[name].values()))]
        shown = "".join(
            f'<td><a href="?source={name}{f"&amp;status={word}" if word else ""}">{number}</a>' if number else "<td>0"
            for word, number in numbers
        )
        lines.append(f'<tr><th scope="row">{html.escape(source.title)}{shown}')
    sums = {word: sum(row[word] for row in counted.values()) for word in STATUSES}
    shown = "".join(f'<td><a href="?status={word}">{number}</a>' for word, number in sums.items())
    lines.append(f'<tr><th scope="row">all{shown}<td>{sum(sums.values())}</tbody></table></div>')
    meanings = "".join(
        f'<dt class="{word}">{status.mark[0]} {word}<dd>{html.escape(status.meaning)}'
        for word, status in STATUSES.items()
    )
    return "\n".join(lines) + f'\n<dl class="statuses simple">{meanings}</dl>'


def criteria():
    """Return the criteria for words as a table: the word, what it means, and why."""
    head = "".join(f'<th scope="col">{name}' for name in ("word", "means", "because"))
    rows = [
        f'<tr><th scope="row">{html.escape(c.word)}<td>{html.escape(c.meaning)}<td>{html.escape(c.reason)}'
        for c in CRITERIA
    ]
    return "\n".join(
        [
            '<div class="ledger-frame" tabindex="0" role="region" aria-label="criteria">',
            '<table class="criteria"><caption>What words mean</caption>',
            f"<thead><tr>{head}</thead><tbody>",
            *rows,
            "</tbody></table></div>",
        ]
    )


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
    """`ledger-totals`: the numbers of results by what was done and by source."""

    def run(self):
        return [nodes.raw("", totals(), format="html")]


class Criteria(SphinxDirective):
    """`ledger-criteria`: what the words mean that evidence rests on."""

    def run(self):
        return [nodes.raw("", criteria(), format="html")]


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
    app.add_directive("ledger-criteria", Criteria)
    app.connect("html-page-context", add_assets)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
