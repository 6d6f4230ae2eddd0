"""The ledger as pages: every result that a book prints, what a computation makes of it, and the cell that shows it.

The results of a chapter are a page, `ledger/10_tuning.html`, a table for each source: whole without a script. The page
`ledger.html` counts them, leads to them, and searches all of them. For the search, `_static/ledger.js` fetches the
rows as data when it is first used. What is computed is the data that the chapters store with their checks.
"""

import functools
import html
import json
from itertools import pairwise
from pathlib import Path
from urllib.parse import quote

import checks
import single_figures
from docutils import nodes
from mathml import in_html
from slugs import check_anchor, ledger_anchor
from sphinx.util.docutils import SphinxDirective

from bookledger import errata
from bookledger.statuses import STATUSES
from bookledger.stored import checks as checks_in
from loopbook.evidence import CRITERIA
from loopbook.ledger import sources

CHAPTERS = Path(__file__).parents[2] / "chapters"
PAGE = "ledger"
COLUMNS = (*checks.COLUMNS[:-1], "computed, or evidence")


@functools.cache
def stored(folder=CHAPTERS):
    """Return the checks in the stored chapters: {(source, entry): (chapter, verdicts by name)}."""
    return {
        (check["source"], check["entry"]): (file.stem, {verdict["name"]: verdict for verdict in check["verdicts"]})
        for file in sorted(folder.glob("*.ipynb"))
        for check in checks_in(json.loads(file.read_text(encoding="utf-8")))
    }


def titles():
    """Return the titles of the chapters by their names, in their order."""
    return {file.stem: single_figures.title_of(file.stem) for file in sorted(CHAPTERS.glob("*.ipynb"))}


def note(result):
    """Return what a reader must know of a result besides: the correction, the reason, the assumption."""
    status = result.status
    if correct := getattr(status, "correct", ""):
        should = f"It should say: {correct}" if result.printed.kind == "claim" else f"It should be `{correct}`:"
        return f"{should} {status.because}."
    text = status.note
    return f"{text[:1].upper()}{text[1:]}." if text else ""


@functools.cache
def rows(formulas=in_html):
    """Return what the pages and the search show of all entries, in the order of the sources.

    Arguments:
        formulas: what writes those of a text as HTML.

    An entry is a dictionary: its `source`, `chapter` and `place`, the address of its `cell` within the chapter's page,
    its `name` and `title`, its `results` as tuples (name, status, words that a search finds it by besides its cells,
    cells, note), and the `slips` of its print.
    """
    made = []
    for entry in checked():
        chapter, verdicts = stored()[entry.source, entry.name]
        slips = [f"Misprint: the book {checks.code(slip.sentence)}." for slip in entry.misprints]
        slips += [f"Damaged: our copy {checks.code(slip.sentence)}." for slip in entry.damage]
        made.append(
            {
                "source": entry.source,
                "chapter": chapter,
                "place": ledger_anchor(entry.source, entry.name),
                "cell": check_anchor(entry.source, entry.name),
                "name": entry.name,
                "title": entry.title,
                "results": [row(result, verdicts[result.name], formulas) for result in entry.results],
                "slips": slips,
            }
        )
    return made


def checked():
    """Return the entries that a chapter checks; of another one there is nothing to show, and the tests ask for it."""
    return [entry for source in sources().values() for entry in source if (entry.source, entry.name) in stored()]


def row(result, verdict, formulas):
    """Return a result as `rows` has it."""
    # what its cells do not say: the name, and formulas as they are typed
    typed = (verdict["book"], verdict["computed"]) if "tex" in verdict else ()
    words = " ".join(dict.fromkeys([result.name, *typed]))
    return result.name, verdict["status"], words, checks.cells(verdict, formulas), checks.code(note(result))


def table(source, entries):
    """Return the table of a source's entries in one chapter; a note that results share is below the last of them."""
    head = "".join(f'<th scope="col">{name}' for name in COLUMNS)
    parts = [
        f'<div class="ledger-frame" tabindex="0" role="region" aria-labelledby="ledger-{source.name}">',
        f'<table class="ledger results"><caption id="ledger-{source.name}">{html.escape(source.citation)}</caption>',
        f"<thead><tr>{head}</thead>",
    ]
    for entry in entries:
        cell = f"../chapters/{entry['chapter']}.html#{entry['cell']}"
        parts += [
            f'<tbody id="{entry["place"]}">',
            f'<tr class="entry"><th scope="rowgroup" colspan="5"><a href="{cell}">{html.escape(entry["name"])}</a>'
            f" · {html.escape(entry['title'])}",
        ]
        for (name, _, _, cells, why), after in pairwise([*entry["results"], ("",) * 5]):
            parts.append(f'<tr id="{entry["place"]}.{name}"{" class=noted" if why else ""}>{cells}')
            if why and why != after[-1]:
                parts.append(f'<tr class="why"><td colspan="5">{why}')
        parts += [*(f'<tr class="slip"><td colspan="5">{slip}' for slip in entry["slips"]), "</tbody>"]
    return "\n".join([*parts, "</table>", "</div>"])


def page(chapter, formulas=in_html):
    """Return the page of the results of a chapter."""
    entries = [entry for entry in rows(formulas) if entry["chapter"] == chapter]
    tables = [
        table(source, own)
        for source in sources().values()
        if (own := [entry for entry in entries if entry["source"] == source.name])
    ]
    return "\n".join(
        [
            f"<section><h1>Results of chapter {html.escape(titles()[chapter])}</h1>",
            f"<p>The books print {pages_with_results()[chapter]} results on the subject of "
            f'<a href="../chapters/{chapter}.html">this chapter</a>. Here they are next to what the chapter computes. '
            f'<a href="../{PAGE}.html">The ledger</a> has those of all chapters, and explains the verdicts.</p>',
            *tables,
            "</section>",
        ]
    )


def pages_with_results():
    """Return the chapters that have results, with their numbers: {chapter: number}."""
    counted = dict.fromkeys(titles(), 0)
    for entry in checked():
        counted[entry.chapter] += len(entry.results)
    return {chapter: number for chapter, number in counted.items() if number}


def data(formulas=in_html):
    """Return what the search looks through, as a script, because a page opened from a disk may load no other data."""
    entries = [list(entry.values()) for entry in rows(formulas)]
    known = {
        "sources": {source.name: source.citation for source in sources().values()},
        "columns": COLUMNS,
        "entries": entries,
    }
    return f"window.loopbookLedger = {json.dumps(known, ensure_ascii=False, separators=(',', ':'))};\n"


def controls():
    """Return the form that searches; a page without its script does not show it."""

    def choice(label, name, options):
        made = "".join(f'<option value="{value}">{html.escape(text)}</option>' for value, text in options)
        return f'<label>{label} <select name="{name}"><option value="">all</option>{made}</select></label>'

    names = [(source.name, source.citation) for source in sources().values()]
    return "\n".join(
        [
            '<form id="ledger-search" role="search" aria-label="the ledger">',
            '<label class="wide">Search <input type="search" name="q" autocomplete="off" '
            'placeholder="10.2, Ziegler, exp(-tau*s)"></label>',
            choice("Source", "source", names),
            choice("Verdict", "status", [(status, status) for status in STATUSES]),
            choice("Chapter", "chapter", [(name, titles()[name]) for name in pages_with_results()]),
            '<p aria-live="polite"><output></output> <button type="reset">Start again</button></p>',
            "</form>",
            "<noscript><style>#ledger-search { display: none; }</style></noscript>",
            # room for what an address asks for, so that nothing moves when it comes
            '<div id="ledger-found"></div>',
            '<script>if (location.search) document.getElementById("ledger-found").className = "coming";</script>',
        ]
    )


def ways():
    """Return the list of the pages."""
    lines = [
        f'<li><a href="{PAGE}/{chapter}.html">{html.escape(titles()[chapter])}</a> <small>{number}</small>'
        for chapter, number in pages_with_results().items()
    ]
    return "\n".join(['<ul class="ledger-ways">', *lines, "</ul>"])


def totals():
    """Return the numbers of results by source and by what was done; each number shows its rows."""
    counted = errata.totals(sources())
    head = "".join(f'<th scope="col">{name}' for name in ("source", *STATUSES, "all"))
    lines = ['<div class="ledger-frame" tabindex="0" role="region" aria-label="totals">', '<table class="totals">']
    lines.append(
        f"<caption>How many results there are, by source and verdict</caption><thead><tr>{head}</thead><tbody>"
    )
    for name, source in sources().items():
        numbers = [*counted[name].items(), ("", sum(counted[name].values()))]
        shown = "".join(
            f'<td><a href="?source={name}{f"&amp;status={quote(word)}" if word else ""}">{number}</a>'
            if number
            else "<td>0"
            for word, number in numbers
        )
        lines.append(f'<tr><th scope="row">{html.escape(source.title)}{shown}')
    sums = {word: sum(row[word] for row in counted.values()) for word in STATUSES}
    shown = "".join(f'<td><a href="?status={quote(word)}">{number}</a>' for word, number in sums.items())
    lines.append(f'<tr><th scope="row">all{shown}<td>{sum(sums.values())}</tbody></table></div>')
    meanings = "".join(
        f'<dt class="{word.replace(" ", "-")}">{status.mark[0]} {word}<dd>{html.escape(status.meaning)}'
        for word, status in STATUSES.items()
    )
    return "\n".join(lines) + f'\n<dl class="statuses simple">{meanings}</dl>'


def criteria():
    """Return the criteria for words of degree, and the measures of words that compare, as two tables."""
    words = [(c.word, ", ".join(c.degrees) or c.word, c.meaning, c.reason) for c in CRITERIA]
    measures = [
        (source.title, word, ", ".join(quantities))
        for source in sources().values()
        for word, quantities in source.language.measures.items()
    ]
    return "\n".join(
        [
            _words("What the words of a claim are taken to mean", ("word", "in the books", "means", "because"), words),
            _words("What comparisons are judged by", ("source", "what is compared", "by"), measures),
        ]
    )


def _words(caption, head, rows):
    """A table of words."""
    lines = [
        f'<tr><th scope="row">{first}{"".join(f"<td>{text}" for text in others)}'
        for first, *others in (map(html.escape, row) for row in rows)
    ]
    return "\n".join(
        [
            f'<div class="ledger-frame" tabindex="0" role="region" aria-label="{caption}">',
            f'<table class="criteria"><caption>{caption}</caption><thead><tr>',
            *(f'<th scope="col">{name}' for name in head),
            "</thead><tbody>",
            *lines,
            "</tbody></table></div>",
        ]
    )


PARTS = {"search": controls, "pages": ways, "totals": totals, "criteria": criteria}


class Ledger(SphinxDirective):
    """`{ledger} totals`: one of the parts of the ledger's page."""

    required_arguments = 1

    def run(self):
        for file in {CHAPTERS / f"{entry.chapter}.ipynb" for source in sources().values() for entry in source}:
            self.env.note_dependency(str(file))
        return [nodes.raw("", PARTS[self.arguments[0]](), format="html")]


def the_pages(app):
    """Make the pages of the chapters, and beside them what the search looks through."""
    if PAGE not in app.env.found_docs:
        return
    folder = Path(app.outdir, "_static")
    folder.mkdir(exist_ok=True)
    (folder / "ledger-rows.js").write_text(data(), encoding="utf-8")
    for chapter in pages_with_results():
        yield (
            f"{PAGE}/{chapter}",
            {"title": f"Results of chapter {titles()[chapter]}", "body": page(chapter)},
            "page.html",
        )


def add_assets(app, pagename, templatename, context, doctree):
    """The look of these pages and the script of the search, for no other page."""
    if pagename == PAGE or pagename.startswith(f"{PAGE}/"):
        app.add_css_file("ledger.css")
    if pagename == PAGE:
        app.add_js_file("ledger.js", loading_method="defer")


def setup(app):
    """Join Sphinx."""
    app.add_directive("ledger", Ledger)
    app.connect("html-collect-pages", the_pages)
    app.connect("html-page-context", add_assets)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
