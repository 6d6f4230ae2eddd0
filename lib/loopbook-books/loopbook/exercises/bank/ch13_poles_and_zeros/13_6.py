"""The tank of exercise 13.6, and the design of its controller."""

from math import atan2, atanh, exp, inf, sin, sinh, sqrt

import numpy as np
import sympy

from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.exercises import authoring
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation

__all__ = ["calm", "damping", "highest", "picture"]


def damping(Kp, Ti, A):
    """The damping of a level under PI control, from its transfer function."""
    return oscillation(1 / (A * Ti * s**2 + Kp * Ti * s + Kp)).zeta


def highest(Kp, Ti, A, d):
    """The largest rise of the level [cm] in its exact response to a step of the inflow."""
    times = np.linspace(0, 4 * float(Ti), 4001)
    return 100 * float(d) * System(Ti * s / (A * Ti * s**2 + Kp * Ti * s + Kp)).step(times).max()


def _zeta(pid, A):
    Kp, Ti = float(pid.Kp), float(pid.Ti)
    return sqrt(Kp * Ti / A) / 2 if Kp > 0 and Ti > 0 else -inf


def _peak(pid, A, d):
    """The largest deviation of a level under PI control after a step d of the inflow, in closed form."""
    Kp, Ti = float(pid.Kp), float(pid.Ti)
    if Kp <= 0 or Ti <= 0:
        return inf
    if Ti == inf:
        return d / Kp
    w, zeta = sqrt(Kp / (A * Ti)), _zeta(pid, A)
    if abs(zeta - 1) < 1e-6:
        return d / (A * w * exp(1))
    root = sqrt(abs(zeta**2 - 1))
    x = (atanh(root / zeta) if zeta > 1 else atan2(root, zeta)) / root
    return d / (A * w * root) * exp(-zeta * x) * (sinh if zeta > 1 else sin)(root * x)


def calm(A, d, h_max, r_max, design):
    """A PI controller that keeps the limits of level and outflow, and whose level does not oscillate."""
    area, flow = float(A), float(d)

    def trends(pid):
        process, C = 1 / (A * s), pid.expr
        times = np.linspace(0, 4 * max(float(pid.Ti) if pid.Ti.is_finite else 0, float(A / pid.Kp)), 301)
        level = 100 * System(sympy.cancel(d * process / (1 + process * C))).step(times)
        outflow = System(sympy.cancel(d * process * C / (1 + process * C))).step(times)
        steepest = np.where(float(r_max) * times <= 1.1 * flow, float(r_max) * times, np.nan)
        curves = {"outflow": outflow, "steepest allowed": (steepest, "setpoint")}
        signals = [{"level": (level, "measurement")}, curves]
        labels = ["level [cm]", "outflow [m³/min]"]
        plot = time_plot(signals, times, xlabel="$t$ [min]", ylabel=labels, low=True)
        return plot.level(h_max, "highest allowed")

    first_change = "the first change of the outflow"
    return authoring.design(
        authoring.settings(design, gain="m²/min", time="min", what="the settings of the controller"),
        authoring.pi_controller(),
        authoring.stable(by=lambda pid: pid.Kp > 0 and pid.Ti > 0),
        authoring.criterion("the damping", lambda pid: _zeta(pid, area), above=1),
        authoring.criterion(
            "the largest rise of the level", lambda pid: 100 * _peak(pid, area, flow), below=h_max, unit="cm"
        ),
        authoring.criterion(first_change, lambda pid: float(pid.Kp) / area * flow, below=r_max, unit="m³/min²"),
        draws=trends,
    )


def picture(A, d):
    """A buffer tank whose level controller moves the valve in the outflow."""
    layout = """
        inflow  1     .    .   .        .
        .       tank  LT   LC  .        .
        .       tank  .    .   .        .
        .       2     .    LV  .  outflow"""
    parts = {"tank": diagrams.tank(rf"${float(A):g}\ \mathrm{{m^2}}$", level="h"), "LV": diagrams.control_valve("LV")}
    names = {"inflow": rf"$+{float(d):g}\ \mathrm{{m^3/min}}$"}
    return diagrams.instrumentation_diagram(layout, "inflow 1 tank 2 LV outflow", "tank LT LC LV", parts, names)
