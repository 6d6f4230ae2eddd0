"""Verdicts, and how a reader sees them: as plain text, as HTML, and as data for the tests."""

import html
from dataclasses import dataclass

import sympy

from loopbook.ledger.compare import parse_formula

#: The MIME type under which a stored notebook carries the verdicts as data.
MIME_TYPE = "application/vnd.loopbook.check+json"


@dataclass(frozen=True)
class Verdict:
    """What became of one result: the computed value as text, whether it holds, and how that was found."""

    result: object
    computed: str
    holds: bool
    how: str

    @property
    def words(self):
        """The verdict in a few words."""
        row = self.result
        if not self.holds:
            return "does not hold"
        return {
            "reproduced": "reproduced",
            "corrected": f"corrected: {row.because}",
            "reconstructed": f"reconstructed within {row.within}, assuming {row.assuming}",
            "unreproduced": f"not reproduced: {row.because}",
            "measured": f"measured: {row.because}",
        }[row.status] + (" (at random points)" if self.how == "probed" else "")

    @property
    def complaint(self):
        """A sentence on what does not hold."""
        row = self.result
        start = f"{row.name} = {self.computed}"
        if row.status == "reconstructed":
            return f"{start} is not within {row.within} of the printed {row.printed}"
        if row.status == "reproduced":
            return f"{start} does not agree with the printed {row.printed}"
        stored = row.correct or row.computed
        return f"{start} must agree with {stored} and not with the printed {row.printed} to be {row.status}"

    @property
    def data(self):
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

    entry: object
    verdicts: tuple

    @property
    def failures(self):
        """The verdicts that do not hold."""
        return tuple(verdict for verdict in self.verdicts if not verdict.holds)

    @property
    def data(self):
        """The verdicts as JSON data."""
        return {"source": self.entry.source, "entry": self.entry.name, "verdicts": [v.data for v in self.verdicts]}

    def __repr__(self):
        rows = [("equation", "result", "book", "computed", "verdict")]
        for verdict in self.verdicts:
            row = verdict.result
            rows.append((row.equation, row.name, f"{row.printed} {row.unit}".strip(), verdict.computed, verdict.words))
        return "\n".join([_heading(self.entry), *_aligned(rows)])

    def _repr_html_(self):
        rows = []
        for verdict in self.verdicts:
            row = verdict.result
            mark, colour = ("✓", "#00664d") if verdict.holds else ("✗", "#b33c00")
            words = f'<span style="color: {colour}">{mark} {_escape(verdict.words)}</span>'
            equation = _escape(f"({row.equation})") if row.equation else ""
            printed = _typeset(row.kind, row.printed, row.unit)
            rows.append((equation, _name(row.name), printed, _typeset(row.kind, verdict.computed), words))
        head = ("equation", "result", "book", "computed", "verdict")
        return _table(_escape(_heading(self.entry)), head, rows)

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME_TYPE: self.data}


def described(entry, as_html=False):
    """An entry with its givens, as text or HTML."""
    if as_html:
        rows = [(_name(name), _given(given)) for name, given in entry.inputs.items()]
        return _table(_escape(_heading(entry)), ("given", ""), rows)
    rows = [(name, "=" if "=" not in given.text else ":", given.text) for name, given in entry.inputs.items()]
    return "\n".join([_heading(entry), *_aligned(rows)])


def _escape(text):
    return html.escape(text, quote=False)


def _heading(entry):
    return f"{entry.source}, {entry.name} · {entry.title}"


def _aligned(rows):
    if not rows:
        return []
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _table(caption, head, rows):
    style = 'style="text-align: left"'
    lines = [f'<table class="loopbook"><caption {style}>{caption}</caption>']
    lines.append("<thead><tr>" + "".join(f"<th {style}>{cell}</th>" for cell in head) + "</tr></thead><tbody>")
    lines += ["<tr>" + "".join(f"<td {style}>{cell}</td>" for cell in row) + "</tr>" for row in rows]
    return "\n".join([*lines, "</tbody></table>"])


def _math(expression):
    return f"$\\displaystyle {_escape(sympy.latex(expression))}$"


def _name(name):
    return _math(sympy.Symbol(name))


def _given(given):
    return _escape(given.text) if isinstance(given.value, sympy.Rational) else _math(given.value)


def _typeset(kind, text, unit=""):
    if kind == "formula":
        try:
            return _math(parse_formula(text))
        except ValueError:  # what SymPy prints is not always what it reads
            return f"<code>{_escape(text)}</code>"
    return _escape(f"{text} {unit}".strip())
