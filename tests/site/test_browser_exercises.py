"""The exercises in the page: how a reader fills them in, what she is told, and what her browser remembers.

What answers most of them is the library in this process, in the place of the Python in the page: these tests are about
the page. In the last class the page's own Python answers.
"""

import json
import shutil
import sys
from pathlib import Path

import pytest
from docs.browser import site
from playwright.sync_api import expect

import browser_runtime
from browser import DESKTOP, PATIENCE, PHONE, SCREENSHOTS, WATCH, Complaints, seen, serious, served
from loopbook.exercises import exercise
from loopbook.exercises.forms import answer

ROOT = Path(__file__).parents[2]
TUNING, SEQUENCES, SYMBOLS = (
    f"chapters/{name}.html" for name in ("10_tuning", "12_sequential_control", "A_instrument_symbols")
)
#: What takes the place of judge.js: it says how far loading is, and asks this process.
JUDGE = """
export class Judge {
  library = window.loopbookExercises.version;
  constructor({ onProgress }) { this.onProgress = onProgress; }
  async ask(request) {
    this.onProgress({ share: 0.4, says: "Python, 10 of 25 MB" });
    const reply = await (await fetch("/ask", { method: "POST", body: JSON.stringify(request) })).json();
    this.onProgress({ share: 1, says: "ready" });
    if (reply.fails) throw new Error(reply.fails);
    return reply;
  }
}
"""


class Reader:
    """A reader of a chapter with exercises."""

    def __init__(self, chromium, address, **habits):
        self.address = address
        self.context = chromium.new_context(**({"viewport": DESKTOP, "service_workers": "block"} | habits))
        self.context.add_init_script("localStorage['loopbook-show'] = 'all'")  # also what is in further sections
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.complaints = Complaints(self.page, noise=("Service Worker registration blocked",))
        self.requests, self.fails = [], None

    def with_python_here(self):
        self.page.route("**/_static/judge.js", lambda r: r.fulfill(body=JUDGE, content_type="text/javascript"))
        self.page.route("**/ask", self.reply)
        return self

    def reply(self, route):
        request = json.loads(route.request.post_data)
        self.requests.append(request)
        text = json.dumps({"fails": self.fails}) if self.fails else answer(json.dumps(request))
        route.fulfill(body=text, content_type="application/json")

    def go(self, page=TUNING):
        self.page.goto(f"{self.address}/{page}")

    def exercise(self, number):
        return Form(self, self.page.locator(f'[data-exercise="{number}"]'), number)

    @property
    def remembered(self):
        return self.page.evaluate("JSON.parse(localStorage.loopbook ?? 'null')")


class Form:
    """An exercise in the page."""

    def __init__(self, reader, box, number):
        self.reader, self.box, self.number = reader, box, number

    def __getattr__(self, name):
        return getattr(self.box, name)

    def field(self, name, part=""):
        place = f"answer-{self.number.replace('.', '-').lower()}-{name}"
        return self.box.locator(f'[id="{place}{part and "-" + part}"]')

    def fill_in(self, **texts):
        expect(self.box.locator("form")).not_to_have_attribute("inert", "")  # her own numbers are on their way
        for name, text in texts.items():
            self.field(name).fill(text)

    def press(self, name):
        self.box.get_by_role("button", name=name, exact=True).click()

    def check(self, **texts):
        self.fill_in(**texts)
        self.press("Check")
        expect(self.box).not_to_have_attribute("aria-busy", "true")

    @property
    def says(self):
        return self.box.locator(".answer")

    def verdict(self, name):
        return self.box.locator(f'.field[data-name="{name}"] .verdict')

    def screenshot(self, name):
        self.box.screenshot(path=SCREENSHOTS / f"exercise_{name}.png")


@pytest.fixture(scope="class")
def address(book):
    with served(book.parent) as server:
        yield server + book.name


@pytest.fixture
def reader(chromium, address):
    reader = Reader(chromium, address).with_python_here()
    yield reader
    reader.context.close()
    assert reader.complaints == []


@pytest.fixture
def forms_page():
    """The progress in all chapters, as the front page holds it."""
    sys.path[:0] = [str(ROOT / "docs" / "extensions")]
    try:
        import exercise_forms
    finally:
        del sys.path[0]
    scripts = "".join(f'<script defer src="_static/{name}.js"></script>' for name in ("exercises/table", "exercises"))
    return (f'<!doctype html><html lang="en"><head><title>x</title>{scripts}</head>'
            f"<body>{exercise_forms.of_all()}</body></html>")  # fmt: skip


class TestAnAnswer:
    def test_it_is_judged_field_by_field_and_remembered(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="1.5", T="1.25 min", tau="90")
        expect(form.verdict("K")).to_have_text("✓right")
        expect(form.verdict("T")).to_contain_text("right, converted from min")
        expect(form.verdict("tau")).to_contain_text("that is the same number as the 90\xa0s of the question")
        expect(form.says).to_contain_text("2 of 3 right.")
        expect(form.field("tau")).to_have_attribute("aria-invalid", "true")
        expect(form.locator(".known")).to_have_text("tried")
        form.check(tau="15")
        expect(form.says).to_contain_text("Right.")
        expect(form.says.get_by_role("link")).to_have_attribute("href", "#exercise-10-2")
        expect(form.locator(".known")).to_have_text("✓ right")
        expect(reader.page.locator(".progress-of-chapter")).to_contain_text("So far 1 of 10 exercises")
        assert reader.remembered["answered"] == {"10.1": True}
        form.check(tau="16")
        form.check(tau="77")
        assert reader.remembered["answered"] == {"10.1": True}  # what was right once stays so

    def test_enter_checks_and_the_keyboard_is_enough(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.field("K").focus()
        for text in ("1.5", "75", "15"):
            reader.page.keyboard.type(text)
            reader.page.keyboard.press("Tab")
        expect(form.get_by_role("button", name="Check")).to_be_focused()
        reader.page.keyboard.press("Shift+Tab")
        reader.page.keyboard.press("Enter")
        expect(form.says).to_contain_text("Right.")
        expect(form.field("tau")).to_be_focused()

    def test_nothing_filled_in_loads_nothing(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="  ")
        expect(form.says).to_have_text("Nothing is filled in yet.")
        expect(form.field("K")).to_be_focused()
        assert reader.requests == []

    def test_a_chapter_is_read_without_any_python(self, reader):
        loaded = []
        reader.page.on("request", lambda request: loaded.append(request.url))
        reader.go()
        expect(reader.exercise("10.1").get_by_role("button", name="Check")).to_be_visible()
        assert not [url for url in loaded if "judge" in url or "help-" in url]

    def test_what_fails_is_said_and_the_page_lives(self, reader):
        reader.go()
        form, reader.fails = reader.exercise("10.1"), "ended after 3 s: such an answer takes too long."
        form.check(K="1.5")
        expect(form.says).to_have_text("Ended after 3 s: such an answer takes too long.")
        reader.fails = None
        form.check(K="1.5")
        expect(form.verdict("K")).to_have_text("✓right")

    def test_python_that_cannot_be_loaded_is_said(self, reader):
        reader.go()
        reader.page.unroute("**/_static/judge.js")
        reader.page.route("**/_static/judge.js", lambda route: route.abort())
        form = reader.exercise("10.1")
        form.check(K="1.5")
        expect(form.says).to_contain_text("look whether there is a network")
        assert all("judge.js" in complaint for complaint in reader.complaints)
        reader.complaints.clear()

    def test_loading_is_shown(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        reader.page.unroute("**/ask")
        held = []
        reader.page.route("**/ask", lambda route: held.append(route))
        form.fill_in(K="1.5")
        with reader.page.expect_request("**/ask"):
            form.press("Check")
        expect(form.get_by_role("progressbar")).to_be_visible()
        expect(form.locator(".loading")).to_contain_text("Python, 10 of 25 MB")
        form.screenshot("loading")
        reader.reply(held[0])
        expect(form.verdict("K")).to_have_text("✓right")
        expect(form.get_by_role("progressbar")).to_be_hidden()

    def test_changing_a_field_takes_its_verdict_away(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="2", T="75")
        expect(form.verdict("K")).not_to_be_empty()
        form.fill_in(K="1.5")
        expect(form.verdict("K")).to_be_empty()
        expect(form.verdict("T")).to_have_text("✓right")


class TestKindsOfFields:
    def test_a_controller_is_its_settings_and_is_drawn(self, reader):
        reader.go()
        form = reader.exercise("10.7")
        form.field("pid", "Kp").fill("2")
        form.field("pid", "Ti").fill("10 min")
        form.check()
        expect(form.verdict("pid")).to_contain_text("the overshoot is")
        assert form.says.locator("img").get_attribute("alt")
        assert reader.requests[-1]["answers"] == {
            "pid": {"Kp": "2", "Ti": "10 min", "Td": "", "Tf": "", "form": "parallel"}
        }

    def test_words_are_buttons_boxes_lists_and_a_row(self, reader):
        reader.go(SEQUENCES)
        form = reader.exercise("12.8")
        form.get_by_label("Hold").check()
        form.get_by_label("Warm").check()
        outputs = form.get_by_role("group", name="on the outputs")
        outputs.get_by_label("heater").check()
        outputs.get_by_label("none of them").check()
        expect(outputs.get_by_label("heater")).not_to_be_checked()
        outputs.get_by_label("heater").check()
        outputs.get_by_label("lamp").check()
        expect(outputs.get_by_label("none of them")).not_to_be_checked()
        form.get_by_label("hot", exact=True).check()
        form.check(Mix="15", Drain="23")
        expect(form.says).to_contain_text("Right.")
        reader.go(SYMBOLS)
        form = reader.exercise("A.1")
        form.field("measured").select_option("pressure")
        form.get_by_label("difference").check()
        form.press("indicator")
        form.press("controller")
        expect(form.field("functions")).to_have_value("indicator, controller")
        form.check(loop="31")
        expect(form.says).to_contain_text("Right.")

    def test_a_chart_is_typed_in_lines_and_control_and_enter_check_it(self, reader):
        reader.go(SEQUENCES)
        form = reader.exercise("12.9")
        form.field("chart").fill("Wait -> Fill: start")
        form.field("chart").press("Enter")
        assert reader.requests == []
        form.field("chart").press("Control+Enter")
        expect(form.verdict("chart")).not_to_be_empty()
        assert reader.requests[0]["answers"]["chart"].endswith("\n")


class TestAFormulaWhileItIsTyped:
    def test_it_is_shown_in_two_dimensions_once_python_is_there(self, reader):
        reader.page.add_init_script(WATCH)
        reader.go("chapters/14_model_approximation.html")
        form = reader.exercise("14.2")
        form.field("g_1").press_sequentially("2/(5s)")
        reader.page.wait_for_function("localStorage.loopbook?.includes('2/(5s)')")
        form.check()
        assert reader.requests[0]["do"] == "check"
        first, second = (form.locator(f'.field[data-name="{name}"] .typeset') for name in ("g_1", "g_2"))
        expect(first.locator("mfrac")).to_be_visible()
        before = seen(reader.page)["moved"]
        for more, is_whole in (("2e^(-0.5s)/(5s(4.5s + 1", False), ("))", True), (" + ", False)):
            form.field("g_2").press_sequentially(more)
            expect(second).to_have_class("typeset" if is_whole else "typeset stale")
            expect(second.locator("mfrac msup")).to_be_visible()
        assert seen(reader.page)["moved"] == before
        form.screenshot("formula")

    def test_a_telephone_has_keys_for_it(self, chromium, address):
        reader = Reader(chromium, address, viewport=PHONE, has_touch=True, is_mobile=True).with_python_here()
        reader.go()
        form = reader.exercise("10.4")
        keys = form.locator(".keys")
        expect(keys).to_be_hidden()
        form.field("Ti").tap()
        for key in ("fraction", "T", "tau", "on to the next bracket", "power of e", "T_C", "on to the next bracket"):
            keys.get_by_role("button", name=key, exact=True).tap()
        expect(form.field("Ti")).to_have_value("(T tau)/(e^(T_C))")
        form.field("Ti").press("Control+a")
        keys.get_by_role("button", name="root").tap()  # of what is selected
        expect(form.field("Ti")).to_have_value("sqrt((T tau)/(e^(T_C)))")
        expect(form.field("Ti")).to_be_focused()
        assert keys.bounding_box()["y"] + keys.bounding_box()["height"] == PHONE["height"]
        reader.page.screenshot(path=SCREENSHOTS / "exercise_phone_keys.png")
        reader.context.close()
        assert reader.complaints == []


class TestHelp:
    def test_each_hint_goes_further_and_needs_no_python(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        for rung, after in ((1, "Next hint"), (2, "Next hint"), (3, "Next hint"), (4, "No more hints")):
            form.press("Hint" if rung == 1 else "Next hint")
            expect(form.locator(".one-hint").nth(rung - 1)).to_contain_text(f"Hint {rung} of 4")
            expect(form.locator("button.hint")).to_have_text(after)
        form.locator("button.hint").click(force=True)  # which does nothing any more
        expect(form.locator(".one-hint")).to_have_count(4)
        assert reader.requests == []

    def test_the_solution_comes_after_an_attempt_or_anyway(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.press("Solution")
        expect(form.says).to_contain_text("The solution comes after your first attempt")
        expect(form.locator(".solved")).to_be_empty()
        form.press("Show it anyway")
        expect(form.locator(".solved h4")).to_be_focused()
        expect(form.locator(".solved")).to_contain_text("what one percent of the control signal does in the end")
        expect(form.locator("button.solve")).to_have_attribute("aria-expanded", "true")
        form.press("Solution")
        expect(form.locator(".solved")).to_be_hidden()
        other = reader.exercise("10.3")
        other.field("pid", "Kp").fill("2")
        other.check()
        other.press("Solution")
        expect(other.locator(".solved img")).to_be_visible()  # drawn, as Python is there now


class TestOwnNumbers:
    def say_name(self, reader, form, name):
        form.locator("button.own").click()
        reader.page.get_by_label("Your name").fill(name)
        reader.page.get_by_role("button", name="Use my numbers").click()

    def test_a_name_is_said_once(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        before = form.locator(".statement").inner_text()
        form.fill_in(K="1.5")
        self.say_name(reader, form, " Mira ")
        expect(form.says).to_have_text("These are the numbers of Mira.")
        mine = exercise("10.1", "Mira")
        assert form.locator(".statement").inner_text() != before
        expect(form.field("K")).to_have_value("")
        expect(reader.exercise("10.2").locator(".whose")).to_have_text("numbers of Mira")
        form.check(**{name: f"{kind.key:.8g}" for name, kind in mine.key.items()})
        expect(form.says).to_contain_text("Right.")
        assert reader.remembered["answered"] == {"10.1 Mira": True}
        assert reader.remembered["student"] == "Mira"
        reader.page.reload()  # what was shown before is shown at once
        expect(form.field("K")).to_have_value(f"{mine.key['K'].key:.8g}")
        expect(form.locator(".known")).to_have_text("✓ right")
        form.locator("button.own").click()
        reader.page.get_by_role("button", name="Back to everybody's numbers").click()
        expect(form.field("K")).to_have_value("1.5")
        assert form.locator(".statement").inner_text() == before

    def test_another_page_asks_before_it_loads_python(self, reader):
        reader.go()
        reader.page.evaluate("localStorage.loopbook = JSON.stringify({ student: 'Noor' })")
        reader.page.reload()
        form = reader.exercise("10.1")
        expect(form.locator(".state .whose")).to_have_text("everybody's numbers")
        assert reader.requests == []
        form.get_by_role("button", name="Show the numbers of Noor").click()
        expect(form.says).to_have_text("These are the numbers of Noor.")
        expect(reader.page.get_by_text("numbers of Noor", exact=True)).to_have_count(
            reader.page.locator("button.own").count()
        )  # of all cards at once
        expect(reader.page.get_by_text("everybody's numbers")).to_have_count(0)

    def test_the_first_answer_under_other_numbers_changes_all_cards(self, reader):
        reader.go()
        reader.page.evaluate("localStorage.loopbook = JSON.stringify({ student: 'Noor' })")
        reader.page.reload()
        form = reader.exercise("10.1")
        form.check(K="1.5")
        expect(form.says).to_have_text("These are the numbers of Noor. Answer these.")
        expect(reader.page.get_by_text("numbers of Noor", exact=True)).to_have_count(
            reader.page.locator("button.own").count()
        )

    def test_no_name_is_said_and_nothing_changes(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        self.say_name(reader, form, " ")
        expect(reader.page.get_by_role("alert")).to_have_text("Nothing is there yet: type a name, as Mira.")
        reader.page.keyboard.press("Escape")
        expect(form.locator("button.own")).to_be_focused()
        expect(form.locator("button.own")).to_have_text("Your own numbers")


class TestMemory:
    def test_what_was_typed_survives_a_reload(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.fill_in(K="1.5", tau="half a minute")
        settings = reader.exercise("10.7")
        settings.field("pid", "Ti").fill("10")
        reader.page.wait_for_function("localStorage.loopbook?.includes('half a minute')")
        reader.page.wait_for_function("""JSON.parse(localStorage.loopbook).tried["10.7"]?.answers.pid.Ti === "10" """)
        reader.page.reload()
        expect(form.field("tau")).to_have_value("half a minute")
        expect(settings.field("pid", "Ti")).to_have_value("10")
        assert reader.requests == []

    @pytest.mark.parametrize("stored", ["{", "[]", "null", '{"answered": 5, "tried": {"10.1": 3}}'])
    def test_what_somebody_else_has_stored_breaks_nothing(self, reader, stored):
        reader.go()
        reader.page.evaluate("text => (localStorage.loopbook = text)", stored)
        reader.page.reload()
        form = reader.exercise("10.1")
        form.check(K="1.5")
        expect(form.verdict("K")).to_have_text("✓right")
        assert reader.remembered["answered"] == {"10.1": False}

    def test_two_windows_do_not_forget_for_each_other(self, reader):
        reader.go()
        other = reader.context.new_page()
        other.goto(f"{reader.address}/{TUNING}")
        other.evaluate("localStorage.loopbook = JSON.stringify({ answered: { '10.2': true } })")
        expect(reader.page.locator(".progress-of-chapter")).to_contain_text("So far 1 of 10")
        reader.exercise("10.1").check(K="1.5")
        assert reader.remembered["answered"] == {"10.1": False, "10.2": True}


class TestProgressOfAll:
    @pytest.fixture
    def front(self, reader, forms_page):
        reader.page.route("**/progress.html", lambda route: route.fulfill(body=forms_page, content_type="text/html"))
        reader.go("progress.html")
        return reader.page

    def test_it_begins_with_an_invitation(self, front):
        expect(front.locator(".sum")).to_contain_text("exercises answer in the page.")
        expect(front.locator("li[data-chapter='10'] .count")).to_have_text("0 of 10")

    def test_it_is_saved_and_read_as_the_notebooks_keep_it(self, reader, front, tmp_path):
        answered = {"10.1": True, "10.1 Mira": False, "9.2": True}
        tried = {"10.1": {"answers": {"K": "1.5"}, "attempts": 2, "hints": 1}}
        front.evaluate("all => (localStorage.loopbook = JSON.stringify(all))", {"answered": answered, "tried": tried})
        front.reload()
        expect(front.locator("li[data-chapter='10'] .count")).to_have_text("1 of 10")
        expect(front.locator(".sum")).to_contain_text("2 of ")
        expect(front.locator(".next a")).to_have_attribute("href", f"{reader.address}/{TUNING}#exercise-10-2")
        with front.expect_download() as saved:
            front.get_by_role("button", name="Save my progress as a file").click()
        file = tmp_path / ".loopbook-progress.json"
        saved.value.save_as(file)
        assert json.loads(file.read_text()) == {"answered": answered, "student": None, "tried": tried}
        front.evaluate("localStorage.clear()")
        front.get_by_label("Read it from a file").set_input_files(file)
        expect(front.locator(".progress-note")).to_contain_text("2 right")
        assert reader.remembered == {"answered": answered, "student": None, "tried": tried}
        file.write_text('{"answered": {"10.1": false, "10.2": true, "1.1": false}}')
        front.get_by_label("Read it from a file").set_input_files(file)
        expect(front.locator(".progress-note")).to_contain_text("1 right")
        assert reader.remembered["answered"] == answered | {"10.2": True, "1.1": False}

    @pytest.mark.parametrize("text", ["", "[]", '{"answered": [true]}', '{"answered": {"1.1": "yes"}}'])
    def test_a_file_without_progress_is_refused(self, reader, front, tmp_path, text):
        file = tmp_path / "other.json"
        file.write_text(text)
        front.get_by_label("Read it from a file").set_input_files(file)
        expect(front.locator(".progress-note")).to_contain_text("other.json holds no progress")
        assert (reader.remembered or {}).get("answered", {}) == {}

    def test_it_is_forgotten_after_a_question(self, reader, front):
        front.evaluate("""localStorage.loopbook = JSON.stringify({ student: "Mira", answered: { "10.1": true } })""")
        front.once("dialog", lambda dialog: dialog.dismiss())
        front.get_by_role("button", name="Forget my progress").click()
        assert reader.remembered["student"] == "Mira"
        front.once("dialog", lambda dialog: dialog.accept())
        front.get_by_role("button", name="Forget my progress").click()
        front.wait_for_function("JSON.parse(localStorage.loopbook).student === null")


class TestWithoutPython:
    def test_without_javascript_the_solution_is_folded(self, chromium, address):
        reader = Reader(chromium, address, java_script_enabled=False)
        reader.go()
        form = reader.exercise("10.1")
        expect(form.locator(".fields")).to_be_hidden()
        expect(form.locator("ul.asked")).to_be_visible()
        expect(form.locator(".why.no-script")).to_contain_text("need JavaScript")
        expect(form.locator(".why.from-file")).to_be_hidden()
        expect(form.locator("details.solution p").first).to_be_hidden()
        form.locator("summary").click()
        expect(form.locator("details.solution")).to_contain_text("what one percent of the control signal does")
        reader.context.close()

    def test_from_a_file_as_well(self, chromium, book):
        reader = Reader(chromium, book.as_uri())
        reader.go()
        form = reader.exercise("10.1")
        expect(form.locator(".why.from-file")).to_contain_text("opened as a file")
        expect(form.locator(".why.no-script")).to_be_hidden()
        expect(form.locator(".fields")).to_be_hidden()
        form.locator("summary").click()
        expect(form.locator("details.solution")).to_contain_text("what one percent of the control signal does")
        form.screenshot("file")
        reader.context.close()
        assert reader.complaints == []

    def test_paper_has_no_controls(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="1.5")
        reader.page.emulate_media(media="print")
        for part in (".fields", ".buttons", ".answer", ".exercise-links"):
            expect(form.locator(part)).to_be_hidden()
        expect(form.locator("ul.asked")).to_be_visible()
        form.screenshot("print")


class TestForEverybody:
    @pytest.mark.parametrize("scheme", ["light", "dark"])
    def test_nothing_serious_is_found(self, chromium, address, scheme):
        """With every kind of field, verdicts, a hint and a solution on the page."""
        reader = Reader(chromium, address, color_scheme=scheme).with_python_here()
        reader.go(SEQUENCES)
        form = reader.exercise("12.8")
        form.get_by_label("Hold").check()
        form.check(Mix="14", Drain="23")
        form.press("Hint")
        expect(form.locator(".one-hint")).to_be_visible()
        form.screenshot(f"checked_{scheme}")
        reader.page.locator("aside, .back-to-top").first.evaluate("part => part.remove()")
        assert serious(reader.page, part="[data-exercise]") == []
        reader.go()
        form = reader.exercise("10.7")
        form.field("pid", "Kp").fill("2")
        form.check()
        form.press("Solution")
        expect(form.locator(".solved h4")).to_be_visible()
        form.locator("button.own").click()
        reader.page.screenshot(path=SCREENSHOTS / f"exercise_dialog_{scheme}.png")
        assert serious(reader.page) == []
        reader.context.close()

    @pytest.mark.parametrize("page", [TUNING, SEQUENCES, SYMBOLS])
    def test_a_phone_shows_all_of_it(self, chromium, address, page):
        reader = Reader(chromium, address, viewport=PHONE, has_touch=True, is_mobile=True)
        reader.go(page)
        boxes = reader.page.evaluate("""[...document.querySelectorAll(`[data-exercise] :is(input:not([type=radio],
            [type=checkbox]), select, textarea, button, .choice)`)].map(part => part.getBoundingClientRect())
            .filter(box => box.width).map(box => [box.left, box.right, box.height])""")
        assert boxes
        assert all(left >= 0 and right <= PHONE["width"] and height >= 43 for left, right, height in boxes)
        assert reader.page.evaluate("document.documentElement.scrollWidth") == PHONE["width"]
        form = reader.page.locator("[data-exercise]").first
        form.locator("button.check").tap()
        expect(form.locator(".answer")).to_have_text("Nothing is filled in yet.")
        form.screenshot(path=SCREENSHOTS / f"exercise_phone_{page[9:11]}.png")
        reader.context.close()
        assert reader.complaints == []


class TestWhatMayHappen:
    def test_a_response_and_hints_are_there_after_a_reload(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="1.5", T="1.25", tau="90")
        form.press("Hint")
        form.press("Next hint")
        expect(form.box.locator(".one-hint")).to_have_count(2)
        reader.page.reload()
        form = reader.exercise("10.1")
        expect(form.says).to_contain_text("1 of 3 right")
        expect(form.verdict("K")).to_contain_text("right")
        form.press("The 2 hints again")
        expect(form.box.locator(".one-hint")).to_have_count(2)
        form.fill_in(tau="15")
        reader.page.wait_for_function("JSON.parse(localStorage.loopbook).tried['10.1'].response === null")
        reader.page.reload()
        expect(reader.exercise("10.1").says).to_be_empty()

    def test_another_version_of_the_book_judges_nothing(self, reader):
        other = JUDGE.replace("{ this.on", '{ this.library = "another"; this.on', 1)
        reader.page.route("**/_static/judge.js", lambda r: r.fulfill(body=other, content_type="text/javascript"))
        reader.go()
        form = reader.exercise("10.1")
        form.check(K="1.5")
        expect(form.says).to_contain_text("There is a new version of the book: reload this page.")
        assert not reader.remembered["answered"]

    def test_where_nothing_more_can_be_stored_the_page_remembers(self, reader):
        reader.go()
        reader.page.evaluate("""() => {
            localStorage.loopbook = "{}";
            Storage.prototype.setItem = () => { throw new DOMException("full", "QuotaExceededError"); };
        }""")
        form = reader.exercise("10.1")
        form.check(K="15")
        expect(form.box.locator(".known")).to_have_text("tried")
        form.press("Solution")
        expect(form.box.locator(".solved")).to_contain_text("Solution")

    def test_a_name_of_dots_is_a_name_and_one_with_a_sign_that_nobody_sees_is_none(self, reader):
        reader.go()
        form = reader.exercise("10.1")
        form.locator("button.own").click()
        reader.page.get_by_label("Your name").fill("Mira\u202e")
        reader.page.get_by_role("button", name="Use my numbers").click()
        expect(reader.page.locator(".exercise-dialog .problem")).to_contain_text("a sign that nobody sees")
        reader.page.get_by_label("Your name").fill("..")
        reader.page.get_by_role("button", name="Use my numbers").click()
        expect(reader.exercise("10.2").says).to_have_text("")
        expect(reader.page.locator("[aria-busy]")).to_have_count(0)
        texts = [reader.exercise(number).locator(".statement").inner_text() for number in ("10.1", "10.2", "10.3")]
        assert len(set(texts)) == 3


class TestPythonInThePage:
    @pytest.fixture
    def small(self, book, tmp_path):
        """A chapter with all that it needs, Python as well."""
        folder = tmp_path / "book"
        shutil.copytree(book / "_static", folder / "_static", ignore=shutil.ignore_patterns("_images"))
        (folder / "chapters").mkdir()
        shutil.copyfile(book / TUNING, folder / TUNING)
        site.place(site.of_all(), folder, browser_runtime.required())
        site.write(folder, True)
        return folder

    def test_a_reader_answers_comes_back_and_has_her_own_numbers(self, chromium, small):
        """A number, a controller that is drawn, numbers of her own; and all of it again without a network."""
        with served(small.parent) as server:
            reader = Reader(chromium, server + small.name, service_workers="allow")
            reader.go()
            form = reader.exercise("10.1")
            form.check(K="1.5", T="1.25 min", tau="15")
            expect(form.says).to_contain_text("Right.")
            form = reader.exercise("10.7")
            form.field("pid", "Kp").fill("2")
            form.field("pid", "Ti").fill("10 min")
            form.check()
            expect(form.verdict("pid")).to_contain_text("the overshoot is")
            expect(form.says.locator("img")).to_be_visible()
            form = reader.exercise("10.4")
            form.fill_in(Ti="4T^2/(T_C + tau")
            expect(form.locator(".typeset mfrac")).to_be_visible()
            form = reader.exercise("10.2")
            form.locator("button.own").click()
            reader.page.get_by_label("Your name").fill("Mira")
            reader.page.get_by_role("button", name="Use my numbers").click()
            expect(form.says).to_have_text("These are the numbers of Mira.")
            expect(reader.page.locator(".known.right")).to_have_count(0)
        key = exercise("10.2", "Mira").key
        reader.page.reload()
        form = reader.exercise("10.2")
        form.check(**{name: f"{kind.key:.8g}" for name, kind in key.items()})
        expect(form.says).to_contain_text("Right.")
        reader.context.close()
