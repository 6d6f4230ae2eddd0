"""Executed notebooks, kept as pages: what the cells have shown is there, and nothing that a page should not hold."""

import base64
import json

import pytest

from drawings import chunk, picture
from exercisegrader.events import LONGEST_SHOWN, MOST_SHOWN, Scene, Shown
from exercisegrader.jail import MEGA, Jail, Limits
from exercisegrader.keeping import executed
from exercisegrader.results import Result
from needs import needs_jail
from whole_pages import assert_whole

RESULT = Result("lag", "s1", "s1/lag.ipynb", True, "f" * 64, "complete", "", (), (), ())
NASTY = "<script>alert(1)</script> \x1b[31mred \u202egnp.exe \ud800 \x00 </pre>"


def notebook(*sources):
    cells = [{"cell_type": "code", "source": source, "metadata": {}, "outputs": []} for source in sources]
    cells.append({"cell_type": "markdown", "source": NASTY, "metadata": {}})
    return json.dumps({"nbformat": 4, "nbformat_minor": 4, "metadata": {}, "cells": cells}).encode()


def demand_safe(document):
    assert "default-src 'none'" in document
    return assert_whole(document)


def pictures(checked):
    return [value for name, value in checked.attributes if name == "src"]


def shown(cell, kind, data):
    return {"cell": cell, "kind": kind, "data": data}


def told(*events):
    scene = Scene()
    for event in events:
        scene._take(json.dumps({"shown": event}).encode())
    return scene


# The page.


def test_what_a_cell_shows_is_text_and_nothing_else():
    document = executed(RESULT, notebook(NASTY, "1"), [Shown(1, "text", NASTY), Shown(1, "error", NASTY)], NASTY)
    demand_safe(document)
    assert document.count("&lt;script&gt;") == 5
    assert r"\x1b[31mred \u202egnp.exe \ud800 \x00" in document


def test_a_picture_is_looked_at_and_holds_nothing_else():
    hidden = chunk(b"tEXt", b"Comment\0<script>")
    document = executed(RESULT, notebook("1"), [Shown(1, "png", base64.b64encode(picture(more=hidden)).decode())])
    (link,) = pictures(demand_safe(document))
    assert base64.b64decode(link.split(",")[1]) == picture()


@pytest.mark.parametrize(
    "data",
    [
        '"><script>', "", "AAAA", base64.b64encode(b"GIF89a").decode(),
        base64.b64encode(picture(10**5, 10**5)).decode(),
        base64.b64encode(picture()[:-8]).decode(), base64.b64encode(picture(more=chunk(b"EVIL", b""))).decode(),
    ],
)  # fmt: skip
def test_what_is_no_picture_is_not_shown(data):
    document = executed(RESULT, notebook("1"), [Shown(1, "png", data)])
    assert pictures(demand_safe(document)) == []


def test_without_a_jail_it_says_so():
    result = Result("lag", "s1", "s1/lag.ipynb", False, "f", "complete", "", (), (), ())
    assert "graded without a jail" in executed(result, b"", [])


# What is told.


def test_what_is_told_is_read_with_suspicion():
    scene = told(
        shown(1, "text", "a"), shown(0, "text", "a"), shown(1, "html", "<b>"), shown(1, "text", 5),
        shown(10**9, "text", ""), {"cell": 1}, [],
    )  # fmt: skip
    assert (scene.shown, scene.odd) == ([Shown(1, "text", "a")], 6)


def test_what_is_kept_has_an_end():
    much = "x" * (LONGEST_SHOWN // 2)
    scene = told(*(shown(1 + number // 3, "text", much) for number in range(60)))
    assert [sum(one.cell == cell for one in scene.shown) for cell in (1, 2)] == [1, 1]
    assert sum(len(one.data) for one in scene.shown) <= MOST_SHOWN


# In the jail.


@pytest.fixture(scope="module")
def jail():
    with Jail(limits=Limits(cell=5, total=60, memory=300 * MEGA)) as jail:
        yield jail


@needs_jail
def test_what_cells_show(jail):
    cells = notebook(
        "import sys\nprint('one', 'two')\nprint('three', file=sys.stderr)\n2 + 3",
        "from IPython.display import display\ndisplay({'a': 1})\nNone",
        "import matplotlib.pyplot as plt\nplt.plot([1, 2])\nplt.show()\nprint('after')",
        "1 / 0",
        "print('x' * 10**7)",
        "plt.get_fignums(), print('\\x1b[31m')",
    )
    seen, stopped = jail.show(cells)
    of = {cell: [(one.kind, one.data) for one in seen if one.cell == cell] for cell in range(1, 7)}
    assert stopped == ""
    assert of[1] == [("text", "one two\nthree\n5\n")]
    assert of[2] == [("text", "{'a': 1}\n")]
    assert [kind for kind, _ in of[3]] == ["text", "png"] or [kind for kind, _ in of[3]] == ["png", "text"]
    assert of[4] == [("error", "ZeroDivisionError: division by zero")]
    assert of[5][0][1].endswith("x\n... the rest is omitted")
    assert of[6] == [("text", "\x1b[31m\n([], None)\n")]
    document = executed(RESULT, cells, seen)
    assert len(pictures(demand_safe(document))) == 1


@needs_jail
def test_to_be_shown_changes_no_answer(jail):
    cells = notebook(
        "import matplotlib.pyplot as plt\nplt.plot([1, 2])",
        "import sys\nsheet.answer('1', figures=len(plt.get_fignums()), file=type(sys.stdout).__name__)",
    )
    before = jail.run(cells).answers
    jail.show(cells)
    assert jail.run(cells).answers == before
    assert before["1"]["figures"] == 1


@needs_jail
@pytest.mark.parametrize(
    "source",
    [
        "import json, os\nline = {'shown': {'cell': 1, 'kind': 'text', 'data': 'x' * 10**5}}\n"
        "for k in range(200):\n    os.write(4, json.dumps(line).encode() + b'\\n')",
        "class Evil:\n    def _repr_png_(self): return b'GIF'\n    def __repr__(self): raise SystemExit\nEvil()",
        "import sys\nsys.stdout.write(5)\nsys.stdout = None\nprint(1)",
        "import matplotlib.figure\nmatplotlib.figure.Figure.savefig = lambda *a, **k: 1 / 0\n"
        "import matplotlib.pyplot as plt\nplt.figure()",
        "get_ipython().showing.__dict__.clear()",
    ],
)  # fmt: skip
def test_a_hostile_notebook_is_a_page_all_the_same(jail, source):
    seen, _ = jail.show(notebook("print('first')", source))
    assert seen[0] == Shown(1, "text", "first\n")
    assert sum(len(one.data) for one in seen) <= MOST_SHOWN
    demand_safe(executed(RESULT, notebook("1", source), seen))
