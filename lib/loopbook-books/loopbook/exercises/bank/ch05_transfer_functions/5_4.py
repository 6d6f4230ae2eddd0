"""Python beside the page of exercise 5.4."""

import sympy

from loopbook import diagrams


def gain_of(M, *gains):
    """The static gain of the whole for those of the blocks; None where it has none."""
    value = M.subs(dict(zip(sympy.symbols("H_1 H_2 H_3 H_4", positive=True), gains, strict=True)))
    return value if value.is_finite else None


def solution_picture(signal, sign):
    """The block diagram with the two loops and the bypass."""
    if signal == "y":
        layout = """
            .  6  .  .    .     H_4  7    .  .
            u  5  e  H_1  add   H_2  out  4  y
            .  .  .  .    8     H_3  .    3  .
            .  .  1  .    .     .    .    2  ."""
        paths = "u 5 e H_1 add H_2 out 4 y, 4 3 H_3 8"
    else:
        layout = """
            .  6  .  .    .    .  .  H_4  7    .  .
            u  5  e  H_1  add  v  4  H_2  out  3  y
            .  .  .  .    8    H_3  9  .  .    .  .
            .  .  1  .    .    .  .  .    .    2  ."""
        paths = "u 5 e H_1 add v 4 H_2 out 3 y, 4 9 H_3 8"
    wires = f"{paths} {sign} add, 5 6 H_4 7 out, 3 2 1 - e"
    return diagrams.grid_diagram(layout, wires, {name: name for name in ("H_1", "H_2", "H_3", "H_4")})
