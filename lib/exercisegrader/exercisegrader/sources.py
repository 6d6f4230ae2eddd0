"""What counts of a notebook: its sources, in one form. Outputs, attachments and the state of widgets are thrown away,
so that running a notebook again changes nothing here.

A file has a limit on its size, and another one on the number of brackets in it: a picture takes as much in memory as
in the file, an empty list thirty times as much.
"""

from __future__ import annotations

import json
import re
from typing import BinaryIO

from exercisebook.judging import harmless
from exercisegrader import GradingError
from exercisegrader.imprint import Imprint

#: The largest file (bytes); most of a notebook is pictures.
LARGEST = 50 * 2**20
#: The most lists and dictionaries in it, brackets in texts included.
MOST_BRACKETS = 4_000_000
TOO_LARGE = f"the file is larger than {LARGEST // 2**20} MiB: expected one without its outputs"
#: The most bytes of what is left of it.
MOST = 10 * 2**20

#: A call of the sheet, also in a comment: the exercise, and what is given until the first bracket that closes.
_CALL = re.compile(r"""\bsheet[ \t]*\.[ \t]*answer[ \t]*\(\s*["']?([^"',()\s]{1,40})["']?\s*,([^)]{0,2000})""")
_NAMED = re.compile(r"[\s#]*(\w+)\s*=(?!=)")
#: What stands in the place of an answer before there is one.
_PLACE = re.compile(r"(?:^|=)\s*(?:\.\.\.|None)\s*$")


def sources(stream: BinaryIO) -> bytes:
    """Return a notebook without its outputs, in one form: nbformat 4, cells with their type and source, and the
    `Imprint` of its release.

    Arguments:
        stream: the file. It may be UTF-8, UTF-16 or UTF-32, with or without a byte order mark.
    Returns:
        JSON, as bytes.
    Raises:
        GradingError: for what is not a notebook, has too much in it, or is one of another language.

    >>> import io
    >>> notebook = {"nbformat": 4, "metadata": {}, "cells": [{"cell_type": "code", "source": ["1 + ", "1"],
    ...     "outputs": [{"data": {"text/plain": "2"}}]}]}
    >>> json.loads(sources(io.BytesIO(json.dumps(notebook).encode("utf-16"))))["cells"]
    [{'cell_type': 'code', 'execution_count': None, 'metadata': {}, 'outputs': [], 'source': '1 + 1'}]
    """
    try:
        notebook = _read(stream)
        metadata = notebook.get("metadata", {})
        _demand(isinstance(metadata, dict), "its metadata are no dictionary")
        kept = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
        if imprint := Imprint.of(metadata):
            kept["loopbook"] = imprint.as_metadata()
        bare = {"cells": _cells(notebook), "metadata": kept, "nbformat": 4, "nbformat_minor": 4}
        content = json.dumps(bare, sort_keys=True).encode()
        _demand(len(content) <= MOST, f"it has more than {MOST // 2**20} MiB without its outputs")
    except (ValueError, RecursionError, MemoryError) as problem:
        says = str(problem) if isinstance(problem, ValueError) else "it has too many brackets one in another"
        raise GradingError(f"the file is not a notebook that can be read: {harmless(says)}") from None
    places = (("kernelspec", "language"), ("language_info", "name"))
    said = [part.get(name) for place, name in places if isinstance(part := metadata.get(place), dict)]
    language = next((one for one in said if one and isinstance(one, str)), "python")
    if language != "python":
        raise GradingError(f"the notebook is written in {harmless(language)}: expected Python")
    return content


def _read(stream):
    """The dictionary in a file. Raises ValueError, and RecursionError."""
    content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise GradingError(TOO_LARGE)
    _demand(content.strip(), "it is empty")
    brackets = content.count(b"[") + content.count(b"{")
    _demand(brackets <= MOST_BRACKETS, f"it has more than {MOST_BRACKETS} brackets")
    try:
        notebook = json.loads(content)
    except UnicodeDecodeError as problem:
        raise ValueError(f"it is no text in {problem.encoding.upper()}") from None
    _demand(isinstance(notebook, dict), "it is no dictionary")
    return notebook


def _cells(notebook):
    """The cells of a notebook in the one form. Raises ValueError."""
    form, cells = notebook.get("nbformat"), notebook.get("cells")
    _demand(isinstance(form, int), "it has no number nbformat")
    _demand(form >= 4, "it is of before 2015: open and save it in Jupyter")
    _demand(isinstance(cells, list), "it has no list of cells")
    return [_cell(cell) for cell in cells]


def _cell(cell):
    _demand(isinstance(cell, dict) and "cell_type" in cell, "it has a cell without a type")
    kind, source = cell["cell_type"] if cell["cell_type"] in ("code", "raw") else "markdown", cell.get("source")
    if isinstance(source, list) and all(isinstance(line, str) for line in source):
        source = "".join(source)
    if kind == "code":
        _demand(isinstance(source, str), "it has a code cell without a source")
        return {"cell_type": kind, "execution_count": None, "metadata": {}, "outputs": [], "source": source}
    return {"cell_type": kind, "metadata": {}, "source": source if isinstance(source, str) else ""}


def _demand(holds, otherwise):
    if not holds:
        raise ValueError(otherwise)


def answered(content: bytes) -> dict[str, set[str]]:
    """Return what the text of a notebook answers, run or not: {exercise: names}; "" is an answer without a name.

    A key of Jupyter turns a code cell into one of text, and nothing else tells; other calls stand in a comment, in a
    function that nobody calls, or below ``%%script``. What a call begins with counts, wherever it ends: it need not be
    code.

    Arguments:
        content: a notebook as `sources` returns it; empty where there is none.

    >>> cells = [{"cell_type": "markdown", "source": "sheet.answer('3', K=2, T=...)"}]
    >>> answered(json.dumps({"cells": cells}).encode())
    {'3': {'K'}}
    """
    found: dict[str, set[str]] = {}
    for cell in json.loads(content)["cells"] if content else []:
        for call in _CALL.finditer(cell["source"]):
            for place, part in enumerate(call[2].split(",")):
                named = _NAMED.match(part)
                is_alone = place == 0 and part.strip() and not part.lstrip().startswith("**")  # others come later
                if (named or is_alone) and not _PLACE.search(part):
                    found.setdefault(call[1], set()).add(named[1] if named else "")
    return found
