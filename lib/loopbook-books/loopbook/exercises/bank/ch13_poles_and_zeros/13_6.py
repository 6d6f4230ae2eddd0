"""Python beside the page of exercise 13.6."""

import numpy as np

from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.oscillation import oscillation
from loopbook.transfer import simplified


def damping(pid, A):
    """The damping of a level under PI control, from its transfer function."""
    return oscillation(simplified(s / (A * s + pid.expr))).zeta


def highest(pid, A, d):
    """The largest rise of the level after a step of the inflow, in cm."""
    times = np.linspace(0, 20 * float(A / pid.Kp), 4001)
    return 100 * System(simplified(d / (A * s + pid.expr))).step(times).max()


def _trends(pid, A, d, h_max, r_max):
    """Level and outflow after the step of the inflow, with their limits."""
    times = np.linspace(0, 4 * max(float(pid.Ti) if pid.Ti.is_finite else 0, float(A / pid.Kp)), 301)
    level = 100 * System(simplified(d / (A * s + pid.expr))).step(times)
    outflow = System(simplified(d * pid.expr / (A * s + pid.expr))).step(times)
    steepest = np.where(float(r_max) * times <= 1.1 * float(d), float(r_max) * times, np.nan)
    panels = [{"level": (level, "measurement")}, {"outflow": outflow, "steepest allowed": (steepest, "setpoint")}]
    plot = time_plot(panels, times, xlabel="$t$ [min]", ylabel=["level [cm]", "outflow [m³/min]"], low=True)
    return plot.level(h_max, "highest allowed")


def calm(A, d, h_max, r_max, pid):
    """A PI controller that keeps the limits of level and outflow, and whose level does not oscillate."""
    return design(
        settings(pid, gain="m²/min", time="min", what="the settings of the controller"),
        pi_controller(),
        stable(by=lambda pid: pid.Kp > 0),
        criterion("the damping", lambda pid: damping(pid, A), above=1),
        criterion("the largest rise of the level", lambda pid: highest(pid, A, d), below=h_max, unit="cm"),
        criterion("the first change of the outflow", lambda pid: float(pid.Kp / A * d), below=r_max, unit="m³/min²"),
        draws=lambda pid: _trends(pid, A, d, h_max, r_max),
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
