"""Permanent links: places of the chapters keep their addresses; and each figure can be had alone, with its cell.

`python tests/site/test_permanent_links.py build/book` puts new places into the list, and takes none away.
"""

import ast
import html
import json
import re
import sys
from pathlib import Path

from draws import of_the_day

ROOT = Path(__file__).parents[2]
LIST = Path(__file__).with_name("permanent_links.txt")
NAMED = re.compile(r' id="((?:example|equation|figure|section|table|exercise|check)-[^"]+)"')
sys.path.insert(0, str(ROOT / "docs" / "extensions"))

import permanent  # noqa: E402 - of docs/extensions/, which has just become a place to import from
import single_figures  # noqa: E402


def promised():
    """The places that must not vanish: {chapter: {name, ...}}."""
    lines = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {name: set(places.split()) for name, _, places in (line.partition(": ") for line in lines)}


def present(site):
    """The places that there are, of the kinds in the list."""
    pages = sorted((site / "chapters").glob("*.html"))
    return {page.stem: set(NAMED.findall(page.read_text(encoding="utf-8"))) for page in pages}


def test_no_permanent_link_is_dead(book):
    found = present(book)
    gone = {name: sorted(places - found.get(name, set())) for name, places in promised().items()}
    assert not any(gone.values()), {name: places for name, places in gone.items() if places}


def test_every_place_is_promised(book):
    known = promised()
    new = {name: sorted(places - known.get(name, set())) for name, places in present(book).items()}
    said = f"put them into the list: python {Path(__file__).relative_to(ROOT)} build/book"
    assert not any(new.values()), (said, {name: places for name, places in new.items() if places})


def test_what_stands_for_an_old_place_is_there(book):
    for chapter, moved in permanent.MOVED.items():
        page = (book / "chapters" / f"{chapter}.html").read_text(encoding="utf-8")
        assert [name for name in moved if f' id="{name}"' not in page] == [], chapter


def test_what_the_ledger_names_has_its_place(book):
    """An example, a numbered equation, a table: the chapter that computes it has its address."""
    found = present(book)
    missing = []
    for file in sorted((ROOT / "chapters").glob("*.ipynb")):
        for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
            for output in cell.get("outputs", []):
                check = output.get("data", {}).get("application/vnd.loopbook.check+json")
                wanted = permanent.names_of(check["entry"]) if check else []
                for verdict in check["verdicts"] if check else []:
                    wanted += permanent.names_of(f"Equation {verdict.get('equation', '-')}")
                missing += [(file.stem, name) for name in wanted if name not in found[file.stem]]
    assert missing == []


def test_a_figure_has_its_sign_its_page_and_its_cell(book):
    for chapter in single_figures.chapters():
        page = (book / "chapters" / f"{chapter}.html").read_text(encoding="utf-8")
        alone = (book / "figures" / f"{chapter}.html").read_text(encoding="utf-8")
        code = html.unescape(re.sub("<[^>]+>", "", alone))
        assert single_figures.imports(chapter).strip() in code
        for figure in single_figures.of_chapter(chapter):
            assert f' id="{figure.name}">' in page, (chapter, figure.name)
            assert f'class="headerlink" href="#{figure.name}"' in page
            assert f'id="{figure.name}"' in alone
            assert single_figures.cells_of(chapter)[figure.cell]["source"].strip() in code


def figures():
    return [figure for chapter in single_figures.chapters() for figure in single_figures.of_chapter(chapter)]


def test_the_first_cell_of_a_chapter_has_all_its_imports():
    for chapter in single_figures.chapters():
        cells = [cell["source"] for cell in single_figures.cells_of(chapter) if cell["cell_type"] == "code"]
        imports = [
            any(isinstance(node, ast.Import | ast.ImportFrom) for node in ast.parse(cell).body) for cell in cells
        ]
        assert imports == [True] + [False] * (len(cells) - 1), chapter


def test_a_cell_that_does_not_go_on_from_others_runs_below_the_imports():
    alone = [figure for figure in figures() if not single_figures.goes_on(figure)]
    assert len(alone) > 50
    for figure in of_the_day(alone, 5):
        known = {"__name__": "alone"}
        exec(single_figures.imports(figure.chapter), known)
        exec(single_figures.cells_of(figure.chapter)[figure.cell]["source"], known)


if __name__ == "__main__":
    found, known = present(Path(sys.argv[1])), promised()
    head = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    places = {name: sorted(found.get(name, set()) | known.get(name, set())) for name in {**known, **found}}
    lines = [f"{name}: {' '.join(names)}" for name, names in places.items()]
    LIST.write_text("\n".join([*head, "", *sorted(lines)]) + "\n", encoding="utf-8")
