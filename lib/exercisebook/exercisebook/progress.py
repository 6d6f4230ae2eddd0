"""Which exercises are right so far: a small file beside the notebook."""

from __future__ import annotations

import html
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from exercisebook import notes

FILE = Path(".loopbook-progress.json")


def note(number: str, student: str | None, is_right: bool) -> None:
    """Note that an exercise was answered, and whether all of it was right; what was right once stays so."""
    if notes.are_off():
        return
    known = load()
    key = _key(number, student)
    if known.get(key) is True or known.get(key) is is_right:
        return
    notes.write(FILE, "answered", known | {key: bool(is_right)}, "the progress")


def load() -> dict[str, bool]:
    """Return what the file says: {exercise: whether it was right}. A damaged file is ignored, with a warning."""
    return notes.read(FILE, "answered", _is_table, "your next answer begins a new one") or {}


def is_answered(number: str, student: str | None) -> bool:
    """Whether an exercise was answered before, right or wrong."""
    return _key(number, student) in load()


def students(number: str) -> list[str | None]:
    """Return for whom an exercise may have been answered: everybody, which is None, and the names in the file."""
    return [None, *(key.removeprefix(f"{number} ") for key in load() if key.startswith(f"{number} "))]


def _is_table(stored):
    return isinstance(stored, dict) and all(isinstance(right, bool) for right in stored.values())


def _key(number, student):
    return number if student is None else f"{number} {student}"


@dataclass(frozen=True)
class Progress:
    """The exercises of a chapter: pairs of a heading and True, False or, where not answered yet, None."""

    rows: tuple[tuple[str, bool | None], ...]

    @classmethod
    def of(cls, headings: Mapping[str, str], student: str | None = None) -> Self:
        """The progress in exercises, of which the headings are given by their numbers."""
        known = load()
        return cls(tuple((heading, known.get(_key(number, student))) for number, heading in headings.items()))

    @property
    def right(self) -> int:
        """How many are right."""
        return sum(right is True for _, right in self.rows)

    def __repr__(self) -> str:
        return "\n".join([f"{self.right} of {len(self.rows)} right", *(f"  {_mark(r)} {h}" for h, r in self.rows)])

    def _repr_html_(self):
        rows = "".join(f"<div>{_mark(right)} {html.escape(heading)}</div>" for heading, right in self.rows)
        return f'<div role="status"><strong>{self.right} of {len(self.rows)} right</strong>{rows}</div>'


@dataclass(frozen=True)
class Collection:
    """All chapters: their titles, the names of their notebooks, and the progress in each."""

    chapters: tuple[tuple[str, str, Progress], ...]

    @property
    def right(self) -> int:
        """How many exercises are right."""
        return sum(progress.right for _, _, progress in self.chapters)

    @property
    def summary(self) -> str:
        """How many of how many exercises are right."""
        return f"{self.right} of {sum(len(progress.rows) for _, _, progress in self.chapters)} right"

    def __repr__(self) -> str:
        widest = max(len(title) for title, _, _ in self.chapters)
        rows = (f"  {title:{widest}}  {_marks(progress)}" for title, _, progress in self.chapters)
        return "\n".join([self.summary, *rows])

    def _repr_html_(self):
        rows = "".join(
            f'<tr><td style="text-align:left"><a href="{name}.ipynb">{html.escape(title)}</a></td>'
            f'<td style="text-align:left">{_marks(progress)}</td>'
            f'<td style="text-align:right">{progress.right} of {len(progress.rows)}</td></tr>'
            for title, name, progress in self.chapters
        )
        return f'<div role="status"><strong>{self.summary}</strong><table><tbody>{rows}</tbody></table></div>'


def _marks(progress):
    return " ".join(_mark(right) for _, right in progress.rows)


def _mark(right):
    return {True: "✓", False: "✗", None: "·"}[right]
