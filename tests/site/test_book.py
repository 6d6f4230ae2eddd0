"""The site: every link leads somewhere, every formula is MathML, every figure has words, and all of it is local."""

import importlib
import re
import sys
from functools import cached_property
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import parse_qs, unquote, urlsplit

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
START = "00_start"  # what leads readers of JupyterLab to the chapters; the site has a front page
CHAPTERS = [path for path in sorted(ROOT.glob("chapters/*.ipynb")) if path.stem != START]
LARGEST = 600_000  # bytes of a page without its figures
EMPTY = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
OPTIONAL = {"dd", "dt", "li", "p", "tbody", "td", "tfoot", "th", "thead", "tr"}  # whose end HTML lets one leave out
FETCHED = {
    ("link", "href"),
    ("script", "src"),
    ("img", "src"),
    ("source", "src"),
    ("iframe", "src"),
    ("object", "data"),
}
SHOWN_AS_IT_IS = {"dt", "code", "pre", "script", "style", "title", "textarea"}


class Page(HTMLParser):
    """A page of the site: its elements, the text outside of code, and what is not closed as it was opened."""

    def __init__(self, path):
        super().__init__()
        self.path, self.elements, self.text, self.stack, self.torn = path, [], [], [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs), tuple(self.stack)))
        if tag not in EMPTY:
            self.stack.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs), tuple(self.stack)))

    def handle_endtag(self, tag):
        if tag in EMPTY:
            return
        while self.stack and self.stack[-1] != tag and self.stack[-1] in OPTIONAL:
            self.stack.pop()
        if not self.stack or self.stack.pop() != tag:
            self.torn.append((tag, self.getpos()))

    def handle_data(self, data):
        if not SHOWN_AS_IT_IS & set(self.stack) and data.strip():
            self.text.append(data)

    def all(self, *tags):
        return [attributes for tag, attributes, _ in self.elements if tag in tags]

    @cached_property
    def ids(self):
        return [attributes["id"] for _, attributes, _ in self.elements if attributes.get("id")]


@pytest.fixture(scope="module")
def pages(book):
    """The pages that Sphinx made; those below lite/ are JupyterLite's."""
    made = [path for path in sorted(book.rglob("*.html")) if not {"_static", "lite"} & set(path.parts)]
    return {path: Page(path) for path in made}


def extension(name):
    """Return a module of docs/extensions/."""
    sys.path.insert(0, str(ROOT / "docs" / "extensions"))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.pop(0)


def name(book, path):
    return path.relative_to(book).as_posix()


def test_every_chapter_and_every_solution_has_its_page(book, pages):
    for folder in ("chapters", "solutions"):
        stored = {path.stem for path in (ROOT / folder).glob("*.ipynb")}
        stored.discard(START)
        assert {path.stem for path in pages if path.parent == book / folder} == stored


def test_every_link_leads_to_a_page_and_a_place_of_the_site(book, pages):
    dead = []
    for path, page in pages.items():
        for tag, attributes, _ in page.elements:
            for attribute in ("href", "src"):
                link = attributes.get(attribute)
                if not link or tag == "use" or urlsplit(link).scheme:
                    continue
                parts = urlsplit(link)
                target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
                place = unquote(parts.fragment)
                if not target.is_file() or (place and target in pages and place not in pages[target].ids):
                    dead.append((name(book, path), link))
    assert not dead, f"{len(dead)} dead links: {dead[:8]}"


def test_every_chapter_and_every_solution_leads_to_its_notebook_in_the_page(book, pages):
    for path, page in pages.items():
        if path.parent.name in ("chapters", "solutions"):
            (link,) = [urlsplit(a["href"]) for a in page.all("a") if a.get("class") == "run"]
            assert (path.parent / link.path).resolve() == book / "lite" / "notebooks" / "index.html"
            (notebook,) = parse_qs(link.query)["path"]
            assert notebook == f"{path.parent.name}/{path.stem}.ipynb"
            assert (book / "lite" / "files" / notebook).is_file()


def test_a_place_has_one_name(book, pages):
    for path, page in pages.items():
        twice = {place for place in page.ids if page.ids.count(place) > 1}
        assert not twice, (name(book, path), sorted(twice)[:5])


def test_nothing_is_fetched_from_elsewhere_and_no_link_needs_the_site_at_a_certain_address(book, pages):
    for path, page in pages.items():
        for tag, attributes, _ in page.elements:
            for attribute in ("href", "src", "data", "srcset", "poster", "action"):
                link = attributes.get(attribute) or ""
                assert not link.startswith("/"), (name(book, path), link)
                if (tag, attribute) in FETCHED:
                    assert urlsplit(link).scheme in {"", "data"}, (name(book, path), link)
    for sheet in (book / "_static").rglob("*.css"):
        links = re.findall(r"url\(\s*['\"]?([^'\")]+)", sheet.read_text(encoding="utf-8"))
        links += re.findall(r"@import\s+['\"]([^'\"]+)", sheet.read_text(encoding="utf-8"))
        for link in links:
            parts = urlsplit(link)
            assert parts.scheme in {"", "data"}, (sheet.name, link)
            assert parts.scheme or not parts.path or (sheet.parent / parts.path).is_file(), (sheet.name, link)


def test_a_page_is_small_and_whole(book, pages):
    for path, page in pages.items():
        assert path.stat().st_size < LARGEST, (name(book, path), path.stat().st_size)
        assert not page.torn, (name(book, path), page.torn[:3])


def test_a_page_says_its_language_its_title_and_how_wide_it_is(book, pages):
    for path, page in pages.items():
        assert page.all("html")[0].get("lang") == "en", name(book, path)
        assert [a for a in page.all("meta") if a.get("name") == "viewport"], name(book, path)
        assert len(page.all("title")) >= 1, name(book, path)
        assert len(page.all("h1")) == 1, (name(book, path), len(page.all("h1")))


def test_every_figure_has_words_a_size_and_waits_for_the_reader(book, pages):
    for path, page in pages.items():
        for image in page.all("img"):
            assert image.get("alt"), (name(book, path), image)
            if image["src"].startswith("../_images"):
                assert image.get("loading") == "lazy", (name(book, path), image)
                assert "width" in image or "width" in image.get("style", ""), (name(book, path), image)


def test_the_words_of_a_figure_are_those_that_the_notebook_stores(book, pages):
    for stored in CHAPTERS:
        cells = nbformat.read(stored, as_version=4).cells
        still = [cell for cell in cells if "nbval-ignore-output" not in cell.metadata.get("tags", [])]  # lessons move
        outputs = [o for cell in still for o in cell.get("outputs", [])]
        words = [o.data["text/plain"][1:-1] for o in outputs if "image/png" in o.get("data", {})]
        images = pages[book / "chapters" / f"{stored.stem}.html"].all("img")
        assert [image["alt"] for image in images if image.get("class") != "lesson-drawing"] == words


def test_every_formula_is_mathml_and_no_latex_is_left(book, pages):
    formulas = 0
    for path, page in pages.items():
        for tag, attributes, _ in page.elements:
            assert tag != "merror", name(book, path)
            if tag in {"div", "span"} and "math" in (attributes.get("class") or "").split():
                formulas += 1
        formulas_here = len(page.all("math"))
        for text in page.text:
            assert "$" not in text, (name(book, path), text[:80])
            assert not re.search(r"\\[a-z]{2,}", text), (name(book, path), text[:80])
        in_words = path.stem == "A_instrument_symbols" or name(book, path) == "solutions/11d_plantwide_control.html"
        if path.parent.name in ("chapters", "solutions") and not in_words:
            assert formulas_here >= 10, name(book, path)
    assert formulas > 3000


def test_a_solution_is_folded_and_the_way_leads_there_and_back(book, pages):
    for path in pages:
        if path.parent.name != "chapters":
            continue
        chapter, solutions = pages[path], pages[book / "solutions" / path.name]
        exercises = [place for place in chapter.ids if re.fullmatch(r"exercise-[\da-z]+-\d+", place)]
        folded = [a for a in solutions.all("details") if a.get("class") == "solution"]
        assert exercises
        assert len(folded) == len(exercises)
        assert not any("open" in attributes for attributes in folded)
        for place in exercises:
            number = place.removeprefix("exercise-")
            assert f"../solutions/{path.name}#solution-{number}" in {a.get("href") for a in chapter.all("a")}
            assert f"../chapters/{path.name}#{place}" in {a.get("href") for a in solutions.all("a")}


def test_every_check_of_a_chapter_has_its_place_and_a_link_to_the_ledger(book, pages):
    slugs = extension("slugs")
    for stored in CHAPTERS:
        page = pages[book / "chapters" / f"{stored.stem}.html"]
        links = {attributes.get("href") for attributes in page.all("a")}
        for cell in nbformat.read(stored, as_version=4).cells:
            for output in cell.get("outputs", []):
                if check := output.get("data", {}).get("application/vnd.loopbook.check+json"):
                    of = check["source"], check["entry"]
                    assert slugs.check_anchor(*of) in page.ids
                    assert f"../ledger/{stored.stem}.html#{slugs.ledger_anchor(*of)}" in links


def test_sections_lead_to_the_reference_of_the_functions_that_they_use(book, pages):
    for path, page in pages.items():
        if path.parent.name == "chapters":
            assert [a for a in page.all("a") if re.match(r"\.\./reference/\w+\.html#loopbook\.", a.get("href") or "")]
            named = [above for tag, a, above in page.elements if tag == "code" and "py-obj" in (a.get("class") or "")]
            assert all("a" in above for above in named), name(book, path)


@pytest.mark.parametrize(
    ("latex", "mathml"),
    [
        (r"\left(s + 1\right)", '<mo stretchy="false">(</mo><mi>s</mi><mo>+</mo><mn>1</mn><mo stretchy="false">)</mo>'),
        (
            r"\left(-1\right)",
            '<mo stretchy="false">(</mo><mo form="prefix">−</mo><mn>1</mn><mo stretchy="false">)</mo>',
        ),
        (r"\ln 2", '<mi>ln</mi><mo>\u2061</mo><mspace width="0.167em" /><mn>2</mn>'),
        (r"\operatorname{atan}{\left(x\right)}", "<mi>atan</mi><mo>\u2061</mo>"),
        (r"k'", '<mi>k</mi><mo lspace="0" rspace="0">′</mo>'),
        (r"\mathrm{d}t", "<mtext>d</mtext><mi>t</mi>"),
        (r"1/s", '<mn>1</mn><mo lspace="0" rspace="0">/</mo><mi>s</mi>'),
        (r"\dot{x}", '<mover accent="true"><mi>x</mi><mo>˙</mo></mover>'),
        (r"\text{remains, $R$}", "<mi>R</mi>"),
    ],
)
def test_a_formula_is_set_as_in_print(latex, mathml):
    assert mathml in extension("mathml").convert(latex)


def test_a_formula_that_cannot_be_set_is_named():
    with pytest.raises(ValueError, match="cannot be written as MathML"):
        extension("mathml").convert(r"\frac{1}{")


def test_formulas_in_a_table_are_set_and_code_is_left_alone():
    in_html = extension("mathml").in_html
    assert in_html("<td>$a &lt; b$</td>").startswith("<td><math><mi>a</mi>")
    assert in_html("<code>$HOME</code>") == "<code>$HOME</code>"


def test_what_a_section_uses_is_read_from_its_code():
    names = extension("functions_used").Names()
    assert names.used("from loopbook import transfer, tuning as rules\nfrom loopbook.loops import Loop") == {}
    used = names.used("loop = Loop(transfer.first_order(1, 2), rules.simc(x))")
    assert set(used) == {"loopbook.loops.Loop", "loopbook.transfer.first_order", "loopbook.tuning.simc"}
    assert names.used("Loop = 3") == {}
    assert names.used("Loop") == {}
