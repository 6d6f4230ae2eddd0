"""What several pages of chapter 19 need."""

import numpy as np

from loopbook.figures import plane_plot
from loopbook.stability import robustness_pi_first_order, shinskey_window
from plainmath.tables import rounded


def three_digits(value):
    """A number as texts show it, with three digits."""
    return float(rounded(float(value), 3))


def robustness_plot(K, T, delay, Kp, Ti):
    """The limit of stability over the gain ratio, with Shinskey's window."""
    ratios = np.geomspace(0.4, 2.5, 81)
    limit = robustness_pi_first_order(K, T, delay, Kp, Ti, ratios)
    high = 1.2 * max(3.0, min(float(limit.max()), 12.0))
    labels = "gain ratio $k$", "delay ratio $d$"
    plot = plane_plot({"limit of stability": (ratios, limit)}, *labels, xlim=(0.4, 2.5), ylim=(0.3, high), log=True)
    return plot.area(*shinskey_window(), "window").points([1], [1], "as tuned")
