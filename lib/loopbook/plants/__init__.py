"""The books' physical processes, each stated once: by its quantities and its laws.

A plant is a class whose body is the physics: a line for each signal and parameter, with value, unit and meaning, and a
line for each balance. The equations, the state-space model, the static response, the linear model, the transfer
functions and the simulation (`loopbook.simulation`) are all derived from these.

Signals are functions of time, ``T(t)``, parameters are symbols. ``HeatedTank.m`` is the symbol, ``HeatedTank(m=80).m``
the number. A new class in a module here is offered by the package, and found by the tests, through the module's list.
"""

from loopbook.plants import (
    batch,
    circuits,
    declarations,
    flows,
    heat,
    material,
    motion,
    plant,
    plantwide,
    process,
    reactor,
    separators,
)
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

__all__ = [
    *batch.__all__, *circuits.__all__, *declarations.__all__, *flows.__all__, *heat.__all__, *material.__all__,
    *motion.__all__, *plant.__all__, *plantwide.__all__, *process.__all__, *reactor.__all__, *separators.__all__,
]  # fmt: skip
