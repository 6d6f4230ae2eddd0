"""What a person marks: a figure, and a text. They are taken down, and nothing is said of right or wrong."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NoReturn

from exercisebook import png
from exercisebook.grammar import Unreadable
from exercisebook.kinds.kind import ELSEWHERE, LINES, Kind
from exercisebook.reading import NOT_ANSWERED, answered
from plainmath.validation import whole

#: Characters of a text.
LONGEST = 5000


class _ByHand:
    """What the kinds that a person marks have in common. Their key is a text for the marker, and may be empty."""

    by_hand = True
    accuracy = ""
    key: str

    def __init__(self, what: str, key: str = ""):
        if not isinstance(key, str):
            raise ValueError(f"the key of {what} is {key!r}: expected a text, what whoever marks it looks for")
        self.what, self.key = what, key

    @property
    def making(self) -> str:
        """Nothing judges it again from code."""
        return ""

    @property
    def field(self) -> dict[str, Any]:
        """Lines."""
        return {"control": LINES, "asked": self.asked}

    def agrees(self, answer: Any) -> bool:
        """Never: a person says whether it is right."""
        return False

    def like(self, value: object) -> NoReturn:
        """There are no mistakes of it that could be recognised."""
        raise ValueError(f"a person marks {self.what}: expected no mistake of it")

    def mistakes(self) -> Iterable[tuple[str, Any]]:
        """None."""
        return ()

    @property
    def solution(self) -> str:
        """What whoever marks it looks for."""
        return self.key

    @property
    def shown(self) -> str:
        """The same, for texts of the author."""
        return self.key


class Figure(_ByHand, Kind):
    """A figure that a person marks: a plot or a sketch, as Matplotlib's figure or as the bytes of a PNG file.

    Arguments:
        what: it shows, as "the path of the ball".
        key: what whoever marks it looks for; no student sees it before keys are revealed.

    >>> sketch = Figure("the path of the ball", key="it is a parabola")
    >>> sketch.asked
    'the path of the ball, as a figure, which a person marks'
    """

    expected = "a figure of Matplotlib, as plt.gcf(), or the bytes of a PNG file"
    FORM = ()

    def __init__(self, what: str = "the figure", key: str = ""):
        super().__init__(what, key)

    @property
    def asked(self) -> str:
        """What it shows, and that it is a figure."""
        return f"{self.what}, as a figure, which a person marks"

    @property
    def field(self) -> dict[str, Any]:
        """No place in a page."""
        says = "A page has no place for a figure: this one is answered in JupyterLab."
        return {"control": ELSEWHERE, "asked": self.asked, "help": says}

    def read(self, given: object) -> tuple[bytes, str]:
        """Return the figure as the bytes of a PNG file."""
        content = png.checked(given) if png.is_data(answered(given)) else png.of_figure(given)
        if content is None:
            raise Unreadable(f"this is not a figure: expected {self.expected}")
        return content, ""

    def written(self, answer: bytes) -> str:
        """Its size."""
        width, height = png.size(answer)
        return f"a figure of {width} × {height} pixels"

    def as_code(self, answer: bytes | None = None) -> str:
        """The dots: no code says a figure."""
        if answer is not None:
            raise ValueError("no code says a figure: expected a file")
        return "..."


class Text(_ByHand, Kind):
    """A text that a person marks.

    Arguments:
        what: it says, as "why the ball bounces".
        words: how many it has at most; a longer one is taken down as well, and that is said.
        key: what whoever marks it looks for; no student sees it before keys are revealed.

    >>> why = Text("why the ball bounces", words=5)
    >>> why.read("What it loses of its height is heat.")[1]
    '8 words, where at most 5 are asked for'
    >>> why.asking
    'text(5)'
    """

    expected = "a text, in quotes"
    FORM = ("words",)

    def __init__(self, what: str = "the text", words: int = 0, key: str = ""):
        super().__init__(what, key)
        self.words = whole("words", words, least=0)

    @property
    def asked(self) -> str:
        """What it says, and in how many words."""
        length = f" in at most {self.words} words" if self.words else " in words"
        return f"{self.what},{length}, which a person marks"

    def read(self, given: object) -> tuple[str, str]:
        """Return the text, and a remark where it is longer than asked for."""
        if not isinstance(answered(given), str):
            raise Unreadable(f"this is not a text: expected {self.expected}")
        text = str(given).strip()
        if not text:
            raise Unreadable(NOT_ANSWERED)
        if len(text) > LONGEST:
            raise Unreadable(f"this text has {len(text)} characters: expected at most {LONGEST}")
        count = len(text.split())
        return text, f"{count} words, where at most {self.words} are asked for" if 0 < self.words < count else ""

    def written(self, answer: str) -> str:
        """The text in one line."""
        return " ".join(answer.split())
