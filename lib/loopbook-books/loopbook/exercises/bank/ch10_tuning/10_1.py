"""Python beside the page of exercise 10.1."""

import numpy as np

from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.transfer import first_order


def picture(rise, t_28, t_63, T, tau):
    """The rise of the temperature after the step, with the two moments at which 28 and 63 % of it are reached."""
    times = np.linspace(0, np.ceil(float(tau + 5 * T) / 50) * 50, 401)
    y = System(first_order(rise, T, tau)).step(times)
    plot = time_plot({"rise of the temperature [K]": (y, "measurement")}, times)
    return plot.level(rise, "in the end").mark(t_28, "28 %").mark(t_63, "63 %")
