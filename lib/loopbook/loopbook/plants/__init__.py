"""The books' physical processes, each stated once: by its quantities and its laws.

A plant is a class whose body is the physics: a line for each signal and parameter, with value, unit and meaning, and a
line for each balance. The equations, the state-space model, the static response, the linear model, the transfer
functions and the simulation (`loopbook.simulation`) are all derived from these.

Signals are functions of time, ``T(t)``, parameters are symbols. ``HeatedTank.m`` is the symbol, ``HeatedTank(m=80).m``
the number. A new class in a module here is offered by the package, and found by the tests, through the module's list.
"""

import importlib
import pkgutil

# the names are here for editors and type checkers
from loopbook.plants.batch import *
from loopbook.plants.circuits import *
from loopbook.plants.declarations import *
from loopbook.plants.flows import *
from loopbook.plants.heat import *
from loopbook.plants.material import *
from loopbook.plants.motion import *
from loopbook.plants.plant import *
from loopbook.plants.plantwide import *
from loopbook.plants.process import *
from loopbook.plants.reactor import *
from loopbook.plants.separators import *

__all__: list[str] = []
# a plant in a module of its own is found by itself
for _module in pkgutil.iter_modules(__path__):  # noqa: F405
    _found = importlib.import_module(f"{__name__}.{_module.name}")
    globals().update({name: getattr(_found, name) for name in _found.__all__})
    __all__ += _found.__all__
