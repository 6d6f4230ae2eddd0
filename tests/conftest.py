"""What all tests share.

Random examples are the same at every run, so that no reader's test fails by luck; each week new ones are tried. Linear
algebra keeps to one thread: the tests themselves run in parallel, and many threads for small matrices only wait.
"""

import os
import subprocess
import time
from pathlib import Path

import pytest
from hypothesis import settings

from recipes import recipe

ROOT = Path(__file__).parents[1]

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# what a reader has answered so far is no matter here, and stays as it is
os.environ["LOOPBOOK_PROGRESS"] = "off"

settings.register_profile("the same every time", derandomize=True, deadline=None)
settings.register_profile("new ones", deadline=None)
settings.load_profile("new ones" if os.environ.get("LOOPBOOK_UNPINNED") == "1" else "the same every time")


#: What takes long begins first, so that no process works alone at the end; before all, what builds the site for others.
FIRST = ("tests/test_browser_site.py", "chapters/11_", "tests/test_ise.py", "tests/test_ledger_in_chapters.py",
         "tests/test_exercises.py", "chapters/", "tests/test_browser.py", "tests/test_solutions.py")  # fmt: skip
#: What needs the site finds it built.
LAST = ("lib/", "README.md", "tests/test_style.py", "tests/test_book.py", "tests/test_cheat_sheet.py")


def pytest_collection_modifyitems(items):
    """Sort whole files, as `--no-loadscope-reorder` hands them out."""

    def place(item):
        for number, name in enumerate(FIRST):
            if item.nodeid.startswith(name):
                return number - len(FIRST)
        return 1 + LAST.index(name) if (name := next(filter(item.nodeid.startswith, LAST), None)) else 0

    items.sort(key=place)


@pytest.fixture(scope="class")
def chromium():
    """The browser, for the tests of one class: while Playwright's loop runs, no notebook can have one of its own."""
    import browser

    browser.required()
    browser.SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    with browser.opened() as chromium:
        yield chromium


@pytest.fixture(scope="session")
def book(tmp_path_factory):
    """The site as ``make book`` makes it: its folder. The first process that asks builds it, the others wait.

    ``LOOPBOOK_BOOK=build/book`` takes one that is there, which saves time while a test is written.
    """
    if "LOOPBOOK_BOOK" in os.environ:
        return Path(os.environ["LOOPBOOK_BOOK"]).resolve()
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    site, log = shared / "book", shared / "book.log"
    try:
        (shared / "book.claimed").mkdir()
    except FileExistsError:
        wait_for_the_end_of(log, seconds=900)
    else:
        build(site, log)
    assert (site / "index.html").exists(), log.read_text(encoding="utf-8")
    return site


def build(site, log):
    """Build the site; the log appears when all is done."""
    partial = site.with_name("book.partial")
    command = [str(partial) if word == "build/book" else word for word in recipe("book")]
    command += ["-d", str(site.with_name("book.doctrees"))]
    sphinx = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
    if sphinx.returncode == 0:
        partial.rename(site)
    log.with_name("book.log.partial").write_text(sphinx.stdout, encoding="utf-8")
    log.with_name("book.log.partial").rename(log)


def wait_for_the_end_of(log, seconds):
    end = time.monotonic() + seconds
    while not log.exists():
        assert time.monotonic() < end, "the process that builds the site does not come to an end"
        time.sleep(0.2)
