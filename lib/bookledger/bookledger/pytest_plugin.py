"""The plug-in of pytest: it proves a ledger, and the notebooks that check it.

It does nothing until the settings of pytest name both, files or folders:

.. code-block:: toml

    [tool.pytest.ini_options]
    bookledger_sources = "ledger"       # TOML files
    bookledger_notebooks = "chapters"   # stored notebooks
    bookledger_evidence = "bookledger.evidence"    # the module that the notebooks import evidence from
    bookledger_mutation = true          # run the notebooks again, which takes a minute for a large one

Then pytest collects of each source its entries and assumptions: an entry that is malformed or that no notebook checks
fails with a sentence. Of each notebook it collects `rules.RULES`, and with the last setting `mutation`.
"""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from bookledger.books import Books

_BOOKS = pytest.StashKey["Books"]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Offer the settings."""
    parser.addini("bookledger_sources", "ledgers as TOML files, or their folders", type="paths", default=[])
    parser.addini("bookledger_notebooks", "the notebooks that check them, or their folders", type="paths", default=[])
    parser.addini("bookledger_evidence", "the module of their evidence", default="bookledger.evidence")
    parser.addini("bookledger_mutation", "run them again with other givens and prints", type="bool", default=False)


def pytest_configure(config: pytest.Config) -> None:
    """Refuse settings that name what does not exist."""
    for setting in _PROOFS:
        if missing := [path for path in config.getini(setting) if not path.exists()]:
            raise pytest.UsageError(f"{setting} names {missing[0]}, which does not exist")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.File | None:
    """Collect the sources and notebooks that the settings name."""
    for setting, (suffix, _) in _PROOFS.items():
        if file_path.suffix == suffix and {file_path, file_path.parent} & {*parent.config.getini(setting)}:
            return Proofs.from_parent(parent, path=file_path)
    return None


class Proofs(pytest.File):
    """A source or a notebook."""

    def collect(self) -> Iterator[pytest.Item]:
        """Return an item for each entry of a source, or for each rule for a notebook."""
        (proofs,) = (proofs for suffix, proofs in _PROOFS.values() if suffix == self.path.suffix)
        for name, proof in proofs(self):
            yield Proof.from_parent(self, name=name, proof=proof)


class Proof(pytest.Item):
    """What must leave nothing to complain about."""

    def __init__(self, proof: Callable[[], list[str]], **named: Any):
        super().__init__(**named)
        self.proof = proof

    def runtest(self) -> None:
        """Fail with a sentence for each complaint."""
        if found := self.proof():
            pytest.fail("\n".join(f"{self.path.stem}, {complaint}" for complaint in found), pytrace=False)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return where it is, and what it is called."""
        return self.path, None, f"{self.path.stem}: {self.name}"


def _of_source(file):
    """The entries of a source, none of which is read yet, and its assumptions, each with what proves it."""
    from bookledger import truth
    from bookledger.errors import LedgerError
    from bookledger.source import Source

    def prove(name):
        books = _books(file.config)
        try:
            source[name]
        except LedgerError as error:
            return [str(error).removeprefix(f"{source.name}, ")]
        return [f"{name}: {complaint}" for complaint in truth.complaints(source.name, name, books)]

    def prove_assumption(name):
        return [f"assumption {name}: {complaint}" for complaint in truth.of_assumption(source, name)]

    try:
        source = Source.open(file.path)
    except LedgerError as error:
        raise file.CollectError(str(error)) from None
    entries = [(name, functools.partial(prove, name)) for name in source.tables]
    assumptions = source.language.assumptions
    return entries + [(f"assumption {name}", functools.partial(prove_assumption, name)) for name in assumptions]


def _of_notebook(file):
    """The rules for a notebook, which is not read yet, each with what proves it."""
    from bookledger.rules import RULES

    proofs = [(rule.__name__, lambda rule=rule: rule(_stored(file.path), _books(file.config))) for rule in RULES]
    if file.config.getini("bookledger_mutation"):
        proofs.append(("mutation", lambda: _mutated(file.path, file.config)))
    return proofs


def _mutated(path, config):
    """What `mutation` complains about, in a process of its own."""
    options = ["--sources", *_files(config)[0], "--notebooks", path, "--evidence", config.getini("bookledger_evidence")]
    command = [sys.executable, "-X", "utf8", "-m", "bookledger.mutation", *options]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    complaints = done.stdout or (done.stderr if done.returncode else "")
    return [line.removeprefix(f"{path.stem}, ") for line in complaints.splitlines()]


def _files(config):
    """The files of sources, and those of notebooks."""
    return [
        [file for path in config.getini(setting) for file in ([path] if path.is_file() else path.glob(f"*{suffix}"))]
        for setting, (suffix, _) in _PROOFS.items()
    ]


#: What the settings name: the suffix of the files, and what is proved of each.
_PROOFS = {"bookledger_sources": (".toml", _of_source), "bookledger_notebooks": (".ipynb", _of_notebook)}


@functools.lru_cache(maxsize=1)  # the rules look at one notebook after the other
def _stored(path):
    from bookledger.stored import Stored

    return Stored.at(path)


def _books(config) -> Books:
    """The ledger and the stored checks, read once in each process."""
    from bookledger.books import Books

    if _BOOKS not in config.stash:
        config.stash[_BOOKS] = Books.at(*_files(config), config.getini("bookledger_evidence"))
    return config.stash[_BOOKS]
