"""Python beside the page of exercise 4.3."""

import numpy as np
from sympy import exp

from loopbook.expressions import t
from loopbook.figures import time_plot
from loopbook.laplace import initial_value, inverse  # noqa: F401


def solution_picture(y, A, B, p, q):
    """The concentration and its two parts: one dies out soon, and then only the slow one is left."""
    curves = {"$y(t)$": y, "the slow part": A * exp(-p * t), "the fast part": B * exp(-q * t)}
    return time_plot(curves, np.linspace(0, 3 / float(p), 201), xlabel="$t$ [min]", ylabel="[mg/L]")
