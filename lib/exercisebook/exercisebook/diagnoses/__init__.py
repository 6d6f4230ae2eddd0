"""Diagnoses: what mistake a wrong answer shows, in every exercise and without a word of its author.

`explained` is the one question. Each module knows one kind of answers and registers there: `numbers` has the table of
the mistakes in a number, on which `rows` and `settings` build; `formulas` changes the key in one place after another
and compares, and `facts` says what of a formula is right; `words` says which of several are.

A sentence is either exactly true ("that is what comes out with 4 s and 9 s interchanged") or a question; none tells
the answer.
"""

from __future__ import annotations

import importlib
import pkgutil

from exercisebook.diagnoses.background import Background
from exercisebook.diagnoses.finding import Finding, explained, followed, swapped

for _module in pkgutil.iter_modules(__path__):  # a module for a kind of answers registers by itself
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["Background", "Finding", "explained", "followed", "swapped"]
