"""The pages that are written from the ledger: errors of the books, open questions, damage of our copies."""

from __future__ import annotations

from collections.abc import Mapping

from bookledger.errata import listed
from bookledger.source import Source
from bookledger.statuses import Corrected, Damaged, NotComputable, Unreproduced

INTRODUCTION = """\
# Errata

What the books print and a computation contradicts, with the reason, and slips of the print that change no result.
`make execute` writes this page from the ledger itself, and a test proves each line on a result: what is computed agrees
with the correction and not with the print. What did not come out, and nobody knows why, is no error of a book: it is on
[a page of its own](docs/unreproduced.md), and so is [what our copies have damaged](docs/damage.md).
"""
UNREPRODUCED = """\
# Not reproduced, and not computable

The first list has what did not come out as it is printed, though all that it takes is known, and what was tried: it
says that we did not find the reason, and not that a book is wrong. The second has results of which the text does not
print what it takes to compute them. `make execute` writes this page from the ledger, and a test proves each line of
the first list: that is what is computed, and it does not agree with the print.
"""
DAMAGE = """\
# Damage of our copies

Where the text that this collection was made from has lost a bracket, an index or a digit of the book on its way: no
error of the authors, as far as one can see. `make execute` writes this page from the ledger, and a test proves each
line on a result: what is computed agrees with what the book must have, and not with our copy. The other lines are
misreadings in the text around the results.
"""


def page(sources: Mapping[str, Source]) -> str:
    """Return the text of ERRATA.md: what is corrected, and misprints."""
    return f"{INTRODUCTION}\n{listed(sources, Corrected, 'chapters/')}"


def unreproduced(sources: Mapping[str, Source]) -> str:
    """Return the text of the page on what did not come out, and what cannot be computed."""
    tried, without_inputs = (listed(sources, status, "/chapters/") for status in (Unreproduced, NotComputable))
    tried, without_inputs = (text.replace("## ", "### ") for text in (tried, without_inputs))
    return f"{UNREPRODUCED}\n## Not reproduced\n\n{tried}\n## Not computable\n\n{without_inputs}"


def damaged(sources: Mapping[str, Source]) -> str:
    """Return the text of the page on what is damaged in our copies."""
    return f"{DAMAGE}\n{listed(sources, Damaged, '/chapters/')}"
