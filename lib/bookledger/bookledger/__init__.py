"""A ledger of what a book prints as results, and the checker that confirms or refutes them.

A `Source` is a TOML file of entries; an entry is checked with values that were computed, and claims with `evidence`.
"""

from bookledger.errors import Disagreement, LedgerError
from bookledger.source import Entry, Given, Result, Slip, Source

__all__ = ["Disagreement", "Entry", "Given", "LedgerError", "Result", "Slip", "Source"]
