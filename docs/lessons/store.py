"""The lessons by name, each recorded from a cell of a chapter."""

import functools
import json
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from plainmath.validation import did_you_mean

HERE = Path(__file__).resolve().parent
RECORDED = HERE / "recorded"


@dataclass(frozen=True)
class Recorded:
    """A lesson that is a cell with sliders of a chapter, and its words out of words.toml.

    Attributes:
        name: of the lesson, and of its file in recorded/.
        chapter, function: where the cell is, and what its function is called.
        title, about, questions: of the lesson, what is shown and what to try; Markdown, with mathematics. The text of
            the chapter above the cell has most of them.
        typed: texts to choose from where the cell has a field to type in.
        named: {slider: values} that a text names, and that can be set where a slider has become coarser.
    """

    name: str
    chapter: str
    function: str
    title: str
    about: str = ""
    questions: tuple = ()
    typed: tuple = ()
    named: dict = field(default_factory=dict)

    @property
    def file(self):
        """Where it is stored."""
        return RECORDED / f"{self.name}.json"

    def record(self):
        """Return what is stored of it: its sliders and its data.

        Raises ValueError where it has not been recorded.
        """
        if not self.file.exists():
            raise ValueError(f"the lesson {self.name!r} is not recorded: run make execute")
        return json.loads(self.file.read_text(encoding="utf-8"))


@functools.cache
def recorded():
    """The recorded lessons by name, in the order of the book."""
    written = tomllib.loads((HERE / "words.toml").read_text(encoding="utf-8"))
    return {
        name: Recorded(
            name,
            told.pop("chapter"),
            told.pop("function", name),
            questions=tuple(told.pop("try", ())),
            typed=tuple(told.pop("typed", ())),
            **told,
        )
        for name, told in written.items()
    }


def of_cell(chapter, source):
    """The recorded lesson of a cell of a chapter, or None."""
    found = re.search(r"^@sliders\(.*?^def (\w+)", source, re.MULTILINE | re.DOTALL)
    place = (chapter, found[1]) if found else None
    return next((lesson for lesson in recorded().values() if (lesson.chapter, lesson.function) == place), None)


def load(name):
    """Return the lesson of a name.

    Raises ValueError for a name that no lesson has.
    """
    if name not in recorded():
        raise ValueError(f"there is no lesson {name!r}: {did_you_mean(name, recorded())}")
    return recorded()[name]


def titles():
    """All lessons as (chapter, name, title), chapter by chapter."""
    return [(lesson.chapter, name, lesson.title) for name, lesson in recorded().items()]
