"""Notebooks run again with other givens and prints: an honest one passes, and cheats are found out.

The cheats hand a printed number back by every detour that we could think of; none is forbidden by its form.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from nbformat import v4, writes

from bookledger import Source, mutation
from bookledger.kinds import Claim, Number
from bookledger.mutation import Notebook
from bookledger.stored import Stored

LEDGER = """
[source]
title = "Warm Walls"
citation = "A. N. Author, Warm Walls: an invented textbook on heat, 1st edition"

[assumption.still_air]
text = "still air"
parameters = 1
within = "10 %"

["Example 3.1"]
title = "Heat through a wall"
chapter = "walls"
given = { k = "0.6 W/(m*K)", A = "12 m^2", d = "0.25 m", D = "20 K", law = "k*A/d", walls = "4" }
result = [
    { name = "Q", printed = "576", unit = "W" },
    { name = "R", printed = "0.42", unit = "m^2*K/W" },
    { name = "loss", label = "loss", printed = "1.6e3", unit = "W", status = "reconstructed", assuming = "still_air" },
    { name = "wrong", label = "per area", printed = "84", status = "corrected", correct = "48", because = "a" },
    { name = "flows", label = "flows", kind = "vector", printed = "576, 288.0", unit = "W" },
    { name = "conductance", label = "conductance", kind = "formula", printed = "2*k*A/d" },
    { name = "material", label = "material", kind = "name", printed = "brick" },
    { name = "pi_half", label = "a right angle", printed = "1.57", constant = "a number of mathematics" },
    { name = "thicker", about = "heat flow", claim = "Through a wall of twice the thickness less heat flows." },
    { name = "thinner", about = "temperature", claim = "A thinner wall is warmer outside." },
]

["Table 3.1"]
title = "Walls"
chapter = "walls"
result = [
    { name = "k_brick", label = "brick", printed = "0.60", unit = "W/(m*K)", status = "measured", because = "a" },
    { name = "k_wool", label = "wool", printed = "0.040", unit = "W/(m*K)", status = "observed", on = "a plate" },
    { name = "best", about = "conductivity", claim = "Wool conducts least." },
]
"""

IMPORTS = """
import numpy as np
from math import pi, sqrt
from bookledger import Source
from bookledger.evidence import equal, every, greater, less, positive
book = Source.open("walls.toml")
"""
GIVENS = """
example, table = book["Example 3.1"], book["Table 3.1"]
k, A, d, D, law, walls = example.given("k", "A", "d", "D", "law", "walls")
outer = [None] * walls
"""
HONEST = {
    "Q": "k * A * D / d",
    "R": "d / k",
    "loss": "len(outer) * 0.7 * k * A * D / d",
    "wrong": "k * D / d",
    "flows": "[k * A * D / d, k * A * D / (2 * d)]",
    "conductance": "2 * law",
    "material": '"brick" if k > table.as_printed("k_brick") / 2 else "wool"',
    "pi_half": "pi / 2",
    "thicker": 'less(k * A * D / (2 * d), k * A * D / d, "heat flow [W]")',
    "thinner": 'greater(2 * D, D, "temperature [K]")',
}
TABLE = {"k_wool": "0.04 * float(np.exp(0))", "best": 'less(table.printed_value("k_wool"), 0.5, "conductivity")'}


def notebook(folder, before="", table=TABLE, ledger=LEDGER, **cheats):
    """The honest notebook with other expressions in its checks, and with code before them."""
    (folder / "walls.toml").write_text(ledger, encoding="utf-8")
    checks = {"example": HONEST | cheats, "table": table}
    calls = [f"{name}.check({', '.join(f'{row}={code}' for row, code in rows.items() if code)})"
             for name, rows in checks.items() if rows]  # fmt: skip
    cells = [v4.new_code_cell(source) for source in (IMPORTS, GIVENS, before, *calls)]
    path = folder / "walls.ipynb"
    path.write_text(writes(v4.new_notebook(cells=cells)), encoding="utf-8")
    return Notebook(Stored.at(path), {"walls": Source.open(folder / "walls.toml")})


def complaints(folder, **changes):
    """What is said of such a notebook."""
    return [*notebook(folder, **changes).complaints()]


def test_an_honest_notebook_is_believed(tmp_path):
    assert complaints(tmp_path) == []


SAME, FOLLOWS, TURNED = "is the same with other givens", "follows the print", "turned around"
CHEATS = {
    # values that do not come from what is given
    "a root of a square": (SAME, {"Q": "sqrt(331776)"}),
    "the largest of one": (SAME, {"Q": "np.array([576.0]).max()"}),
    "a function that knows": (SAME, {"before": "def heat_flow(*inputs):\n    return 576", "Q": "heat_flow(k, A)"}),
    "a sum of shares": (SAME, {"Q": "sum([500, 76])"}),
    "multiplied by zero": (SAME, {"Q": "576 + 0 * k"}),
    "rounded to the print": (SAME, {"R": "round(float(d / k), 1) + 0.02"}),
    "the middle of a list": (SAME, {"R": "float(np.linspace(0.32, 0.52, 3)[1])"}),
    "a text that is a number": (SAME, {"Q": "float('57' + '6')"}),
    "code in a text": (SAME, {"Q": "eval('5' + '76')"}),
    "hexadecimal digits": (SAME, {"Q": "0x240"}),
    "characters": (SAME, {"Q": "ord('ɀ')"}),
    "a formula in symbols of one's own": (SAME, {"conductance": "__import__('sympy').sympify('2*k*A/d')"}),
    "a row of literals": (SAME, {"flows": "np.array([576, 288.0])"}),
    "a wider margin": (SAME, {"loss": "1.5e3"}),
    "as long as it is what it was": (
        SAME,
        {"before": "from sympy import Rational\nassert k == Rational(3, 5)\nflow = 576", "Q": "flow"},
    ),
    # values that come from the print
    "the print handed back": (FOLLOWS, {"Q": "example.printed_value('Q')"}),
    "the print by another name": (FOLLOWS, {"before": "p = [example.printed_value('Q')]", "Q": "p[0] * k / k"}),
    "the row as a mapping": (FOLLOWS, {"Q": "vars(vars(example.results[0])['printed'])['value']"}),
    "the row's attribute, spelled": (FOLLOWS, {"Q": "getattr(getattr(example.results[0], 'prin' + 'ted'), 'value')"}),
    "the tables of the source": (FOLLOWS, {"Q": "float(book.tables['Example 3.1']['result'][0]['printed'])"}),
    "another source of the same file": (
        FOLLOWS,
        {"before": "twin = Source.open('walls.toml')['Example 3.1']", "Q": "twin.printed_value('Q')"},
    ),
    "the report of a comparison": (
        FOLLOWS,
        {"before": "told = repr(example.results)", "Q": 'float(told.split("text=\'")[1].split("\'")[0])'},
    ),
    "what is right, of what is wrong": (FOLLOWS, {"wrong": "float(example.results[3].status.correct)"}),
    "near the print": (FOLLOWS, {"R": "example.printed_value('R') + d / k / 1000"}),
    "a name handed back": (FOLLOWS, {"material": "example.results[6].printed.text"}),
    "a formula handed back": (FOLLOWS, {"conductance": "example.results[5].printed.value"}),
    "all prints at once": (
        FOLLOWS,
        {"Q": "", "R": "d / k, **{row.name: row.printed.value for row in example.results[:1]}"},
    ),
    "what the book says": (
        FOLLOWS,
        {"thicker": "(less if example.results[8].printed.says else greater)(k * D, k * A * D, 'heat flow [W]')"},
    ),
    # evidence that cannot fail
    "two numbers": (SAME, {"thicker": "less(np.float64(6), np.float64(7), 'heat flow [W]')"}),
    "givens in words alone": (SAME, {"thicker": "every({f'k = {k}': less(6, 7, 'heat flow [W]')})"}),
    "squares": ("fails", {"thicker": "positive((k * A - d) ** 2)"}),
    "the evidence of another claim": ("fails", {"thicker": HONEST["thinner"]}),
    "a claim of another table": (
        FOLLOWS,
        {"table": TABLE | {"best": "less(float(table.results[1].printed.value), 0.5, 'conductivity')"}},
    ),
    "evidence of one's own": (
        TURNED,
        {
            "before": "from bookledger.evidence import Comparison\nclass Sure(Comparison):\n    holds = True",
            "thicker": "Sure(k * A, '<', k, 'heat flow')",
        },
    ),
    # words without deeds
    "no check": ("nothing is handed over", {"table": {}}),
}


@pytest.mark.parametrize("cheat", CHEATS)
def test_a_cheat_is_found_out(tmp_path, cheat):
    words, changes = CHEATS[cheat]
    found = complaints(tmp_path, **changes)
    assert any(words in complaint for complaint in found), found


def test_what_is_called_constant_must_not_move(tmp_path):
    ledger = LEDGER.replace('printed = "576", unit', 'printed = "576", constant = "heat is heat", unit')
    assert complaints(tmp_path, ledger=ledger) == [
        "walls, Example 3.1: Q moves with other givens, and is called constant: heat is heat"
    ]
    ledger = LEDGER.replace(', constant = "a number of mathematics"', "")
    assert complaints(tmp_path, ledger=ledger) == [
        f"walls, Example 3.1: pi_half {SAME}: expected another value, or `constant` and why"
    ]


def test_a_notebook_that_fails_is_not_run_again(tmp_path):
    (found,) = complaints(tmp_path, Q="2 * k")
    assert found.startswith("cell [4] 'example.check(Q=2 * k")
    assert "fails: Disagreement: walls, Example 3.1: Q = 1.2 does not agree with the printed 576" in found


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system knows no such limit")
def test_a_cell_that_takes_too_long_with_other_givens_is_passed_over(tmp_path, monkeypatch):
    monkeypatch.setattr(mutation, "SECONDS", 0.05)
    slow = notebook(tmp_path, before="while k * A * D / d != 576:\n    pass")
    slow.run(mutation.other_givens)
    assert slow.failed["cell [3] 'while k * A * D / d != 576:'"] == "TimeoutError: it computes too long"


def test_what_is_not_reached_is_said_with_the_first_cell_that_fails(tmp_path):
    given = str(Source.read("walls", LEDGER.encode())["Example 3.1"].givens)
    found = complaints(tmp_path, before=f"assert str(example.givens) == {given!r}\nflow = 576", Q="flow")
    assert {complaint.partition(" fails, ")[0] for complaint in found} >= {
        "walls, Example 3.1: Q is not reached with other givens: cell [2] 'example, table = book[\"Example 3.1\"], bo'"
    }


def test_a_check_that_accepts_anything_is_found_out(tmp_path, monkeypatch):
    monkeypatch.setattr(Number, "agrees", lambda self, value: "digits")
    monkeypatch.setattr(Claim, "computed", lambda self, evidence: evidence)
    found = complaints(tmp_path, ledger=LEDGER.replace(', status = "corrected", correct = "48", because = "a"', ""))
    assert any("Q may be another value, too" in complaint for complaint in found)
    assert any("flows may be another value, too" in complaint for complaint in found)
    assert any("thicker has evidence that bears out thinner, too" in complaint for complaint in found)


def test_the_command_has_a_line_for_each_fault(tmp_path):
    complaints(tmp_path, Q="sum([500, 76])")
    (tmp_path / "other.ipynb").write_text(writes(v4.new_notebook()), encoding="utf-8")
    command = [sys.executable, "-m", "bookledger.mutation", "--sources", "walls.toml", "--notebooks"]
    environment = os.environ | {"PYTHONPATH": str(Path(mutation.__file__).parents[1])}
    for notebooks, status, said in [(["other.ipynb"], 0, 0), (["walls.ipynb", "other.ipynb"], 1, 1)]:
        done = subprocess.run(
            [*command, *notebooks], cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False
        )
        assert (done.returncode, len(done.stdout.splitlines()), done.stderr) == (status, said, "")
