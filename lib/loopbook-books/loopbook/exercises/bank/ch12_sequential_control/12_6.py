"""Python beside the page of exercise 12.6."""

import numpy as np
from scipy.integrate import quad

from loopbook.figures import time_plot


def worked_out(expression, A, K_v, h_0, h_1):
    """A time in its symbols with the numbers of the vat, in s; K_v is in litres."""
    numbers = {"A": A, "K_v": K_v / 1000, "h_0": h_0, "h_1": h_1}
    return float(expression.subs({one: numbers[one.name] for one in expression.free_symbols}))


def integral(A, K_v, h_0, h_1):
    """The time of emptying as the integral over the level, in s."""
    return quad(lambda h: float(1000 * A / K_v) / np.sqrt(h), float(h_0), float(h_1))[0]


def solution_picture(h_0, h_1, filling, batch, emptying):
    """The level during one batch: it rises steadily, stays while heating and dyeing, and falls ever more slowly."""
    low, high, begins, filling = (float(x) for x in (h_0, h_1, batch - emptying, filling))
    minutes = np.linspace(0, float(batch), 401)
    root = np.interp(minutes, [begins, float(batch)], [np.sqrt(high), np.sqrt(low)])
    level = np.where(minutes < begins, np.interp(minutes, [0, filling], [low, high]), root**2)
    return time_plot({"level [m]": level}, minutes, xlabel="$t$ [min]", low=True)
