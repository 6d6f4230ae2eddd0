"""What the site costs: `make bench` prints how long it takes to build, how large its pages are, and how soon they show.

A page counts without its figures. It shows when something of it is first painted, from a server on the same machine,
to a browser that comes for the first time, and to one that comes again. The same is measured of the first answer to an
exercise, with all parts of Python on that server, and of the answers after it.
"""

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from docs.browser import site as parts
from rich.console import Console
from rich.table import Table

import browser
import browser_runtime

ROOT = Path(__file__).parents[2]
RUNS = 5
#: The front page, the largest pages, and one with a live lesson.
VISITED = ["index", "ledger", "chapters/16_tuning_relations", "chapters/17_dead_time_compensation"]


def build(folder: Path) -> tuple[Path, float]:
    """Build the site as ``make book`` does, from nothing: where it is, and the seconds."""
    site = folder / "book"
    begin = time.perf_counter()
    subprocess.run([sys.executable, "docs", str(site)], cwd=ROOT, check=True)
    return site, time.perf_counter() - begin


def the_pages(site: Path, seconds: float) -> Table:
    files = {path.relative_to(site): path.stat().st_size for path in site.rglob("*") if path.is_file()}
    in_the_page = sum(size for path, size in files.items() if path.parts[0] == "lite")
    whole = sum(size for path, size in files.items() if path.parts[0] != ".doctrees")
    sizes = {str(path): size for path, size in files.items() if path.suffix == ".html" and path.parts[0] != "lite"}
    table = Table("", "", title=f"{len(sizes)} pages, built in {seconds:.0f} s")
    for page in sorted(sizes, key=sizes.get, reverse=True)[:5]:
        table.add_row(page, f"{sizes[page] / 1000:.0f} kB")
    table.add_row("median page", f"{statistics.median(sizes.values()) / 1000:.0f} kB")
    table.add_row("the notebooks in the page", f"{in_the_page / 1e6:.1f} MB")
    table.add_row("the whole site", f"{whole / 1e6:.1f} MB")
    return table


def the_first_paint(site: Path) -> Table:
    table = Table("page", "first visit", "second visit", title=f"First paint, median of {RUNS}")
    with browser.opened() as chromium, browser.served(site.parent) as address:
        for name in VISITED:
            found = [[], []]
            for _ in range(RUNS):
                visitor = chromium.new_context(viewport=browser.DESKTOP)
                page = visitor.new_page()
                for times in found:
                    page.goto(f"{address}{site.name}/{name}.html")
                    times.append(browser.first_paint(page))
                visitor.close()
            table.add_row(name, *(f"{1000 * statistics.median(times):.0f} ms" for times in found))
    return table


def the_answers(site: Path) -> Table:
    parts.place(parts.of_all(), site, browser_runtime.parts())
    parts.write(site, True)
    asked = {"do": "check", "exercise": "7.1", "student": None, "answers": {"I": "14.4 mA", "p": "0.85 MPa"}}
    found = {"first visit, nothing kept": [], "second visit": [], "the answers after it": []}
    with browser.opened() as chromium, browser.served(site) as address:
        for _ in range(RUNS):
            visitor = chromium.new_context()
            for first in list(found)[:2]:
                page = visitor.new_page()
                page.goto(f"{address}index.html")
                found[first].append(browser_runtime.ask(page, asked)["seconds"])
                found["the answers after it"] += [browser_runtime.ask(page, asked)["seconds"] for _ in range(RUNS)]
                browser_runtime.wait_until_compiled(page, site)
                page.close()
            visitor.close()
    table = Table("", "", title=f"Until an exercise is answered, median of {RUNS}")
    for name, seconds in found.items():
        table.add_row(name, f"{statistics.median(seconds):.2f} s")
    return table


if __name__ == "__main__":
    console = Console()
    folder = Path(tempfile.mkdtemp())
    try:
        site, seconds = build(folder)
        console.print(the_pages(site, seconds))
        console.print(the_first_paint(site) if browser.chromium() else browser.MISSING)
        console.print(the_answers(site) if browser.chromium() else "")
    finally:
        shutil.rmtree(folder)
