"""Python beside the page of exercise 1.8."""

import math

import numpy as np

from loopbook.exercises import authoring
from loopbook.figures import time_plot


def gain(key, what):
    """A gain that is read off the picture."""
    return authoring.number(key, "", what, within=0.1)


def new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """Trend of a tank with a PI controller, from one setpoint to another at 10 min: times, level, control signal.

    A tank is an integrator: error and control signal obey s² + 2ζω s + ω², with 2ζω = Kp times its rate per percent.
    """
    damping = float(Kp * per_percent) / 2
    omega = damping / float(zeta)
    swing = math.sqrt(omega**2 - damping**2)
    before, after = np.linspace(0, 9.9999, 41), np.linspace(0, 5 / damping, 401)
    fades, angle = np.exp(-damping * after), swing * after
    step = float(h_2 - h_1)
    error = step * fades * (np.cos(angle) - damping / swing * np.sin(angle))
    added = step * fades * np.sin(angle) / swing * omega**2 / (2 * damping)
    control = float(u_0) + float(Kp) * 100 / float(reach) * (error + added)
    level = np.r_[np.full(before.shape, float(h_1)), float(h_2) - error]
    return np.r_[before, 10 + after], level, np.r_[np.full(before.shape, float(u_0)), control]


def first_at(t, h, level):
    """When the record reaches a level for the first time."""
    return float(t[np.argmax(h >= float(level))])


def _plot(t, h, u, h_1, h_2, title):
    setpoint = np.where(t < 10, float(h_1), float(h_2))
    panels = [{"setpoint": (setpoint, "setpoint"), "$h$": (h, "measurement")}, {"$u$": (u, 0)}]
    return time_plot(panels, t, title, xlabel="$t$ [min]", ylabel=["$h$ [m]", "$u$ [%]"])


def picture(t, h, u, h_1, h_2):
    """The setpoint makes a step, the level rises beyond it and comes back; the control signal jumps and returns."""
    return _plot(t, h, u, h_1, h_2, "A new setpoint after ten minutes")


def solution_picture(t, h, u, h_1, h_2, t_rise):
    """The picture of the statement, with the first moment at the setpoint and the highest level marked."""
    plot = _plot(t, h, u, h_1, h_2, "What is read off")
    return plot.mark(10 + t_rise, "at the setpoint", signal="$h$").mark(10 + 2 * t_rise, "highest", signal="$h$")
