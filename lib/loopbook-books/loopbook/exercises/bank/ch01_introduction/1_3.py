"""Python beside the page of exercise 1.3."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(length, speed, u_0, w_0):
    """A feeder, a belt of {length} at {speed}, and a bunker, from which {w_0} leave; its level controller moves the
    feeder, with a control signal of {u_0}."""
    layout = """
        .       1       u     .     .       LC
        gravel  feeder  .     .     .       .
        .       belt    belt  belt  2       .
        .       .       .     .     bunker  LT
        .       .       .     .     3       out"""
    belt = draw.conveyor(f"${written(length)}$ m at ${written(speed)}$ m/s")
    parts = {"feeder": "Feeder", "belt": belt, "bunker": draw.silo()}
    names = {"u": f"${written(u_0)}\\,\\%$", "out": f"${written(w_0)}$ kg/s"}
    pipes, signals = "gravel feeder belt 2 bunker 3 out", "bunker LT LC u 1 feeder"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)
