"""Python beside the page of exercise 5.4."""

import sympy

from loopbook import diagrams


def in_numbers(M, *gains):
    """The static gain of the whole for those of the blocks; None where it has none."""
    value = M.subs(dict(zip(sympy.symbols("H_1 H_2 H_3 H_4", positive=True), gains, strict=True)))
    return value if value.is_finite else None


def solved_for_y(h_1, h_2, h_3, h_4, sense, signal):
    """What comes out for u = 1, from e = u - y, v = H_1 e + sense H_3 (y or v) and y = H_2 v + H_4 u."""
    v, y = sympy.symbols("v y")
    inner = h_1 * (1 - y) + sense * h_3 * (y if signal == "y" else v) - v
    return sympy.solve([inner, h_2 * v + h_4 - y], [v, y])[y]


def shown_inner(signal, sign):
    """The equation of the inner loop."""
    return rf"$v = H_1\,e {sign} H_3\,{signal}$"


def shown_solved(sign):
    """The equation of the inner loop where v is on both sides."""
    minus = "-" if sign == "+" else "+"
    return rf" There is $v$ on both sides; solved for it, $v = \frac{{H_1 (u - y)}}{{1 {minus} H_3}}$."


def shown_fraction(signal, sign, *gains):
    """The static gain as a fraction of numbers."""
    k_1, k_2, k_3, k_4 = (f"{float(k):g}" for k in gains)
    minus = "-" if sign == "+" else "+"
    around, bypass = (rf"{k_2} \cdot {k_3}", k_4) if signal == "y" else (k_3, rf"{k_4} \cdot (1 {minus} {k_3})")
    return rf"\frac{{ {k_1} \cdot {k_2} + {bypass} }}{{ 1 + {k_1} \cdot {k_2} {minus} {around} }}"


def solution_picture(signal, sign):
    """The block diagram with the two loops and the bypass."""
    if signal == "y":
        layout = """
            .  6  .  .    .     H_4  7    .  .
            u  5  e  H_1  add   H_2  out  4  y
            .  .  .  .    8     H_3  .    3  .
            .  .  1  .    .     .    .    2  ."""
        ways = "u 5 e H_1 add H_2 out 4 y, 4 3 H_3 8"
    else:
        layout = """
            .  6  .  .    .    .  .  H_4  7    .  .
            u  5  e  H_1  add  v  4  H_2  out  3  y
            .  .  .  .    8    H_3  9  .  .    .  .
            .  .  1  .    .    .  .  .    .    2  ."""
        ways = "u 5 e H_1 add v 4 H_2 out 3 y, 4 9 H_3 8"
    wires = f"{ways} {sign} add, 5 6 H_4 7 out, 3 2 1 - e"
    return diagrams.grid_diagram(layout, wires, {name: name for name in ("H_1", "H_2", "H_3", "H_4")})
