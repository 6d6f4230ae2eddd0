"""Our ledgers as a whole: the pages written from them, the command that writes these, and the entry of the guide."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
import sympy
from typer.testing import CliRunner

import contributing
import loopbook.ledger
from bookledger import Source, truth
from bookledger.books import Books, entries
from bookledger.statuses import STATUSES
from loopbook import errata, s
from loopbook.__main__ import app
from loopbook.evidence import greater
from loopbook.ledger import sources

ROOT = Path(__file__).parents[2]
LEDGER = ROOT / "lib" / "loopbook-books" / "loopbook" / "ledger"
WRITTEN = {file.stem: entries(file.read_text(encoding="utf-8")) for file in sorted(LEDGER.glob("*.toml"))}
PAGES = {"ERRATA.md": errata.page, "docs/unreproduced.md": errata.unreproduced, "docs/damage.md": errata.damaged}


@pytest.mark.parametrize("page", PAGES)
def test_the_pages_are_what_the_command_writes(page):
    assert (ROOT / page).read_text(encoding="utf-8") == PAGES[page](sources())


def test_the_command_prints_every_source_and_writes_the_pages(tmp_path):
    command = [sys.executable, "-m", "loopbook", "ledger"]
    environment = os.environ | {"PYTHONUTF8": "1"}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, encoding="utf-8", env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    head, *lines = [line.split() for line in done.stdout.splitlines() if line.split()]
    assert head == " ".join(["source", *STATUSES, "all"]).split()
    printed = {line[0]: [int(number) for number in line[1:]] for line in lines if line[-1].isdigit()}
    for source, book in WRITTEN.items():
        count = Counter(row.get("status", "computed") for entry in book.values() for row in entry.get("result", []))
        assert printed[source] == [*(count[status] for status in STATUSES), count.total()]
    assert printed["all"] == [sum(column) for column in zip(*(printed[source] for source in WRITTEN), strict=True)]
    for page in PAGES:
        assert (tmp_path / page).read_bytes() == (ROOT / page).read_bytes().replace(b"\r\n", b"\n")


@pytest.mark.parametrize("content", ["[source", '[source]\ncitation = "A"\n["Example 1"]\ntitle = "A"\n'])
def test_the_command_refuses_a_malformed_source_in_one_line(tmp_path, monkeypatch, content):
    (tmp_path / "malformed.toml").write_text(content, encoding="utf-8")
    monkeypatch.setattr(loopbook.ledger, "_FOLDER", tmp_path)
    done = CliRunner().invoke(app, ["ledger", "--errata", str(tmp_path / "ERRATA.md")])
    assert done.exit_code == 1
    assert done.output.startswith("malformed")
    assert len(done.output.splitlines()) == 1
    assert not (tmp_path / "ERRATA.md").exists()


def test_an_unknown_source_is_named_with_the_known_ones(monkeypatch):
    monkeypatch.setattr(loopbook.ledger, "_names", lambda: ["author", "writer"])
    with pytest.raises(AttributeError, match="no source 'auhtor': did you mean 'author'"):
        loopbook.ledger.auhtor  # noqa: B018
    with pytest.raises(ImportError, match="auhtor"):
        from loopbook.ledger import auhtor  # noqa: F401


def test_the_entry_that_contributors_are_shown_is_a_good_one():
    source = Source.read("shown", contributing.ledger().encode())
    assert source.citation in {book.citation for book in sources().values()}
    entry = source["Example 10.2"]
    K, T, tau = sympy.symbols("K T tau", positive=True)
    H = K * sympy.exp(-tau * s) / (T * s + 1)
    gain, lag, delay = entry.given("K", "T", "tau")
    check = entry.compare(K_p=lag / (2 * gain * delay), H=H, less_stable=greater(2, 1, "Ms")).data
    books = Books({"shown": entries(contributing.ledger())}, {"10_tuning": [check]})
    assert truth.complaints("shown", "Example 10.2", books) == []
