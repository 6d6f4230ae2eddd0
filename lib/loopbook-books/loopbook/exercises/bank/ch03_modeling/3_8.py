"""Python beside the page of exercise 3.8."""

import numpy as np

from loopbook.figures import plane_plot


def measured(power, h_s, q_i):
    """Levels [m] and outflow [L/s] of the picture."""
    h = np.linspace(0, 2, 201)
    return h, float(q_i) * (h / float(h_s)) ** float(power)


def picture(h, q_i, q_o):
    """Two curves against the level: the inflow is constant, the outflow grows with the level and crosses it once."""
    curves = {"inflow": (h, np.full(h.shape, float(q_i)), "control signal"), "outflow": (h, q_o, "measurement")}
    axes = {"xlim": (0, h[-1]), "ylim": (0, 1.05 * q_o[-1])}
    return plane_plot(curves, "$h$ [m]", "flow [L/s]", "Inflow and outflow of the tank", **axes)


def solution_picture(h, q_i, q_o, h_s, slope):
    """The two flows, and the straight line that takes the place of the outflow near the rest."""
    ends = float(h_s) + np.array([-0.5, 0.5])
    ruler = float(q_i) + float(slope) * (ends - float(h_s))
    plot = picture(h, q_i, q_o).line(ends, ruler, "ruler", role="setpoint")
    return plot.points(float(h_s), float(q_i), "rest")
