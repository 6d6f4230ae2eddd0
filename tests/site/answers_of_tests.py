"""The answers that the tests give to exercises, written down, so that another Python can judge them too.

Some of them are made here, of the bank: keys in many forms, wrong answers, mistakes, and what is no answer. All of them
are recorded while the tests run: as a plugin of pytest (``-p answers_of_tests``) this module writes each answer that
comes to a judge into the file that ``LOOPBOOK_RECORD`` names.
"""

import functools
import os
import pickle
import pickletools
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from exercisebook import judging, question
from judged import NOT_TO_BE_JUDGED
from loopbook.exercises import bank

TESTS = Path(__file__).parents[1]
RECORD = "LOOPBOOK_RECORD"
#: Whose objects are the same in the other Python; those of a test, and Python's own functions, stay here.
PORTABLE = {
    "_codecs", "_operator", "builtins", "collections", "complex", "copyreg", "datetime", "decimal", "fractions",
    "functools", "loopbook", "mpmath", "numpy", "operator", "scipy", "sympy",
}  # fmt: skip


def portable(*given: object) -> bytes | None:
    """Return answers pickled; None where there is something among them that only this Python has.

    >>> portable(2.5) is None, portable(lambda: 1) is None
    (False, True)
    """
    try:
        content = pickle.dumps(given if len(given) > 1 else given[0], protocol=4)
        pickle.loads(content)
    except Exception:  # an answer may be anything
        return None
    known = [""]  # the texts in it: the name of a module comes just before that of what is taken from it
    for code, about, _ in pickletools.genops(content):
        if code.name == "STACK_GLOBAL" and not any(text.partition(".")[0] in PORTABLE for text in known[-2:-1]):
            return None
        if isinstance(about, str):
            known.append(about)
    return content


# ---- of the bank


def of_bank(count: int, seed: int) -> list[tuple]:
    """Return so many answers to exercises of the bank, as `in_browser.judged` takes them, as many of each kind."""
    drawn, by_kind = random.Random(seed), {}
    chosen = [(number, exercise) for chapter in bank.chapters() for number, exercise in bank.exercises(chapter).items()]
    drawn.shuffle(chosen)
    for number, exercise in chosen:
        for name, kind in exercise.question().key.items():
            by_kind.setdefault(kind.maker, []).append((number, name))
    found = []
    for asked in by_kind.values():
        answers = [one for number, name in asked[:12] for one in of_exercise(number, name)]
        found += drawn.sample(answers, min(len(answers), -(-count // len(by_kind))))
    return found


def of_exercise(number: str, name: str) -> Iterator[tuple]:
    """Yield answers to a quantity of an exercise: right, wrong, mistaken, and some that are none at all."""
    asked = bank.exercises(number.partition(".")[0])[number].question()
    kind = asked.key[name]
    given = [one for _, one in (*kind.right_forms(), *kind.wrong_forms(), *asked.mistakes[name])]
    given += [none for place, none in enumerate(NOT_TO_BE_JUDGED.values()) if place % 4 == len(number) % 4]
    for one in given:
        if content := portable((), {name: one}):
            yield "check", number, None, content


# ---- of all tests


def of_all(folder: Path) -> list[tuple]:
    """Return all answers that the tests of exercises give and that another Python can have; it takes minutes."""
    tested = {*TESTS.glob("exercisebook/test_*.py"), *TESTS.glob("books/test_exercise*.py")}
    forms = {TESTS / "exercisebook" / "test_exercise_forms.py", TESTS / "books" / "test_exercise_pages.py"}
    masked = {TESTS / "exercisegrader/slow/test_masked_answers.py", TESTS / "books_grading/test_masked_in_books.py"}
    files = sorted((tested - forms) | masked)
    places = os.pathsep.join([str(Path(__file__).parent), str(TESTS)])
    environment = os.environ | {RECORD: str(folder / "recorded"), "PYTHONPATH": places}
    environment.pop("LOOPBOOK_ALL", None)
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "answers_of_tests",
        "-p",
        "no:cacheprovider",
        "-o",
        "addopts=",
    ]
    run = subprocess.run(
        [*command, *map(str, files)], cwd=TESTS.parent, env=environment, capture_output=True, text=True
    )
    if run.returncode:
        raise RuntimeError(f"the tests whose answers are recorded fail: {run.stdout[-2000:]}")
    with (folder / "recorded").open("rb") as file:
        return pickle.load(file)


class _Recorder:
    """Wraps what judges, and keeps what comes to it from outside."""

    def __init__(self):
        self.seen: dict[tuple, None] = {}
        self.inside = False  # of an exercise of the bank, whose answers are kept as a whole
        self.known = {number: one for chapter in bank.chapters() for number, one in bank.exercises(chapter).items()}

    def install(self):
        judge, is_right, check = judging.judge, judging.is_right, question.Question.check

        @functools.wraps(judge)
        def judged(name, kind, given, mistakes=(), background=None):
            if not self.inside and (making := _making(kind)):
                self._keep("judge", name, *making, given=(given, list(mistakes)))
            return judge(name, kind, given, mistakes, background)

        @functools.wraps(is_right)
        def was_right(kind, given):
            if not self.inside and (making := _making(kind)):
                self._keep("is right", *making, given=(given,))
            return is_right(kind, given)

        @functools.wraps(check)
        def checked(asked, /, *alone, **named):
            number = asked.exercise.number
            if self.inside or self.known.get(number) is not asked.exercise:
                return check(asked, *alone, **named)
            self._keep("check", number, asked.student, given=(alone, named))
            self.inside = True
            try:
                return check(asked, *alone, **named)
            finally:
                self.inside = False

        judging.judge = question.judge = judged
        judging.is_right = question.is_right = was_right
        question.Question.check = checked

    def _keep(self, *what, given):
        if content := portable(*given):
            self.seen.setdefault((*what, content))

    def write(self):
        Path(os.environ[RECORD]).write_bytes(pickle.dumps(list(self.seen), protocol=4))


def _making(kind):
    """The code that makes a kind, and what it draws from; nothing where no code says it."""
    try:
        return (kind.making, kind.seed) if kind.making else None
    except ValueError:
        return None


_recorder = _Recorder() if RECORD in os.environ else None


def pytest_configure():
    if _recorder:
        _recorder.install()


def pytest_sessionfinish():
    if _recorder:
        _recorder.write()
