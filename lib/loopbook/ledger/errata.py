"""What the ledger says as a whole: its totals by status, the books' errors as a page, and the damage of our copies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from loopbook.ledger.kinds import Claim
from loopbook.ledger.statuses import STATUSES, Corrected, Damaged, Unreproduced

if TYPE_CHECKING:
    from loopbook.ledger.source import Entry, Result, Source

INTRODUCTION = """\
# Errata

What the books print and a computation contradicts, with the reason, and slips of the print that change no result.
`make execute` writes this page from the ledger itself, and a test proves each line on a result: what is computed agrees
with the correction and not with the print.
"""
DAMAGE = """\
# Damage of our copies

Where the text that this collection was made from has lost a bracket, an index or a digit of the book on its way: no
error of the authors. `make execute` writes this page from the ledger, and a test proves each line on a result: what is
computed agrees with what the book must have, and not with our copy.
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
    """Return the text of ERRATA.md: what is corrected, what could not be reproduced, and misprints."""
    return _page(INTRODUCTION, sources, (Corrected, Unreproduced), "misprints", "chapters/")


def damaged(sources: Mapping[str, Source]) -> str:
    """Return the text of the page on what is damaged in our copies."""
    return _page(DAMAGE, sources, (Damaged,), "damage", "/chapters/")


def _page(introduction, sources, statuses, slips, folder):
    lines = [introduction]
    for source in sources.values():
        found = []
        for entry in source:
            found += [_line(entry, row, folder) for row in entry.results if type(row.status) in statuses]
            found += [f"- **{entry.name}** {slip.sentence}. {_link(entry, folder)}" for slip in getattr(entry, slips)]
        if found:
            lines += [f"## {source.citation}\n", *found, ""]
    return "\n".join(lines)


def _line(entry: Entry, row: Result, folder: str) -> str:
    place = f"{entry.name}, equation ({row.equation})" if row.equation else entry.name
    status, printed = row.status, row.printed
    if isinstance(printed, Claim):
        says = "claims" if printed.says else "denies"
        verdict = f"{says}: {printed.text}"
        right = getattr(status, "correct", "") or getattr(status, "computed", "")
        if right:
            verdict += f" {'Correct is' if isinstance(status, Corrected) else 'Found is'}: {right}"
        return f"- **{place}** {verdict} Because: {status.because}. {_link(entry, folder)}"
    if isinstance(status, Corrected):
        verdict = f"prints `{printed.text}`, correct is `{status.correct}`"
    elif not status.computed:
        verdict = f"prints `{printed.text}`, which cannot be computed"
    else:
        verdict = f"prints `{printed.text}`, computed is `{status.computed}`, unexplained so far"
    return f"- **{place}**, {row.title}: {verdict}: {status.because}. {_link(entry, folder)}"


def _link(entry, folder):
    return f"([{entry.chapter}]({folder}{entry.chapter}.ipynb))"
