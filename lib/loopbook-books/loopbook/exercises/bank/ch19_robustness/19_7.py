"""The runs of exercise 19.7."""

import cmath
import functools

import numpy as np
import sympy

from loopbook import PID, Loop, closed_loop, first_order
from loopbook.figures import time_plot


def loop(K, T, delay, model, T_c):
    """A Smith predictor whose model has another dead time."""
    pid = PID(T / (K * T_c), T)
    return Loop(first_order(K, T, delay), closed_loop(pid, first_order(K, T) - first_order(K, T, model)))


@functools.lru_cache(maxsize=8)
def run(K, T, delay, model, T_c, step):
    """The step of the setpoint, exactly as the loop makes it: times, output and control signal."""
    times = np.linspace(0, 4 * float(delay), 481)
    it = loop(K, T, delay, model, T_c)
    return times, float(step) * it.servo.step(times), float(step) * it.setpoint_to_control.step(times)


def first_moved(t, y):
    """When the output has last been at rest."""
    return t[np.flatnonzero(np.abs(y) > 1e-9)[0] - 1]


def added(M, delay, model):
    """The value of M at one point, given as text."""
    return complex(sympy.sympify(M).subs({"theta": delay, "theta_m": model, "s": 0.1 + 0.2j}))


def in_loop(K, T, delay, model, T_c):
    """What the loop has there beside T_C s + 1 in its characteristic equation."""
    s = 0.1 + 0.2j
    return cmath.exp(-s * delay) / loop(K, T, delay, model, T_c).servo(s) - T_c * s - 1


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
