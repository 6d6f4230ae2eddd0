"""What the tests of the site and of JupyterLab share: a browser, and the site, which is built once."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import browser

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="class")
def chromium():
    """The browser, for the tests of one class: while Playwright's loop runs, no notebook can have one of its own."""
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
    command = [sys.executable, "docs", str(partial), "-d", str(site.with_name("book.doctrees"))]
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
