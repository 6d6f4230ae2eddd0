"""Python beside the page of exercise 10.1."""

import numpy as np

from loopbook.figures import time_plot


def picture(rise, t_28, t_63, T, tau):
    """The rise of the temperature after the step, with the two moments at which 28 and 63 % of it are reached."""
    T, tau = float(T), float(tau)
    times = np.linspace(0, np.ceil((tau + 5 * T) / 50) * 50, 401)
    y = float(rise) * -np.expm1(-np.maximum(times - tau, 0) / T)
    plot = time_plot({"rise of the temperature [K]": (y, "measurement")}, times)
    return plot.level(rise, "in the end").mark(t_28, "28 %").mark(t_63, "63 %")
