"""A chapter runs in the page: JupyterLite opens it, its sliders move, changes are kept, and nobody else is asked."""

import sys
from urllib.parse import urlsplit

import pytest
from axe_playwright_python.sync_playwright import Axe

import browser
import browser_runtime
from browser import PATIENCE, ROOT
from desk import until

sys.path.insert(0, str(ROOT))

from docs.browser import lite

CHAPTER = "chapters/05_transfer_functions.ipynb"
SAYS = "#loopbook .says"
#: The notebook as JupyterLite holds it.
NOTEBOOK = "jupyterapp.shell.currentWidget.content.model.toJSON()"
#: The notebook as the browser keeps it.
KEPT = f"jupyterapp.serviceManager.contents.get('{CHAPTER}', {{content: true}})"
CHANGED = "The zero is on the right."


@pytest.fixture(scope="class")
def site(tmp_path_factory):
    """The part of a site for schools without a network that runs notebooks."""
    parts, folder = browser_runtime.required(), tmp_path_factory.mktemp("school")
    (folder / "chapters").mkdir()
    (folder / CHAPTER).with_suffix(".html").write_text("<!doctype html><title>Its page</title>", encoding="utf-8")
    lite.write(folder, offline=True, source=parts)
    return folder


@pytest.fixture(scope="class")
def reader(chromium):
    """A reader's browser, and the addresses outside of this machine that it asked for."""
    context = chromium.new_context(viewport=browser.DESKTOP)
    context.set_default_timeout(PATIENCE)
    elsewhere = []
    context.on("request", lambda request: is_here(request.url) or elsewhere.append(request.url))
    yield context, elsewhere
    context.close()


def is_here(url):
    return urlsplit(url.removeprefix("blob:")).hostname in ("127.0.0.1", None)


def opened(page, address):
    """Open the chapter, and wait for Python."""
    page.goto(f"{address}lite/notebooks/index.html?path={CHAPTER}")
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function(f"/ready|again/.test(document.querySelector('{SAYS}').textContent)")
    assert "Python is ready" in page.inner_text(SAYS)


def outputs(page):
    """The outputs of the code cells, and how many of these were run."""
    cells = [cell for cell in page.evaluate(NOTEBOOK)["cells"] if cell["cell_type"] == "code"]
    return [output for cell in cells for output in cell["outputs"]], [cell["execution_count"] for cell in cells]


class TestAChapterInThePage:
    def test_it_runs_and_is_kept_without_any_other_machine(self, site, reader):
        context, elsewhere = reader
        page = context.new_page()
        with browser.served(site) as address:
            opened(page, address)
            self.runs(page)
            self.moves(page)
            self.is_accessible(page)
            page.evaluate(
                f"jupyterapp.shell.currentWidget.content.model.cells.get(0).sharedModel.setSource('{CHANGED}')"
            )
            until(lambda: page.evaluate(KEPT)["content"]["cells"][0]["source"] == CHANGED)  # it is saved by itself
            page.get_by_role("link", name="Back to the page").click()
            page.wait_for_url(f"**/{CHAPTER.replace('.ipynb', '.html')}")
        # the server is gone: what the browser keeps is all there is
        opened(page, address)
        assert page.evaluate(NOTEBOOK)["cells"][0]["source"] == CHANGED
        assert elsewhere == []

    def runs(self, page):
        page.get_by_role("button", name="Run all cells", exact=True).click()
        page.wait_for_function(f"{NOTEBOOK}.cells.filter(cell => cell.cell_type == 'code').at(-1).execution_count")
        shown, counts = outputs(page)
        assert all(counts)
        assert [each for each in shown if each["output_type"] in ("error", "stream")] == []

    def moves(self, page):
        """A slider of the chapter's opening moves its picture."""
        picture = page.locator("img.loopbook-figure").first
        before = picture.get_attribute("src")
        page.get_by_role("slider").first.press("ArrowRight")
        page.wait_for_function("before => document.querySelector('img.loopbook-figure').src != before", arg=before)

    def is_accessible(self, page):
        """The line above the notebook; the rest is Jupyter's."""
        found = Axe().run(page, context={"include": [["#loopbook"]]}).response["violations"]
        assert [each["id"] for each in found if each["impact"] in ("serious", "critical")] == []

    def test_from_a_file_it_says_why_it_does_not(self, site, reader):
        page = reader[0].new_page()
        page.goto((site / "lite" / "notebooks" / "index.html").as_uri())
        page.wait_for_function("document.body.textContent.includes('runs only on the pages of a web server')")
