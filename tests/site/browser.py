"""What the tests in a browser share: Chromium, what a page complains about, a server of files, an audit."""

import contextlib
import functools
import http.server
import os
import re
import shutil
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
#: Pictures for people to look at; git ignores the folder.
SCREENSHOTS = ROOT / "build" / "screenshots"
DESKTOP = {"width": 1280, "height": 900}
PHONE = {"width": 390, "height": 844}
#: Milliseconds that anything may take on a machine that has other things to do. Nothing waits longer than it must.
PATIENCE = 240_000

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
MISSING = "no browser: nothing was proved in a browser; install Chromium, for example with: apt-get install chromium"


def chromium() -> str | None:
    """Where the system's Chromium is, or ``None``."""
    return next(filter(None, map(shutil.which, NAMES)), None)


@contextlib.contextmanager
def opened() -> Iterator:
    """A running Chromium, steered by Playwright."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=PATIENCE)
    # a container has no user namespaces to build the browser's own sandbox of, and often little shared memory
    arguments = ["--no-sandbox", "--disable-dev-shm-usage"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=arguments, timeout=PATIENCE)
        yield browser
        browser.close()


def required() -> None:
    """Skip loudly where there is no browser; in continuous integration that is a failure."""
    if chromium():
        return
    if os.environ.get("CI"):
        pytest.fail(MISSING)
    warnings.warn(pytest.PytestWarning(MISSING), stacklevel=2)
    pytest.skip(MISSING)


class Complaints(list):
    """What a page complains about: errors and warnings on its console, exceptions, requests that fail.

    Messages that match one of ``noise`` are skipped.
    """

    def __init__(self, page, noise: tuple[str, ...] = ()):
        super().__init__()
        self.noise = re.compile("|".join(noise) or r"(?!)")
        page.on("console", lambda message: self.note(message.type, f"{message.text} ({message.location['url']})"))
        page.on("pageerror", lambda error: self.note("error", str(error)))
        page.on("requestfailed", self.note_failure)
        page.on("response", lambda answer: answer.status < 400 or self.note("error", f"{answer.url}: {answer.status}"))

    def note_failure(self, request) -> None:
        if request.failure != "net::ERR_ABORTED":  # what a reader who walks on leaves behind
            self.note("error", f"{request.url}: {request.failure}")

    def note(self, kind: str, text: str) -> None:
        if kind in ("error", "warning") and not self.noise.search(text):
            self.append(f"{kind}: {text}")


class Patient(http.server.ThreadingHTTPServer):
    """A server that turns nobody away while it is busy."""

    request_queue_size = 128


class Silent(http.server.SimpleHTTPRequestHandler):
    """A server of files that does not tell what it serves."""

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def served(folder: Path, prefix: str = "some/prefix") -> Iterator[str]:
    """The address under which a local server shows a folder, below a prefix as on a site for many projects."""
    handler = functools.partial(Silent, directory=str(folder))
    with Patient(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


#: Notes, from the beginning of a page, when its largest part was painted, what moved, and what kept it busy.
WATCH = """(() => {
    window.seen = {painted: 0, moved: 0, busy: 0};
    const watch = (type, note) =>
        new PerformanceObserver(list => list.getEntries().forEach(note)).observe({type, buffered: true});
    watch("largest-contentful-paint", entry => { seen.painted = entry.startTime; });
    watch("layout-shift", entry => { if (!entry.hadRecentInput) seen.moved += entry.value; });
    watch("longtask", entry => { seen.busy = Math.max(seen.busy, entry.duration); });
})()"""


def seen(page) -> dict[str, float]:
    """What has been noted of a page for which WATCH is an init script.

    ``painted``, when its largest part was, and ``busy``, its longest task, are in milliseconds; ``moved`` is the
    cumulative layout shift, and ``nodes`` the number of its elements.
    """
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => setTimeout(done)))")
    return page.evaluate("({...seen, nodes: document.getElementsByTagName('*').length})")


def serious(page, part: str | None = None, **options) -> list[str]:
    """What axe finds that keeps people from reading a page, or a part of its text: rule, how many times, where first.

    What is hidden and what is not asked for is taken away first: axe passes it over, but takes seconds to do so.
    """
    from axe_playwright_python.sync_playwright import Axe

    if part:
        page.evaluate(
            "part => document.querySelector('article').replaceChildren(...document.querySelectorAll(part))", part
        )
    page.evaluate("document.querySelectorAll('[hidden]').forEach(part => part.remove())")
    found = Axe().run(page, options={"resultTypes": ["violations"], **options}).response["violations"]
    return [
        f"{each['id']} ({each['impact']}), {len(each['nodes'])} times: {each['nodes'][0]['html'][:200]}"
        for each in found
        if each["impact"] in ("serious", "critical")
    ]
