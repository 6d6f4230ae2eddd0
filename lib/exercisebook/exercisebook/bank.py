"""The exercises of a book: a package with a package for each chapter, loaded when one of its exercises is asked for."""

from __future__ import annotations

import functools
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import EllipsisType
from typing import TYPE_CHECKING

from exercisebook import naming
from exercisebook.errors import ExerciseError
from exercisebook.progress import Collection, Progress
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.authoring import Exercise
    from exercisebook.question import Question


class Bank:
    """The exercises of a package of chapters, as ``ch01_introduction``, each a package with pages, or a module.

    Arguments:
        package: its name.
    """

    def __init__(self, package: str):
        self.package = package

    @functools.cache  # noqa: B019 - a bank lives as long as the program
    def chapters(self) -> dict[str, str]:
        """Return the names of the modules by their chapters, in order: {"1": "ch01_introduction", ...}."""
        path = importlib.import_module(self.package).__path__
        names = sorted(module.name for module in pkgutil.iter_modules(path) if module.name.startswith("ch"))
        return {name[2:].split("_")[0].lstrip("0"): name for name in names}

    @functools.cache  # noqa: B019
    def exercises(self, chapter: str) -> dict[str, Exercise]:
        """Return the exercises of a chapter in their order: {number: `Exercise`}. Raises KeyError for no chapter."""
        from exercisebook.authoring import (
            collected,
            in_order,
        )  # they load the plug-ins, which may have banks themselves
        from exercisebook.pages import page

        module, found = self._module(chapter), {}
        for folder in map(Path, getattr(module, "__path__", ())):
            for file in sorted(folder.glob("*.md")):
                found |= page.read(file)
        return in_order(found | collected(module))

    def title(self, chapter: str) -> str:
        """Return number and title of a chapter, from the first line of its module. Raises KeyError for no chapter."""
        words = re.match(r"Exercises of \w+ \w+, (.+?)[.:]", inspect.getdoc(self._module(chapter)))[1]
        return f"{chapter} · {words[0].upper()}{words[1:]}"

    def _module(self, chapter):
        return importlib.import_module(f"{self.package}.{self.chapters()[chapter]}")

    def exercise(self, number: str, student: str | None = None) -> Question:
        """Return an exercise as a question: shown, it is the statement; ``.check(...)`` responds to answers.

        Arguments:
            number: chapter and place in it, as "10.3".
            student: a name, for numbers of one's own, the same every time. If not given, it is the name that
                `student` keeps, and without one the variant is the reference.
        Raises:
            ExerciseError: for an unknown number.
        """
        if not isinstance(number, str):
            raise ExerciseError(f"the exercise is {number!r}: expected chapter and place in it as text, such as '10.3'")
        known = self.exercises(self._chapter(number.partition(".")[0]))
        if number not in known:
            raise ExerciseError(f"there is no exercise {number!r}: {did_you_mean(number, known)}")
        try:
            return known[number].question(naming.known() if student is None else student)
        except (TypeError, ValueError) as error:
            raise ExerciseError(str(error)) from None

    def progress(self, chapter: str | int | None = None, student: str | None = None) -> Progress | Collection:
        """Return which exercises are right so far; a file beside the notebook keeps it.

        Arguments:
            chapter: as "10"; all chapters if not given.
            student: whose progress, in numbers of one's own. If not given, that of the name that `student` keeps.
        """
        name = naming.known() if student is None else student
        if chapter is not None:
            return self._progress(self._chapter(str(chapter)), name)
        return Collection(
            tuple(
                (self.title(one), module.removeprefix("ch"), self._progress(one, name))
                for one, module in self.chapters().items()
            )
        )

    def _progress(self, chapter, name):
        return Progress.of({number: one.heading for number, one in self.exercises(chapter).items()}, name)

    def _chapter(self, name):
        name = name.lstrip("0")
        if name not in self.chapters():
            known = did_you_mean(name, self.chapters())
            raise ExerciseError(f"there is no chapter {name!r} with exercises: {known}")
        return name


def student(name: str | EllipsisType | None = ...) -> naming.Student:
    """Say a name once: from then on the exercises beside this notebook have numbers of one's own.

    A small file beside the progress keeps the name. An exercise that is asked for with another ``student`` has the
    numbers of that one.

    Arguments:
        name: as "Mira"; None forgets the name. Without one, or with dots in its place, all stays as it is.
    Raises:
        ExerciseError: for what is no name.

    >>> student("")
    Traceback (most recent call last):
    exercisebook.errors.ExerciseError: student is an empty text: expected a name, as in student('Mira')
    """
    try:
        if name is None:
            naming.forget()
        elif name is not ...:
            naming.keep(name)
    except (OSError, ValueError) as error:
        raise ExerciseError(str(error)) from None
    return naming.Student(naming.known())
