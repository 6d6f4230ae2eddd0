"""A chapter in JupyterLab as a reader has it: opened, run from the menu, its sliders moved, its exercises answered."""

import hashlib
import re

import pytest
from playwright.sync_api import expect

from browser import DESKTOP, PHONE, ROOT
from desk import Desk, jupyterlab, until

#: A quick one that has sliders, and exercises whose responses can say a lot.
CHAPTER = "05_transfer_functions.ipynb"


@pytest.fixture(scope="class")
def desk(chromium, tmp_path_factory):
    """JupyterLab with a chapter that has been run from the menu to its end, and saved."""
    folder = tmp_path_factory.mktemp("lab") / "desk"
    with jupyterlab(folder, CHAPTER) as lab:
        desk = Desk(chromium.new_page(viewport=DESKTOP), lab.file)
        desk.open(lab.chapter)
        desk.screenshot("opened")
        desk.run_all()
        desk.save()
        desk.screenshot("run")
        yield desk
        desk.page.close()


@pytest.fixture(scope="class")
def lab(tmp_path_factory):
    with jupyterlab(tmp_path_factory.mktemp("lab") / "desk", CHAPTER) as lab:
        yield lab


@pytest.fixture(scope="class")
def start(chromium, lab):
    """The start page, when it has come to rest."""
    desk = Desk(chromium.new_page(viewport=DESKTOP), lab.file.with_name("00_start.ipynb"))
    desk.open(lab.front)
    desk.screenshot("start")
    yield desk
    desk.page.close()


class TestStartPage:
    """What ``make lab`` opens, for a reader who has never had it."""

    def test_it_is_all_that_is_open_and_nothing_is_asked(self, start):
        expect(start.tabs()).to_have_text(["00_start.ipynb"])
        assert start.page.locator("dialog.jp-Dialog, .Toastify__toast").count() == 0
        assert start.page.locator(".jp-NotebookPanel h1").inner_text().startswith("Start here")

    def test_it_runs_and_shows_what_is_right(self, start):
        start.run_all()
        expect(start.code.nth(1).locator(".jp-OutputArea-output")).to_contain_text(re.compile(r"0 of \d+ right"))

    def test_a_title_opens_its_chapter_and_the_repository_stays_as_it_is(self, start, lab):
        original = lab.file.parents[2] / "chapters" / CHAPTER
        before = original.read_bytes()
        start.page.locator(".jp-OutputArea-output a", has_text="Transfer functions").click()
        expect(start.tabs()).to_have_text(["00_start.ipynb", CHAPTER])
        start.ready()
        start.file = lab.file
        start.save()
        assert original.read_bytes() == before
        assert start.complaints == []


@pytest.fixture(scope="class")
def chapters_before():
    return fingerprint()


def fingerprint():
    """What lies in the folder of the chapters."""
    files = (path for path in (ROOT / "chapters").rglob("*") if path.is_file())
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


@pytest.mark.usefixtures("chapters_before")
class TestJupyterLab:
    def test_a_chapter_runs_from_the_menu_to_its_end(self, desk):
        code = desk.stored()
        assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
        outputs = [output for cell in code for output in cell["outputs"]]
        assert [output for output in outputs if output["output_type"] in ("error", "stream")] == []
        assert any("image/png" in output.get("data", {}) for output in outputs)

    @pytest.mark.parametrize("way", ["by mouse", "by keyboard"])
    def test_a_slider_moves_the_figure(self, desk, way):
        cell = desk.code.filter(has=desk.page.locator(".noUi-handle")).first
        cell.scroll_into_view_if_needed()
        slider = cell.locator(".noUi-handle").last
        slider.scroll_into_view_if_needed()
        before, value = desk.picture(cell), slider.get_attribute("aria-valuenow")
        if way == "by mouse":
            slider.hover()  # waits until it has come to rest
            box = slider.bounding_box()
            x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            desk.page.mouse.move(x, y)
            desk.page.mouse.down()
            desk.page.mouse.move(x + 40, y, steps=5)
            desk.page.mouse.up()
        else:
            slider.focus()
            desk.page.keyboard.press("ArrowLeft")
        desk.page.wait_for_function(
            "([cell, before]) => [...cell.querySelectorAll('.jp-OutputArea-output img')].some(i => i.src != before)",
            arg=[cell.element_handle(), before],
        )
        assert slider.get_attribute("aria-valuenow") != value
        desk.rest()
        desk.screenshot("slider_" + way.replace(" ", "_"))

    def test_an_exercise_answers_to_what_is_wrong_and_to_what_is_right(self, desk):
        wrong = desk.answer("5.1", 'H_u="1.5/(0.6*s + 0.2)", H_M=..., pole=1/3')
        desk.screenshot("wrong")
        assert "H_u: right" in wrong, wrong
        assert "pole: With such a pole the speed would run away" in wrong
        assert "H_M: not answered yet" in wrong
        right = desk.answer("5.1", 'H_u="1.5/(0.6s + 0.2)", H_M="-1/(0.6*s + 0.2)", pole=-1/3')
        expect(desk.cell('exercise("5.1").check(').locator("mjx-mfrac")).to_have_count(1)  # how it was read
        desk.screenshot("right")
        assert "right" in right.splitlines()[0], right

    def test_a_response_is_read_on_a_phone(self, desk):
        """With the list of files put away, as JupyterLab's own View menu does it."""
        desk.page.set_viewport_size(PHONE)
        desk.page.keyboard.press("Control+b")
        response = desk.cell('exercise("5.1").check(').locator(".jp-OutputArea-output")
        response.scroll_into_view_if_needed()
        until(lambda: response.bounding_box()["width"] > 0.5 * PHONE["width"])
        desk.screenshot("phone")
        assert response.evaluate("part => part.scrollWidth <= part.clientWidth"), "the response is cut"
        desk.page.keyboard.press("Control+b")
        desk.page.set_viewport_size(DESKTOP)

    def test_a_figure_is_turned_over_in_a_dark_theme(self, desk):
        figure = desk.page.locator(".jp-OutputArea-output img").first
        theme, style = "document.body.dataset.jpThemeLight = ", "figure => getComputedStyle(figure).filter"
        assert figure.evaluate(style) == "none"
        desk.page.evaluate(theme + "false")
        assert figure.evaluate(style) == "invert(0.93) hue-rotate(180deg)"
        desk.page.evaluate(theme + "true")

    def test_nothing_complains(self, desk):
        assert desk.complaints == []

    def test_the_chapters_are_as_before(self, desk, chapters_before):
        assert fingerprint() == chapters_before
