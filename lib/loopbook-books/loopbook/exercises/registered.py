"""What control engineering adds to `exercisebook`: kinds of answers, what is found in wrong ones, and PID settings."""

import importlib
import pkgutil

from exercisebook.pages import formula
from loopbook.exercises import diagnoses, in_formulas, kinds

formula.LIBRARY |= in_formulas.LIBRARY

for _package in (kinds, diagnoses):  # what is in a module of its own is found by itself
    for _module in pkgutil.iter_modules(_package.__path__):
        importlib.import_module(f"{_package.__name__}.{_module.name}")
