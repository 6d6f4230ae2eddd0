"""Python beside the page of exercise 9.9."""

import numpy as np

from exercisebook import authoring
from loopbook.figures import plane_plot, time_plot


def read_off(key, unit, what, within):
    """A number that is given, and is asked where it is only seen in the picture."""
    return authoring.number(key, unit, what, within=float(within))


def current(q, q_max):
    """The current of the sensor for a flow, in mA."""
    return 4 + 16 * (q / float(q_max)) ** 2


def error_of_square(x, allowed):
    """By how much the square of a share is wrong, in percent of full scale, if the share is by so many of itself."""
    return 100 * float((x * (1 + allowed / 100)) ** 2 - x**2)


def picture(q_max):
    """The current of the sensor against the flow: it begins at 4 mA and grows with the square of the flow to 20 mA."""
    x, full = np.linspace(0, 1, 201), float(q_max)
    curve = {"current": (x * full, current(x, 1), "measurement")}
    return plane_plot(curve, "flow [m³/h]", "current [mA]", xlim=(0, 1.2 * full), ylim=(0, 22))


def solution_picture(inaccuracy, allowed, turndown):
    """The error of the flow relative to the flow, with the lowest flow that is known well enough."""
    x = np.linspace(0.05, 1, 191)
    error = float(inaccuracy) / (2 * x**2)
    plot = time_plot(
        {"error [% of the flow]": error}, 100 * x, xlabel="flow [% of the largest]", ylim=(0, 4 * float(allowed))
    )
    return plot.mark(100 * float(turndown), "lowest flow")
