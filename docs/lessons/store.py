"""The lessons by name with their places, and what they have computed, kept until the code changes."""

import concurrent.futures
import hashlib
import importlib
import json
import os
from pathlib import Path
from typing import NamedTuple

from loopbook.validation import did_you_mean


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
NAMES = tuple(PLACES)

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KEPT = ROOT / "build" / "lessons"


def load(name):
    """Return the `Lesson` of a name.

    Raises ValueError for a name that no lesson has.
    """
    if name not in NAMES:
        raise ValueError(f"there is no lesson {name!r}: {did_you_mean(name, NAMES)}")
    return importlib.import_module(f"lessons.{name}").LESSON


def code_of(name):
    """A short text that changes with the code of a lesson and of the library."""
    files = sorted([*(ROOT / "lib" / "loopbook").rglob("*.py"), *map(HERE.joinpath, ("lesson.py", f"{name}.py"))])
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def computed(name):
    """Return the data of one lesson as JSON, from the last time if the code is still the same."""
    kept = KEPT / f"{name}-{code_of(name)}.json"
    if kept.exists():
        return kept.read_text(encoding="utf-8")
    text = json.dumps(load(name).data(), ensure_ascii=False, separators=(",", ":"))
    KEPT.mkdir(parents=True, exist_ok=True)
    for old in KEPT.glob(f"{name}-*.json"):
        old.unlink(missing_ok=True)
    being_written = kept.with_suffix(f".{os.getpid()}")
    being_written.write_text(text, encoding="utf-8")
    being_written.replace(kept)  # in one step, since two builds may run at once
    return text


def data(names=NAMES):
    """Return {name: JSON of the lesson's data}, computed on all the processors where it is not kept.

    Raises ValueError for a name that no lesson has.
    """
    for name in names:
        load(name)
    if all((KEPT / f"{name}-{code_of(name)}.json").exists() for name in names):
        return {name: computed(name) for name in names}
    with concurrent.futures.ProcessPoolExecutor(min(len(names), os.cpu_count() or 1)) as pool:
        return dict(zip(names, pool.map(computed, names), strict=True))
