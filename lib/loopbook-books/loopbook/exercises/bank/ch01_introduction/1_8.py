"""Python beside the page of exercise 1.8."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.transfer import integrator


def new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """Trend of a tank with a PI controller, from one setpoint to another at 10 min: times, level, control signal."""
    loop = Loop(integrator(per_percent), PID(Kp, 4 * zeta**2 / (Kp * per_percent)))
    quiet, after = np.linspace(0, 9.9999, 41), np.linspace(0, 10 / float(Kp * per_percent), 401)
    level = float(h_1) + float(h_2 - h_1) * loop.servo.step(after)
    control = float(u_0) + float(100 * (h_2 - h_1) / reach) * loop.setpoint_to_control.step(after)
    return np.r_[quiet, 10 + after], np.r_[0 * quiet + float(h_1), level], np.r_[0 * quiet + float(u_0), control]


def first_at(t, h, level):
    """When the record reaches a level for the first time."""
    return float(t[np.argmax(h >= float(level))])


def picture(t, h, u, h_1, h_2):
    """The setpoint makes a step, the level rises beyond it and comes back; the control signal jumps and returns."""
    setpoint = np.where(t < 10, float(h_1), float(h_2))
    panels = [{"setpoint": (setpoint, "setpoint"), "$h$": (h, "measurement")}, {"$u$": (u, 0)}]
    title = "A new setpoint after ten minutes"
    return time_plot(panels, t, title, xlabel="$t$ [min]", ylabel=["$h$ [m]", "$u$ [%]"])


def solution_picture(t, h, u, h_1, h_2, t_rise):
    """The picture of the statement, with the first moment at the setpoint and the highest level marked."""
    plot = picture(t, h, u, h_1, h_2)
    return plot.mark(10 + t_rise, "at the setpoint", signal="$h$").mark(10 + 2 * t_rise, "highest", signal="$h$")
