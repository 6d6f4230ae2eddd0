"""What a notebook shows of an exercise: Markdown, and a picture below it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any


class Showing:
    """Something that a notebook shows as Markdown or HTML, with pictures below it."""

    @property
    def pictures(self) -> Sequence[Any]:
        """Figures that show themselves."""
        return ()

    def _ipython_display_(self):
        if not (pictures := self.pictures):
            raise NotImplementedError  # IPython then shows the value of the cell as it is
        from IPython.display import display

        display(self._repr_mimebundle_(), raw=True)
        for picture in pictures:
            display(picture)


class Page(Showing):
    """A text in Markdown, and perhaps a picture.

    Arguments:
        text: Markdown.
        draw: returns the figure, or None.

    >>> Page("The **gain** comes first.")
    The **gain** comes first.
    """

    def __init__(self, text: str, draw: Callable[[], Any] = lambda: None):
        self.text, self._draw = text, draw

    @property
    def pictures(self) -> Sequence[Any]:
        """The picture, if there is one."""
        picture = self._draw()
        return () if picture is None else (picture,)

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": self.text, "text/markdown": self.text}

    def __repr__(self) -> str:
        return self.text
