"""`python -m bookledger` writes what a ledger and its stored checks say, as HTML and as a list of errata."""

import json

import pytest

from bookledger import EXAMPLE, Source
from bookledger.__main__ import main
from bookledger.evidence import less
from bookledger.report import MIME_TYPE


@pytest.fixture
def written(tmp_path, monkeypatch):
    """What makes both files for the example of a source, with a heat flow in its stored check."""

    def write(flow=576):
        (tmp_path / "walls.toml").write_text(EXAMPLE.read_text(encoding="utf-8"), encoding="utf-8")
        wall = Source.open(tmp_path / "walls.toml")["Example 2.1"]
        report = wall.compare(Q=flow, R=0.417, thicker=less(288, 576, "heat flow [W]"))
        cell = {"outputs": [{"data": {MIME_TYPE: report.data}}]}
        (tmp_path / "books").mkdir()
        (tmp_path / "books" / "02_conduction.ipynb").write_text(json.dumps({"cells": [cell]}), encoding="utf-8")
        monkeypatch.chdir(tmp_path)
        main(["walls.toml", "--notebooks", "books"])
        return [(tmp_path / name).read_text(encoding="utf-8") for name in ("ledger.html", "ERRATA.md")]

    return write


def test_the_page_has_each_result_beside_what_was_computed(written):
    page, _ = written()
    assert "<td>✓ computed</td><td>2.3</td><td>Q</td><td>576 W</td><td>576</td>" in page
    assert "<td>heat flow 288 W &lt; 576 W</td>" in page
    assert "<p>corrected: the decimal point is lost</p>" in page
    assert "2 computed, 1 corrected, 2 measured" in page


def test_what_fails_and_what_no_notebook_checks_is_seen(written):
    page, _ = written(flow=500)
    assert '<tr class="fails"><td>✗ does not hold</td>' in page
    assert page.count("<p>No notebook checks it.</p>") == 1


def test_the_errata_lead_to_the_notebook(written):
    _, errata = written()
    assert "prints `4.17`, correct is `0.417`: the decimal point is lost." in errata
    assert "([02_conduction](books/02_conduction.ipynb))" in errata
