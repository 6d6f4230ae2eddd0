"""Assignments: pages of exercises, or a Python module in their format, and the variants that it gives to students.

Above the pages stand title and introduction, and a block of TOML with the secret that the variants are drawn from. Of a
module its docstring is title and introduction, and `SECRET` is that.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import importlib.metadata
import inspect
import keyword
import re
import secrets
import sys
import traceback
import types
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

from exercisebook.authoring import Credit, Exercise, Late, collected
from exercisebook.credit import NOTHING
from exercisebook.pages import page
from exercisebook.pages.parts import PageError
from exercisebook.parameters import of_text
from exercisegrader import GradingError
from exercisegrader.lateness import Policy, policy_of, without_dates
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.question import Question

SHORTEST_SECRET = 16
#: What the secrets of the documentation and of the examples contain, which everybody knows.
DOCUMENTED = ("of-your-own", "everybody-may-read")
#: The ending of a file with pages, and what its block of TOML may say.
PAGES, SETTINGS = ".md", ("secret", "due", "late", "credit")
_NUMBER = re.compile(r"\w[\w.-]{0,19}")


@dataclass(frozen=True)
class Assignment:
    """An assignment; `load` reads one from a file, `Assignment.of` makes one from a text.

    Attributes:
        name: the stem of the file, which the students' notebooks have too.
        title, introduction: from the docstring.
        secret: what the variants are drawn from.
        exercises: {number: `Exercise`}, in their order.
        source: the text of the file.
        path: of the file; None where it was made from a text.
        policy: when it is due and what it costs to be late, from `DUE` and `LATE`; None where there is no `DUE`.
        credit: what is worth something though it is not right, from `CREDIT`.
    """

    name: str
    title: str
    introduction: str
    secret: str
    exercises: dict[str, Exercise]
    source: str
    path: Path | None = None
    policy: Policy | None = None
    credit: Credit = NOTHING

    @classmethod
    def of(cls, source: str, name: str, path: Path | None = None) -> Self:
        """Return the assignment that a text is. That of a module is run: it is the instructor's.

        Arguments:
            source: the text of a module, or pages, as the ending of the path says.
            name: of the assignment.
            path: the file that it came from; modules beside it can be imported.
        Raises:
            GradingError: for a text that fails, or has no title, secret or exercises; with the line.

        >>> text = '''"Springs"
        ... SECRET = "a secret of many letters"
        ... from exercisebook.authoring import answers, between, exercise, number
        ... @exercise("1", title="A spring")
        ... def spring(k=between(100, 900, "N/m"), x=between(2, 9, "cm")):
        ...     "A spring of {k} is {x} longer than at rest. How large is the force in it?"
        ...     return answers(F=number(k * x / 100, "N", "the force"))
        ... '''
        >>> springs = Assignment.of(text, "springs")
        >>> springs.title, springs.question("s1001", "1").values == springs.question("s1002", "1").values
        ('Springs', False)
        """
        is_of_pages = path is not None and path.suffix == PAGES
        file = f"{name}{PAGES if is_of_pages else '.py'}"
        module = _paged(source, name, path) if is_of_pages else _run(source, name, path)
        title, _, introduction = inspect.cleandoc(module.__doc__ or "").partition("\n")
        if not title.strip():
            raise GradingError(f"{file} has no docstring: expected the title of the assignment in its first line")
        secret = getattr(module, "SECRET", None)
        if not (isinstance(secret, str) and len(secret) >= SHORTEST_SECRET):
            raise GradingError(
                f"{file} has no {'secret' if is_of_pages else 'SECRET'} of at least {SHORTEST_SECRET} characters, from "
                f"which the variants are drawn: write {'secret' if is_of_pages else 'SECRET'} = "
                f'"{secrets.token_hex(16)}" into it'
            )
        try:
            exercises = collected(module)
        except ValueError as problem:
            raise GradingError(f"{file}: {problem}") from None
        if not exercises:
            raise GradingError(
                f"{file} has no exercise: expected at least one, a page or a function with @exercise(...)"
            )
        for exercise in exercises.values():
            _check(exercise, file)
        credit = getattr(module, "CREDIT", NOTHING)
        if not isinstance(credit, Credit):
            raise GradingError(f"{file}: CREDIT is {credit!r}: expected one as Credit(unit=50, follows=50, mistake=25)")
        policy = policy_of(module, file)
        return cls(name, title.strip(), introduction.strip(), secret, exercises, source, path, policy, credit)

    @property
    def points(self) -> float:
        """The points of all exercises together."""
        return sum(exercise.points for exercise in self.exercises.values())

    @property
    def fingerprint(self) -> str:
        """A text that changes with the module and with this package's version; modules beside it are not part of it.

        What says when it is due is not part of it either: nothing is judged by that.
        """
        version, source = importlib.metadata.version("exercisegrader"), without_dates(self.source)
        return hashlib.sha256(f"{version}\n{source}".encode("utf-8", "surrogatepass")).hexdigest()

    def demand_own_secret(self) -> None:
        """Raise GradingError where the secret is one of the documentation, from which everybody can draw variants."""
        if any(part in self.secret for part in DOCUMENTED):
            raise GradingError(
                f"the secret of {self.name}, {self.secret!r}, stands in the documentation, and whoever knows it knows "
                f'everybody\'s numbers: expected one of your own, such as "{secrets.token_hex(16)}"'
            )

    @property
    def record(self) -> Path | None:
        """Where the numbers of its releases are kept: beside the module; None where it was made from a text."""
        return self.path and self.path.with_name(f"{self.name}.released.json")

    def question(self, student_id: str, number: str, values: Mapping[str, str] | None = None) -> Question:
        """Return a student's variant of an exercise, a `Question`, the same every time.

        Arguments:
            student_id: of the student.
            number: of the exercise.
            values: with which it was released, {parameter: text}, as `released.Released.numbers` has them; what is not
                among them is drawn from the secret.

        Raises GradingError for an unknown exercise, and where the author's functions fail.
        """
        if number not in self.exercises:
            raise GradingError(
                f"there is no exercise {number!r} in {self.name}: {did_you_mean(number, self.exercises)}"
            )
        drawn_from = hmac.new(self.secret.encode(), str(student_id).encode(), hashlib.sha256).hexdigest()
        exercise = self.exercises[number]
        try:
            if values is None:
                return exercise.question(drawn_from)
            return exercise.question_with(drawn_from, {name: of_text(text) for name, text in values.items()})
        except Exception as problem:  # the condition is the author's
            raise GradingError(f"exercise {number} of {self.name} for student {student_id}: {problem}") from problem


def load(path: str | Path) -> Assignment:
    """Return the assignment in a file. Raises GradingError in a sentence, with the line where the module fails."""
    path = Path(path)
    if path.suffix not in (PAGES, ".py"):
        raise GradingError(f"{path} is not an assignment: expected pages, as heater.md, or a Python module, heater.py")
    try:
        source = path.read_text(encoding="utf-8-sig")
    except OSError as problem:
        raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise GradingError(f"{path} is not text in UTF-8: expected one") from None
    return Assignment.of(source, path.stem, path)


def _paged(source, name, path):
    """What a module of these pages would hold."""
    file, module = f"{name}{PAGES}", types.ModuleType(f"assignment {name}")
    try:
        with _imported(module, path):
            front, exercises = page.of(source, file, page.beside(path))
        if front is None:
            raise PageError(file, 1, "there is no title above the exercises: expected one, as '# Filling tanks'")
        settings = dict(front.settings)
        if unknown := [word for word in settings if word not in SETTINGS]:
            raise PageError(file, 1, f"there is no setting {unknown[0]!r}: {did_you_mean(unknown[0], SETTINGS)}")
        if "late" in settings:
            settings["late"] = Late(**settings["late"])
        if "credit" in settings:
            settings["credit"] = Credit(**settings["credit"])
    except (TypeError, ValueError) as problem:
        raise GradingError(str(problem)) from None
    module.__doc__ = f"{front.title}\n{front.introduction}"
    vars(module).update({word.upper(): value for word, value in settings.items()} | exercises)
    return module


def _run(source, name, path):
    """The module of a text; while it runs, modules beside its file can be imported."""
    file = f"{name}.py"
    module = types.ModuleType(f"assignment {name}")
    try:
        with _imported(module, path):
            exec(compile(source, file, "exec"), vars(module))
    except SyntaxError as problem:
        where = f"line {problem.lineno}" if problem.filename == file else f"{problem.filename}, line {problem.lineno}"
        raise GradingError(f"{file}, {where}: {problem.msg}") from None
    except (Exception, SystemExit) as problem:
        lines = [frame.lineno for frame in traceback.extract_tb(problem.__traceback__) if frame.filename == file]
        where = f", line {lines[-1]}" if lines else ""
        says = " ".join(str(problem).split())
        raise GradingError(f"{file}{where}: {type(problem).__name__}{': ' if says else ''}{says}") from problem
    return module


@contextlib.contextmanager
def _imported(module, path):
    """While it runs, a module is among those that are imported, as data classes demand, and finds those beside it."""
    before, sys.modules[module.__name__] = sys.path, module
    sys.path = [*([str(path.resolve().parent)] if path else []), *before]
    try:
        yield
    finally:
        sys.path = before
        sys.modules.pop(module.__name__, None)


def _check(exercise, file):
    if not (isinstance(exercise, Exercise) and isinstance(exercise.number, str) and _NUMBER.fullmatch(exercise.number)):
        raise GradingError(
            f"{file}: the number of an exercise is {exercise.number!r}: expected a text such as '1' or '2b', of "
            "at most 20 letters, digits, dots and hyphens"
        )
    points = exercise.points
    if isinstance(points, bool) or not isinstance(points, int | float) or not 0 < points < float("inf"):
        raise GradingError(f"{file}: exercise {exercise.number} has {points!r} points: expected a positive number")


def check_names(question: Question) -> None:
    """Raise GradingError unless each asked quantity has a name that can be written in Python."""
    for name in question.key:
        if not name.isidentifier() or keyword.iskeyword(name):
            number = question.exercise.number
            raise GradingError(f"exercise {number} asks for {name!r}: expected a name that can be written in Python")
