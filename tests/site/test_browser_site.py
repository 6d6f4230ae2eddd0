"""The site in a browser: its pages, its links and switches, its live lessons; and an audit."""

import importlib
import re
import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

from browser import DESKTOP, PATIENCE, PHONE, SCREENSHOTS, WATCH, Complaints, seen, serious, served

sys.path.append(str(Path(__file__).parents[2] / "docs"))
lessons, moving, shapes = (importlib.import_module(name) for name in ("lessons", "lessons.moving", "lessons.shapes"))

#: A page of each kind.
KINDS = {
    "front": "index.html",
    "chapter": "chapters/05_transfer_functions.html",
    "solution": "solutions/05_transfer_functions.html",
    "ledger": "ledger.html?chapter=10_tuning&status=corrected",
    "results": "ledger/10_tuning.html",
    "reference": "reference/deadtime.html",
    "figures": "figures/04_laplace.html",
    "gallery": "figures.html",
    "schools": "schools.html",
}


#: Pages with lessons of each kind: curves, marks, bars, a map, a drawing.
LESSONS = [f"chapters/{name}.html" for name in (
    "06_dynamics", "07_feedback", "12_sequential_control", "19_robustness", "A_instrument_symbols",
)]  # fmt: skip


def pages(book):
    """The addresses of all pages, seen from the front page."""
    made = [path for path in book.rglob("*.html") if not {"_static", "lite"} & set(path.parts)]  # by Sphinx
    return sorted(path.relative_to(book).as_posix() for path in made)


def with_lessons(book):
    return [page for page in pages(book) if 'type="range"' in (book / page).read_text(encoding="utf-8")]


MOST_MOVED = 0.05  # cumulative layout shift
MOST_ELEMENTS = 20_000  # the most have the 810 formulas of chapter 13


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
        """Nothing fails, nothing is said on the console, no page has to be pushed sideways, none moves or is heavy."""
        reader.page.set_viewport_size(PHONE)
        reader.page.add_init_script(WATCH)
        wide, moving, heavy = {}, {}, {}
        for page in pages(book):
            reader.go(page)
            found = seen(reader.page)
            wide[page] = reader.page.evaluate("document.documentElement.scrollWidth")
            moving[page], heavy[page] = found["moved"], found["nodes"]
        assert {page: width for page, width in wide.items() if width > PHONE["width"]} == {}
        assert {page: shift for page, shift in moving.items() if shift >= MOST_MOVED} == {}
        assert {page: count for page, count in heavy.items() if count > MOST_ELEMENTS} == {}

    def test_the_ledger_fits_a_window_of_middle_width(self, reader):
        reader.page.set_viewport_size({"width": 1200, "height": 900})
        reader.go("ledger.html")
        assert reader.page.evaluate("document.documentElement.scrollWidth") <= 1200

    @pytest.mark.parametrize("way", ["http", "file"])
    def test_the_ledger_is_searched_and_old_addresses_of_results_lead_on(self, chromium, addresses, way):
        reader = Reader(chromium, addresses[way])
        reader.go("ledger.html")
        rows, said = reader.page.locator("#ledger-found tr[data-result]"), reader.page.locator("#ledger-search output")
        assert rows.count() == 0
        reader.page.get_by_label("Search", exact=True).last.fill("10.2 Skogestad")
        expect(said).to_contain_text(" of ")
        first = rows.count()
        assert first
        reader.page.get_by_label("Verdict").select_option("corrected")
        reader.page.get_by_label("Search", exact=True).last.fill("exp(-tau*s)")
        expect(rows).not_to_have_count(first)
        reader.page.get_by_role("button", name="Start again").click()
        expect(rows).to_have_count(0)
        reader.page.locator(".totals tr").last.locator("a").first.click()  # all that is computed
        reader.page.get_by_role("button", name="Show").click()
        assert reader.page.evaluate("document.activeElement.dataset.result")
        place = rows.last.get_attribute("data-result")
        reader.go("index.html")
        reader.go(f"ledger.html#{place}")
        reader.page.wait_for_url("**/ledger/*.html#*")
        assert reader.page.evaluate("document.querySelector(':target').id") == place
        reader.page.close()
        assert reader.complaints == []

    def test_the_ledger_is_whole_without_a_script(self, chromium, addresses):
        reader = Reader(chromium, addresses["file"], java_script_enabled=False)
        reader.go("ledger.html")
        expect(reader.page.locator("#ledger-search")).to_be_hidden()
        reader.page.locator(".ledger-ways a", has_text="Tuning of PID controllers").click()
        expect(reader.page.locator("table.ledger td.verdict").first).to_be_visible()
        reader.page.close()

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

    def test_the_front_page_stands_still_while_it_loads(self, reader):
        """And so does a chapter, with its figures and its lessons."""
        for screen in (DESKTOP, PHONE):
            reader.page.set_viewport_size(screen)
            for page in (KINDS["front"], KINDS["chapter"]):
                reader.go(page)
                reader.page.wait_for_load_state("networkidle")
                assert moved(reader.page) < 0.01, (page, screen)

    def test_one_sees_where_one_is(self, reader):
        """In the contents of a page, the section that is being read is marked, whatever is scrolled to."""
        reader.page.set_viewport_size({"width": 1440, "height": 900})
        reader.go(KINDS["chapter"])
        links = reader.page.locator(".toc-tree > ul > li > ul > li > a")
        for number in (1, links.count() // 2):
            place = links.nth(number).get_attribute("href")
            reader.page.evaluate("id => document.getElementById(id).scrollIntoView({behavior: 'instant'})", place[1:])
            expect(reader.page.locator(f".toc-tree li.scroll-current > a[href='{place}']")).to_be_visible()

    def test_a_link_to_something_folded_opens_it(self, reader):
        reader.go("chapters/10_tuning.html#equation-10-15")
        expect(reader.page.locator("#equation-10-15")).to_be_in_viewport()

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

    def test_every_slider_of_every_lesson_moves_its_picture(self, reader, book):
        """At some value of each, with the others at the start; and all goes back to the start."""
        idle, moved = [], 0
        reader.page.add_init_script("localStorage['loopbook-show'] = 'all'")  # some are in further sections
        for page in with_lessons(book):
            reader.go(page)
            for lesson in reader.page.locator(".lesson").all():
                begin(lesson)
                found = lesson.evaluate(EVERY_KNOB)
                idle += found["idle"]
                moved += found["moved"]
        assert idle == []
        assert moved > 50, "most lessons have two sliders or more"

    def test_a_lesson_obeys_the_mouse_and_keeps_curves_for_comparison(self, reader):
        reader.go("chapters/10_tuning.html")
        lesson = reader.page.locator("#lesson-by_hand")
        begin(lesson)
        start = drawn(lesson)
        for knob in lesson.locator("input[type=range]").all():
            before = drawn(lesson)
            box = knob.bounding_box()
            knob.click(position={"x": 0.7 * box["width"], "y": box["height"] / 2})
            assert drawn(lesson) != before
        lesson.get_by_role("button", name="Keep these curves in grey").click()
        assert grey(lesson) == ""
        lesson.locator("input[type=range]").first.press("Home")
        assert grey(lesson).startswith("M")
        reader.page.screenshot(path=SCREENSHOTS / "site_lesson_by_hand.png")
        lesson.get_by_role("button", name="Back to the start").click()
        assert drawn(lesson) == start
        assert grey(lesson) == ""

    def test_a_lesson_draws_between_what_is_recorded_and_says_what_is_seen(self, reader):
        reader.go("chapters/10_tuning.html")
        lesson = reader.page.locator("#lesson-by_hand")
        begin(lesson)
        words = lesson.locator(".lesson-words")
        expect(words).to_have_text(re.compile(r"^oven rises to .*K, .*; after cold load it .*\. u .*\.$"))
        assert words.get_attribute("aria-live") == "polite"
        data = lessons.load("by_hand").record()["data"]
        oven = next(k for k, item in enumerate(data["items"]) if item["label"] == "oven")
        column = data["items"][oven]["line"]
        for number in [k for k, line in enumerate(column) if line == moving.BETWEEN][::200]:
            before = words.inner_text()
            gain, integral_time = divmod(number, data["counts"][1])
            for knob, value in zip(lesson.locator("input").all(), (gain, integral_time), strict=True):
                knob.evaluate("(knob, value) => { knob.value = value; knob.dispatchEvent(new Event('input')); }", value)
            assert words.inner_text() != before
            for k, shape in enumerate(moving.view(data, number).shapes):
                (piece,) = lesson.locator(f'path[data-item="{k}"]').get_attribute("d")[1:].removesuffix("Z").split("M")
                seen = [[[*map(float, corner.split())] for corner in piece.split("L")]]
                assert shapes.apart(seen, shapes.decoded(shape)) < 1

    def test_a_lesson_obeys_the_keyboard_in_a_page_from_a_disk(self, chromium, addresses):
        reader = Reader(chromium, addresses["file"])
        reader.go("chapters/16_tuning_relations.html")
        lesson = reader.page.locator("#lesson-at_work")
        begin(lesson)
        for knob, key in ((lesson.locator("select"), "ArrowDown"), (lesson.locator("input"), "ArrowRight")):
            before, said = drawn(lesson), lesson.locator(".lesson-result").inner_text()
            knob.first.press(key)
            assert drawn(lesson) != before
            assert lesson.locator(".lesson-result").inner_text() != said
        reader.page.close()
        assert reader.complaints == []

    def test_a_lesson_obeys_a_finger(self, chromium, addresses):
        reader = Reader(chromium, addresses["http"], has_touch=True, is_mobile=True)
        reader.page.set_viewport_size(PHONE)
        reader.go("chapters/13_poles_and_zeros.html")
        lesson = reader.page.locator("#lesson-zero_to_move")
        begin(lesson)
        before, box = drawn(lesson), lesson.locator("input").first.bounding_box()
        assert box["height"] >= 32, "of a finger"
        reader.page.touchscreen.tap(box["x"] + 0.8 * box["width"], box["y"] + box["height"] / 2)
        assert drawn(lesson) != before
        reader.screenshot("phone_lesson")
        reader.page.close()
        assert reader.complaints == []

    def test_a_page_loads_the_lessons_that_the_reader_comes_near(self, reader):
        reader.go("chapters/10_tuning.html")
        begin(reader.page.locator(".lesson").first)
        count = "[...document.scripts].filter(script => script.src.includes('/lessons/')).length"
        assert reader.page.evaluate(count) < reader.page.locator(".lesson").count()

    def test_a_lesson_is_seen_without_a_script_and_nothing_moves_when_it_comes(self, chromium, addresses):
        def look(scripts):
            reader = Reader(chromium, addresses["http"], java_script_enabled=scripts)
            reader.go("chapters/10_tuning.html")
            lesson = reader.page.locator("#lesson-by_hand")
            if scripts:
                begin(lesson)
            plots = [plot.bounding_box() for plot in lesson.locator(".lesson-plot").all()]
            paths = [path.get_attribute("d") for path in lesson.locator("path[data-item]").all()]
            said = lesson.locator("noscript p").is_visible()
            reader.page.close()
            return [plot["height"] for plot in plots], plots[1]["y"] - plots[0]["y"], paths, said

        *still, said = look(scripts=False)
        *live, silent = look(scripts=True)
        assert still == live
        assert said
        assert not silent

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
        for page in LESSONS:
            reader.go(page)
            begin(reader.page.locator(".lesson").first)
            found += [f"{page}: {problem}" for problem in serious(reader.page, ".lesson", **rules)]
        reader.page.close()
        assert not found, "\n".join(found)


def moved(page):
    """By how much what had been shown has moved: the cumulative layout shift."""
    return page.evaluate(
        """() => new Promise(resolve => {
            let sum = 0;
            const watch = list => list.getEntries().forEach(one => { if (!one.hadRecentInput) sum += one.value; });
            const watcher = new PerformanceObserver(watch);
            watcher.observe({type: "layout-shift", buffered: true});
            const end = () => (watch({getEntries: () => watcher.takeRecords()}), resolve(sum));
            requestAnimationFrame(() => setTimeout(end));
        })"""
    )


#: Moves every slider and list of a lesson, and says which of them moved nothing.
EVERY_KNOB = """lesson => {
    const seen = () => lesson.querySelector(".lesson-desk").innerHTML.replace(/ (aria-valuetext|value)="[^"]*"/g, "")
        .replace(/<output.*?<[/]output>/g, "");
    const turn = (knob, value) => { knob.value = value; knob.dispatchEvent(new Event("input")); };
    const start = seen();
    const idle = [];
    const knobs = [...lesson.querySelectorAll("input[type=range], select")];
    for (const knob of knobs) {
        const first = knob.value;
        const last = knob.options ? knob.options.length - 1 : Number(knob.max);
        let found = false;
        for (let value = 0; value <= last && !found; value++) {
            turn(knob, value);
            found = seen() !== start;
        }
        if (!found) idle.push(knob.id);
        turn(knob, first);
    }
    if (seen() !== start) idle.push(`${lesson.id}: back to the start`);
    return { idle, moved: knobs.length };
}"""


def begin(lesson):
    """Bring a lesson into the window, and wait until its sliders do something."""
    lesson.scroll_into_view_if_needed()
    expect(lesson).to_contain_class("lesson-live")


def drawn(lesson):
    """What the pictures of a lesson show."""
    return lesson.locator("path[data-item]").evaluate_all("paths => paths.map(path => path.getAttribute('d')).join()")


def grey(lesson):
    """What a lesson shows of the curves that were kept."""
    return lesson.locator("path[data-kept]").evaluate_all("paths => paths.map(path => path.getAttribute('d')).join('')")
