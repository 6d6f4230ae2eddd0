"""Python beside the page of exercise 8.1."""

import itertools

from loopbook import diagrams
from loopbook.expressions import parse


def apart(values):
    """Whether no two of the values can be taken for one another."""
    return all(abs(x - y) > 0.03 * abs(x) for x, y in itertools.permutations(values, 2))


def in_numbers(formula, w_c, T_SP, T_c, T_h):
    """The feedforward with the numbers of the dairy."""
    values = {"w_c": w_c, "T_SP": T_SP, "T_c": T_c, "T_h": T_h}
    return parse(formula).subs({symbol: values[symbol.name] for symbol in parse(formula).free_symbols})


def picture(T_SP, T_c, T_h):
    """Cold and hot water are mixed; the cold flow is measured, and a feedforward sets the valve in the hot flow."""
    layout = """
        w_c   1   2  out
        .     FT  .  .
        T_SP  F   .  .
        w_h   V   3  ."""
    names = {"w_c": rf"$w_c$, ${T_c}$ °C", "w_h": rf"$w_h$, ${T_h}$ °C", "out": rf"${T_SP}$ °C", "T_SP": "$T_{SP}$"}
    parts = {"V": diagrams.control_valve(), "F": "Feed-\nforward"}
    return diagrams.instrumentation_diagram(layout, "w_c 1 2 out, w_h V 3 2", "1 FT F V, T_SP F", parts, names)
