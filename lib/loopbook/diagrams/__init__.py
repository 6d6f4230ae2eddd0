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
from loopbook.diagrams.circuits import kirchhoff_laws, rc_circuit, resistor_combinations, two_terminal_components
from loopbook.diagrams.grid import grid_diagram
from loopbook.diagrams.instrumentation import (
    compressor,
    control_valve,
    conveyor,
    fan,
    feed_screw,
    heat_exchanger,
    heater,
    instrument,
    instrumentation_diagram,
    motor,
    pump,
    tank,
    turbine,
    valve,
    vessel,
)
from loopbook.diagrams.machines import conveyor_belt, mass_spring_damper, motor_with_load

__all__ = [
    "block", "block_diagram", "compressor", "control_valve", "conveyor", "conveyor_belt", "delay",
    "disturbance", "division", "elementary_blocks", "equivalent_diagrams", "fan", "feed_screw", "feedback_loop", "gain",
    "grid_diagram", "heat_exchanger", "heater", "instrument", "instrumentation_diagram", "integrator", "kirchhoff_laws",
    "mass_spring_damper", "motor", "motor_with_load", "multiplication", "overall_diagram", "parallel_paths", "pump",
    "rc_circuit", "resistor_combinations", "sum_of", "switch", "tank", "turbine", "two_terminal_components", "valve",
    "vessel",
]  # fmt: skip
