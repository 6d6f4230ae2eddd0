"""What the ledger says when something is wrong: one sentence that names the entry and what was expected."""

from __future__ import annotations

from bookledger.evidence.values import in_one_line

__all__ = ["Disagreement", "LedgerError"]


class LedgerError(Exception):
    """A wrong use of the ledger, or a malformed entry: one sentence that names the entry and what was expected."""

    def __init__(self, message: str):
        super().__init__(in_one_line(message))

    def _render_traceback_(self):
        """Notebooks show the sentence alone: the place in the library's code helps no reader."""
        return [f"{type(self).__name__}: {self}"]


class Disagreement(LedgerError):  # noqa: N818 - it reads as what it is: "Disagreement: Q = 1.7 ..."
    """A computed value, or evidence, that the ledger does not confirm."""
