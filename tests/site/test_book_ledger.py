"""The book's pages that are written from data: the ledger, the reference, and what the repository's own pages say.

Nothing is built here. `test_book` makes the site and follows its links.
"""

import doctest
import html.parser
import importlib
import json
import re
import sys
from pathlib import Path

import pytest
import sympy

from bookledger.evidence.values import NUMBER
from bookledger.statuses import STATUSES
from loopbook.evidence import CRITERIA
from loopbook.ledger import sources

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MIME_TYPE = "application/vnd.loopbook.check+json"
sys.path.insert(0, str(DOCS / "extensions"))

pytest.importorskip("sphinx", reason="the book's extra is not installed")
import checks  # noqa: E402  (of docs/extensions)
import ledger_page  # noqa: E402  (of docs/extensions)
import library  # noqa: E402
import repository_pages  # noqa: E402
import slugs  # noqa: E402

#: Of the entries that a chapter checks; pytest says of which none does, as it proves the ledger.
RESULTS = [(entry, row) for entry in ledger_page.checked() for row in entry.results]


class Table(html.parser.HTMLParser):
    """The rows of the ledger's tables by their ids, and the links of its entries."""

    def __init__(self):
        super().__init__()
        self.rows, self.links, self.row, self.body, self.notes = {}, {}, None, "", []

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag == "tbody":
            self.body = attrs["id"]
        elif tag == "tr":
            self.row = {"cells": [], "classes": [], "body": self.body}
            if "id" in attrs:
                assert attrs["id"] not in self.rows
                self.rows[attrs["id"]] = self.row
            elif attrs.get("class") in ("why", "slip"):
                self.notes.append(self.row)
        elif tag in ("td", "th"):
            self.row["cells"].append("")
            self.row["classes"].append(attrs.get("class"))
        elif tag == "a" and self.body:
            assert self.body not in self.links
            self.links[self.body] = attrs["href"]

    def handle_endtag(self, tag):
        if tag == "tbody":
            self.row = None
        elif tag == "section":
            self.body = ""

    def handle_data(self, data):
        if self.row and self.row["cells"]:
            self.row["cells"][-1] += data


@pytest.fixture(scope="module")
def page():
    table = Table()
    for chapter in ledger_page.pages_with_results():
        table.feed(ledger_page.page(chapter, formulas=as_written))
    return table


def as_written(cell):
    return cell


def row_of(page, entry, result):
    return page.rows[slugs.ledger_anchor(entry.source, entry.name, result.name)]


def test_every_result_has_its_row_and_no_other_is_there(page):
    assert len(page.rows) == len(RESULTS) > 1200
    for entry, result in RESULTS:
        assert row_of(page, entry, result)["body"] == slugs.ledger_anchor(entry.source, entry.name)


def test_every_entry_leads_to_a_cell_that_checks_it(page):
    checked = set()
    for chapter in (ROOT / "chapters").glob("*.ipynb"):
        for cell in json.loads(chapter.read_text(encoding="utf-8"))["cells"]:
            for output in cell.get("outputs", []):
                if check := output["data"].get(MIME_TYPE) if "data" in output else None:
                    anchor = slugs.check_anchor(check["source"], check["entry"])
                    checked.add(f"../chapters/{chapter.stem}.html#{anchor}")
    assert set(page.links.values()) == checked
    assert len(page.links) == len(checked)


def test_every_row_says_what_the_ledger_says(page):
    for entry, result in RESULTS:
        row, word = row_of(page, entry, result), result.status.word
        verdict, equation, title, *book, computed = row["cells"]
        assert equation == (f"({result.equation})" if result.equation else "")
        sign = re.escape(STATUSES[word].mark[0])
        assert re.fullmatch(rf"{sign}\xa0{word}( at random points| a near thing|)+", verdict.strip())
        assert row["classes"][0] == f"verdict {word.replace(' ', '-')}"
        if result.printed.kind == "claim":
            assert (title, book) == (result.printed.text + " (denies it)" * (not result.printed.says), [])
        elif result.printed.kind != "formula" and result.printed.text not in ("oo", "-oo"):
            assert book == [f"{result.printed.text} {result.unit}".strip()]
        assert (computed.strip() == "–") is not result.is_checked


def test_computed_numbers_are_those_that_the_ledger_accepts(page):
    numbers = [(entry, row) for entry, row in RESULTS if NUMBER.fullmatch(row.printed.text) and row.is_checked]
    assert len(numbers) > 150
    for entry, result in numbers:
        computed = row_of(page, entry, result)["cells"][-1].strip().replace("the same", result.printed.text)
        exact = computed.removeprefix(r"$\displaystyle ").strip("$").replace(" ", "")
        value = sympy.oo if exact == r"\infty" else sympy.Rational(re.sub(r"\\dfrac{(-?\d+)}{(\d+)}", r"\1/\2", exact))
        assert result.judge(value).holds, f"{entry.source}, {entry.name}: {result.name} = {computed}"


def test_every_reason_is_told(page):
    notes = " ".join(note["cells"][0] for note in page.notes)
    for _, result in RESULTS:
        told = [getattr(result.status, key, "") for key in ("correct", "because", "on", "library", "tried")]
        told.append(getattr(getattr(result.status, "assuming", None), "text", ""))
        assert all(text.replace("`", "") in notes for text in told)


def test_slips_of_the_print_are_told(page):
    notes = " ".join(note["cells"][0] for note in page.notes)
    slips = [slip for entry in ledger_page.checked() for slip in entry.misprints]
    assert len(slips) > 5
    assert all(slip.because.replace("`", "") in notes for slip in slips)


VERDICT = {
    "name": "y", "kind": "claim", "title": "A < B grows.", "book": "says so", "computed": "Ms 2 > 1",
    "status": "computed", "word": "computed (a near thing)", "holds": True,
}  # fmt: skip


def test_a_check_shows_the_verdict_first_and_escapes_what_is_no_formula():
    cells = checks.cells(VERDICT)
    assert cells.startswith('<td class="verdict computed">✓&nbsp;computed <small>a near thing</small>')
    assert '<th scope="row" class="claim" colspan="2">A &lt; B grows.' in cells
    assert '<td class="value">Ms 2 &gt; 1' in cells
    assert "<math" in checks.cells(VERDICT | {"tex": {"computed": "gain $K T$ > 0"}})
    assert "✗" in checks.cells(VERDICT | {"holds": False})


def test_what_words_mean_is_on_the_page():
    told = ledger_page.criteria()
    assert all(c.word in told and c.meaning in told and c.reason in told for c in CRITERIA)


def test_the_search_offers_all_sources_statuses_and_chapters():
    form = ledger_page.controls()
    offered = re.findall(r'<option value="([^"]+)"', form)
    chapters = sorted({entry.chapter for source in sources().values() for entry in source if entry.results})
    assert offered == [*sources(), *STATUSES, *chapters]
    assert form.count("<label") == form.count("<select") + form.count("<input")


def test_the_search_looks_through_the_rows_of_the_pages():
    script = ledger_page.data(as_written)
    known = json.loads(script.removeprefix("window.loopbookLedger = ").removesuffix(";\n"))
    found = {(entry[2], row[0], row[1]) for entry in known["entries"] for row in entry[6]}
    assert found == {
        (slugs.ledger_anchor(entry.source, entry.name), result.name, result.status.word) for entry, result in RESULTS
    }


def test_each_page_is_listed_with_its_number_of_results():
    listed = dict(re.findall(r'href="ledger/(\w+)\.html">[^<]*</a> <small>(\d+)', ledger_page.ways()))
    assert {chapter: int(number) for chapter, number in listed.items()} == ledger_page.pages_with_results()
    assert sum(map(int, listed.values())) == len(RESULTS)


def test_the_totals_add_up():
    cells = re.findall(r"<td>(?:<a [^>]*>)?(\d+)", ledger_page.totals())
    written = [row for source in sources().values() for entry in source for row in entry.results]
    assert int(cells[-1]) == len(written) == sum(map(int, cells[-1 - len(STATUSES) : -1]))


def test_every_module_of_the_readme_has_its_page_in_the_reference():
    pages = {file.stem: file.read_text(encoding="utf-8") for file in (DOCS / "reference").glob("*.rst")}
    del pages["index"]
    names = [name for names, _ in library.modules() for name in names]
    assert sorted(names) == sorted(pages)
    for name, text in pages.items():
        assert f".. library:: {library.address_of(name)}\n" in text


@pytest.mark.parametrize("name", [name for names, _ in library.modules() for name in names])
def test_every_public_name_has_a_docstring(name):
    module = importlib.import_module(library.address_of(name))
    assert module.__doc__
    assert all(getattr(module, key).__doc__ for key in getattr(module, "__all__", ()))


def test_the_reference_follows_the_source():
    names = library.offered(importlib.import_module("loopbook.tuning"))
    assert names.index("good_gain") < names.index("simc") < names.index("adjusted") < names.index("cohen_coon")
    names = library.offered(importlib.import_module("loopbook.exercises.authoring"))
    assert names.index("answers") < names.index("exercise") < names.index("between")


def test_what_the_repository_says_is_found_and_leads_somewhere():
    blocks = [
        (file, dict(repository_pages.OPTION.findall(options)))
        for page in DOCS.glob("*.md")
        for file, options in repository_pages.BLOCK.findall(page.read_text(encoding="utf-8"))
    ]
    assert {"ERRATA.md", "CONTRIBUTING.md", "README.md"} < {file for file, _ in blocks}
    for file, options in blocks:
        text = repository_pages.text_of(file, options.get("from", ""), options.get("until", ""))
        assert text.strip()
        for link in re.findall(r"\]\((/[^)#\s]+)", text):
            folder = ROOT if link.endswith(".ipynb") else DOCS
            assert (folder / link[1:]).exists(), f"{file} leads to {link}"


def test_a_place_that_is_not_there_is_named():
    with pytest.raises(ValueError, match=r"README\.md does not hold 'no such text'"):
        repository_pages.text_of("README.md", "no such text")


@pytest.mark.parametrize("module", [ledger_page, library, repository_pages, slugs], ids=lambda module: module.__name__)
def test_examples(module):
    assert not doctest.testmod(module).failed
