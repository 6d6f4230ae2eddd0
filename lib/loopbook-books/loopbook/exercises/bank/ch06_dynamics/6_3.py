"""Python beside the page of exercise 6.3."""

import numpy as np

from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.transfer import dead_time, first_order, series  # noqa: F401


def after(H, time):
    """The step response at a moment, by simulation."""
    return System(H).step(np.array([0, float(time)]))[-1]


def picture(V, V_pipe, F):
    """Brine flows through a stirred tank and then through a long pipe."""
    stirred, pipe = diagrams.tank(f"${V}$ L", stirrer=True), f"Pipe\n${V_pipe}$ L"
    layout = """
        F   tank  pipe  c"""
    names = {"F": f"${F}$ L/min", "c": "out"}
    return diagrams.instrumentation_diagram(layout, "F tank pipe c", "", {"tank": stirred, "pipe": pipe}, names)


def solution_picture(T, delay, t_half, factor, less):
    """The share of the change at the end of the pipe against time, with the flow as it is and with less flow."""
    T, delay, slower = float(T), float(delay), float(factor)
    times = np.linspace(0, slower * (delay + 4 * T), 400)
    curves = {"flow as it is": 1, f"{less} % less": slower}
    rises = {name: np.maximum(0, 1 - np.exp(-(times / k - delay) / T)) for name, k in curves.items()}
    plot = time_plot(rises, times, xlabel="$t$ [min]", ylabel="share of the change", low=True)
    return plot.mark(t_half, "half")
