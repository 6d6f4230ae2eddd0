"""Notebooks as they were executed, kept as pages for whoever has to answer a complaint.

A page holds text and pictures alone: what a student's code has shown is untrusted, so it is escaped, what cannot be
seen is spelled out, pictures are looked at without being decoded, and the browser is told to run and to fetch nothing.
"""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from exercisebook import png
from exercisebook.reading import Unreadable
from exercisegrader.files import write
from exercisegrader.reports.page import escaped, page

if TYPE_CHECKING:
    from exercisegrader.events import Shown
    from exercisegrader.results import Result

_STYLE = "white-space: pre-wrap; overflow-wrap: anywhere; margin: 0; padding: 0.4rem 0.8rem; font-size: 0.9rem"
_CODE = f"{_STYLE}; background: var(--box); border-left: 0.3rem solid var(--line)"


class Kept:
    """The pages in a folder: ``{student}.html``, and the notebook without its outputs as ``{student}.ipynb``.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kept = Kept(Path(folder))
    ...     kept.keep("s1", "<!-- abc --><p>1", "{}")
    ...     kept.is_there("s1"), kept.is_there("s1", "abc"), kept.is_there("s1", "other"), kept.is_there("s2")
    (True, True, False, False)
    """

    def __init__(self, folder: Path):
        self.folder = folder

    def is_there(self, student: str, fingerprint: str = "") -> bool:
        """Whether a student has a page, and if a fingerprint is given, that of the result with this fingerprint."""
        try:
            text = (self.folder / f"{student}.html").read_text(encoding="utf-8")
        except (OSError, ValueError):
            return False
        return not fingerprint or _mark(fingerprint) in text

    def keep(self, student: str, document: str, notebook: str) -> None:
        """Store a page and the notebook. Raises GradingError where they cannot be written."""
        write(self.folder / f"{student}.ipynb", notebook)
        write(self.folder / f"{student}.html", document)


def _mark(fingerprint):
    return f"<!-- {fingerprint} -->"


def executed(result: Result, content: bytes, shown: Iterable[Shown], stopped: str = "") -> str:
    """Return the page of a notebook.

    Arguments:
        result: of the submission.
        content: the notebook as `sources.sources` returns it; empty where it was not run.
        shown: what its cells have shown.
        stopped: why it did not run to its end, in a sentence.
    """
    title = f"{result.student}: {result.file}"
    body = [_mark(result.fingerprint), f"<h1>{escaped(title)}</h1>"]
    if not result.jailed:
        body.append('<p class="warning">graded without a jail</p>')
    says = "It ran a second time to be shown here; the points are those of the first run."
    body.append(f'<p class="quiet">{says}</p>')
    of_cells: dict[int, list[Shown]] = {}
    for one in shown:
        of_cells.setdefault(one.cell, []).append(one)
    number = 0
    for cell in json.loads(content)["cells"] if content else ():
        is_code = cell["cell_type"] == "code"
        number += is_code
        label = f"cell {number}" if is_code else "text"
        body.append(f'<p class="quiet">{label}</p>')
        body.append(f'<pre style="{_CODE if is_code else _STYLE}">{_text(cell["source"])}</pre>')
        body += [_output(one) for one in of_cells.get(number, ()) if is_code]
    for says in filter(None, [result.says, stopped if stopped != result.says else ""]):
        body.append(f'<p class="warning">{escaped(says)}</p>')
    return page(title, body)


def source(content: bytes) -> str:
    """Return a notebook as it was graded, as the text of an ``.ipynb`` file; outputs are not in it."""
    notebook = json.loads(content) if content else {"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 4}
    return json.dumps(notebook, indent=1, sort_keys=True) + "\n"


def _output(shown):
    if shown.kind == "png":
        try:
            content = png.checked({"png": shown.data})
        except Unreadable as problem:
            return f'<p class="quiet">{escaped(str(problem))}</p>'
        width, height = png.size(content)
        data = base64.b64encode(content).decode()
        return f'<img src="data:image/png;base64,{data}" width="{width}" height="{height}" alt="what the cell shows">'
    return f'<pre style="{_STYLE}">{_text(shown.data)}</pre>'


def _text(text):
    """A text of several lines as HTML shows it, with all that cannot be seen, or turns the direction, spelled out."""
    lines = text.replace("\r\n", "\n")
    return html.escape(
        "".join(c if c.isprintable() or c in "\n\t" else c.encode("unicode_escape").decode() for c in lines)
    )
