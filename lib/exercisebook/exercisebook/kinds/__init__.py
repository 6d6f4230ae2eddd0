"""The kinds of asked quantities: how an answer is read, compared with the key, and responded to.

A kind is a class in a module of this package and nothing else: `MAKERS` has all of them by the names that authors use.
"""

import importlib
import pkgutil

from exercisebook.kinds.design import Criterion, Design
from exercisebook.kinds.formula import Expression, TimeFunction
from exercisebook.kinds.kind import MAKERS, Kind
from exercisebook.kinds.numeric import Number, Numbers, Poles
from exercisebook.kinds.words import Word, Words

for _module in pkgutil.iter_modules(__path__):  # a kind in a module of its own is found by itself
    importlib.import_module(f"{__name__}.{_module.name}")
globals().update({kind.__name__: kind for kind in MAKERS.values()})

__all__ = [
    "MAKERS", "Criterion", "Design", "Expression", "Kind", "Number", "Numbers", "Poles", "TimeFunction", "Word",
    "Words",
]  # fmt: skip
