"""The ISE over the gain of exercise 18.3."""

import numpy as np

from loopbook.figures import plane_plot


def solution_picture(K, delay, Kp, ISE, best_gain, least_ISE):
    """The ISE over the gain: flat around the best gain, and steep towards the limit of stability."""
    x = np.linspace(0.2, 1.4, 200)
    curve = float(delay) * np.cos(x) / (2 * x * (1 - np.sin(x)))
    plot = plane_plot({"ISE": (x / float(K * delay), curve)}, "$K_p$", "ISE [s]", "The ISE over the gain")
    plot.points([float(best_gain)], [float(least_ISE)], "best", "x")
    return plot.points([float(Kp)], [float(ISE)], "as given")
