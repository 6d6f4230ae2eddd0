"""What a notebook shows of an exercise: texts in Markdown, which others take in parts, and a picture below them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Statement:
    """What a question says, in Markdown; as a string, it is all of it.

    Attributes:
        heading: the number of the exercise, and its title.
        points: how many it brings, in words.
        body: what is given and wanted.
        asked: for each asked quantity its name, and what it is.
        accuracy: how near the answers must be; empty where that is no question.
    """

    heading: str
    points: str
    body: str
    asked: tuple[str, ...]
    accuracy: str

    @property
    def list_of_asked(self) -> str:
        """What is asked as a list."""
        return "\n".join(f"- {one}" for one in self.asked)

    @property
    def below_heading(self) -> str:
        """All but the heading and the points."""
        parts = [self.body, self.list_of_asked]
        return "\n\n".join([*parts, f"*Accuracy: {self.accuracy}*"] if self.accuracy else parts)

    def __str__(self) -> str:
        return f"**{self.heading}** ({self.points})\n\n{self.below_heading}"


class Page(Showing):
    """A text in Markdown, and perhaps a picture.

    Arguments:
        body: Markdown.
        head: the line above it; empty for none.
        draw: returns the figure, or None.

    >>> Page("The **law** comes first.")
    The **law** comes first.
    """

    def __init__(self, body: str, head: str = "", draw: Callable[[], Any] = lambda: None):
        self.body, self.head, self._draw = body, head, draw

    @property
    def text(self) -> str:
        """All of it in Markdown."""
        return f"{self.head}\n\n{self.body}" if self.head else self.body

    @property
    def pictures(self) -> Sequence[Any]:
        """The picture, if there is one."""
        picture = self._draw()
        return () if picture is None else (picture,)

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": self.text, "text/markdown": self.text}

    def __repr__(self) -> str:
        return self.text
