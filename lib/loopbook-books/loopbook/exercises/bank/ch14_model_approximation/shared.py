"""What several pages of chapter 14 need."""

import numpy as np
from sympy import Eq, Function

from loopbook.deadtime import System
from loopbook.expressions import s
from loopbook.figures import time_plot


def equation(H):
    """The equation g(s) = H(s)."""
    return Eq(Function("g")(s), H, evaluate=False)


def times_until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def beside(systems, times, title, xlabel="$t$ [min]", ylabel="share of the step"):
    """The step responses of a process and its models."""
    roles = ("process", "model", "second model", "third model")
    curves = {name: (System(H).step(times), role) for (name, H), role in zip(systems.items(), roles, strict=False)}
    return time_plot(curves, times, title, xlabel, ylabel)
