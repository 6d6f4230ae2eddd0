"""Python beside the page of exercise 11.10."""

from loopbook import diagrams
from loopbook.exercises.bank.ch11_control_structures.shared import lag


def picture(K_1, T_1, K_2, T_2):
    """The block diagram: the integral of the control error, minus both temperatures, each with its gain."""
    layout = """
        .     .  .         .    .  .    .       .  .     .  .
        y_SP  e  Integral  k_i  f  u    Jacket  1  Glue  2  x_1
        .     .  .         .    9  k_2  .       3  .     .  .
        .     .  .         .    7  k_1  .       .  .     4  .
        .     6  .         .    .  .    .       .  .     5  ."""
    wires = "y_SP e Integral k_i f u Jacket 1 Glue 2 x_1, 1 3 k_2 9 - f, 2 4 k_1 7 - f, 4 5 6 - e"
    blocks = {"Integral": r"\frac{1}{s}", "Jacket": lag(K_2, T_2), "Glue": lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, wires, blocks | {name: name for name in ("k_i", "k_1", "k_2")})
