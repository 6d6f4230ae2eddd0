"""Python beside the page of exercise 8.1."""

from loopbook import diagrams


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
