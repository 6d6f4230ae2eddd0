"""Python beside the page of exercise 11.4."""

from exercisebook.parameters import written
from loopbook import diagrams
from loopbook.exercises.bank.ch11_control_structures.shared import lag


def picture(K_1, T_1, K_2, T_2, K_p2):
    """The block diagram: the secondary loop around the first part of the process, and then the second part."""
    layout = """
        .      .  .     .  d  .    .  .   .
        y_2SP  e  K_p2  u  j  P_2  1  P_1  y_1
        .      3  .     .  .  .    2  .   ."""
    blocks = {"K_p2": written(K_p2), "P_2": lag(K_2, T_2), "P_1": lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, "y_2SP e K_p2 u j P_2 1 P_1 y_1, d + j, 1 2 3 - e", blocks)
