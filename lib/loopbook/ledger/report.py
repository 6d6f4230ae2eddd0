"""Verdicts, and how a reader sees them: as plain text, as HTML, and as data for the tests."""

from __future__ import annotations

import html
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy

from loopbook.ledger.compare import NUMBER, parse_formula

if TYPE_CHECKING:
    from loopbook.ledger.source import Entry, Result

#: The MIME type under which a stored notebook carries the verdicts as data.
MIME_TYPE = "application/vnd.loopbook.check+json"

_GREEK = {"alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi",
          "pi", "rho", "sigma", "tau", "phi", "chi", "psi", "omega"}  # fmt: skip


_HEAD = ("equation", "result", "book", "computed", "verdict")


@dataclass(frozen=True)
class Verdict:
    """What became of one result: the computed value as text, whether it holds, and how that was found."""

    result: Result
    computed: str
    holds: bool
    how: str

    @property
    def word(self) -> str:
        """The verdict in a word or two."""
        if not self.holds:
            return "does not hold"
        return self.result.status + (" (at random points)" if self.how == "probed" else "")

    @property
    def mark(self) -> tuple[str, str]:
        """A sign and its colour: whether it holds, and whether book and computation agree in the end."""
        if not self.holds:
            return "✗", "#b33c00"
        if not self.result.is_checked:
            return "–", "#555555"
        return ("≠", "#8a5a00") if self.result.status == "unreproduced" else ("✓", "#00664d")

    @property
    def note(self) -> str:
        """What the reader must know besides: the reason, or the assumption. Empty where there is none."""
        row = self.result
        if row.status == "reconstructed":
            return f"reconstructed{f' to within {row.within}' if row.within else ''}, assuming {row.assuming}"
        return f"{row.status}: {row.because}" if row.because else ""

    @property
    def complaint(self) -> str:
        """A sentence on what does not hold."""
        row = self.result
        start = f"{row.name} = {self.computed}"
        if row.within:
            return f"{start} is not within {row.within} of the printed {row.printed}"
        if not (row.correct or row.computed):
            return f"{start} does not agree with the printed {row.printed}"
        stored = row.correct or row.computed
        return f"{start} must agree with {stored} and not with the printed {row.printed} to be {row.status}"

    @property
    def data(self) -> dict[str, str | bool]:
        """The verdict as JSON data."""
        return {
            "name": self.result.name,
            "printed": self.result.printed,
            "status": self.result.status,
            "computed": self.computed,
            "holds": self.holds,
            "how": self.how,
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
    def notes(self) -> list[str]:
        """The notes on the verdicts, each once, with the names that it is about."""
        about = {}
        for verdict in self.verdicts:
            if verdict.note:
                about.setdefault(verdict.note, []).append(verdict.result.name)
        return [f"{', '.join(names)} {'are' if names[1:] else 'is'} {note}" for note, names in about.items()]

    @property
    def data(self) -> dict[str, Any]:
        """The verdicts as JSON data."""
        return {"source": self.entry.source, "entry": self.entry.name, "verdicts": [v.data for v in self.verdicts]}

    def __repr__(self) -> str:
        rows = []
        for verdict in self.verdicts:
            row = verdict.result
            rows.append((row.equation, row.name, f"{row.printed} {row.unit}".strip(), verdict.computed, verdict.word))
        return "\n".join(
            [_heading(self.entry), *_aligned([self._columns(_HEAD), *map(self._columns, rows)]), *self.notes]
        )

    def _columns(self, row):
        """A row of the table, without the equations where none has a number."""
        return row if any(verdict.result.equation for verdict in self.verdicts) else row[1:]

    def _repr_html_(self):
        rows = []
        for verdict in self.verdicts:
            row = verdict.result
            mark, colour = verdict.mark
            rows.append(
                (
                    _escape(f"({row.equation})") if row.equation else "",
                    _name(row.name),
                    _typeset(row.kind, row.printed, row.unit),
                    _typeset(row.kind, verdict.computed),
                    f'<span style="color: {colour}; white-space: nowrap">{mark} {_escape(verdict.word)}</span>',
                )
            )
        table = _table(self.entry, map(self._columns, rows), self._columns(_HEAD))
        return table + "".join(f"\n<p>{_escape(note)}</p>" for note in self.notes)

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME_TYPE: self.data}


def described(entry: Entry, as_html: bool = False) -> str:
    """An entry with its givens, as text or HTML."""
    if as_html:
        return _table(entry, [(_name(name), _given(given)) for name, given in entry.inputs.items()])
    rows = [(name, "=" if "=" not in given.text else ":", given.text) for name, given in entry.inputs.items()]
    return "\n".join([_heading(entry), *_aligned(rows)])


def _escape(text):
    # a dollar sign in a tag of its own opens no mathematics
    return html.escape(text, quote=False).replace("$", "<span>$</span>")


def _heading(entry):
    return f"{entry.source}, {entry.name} · {entry.title}"


def _aligned(rows):
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _table(entry, rows, head=()):
    left = 'style="text-align:left"'  # JupyterLab would centre the heads and align numbers to the right
    rows = list(rows)
    lines = [f"<p><strong>{_escape(_heading(entry))}</strong></p>"]
    if rows:
        lines.append("<table>")
        if head:
            lines.append("<thead><tr>" + "".join(f"<th {left}>{cell}</th>" for cell in head) + "</tr></thead>")
        lines += ["<tr>" + "".join(f"<td {left}>{cell}</td>" for cell in row) + "</tr>" for row in rows]
        lines.append("</table>")
    return "\n".join(lines)


def _math(expression):
    # an older MathJax breaks lines as soon as it can, unless the cell has the width that the formula needs
    room = min(16, 1 + 0.35 * len(str(expression)))
    words = {x: rf"\mathrm{{{x}}}" for x in getattr(expression, "free_symbols", ()) if _is_word(str(x))}
    latex = sympy.latex(expression, symbol_names=words, mul_symbol=r"\," if words else None)
    formula = f"$\\displaystyle {html.escape(latex, quote=False)}$"
    return f'<div style="min-width: {room:.0f}em">{formula}</div>' if room > 6 else formula


def _is_word(name):
    """Whether a symbol's name is a word, such as a unit, and no letter."""
    return len(name) > 2 and name.isalpha() and name not in _GREEK


def _name(name):
    """A name as a symbol where it is one, K or T_1 or tau, and as code where it is words."""
    letter, _, index = name.partition("_")
    is_symbol = (len(letter) == 1 or letter in _GREEK) and len(index) <= 3
    return _math(sympy.Symbol(name)) if is_symbol else f"<code>{_escape(name)}</code>"


def _given(given):
    return _escape(given.text) if isinstance(given.value, sympy.Rational) else _math(given.value)


def _typeset(kind, text, unit=""):
    if kind == "formula" and not NUMBER.fullmatch(text):
        try:
            return _math(parse_formula(text))
        except ValueError:  # what SymPy prints is not always what it reads
            return f"<code>{_escape(text)}</code>"
    return _escape(f"{text} {unit}".strip())
