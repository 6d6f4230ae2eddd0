"""Python beside the page of exercise 3.4."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(m, F, U_h, T_i, T_e):
    """A stirred tank of {m} with a heating element of the power P: {F} come in at {T_i} and leave; through the wall, of
    {U_h}, heat passes to the dairy at {T_e}."""
    layout = """
        in  1    .    .    .
        .   vat  vat  vat  dairy
        .   vat  vat  vat  .
        P   vat  vat  vat  out"""
    names = {"in": f"${written(F)}$ kg/s, ${written(T_i)}$ °C", "out": f"${written(F)}$ kg/s"}
    names["dairy"] = f"dairy, ${written(T_e)}$ °C,\nby ${written(U_h)}$ W/K"
    vat = draw.tank(f"${written(m)}$ kg", stirrer=True, heater=True)
    return draw.instrumentation_diagram(layout, "in 1 vat out", "P vat", {"vat": vat}, names)
