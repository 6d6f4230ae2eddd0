"""The whole book as a PDF, made of the pages of the site by Chromium: ``python docs/pdf build/book``.

It has a title page, contents with the numbers of the pages, the chapters with core and further reading, the solutions,
bookmarks, and links that work within. Chromium prints twice: the first printing says on which page each line of the
contents is, the second has the numbers.
"""

import io
import re
import sys
from pathlib import Path

import pypdf

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "tests" / "site"), str(HERE.parent / "extensions")]

from reading import WHOLE_BOOK  # noqa: E402

import browser  # noqa: E402 - of tests/site/, which has just become a place to import from
import repository  # noqa: E402 - of docs/extensions/

FILE = "loopbook.pdf"
TITLE = "loopbook"
ABOUT = [
    "Process control from the books, as notebooks that compute everything the books print.",
    f"{repository.COPYRIGHT}. Version {repository.VERSION}. {repository.LICENCES} {repository.ADDRESS}".strip(),
]


ASSEMBLE = (HERE / "assemble.js").read_text(encoding="utf-8")
#: Writes the numbers into the contents, and returns its lines.
NUMBER = """known => [...document.querySelectorAll(".book-contents a")].map(line => {
    const number = known[decodeURIComponent(line.hash.slice(1))];
    line.lastChild.textContent = number;
    return [Number(line.dataset.level), line.firstChild.textContent, number];
})"""


def parts(site: Path) -> list[dict]:
    """What the book has: the chapters, and the solutions as an appendix, by the addresses of their pages."""
    chapters, solutions = (
        [f"{folder}/{page.name}" for page in sorted((site / folder).glob("*.html"))]
        for folder in ("chapters", "solutions")
    )
    if not chapters:
        raise SystemExit(f"{site} has no chapters: make the site first, with make book")
    return [{"title": "", "pages": chapters}, {"title": "Solutions", "pages": solutions}]


def printed(page) -> bytes:
    """Print what the browser shows. (With a structure for readers of screens the file would be four times as large.)"""
    return page.pdf(prefer_css_page_size=True, print_background=True)


def numbers(pdf: bytes) -> dict[str, int]:
    """On which page each place of a PDF is to which something leads, counted from 1."""
    reader = pypdf.PdfReader(io.BytesIO(pdf))
    places = reader.named_destinations.items()
    return {name.removeprefix("/"): reader.get_destination_page_number(place) + 1 for name, place in places}


def made(chromium, site: Path, book: list[dict]) -> bytes:
    """Return the PDF of the parts of a site, printed by a browser that is open."""
    with browser.served(site) as address:
        page = chromium.new_page(viewport=browser.DESKTOP, color_scheme="light")
        page.set_default_timeout(0)  # hundreds of sheets take as long as they take
        page.route(re.compile(r"\.js(\?|$)"), lambda request: request.abort())  # on paper nothing moves
        page.goto(f"{address}{book[0]['pages'][0]}")
        page.evaluate(ASSEMBLE, {"address": address, "parts": book, "title": TITLE, "about": ABOUT})
        page.add_style_tag(path=HERE / "look.css")
        print("printing all pages: once for their numbers", flush=True)
        lines = page.evaluate(NUMBER, numbers(printed(page)))
        print(f"and once more, with {len(lines)} lines of contents", flush=True)
        pdf = printed(page)
        page.close()
    return with_bookmarks(pdf, lines)


def with_bookmarks(pdf: bytes, lines: list[tuple[int, str, int]]) -> bytes:
    """Return a PDF with a bookmark for each line of its contents: (level, title, number of the page)."""
    writer = pypdf.PdfWriter(clone_from=io.BytesIO(pdf))
    writer.add_metadata({"/Title": TITLE, "/Author": repository.AUTHORS})
    writer.page_mode = "/UseOutlines"
    above = {0: None}
    for level, title, number in lines:
        above[level + 1] = writer.add_outline_item(title=title, page_number=number - 1, parent=above[level])
    file = io.BytesIO()
    writer.write(file)
    return file.getvalue()


def link(site: Path) -> None:
    """Let the pages that have a place for it lead to the PDF."""
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        if WHOLE_BOOK in text:
            up = "../" * (len(page.relative_to(site).parts) - 1)
            text = text.replace(WHOLE_BOOK, f'<span><a href="{up}{FILE}">The whole book</a> (PDF)</span>')
            page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    site = Path(sys.argv[1]).resolve()
    with browser.opened() as chromium:
        (site / FILE).write_bytes(made(chromium, site, parts(site)))
    link(site)
    print(f"{site / FILE} is made", flush=True)
