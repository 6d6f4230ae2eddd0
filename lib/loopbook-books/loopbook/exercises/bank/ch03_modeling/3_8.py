"""Python beside the page of exercise 3.8."""

import numpy as np

from loopbook.figures import plane_plot

DEEPEST = 2  # metres


def outflow(level, power, h_s, q_i):
    """The outflow [L/s] at a level."""
    return float(q_i) * float(level / h_s) ** float(power)


def measured(power, h_s, q_i):
    """Levels [m] and outflow [L/s] of the picture."""
    h = np.linspace(0, DEEPEST, 201)
    return h, np.array([outflow(level, power, h_s, q_i) for level in h])


def height(at, x, y):
    """What a curve has at a place."""
    return float(np.interp(float(at), x, y))


def slope_at(at, x, y):
    """The slope of a curve at a place, between its neighbours."""
    return height(at, x, np.gradient(y, x))


def if_apart(values, number, by=0.35):
    """One of the values if a ruler can tell it from the right one, which is the first, and from all others."""
    right, value, *others = values[0], values[number], *values[1:number], *values[number + 1 :]
    is_apart = abs(value / right - 1) > by
    return value if is_apart and all(abs(value / other - 1) > 0.35 for other in others) else right


def _both_flows(h, q_i, q_o, title):
    curves = {"inflow": (h, np.full(h.shape, float(q_i)), "control signal"), "outflow": (h, q_o, "measurement")}
    return plane_plot(curves, "$h$ [m]", "flow [L/s]", title, xlim=(0, DEEPEST), ylim=(0, 1.05 * q_o[-1]))


def picture(h, q_i, q_o):
    """Two curves against the level: the inflow is constant, the outflow grows with the level and crosses it once."""
    return _both_flows(h, q_i, q_o, "Inflow and outflow of the tank")


def solution_picture(h, q_i, q_o, h_s, slope):
    """The two flows, and the straight line that takes the place of the outflow near the rest."""
    plot = _both_flows(h, q_i, q_o, "The ruler at the place of rest")
    ends = float(h_s) + np.array([-0.5, 0.5])
    plot = plot.line(ends, float(q_i) + float(slope) * (ends - float(h_s)), "ruler", role="setpoint")
    return plot.points(float(h_s), float(q_i), "rest")
