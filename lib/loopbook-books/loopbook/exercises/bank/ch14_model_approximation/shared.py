"""What several pages of chapter 14 need."""

import numpy as np

from loopbook import System
from loopbook.figures import time_plot


def times_until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def beside(systems, end, title, xlabel="$t$ [min]", ylabel="share of the step"):
    """The step responses of a process and its models."""
    times, roles = times_until(end), ("process", "model", "second model", "third model")
    curves = {name: (System(H).step(times), role) for (name, H), role in zip(systems.items(), roles, strict=False)}
    return time_plot(curves, times, title, xlabel, ylabel)
