"""What a released notebook says in its metadata: for whom and from which assignment it is, and with which numbers.

The numbers stand there as a proof that needs the assignment's secret: it tells whether they are those of the record,
and neither what they are nor what follows from them.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from nbformat import NotebookNode


@dataclass(frozen=True)
class Imprint:
    """The imprint of a notebook.

    Attributes:
        assignment: its name.
        student: id.
        version: of the package that released it.
        cells: a text that changes with the cells as they were released; empty where it is not known.
        numbers: {exercise: proof of its numbers}; empty in notebooks of a version that wrote none.
    """

    assignment: str
    student: str
    version: str = ""
    cells: str = ""
    numbers: Mapping[str, str] | None = None

    @classmethod
    def of(cls, metadata: object) -> Self | None:
        """Return the imprint in the metadata of a notebook; None where there is none."""
        said = metadata.get("loopbook") if isinstance(metadata, Mapping) else None
        if not (isinstance(said, Mapping) and _is_text(said.get("student")) and _is_text(said.get("assignment"))):
            return None
        version, cells, numbers = (said.get(name) for name in ("version", "released", "numbers"))
        return cls(
            said["assignment"],
            said["student"],
            version if _is_text(version) else "",
            cells if _is_text(cells) else "",
            {name: proof for name, proof in numbers.items() if _is_text(proof)}
            if isinstance(numbers, Mapping)
            else None,
        )

    def as_metadata(self) -> dict[str, Any]:
        """Return it as the metadata of a notebook, under the key "loopbook"."""
        said = {"assignment": self.assignment, "released": self.cells, "student": self.student, "version": self.version}
        return said | {"numbers": dict(self.numbers or {})}


def peek(content: bytes) -> Imprint | None:
    """Return the imprint of a notebook as `sources.sources` returns it; None where there is none.

    >>> peek(b'{"cells": [], "metadata": {"loopbook": {"assignment": "heater", "student": "s1001"}}}').student
    's1001'
    """
    return Imprint.of(json.loads(content)["metadata"]) if content else None


def what_it_is(content: bytes) -> str:
    """Return what to say of a notebook that answers nothing; nothing of one that is as it was released.

    Arguments:
        content: a notebook as `sources.sources` returns it; empty where there is none.
    """
    if not content:
        return ""
    imprint = peek(content)
    if imprint is None:
        return "it answers nothing and was not released with this assignment: is it another notebook?"
    cells = [(cell["cell_type"], cell["source"]) for cell in json.loads(content)["cells"]]
    is_as_released = not imprint.cells or imprint.cells == _told(cells)
    return "" if is_as_released else "it answers nothing, though somebody has worked in it"


def cells_of(notebook: NotebookNode) -> str:
    """Return a text that changes with the cells of a notebook."""
    return _told([(cell.cell_type, cell.source) for cell in notebook.cells])


def _told(cells):
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()


def proofs(secret: str, student: str, numbers: Mapping[str, Mapping[str, str]]) -> dict[str, str]:
    """Return what stands for the numbers of a student in the imprint: {exercise: text}.

    Arguments:
        secret: of the assignment.
        student: id.
        numbers: {exercise: {parameter: text}}.
    """
    return {
        exercise: sealed(secret, [student, exercise, sorted(texts.items())])[:16] for exercise, texts in numbers.items()
    }


def sealed(secret: str, data: object) -> str:
    """Return what only the owner of a secret can make of data."""
    return hmac.new(secret.encode(), json.dumps(data, sort_keys=True).encode(), hashlib.sha256).hexdigest()


def _is_text(value):
    return isinstance(value, str)
