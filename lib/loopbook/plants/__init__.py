"""The books' physical processes, each stated once: by its balance law.

A plant is a class whose body is the physics: the equations as the book writes them, and a table of the quantities with
their values and units. The state equations, the static response, the linear model, the transfer functions and the
simulation (`loopbook.simulation`) are all derived from these equations.

Signals are functions of time, ``T(t)``, parameters are letters. ``HeatedTank.m`` is the letter, ``HeatedTank(m=80).m``
the number.
"""

from loopbook.plants.batch import BatchTank
from loopbook.plants.circuits import (
    RCCircuit,
    capacitor,
    inductor,
    resistor,
    resistors_in_parallel,
    resistors_in_series,
)
from loopbook.plants.flows import BlendingStation
from loopbook.plants.heat import (
    AirHeater,
    AirHeaterWithFan,
    HeatedTank,
    HeatedTankWithElement,
    HeatedTankWithTransport,
    HeatExchanger,
    JacketedTank,
)
from loopbook.plants.material import BlendingTank, BufferTank, LiquidTank, WoodChipTank, WoodChipTankWithScale
from loopbook.plants.motion import MassSpringDamper, MotorWithLoad
from loopbook.plants.plant import Plant, Quantity, name_of, parameters, signals
from loopbook.plants.plantwide import AmmoniaEvaporator, FlashPlant
from loopbook.plants.process import Process
from loopbook.plants.reactor import JacketedReactor
from loopbook.plants.separators import TwoStageSeparator

__all__ = [
    "AirHeater", "AirHeaterWithFan", "AmmoniaEvaporator", "BatchTank", "BlendingStation", "BlendingTank",
    "BufferTank", "FlashPlant", "HeatExchanger", "HeatedTank", "HeatedTankWithElement", "HeatedTankWithTransport",
    "JacketedReactor", "JacketedTank", "LiquidTank", "MassSpringDamper", "MotorWithLoad", "Plant", "Process",
    "Quantity", "RCCircuit", "TwoStageSeparator", "WoodChipTank", "WoodChipTankWithScale", "capacitor", "inductor",
    "name_of", "parameters", "resistor", "resistors_in_parallel", "resistors_in_series", "signals",
]  # fmt: skip
