"""The errors of exercise 18.6, of straight lines."""

import numpy as np

from loopbook.figures import time_plot


def errors(wait, fall, down, up, depth, change):
    """Times, and both errors: after the change with a worse beginning, or with one more oscillation at the end.

    And the corners of the error, which waits, falls through zero, and comes back: times and values.
    """
    corners, e = np.cumsum([0, wait, fall, down, up]).astype(float), np.array([1, 1, 0, -float(depth), 0])
    times = np.linspace(0, corners[-1] + 7, 20 * int(corners[-1] + 7) + 1)
    if change == "beginning":
        changed = corners, np.array([1, 1.8, *e[2:]])
    else:
        changed = np.append(corners, corners[-1] + [3.0, 6.0]), np.append(e, [0.6 * float(depth), 0])
    return times, np.interp(times, corners, e), np.interp(times, *changed), (corners, e)


def integrals(t, e):
    """IAE, ISE and ITAE by Simpson's rule, which is exact for parabolas."""
    from scipy.integrate import simpson  # not before it is asked: a page of the site loads it then

    return [float(simpson(one, x=t)) for one in (abs(e), e**2, t * abs(e))]


def picture(t, e, changed, corners):
    """The error in straight lines: it stays at one, falls below zero, and returns; dashed, after the change."""
    curves = {"error": (e, "measurement"), "after the change": (changed, "setpoint")}
    return time_plot(curves, t, "After a unit step of the setpoint", ylabel="error").points(*corners, "corners")


def solution_picture(t, e):
    """What the three criteria add up before the change: the absolute error, its square, and its product with time."""
    panels = [{"$|e|$": (abs(e), 0)}, {"$e^2$": (e**2, 1)}, {"$t\\,|e|$": (t * abs(e), 2)}]
    plot = time_plot(panels, t, "What is added up", low=True)
    return plot.area("$|e|$").area("$e^2$").area("$t\\,|e|$")
