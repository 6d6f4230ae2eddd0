"""Python beside the page of exercise 9.4."""

import numpy as np

from exercisebook.authoring import expression
from loopbook.figures import time_plot


def formula_of(moves):
    """The ripple in symbols."""
    return expression(moves, "the ripple as a formula")


def moved(q, A, D, P):
    """How far the level moves in a cycle, in mm, from what flows in and what flows out."""
    n = 2000
    flows = np.where(np.arange(n) < n * float(D), float(q), 0.0)
    level = np.cumsum(flows - flows.mean()) * float(P / A) / n
    return float(np.ptp(level))


def picture(q, D):
    """The flow of the pump in three cycles: it runs for the fraction D of each."""
    cycles = np.linspace(0, 3, 601)[:-1]
    flow = np.where(cycles % 1 < float(D), float(q), 0.0)
    return time_plot({"pump [L/s]": (flow, "control signal")}, cycles, xlabel="time in cycles, $t/P$", low=True)
