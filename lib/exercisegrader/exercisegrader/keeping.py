"""Notebooks as they were executed, kept as pages for whoever has to answer a complaint.

A page holds text and pictures alone: what a student's code has shown is untrusted, so it is escaped, what cannot be
seen is spelled out, pictures are looked at without being decoded, and the browser is told to run and to fetch nothing.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from markupsafe import Markup

from exercisebook import png
from exercisebook.grammar import Unreadable
from exercisegrader.files import write
from exercisegrader.reports.pages import line, page, picture, several_lines

if TYPE_CHECKING:
    from exercisegrader.events import Shown
    from exercisegrader.results import Result


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
            return f"<!-- {fingerprint}" in (self.folder / f"{student}.html").read_text(encoding="utf-8")
        except (OSError, ValueError):
            return False

    def keep(self, student: str, document: str, notebook: str) -> None:
        """Store a page and the notebook. Raises GradingError where they cannot be written."""
        write(self.folder / f"{student}.ipynb", notebook)
        write(self.folder / f"{student}.html", document)


def executed(result: Result, content: bytes, shown: Iterable[Shown], stopped: str = "") -> str:
    """Return the page of a notebook.

    Arguments:
        result: of the submission.
        content: the notebook as `sources.sources` returns it; empty where it was not run.
        shown: what its cells have shown.
        stopped: why it did not run to its end, in a sentence.
    """
    outputs = defaultdict(list)
    for one in shown:
        outputs[one.cell].append(_output(one))
    cells = json.loads(content)["cells"] if content else []
    problems = dict.fromkeys(filter(None, [result.says, stopped]))
    told = {"result": result, "cells": cells, "outputs": outputs, "problems": problems}
    return page("executed.html", f"{result.student}: {result.file}", **told)


def source(content: bytes) -> str:
    """Return a notebook as it was graded, as the text of an ``.ipynb`` file; outputs are not in it."""
    notebook = json.loads(content) if content else {"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 4}
    return json.dumps(notebook, indent=1, sort_keys=True) + "\n"


def _output(shown):
    if shown.kind != "png":
        return Markup("<pre>{}</pre>").format(several_lines(shown.data))
    try:
        return picture(png.checked({"png": shown.data}), "what the cell shows")
    except Unreadable as problem:
        return Markup('<p class="quiet">{}</p>').format(line(str(problem)))
