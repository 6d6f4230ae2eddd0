"""The files that grading leaves behind. The modules of this folder make some, and register them by `output`.

So do the learning management systems in `exercisegrader.lms`. What is registered is written, is listed by
``exercisegrader grade --help``, and is tested.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from exercisegrader import GradingError

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.marking import Marked
    from exercisegrader.roster import Student

__all__ = ["Output", "output", "registered"]

#: What stands in the name of a file that is made for each student.
STUDENT = "{student}"
#: The packages whose modules register outputs.
PACKAGES = (__name__, "exercisegrader.lms")
#: What a function may ask for, by the names of its parameters.
OF_CLASS = ("title", "students", "marks", "complaints", "notes", "notebooks", "reveal", "folder")
OF_STUDENT = ("title", "student", "mark", "notebooks", "reveal")

_REGISTERED: dict[str, Output] = {}
_Function = TypeVar("_Function", bound="Callable[..., str | bytes | None]")


@dataclass(frozen=True)
class Output:
    """A file that grading leaves behind, or one for each student.

    Attributes:
        file: its place in the folder of the grades; where it holds "{student}", there is one for each, named by the id.
        what: it is, and for whom, in some words.
        content: makes what it holds, a text or bytes, or None where there is no such file for this roster; what it
            takes it asks for by name.
    """

    file: str
    what: str
    content: Callable[..., str | bytes | None]

    @property
    def is_for_each_student(self) -> bool:
        """Whether there is one for each student."""
        return STUDENT in self.file

    def files(
        self,
        title: str,
        students: Sequence[Student],
        marks: Sequence[Marked],
        complaints: Iterable[str] = (),
        notes: Iterable[str] = (),
        reveal: bool = False,
        notebooks: Collection[str] = (),
        folder: Path | None = None,
    ) -> Iterator[tuple[str, str | bytes]]:
        """Yield the places of the files and their contents.

        Arguments:
            title: of the assignment.
            students: the roster.
            marks: a `Marked` for each submission of these students, in the order of the roster.
            complaints: sentences on what was handed in and could not be assigned to a student.
            notes: sentences on how the class was graded.
            reveal: whether students see the keys.
            notebooks: the ids of the students whose notebook was kept as it ran, ``notebooks/{student}.html``.
            folder: of the grades, where the files for each student are already.
        Raises:
            GradingError: where the function returns a text that no file can hold.
        """
        known = {
            "title": title, "students": students, "marks": marks, "complaints": complaints, "notes": notes,
            "reveal": reveal, "notebooks": notebooks, "folder": folder,
        }  # fmt: skip
        if not self.is_for_each_student:
            if (made := self._made_of(known)) is not None:
                yield self.file, made
            return
        by_id = {student.id: student for student in students}
        for mark in marks:
            student = by_id[mark.result.student]
            if (made := self._made_of(known | {"student": student, "mark": mark})) is not None:
                yield self.file.replace(STUDENT, student.id), made

    def _made_of(self, known):
        made = self.content(**{name: known[name] for name in inspect.signature(self.content).parameters})
        if isinstance(made, str) and (torn := re.search("[\ud800-\udfff]", made)):
            raise GradingError(
                f"the output {self.file!r} has {torn[0]!r}, half a character that no file can hold: expected what "
                "students wrote as reports.wording.visible returns it"
            )
        return made


def output(file: str, what: str) -> Callable[[_Function], _Function]:
    """Register a function as what makes a file; it returns the text, or the bytes, that the file holds.

    It returns None where there is no such file for this roster. The parameters of the function say what it takes: any
    of title, students, marks, complaints, notes, notebooks, reveal and folder; where a file is made for each student,
    any of title, student, mark, notebooks and reveal. `Output.files` says what these are.

    Arguments:
        file: its place in the folder of the grades, with "{student}" in it for a file for each student.
        what: it is, and for whom, for the list of ``exercisegrader grade --help``.
    Raises:
        GradingError: for a file that is made already, and for a function that asks for something else.

    A module of this folder says::

        @output("names.txt", "the names of the class, for the door")
        def names(students: Sequence[Student]) -> str:
            return "\\n".join(student.name for student in students)
    """
    if file in _REGISTERED:
        raise GradingError(f"two outputs have the file {file!r}: expected one")
    may_ask = OF_STUDENT if STUDENT in file else OF_CLASS

    def register(content):
        if unknown := [name for name in inspect.signature(content).parameters if name not in may_ask]:
            raise GradingError(f"the output {file!r} asks for {unknown[0]!r}: expected some of {', '.join(may_ask)}")
        _REGISTERED[file] = Output(file, what, content)
        return content

    return register


def registered() -> tuple[Output, ...]:
    """Return what is registered, in the order of the files' names.

    >>> next(one.what for one in registered() if one.file == "grades.csv")
    'the grades by id, for any table'
    """
    for package in PACKAGES:
        for module in pkgutil.iter_modules(importlib.import_module(package).__path__, f"{package}."):
            importlib.import_module(module.name)
    return tuple(sorted(_REGISTERED.values(), key=lambda one: one.file))
