"""The ledger: every number and formula that the books print as a result, and the checker that confirms them.

Each source is a TOML file beside this one, and is imported by its name:

>>> from loopbook.ledger import haugen
>>> example = haugen["Example 5.2"]
>>> example.given("H")
3/(s + 1/2)
>>> example.check(model_of="Example 5.1", H_s=6, y_s=12)  # doctest: +ELLIPSIS
haugen, Example 5.2 · Static transfer function and static response
equation  result    book         computed     verdict
          model_of  Example ???  Example 5.1  corrected: the cross-reference was lost in the book; the transfer ...
5.26      H_s       6            6            reproduced
5.27      y_s       12           12           reproduced
"""

import importlib.resources

from loopbook.ledger.compare import Disagreement, LedgerError
from loopbook.ledger.source import Entry, Given, Result, Source

__all__ = ["Disagreement", "Entry", "Given", "LedgerError", "Result", "Source", "sources"]


def sources():
    """Return all sources of the ledger, by name.

    >>> "haugen" in sources()
    True
    """
    names = sorted(file.name for file in importlib.resources.files(__name__).iterdir() if file.name.endswith(".toml"))
    return {name.removesuffix(".toml"): _load(name.removesuffix(".toml")) for name in names}


def _load(name):
    if name not in globals():
        file = importlib.resources.files(__name__).joinpath(f"{name}.toml")
        if not file.is_file():
            raise AttributeError(f"the ledger has no source {name!r}: expected one of {', '.join(sources())}")
        globals()[name] = Source.read(name, file.read_text(encoding="utf-8"))
    return globals()[name]


def __getattr__(name):
    if name.startswith("_"):
        raise AttributeError(name)
    return _load(name)
