"""The site in a browser: its pages, its search, its links and switches, its live lessons; and an audit."""

import pytest
from playwright.sync_api import expect

from browser import DESKTOP, PATIENCE, PHONE, SCREENSHOTS, Complaints, serious, served

#: A page of each kind. Of the ledger a few results of each status: the others look alike, and axe takes its time.
KINDS = {
    "front": "index.html",
    "chapter": "chapters/05_transfer_functions.html",
    "solution": "solutions/05_transfer_functions.html",
    "ledger": "ledger.html?chapter=10_tuning",
    "reference": "reference/deadtime.html",
}


def pages(book):
    """The addresses of all pages, seen from the front page."""
    return sorted(path.relative_to(book).as_posix() for path in book.rglob("*.html") if "_static" not in path.parts)


def with_lessons(book):
    return [page for page in pages(book) if 'type="range"' in (book / page).read_text(encoding="utf-8")]


class Reader:
    """A reader of the site: at a desk, on a phone, by day, by night."""

    def __init__(self, chromium, address, **habits):
        self.address = address
        self.page = chromium.new_page(viewport=DESKTOP, **habits)
        self.page.set_default_timeout(PATIENCE)
        self.complaints = Complaints(self.page)

    def go(self, page):
        self.page.goto(f"{self.address}/{page}")

    def screenshot(self, name):
        self.page.screenshot(path=SCREENSHOTS / f"site_{name}.png")


@pytest.fixture(scope="class")
def addresses(book):
    """The site from a server, below a prefix, and as files."""
    with served(book.parent) as server:
        yield {"http": server + book.name, "file": book.as_uri()}


@pytest.fixture
def reader(chromium, addresses):
    """A reader who comes by http and finds nothing to complain about."""
    reader = Reader(chromium, addresses["http"])
    yield reader
    reader.page.close()
    assert reader.complaints == []


class TestSite:
    def test_every_page_loads_in_full_and_fits_a_phone(self, reader, book):
        """Nothing fails, nothing is said on the console, and no page has to be pushed sideways."""
        reader.page.set_viewport_size(PHONE)
        widths = {}
        for page in pages(book):
            reader.go(page)
            widths[page] = reader.page.evaluate("document.documentElement.scrollWidth")
        assert {page: width for page, width in widths.items() if width > PHONE["width"]} == {}

    def test_the_ledger_fits_a_window_of_middle_width(self, reader):
        reader.page.set_viewport_size({"width": 1200, "height": 900})
        reader.go("ledger.html")
        assert reader.page.evaluate("document.documentElement.scrollWidth") <= 1200

    @pytest.mark.parametrize("by", ["the switch", "the system"])
    def test_a_figure_is_turned_over_on_a_dark_page_and_not_on_paper(self, chromium, addresses, by):
        system = "dark" if by == "the system" else "light"
        reader = Reader(chromium, addresses["http"], color_scheme=system)
        reader.go(KINDS["chapter"])
        figure, style = reader.page.locator(".cell_output img").first, "figure => getComputedStyle(figure).filter"
        if by == "the switch":
            assert figure.evaluate(style) == "none"
            reader.page.evaluate("document.body.dataset.theme = 'dark'")
        assert figure.evaluate(style) == "invert(0.93) hue-rotate(180deg)"
        figure.scroll_into_view_if_needed()
        reader.screenshot("dark_figure_" + by.replace(" ", "_"))
        reader.page.emulate_media(media="print", color_scheme=system)
        assert figure.evaluate(style) == "none"
        reader.page.close()
        assert reader.complaints == []

    def test_the_pages_are_whole_as_files(self, chromium, addresses):
        reader = Reader(chromium, addresses["file"])
        for page in KINDS.values():
            reader.go(page)
            assert reader.page.evaluate("document.documentElement.scrollWidth") <= DESKTOP["width"]
        reader.page.close()
        assert reader.complaints == []

    @pytest.mark.parametrize("way", ["http", "file"])
    def test_the_search_finds_the_smith_predictor(self, chromium, addresses, way):
        reader = Reader(chromium, addresses[way])
        reader.go("index.html")
        reader.page.locator("input[name=q]").first.fill("Smith predictor")
        reader.page.keyboard.press("Enter")
        found = reader.page.locator("ul.search li a")
        expect(found.filter(has_text="Dead-time compensation").first).to_be_visible()
        reader.screenshot(f"search_{way}")
        found.filter(has_text="Dead-time compensation").first.click()
        expect(reader.page.locator("h1")).to_contain_text("Dead-time compensation")
        reader.page.close()
        assert reader.complaints == []

    def test_a_reader_gets_around(self, reader):
        """From the front page to a chapter, by the links in the text, at the side and at the foot."""
        reader.go("index.html")
        reader.page.locator("article a[href$='10_tuning.html']").first.click()
        expect(reader.page.locator("h1")).to_contain_text("Tuning of PID controllers")
        reader.page.locator(".sidebar-tree a", has_text="Feedback control").first.click()
        expect(reader.page.locator("h1")).to_contain_text("Feedback control")
        reader.page.locator(".related-pages .next-page").click()
        expect(reader.page.locator("h1")).to_contain_text("Feedforward control")
        reader.page.locator(".sidebar-brand").click()
        expect(reader.page.locator("h1")).to_contain_text("loopbook")

    def test_a_phone_opens_the_list_of_chapters(self, reader):
        reader.page.set_viewport_size(PHONE)
        reader.go("index.html")
        reader.screenshot("phone_front")
        reader.page.locator("label.nav-overlay-icon").click()
        reader.page.locator(".sidebar-tree a", has_text="Robustness").first.click()
        expect(reader.page.locator("h1")).to_contain_text("Robustness")
        reader.screenshot("phone_chapter")

    @pytest.mark.parametrize("screen", [DESKTOP, PHONE], ids=["desktop", "phone"])
    def test_a_check_opens_from_its_line_and_shows_the_verdicts_first(self, reader, screen):
        reader.page.set_viewport_size(screen)
        reader.go(KINDS["chapter"])
        check = reader.page.locator("details.check").first
        verdict = check.locator("td.verdict").first
        expect(verdict).to_be_hidden()
        check.locator("summary").click()
        expect(verdict).to_be_visible()
        box, place = verdict.bounding_box(), check.bounding_box()
        assert place["x"] <= box["x"] < place["x"] + 20
        assert box["x"] + box["width"] <= screen["width"]
        assert verdict.evaluate("cell => cell.scrollWidth <= cell.clientWidth")

    def test_dark_and_light_by_a_switch(self, reader):
        reader.go("index.html")
        seen = set()
        for _ in range(3):
            reader.page.locator(".theme-toggle:visible").first.click()
            seen.add(reader.page.evaluate("getComputedStyle(document.body).backgroundColor"))
        assert len(seen) == 2

    @pytest.mark.parametrize("way", ["http", "file"])
    def test_the_knobs_of_every_lesson_move_its_plot(self, chromium, addresses, book, way):
        """By mouse from a server, by keyboard from a file; and all goes back to the start."""
        reader = Reader(chromium, addresses[way])
        idle, moved = [], 0
        for page in with_lessons(book):
            reader.go(page)
            for lesson in reader.page.locator(".lesson").all():
                name = lesson.get_attribute("data-lesson")
                lesson.scroll_into_view_if_needed()
                start = before = drawn(lesson)
                for knob in lesson.locator("input[type=range], select").all():
                    move(knob, "mouse" if way == "http" else "keyboard")
                    moved += 1
                    if (after := drawn(lesson, other_than=before)) == before:
                        idle.append(f"{name}: {knob.get_attribute('id')}")
                    before = after
                if way == "http":
                    lesson.screenshot(path=SCREENSHOTS / f"site_lesson_{name}.png")
                lesson.get_by_role("button", name="Back to the start").click()
                if drawn(lesson, until=start) != start:
                    idle.append(f"{name}: back to the start")
        reader.page.close()
        assert moved >= 12, "there are six lessons, most with two knobs or more"
        assert idle == []
        assert reader.complaints == []

    @pytest.mark.parametrize("scheme", ["light", "dark"])
    def test_nobody_is_kept_from_reading(self, chromium, addresses, book, scheme):
        """By axe: all of its rules on a phone by day; at a desk by night, where only the contrast is another."""
        rules, size = ({}, PHONE) if scheme == "light" else ({"runOnly": ["color-contrast"]}, DESKTOP)
        reader = Reader(chromium, addresses["http"], color_scheme=scheme)
        reader.page.set_viewport_size(size)
        found = []
        for name, page in KINDS.items():
            reader.go(page)
            reader.screenshot(f"{name}_{scheme}")
            found += [f"{page}: {problem}" for problem in serious(reader.page, **rules)]
        for page in with_lessons(book):
            reader.go(page)
            found += [f"{page}: {problem}" for problem in serious(reader.page, ".lesson", **rules)]
        reader.page.close()
        assert not found, "\n".join(found)


def drawn(lesson, other_than=None, until=None, frames=200):
    """What the plots of a lesson show, once they have been drawn; after some frames also what is not as expected."""
    for _ in range(frames):
        shown = lesson.evaluate(
            """async part => {
                await new Promise(done => requestAnimationFrame(() => setTimeout(done, 30)));
                return [...part.querySelectorAll("canvas")].map(plot => plot.toDataURL());
            }"""
        )
        if shown != other_than and until in (None, shown):
            break
    return shown


def move(knob, way):
    """Set a slider or a list to another value."""
    if knob.evaluate("knob => knob.tagName") == "SELECT":
        if way == "keyboard":
            knob.press("ArrowDown")
        else:
            knob.select_option(index=knob.locator("option").count() - 1)
    elif way == "keyboard":
        knob.press("End" if knob.evaluate("knob => knob.value != knob.max") else "Home")
    else:
        box = knob.bounding_box()
        share = 0.2 if knob.evaluate("knob => knob.value - knob.min > (knob.max - knob.min) / 2") else 0.8
        knob.click(position={"x": share * box["width"], "y": box["height"] / 2})
