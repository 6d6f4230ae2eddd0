"""What the cells of a notebook show, caught inside the jail: what they print, their values, and figures as PNG.

Only a notebook that is run to be shown is looked at like this; the run that counts for points has none of it.
"""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable
from typing import Any

from IPython.core.interactiveshell import InteractiveShell

from exercisebook import png

#: What a cell may show (characters of text, and bytes of pictures).
MOST = 300_000
_TEXT, _PNG = "text/plain", "image/png"


class Showing:
    """Whoever catches what cells show, and tells it as events "shown", with the cell, "text" or "png", and the data.

    Arguments:
        interpreter: the shell.
        tell: a function that takes an event.
    """

    def __init__(self, interpreter: InteractiveShell, tell: Callable[[dict[str, Any]], object]):
        self._tell, self._cell, self._left, self._texts = tell, 0, MOST, []
        self._formatter = interpreter.display_formatter
        self._formatter.__dict__.pop("format", None)  # which the shell has replaced by one that does nothing
        self._formatter.active_types = [_TEXT, _PNG]
        interpreter.showing = self
        sys.stdout = sys.stderr = _Stream(self)

    def begin(self, cell: int) -> None:
        """Tell what follows as that of another cell."""
        self._cell, self._left = cell, MOST

    def end(self) -> None:
        """Tell what the cell has shown, and its figures, which are then closed as in Jupyter."""
        with contextlib.suppress(Exception):  # a student's figure may fail in any way
            self._figures()
        self._flush()

    def text(self, text: str) -> None:
        """Take a text."""
        if self._left > 0:
            self._texts.append(text[: self._left])
            self._left -= len(text)
            if self._left <= 0:
                self._texts.append("\n... the rest is omitted")

    def value(self, value: object) -> None:
        """Take the value of a cell."""
        with contextlib.suppress(Exception):
            self.data(self._formatter.format(value)[0])

    def data(self, data: dict[str, Any]) -> None:
        """Take what was displayed, in the forms that it has: a picture, or else text."""
        picture = data.get(_PNG)
        if isinstance(picture, str):
            picture = png.checked({"png": picture.replace("\n", "")})
        if isinstance(picture, bytes):
            self._picture(picture)
        elif isinstance(data.get(_TEXT), str):
            self.text(data[_TEXT] + "\n")

    def _figures(self):
        pyplot = sys.modules.get("matplotlib.pyplot")
        for number in pyplot.get_fignums() if pyplot else ():
            picture = png.of_figure(pyplot.figure(number))
            if picture:
                self._picture(picture)
        if pyplot:
            pyplot.close("all")

    def _picture(self, content):
        self._left -= len(content)
        if self._left < 0:
            self._texts.append("\n... a picture is omitted\n")
            return
        self._flush()
        self._tell({"shown": {"cell": self._cell, "kind": "png", "data": png.as_data(content)["png"]}})

    def _flush(self):
        text, self._texts = "".join(self._texts), []
        if text:
            text = text.encode("utf-8", "backslashreplace").decode()
            self._tell({"shown": {"cell": self._cell, "kind": "text", "data": text}})


class _Stream(io.TextIOBase):
    """What is printed."""

    encoding = "utf-8"

    def __init__(self, showing):
        self._showing = showing

    def writable(self):
        return True

    def write(self, text):
        self._showing.text(str(text))
        return len(text)
