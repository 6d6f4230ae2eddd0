"""Python beside the page of exercise 3.3."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(V, q, c_in):
    """A stirred tank of {V}: {q} flow in with {c_in} of waste, and {q} flow out with the concentration c."""
    layout = """
        in  1     .     .
        .   pond  pond  .
        .   pond  pond  out"""
    names = {"in": f"${written(q)}$ m³/h with ${written(c_in)}$ g/m³", "out": f"${written(q)}$ m³/h with $c$"}
    water = draw.tank(f"${written(V)}$ m³", stirrer=True)
    return draw.instrumentation_diagram(layout, "in 1 pond out", "", {"pond": water}, names)
