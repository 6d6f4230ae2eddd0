"""What the site costs: `make bench` prints how long it takes to build, how large its pages are, and how soon they show.

A page counts without its figures. Each kind of page is opened by a browser that comes for the first time: from a server
on the same machine, and as a phone has it, behind slow 4G with a processor that is four times as slow.
The first answer to an exercise is timed as well, with all parts of Python on that server, and the answers after it.
``python tests/site/bench_book.py build/book`` measures the pages of a site that is there.
"""

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table

import browser
import browser_runtime

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from docs.browser import site as parts  # noqa: E402 - the repository has just become a place to import from

RUNS = 3
#: A page of each kind, and the largest.
VISITED = [
    "index.html",
    "chapters/05_transfer_functions.html",
    "chapters/11_control_structures.html",
    "chapters/13_poles_and_zeros.html",
    "solutions/16_tuning_relations.html",
    "ledger.html",
    "ledger.html?q=Skogestad",
    "ledger/13_poles_and_zeros.html",
    "reference/exercises.html",
    "cheat_sheet.html",
    "search.html?q=Smith+predictor",
]
#: Round trip in ms, and bytes per second, as browsers' tools name it.
SLOW_4G = {"offline": False, "latency": 150, "downloadThroughput": 1.6e6 / 8, "uploadThroughput": 0.75e6 / 8}


def build(folder: Path) -> tuple[Path, float]:
    """Build the site as ``make book`` does, from nothing: where it is, and the seconds."""
    site = folder / "book"
    begin = time.perf_counter()
    subprocess.run([sys.executable, "docs", str(site)], cwd=ROOT, check=True)
    return site, time.perf_counter() - begin


def the_pages(site: Path, seconds: float) -> Table:
    files = {path.relative_to(site): path.stat().st_size for path in site.rglob("*") if path.is_file()}
    in_the_page = sum(size for path, size in files.items() if path.parts[0] == "lite")
    whole = sum(files.values())
    sizes = {str(path): size for path, size in files.items() if path.suffix == ".html" and path.parts[0] != "lite"}
    table = Table("", "", title=f"{len(sizes)} pages" + (f", built in {seconds:.0f} s" if seconds else ""))
    for page in sorted(sizes, key=sizes.get, reverse=True)[:5]:
        table.add_row(page, f"{sizes[page] / 1000:.0f} kB")
    table.add_row("median page", f"{statistics.median(sizes.values()) / 1000:.0f} kB")
    table.add_row("the notebooks in the page", f"{in_the_page / 1e6:.1f} MB")
    table.add_row("the whole site", f"{whole / 1e6:.1f} MB")
    return table


def the_visits(site: Path) -> Table:
    table = Table("page", title=f"Median of {RUNS} first visits: here, and on a phone behind slow 4G")
    for name in ("elements", "here: painted", "moved", "longest task", "phone: painted", "moved", "longest task"):
        table.add_column(name, justify="right")
    with browser.opened() as chromium, browser.served(site.parent) as address:
        for name in (name for name in VISITED if (site / name.partition("?")[0]).exists()):
            here = [visit(chromium, f"{address}{site.name}/{name}", phone=False) for _ in range(RUNS)]
            phone = [visit(chromium, f"{address}{site.name}/{name}", phone=True) for _ in range(RUNS)]
            cells = [f"{here[0]['nodes']}"]
            for found in (here, phone):
                middle = {key: statistics.median(each[key] for each in found) for key in found[0]}
                cells += [f"{middle['painted']:.0f} ms", f"{middle['moved']:.3f}", f"{middle['busy']:.0f} ms"]
            table.add_row(name, *cells)
    return table


def visit(chromium, address: str, phone: bool) -> dict[str, float]:
    """What a browser sees that comes for the first time."""
    visitor = chromium.new_context(viewport=browser.PHONE if phone else browser.DESKTOP)
    page = visitor.new_page()
    page.set_default_timeout(browser.PATIENCE)
    page.add_init_script(browser.WATCH)
    if phone:
        tools = visitor.new_cdp_session(page)
        tools.send("Network.enable")
        tools.send("Network.emulateNetworkConditions", SLOW_4G)
        tools.send("Emulation.setCPUThrottlingRate", {"rate": 4})
    page.goto(address, wait_until="networkidle")
    found = browser.seen(page)
    visitor.close()
    return found


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
    console = Console(width=140)
    folder = Path(tempfile.mkdtemp())
    try:
        site, seconds = (Path(sys.argv[1]).resolve(), 0) if sys.argv[1:] else build(folder)
        console.print(the_pages(site, seconds))
        console.print(the_visits(site) if browser.chromium() else browser.MISSING)
        if browser.chromium() and not sys.argv[1:]:  # it puts Python into the site
            console.print(the_answers(site))
    finally:
        shutil.rmtree(folder)
