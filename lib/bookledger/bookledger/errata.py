"""What the ledger says as a whole: its totals by status, and three pages: errors, open questions, damaged copies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from bookledger.kinds import Claim
from bookledger.statuses import STATUSES, Corrected, Damaged, Unreproduced

if TYPE_CHECKING:
    from bookledger.source import Entry, Result, Source

INTRODUCTION = """\
# Errata

What the books print and a computation contradicts, with the reason, and slips of the print that change no result.
`make execute` writes this page from the ledger itself, and a test proves each line on a result: what is computed agrees
with the correction and not with the print. What did not come out, and nobody knows why, is no error of a book: it is on
[a page of its own](docs/unreproduced.md), and so is [what our copies have damaged](docs/damage.md).
"""
UNREPRODUCED = """\
# Not reproduced

What did not come out as it is printed, though all that it takes is known, and what cannot be computed because the book
does not print what it takes. Nothing here says that a book is wrong. `make execute` writes this page from the ledger,
and a test proves each line that has a number or evidence: that is what is computed, and it does not agree with the
print.
"""
DAMAGE = """\
# Damage of our copies

Where the text that this collection was made from has lost a bracket, an index or a digit of the book on its way: no
error of the authors, as far as one can see. `make execute` writes this page from the ledger, and a test proves each
line on a result: what is computed agrees with what the book must have, and not with our copy. The other lines are
misreadings in the text around the results.
"""


def totals(sources: Mapping[str, Source]) -> dict[str, dict[str, int]]:
    """Count the results of each source by status: {source name: {status: number}}.

    >>> from loopbook.ledger import sources
    >>> list(totals(sources())["haugen"])[:4]
    ['computed', 'quoted', 'observed', 'reconstructed']
    """
    return {
        name: {word: sum(row.status.word == word for entry in source for row in entry.results) for word in STATUSES}
        for name, source in sources.items()
    }


def page(sources: Mapping[str, Source]) -> str:
    """Return the text of ERRATA.md: what is corrected, and misprints."""
    return _page(INTRODUCTION, sources, Corrected, "misprints", "chapters/")


def unreproduced(sources: Mapping[str, Source]) -> str:
    """Return the text of the page on what did not come out."""
    return _page(UNREPRODUCED, sources, Unreproduced, "", "/chapters/")


def damaged(sources: Mapping[str, Source]) -> str:
    """Return the text of the page on what is damaged in our copies."""
    return _page(DAMAGE, sources, Damaged, "damage", "/chapters/")


def _page(introduction, sources, status, slips, folder):
    lines = [introduction]
    for source in sources.values():
        found = []
        for entry in source:
            found += [_line(entry, row, folder) for row in entry.results if type(row.status) is status]
            found += [
                f"- **{entry.name}** {slip.sentence}. {_link(entry, folder)}"
                for slip in getattr(entry, slips or "", ())
            ]
        if found:
            lines += [f"## {source.citation}\n", *found, ""]
    return "\n".join(lines)


def _line(entry: Entry, row: Result, folder: str) -> str:
    place = f"{entry.name}, equation ({row.equation})" if row.equation else entry.name
    status, printed = row.status, row.printed
    right = status.found
    if isinstance(printed, Claim):
        says = "claims" if printed.says else "denies"
        found = {Unreproduced: "We found: "}.get(type(status), "It should read: ") + right if right else ""
        return f"- **{place}** {says}: {printed.text} {found} Reason: {status.because}. {_link(entry, folder)}"
    verb = "reads" if isinstance(status, Damaged) else "prints"
    if isinstance(status, Corrected):
        verdict = f"{verb} `{printed.text}`, correct is `{right}`"
    elif not right:
        verdict = f"prints `{printed.text}`, which cannot be computed"
    else:
        verdict = f"prints `{printed.text}`, computed is `{right}`"
    return f"- **{place}**, {row.title}: {verdict}: {status.because}. {_link(entry, folder)}"


def _link(entry, folder):
    return f"([{entry.chapter}]({folder}{entry.chapter}.ipynb))"
