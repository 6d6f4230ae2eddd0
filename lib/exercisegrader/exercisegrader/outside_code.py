"""Answers in cells that are not run: a key of Jupyter turns a code cell into one of text, and nothing else tells."""

from __future__ import annotations

import json
import re

#: A call of the sheet at the beginning of a line: the exercise, and what is given until the first bracket that closes.
_CALL = re.compile(r"""(?m)^[ \t]*sheet[ \t]*\.[ \t]*answer[ \t]*\(\s*["']?([^"',()\s]{1,40})["']?\s*,([^)]{0,2000})""")
#: What stands in the place of an answer before there is one.
_PLACE = re.compile(r"=\s*(?:\.\.\.|None)\s*$")


def answered(content: bytes) -> tuple[str, ...]:
    """Return the exercises that are answered in cells that are no code cells, without repetition.

    What a call begins with counts, wherever it ends: such a cell need not be code.

    Arguments:
        content: a notebook as `sources.sources` returns it; empty where there is none.

    >>> cells = [{"cell_type": "markdown", "source": "sheet.answer('3', K=2)"}]
    >>> answered(json.dumps({"cells": cells}).encode())
    ('3',)
    """
    cells = json.loads(content)["cells"] if content else []
    found = [
        call[1]
        for cell in cells
        if cell["cell_type"] != "code"
        for call in _CALL.finditer(cell["source"])
        if any("=" in part and not _PLACE.search(part) for part in call[2].split(","))
    ]
    return tuple(dict.fromkeys(found))
