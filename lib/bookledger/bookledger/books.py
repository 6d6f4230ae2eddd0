"""A ledger and the notebooks that check it, side by side: what the rules compare."""

from __future__ import annotations

import importlib
import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, Self

from bookledger.stored import checks

#: An entry as the ledger writes it.
Written = Mapping[str, Any]


@dataclass(frozen=True)
class Books:
    """The ledger as it is written, and the checks as they are stored.

    Attributes:
        written: the entries of each source by their names, read as plain TOML.
        stored: the checks of each notebook, by its name.
    """

    written: Mapping[str, Mapping[str, Written]] = field(default_factory=dict)
    stored: Mapping[str, list[dict[str, Any]]] = field(default_factory=dict)

    @classmethod
    def at(cls, sources: Iterable[Path], notebooks: Iterable[Path], evidence: str) -> Self:
        """Read files of sources and notebooks, and let the module of evidence register the words that it knows."""
        importlib.import_module(evidence)
        written = {path.stem: entries(path.read_text(encoding="utf-8")) for path in sources}
        stored = {path.stem: checks(json.loads(path.read_text(encoding="utf-8"))) for path in notebooks}
        return cls(written, stored)

    def checks_of(self, source: str, entry: str) -> list[dict[str, Any]]:
        """Return the checks of an entry."""
        every = (check for stored in self.stored.values() for check in stored)
        return [check for check in every if (check["source"], check["entry"]) == (source, entry)]


def entries(text: str) -> dict[str, Written]:
    """Return the entries of a source, without what it says about itself and for all of them."""
    tables = tomllib.loads(text)
    return {name: tables[name] for name in tables if name not in ("source", "assumption", "measure")}


def printed_numbers(entry: Written) -> set[Fraction]:
    """Return the magnitudes that an entry prints, 0 and 1 excepted.

    >>> sorted(printed_numbers({"given": {"T": "2.5 s"}, "result": [{"printed": "K*exp(-3*t)/s**4"}]}))
    [Fraction(5, 2), Fraction(3, 1)]
    """
    texts = [str(value) for value in entry.get("given", {}).values()]
    for result in entry.get("result", []):
        texts += [str(result[key]) for key in ("printed", "correct", "computed") if key in result]
    # Exponents, orders of derivatives and the numbers of examples are no data.
    data = [
        re.sub(r"(\*\*|\^)\s*[({]?-?\d+|\(\w+, \d+\)|(Example|Equation|Figure|Section) \S+", "", text) for text in texts
    ]
    found = {Fraction(n) for text in data for n in re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?:[eE][+-]?\d+)?", text)}
    return found - {0, 1}
