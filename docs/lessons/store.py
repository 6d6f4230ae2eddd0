"""The lessons by name with their places: made by hand and kept until their code changes, or recorded from a cell."""

import concurrent.futures
import functools
import hashlib
import importlib
import json
import os
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from plainmath.validation import did_you_mean


class Place(NamedTuple):
    """The chapter of a lesson, and the beginning of the heading whose part "Try it" it follows."""

    chapter: str
    section: str


PLACES = {
    "pi": Place("07_feedback", "Example 7.5"),
    "good_gain": Place("10_tuning", "Example 10.1"),
    "half_rule": Place("14_model_approximation", "How good is a reduced model?"),
    "smith": Place("17_dead_time_compensation", "Section 7.4"),
    "windup": Place("07_feedback", "Example 7.4"),
    "cascade": Place("11_control_structures", "Example 11.1"),
}

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KEPT = ROOT / "build" / "lessons"
RECORDED = HERE / "recorded"


@dataclass(frozen=True)
class Recorded:
    """A lesson that is a cell with sliders of a chapter, and its words out of words.toml.

    Attributes:
        name: of the lesson, and of its file in recorded/.
        chapter, function: where the cell is, and what its function is called.
        title, about, questions: as of `lesson.Lesson`; the text of the chapter above the cell has most of them.
        typed: texts to choose from where the cell has a field to type in.
    """

    name: str
    chapter: str
    function: str
    title: str
    about: str = ""
    questions: tuple = ()
    typed: tuple = ()

    @property
    def file(self):
        """Where it is stored."""
        return RECORDED / f"{self.name}.json"

    def record(self):
        """Return what is stored of it: its sliders and its data.

        Raises ValueError where it has not been recorded.
        """
        if not self.file.exists():
            raise ValueError(f"the lesson {self.name!r} is not recorded: run make execute")
        return json.loads(self.file.read_text(encoding="utf-8"))


@functools.cache
def recorded():
    """The recorded lessons by name, in the order of the book."""
    written = tomllib.loads((HERE / "words.toml").read_text(encoding="utf-8"))
    return {
        name: Recorded(
            name,
            told.pop("chapter"),
            told.pop("function", name),
            questions=tuple(told.pop("try", ())),
            typed=tuple(told.pop("typed", ())),
            **told,
        )
        for name, told in written.items()
    }


def of_cell(chapter, source):
    """The recorded lesson of a cell of a chapter, or None."""
    found = re.search(r"^@sliders\(.*?^def (\w+)", source, re.MULTILINE | re.DOTALL)
    place = (chapter, found[1]) if found else None
    return next((lesson for lesson in recorded().values() if (lesson.chapter, lesson.function) == place), None)


def names():
    """The names of all lessons."""
    return (*PLACES, *recorded())


def load(name):
    """Return the lesson of a name, a `lesson.Lesson` or a `Recorded` one.

    Raises ValueError for a name that no lesson has.
    """
    if name in PLACES:
        return importlib.import_module(f"lessons.{name}").LESSON
    if name not in recorded():
        raise ValueError(f"there is no lesson {name!r}: {did_you_mean(name, names())}")
    return recorded()[name]


def titles():
    """All lessons as (chapter, name, title), chapter by chapter."""
    of_hand = [(place.chapter, name, load(name).title.removeprefix("Live: ")) for name, place in PLACES.items()]
    others = [(lesson.chapter, name, lesson.title) for name, lesson in recorded().items()]
    return sorted(((c, n, title[0].upper() + title[1:]) for c, n, title in others + of_hand), key=lambda told: told[0])


def code_of(name):
    """A short text that changes with the code of a lesson made by hand, and of the library."""
    files = sorted([*(ROOT / "lib" / "loopbook" / "loopbook").rglob("*.py"), *HERE.glob("*.py")])
    digest = hashlib.sha256(name.encode())
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def computed(name):
    """Return the record of one lesson as JSON; one made by hand is computed again where the code has changed."""
    if name not in PLACES:
        return json.dumps(load(name).record(), ensure_ascii=False, separators=(",", ":"))
    kept = KEPT / f"{name}-{code_of(name)}.json"
    if kept.exists():
        return kept.read_text(encoding="utf-8")
    text = json.dumps(load(name).record(), ensure_ascii=False, separators=(",", ":"))
    KEPT.mkdir(parents=True, exist_ok=True)
    for old in KEPT.glob(f"{name}-*.json"):
        old.unlink(missing_ok=True)
    being_written = kept.with_suffix(f".{os.getpid()}")
    being_written.write_text(text, encoding="utf-8")
    being_written.replace(kept)  # in one step, since two builds may run at once
    return text


def data(wanted=None):
    """Return {name: JSON of the lesson's record}, computed on all the processors where it is not kept.

    Raises ValueError for a name that no lesson has.
    """
    wanted = names() if wanted is None else wanted
    for name in wanted:
        load(name)
    by_hand = [n for n in wanted if n in PLACES and not (KEPT / f"{n}-{code_of(n)}.json").exists()]
    if by_hand:
        with concurrent.futures.ProcessPoolExecutor(min(len(by_hand), os.cpu_count() or 1)) as pool:
            list(pool.map(computed, by_hand))
    return {name: computed(name) for name in wanted}
