"""Python beside the page of exercise 9.8."""

import math

import numpy as np

from loopbook.figures import plane_plot

AXES = "opening [%]", "flow [%]"


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


def rise(kind, authority, opening):
    """The slope by two flows close together."""
    return (flow_at(kind, authority, opening + 0.01) - flow_at(kind, authority, opening - 0.01)) / 0.02


def opening_for(kind, authority, flow):
    """Where the curve reaches a flow."""
    openings = np.linspace(0, 100, 10001)
    return float(np.interp(float(flow), _installed(kind, authority, openings)[0], openings))


def seen(wrong, right):
    """A wrong value, where a ruler tells it from the right one."""
    return right if 0.75 < wrong / right < 1.3 else wrong


def picture(kind, authority, low, high):
    """The flow against the opening of the valve, as measured in the plant, with the points A and B."""
    x = np.linspace(0, 100, 201)
    plot = plane_plot(
        {"valve": (x, _installed(kind, authority, x)[0], "measurement")}, *AXES, xlim=(0, 100), ylim=(0, 105)
    )
    flows = [float(_installed(kind, authority, opening)[0]) for opening in (low, high)]
    plot.points([float(low), float(high)], flows, "working points")
    return plot.text(float(low) - 3, flows[0] + 5, "A").text(float(high) - 3, flows[1] + 5, "B")


def solution_picture(kind, authority, low, high):
    """The curve with its tangents at A and B."""
    x = np.linspace(0, 100, 201)
    curves = {"flow [%]": (x, _installed(kind, authority, x)[0], "measurement")}
    for name, at in (("A", low), ("B", high)):
        flow, slope = _installed(kind, authority, at)
        near = np.array([-15.0, 15.0])
        curves[f"tangent at {name}"] = (float(at) + near, flow + slope * near)
    return plane_plot(curves, *AXES, xlim=(0, 100), ylim=(0, 105))
