"""What other packages add: kinds of answers, names of quantities, diagnoses."""

from __future__ import annotations

import functools
from importlib import import_module, metadata
from pathlib import Path

GROUP = "exercisebook.plugins"


@functools.cache
def load() -> None:
    """Import the modules that installed packages name in their entry points, so that they register what they add."""
    for plugin in metadata.entry_points(group=GROUP):
        plugin.load()


def folders() -> list[Path]:
    """Return the folders with the modules of this package, of what it stands on, and of the packages of plug-ins."""
    names = {"exercisebook", "plainmath"}
    names |= {plugin.module.partition(".")[0] for plugin in metadata.entry_points(group=GROUP)}
    return sorted({Path(folder) for name in names for folder in import_module(name).__path__})
