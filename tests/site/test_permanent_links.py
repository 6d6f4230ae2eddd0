"""Permanent links: places of the chapters keep their addresses; and each figure can be had alone, with its program.

`python tests/site/test_permanent_links.py build/book` puts new places into the list, and takes none away.
"""

import base64
import json
import os
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LIST = Path(__file__).with_name("permanent_links.txt")
NAMED = re.compile(r' id="((?:example|equation|figure|section|table|exercise|check)-[^"]+)"')
sys.path.insert(0, str(ROOT / "docs" / "extensions"))

import permanent  # noqa: E402 - of docs/extensions/, which has just become a place to import from
import programs  # noqa: E402
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


def test_a_figure_has_its_sign_its_page_and_its_program(book):
    for chapter in single_figures.chapters():
        page = (book / "chapters" / f"{chapter}.html").read_text(encoding="utf-8")
        alone = (book / "figures" / f"{chapter}.html").read_text(encoding="utf-8")
        for figure in single_figures.of_chapter(chapter):
            assert f' id="{figure.name}">' in page, (chapter, figure.name)
            assert f'class="headerlink" href="#{figure.name}"' in page
            assert f'id="{figure.name}"' in alone
            program = (book / "figures" / chapter / f"{figure.name}.py").read_text(encoding="utf-8")
            compile(program, figure.name, "exec")
            assert f'.save("{figure.name}.png")' in program


#: One of a slider, a diagram, one with functions of other cells; all of them once a week.
DRAWN = [("04_laplace", "figure-cell-097"), ("10_tuning", "figure-10-2"), ("16_tuning_relations", "figure-7-17")]
if os.environ.get("LOOPBOOK_ALL") == "1":
    DRAWN = [(chapter, one.name) for chapter in single_figures.chapters() for one in single_figures.of_chapter(chapter)]


@pytest.mark.parametrize(("chapter", "name"), DRAWN)
def test_a_program_draws_the_figure_of_the_chapter(chapter, name, tmp_path, monkeypatch):
    """To the byte, with nothing of the notebook but what the program has taken from it."""
    monkeypatch.chdir(tmp_path)
    figure = next(figure for figure in single_figures.of_chapter(chapter) if figure.name == name)
    known = {"__name__": "alone"}
    exec(compile(single_figures.program(figure), name, "exec"), known)
    output = single_figures.cells_of(chapter)[figure.cell]["outputs"]
    stored = next(o["data"]["image/png"] for o in output if "image/png" in o.get("data", {}))
    assert known["picture"].png() == base64.b64decode("".join(stored))
    assert (tmp_path / f"{name}.png").read_bytes()[:4] == b"\x89PNG"


def cut(*cells):
    """The body of the program for the last of some cells, without its title."""
    whole = programs.program([{"cell_type": "code", "source": cell} for cell in cells], len(cells) - 1, "T")
    return whole.removeprefix('"""T"""\n\n')


@pytest.mark.parametrize(
    ("cells", "kept", "left_out"),
    [
        (["a = 1\nb = 2", "show(a)"], ["a = 1"], ["b = 2"]),
        (["a = 1", "a = 2", "show(a)"], ["a = 2"], ["a = 1"]),
        (["a = {}", "a['x'] = 1\nb = 3", "show(a)"], ["a = {}", "a['x'] = 1"], ["b = 3"]),
        (["a = []", "a.append(1)", "show(a)"], ["a.append(1)"], []),
        (["a = [[], []]", "for part in a:\n    part.append(1)", "show(a)"], ["    part.append(1)"], []),
        (["a = 1", "example.check(a=a)", "show(a)"], [], ["example.check"]),
        (["k = 1", "def f():\n    return k", "k = 2", "show(f())"], ["k = 2", "def f():"], ["k = 1"]),
        (["k = 1", "f = lambda x: k * x", "g = wrap(f)", "k = 2", "show(g)"], ["k = 2"], []),
        (["x = 5", "a = [x for x in range(3)]", "show(a)"], [], ["x = 5"]),
        (["from sympy import exp, sin", "show(sin)"], ["from sympy import sin"], ["exp"]),
        (["if late:\n    a = 2", "show(a)"], ["if late:"], []),
        (["a = 1", "a += b", "show(a)"], ["a = 1", "a += b"], []),
        (["n = 3", "@sliders({'n': (1, 2)})\ndef f(m=n):\n    return draw(m)"], ["picture = f()"], ["@sliders"]),
    ],
)
def test_a_program_has_what_the_figure_needs(cells, kept, left_out):
    lines = cut(*cells)
    assert [one for one in kept if one not in lines.splitlines()] == [], lines
    assert [one for one in left_out if one in lines] == [], lines


def test_a_cell_that_shows_nothing_is_refused():
    with pytest.raises(ValueError, match="expected what it shows"):
        cut("a = 1")


if __name__ == "__main__":
    found, known = present(Path(sys.argv[1])), promised()
    head = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    places = {name: sorted(found.get(name, set()) | known.get(name, set())) for name in {**known, **found}}
    lines = [f"{name}: {' '.join(names)}" for name, names in places.items()]
    LIST.write_text("\n".join([*head, "", *sorted(lines)]) + "\n", encoding="utf-8")
