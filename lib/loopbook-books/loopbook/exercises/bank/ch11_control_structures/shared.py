"""What pages of chapter 11 share: the blocks of a cascade, and vessels in a row."""

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


def vessels(feed, pipes, product, above=None, signals=""):
    """Vessels in a row, each with its level controller, and between them pipes with what is in each.

    Arguments:
        feed, product: where the row begins and where it ends.
        pipes: the signs in each, one pipe more than vessels.
        above: {sign in a pipe: the two signs above it}.
        signals: those of what is in the pipes.
    """
    names = [f"T{n}" for n in range(1, len(pipes))]
    above = {name: (f"L{name}", f"LC{name[1:]}") for name in names} | (above or {})
    row = [feed, *pipes[0], *(sign for name, pipe in zip(names, pipes[1:], strict=True) for sign in (name, *pipe))]
    row += [product]
    layout = [[above.get(sign, (".", "."))[place] for sign in row] for place in (1, 0)] + [row]
    parts = {sign: sign for sign in row if sign == "Filter"}
    parts |= {name: diagrams.vessel(name[1:], filled=0.5) for name in names}
    parts |= {sign: diagrams.control_valve(sign[1:] and sign) for sign in row if sign[0] == "V"}
    signals = [signals] * bool(signals) + [f"{name} {' '.join(above[name])}" for name in names]
    return diagrams.instrumentation_diagram("\n".join(map(" ".join, layout)), " ".join(row), ", ".join(signals), parts)
