"""Verdicts, and how a reader sees them: as plain text, as HTML, and as data for whatever shows them otherwise."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy

from bookledger.evidence.comparisons import without_gaps
from bookledger.kinds import Claim, Formula
from plainmath.tables import aligned, marked, symbol, typeset

if TYPE_CHECKING:
    from bookledger.source import Entry, Result

#: The MIME type under which a stored notebook carries the verdicts as data.
MIME_TYPE = "application/vnd.loopbook.check+json"

_HEAD = ("verdict", "equation", "result", "book", "computed")
_CLAIMS = ("verdict", "equation", "claim", "", "evidence")
_FAILS = ("✗", "fails")
_LEFT = 'style="text-align:left"'  # JupyterLab would centre the heads and align numbers to the right


@dataclass(frozen=True)
class Verdict:
    """What became of one result.

    Attributes:
        result: of the ledger.
        computed: the value, or the evidence, as text.
        how: how it was found to hold; empty where it does not hold.
        value: the number, formula or name, or the evidence; None where nothing can be computed.
    """

    result: Result
    computed: str
    how: str
    value: Any = None

    @property
    def holds(self) -> bool:
        """Whether the computation bears the status out."""
        return bool(self.how)

    @property
    def near(self) -> bool:
        """Whether the evidence hangs on the limit of a criterion, or on a few percent."""
        return self.is_claim and self.value is not None and self.value.near

    @property
    def is_claim(self) -> bool:
        """Whether the result is a sentence."""
        return isinstance(self.result.printed, Claim)

    @property
    def word(self) -> str:
        """The verdict in a word or two."""
        if not self.holds:
            return "does not hold"
        more = [text for text, so in (("at random points", self.how == "probed"), ("a near thing", self.near)) if so]
        return self.result.status.word + (f" ({', '.join(more)})" if more else "")

    @property
    def mark(self) -> tuple[str, str]:
        """A sign, and the class under which a page shows it."""
        return self.result.status.mark if self.holds else _FAILS

    @property
    def complaint(self) -> str:
        """A sentence on what does not hold."""
        what = f"the evidence ({self.computed})" if self.is_claim else f"= {self.computed}"
        return f"{self.result.name} {what} {self.result.status.complaint(self.result.printed)}"

    @property
    def book(self) -> str:
        """What the book prints, as text: of a claim what it says of the sentence."""
        printed = self.result.printed
        if isinstance(printed, Claim):
            return "says so" if printed.says else "denies it"
        return f"{printed.text} {self.result.unit}".strip()

    @property
    def data(self) -> dict[str, Any]:
        """The verdict as JSON data; `tex` has the texts that hold formulas again, those between dollar signs.

        What is empty is left out.
        """
        result, printed = self.result, self.result.printed
        typeset_texts = {"computed": printed.latex(self.computed)}
        if self.is_claim:
            typeset_texts["computed"] = self.value.told(typeset) if self.value is not None else ""
        else:
            typeset_texts["title"] = "" if result.label else symbol(result.name)
            typeset_texts["book"] = f"{printed.latex(printed.text)} {result.unit}".strip()
        plain = {"title": printed.text if self.is_claim else result.title, "book": self.book, "computed": self.computed}
        return {
            "name": result.name,
            "kind": printed.kind,
            **plain,
            "status": result.status.word,
            "word": self.word,
            "holds": self.holds,
            "how": self.how,
            **without_gaps(
                {
                    "equation": result.equation,
                    "tex": {key: text for key, text in typeset_texts.items() if text and text != plain[key]},
                    "evidence": self.value.data if self.is_claim and self.value is not None else None,
                }
            ),
        }


@dataclass(frozen=True)
class Report:
    """The verdicts on one entry of the ledger."""

    entry: Entry
    verdicts: tuple[Verdict, ...]

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
        told += [f"misprint: the book {slip.sentence}" for slip in self.entry.misprints]
        return told + [f"damaged: our copy {slip.sentence}" for slip in self.entry.damage]

    @property
    def data(self) -> dict[str, Any]:
        """The verdicts as JSON data."""
        return {
            "source": self.entry.source,
            "entry": self.entry.name,
            "heading": heading(self.entry),
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
        return "\n".join([f"{heading(self.entry)}: {self.counts}", *lines, *self.notes])

    def _without_equations(self, rows, column):
        """Rows without the column of equations where none has a number."""
        if any(verdict.result.equation for verdict in self.verdicts):
            return rows
        return [row[:column] + row[column + 1 :] for row in rows]

    def _repr_html_(self):
        rows = [self._cells(verdict.data, verdict.mark[0]) for verdict in self.verdicts]
        names = _CLAIMS if all(verdict.is_claim for verdict in self.verdicts) else _HEAD
        head = "".join(f"<th {_LEFT}>{name}</th>" for name in self._without_equations([names], 1)[0])
        lines = [f'<tr class="{v.mark[1]}">{row}</tr>' for v, row in zip(self.verdicts, rows, strict=True)]
        sign = _FAILS[0] if self.failures else "✓"
        opened = " open" if self.failures else ""
        return "\n".join(
            [
                f'<details class="loopbook-check"{opened}>',
                f"<summary>{sign} <strong>{marked(heading(self.entry))}</strong>: {self.counts}</summary>",
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
        cells = [f'<td {_LEFT} class="verdict">{sign}&nbsp;{marked(data["word"])}</td>', f"<td {_LEFT}>{equation}</td>"]
        if data["kind"] == Claim.kind:
            cells.append(f'<td {_LEFT} colspan="2">{title}{"" if book == "says so" else f" ({book})"}</td>')
        else:
            cells += [f"<td {_LEFT}>{title}</td>", f"<td {_LEFT}>{book}</td>"]
        computed = "the same" if data["kind"] == Formula.kind and computed == book else computed
        return "".join(self._without_equations([[*cells, f"<td {_LEFT}>{computed}</td>"]], 1)[0])

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME_TYPE: self.data}


def _named(results):
    """A few results by their titles, more of them, or claims, by their number."""
    if len(results) > 3 or any(isinstance(result.printed, Claim) for result in results):
        kind = "claim" if all(isinstance(result.printed, Claim) for result in results) else "result"
        return f"{len(results)} {kind}s" if results[1:] else f"one {kind}"
    return ", ".join(result.title for result in results)


def described(entry: Entry, as_html: bool = False) -> str:
    """An entry with its givens, as text or HTML."""
    if not as_html:
        rows = [(name, "=" if "=" not in given.text else ":", given.text) for name, given in entry.inputs.items()]
        return "\n".join([heading(entry), *aligned(rows)])
    lines = [f"<p><strong>{marked(heading(entry))}</strong></p>"]
    if entry.inputs:
        cells = [(marked(symbol(name)), marked(_given(given))) for name, given in entry.inputs.items()]
        rows = [f"<tr><td {_LEFT}>{name}</td><td {_LEFT}>{given}</td></tr>" for name, given in cells]
        lines += ["<table>", *rows, "</table>"]
    return "\n".join(lines)


def heading(entry: Entry) -> str:
    """The short title of the book, the name of the entry and its title."""
    return f"{entry.book or entry.source}, {entry.name} · {entry.title}"


def _given(given):
    return given.text if isinstance(given.value, sympy.Rational) else typeset(given.value)
