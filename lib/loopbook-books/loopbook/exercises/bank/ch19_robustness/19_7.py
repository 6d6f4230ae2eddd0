"""The runs of exercise 19.7."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.exercises import authoring
from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.stability import is_closed_loop_stable
from loopbook.transfer import feedback, first_order


def dead_time(value, what):
    """A dead time that is read off the figure."""
    return authoring.number(value, "min", what, within=0.04)


def _loop(K, T, delay, model, T_c):
    """Process and controller: a Smith predictor whose model has another dead time."""
    inner = first_order(K, T) - first_order(K, T, model)
    return first_order(K, T, delay), feedback(PID(T / (K * T_c), Ti=T).expr, inner)


def run(K, T, delay, model, T_c, step):
    """The step of the setpoint, exactly as the loop makes it: times, output and control signal."""
    times = np.linspace(0, 4 * float(delay), 481)
    found = Loop(*_loop(K, T, delay, model, T_c)).run(times, setpoint=step)
    return times, found["y"], found["u"]


def first_moved(t, y):
    """When the output has last been at rest."""
    return t[np.flatnonzero(np.abs(y) > 1e-9)[0] - 1]


def is_stable(K, T, delay, model, T_c):
    """Whether the loop with the wrong model is stable."""
    process, controller = _loop(K, T, delay, model, T_c)
    return is_closed_loop_stable(process * controller)


def picture(t, y, u, step):
    """Output and control signal after the step of the setpoint: the output begins late, overshoots and oscillates."""
    panels = [{"$y$": (y, "measurement"), "setpoint": (step, "setpoint")}, {"$u$": (u, "control signal")}]
    plot = time_plot(panels, t, xlabel="$t$ [min]", ylabel=["output [%]", "control signal [%]"])
    for axes in plot.figure.axes:
        axes.minorticks_on()
        axes.grid(which="minor", axis="x", linewidth=0.3)
    return plot


def solution_picture(K, T, delay, model, T_c, step, t, y, T_safe):
    """The same response beside that of a predictor with the safe time constant."""
    _, calm, _ = run(K, T, delay, model, T_safe, step)
    curves = {f"$T_C$ = {float(T_c):g} min": y, f"$T_C$ = {float(T_safe):g} min": calm, "setpoint": (step, "setpoint")}
    return time_plot(curves, t, xlabel="$t$ [min]", ylabel="output [%]", low=True)
