"""Python beside the page of exercise 3.4."""

import numpy as np
import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.expressions import t
from loopbook.figures import time_plot


def picture(m, F, U_h, T_i, T_e):
    """A stirred tank of {m} with a heating element of the power P: {F} come in at {T_i} and leave; through the wall, of
    {U_h}, heat passes to the dairy at {T_e}."""
    layout = """
        in  1    .    .    .
        .   vat  vat  vat  dairy
        .   vat  vat  vat  .
        P   vat  vat  vat  out"""
    names = {
        "in": f"${written(F)}$ kg/s, ${written(T_i)}$ °C",
        "dairy": f"dairy, ${written(T_e)}$ °C,\nby ${written(U_h)}$ W/K",
        "out": f"${written(F)}$ kg/s",
    }
    vat = draw.tank(f"${written(m)}$ kg", stirrer=True, heater=True)
    return draw.instrumentation_diagram(layout, "in 1 vat out", "P vat", {"vat": vat}, names)


def solution_picture(T_off, T_SP, T):
    """The temperature after the element has failed: it falls from the setpoint to where stream and dairy pull it."""
    temperature = T_off + (T_SP - T_off) * sympy.exp(-t / T)
    times = np.linspace(0, 5 * float(T), 201)
    plot = time_plot({"$T$": (temperature, "measurement")}, times, xlabel="$t$ [min]", ylabel="$T$ [°C]")
    return plot.level(T_off, "without the element").mark(T, "one time constant")
