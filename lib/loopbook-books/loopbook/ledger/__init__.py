"""The ledger: every number, formula and claim that the books print as a result, and the checker that confirms them.

Each source is a TOML file beside this one, and is imported by its name:

>>> from loopbook.ledger import haugen
>>> example = haugen["Equation 6.14"]
>>> example.given("H")
3/(4*s + 2)
>>> example.check(K=1.5, T=2)
Haugen, Equation 6.14 · Gain and time constant of a numerical example: 2 computed
verdict   equation  result  book  computed
computed  6.14      K       1.5   3/2
computed  6.14      T       2     2
"""

from __future__ import annotations

import functools
from pathlib import Path

from bookledger.errors import Disagreement, LedgerError
from bookledger.results import Result
from bookledger.source import Entry, Given, Slip, Source
from plainmath.validation import did_you_mean

__all__ = ["Disagreement", "Entry", "Given", "LedgerError", "Result", "Slip", "Source", "sources"]

_FOLDER = Path(__file__).parent


def sources() -> dict[str, Source]:
    """Return all sources of the ledger, by name.

    >>> "haugen" in sources()
    True
    """
    return {name: _load(name) for name in _names()}


def _names():
    return sorted(path.stem for path in _FOLDER.glob("*.toml"))


@functools.cache
def _load(name):
    path = _FOLDER / f"{name}.toml"
    if not path.is_file():
        raise AttributeError(f"the ledger has no source {name!r}: {did_you_mean(name, _names())}")
    return Source.open(path)


def __getattr__(name: str) -> Source:
    if name.startswith("_"):
        raise AttributeError(name)
    return _load(name)
