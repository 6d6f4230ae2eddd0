"""A ledger of what a book prints as results, and the checker that confirms or refutes them.

A `Source` is a TOML file of entries. An entry has the inputs of an example and the results that the book prints, and is
checked with values that were computed; `bookledger.evidence` decides what the book says in words:

>>> from bookledger import EXAMPLE, Source
>>> from bookledger.evidence import less
>>> book = Source.open(EXAMPLE)
>>> wall = book["Example 2.1"]
>>> k, A, d, D = wall.given("k", "A", "d", "D")
>>> thicker = k * A * D / (2 * d)
>>> wall.check(Q=k * A * D / d, R=d / k, thicker=less(thicker, k * A * D / d, "heat flow [W]"))
Warm Walls, Example 2.1 · Heat through a brick wall: 2 computed, 1 corrected
verdict    equation  result  book          computed
computed   2.3       Q       576 W         576
corrected  2.4       R       4.17 m^2*K/W  0.4166667
computed: Through a wall of twice the thickness less heat flows.
    heat flow 288 W < 576 W
corrected: the decimal point is lost

`bookledger.pytest_plugin` proves a collection of notebooks: that each entry is checked where it belongs, that its
status is one that it may have, and that what is computed follows what is given, and not what is printed.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bookledger.errors import Disagreement as Disagreement
    from bookledger.errors import LedgerError as LedgerError
    from bookledger.source import Entry as Entry
    from bookledger.source import Source as Source

#: A small source, of a book that does not exist.
EXAMPLE = Path(__file__).with_name("example.toml")
_HOMES = {"Disagreement": "errors", "Entry": "source", "LedgerError": "errors", "Source": "source"}

__all__ = ["EXAMPLE", *_HOMES]


def __getattr__(name: str) -> object:
    """Import what is asked for only then: pytest loads the plug-in wherever this package is installed."""
    if name not in _HOMES:
        raise AttributeError(f"module 'bookledger' has no attribute {name!r}")
    return getattr(importlib.import_module(f"bookledger.{_HOMES[name]}"), name)
