"""Python beside the page of exercise 11.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams
from loopbook.deadtime import System
from loopbook.exercises.bank.ch11_control_structures.shared import lag
from loopbook.figures import time_plot
from loopbook.transfer import feedback, first_order, poles, second_order, static_gain  # noqa: F401


def picture(K_1, T_1, K_2, T_2, K_p2):
    """The block diagram: the secondary loop around the first part of the process, and then the second part."""
    layout = """
        .      .  .     .  d  .    .  .   .
        y_2SP  e  K_p2  u  j  P_2  1  P_1  y_1
        .      3  .     .  .  .    2  .   ."""
    blocks = {"K_p2": written(K_p2), "P_2": lag(K_2, T_2), "P_1": lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, "y_2SP e K_p2 u j P_2 1 P_1 y_1, d + j, 1 2 3 - e", blocks)


def solution_picture(K_1, T_1, K_2, T_2, H):
    """What a disturbance of 1 % does to the parts, with the secondary loop and without it."""
    times = np.linspace(0, 5 * float(T_1), 301)
    effects = {"without": second_order(K_1 * K_2, T_1, T_2), "with the secondary loop": H}
    curves = {name: System(effect).step(times) for name, effect in effects.items()}
    return time_plot(curves, times, ylabel="$y_1$ [K]", low=True)
