"""Python beside the page of exercise 3.3."""

import numpy as np
import sympy
from sympy import diff  # noqa: F401

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.expressions import t
from loopbook.figures import time_plot


def picture(V, q, c_in):
    """A stirred tank of {V}: {q} flow in with {c_in} of waste, and {q} flow out with the concentration c."""
    layout = """
        in  1     .     .
        .   pond  pond  .
        .   pond  pond  out"""
    names = {"in": f"${written(q)}$ m³/h with ${written(c_in)}$ g/m³", "out": f"${written(q)}$ m³/h with $c$"}
    water = draw.tank(f"${written(V)}$ m³", stirrer=True)
    return draw.instrumentation_diagram(layout, "in 1 pond out", "", {"pond": water}, names)


def solution_picture(V, q, c_in, T, c):
    """The concentration with bacteria, and what it would be without them: higher in the end, and later."""
    curves = {"with bacteria": c, "without": c_in * (1 - sympy.exp(-t * q / V))}
    times = np.linspace(0, 4 * float(V / q), 201)
    return time_plot(curves, times, xlabel="$t$ [h]", ylabel="$c$ [g/m³]").mark(T, "$T$", signal="with bacteria")
