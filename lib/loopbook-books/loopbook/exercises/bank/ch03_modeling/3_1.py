"""Python beside the page of exercise 3.1."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(A, h, h_max, q_1, q_2, q_o):
    """A tank of {A} with the level {h} and the rim at {h_max}: {q_1} and {q_2} come in, a pump takes {q_o} out."""
    layout = """
        first  1     2     second  .
        .      tank  tank  rim     .
        .      tank  tank  .       .
        .      tank  tank  pump    out"""
    water = draw.tank(f"${written(A)}$ m²", level=f"${written(h)}$ mm")
    names = {
        "first": f"${written(q_1)}$ L/min",
        "second": f"${written(q_2)}$ L/min",
        "rim": f"rim at\n${written(h_max)}$ mm",
        "out": f"${written(q_o)}$ L/min",
    }
    pipes = "first 1 tank pump out, second 2 tank"
    return draw.instrumentation_diagram(layout, pipes, "", {"tank": water, "pump": draw.pump()}, names)
