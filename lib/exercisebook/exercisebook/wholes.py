"""Answers that may come whole or in parts: a spring, and its stiffness and its length one by one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar


class Whole:
    """Something that readers give as one object or in parts with names of their own; each registers itself.

    Attributes:
        called: a name under which readers give it whole, one in a row of `asked_names.SYNONYMS`.
        parts: the names of the parts, the one without which there is no whole first.
    """

    called: ClassVar[str]
    parts: ClassVar[tuple[str, ...]]

    def __init__(self) -> None:
        WHOLES.append(self)

    def part(self, name: str) -> str:
        """Return which part a name stands for, here or in other books; empty for another name."""
        raise NotImplementedError

    def parts_of(self, given: object) -> tuple[dict[str, Any] | None, str]:
        """Return the parts in an answer as they were given, None where it has none, and a remark on other names."""
        raise NotImplementedError

    def is_one(self, given: object) -> bool:
        """Return whether an answer is the object, or a text that looks like it."""
        raise NotImplementedError

    def as_data(self, value: object) -> dict[str, Any] | None:
        """Return the object as a dictionary that `of_data` reads; None for anything else."""
        raise NotImplementedError

    def of_data(self, data: dict[str, Any]) -> object | None:
        """Return the object that a dictionary is the data of; None for another dictionary."""
        raise NotImplementedError

    def in_words(self, data: dict[str, Any], written: Callable[[Any], str]) -> str | None:
        """Return the object that a dictionary is the data of, as people write it; None for another dictionary.

        Arguments:
            data: as plain data, in which a fraction is a text, and which may be anybody's.
            written: returns a value of it as a text.
        """
        raise NotImplementedError


#: All that there are.
WHOLES: list[Whole] = []
