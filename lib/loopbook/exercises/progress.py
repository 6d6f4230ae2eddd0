"""Which exercises are right so far: a small file beside the notebook."""

from __future__ import annotations

import contextlib
import html
import json
import os
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from loopbook.exercises.authoring import Exercise

FILE = Path(".loopbook-progress.json")
#: A larger file is none that was written here.
LARGEST = 10**6
#: Set to "off", this variable of the environment keeps the file from being read and written, as in tests.
SWITCH = "LOOPBOOK_PROGRESS"


def note(number: str, student: str | None, is_right: bool) -> None:
    """Note that an exercise was answered, and whether all of it was right; what was right once stays so."""
    if os.environ.get(SWITCH) == "off":
        return
    known = load()
    key = _key(number, student)
    if known.get(key) is True or known.get(key) is is_right:
        return
    _store(known | {key: bool(is_right)})


def load() -> dict[str, bool]:
    """Return what the file says: {exercise: whether it was right}. A damaged file is ignored, with a warning."""
    if os.environ.get(SWITCH) == "off" or not os.path.lexists(FILE):
        return {}
    try:
        if not FILE.is_file() or FILE.stat().st_size > LARGEST:
            raise ValueError("no file, or a very large one")
        stored = json.loads(FILE.read_text(encoding="utf-8-sig"))["answered"]
        if not (isinstance(stored, dict) and all(isinstance(right, bool) for right in stored.values())):
            raise ValueError("not a table of exercises")
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        warnings.warn(f"{FILE} is damaged and ignored; your next answer begins a new one", stacklevel=3)
        return {}
    return stored


def _store(known):
    """Replace the file in one step, so that an interruption leaves the old one or the new one."""
    file = FILE.resolve() if FILE.is_file() else FILE  # where a link leads
    partial = file.with_name(f"{file.name}.{os.getpid()}")
    try:
        partial.write_text(json.dumps({"answered": known}, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        partial.replace(file)
    except OSError as problem:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        warnings.warn(f"the progress cannot be stored in {FILE}: {problem.strerror}", stacklevel=4)


def _key(number, student):
    return number if student is None else f"{number} {student}"


@dataclass(frozen=True)
class Progress:
    """The exercises of a chapter: pairs of a heading and True, False or, where not answered yet, None."""

    rows: tuple[tuple[str, bool | None], ...]

    @classmethod
    def of(cls, exercises: Iterable[Exercise], student: str | None = None) -> Self:
        """The progress in these exercises."""
        known = load()
        return cls(tuple((one.heading, known.get(_key(one.number, student))) for one in exercises))

    @property
    def right(self) -> int:
        """How many are right."""
        return sum(right is True for _, right in self.rows)

    def __repr__(self) -> str:
        return "\n".join([f"{self.right} of {len(self.rows)} right", *(f"  {_mark(r)} {h}" for h, r in self.rows)])

    def _repr_html_(self):
        rows = "".join(f"<div>{_mark(right)} {html.escape(heading)}</div>" for heading, right in self.rows)
        return f'<div role="status"><strong>{self.right} of {len(self.rows)} right</strong>{rows}</div>'


def _mark(right):
    return {True: "✓", False: "✗", None: "·"}[right]
