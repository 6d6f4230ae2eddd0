"""How a chapter is read: its core or all, with its code or without; what a check means; and where a reader begins."""

import re
import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

from browser import DESKTOP, PATIENCE, PHONE, SCREENSHOTS, WATCH, Complaints, seen, serious, served

ROOT = Path(__file__).parents[2]
TUNING = "chapters/10_tuning.html"
CODE = "div.cell_input:not(details *)"  # of the core, and not folded
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "docs" / "extensions")]

import reading  # noqa: E402 - of docs/extensions/, which has just become a place to import from
from lessons import titles  # noqa: E402

CHAPTERS = [path.stem for path in sorted(ROOT.glob("chapters/*.ipynb")) if path.stem != "00_start"]


def markdown(text):
    return {"cell_type": "markdown", "source": text}


def code(text, *tags):
    return {"cell_type": "code", "source": text, "metadata": {"tags": list(tags)}, "outputs": []}


def test_the_minutes_are_those_of_the_core_with_its_code_and_lessons():
    words = markdown("## One\n" + "word " * 750)
    whole = [words, code("x = 1\n" * 50), code("@sliders({})\ndef f(): ...")]
    assert reading.minutes([words]) == 15
    assert reading.minutes(whole) == 25, "5 for the code, 3 for the lesson"
    further = [markdown("## Two\n\n*Further: more.*\n" + "word " * 999), code("x = 1\n" * 50)]
    assert reading.minutes(whole + further) == reading.minutes(whole)
    assert reading.minutes([words, code("x = 1\n" * 50, "hide-input")]) == 15


@pytest.mark.parametrize("name", CHAPTERS)
def test_a_chapter_says_what_its_counts_mean_where_they_are_first(book, name):
    text = (book / "chapters" / f"{name}.html").read_text(encoding="utf-8")
    summaries = re.findall(r"<summary>. <strong>.*?</strong>: ([\w ,]+)</summary>", text)
    meanings = re.findall(r'<p class="means">(.*?)</p>', text)
    explained = re.findall(r"<strong>([\w ]+)</strong>: ", " ".join(meanings), re.IGNORECASE)
    assert meanings[0].startswith("A check compares")
    assert len(set(explained)) == len(explained), "each once"
    assert {word for counts in summaries for word in re.findall(r"\d+ ([a-z ]+)", counts)} <= set(explained)


def test_the_front_page_leads_to_every_lesson_and_pictures_every_chapter(book):
    text = (book / "index.html").read_text(encoding="utf-8")
    tiles = re.findall(r"<li><a href=\"chapters/(\w+)\.html\".*?</li>", text, re.DOTALL)
    assert tiles == CHAPTERS
    for chapter, name, _ in titles():
        assert f'href="chapters/{chapter}.html#lesson-{name}"' in text
    for picture in re.findall(r'<img src="(_images/\w+\.png)"', text):
        assert (book / picture).is_file()


@pytest.fixture(scope="class")
def address(book):
    with served(book.parent) as server:
        yield f"{server}{book.name}"


@pytest.fixture
def page(chromium, address):
    context = chromium.new_context(viewport=DESKTOP, service_workers="block")
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    complaints = Complaints(page, noise=("Service Worker registration blocked",))
    yield page
    context.close()
    assert complaints == []


class TestSwitches:
    def test_the_core_is_shown_and_what_a_reader_chooses_is_kept(self, page, address):
        page.goto(f"{address}/{TUNING}")
        further, fold = page.locator("section.further"), page.locator("details.further")
        inside = further.first.locator("div.cell").first
        assert further.count() > 5
        expect(further.first.get_by_role("heading").first).to_be_visible()
        expect(fold.first.locator("> summary")).to_contain_text("limits of the Good Gain method")
        expect(inside).to_be_hidden()
        page.get_by_role("group", name="Show").get_by_role("button", name="all").click()
        expect(inside).to_be_visible()
        page.get_by_role("group", name="Code").get_by_role("button", name="hidden").click()
        expect(page.locator(CODE).first).to_be_hidden()
        expect(page.locator("div.cell_output").first).to_be_visible()
        page.goto(f"{address}/chapters/07_feedback.html")
        expect(page.locator("details.further:not([open])")).to_have_count(0)
        expect(page.locator(CODE).first).to_be_hidden()
        code = page.get_by_role("group", name="Code")
        expect(code.get_by_role("button", name="hidden")).to_have_attribute("aria-pressed", "true")
        page.screenshot(path=SCREENSHOTS / "reading_without_code.png")
        code.get_by_role("button", name="shown").click()
        expect(page.locator(CODE).first).to_be_visible()

    @pytest.mark.parametrize("place", ["section-10-3-4-further", "table-10-1-further", "equation-10-23"])
    def test_a_link_into_a_folded_section_opens_it(self, page, address, place):
        page.goto(f"{address}/{TUNING}")
        page.evaluate("place => { location.hash = place }", place)
        expect(page.locator("details.further[open]")).to_have_count(1)
        expect(page.locator(f'[id="{place}"]').locator("xpath=ancestor-or-self::section").last).to_be_in_viewport()

    def test_a_hit_of_the_search_opens_it_too(self, page, address):
        page.goto(f"{address}/{TUNING}")
        page.keyboard.press("Control+k")
        page.keyboard.type("parallel series")
        expect(page.locator(".search-found a").first).to_contain_text("Serial and parallel settings")
        page.keyboard.press("Enter")
        expect(page.locator("details.further[open] > summary")).to_contain_text("settings of a parallel controller")

    def test_exercises_keep_their_choices(self, page, address):
        """The switches have a look of their own, and take nothing else for one of them."""
        page.goto(f"{address}/chapters/12_sequential_control.html")
        expect(page.locator(".exercise .choices").first).to_be_visible()
        expect(page.locator(".switches")).to_have_count(1)

    @pytest.mark.parametrize("chosen", [{}, {"loopbook-show": "all", "loopbook-code": "none"}])
    def test_nothing_moves_and_nobody_is_shut_out(self, page, address, chosen):
        page.add_init_script(WATCH)
        page.set_viewport_size(PHONE)
        page.add_init_script(f"Object.assign(localStorage, {chosen})")
        page.goto(f"{address}/{TUNING}")
        assert seen(page)["moved"] < 0.01
        assert page.evaluate("document.documentElement.scrollWidth") == PHONE["width"]
        assert serious(page, part=".switches, section.further") == []

    def test_without_a_script_all_can_be_read(self, chromium, book):
        page = chromium.new_page(java_script_enabled=False)
        page.set_default_timeout(PATIENCE)
        page.goto((book / TUNING).as_uri())
        fold = page.locator("details.further").first
        expect(page.locator(".switches")).to_be_hidden()
        fold.locator("> summary").click()
        expect(fold.locator("div.cell").first).to_be_visible()
        page.close()

    def test_the_first_screen_says_for_whom_which_books_and_where_to_begin(self, page, address):
        page.goto(f"{address}/index.html")
        for name in ("Haugen", "Skogestad", "Seborg", "Syder", "students", "Begin here", "One evening", "Four weeks"):
            expect(page.locator("article :is(p, strong)", has_text=name).first).to_be_in_viewport()
        assert serious(page, part=".doors, ol.chapters") == []
