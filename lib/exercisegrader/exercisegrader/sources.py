"""What counts of a notebook, its sources, read from a file of any usual size in little memory.

Outputs, attachments and the state of widgets are skipped while they are read, so that a notebook may be full of
pictures, and running it again changes nothing here. What is left is JSON of one form.

The reader is our own because those of others hold what it skips: `json.loads` all of it, ijson the longest text,
which is the largest picture; and ijson refuses NaN, which Jupyter writes into outputs. It takes what `json.loads`
takes, with fewer brackets one in another and an end to everything.
"""

from __future__ import annotations

import codecs
import json
import re
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

from exercisebook.judging import harmless
from exercisegrader import GradingError

#: The most characters of sources, and brackets one in another.
MOST, DEEPEST = 10 * 2**20, 200
#: The most values that are skipped one by one; most come in runs, as a list of points does.
MOST_VALUES = 1_000_000

#: The size of a piece (bytes).
_PIECE = 2**18
#: The longest number, and the longest word (characters).
_LONGEST_NUMBER, _LONGEST_WORD = 2**19, len("-Infinity")
#: What a cell takes beside its source (characters).
_CELL = 100
_LONGEST_KEY = 100

_SPACE = re.compile(r"[ \t\n\r]*")
_PLAIN = r'[^"\\\x00-\x1f]*'
_IN_TEXT = rf'{_PLAIN}(?:\\(?:["\\/bfnrt]|u[0-9a-fA-F]{{4}}){_PLAIN})*'
_ESCAPE = 6
_NUMBER = r"(?:-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)"
_WORD = r"(?:true|false|null|NaN|-?Infinity)"
_COMMA = r"[ \t\n\r]*,[ \t\n\r]*"


def _listed(value):
    """The expression for values with commas between them, or nothing."""
    return rf"[ \t\n\r]*(?:{value}(?:{_COMMA}{value})*)?[ \t\n\r]*"


_SIMPLE = f'(?:{_WORD}|{_NUMBER}|"{_IN_TEXT}")'
_NAMED = rf'"{_IN_TEXT}"[ \t\n\r]*:[ \t\n\r]*'
_FLAT = rf"(?:{_SIMPLE}|\[{_listed(_SIMPLE)}\]|\{{{_listed(_NAMED + _SIMPLE)}\}})"
_TEXT, _ATOM = re.compile(_IN_TEXT), re.compile(f"{_WORD}|{_NUMBER}")
_RUNS = {"[": re.compile(f"(?:{_FLAT}{_COMMA})*"), "{": re.compile(f"(?:{_NAMED}{_FLAT}{_COMMA})*")}
_ENDS = {"[": "]", "{": "}"}


def sources(stream: BinaryIO) -> bytes:
    """Return a notebook without its outputs, in one form: nbformat 4, cells with their type and source, and the names
    that its metadata carries for the grader (``loopbook``).

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
        cells, metadata = _notebook(_Text(stream))
    except ValueError as problem:
        raise GradingError(f"the file is not a notebook that can be read: {harmless(str(problem))}") from None
    kernel, info = metadata.get("kernelspec"), metadata.get("language_info")
    languages = [kernel.get("language") if isinstance(kernel, dict) else None]
    languages += [info.get("name") if isinstance(info, dict) else None]
    language = next(filter(None, languages), "python")
    if language != "python":
        raise GradingError(f"the notebook is written in {harmless(str(language))}: expected Python")
    kept = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    if "loopbook" in metadata:
        kept["loopbook"] = metadata["loopbook"]
    notebook = {"cells": cells, "metadata": kept, "nbformat": 4, "nbformat_minor": 4}
    return json.dumps(notebook, sort_keys=True).encode()


# A notebook.


def _notebook(text):
    """The cells of a notebook, and what is kept of its metadata."""
    if text.next() == "":
        raise ValueError("it is empty")
    found = {}
    for name in text.members():
        if name == "nbformat":
            found[name] = text.value()
        elif name == "metadata" and text.next() == "{":
            found[name] = {key: text.value() for key in text.members(only=("kernelspec", "language_info", "loopbook"))}
        elif name == "cells" and text.next() == "[":
            found[name] = [_cell(text) for _ in text.elements()]
        elif name == "worksheets" and text.next() == "[":
            found[name] = [_sheet(text) for _ in text.elements()]
        else:
            text.skip()
            found[name] = None  # the last of two of one name counts, as everywhere
    if text.next():
        raise text.broken("something after its end")
    form = found.get("nbformat")
    if not isinstance(form, int):
        raise ValueError("it has no number nbformat")
    cells = found.get("cells")
    if form < 4:  # of before 2015
        cells = [cell for sheet in found.get("worksheets") or () for cell in sheet]
    if cells is None:
        raise ValueError("it has no list of cells")
    metadata = found.get("metadata", {})
    if metadata is None:
        raise ValueError("its metadata are no dictionary")
    return [_kept(cell, "source" if form >= 4 else "input") for cell in cells], metadata


def _sheet(text):
    """The cells of a worksheet, in which notebooks before format 4 have them."""
    cells = []
    for name in text.members(only=("cells",)):
        if text.next() != "[":
            raise text.broken(f"no list of {name}")
        cells = [_cell(text) for _ in text.elements()]
    return cells


def _cell(text):
    """What counts of a cell, as it stands in the file."""
    if text.next() != "{":
        raise text.broken("a cell that is no dictionary")
    text.take(_CELL)
    return {name: text.value() for name in text.members(only=("cell_type", "source", "input"))}


def _kept(cell, name):
    """A cell in the one form."""
    kind = cell.get("cell_type")
    if kind is None:
        raise ValueError("a cell has no type")
    source = cell.get(name if kind == "code" else "source", None if name == "source" and kind == "code" else "")
    if isinstance(source, list) and all(isinstance(line, str) for line in source):
        source = "".join(source)
    if not isinstance(source, str):
        if kind == "code":
            raise ValueError("a cell has no source")
        source = ""
    if kind != "code":
        return {"cell_type": "raw" if kind == "raw" else "markdown", "metadata": {}, "source": source}
    return {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": source}


# JSON, a piece at a time.


class _Text:
    """The characters of a file, of which little more than one piece is there at a time, and a place among them."""

    def __init__(self, stream: BinaryIO):
        self._stream, self._decoder = stream, None
        self._text, self._at, self._before = "", 0, 0
        self._left, self._values = MOST, 0
        self._from, self._taken, self._room = 0, [], None

    def broken(self, what: str) -> ValueError:
        """What is wrong at this place, as an error to raise."""
        if self._at == len(self._text):
            what = "it ends before it should"
        return ValueError(f"at character {self._before + self._at + 1}: {what}")

    def take(self, characters: int) -> None:
        """Count characters of what is kept. Raises ValueError where there are too many."""
        self._left -= characters
        if self._left < 0:
            raise ValueError(f"it has more than {MOST // 2**20} MiB without its outputs")

    def _more(self):
        """Add the next piece to what lies ahead; returns whether there was one."""
        raw = self._stream.read(_PIECE)
        if self._decoder is None:
            while raw and len(raw) < 4 and (more := self._stream.read(4 - len(raw))):
                raw += more
            self._decoder = codecs.getincrementaldecoder(json.detect_encoding(raw))()
        try:
            new = self._decoder.decode(raw, final=not raw)
        except UnicodeDecodeError as problem:
            raise ValueError(f"it is no text in {problem.encoding.upper()}") from None
        if not raw:  # then there was no character left either
            return False
        self._keep()
        self._before += self._at
        self._text, self._at, self._from = self._text[self._at :] + new, 0, 0
        return True

    def _keep(self):
        """Take what was skipped since the last time, unless it is too much by now."""
        if self._room is not None:
            self._taken.append(self._text[self._from : self._at])
            self._room -= self._at - self._from
            if self._room < 0:
                self._taken, self._room = [], None
        self._from = self._at

    def _passed(self, passing: Callable[[], object], most: int) -> str | None:
        """The characters over which a function passes; None where they are more than that."""
        self._from, self._room = self._at, most
        passing()
        self._keep()
        taken = None if self._room is None else "".join(self._taken)
        self._taken, self._room = [], None
        return taken

    def next(self) -> str:
        """The next sign that is no space, which stays the next one; empty at the end."""
        while True:
            self._at = _SPACE.match(self._text, self._at).end()
            if self._at < len(self._text):
                return self._text[self._at]
            if not self._more():
                return ""

    def _sign(self, *signs: str) -> str:
        """skip one of these signs."""
        sign = self.next()
        if sign not in signs:
            raise self.broken(f"expected {' or '.join(signs)}, found {sign!r}")
        self._at += 1
        return sign

    def members(self, only: tuple[str, ...] = ()) -> Iterator[str | None]:
        """Yield the names in a dictionary; whoever asks skips the value of each before the next.

        Arguments:
            only: names to yield, all if empty; the values of others are skipped.
        """
        self._sign("{")
        if self.next() == "}":
            self._at += 1
            return
        while True:
            written = self._passed(self._string, _LONGEST_KEY)
            self._sign(":")
            name = written if written is None else json.loads(written)
            if only and name not in only:
                self.skip()
            else:
                yield name
            if self._sign(",", "}") == "}":
                return

    def elements(self) -> Iterator[None]:
        """Yield once for each value of a list; whoever asks skips it before the next."""
        self._sign("[")
        if self.next() == "]":
            self._at += 1
            return
        while True:
            yield
            if self._sign(",", "]") == "]":
                return

    def value(self) -> Any:
        """Skip a value, and return it. Raises ValueError where too much is kept by now."""
        written = self._passed(self.skip, self._left)
        self.take(len(written) if written is not None else self._left + 1)
        return json.loads(written)

    def skip(self) -> None:
        """Skip a value."""
        inside = []
        while True:
            self._values += 1
            if self._values > MOST_VALUES:
                raise ValueError(f"it has more than {MOST_VALUES} values")
            sign = self.next()
            if sign in ("[", "{"):
                self._at += 1
                if self.next() == _ENDS[sign]:
                    self._at += 1
                else:
                    inside.append(sign)
                    if len(inside) > DEEPEST:
                        raise self.broken(f"more than {DEEPEST} brackets one in another")
                    self._to_value(sign)
                    continue
            elif sign == '"':
                self._string()
            else:
                self._atom()
            while inside:
                sign = self._sign(",", _ENDS[inside[-1]])
                if sign == ",":
                    self._to_value(inside[-1])
                    break
                inside.pop()
            else:
                return

    def _to_value(self, sign):
        """skip short values in a list or a dictionary, as many as there are, and a name."""
        self.next()
        self._at = _RUNS[sign].match(self._text, self._at).end()
        if sign == "{":
            self._string()
            self._sign(":")

    def _string(self):
        """Skip a text."""
        self._sign('"')
        while True:
            self._at = _TEXT.match(self._text, self._at).end()
            if self._text[self._at : self._at + 1] == '"':
                self._at += 1
                return
            # here lies the end of the piece, perhaps within an escape, or what no text has
            whole = self._text[self._at : self._at + 1] != "\\" or len(self._text) - self._at >= _ESCAPE
            if (self._at < len(self._text) and whole) or not self._more():
                raise self.broken("a sign that no text has")

    def _atom(self):
        """Skip a number or a word."""
        while True:
            match = _ATOM.match(self._text, self._at)
            end = match.end() if match else self._at
            # what comes next may belong to it: the rest of a word, or of an exponent
            if end + _LONGEST_WORD <= len(self._text) or not self._more():
                break
            if len(self._text) - self._at > _LONGEST_NUMBER:
                raise self.broken("a number without an end")
        if not match:
            raise self.broken("expected a value")
        self._at = match.end()
