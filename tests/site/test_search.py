"""The search: its index is small and knows what the book says, what one types instead, and the numbers of equations."""

import json
import re
import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

from browser import DESKTOP, PATIENCE, PHONE, SCREENSHOTS, Complaints, serious, served

ROOT = Path(__file__).parents[2]
LARGEST = 600_000  # bytes that the first search loads
LARGEST_TEXT = 150_000  # and for the excerpts of one page
sys.path.insert(0, str(ROOT / "docs" / "extensions"))

import search_index  # noqa: E402 - of docs/extensions/, which has just become a place to import from


@pytest.fixture(scope="module")
def index(book):
    text = (book / "_static" / "search" / "index.js").read_text(encoding="utf-8")
    return json.loads(text[text.index("{", text.index(".index")) : text.rindex("}") + 1])


def test_a_search_loads_little(book):
    sizes = {file.stem: file.stat().st_size for file in (book / "_static" / "search").glob("*.js")}
    assert sizes.pop("index") < LARGEST
    assert {page: size for page, size in sizes.items() if size > LARGEST_TEXT} == {}


def test_every_section_of_a_chapter_can_be_found(book, index):
    named = {(index["pages"][page][0], place) for page, place, *_ in index["sections"]}
    for page, place in named:
        assert f'id="{place}"' in (book / f"{page}.html").read_text(encoding="utf-8"), (page, place)
    chapters = {page for page, _ in named if page.startswith("chapters/")}
    assert chapters == {f"chapters/{file.stem}" for file in (ROOT / "chapters").glob("[01A]*.ipynb")} - {
        "chapters/00_start"
    }
    assert len(named) > 1000


def test_what_one_types_leads_to_what_the_book_says(index):
    """Each word on the right of search_words.txt is one that the book has."""
    known = set(index["words"].split())
    said = {word for _, meant, _ in index["aliases"] for other in meant for word in other.split()}
    assert said - known - set(index["common"].split()) == set()


def test_postings_come_back():
    pages = {"chapters/a": [("one", "Half rule", "", "the half rule halves a lag", []), ("two", "Else", "", "lag", [])]}
    index = search_index.index(pages, {"chapters/a": "A"})
    entries = dict(zip(index["words"].split(), index["entries"].split(), strict=True))
    places = {name: [search_index.ALPHABET.index(letter) for letter in text[::2]] for name, text in entries.items()}
    assert places["lag"] == [0, 1], "the first section, and one after it"
    assert places["half"] == [0]
    assert "the" not in entries


def test_a_line_without_a_sign_is_named():
    with pytest.raises(ValueError, match=r"'wind up'.*expected"):
        search_index.aliases("wind up")


#: What is typed, and what is to be among the first three places: a part of its address.
ASKED = {
    "windup": "chapters/07_feedback.html#example-7-4",
    "anti-windup": "chapters/07_feedback.html",
    "half rule": "chapters/14_model_approximation.html",
    "smith predictor": "chapters/17_dead_time_compensation.html",
    "lambda tuning": "chapters/15_direct_synthesis.html",
    "deadtime": "chapters/",
    "Ziegler": "chapters/16_tuning_relations.html",
    "zigler": "chapters/16_tuning_relations.html",
    "10.15": "chapters/10_tuning.html#equation-10-15",
    "Eq. (10.15)": "chapters/10_tuning.html#equation-10-15",
    "example 7.4": "chapters/07_feedback.html#example-7-4",
    "Table 12.3": "chapters/16_tuning_relations.html#table-12-3",
    "first_order": "reference/transfer.html#loopbook.transfer.first_order",
}
#: What a beginner asks, and where the first place is. (The library's reference is never first: nobody asked for code.)
QUESTIONS = {
    "how do I tune a PID": "chapters/10_tuning.html#tuning-of-pid-controllers",
    "parallel series": "chapters/10_tuning.html#section-10-3-4-further",
    "PID form parallel series": "chapters/10_tuning.html#section-10-3-4-further",
    "time constant": "chapters/06_dynamics.html#section-6-3",
    "what is dead time?": "chapters/06_dynamics.html#section-6-4",
    "simc": "chapters/10_tuning.html#table-10-1",
    "why does my loop oscillate": "chapters/07_feedback.html#section-7-5",
    "How do I choose the integral time?": "chapters/10_tuning.html#tuning-of-pid-controllers",
    "difference between PI and PID": "chapters/07_feedback.html#section-7-3-2",
    "what is a transfer function": "chapters/05_transfer_functions.html#transfer-functions",
    "my controller output jumps when the setpoint changes": "chapters/07_feedback.html#example-7-3",
    "when do I need cascade control": "chapters/11_control_structures.html#section-11-1",
    "inverse laplace": "chapters/04_laplace.html#section-4-3",
    "noisy measurement": "chapters/07_feedback.html#section-7-2-2",
    "where do I start": "index.html#where-to-begin",
}
#: What is not in the books, or not under that name: a word of what is said above the places.
NOT_THERE = {"root locus": "no root locus", "bode plot": "Nyquist", "kalman filter": "not in these books"}


class TestInABrowser:
    @pytest.mark.parametrize("way", ["http", "file"])
    def test_the_search_finds_what_is_asked(self, chromium, book, way):
        with served(book.parent) as server:
            page = chromium.new_page(viewport=DESKTOP)
            page.set_default_timeout(PATIENCE)
            complaints = Complaints(page)
            page.goto(f"{server}{book.name}/index.html" if way == "http" else (book / "index.html").as_uri())
            page.keyboard.press("Control+k")
            field, said = page.get_by_role("searchbox", name="Search the book"), page.locator(".search-said")
            missed = {}
            for text, address in ASKED.items():
                field.fill("")
                expect(said).to_have_text("")
                field.fill(text)
                expect(said).not_to_have_text("")
                links = page.locator(".search-found a").evaluate_all("links => links.map(link => link.href)")
                if not any(address in link for link in links[:3]):
                    missed[text] = links[:3]
            assert missed == {}
            for text, address in QUESTIONS.items():
                field.fill(text)
                expect(page.locator(".search-found a").first).to_have_attribute("href", re.compile(re.escape(address)))
            for text, words in NOT_THERE.items():
                field.fill(text)
                expect(said.locator("strong")).to_contain_text(words)
                expect(page.locator(".search-found a").first).to_have_attribute("href", re.compile("^./chapters/"))
            field.fill("half rule")
            expect(page.locator(".search-excerpt mark").first).to_be_visible()
            page.screenshot(path=SCREENSHOTS / f"search_{way}.png")
            page.close()
            assert complaints == []

    def test_the_keyboard_is_enough(self, chromium, book):
        """Opened, asked, walked and followed; and closed again."""
        page = chromium.new_page(viewport=PHONE)
        page.set_default_timeout(PATIENCE)
        page.goto((book / "chapters" / "01_introduction.html").as_uri())
        page.keyboard.press("/")
        page.keyboard.type("cascade")
        links = page.locator(".search-found a")
        expect(links.nth(1)).to_be_visible()
        page.keyboard.press("ArrowDown")
        page.keyboard.press("ArrowDown")
        expect(links.nth(1)).to_be_focused()
        page.keyboard.press("ArrowUp")
        expect(links.nth(0)).to_be_focused()
        found = serious(page, resultTypes=["violations"])
        page.keyboard.press("Escape")
        expect(page.locator("dialog[open]")).to_have_count(0)
        page.keyboard.press("Control+k")
        page.keyboard.press("Enter")
        page.wait_for_url("**/11_control_structures.html*")
        page.close()
        assert found == []

    def test_the_page_of_the_search_has_the_same(self, chromium, book):
        page = chromium.new_page(viewport=DESKTOP)
        page.set_default_timeout(PATIENCE)
        page.goto(f"{(book / 'search.html').as_uri()}?q=feedforward")
        expect(page.locator(".search-found a b", has_text="Feedforward").first).to_be_visible()
        page.close()
