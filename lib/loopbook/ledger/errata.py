"""What the ledger says as a whole: its totals by status, and the books' errors as a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from loopbook.ledger.source import STATUSES

if TYPE_CHECKING:
    from loopbook.ledger.source import Source

INTRODUCTION = """\
# Errata

What the books print and a computation contradicts, or a reference that is lost, with the reason. `make execute` writes
this page from the ledger itself, and a test proves each line: what is computed agrees with the correction and not with
the print.
"""


def totals(sources: Mapping[str, Source]) -> dict[str, dict[str, int]]:
    """Count the results of each source by status: {source name: {status: number}}.

    >>> from loopbook.ledger import sources
    >>> list(totals(sources())["haugen"])
    ['reproduced', 'corrected', 'reconstructed', 'unreproduced', 'measured']
    """
    return {
        name: {status: sum(row.status == status for entry in source for row in entry.results) for status in STATUSES}
        for name, source in sources.items()
    }


def page(sources: Mapping[str, Source]) -> str:
    """Return the text of ERRATA.md: what is corrected, and what could not be reproduced, source by source."""
    lines = [INTRODUCTION]
    for source in sources.values():
        rows = [(entry, row) for entry in source for row in entry.results]
        if found := [_line(*pair) for pair in rows if pair[1].status in ("corrected", "unreproduced")]:
            lines += [f"## {source.citation}\n", *found, ""]
    return "\n".join(lines)


def _line(entry, row):
    place = f"{entry.name}, equation ({row.equation})" if row.equation else entry.name
    link = f"[{entry.chapter}](chapters/{entry.chapter}.ipynb)"
    if row.status == "corrected":
        verdict = f"prints `{row.printed}`, correct is `{row.correct}`"
    elif not row.computed:
        verdict = f"prints `{row.printed}`, which cannot be computed"
    else:
        verdict = f"prints `{row.printed}`, computed is `{row.computed}`, unexplained so far"
    return f"- **{place}**, `{row.name}`: {verdict}: {row.because}. ({link})"
