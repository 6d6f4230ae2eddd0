"""The plug-in of pytest collects what the settings name, fails with sentences, and does nothing without settings."""

import pytest
from nbformat import v4, writes

from bookledger import EXAMPLE, Source
from bookledger.evidence import less
from bookledger.report import MIME_TYPE
from bookledger.rules import RULES

pytest_plugins = ["pytester"]

LEDGER = EXAMPLE.read_text(encoding="utf-8")
CELLS = [
    'from bookledger import Source\nfrom bookledger.evidence import less\nbook = Source.open("../ledger/walls.toml")',
    'wall = book["Example 2.1"]\nk, A, d, D = wall.given("k", "A", "d", "D")',
    'Q = k * A * D / d\nwall.check(Q=Q, R=d / k, thicker=less(Q / 2, Q, "heat flow [W]"))\nbook["Table 2.1"].check()',
]


@pytest.fixture
def collection(pytester):
    """What makes a collection: a ledger and a notebook, and settings that name both; it returns what pytest says."""

    def make(*options, ledger=LEDGER, cells=CELLS, settings="ledger", more="", flow=576):
        book = Source.read("walls", LEDGER.encode())
        wall = book["Example 2.1"].compare(Q=flow, R=0.417, thicker=less(1, 2, "heat flow [W]"))
        notebook = v4.new_notebook(cells=[v4.new_code_cell(source) for source in cells])
        notebook.cells[-1].outputs = [
            v4.new_output("display_data", data={MIME_TYPE: report.data})
            for report in (wall, book["Table 2.1"].compare())
        ]
        for path, text in {"ledger/walls.toml": ledger, "books/02_conduction.ipynb": writes(notebook)}.items():
            (pytester.path / path).parent.mkdir()
            (pytester.path / path).write_text(text, encoding="utf-8")
        if settings:
            pytester.makeini(f"[pytest]\nbookledger_sources = {settings}\nbookledger_notebooks = books\n{more}")
        return pytester.runpytest_inprocess("-p", "no:cacheprovider", *options)

    return make


def test_entries_and_rules_are_proved(collection):
    result = collection("-v")
    result.assert_outcomes(passed=2 + len(RULES))
    result.stdout.fnmatch_lines(["ledger/walls.toml::Example 2.1 PASSED*"])


def test_notebooks_are_run_again_where_the_settings_say_so(collection):
    cells = [*CELLS[:2], CELLS[2].replace("R=d / k", "R=sum([0.4, 0.017])")]
    result = collection(more="bookledger_mutation = true", cells=cells)
    result.assert_outcomes(passed=2 + len(RULES), failed=1)
    result.stdout.fnmatch_lines(["02_conduction, walls, Example 2.1: R is the same with other givens: expected *"])


def test_an_assumption_is_proved_with_the_entries(collection):
    ledger = f'{LEDGER}\n[assumption.still_air]\ntext = "still air"\nparameters = 1\n'
    result = collection("ledger", ledger=ledger)
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["walls, assumption still_air: no result rests on it"])


def test_a_file_is_proved_alone(collection):
    collection("books/02_conduction.ipynb").assert_outcomes(passed=len(RULES))


def test_without_settings_there_is_nothing(collection):
    assert collection(settings="").ret == pytest.ExitCode.NO_TESTS_COLLECTED


@pytest.mark.parametrize(
    ("change", "failed", "sentence"),
    [
        (
            {"ledger": LEDGER.replace('"4.17"', '"four"')},
            2,
            "walls, Example 2.1, R: printed is 'four', expected a number like 1.50*",
        ),
        (
            {"ledger": LEDGER.replace('chapter = "02_c', 'chapter = "03_c')},
            3,
            "walls, Table 2.1: there is no notebook 03_conduction",
        ),
        ({"ledger": LEDGER.replace("Example 2.1", "Example 2.2")}, 2, "walls, Example 2.2: no notebook checks it: *"),
        ({"cells": [*CELLS[:2], "wall.check(Q=576)"]}, 2, "02_conduction, cell * 576 in a check is not computed"),
        ({"flow": 500}, 1, "02_conduction, the check of walls, Example 2.1: Q does not hold"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(collection, change, failed, sentence):
    result = collection(**change)
    assert result.parseoutcomes()["failed"] == failed
    result.stdout.fnmatch_lines([sentence])


def test_a_source_that_is_no_toml_is_an_error(collection):
    result = collection(ledger="[source")
    result.assert_outcomes(errors=1, passed=0)
    result.stdout.fnmatch_lines(["walls.toml is not valid TOML: *"])


def test_a_setting_that_names_nothing_is_an_error(collection):
    result = collection(settings="legder")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["ERROR: bookledger_sources names *legder, which does not exist"])
