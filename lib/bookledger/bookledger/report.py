"""How a reader sees verdicts: as plain text, as HTML, and as data for whatever shows them otherwise."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from bookledger.kinds import Claim, Formula
from bookledger.results import FAILS, Result, Verdict
from plainmath.tables import aligned, marked

#: The MIME type under which a stored notebook carries the verdicts as data; it has the name of the first collection.
MIME_TYPE = "application/vnd.loopbook.check+json"

_HEAD = ("verdict", "equation", "result", "book", "computed")
_CLAIMS = ("verdict", "equation", "claim", "", "evidence")
LEFT = 'style="text-align:left"'  # JupyterLab would centre the heads and align numbers to the right


@dataclass(frozen=True)
class Report:
    """The verdicts on one entry of the ledger.

    Attributes:
        source, name: of the entry.
        heading: the entry as a reader calls it.
        verdicts: on its results, in their order.
        slips: those of its print, a sentence for each.
    """

    source: str
    name: str
    heading: str
    verdicts: tuple[Verdict, ...]
    slips: tuple[str, ...] = ()

    @property
    def failures(self) -> tuple[Verdict, ...]:
        """The verdicts that do not hold."""
        return tuple(verdict for verdict in self.verdicts if not verdict.holds)

    @property
    def counts(self) -> str:
        """How many results have which verdict, as in "7 computed, 2 corrected"."""
        words = Counter(v.result.status.word if v.holds else "not confirmed" for v in self.verdicts)
        return ", ".join(f"{count} {word}" for word, count in words.items())

    @property
    def notes(self) -> list[str]:
        """The notes on the verdicts, each once, with the results that it is about, and the slips of the entry."""
        about: dict[str, list[Result]] = {}
        for verdict in self.verdicts:
            if note := verdict.result.status.note:
                about.setdefault(note, []).append(verdict.result)
        alike = Counter(verdict.result.status.word for verdict in self.verdicts)
        told = [
            note if len(results) == alike[results[0].status.word] else f"{_named(results)}: {note}"
            for note, results in about.items()
        ]
        return [*told, *self.slips]

    @property
    def data(self) -> dict[str, Any]:
        """The verdicts as JSON data."""
        return {
            "source": self.source,
            "entry": self.name,
            "heading": self.heading,
            "counts": self.counts,
            "verdicts": [verdict.data for verdict in self.verdicts],
            "notes": self.notes,
        }

    def __repr__(self) -> str:
        values = [verdict for verdict in self.verdicts if not verdict.is_claim]
        rows = [(v.word, v.result.equation, v.result.title, v.book, v.computed) for v in values]
        lines = aligned(self._without_equations([_HEAD, *rows], 1)) if rows else []
        for verdict in self.verdicts:
            if verdict.is_claim:
                denied = "" if verdict.result.printed.says else " (The book denies it.)"
                lines += [f"{verdict.word}: {verdict.result.printed.text}{denied}", f"    {verdict.computed}"]
        return "\n".join([f"{self.heading}: {self.counts}", *lines, *self.notes])

    def _without_equations(self, rows, column):
        """Rows without the column of equations where none has a number."""
        if any(verdict.result.equation for verdict in self.verdicts):
            return rows
        return [row[:column] + row[column + 1 :] for row in rows]

    def _repr_html_(self):
        rows = [self._cells(verdict.data, verdict.mark[0]) for verdict in self.verdicts]
        names = _CLAIMS if all(verdict.is_claim for verdict in self.verdicts) else _HEAD
        head = "".join(f"<th {LEFT}>{name}</th>" for name in self._without_equations([names], 1)[0])
        lines = [f'<tr class="{v.mark[1]}">{row}</tr>' for v, row in zip(self.verdicts, rows, strict=True)]
        sign = FAILS[0] if self.failures else "✓"
        opened = " open" if self.failures else ""
        return "\n".join(
            [
                f'<details class="loopbook-check"{opened}>',
                f"<summary>{sign} <strong>{marked(self.heading)}</strong>: {self.counts}</summary>",
                f"<table><thead><tr>{head}</tr></thead>",
                *lines,
                "</table>",
                *(f"<p>{marked(note)}</p>" for note in self.notes),
                "</details>",
            ]
        )

    def _cells(self, data, sign):
        title, book, computed = (
            marked(data.get("tex", {}).get(key, data[key])) for key in ("title", "book", "computed")
        )
        equation = marked(f"({data['equation']})") if "equation" in data else ""
        cells = [f'<td {LEFT} class="verdict">{sign}&nbsp;{marked(data["word"])}</td>', f"<td {LEFT}>{equation}</td>"]
        if data["kind"] == Claim.kind:
            cells.append(f'<td {LEFT} colspan="2">{title}{"" if book == "says so" else f" ({book})"}</td>')
        else:
            cells += [f"<td {LEFT}>{title}</td>", f"<td {LEFT}>{book}</td>"]
        computed = "the same" if data["kind"] == Formula.kind and computed == book else computed
        return "".join(self._without_equations([[*cells, f"<td {LEFT}>{computed}</td>"]], 1)[0])

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME_TYPE: self.data}


def _named(results):
    """A few results by their titles, more of them, or claims, by their number."""
    if len(results) > 3 or any(isinstance(result.printed, Claim) for result in results):
        kind = "claim" if all(isinstance(result.printed, Claim) for result in results) else "result"
        return f"{len(results)} {kind}s" if results[1:] else f"one {kind}"
    return ", ".join(result.title for result in results)
