"""Every stored notebook has our form, every rule of it can be broken, and notebooks are stored as promised."""

import copy
import difflib
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from nbformat import NotebookNode, v4
from typer.testing import CliRunner

import hygiene
from hygiene import CHECKS, ROOT, Stored
from loopbook import notebooks
from loopbook.__main__ import app

STORED = [path for folder in ("chapters", "solutions") for path in sorted((ROOT / folder).glob("*.ipynb"))]


@pytest.mark.parametrize("path", STORED, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_the_stored_notebooks(path):
    stored = Stored.at(path)
    found = [f"{check.__name__}: {complaint}" for check in CHECKS for complaint in check(stored)]
    assert not found, "\n" + "\n".join(found)


# Miniature notebooks: one that every rule accepts, and for every rule those that it refuses.


def text(source):
    return v4.new_markdown_cell(source)


def code(source, *outputs):
    return v4.new_code_cell(source, outputs=list(outputs))


def shows(**data):
    return v4.new_output("display_data", data={mime.replace("_", "/"): value for mime, value in data.items()})


def prints(line, name="stdout"):
    return v4.new_output("stream", name=name, text=line)


def answers(text):
    return code("K", v4.new_output("execute_result", data={"text/plain": text}))


IMPORTS = code("from loopbook.ledger import haugen\nfrom loopbook.tuning import simc")
EXAMPLE = text("## Example 10.2 · a lag with dead time")
GIVENS = code('example = haugen["Example 10.2"]\nK, T, tau = example.given("K", "T", "tau")')
FIGURE = code("trends(loop)", shows(text_plain="<Figure>", image_png="iVBORw0KGgo/home/QAAUh0x7f3a5c0d1e50"))
SLIDER = code("@interact(T=(1, 3))\ndef slow(T): trends(loop(T))")
OPENING = code("@sliders({'T [s]': (1, 3)})\ndef lag(T): return trends(loop(T))", FIGURE.outputs[0])
CHECK = code("example.check(Kp=settings.Kp, Ti=T + tau)")
CLOSING = text("## What you can do now")
GOOD = [text("# Tuning"), IMPORTS, OPENING, EXAMPLE, GIVENS, FIGURE, SLIDER, CHECK, CLOSING]


def stored(*cells, name="10_tuning", change=lambda notebook: None):
    notebook = notebooks.normalised(v4.new_notebook(cells=list(cells)))
    change(notebook)
    return Stored(Path(f"chapters/{name}.ipynb"), notebooks.as_text(notebook), notebook)


def changed(change):
    return stored(*GOOD, change=change)


def with_code(*sources, section=True):
    """The good notebook with more cells in the section of its example, or in a section of their own."""
    heading = [] if section else [text("## Another")]
    return stored(*GOOD[:-1], *heading, *(code(source) for source in sources), CLOSING)


BROKEN = [
    (hygiene.named_as_designed, "no row in the README", stored(*GOOD, name="10_tuning_copy")),
    (hygiene.valid, "format 4.4", changed(lambda n: n.update(nbformat_minor=4))),
    (hygiene.valid, "not a valid notebook", changed(lambda n: n.cells[0].pop("source"))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[1].update(execution_count=1))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[1].metadata.update(scrolled=True))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[0].metadata.update(tags=[notebooks.SLIDERS]))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[4].metadata.update(tags=[notebooks.SLIDERS]))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[6].metadata.pop("tags"))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[6].metadata["tags"].append("nbval-skip"))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.cells[7].metadata.update(tags=["raises-exception"]))),
    (hygiene.in_normal_form, "not as", changed(lambda n: n.metadata.update(widgets={}))),
    (hygiene.in_normal_form, "not as", stored(*GOOD)._replace(text=stored(*GOOD).text.replace("\n", "\r\n"))),
    (hygiene.light, "bytes", stored(*GOOD, code("trends(loop)", shows(image_png="A" * hygiene.MOST_BYTES)))),
    (hygiene.fit_to_store, "stored error", stored(*GOOD, code("1/0", v4.new_output("error", ename="E", evalue="e")))),
    (hygiene.fit_to_store, "stderr", stored(*GOOD, code("poles(H)", prints("UserWarning", "stderr")))),
    (hygiene.fit_to_store, "address", stored(*GOOD, code("loop", shows(text_plain="<Loop at 0x7f3a5c0d1e50>")))),
    (hygiene.fit_to_store, "/home/ada/book", stored(*GOOD, code("here", prints("in /home/ada/book")))),
    (hygiene.fit_to_store, "/Users/ada", stored(*GOOD, code("here", prints("'/Users/ada'")))),
    (hygiene.fit_to_store, "C:", stored(*GOOD, code("here", shows(text_plain=r"'C:\\Users\\ada'")))),
    (hygiene.fit_to_store, "/tmp/", stored(*GOOD, code('open("/tmp/x")'))),
    (hygiene.fit_to_store, "/work/", stored(*GOOD, text("Kept in /work/loopbook."))),
    (hygiene.fit_to_store, "/root/", stored(*GOOD, text("Kept in /root/loopbook."))),
    (hygiene.plain_python, "cell [7]", with_code("%matplotlib inline")),
    (hygiene.without_tricks, "sys.path", with_code("sys.path.append('..')")),
    (hygiene.without_tricks, "import", with_code("try:\n    import control\nexcept ImportError:\n    pass")),
    (hygiene.without_tricks, "hides", with_code("try:\n    poles(H)\nexcept Exception:\n    pass")),
    (hygiene.without_tricks, "hides", with_code("try:\n    poles(H)\nexcept:\n    pass")),
    (hygiene.without_tricks, "cannot fail", with_code("assert True")),
    (hygiene.one_import_cell, "outside", with_code("import sympy")),
    (hygiene.one_import_cell, "outside", with_code("def f():\n    from sympy import pi\n    return pi")),
    (hygiene.one_import_cell, "among", stored(code("import sympy\nsympy.init_printing()"))),
    (hygiene.short_cells, "13 lines", with_code("\n".join(["K"] * 13))),
    (hygiene.short_cells, "89 columns", with_code("K" * 89)),
    (hygiene.short_cells, "median", with_code(*["K\nK\nK\nK\nK"] * 9)),
    (hygiene.only_sliders_escape_comparison, "hides", with_code("# NBVAL_IGNORE_OUTPUT\nexample.check(Kp=Kp)")),
    (hygiene.only_sliders_escape_comparison, "hides", with_code("# NBVAL_IGNORE_OUTPUT\n" + SLIDER.source)),
    (hygiene.only_sliders_escape_comparison, "hides", with_code("K\n# NBVAL_SKIP")),
    (hygiene.only_sliders_escape_comparison, "hides", with_code(SLIDER.source + "\n# NBVAL_SKIP")),
    (hygiene.sections_begin_a_cell, "within", stored(*GOOD, text("So much for this.\n\n## Example 10.3"))),
    (hygiene.answers_are_labelled, "2.1", stored(*GOOD, answers("2.1"))),
    (hygiene.answers_are_labelled, "[0.3, 16.0]", stored(*GOOD, answers("[0.3, 16.0]"))),
    (hygiene.answers_are_labelled, "oo", stored(*GOOD, answers("{'pole': -oo, 'pair': sqrt(2)/2}"))),
    (hygiene.answers_are_labelled, "True", stored(*GOOD, answers("True"))),
    (hygiene.answers_are_labelled, "a word", stored(*GOOD, answers("'a word'"))),
    (hygiene.core_is_short, "61 code cells", stored(*GOOD, *(code("K") for _ in range(55)))),
    (hygiene.core_is_short, "61 code cells", stored(*GOOD, text("## Core"), *(code("K") for _ in range(55)))),
    (hygiene.opens_and_closes, "no slider", stored(*GOOD[:2], *GOOD[3:])),
    (hygiene.opens_and_closes, "What you can do now", stored(*GOOD[:-1])),
    (hygiene.sliders_follow_a_figure, "without a figure", with_code(SLIDER.source, section=False)),
    (hygiene.sliders_keep_what_they_use, "uses K, which", with_code(SLIDER.source.replace("T))", "K))"), "K = 3")),
    (
        hygiene.sliders_keep_what_they_use,
        "uses T, which",
        with_code(
            "def loop(K):\n    return [K * T for _ in range(3)]",
            SLIDER.source.replace("(T)", "(K)").replace("T=", "K="),
            "for T in range(3):\n    T",
        ),
    ),
]

ACCEPTED = [
    (hygiene.one_import_cell, stored()),
    (hygiene.fit_to_store, stored(*GOOD, text("A ratio a/home/b, https://example.org/home/x and 0xff are fine."))),
    # a name within a comprehension or a function is another one
    *(
        (hygiene.sliders_keep_what_they_use, with_code(SLIDER.source.replace("T))", "K))"), later))
        for later in ("[K for K in (1, 2)]", "sum(K for K in (1, 2))", "def f():\n    K = 3", "lambda K: K")
    ),
]


def test_the_rules_accept_a_good_notebook():
    assert [complaint for check in CHECKS for complaint in check(stored(*GOOD))] == []


def test_the_rules_accept_what_looks_alike(subtests):
    for check, notebook in ACCEPTED:
        with subtests.test(check=check.__name__):
            assert check(notebook) == []


def test_the_rules_refuse_a_broken_notebook(subtests):
    for check, words, notebook in BROKEN:
        with subtests.test(check=check.__name__, words=words):
            complaints = check(notebook)
            assert any(words in complaint for complaint in complaints), complaints


def test_the_rules_have_all_been_seen_to_refuse():
    assert {check for check, _, _ in BROKEN} == set(CHECKS)


# Running and storing.

CHAPTER = [
    text("# A lag"),
    code("import matplotlib.pyplot as plt\nfrom ipywidgets import interact\nfrom loopbook import s"),
    code("print('one')\nprint('two')"),
    code("1 / (2*s + 1)"),
    code("plt.plot([0, 1])\nplt.show()"),
    code("@interact(T=(1, 3))\ndef lag(T=2): print(T)"),
    code(""),
]


def write(path, *cells):
    path.parent.mkdir(exist_ok=True)
    path.write_text(notebooks.as_text(v4.new_notebook(cells=list(cells))), encoding="utf-8")
    return path.read_bytes()


def execute(*paths):
    result = CliRunner().invoke(app, ["execute", *map(str, paths)])
    return result.exit_code, result.output.splitlines()


def test_execute_stores_the_same_bytes_again_and_nothing_unfit(tmp_path):
    folder = tmp_path / "a folder with spaces"
    good = folder / "04_laplace.ipynb"
    write(good, *CHAPTER)
    unfit = {
        "failing": ([code("K = 1"), code("K / 0\n\nK")], "cell [2] 'K / 0': ZeroDivisionError: division by zero"),
        "hidden": (
            [v4.new_code_cell("1 / 0", metadata={"tags": ["raises-exception"]})],
            "cell [1] '1 / 0': ZeroDivisionError",
        ),
        "address": ([code("object()")], "cell [1] 'object()': shows a memory address"),
        "path": (
            [code("'/'.join(['', 'home', 'ada'])")],
            "cell [1] \"'/'.join(['', 'home', 'ada'])\": shows a path of one machine, /home/ada",
        ),
        "warning": (
            [code("import warnings\nwarnings.warn('careful')")],
            "cell [1] 'import warnings': writes to stderr",
        ),
        "slider": (
            [code("from ipywidgets import interact\n@interact(T=(1, 3))\ndef f(T): 1 / 0")],
            "a slider fails: Zero",
        ),
    }
    before = {name: write(folder / f"{name}.ipynb", *cells) for name, (cells, _) in unfit.items()}
    (folder / "text.ipynb").write_text("no notebook")

    exit_code, lines = execute(folder)

    assert exit_code == 1
    assert "7 of 8 notebooks not stored" in lines
    assert [line for line in lines if line.startswith(f"{folder / 'text.ipynb'}: not a notebook")]
    for name, (_, words) in unfit.items():
        path = folder / f"{name}.ipynb"
        assert [line for line in lines if line.startswith(f"{path}: {words}")], (name, lines)
        assert path.read_bytes() == before[name]
    assert not list(folder.glob(".*"))

    first = good.read_bytes()
    exit_code, lines = execute(good)
    assert exit_code == 0
    assert lines[0].startswith(f"{good}: unchanged")
    assert good.read_bytes() == first
    stored = Stored.at(good)
    for check in CHECKS:
        assert check(stored) == [], check.__name__
    assert [[output.output_type for output in cell.outputs] for _, cell in hygiene.code(stored.notebook)] == [
        [],
        ["stream"],
        ["execute_result"],
        ["display_data"],
        [],
    ]


def test_execute_names_a_path_that_it_cannot_find(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert execute("missing.ipynb") == (1, ["missing.ipynb: no such notebook"])
    assert execute() == (1, ["no notebooks here: name some, or run this in the folder that holds chapters"])


def test_an_interrupted_execution_leaves_the_file_as_it_was(tmp_path):
    path = tmp_path / "04_laplace.ipynb"
    before = write(path, code("open('started', 'w').close()\nimport time\ntime.sleep(60)"))
    process = subprocess.Popen([sys.executable, "-m", "loopbook", "execute", path], stdout=subprocess.DEVNULL)
    while not (tmp_path / "started").exists():
        assert process.poll() is None
        time.sleep(0.05)
    process.kill()
    process.wait()
    assert path.read_bytes() == before


def test_pytest_compares_every_output_of_a_stored_notebook(tmp_path):
    """The settings of the repository run notebooks again: an output that changed or was not stored fails."""
    two, three = (v4.new_output("execute_result", data={"text/plain": number}) for number in "23")
    cells = {
        "same": code("1 + 1", two),
        "changed": code("1 + 1", three),
        "missing": code("1 + 1"),
        "sliders": code("@interact(T=(1, 3))\ndef lag(T=2): print(T)", prints("not as it is")),
        "tagged": v4.new_code_cell("1 + 1", outputs=[three], metadata={"tags": ["nbval-ignore-output", "nbval-skip"]}),
    }
    stored = notebooks.normalised(v4.new_notebook(cells=[code("from ipywidgets import interact"), *cells.values()]))
    assert {cell.execution_count for cell in stored.cells} == {None}
    (tmp_path / "all.ipynb").write_text(notebooks.as_text(stored), encoding="utf-8")
    shutil.copy(ROOT / "conftest.py", tmp_path)
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-c",
        ROOT / "pyproject.toml",
        "-p",
        "no:cacheprovider",
        "-rfp",
        tmp_path,
    ]
    result = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=tmp_path, check=False)
    assert result.returncode == 1
    outcomes = {int(cell): word for word, cell in re.findall(r"^(PASSED|FAILED) .*::Cell (\d+)", result.stdout, re.M)}
    found = {name: outcomes[cell] for cell, name in enumerate(cells, start=1)}
    assert found == {
        "same": "PASSED",
        "changed": "FAILED",
        "missing": "FAILED",
        "sliders": "PASSED",
        "tagged": "FAILED",
    }, result.stdout


# What a diff shows.


def test_a_cell_keeps_its_id_for_life():
    before = notebooks.normalised(v4.new_notebook(cells=CHAPTER))
    assert [cell.id for cell in before.cells] == [cell.id for cell in CHAPTER if cell.source]
    kept = copy.deepcopy(before)
    first, *others = kept.cells
    kept.cells = [*reversed(others), code("added = 1"), first]
    kept.cells[0].source += "  # changed"
    after = notebooks.normalised(kept)
    assert [cell.id for cell in after.cells] == [cell.id for cell in kept.cells]
    assert notebooks.as_text(notebooks.normalised(after)) == notebooks.as_text(after)


def test_a_cell_without_an_id_of_its_own_gets_one_from_its_content():
    def without(source):
        cell = code(source)
        del cell["id"]
        return cell

    def named(*cells):
        made = notebooks.normalised(NotebookNode(cells=list(cells)))  # v4.new_notebook would mend them at random
        assert hygiene.valid(Stored(Path(), "", made)) == []
        return [cell.id for cell in made.cells]

    (alone,) = named(without("K = 1"))
    assert named(text("# Lag"), without("K = 1"))[1] == alone
    first, second = named(without("K = 1"), without("K = 1"))
    assert first == alone != second
    # neither a copy nor one with the same content takes the id of a cell that has one
    assert named(without("K = 1"), v4.new_code_cell("K = 1", id=alone))[1] == alone
    original, pasted = named(*(v4.new_code_cell(source, id="gain") for source in ("K = 1", "K = 2")))
    assert original == "gain" != pasted
    invalid = code("K = 1")
    invalid.id = "no id"
    assert re.fullmatch("[0-9a-f]{8}", *named(invalid))


def test_a_file_with_a_missing_or_a_double_id_is_not_as_stored(tmp_path):
    good = stored(*GOOD)
    first, second = (f'   "id": "{cell.id}",\n' for cell in good.notebook.cells[:2])
    path = tmp_path / "10_tuning.ipynb"
    for wrong in ("", second):
        path.write_text(good.text.replace(first, wrong), encoding="utf-8")
        with pytest.warns(FutureWarning, match="id"):  # nbformat mends it as it reads, and says so
            assert hygiene.in_normal_form(Stored.at(path))
    path.write_text(good.text, encoding="utf-8")
    assert hygiene.in_normal_form(Stored.at(path)) == []


def test_added_cells_leave_the_others_as_they_were():
    """Three new cells in a chapter of a hundred change the lines that they hold, and no other."""
    path = ROOT / "chapters" / "05_transfer_functions.ipynb"
    before = notebooks.read(path)
    after = copy.deepcopy(before)
    added = [text("Three times as slow:"), code("slower = 3 * T", prints("one")), code("slower", shows(text_plain="3"))]
    after.cells[5:5] = added
    old, new = (notebooks.as_text(notebooks.normalised(one)).splitlines() for one in (before, after))
    changed = [line for line in difflib.ndiff(old, new) if line[0] in "+-"]
    assert not [line for line in changed if line[0] == "-"]
    assert len(changed) == len(new) - len(old) < 60
