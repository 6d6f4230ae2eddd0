"""Python beside the page of exercise 11.5."""

from loopbook import diagrams


def picture(A, F):
    """The flow diagram: the level controller acts on the valve in the outflow."""
    layout = """
        rain  1     .    h_SP  .
        .     tank  LT1  LC1   .
        .     tank  .    .     .
        .     2     .    V1    plant"""
    parts = {"V1": diagrams.control_valve(), "tank": diagrams.tank(text=f"{A}$\\,$m²", level="h")}
    names = {"rain": f"rain,$\\,${F} kg/s more"}
    pipes, signals = "rain 1 tank 2 V1 plant", "tank LT1 LC1 V1, h_SP LC1"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)
