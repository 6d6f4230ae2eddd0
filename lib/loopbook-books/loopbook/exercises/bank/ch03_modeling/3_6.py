"""Python beside the page of exercise 3.6."""

import numpy as np
import sympy
from sympy import diff  # noqa: F401

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.transfer import initial_gain, poles, static_gain  # noqa: F401

#: What lies above the output and what below, and whether the latter is a row.
PARTS = {
    "loaded": (["R_1"], ["C", "R_2"], False),
    "stepped": (["R_1"], ["R_2", "C"], True),
    "bridged": (["R_1", "C"], ["R_2"], False),
}


def in_numbers(formula, *values):
    """A formula with the values of R_1, R_2 and C."""
    return formula.subs(dict(zip(sympy.symbols("R_1 R_2 C", positive=True), values, strict=True)))


def divider(circuit, r_1, r_2, c):
    """The transfer function of the circuit, as a divider of two impedances."""
    values = {"R_1": r_1, "R_2": r_2, "C": 1 / (c * s)}
    above, below, is_row = PARTS[circuit]
    first = 1 / sum(1 / values[part] for part in above)
    parts = [values[part] for part in below]
    second = sum(parts) if is_row else 1 / sum(1 / part for part in parts)
    return sympy.cancel(second / (first + second))


def picture(circuit, r_1, r_2, c):
    """The circuit. {looks}. The voltage v over the capacitor has its plus at the side towards the input."""
    values = {"R_1": written(r_1, "kΩ"), "R_2": written(r_2, "kΩ"), "C": written(c, "µF")}
    title = ", ".join(f"${name}$ = {value}" for name, value in values.items())
    return draw.voltage_divider(*PARTS[circuit], title=title, voltages={"C": "v"})


def solution_picture(slow, fast, T):
    """The output after a step of the input, from the factor for very fast voltages to that for constant ones."""
    output = slow + (fast - slow) * sympy.exp(-t / T)
    axes = {"xlabel": "$t$ [ms]", "ylabel": "$v_{out}/v_{in}$", "ylim": (-0.05, 1.1)}
    times = np.linspace(0, 5 * float(T), 201)
    return time_plot({"$v_{out}$": (output, "measurement")}, times, **axes).level(slow, "slow")
