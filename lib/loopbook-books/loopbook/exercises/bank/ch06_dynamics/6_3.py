"""Python beside the page of exercise 6.3."""

from loopbook import diagrams


def picture(V, V_pipe, F):
    """Brine flows through a stirred tank and then through a long pipe."""
    parts = {"tank": diagrams.tank(f"${V}$ L", stirrer=True), "pipe": f"Pipe\n${V_pipe}$ L"}
    layout = """
        F   tank  pipe  c"""
    names = {"F": f"${F}$ L/min", "c": "out"}
    return diagrams.instrumentation_diagram(layout, "F tank pipe c", "", parts, names)
