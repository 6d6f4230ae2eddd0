"""Python beside the page of exercise 11.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams
from loopbook.exercises.bank.ch11_control_structures.shared import lag
from loopbook.figures import time_plot
from loopbook.transfer import feedback, first_order, poles, static_gain  # noqa: F401


def picture(K_1, T_1, K_2, T_2, K_p2):
    """The block diagram: the secondary loop around the first part of the process, and then the second part."""
    layout = """
        .      .  .     .  d  .    .  .   .
        y_2SP  e  K_p2  u  j  P_2  1  P_1  y_1
        .      3  .     .  .  .    2  .   ."""
    blocks = {"K_p2": written(K_p2), "P_2": lag(K_2, T_2), "P_1": lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, "y_2SP e K_p2 u j P_2 1 P_1 y_1, d + j, 1 2 3 - e", blocks)


def solution_picture(K_1, T_1, K_2, T_2, K_p2):
    """What a disturbance of 1 % does to the parts, with the secondary loop and without it."""
    times = np.linspace(0, 5 * float(T_1), 301)

    def effect(gain, short):
        long = float(T_1)
        slow, fast = np.exp(-times / long), np.exp(-times / float(short))
        return float(gain) * (1 - (long * slow - float(short) * fast) / (long - float(short)))

    loop = 1 + K_p2 * K_2
    curves = {"without": effect(K_1 * K_2, T_2), "with the secondary loop": effect(K_1 * K_2 / loop, T_2 / loop)}
    return time_plot(curves, times, ylabel="$y_1$ [K]", low=True)
