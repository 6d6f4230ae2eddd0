"""Python beside the page of exercise 9.4."""

import numpy as np
import sympy

from exercisebook.authoring import expression
from loopbook.figures import time_plot


def formula_of(moves):
    """The ripple in symbols."""
    return expression(moves, "the ripple as a formula")


def in_numbers(moves, *values):
    """The formula of the ripple with numbers."""
    return moves.subs(dict(zip(sympy.symbols("q A D P", positive=True), values, strict=True)))


def moved(q, A, D, P):
    """How far the level moves in a cycle, in mm, from what flows in and what flows out."""
    n = 2000
    flows = np.where(np.arange(n) < n * float(D), float(q), 0.0)
    level = np.cumsum(flows - flows.mean()) * float(P / A) / n
    return float(level.max() - level.min())


def picture(q, D):
    """The flow of the pump in three cycles: it runs for the share D of each."""
    cycles = np.linspace(0, 3, 601)[:-1]
    flow = np.where(cycles % 1 < float(D), float(q), 0.0)
    return time_plot({"pump [L/s]": (flow, "control signal")}, cycles, xlabel="time in cycles, $t/P$", low=True)


def solution_picture(D, height, P):
    """Three of the longest cycles: the level, and the pump."""
    times = np.linspace(0, 3 * float(P), 601)[:-1]
    share = (times / float(P)) % 1
    runs = share < float(D)
    level = float(height) * np.where(runs, share / float(D), (1 - share) / (1 - float(D)))
    panels = [{"level [mm]": (level, "measurement")}, {"pump": (runs.astype(float), "control signal")}]
    return time_plot(panels, times, low=True)
