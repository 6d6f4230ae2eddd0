"""Diagrams: of blocks and signals, of plants with their instruments, of machines, of circuits; all with one look."""

from loopbook.diagrams.blocks import (
    block,
    block_diagram,
    delay,
    disturbance,
    division,
    elementary_blocks,
    equivalent_diagrams,
    feedback_loop,
    gain,
    integrator,
    multiplication,
    overall_diagram,
    parallel_paths,
    sum_of,
    switch,
)
from loopbook.diagrams.circuits import (
    current_loop,
    kirchhoff_laws,
    rc_circuit,
    resistor_combinations,
    two_terminal_components,
    voltage_divider,
)
from loopbook.diagrams.conductors import CONDUCTORS, SIGNALS, conductor
from loopbook.diagrams.conveying import conveyor, feed_screw
from loopbook.diagrams.exchangers import EXCHANGERS, HEATERS, heat_exchanger, heater
from loopbook.diagrams.grid import grid_diagram
from loopbook.diagrams.instrument_symbols import DEVICES, PLACES, instrument
from loopbook.diagrams.instrumentation import instrumentation_diagram
from loopbook.diagrams.machines import conveyor_belt, hoist, mass_spring_damper, motor_with_load, widening_tank
from loopbook.diagrams.rotating import COMPRESSORS, FANS, PUMPS, compressor, fan, motor, pump, turbine
from loopbook.diagrams.sequences import sequential_function_chart
from loopbook.diagrams.states import state_diagram
from loopbook.diagrams.symbols import symbol_table
from loopbook.diagrams.tanks import ROOFS, cyclone, silo, tank, vessel
from loopbook.diagrams.valves import ACTUATORS, VALVES, control_valve, valve

__all__ = [
    "ACTUATORS", "COMPRESSORS", "CONDUCTORS", "DEVICES", "EXCHANGERS", "FANS", "HEATERS", "PLACES", "PUMPS", "ROOFS",
    "SIGNALS", "VALVES", "block", "block_diagram", "compressor", "conductor", "control_valve", "conveyor",
    "conveyor_belt", "current_loop", "cyclone", "delay", "disturbance", "division", "elementary_blocks",
    "equivalent_diagrams", "fan", "feed_screw", "feedback_loop", "gain", "grid_diagram", "heat_exchanger", "heater",
    "hoist", "instrument", "instrumentation_diagram", "integrator", "kirchhoff_laws", "mass_spring_damper", "motor",
    "motor_with_load", "multiplication", "overall_diagram", "parallel_paths", "pump", "rc_circuit",
    "resistor_combinations", "sequential_function_chart", "silo", "state_diagram", "sum_of", "switch", "symbol_table",
    "tank", "turbine", "two_terminal_components", "valve", "vessel", "voltage_divider", "widening_tank",
]  # fmt: skip
