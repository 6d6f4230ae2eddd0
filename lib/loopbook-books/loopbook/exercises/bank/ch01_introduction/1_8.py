"""Python beside the page of exercise 1.8."""

import numpy as np

from loopbook.figures import time_plot


def new_level(*givens):
    """Trend of a tank with a PI controller, from one setpoint to another at 10 min: times, level, control signal.

    A tank is an integrator: error and control signal obey s² + 2ζω s + ω², with 2ζω = Kp times its rate per percent.
    """
    h_1, h_2, reach, Kp, zeta, per_percent, u_0 = map(float, givens)
    damping = Kp * per_percent / 2
    omega = damping / zeta
    swing = omega * np.sqrt(1 - zeta**2)
    after = np.linspace(0, 5 / damping, 401)
    fades, angle = (h_2 - h_1) * np.exp(-damping * after), swing * after
    error = fades * (np.cos(angle) - damping / swing * np.sin(angle))
    added = fades * np.sin(angle) / swing * omega**2 / (2 * damping)
    quiet = np.linspace(0, 9.9999, 41)
    level = np.r_[0 * quiet + h_1, h_2 - error]
    return np.r_[quiet, 10 + after], level, np.r_[0 * quiet + u_0, u_0 + Kp * 100 / reach * (error + added)]


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
