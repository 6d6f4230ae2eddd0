"""The files that grading leaves behind. The modules of this folder make some, and register them by `output`.

So do the learning management systems in `exercisegrader.lms`. What is registered is written, is listed in the summary
and in the guide, and is tested.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from exercisegrader import GradingError
from exercisegrader.student import parts

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.marking import Marked
    from exercisegrader.student import Student

#: What stands in the name of a file that is made for each student, or for whoever marks a section.
STUDENT, PART = "{student}", "{part}"
#: The packages whose modules register outputs.
PACKAGES = (__name__, "exercisegrader.lms")

_REGISTERED: dict[str, Output] = {}
_Function = TypeVar("_Function", bound="Callable[..., str | bytes | None]")


@dataclass(frozen=True)
class Grades:
    """What outputs are made of.

    Attributes:
        title: of the assignment.
        students: the roster.
        marks: a `Marked` for each submission of these students, in the order of the roster.
        complaints: sentences on what was handed in and could not be assigned to a student.
        notes: sentences on how the class was graded.
        reveal: whether students see the keys.
        notebooks: the ids of the students whose notebook was kept as it ran, ``notebooks/{student}.html``.
        folder: of the grades, where the files for each student are already.
    """

    title: str
    students: Sequence[Student]
    marks: Sequence[Marked]
    complaints: Sequence[str] = ()
    notes: Sequence[str] = ()
    reveal: bool = False
    notebooks: Collection[str] = ()
    folder: Path | None = None

    @property
    def graded(self) -> list[tuple[Student, Marked]]:
        """The students with a result, each with the `Marked`, in the order of the roster."""
        by_id = {mark.result.student: mark for mark in self.marks}
        return [(student, by_id[student.id]) for student in self.students if student.id in by_id]

    @property
    def without_jail(self) -> bool:
        """Whether a submission ran without a jail."""
        return any(not mark.result.jailed for mark in self.marks)

    @property
    def pages(self) -> dict[str, bytes]:
        """The pages of feedback that were written, by the ids of their students."""
        paths = {one.id: self.folder / "feedback" / one.id / "feedback.html" for one, _ in self.graded if self.folder}
        return {student: path.read_bytes() for student, path in paths.items() if path.is_file()}


@dataclass(frozen=True)
class Output:
    """A file that grading leaves behind, or one for each student or section.

    Attributes:
        file: its place in the folder of the grades; where it holds "{student}", there is one for each, named by the id,
            and where it holds "{part}" one for each of the `parts`.
        what: it is, and for whom, in some words.
        content: makes what it holds, as `output` says.
    """

    file: str
    what: str
    content: Callable[..., str | bytes | None]

    @property
    def is_for_each_student(self) -> bool:
        """Whether there is one for each student."""
        return STUDENT in self.file

    @property
    def is_for_each_part(self) -> bool:
        """Whether there is one for whoever marks a section."""
        return PART in self.file

    def files(self, grades: Grades) -> Iterator[tuple[str, str | bytes]]:
        """Yield the places of the files and their contents.

        Raises GradingError where the function returns a text that no file can hold.
        """
        each: list[tuple[str, tuple[object, ...]]] = [(self.file, ())]
        if self.is_for_each_student:
            each = [(self.file.replace(STUDENT, one[0].id), one) for one in grades.graded]
        elif self.is_for_each_part:
            each = [(self.file.replace(PART, part), (part,)) for part in sorted({*parts(grades.students).values()})]
        for file, of_one in each:
            made = self.content(grades, *of_one)
            if isinstance(made, str) and (torn := re.search("[\ud800-\udfff]", made)):
                raise GradingError(
                    f"the output {self.file!r} has {torn[0]!r}, half a character that no file can hold: expected what "
                    "students wrote as reports.wording.visible returns it"
                )
            if made is not None:
                yield file, made


def output(file: str, what: str) -> Callable[[_Function], _Function]:
    """Register a function as what makes a file; it returns the text, or the bytes, that the file holds.

    It takes `Grades`; where a file is made for each student, the student and the `Marked` as well, and where it is made
    for each section, its name as `parts` has it. It returns None where there is no such file for this roster.

    Arguments:
        file: its place in the folder of the grades, with "{student}" in it for a file for each student, or "{part}".
        what: it is, and for whom, for the list in the summary.
    Raises:
        GradingError: for a file that is made already.

    A module of this folder says::

        @output("names.txt", "the names of the class, for the door")
        def names(grades: Grades) -> str:
            return "\\n".join(student.name for student in grades.students)
    """
    if file in _REGISTERED:
        raise GradingError(f"two outputs have the file {file!r}: expected one")

    def register(content):
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
