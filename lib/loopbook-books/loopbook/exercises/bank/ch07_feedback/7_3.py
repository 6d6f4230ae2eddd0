"""Python beside the page of exercise 7.3."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.transfer import step_response  # noqa: F401

from_panel = PID.from_panel


def solution_picture(u_0, jump, u, T_i):
    """The control signal after the error has jumped: a jump, then a ramp that repeats it in each integral time."""
    times = np.linspace(0, float(max(60, T_i)), 121)
    curves = {"$u$": (u, "control signal"), "without integral term": (u_0 + jump, 0)}
    axes = {"ylabel": "$u$ [%]", "ylim": (u_0, u_0 + jump * (2.2 + times[-1] / T_i)), "low": True}
    return time_plot(curves, times, **axes).mark(T_i, "first repeat, after $T_i$", "$u$")
