"""Python beside the page of exercise 9.9."""

import numpy as np

from loopbook.figures import plane_plot


def picture(q_max):
    """The current of the sensor against the flow: it begins at 4 mA and grows with the square of the flow to 20 mA."""
    x, full = np.linspace(0, 1, 201), float(q_max)
    curve = {"current": (x * full, 4 + 16 * x**2, "measurement")}
    return plane_plot(curve, "flow [m³/h]", "current [mA]", xlim=(0, 1.2 * full), ylim=(0, 22))
