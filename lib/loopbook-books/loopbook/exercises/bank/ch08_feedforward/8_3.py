"""Python beside the page of exercise 8.3."""

import numpy as np

from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.transfer import first_order, initial_gain, simplified, static_gain  # noqa: F401


def picture(K, T, tau, K_d, T_d, tau_d):
    """Steam valve and milk flow act on the temperature, each through its own transfer function; the two are added."""
    G = diagrams.block(rf"\frac{{{float(K):g}}}{{{T}s+1}}e^{{-{tau}s}}")
    G_d = diagrams.block(rf"\frac{{-{K_d}}}{{{T_d}s+1}}e^{{-{tau_d}s}}")
    return diagrams.block_diagram("u", G, diagrams.disturbance("d", G_d), "y")


def solution_picture(F_fd, rise, wait, T_d, u_end):
    """What the feedforward adds to the control signal after the step of the milk flow."""
    times = np.linspace(0, float(wait + 4 * T_d), 400)
    u = System(rise * F_fd).step(times)
    return time_plot({"feedforward [%]": (u, "control signal")}, times, low=True).level(u_end, "in the end")
