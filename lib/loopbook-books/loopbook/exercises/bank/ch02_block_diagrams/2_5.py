"""Python beside the page of exercise 2.5."""

import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw


def tex(matrix):
    """A matrix as a formula."""
    return sympy.latex(sympy.Matrix(matrix))


def picture(T_1, T_2, K):
    """A block diagram of the two equations: two integrators, each in a loop of its own; {K} in front of the first one,
    division by {T_1} in the first loop and by {T_2} in the second one."""
    furnace, workpiece = (draw.feedback_loop([draw.division(written(T)), draw.integrator()]) for T in (T_1, T_2))
    return draw.block_diagram("u", draw.gain(written(K)), furnace, "x_1", workpiece, "x_2")
