"""A reader's name, said once: a small file beside the notebook keeps it, and exercises have her numbers."""

from __future__ import annotations

import contextlib
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from exercisebook import notes

FILE = Path(".loopbook-student.json")
LONGEST = 100


@dataclass(frozen=True)
class Student:
    """Whose numbers the exercises have: those of a name, or of everybody without one."""

    name: str | None = None

    def __repr__(self) -> str:
        if self.name is None:
            return 'No name yet: the exercises have the numbers that everybody has. For your own, say student("Mira")'
        return f"{self.name}: the exercises have your own numbers. Back to those that everybody has: student(None)"


def checked(name: object) -> str:
    """Return a name in its one spelling. Raises ValueError for what is none."""
    if not isinstance(name, str):
        raise ValueError(f"student is {name!r}: expected a name in quotes, as in student('Mira')")
    name = unicodedata.normalize("NFC", name.strip())
    if not name:
        raise ValueError("student is an empty text: expected a name, as in student('Mira')")
    if len(name) > LONGEST or not name.isprintable():
        raise ValueError(f"student is {name[:LONGEST]!r}: expected a name in one line of at most {LONGEST} characters")
    return name


def known() -> str | None:
    """Return the name that is kept for the notebooks of this folder."""
    return notes.read(FILE, "student", _is_name, 'say your name again, as in student("Mira")')


def _is_name(value):
    with contextlib.suppress(ValueError):
        return checked(value) == value
    return False


def keep(name: str) -> None:
    """Keep a name for the notebooks of this folder. Raises ValueError for what is none."""
    name = checked(name)
    if not notes.are_off():
        notes.write(FILE, "student", name, "the name")


def forget() -> None:
    """Forget the name."""
    if not notes.are_off():
        FILE.unlink(missing_ok=True)
