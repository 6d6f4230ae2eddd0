"""Python beside the page of exercise 8.5."""

import numpy as np

from loopbook.figures import time_plot


def _needed(u_0, u_full, d):
    return float(u_0) + float(u_full - u_0) * d**2 / 10000


def in_table(u_0, u_full, points, d):
    """What a table of so many points gives."""
    at = np.linspace(0, 100, int(points))
    return np.interp(np.array(d, float), at, _needed(u_0, u_full, at))


def largest_error(u_0, u_full, points):
    """The largest error of a table of so many points."""
    d = np.linspace(0, 100, 20001)
    return max(in_table(u_0, u_full, points, d) - _needed(u_0, u_full, d))


def picture(u_0, u_full, points):
    """The needed control signal against the consumption, a curve, and the straight lines of the table."""
    d, at = np.linspace(0, 100, 201), np.linspace(0, 100, int(points))
    needed, table = _needed(u_0, u_full, d), in_table(u_0, u_full, points, d)
    names = {"xlabel": "$d$ [m³/h]", "ylabel": "control signal [%]"}
    plot = time_plot({"needed": (needed, "process"), "table": (table, "model")}, d, **names)
    return plot.points(at, _needed(u_0, u_full, at), "points")
