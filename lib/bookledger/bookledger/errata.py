"""What ledgers say as a whole: totals by status, and lists of what was corrected, not reproduced, or damaged."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from bookledger.kinds import Claim
from bookledger.statuses import STATUSES, Corrected, Damaged, NotComputable, Status, Unreproduced

if TYPE_CHECKING:
    from bookledger.results import Result
    from bookledger.source import Entry, Source

#: The slips of the print that are listed with a status, by their name in an entry.
_SLIPS = {Corrected: "misprints", Damaged: "damage"}


def totals(sources: Mapping[str, Source]) -> dict[str, dict[str, int]]:
    """Count the results of each source by status: {source name: {status: number}}.

    >>> from bookledger import EXAMPLE, Source
    >>> {word: count for word, count in totals({"walls": Source.open(EXAMPLE)})["walls"].items() if count}
    {'computed': 2, 'corrected': 1, 'measured': 2}
    """
    return {
        name: {word: sum(row.status.word == word for entry in source for row in entry.results) for word in STATUSES}
        for name, source in sources.items()
    }


def listed(sources: Mapping[str, Source], status: type[Status], folder: str) -> str:
    """Return what has a status, and the slips of that kind, as a list in Markdown under each source's citation.

    Arguments:
        sources: by name.
        status: `Corrected`, `Unreproduced`, `NotComputable` or `Damaged`.
        folder: the address of the notebooks' folder, with a slash at its end.

    >>> from bookledger import EXAMPLE, Source
    >>> print(listed({"walls": Source.open(EXAMPLE)}, Corrected, "notebooks/"))
    ## A. N. Author, Warm Walls: an invented textbook on heat, 1st edition
    <BLANKLINE>
    - **Example 2.1, equation (2.4)**, R: prints `4.17`, correct is `0.417`: the decimal point is lost. ([02_conduction](notebooks/02_conduction.ipynb))
    <BLANKLINE>
    """  # noqa: E501
    lines = []
    for source in sources.values():
        found = []
        for entry in source:
            found += [_line(entry, row, folder) for row in entry.results if type(row.status) is status]
            found += [
                f"- **{entry.name}** {slip.sentence}. {_link(entry, folder)}"
                for slip in getattr(entry, _SLIPS.get(status, ""), ())
            ]
        if found:
            lines += [f"## {source.citation}\n", *found, ""]
    return "\n".join(lines)


def _line(entry: Entry, row: Result, folder: str) -> str:
    place = f"{entry.name}, equation ({row.equation})" if row.equation else entry.name
    status, printed = row.status, row.printed
    reason, link = f"{status.because}{_tried(status)}", _link(entry, folder)
    if isinstance(printed, Claim):
        says = "claims" if printed.says else "denies"
        found = {Unreproduced: "We found: ", NotComputable: ""}.get(type(status), "It should read: ")
        right = "" if isinstance(status, NotComputable) else status.found
        return f"- **{place}** {says}: {printed.text} {found}{right} Reason: {reason}. {link}".replace("  ", " ")
    if isinstance(status, NotComputable):
        return f"- **{place}**, {row.title}, `{printed.text}`: {reason}. {link}"
    verb = "reads" if isinstance(status, Damaged) else "prints"
    right = f"correct is `{status.found}`" if isinstance(status, Corrected) else f"computed is `{status.found}`"
    return f"- **{place}**, {row.title}: {verb} `{printed.text}`, {right}: {reason}. {link}"


def _tried(status):
    return f"; tried: {status.tried}" if isinstance(status, Unreproduced) else ""


def _link(entry, folder):
    return f"([{entry.chapter}]({folder}{entry.chapter}.ipynb))"
