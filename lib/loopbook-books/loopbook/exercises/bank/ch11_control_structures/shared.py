"""What pages of chapter 11 share: the blocks of a cascade."""

from exercisebook.parameters import written
from loopbook import diagrams


def lag(K, T, delay=0):
    """A lag with dead time, as it is written in a block."""
    late = f"e^{{-{written(delay)}s}}" if delay else ""
    return rf"\frac{{{written(K)}\,{late}}}{{{written(T)}\,s+1}}"


def cascade(first, second, P_1, P_2):
    """A cascade in a block diagram, from its two controllers and the two parts of the process."""
    layout = """
        .     .  .    .      .  .    .  .    .  .    .  .
        y_SP  e  C_1  y_2SP  f  C_2  u  P_2  1  P_1  2  y_1
        .     .  .    .      4  .    .  .    3  .    .  .
        .     6  .    .      .  .    .  .    .  .    5  ."""
    wires = "y_SP e C_1 y_2SP f C_2 u P_2 1 P_1 2 y_1, 1 3 4 - f, 2 5 6 - e"
    return diagrams.grid_diagram(layout, wires, {"C_1": first, "C_2": second, "P_1": P_1, "P_2": P_2})
