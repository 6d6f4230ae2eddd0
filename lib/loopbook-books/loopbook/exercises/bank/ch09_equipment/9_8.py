"""Python beside the page of exercise 9.8."""

import math

import numpy as np

from loopbook.figures import plane_plot


def _installed(kind, authority, opening):
    """The flow in percent and its slope, for an opening in percent, of a valve in series with a pipe."""
    x, authority = np.asarray(opening, float) / 100, float(authority)
    inherent, slope = (x, np.ones_like(x)) if kind == "linear" else (50 ** (x - 1), math.log(50) * 50 ** (x - 1))
    flow = inherent / np.sqrt(authority + (1 - authority) * inherent**2)
    return 100 * flow, slope * authority / (authority + (1 - authority) * inherent**2) ** 1.5


def flow_at(kind, authority, opening):
    """The flow at an opening."""
    return float(_installed(kind, authority, opening)[0])


def slope_at(kind, authority, opening):
    """The slope of the curve at an opening."""
    return float(_installed(kind, authority, opening)[1])


def opening_for(kind, authority, flow):
    """Where the curve reaches a flow."""
    openings = np.linspace(0, 100, 10001)
    return float(np.interp(float(flow), _installed(kind, authority, openings)[0], openings))


def _curve(kind, authority, points, tangents):
    x = np.linspace(0, 100, 201)
    curves = {"valve": (x, _installed(kind, authority, x)[0], "measurement")} | tangents
    plot = plane_plot(curves, "opening [%]", "flow [%]", xlim=(0, 100), ylim=(0, 105))
    for name, (opening, flow) in points.items():
        plot.text(float(opening) - 3, float(flow) + 5, name)
    return plot.points(*np.array([*points.values()], float).T, "working points")


def picture(kind, authority, low, high, q_A, q_B):
    """The flow against the opening of the valve, as measured in the plant, with the points A and B."""
    return _curve(kind, authority, {"A": (low, q_A), "B": (high, q_B)}, {})


def solution_picture(kind, authority, low, high, q_A, q_B, gain_A, gain_B):
    """The curve with its tangents at A and B."""
    near = np.array([-15.0, 15.0])
    lines = {"tangent at A": (low, q_A, gain_A), "tangent at B": (high, q_B, gain_B)}
    tangents = {name: (float(x) + near, float(q) + slope * near) for name, (x, q, slope) in lines.items()}
    return _curve(kind, authority, {"A": (low, q_A), "B": (high, q_B)}, tangents)
