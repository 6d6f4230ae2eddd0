"""On paper: a chapter's core on few sheets, each with its title and number; and the whole book as one PDF."""

import importlib.util
import io
import re
from pathlib import Path

import pypdf
import pytest

import browser
from draws import THOROUGH

ROOT = Path(__file__).parents[2]
SHEETS = 15  # of a chapter's core
#: Those whose core is the longest; all of them once a week.
LONGEST = ["07_feedback", "12_sequential_control", "17_dead_time_compensation"]
CHAPTERS = [path.stem for path in sorted(ROOT.glob("chapters/*.ipynb")) if path.stem != "00_start"]


@pytest.fixture(scope="module")
def printer():
    """The program that makes the PDF of the book, docs/pdf."""
    spec = importlib.util.spec_from_file_location("pdf_of_the_book", ROOT / "docs" / "pdf" / "__main__.py")
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    return program


def read(pdf):
    return pypdf.PdfReader(io.BytesIO(pdf))


class TestPaper:
    @pytest.mark.parametrize("name", CHAPTERS if THOROUGH else LONGEST)
    def test_the_core_of_a_chapter_is_on_few_sheets(self, chromium, book, name):
        page = chromium.new_page(viewport=browser.DESKTOP, color_scheme="dark")
        page.goto((book / "chapters" / f"{name}.html").as_uri())
        title = page.title().removesuffix(" - loopbook")
        page.evaluate("window.print = () => { window.printed = true; }")
        page.get_by_role("group", name="Print").get_by_role("button", name="the core").click()
        page.wait_for_function("window.printed", timeout=browser.PATIENCE)
        page.emulate_media(media="print")
        headings = [heading.text_content() for heading in page.locator("article h2").all() if heading.is_visible()]
        assert headings
        assert not [heading for heading in headings if "How we know" in heading]
        sheets = read(page.pdf(prefer_css_page_size=True, print_background=True)).pages
        page.close()
        texts = [re.sub(r"\s+", " ", sheet.extract_text()) for sheet in sheets]
        assert len(sheets) <= SHEETS
        assert not [text for text in texts if "Skip to content" in text]
        for number, text in enumerate(texts[1:], start=2):
            assert text.startswith(f"{title} {number} "), text[:80]


@pytest.fixture(scope="class")
def pdf(chromium, book, printer):
    """The book of one chapter and its solutions: the others are made alike, and take a minute."""
    parts = printer.parts(book)
    for part in parts:
        part["pages"] = [page for page in part["pages"] if "05_transfer_functions" in page]
    return read(printer.made(chromium, book, parts))


class TestWholeBook:
    def test_it_says_what_it_is(self, pdf):
        assert pdf.metadata.title == "loopbook"
        assert pdf.metadata.author

    def test_the_contents_have_the_numbers_of_the_sheets(self, pdf):
        texts = [sheet.extract_text() for sheet in pdf.pages]
        lines = re.findall(r"^(.+ \((?:Section|Example) [\d.]+\)|Solutions(?: · .+?)?) ?(\d+)$", texts[1], re.MULTILINE)
        assert len(lines) >= 8
        for title, number in lines:
            assert title in texts[int(number) - 1], (title, number)

    def test_bookmarks_lead_to_chapter_sections_and_solutions(self, pdf):
        chapter, sections, solutions, inside = pdf.outline
        assert (chapter.title, solutions.title) == ("5 · Transfer functions", "Solutions")
        assert [mark.title for mark in inside] == ["Solutions · 5 · Transfer functions"]
        assert "How we know" in [mark.title for mark in sections], "further reading is in the book"
        for mark in (chapter, *sections, solutions):
            assert mark.title in pdf.pages[pdf.get_destination_page_number(mark)].extract_text()

    def test_links_lead_to_places_within_or_to_public_addresses(self, pdf):
        inside = 0
        for sheet in pdf.pages:
            for note in sheet.get("/Annots") or []:
                link = note.get_object()
                if "/Dest" in link:
                    assert link["/Dest"] in pdf.named_destinations
                    inside += 1
                elif "/A" in link:
                    assert link["/A"]["/URI"].startswith("https://")
        assert inside > 10, "the lines of the contents alone"
