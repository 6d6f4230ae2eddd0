"""The exercises of the chapters, a module each, loaded when one of them is asked for."""

from __future__ import annotations

import functools
import importlib
import inspect
import itertools
import pkgutil
import re
from types import ModuleType

from loopbook.exercises.authoring import Exercise


@functools.cache
def chapters() -> dict[str, str]:
    """Return the names of the modules by their chapters, in order: {"1": "ch01_introduction", ...}."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name.startswith("ch"))
    return {name[2:].split("_")[0].lstrip("0"): name for name in names}


@functools.cache
def exercises(chapter: str) -> dict[str, Exercise]:
    """Return the exercises of a chapter in their order: {number: `Exercise`}. Raises KeyError for no chapter."""
    return collected(importlib.import_module(f"{__name__}.{chapters()[chapter]}"))


def title(chapter: str) -> str:
    """Return number and title of a chapter, from the first line of its module. Raises KeyError for no chapter.

    >>> title("15")
    '15 · Direct synthesis'
    """
    module = importlib.import_module(f"{__name__}.{chapters()[chapter]}")
    words = re.match(r"Exercises of \w+ \w+, (.+?)[.:]", inspect.getdoc(module))[1]
    return f"{chapter} · {words[0].upper()}{words[1:]}"


def collected(module: ModuleType) -> dict[str, Exercise]:
    """Return the exercises that a module defines: {number: `Exercise`}. Raises ValueError where two have a number."""
    found = {}
    for one in vars(module).values():
        if isinstance(one, Exercise):
            if one.number in found:
                raise ValueError(f"there are two exercises {one.number} in {module.__name__}: expected one")
            found[one.number] = one
    for one, following in itertools.pairwise(found.values()):
        one.then = following.heading
    return found
