"""What formulas of pages may call of the library, by name, and what they measure in responses."""

from __future__ import annotations

import numpy as np
import sympy

from loopbook.deadtime import System
from loopbook.expressions import parse
from loopbook.laplace import evaluate

#: The functions by the module that they are in. Each is imported when a formula calls it.
_BY_MODULE = {
    "loopbook.approximation": "half_rule pade zero_rule",
    "loopbook.deadtime": "System",
    "loopbook.identification": "fit",
    "loopbook.integrals": "ise pi_first_order",
    "loopbook.instruments": "decode",
    "loopbook.laplace": "evaluate final_value initial_value inverse transform",
    "loopbook.loops": "Loop",
    "loopbook.oscillation": "oscillation",
    "loopbook.pid": "PID",
    "loopbook.stability": "delay_margin is_closed_loop_stable margins robust_in_window robustness_pi_first_order "
    "ultimate unstable_closed_loop_poles",
    "loopbook.synthesis": "direct_synthesis imc",
    "loopbook.transfer": "dead_time feedback first_order initial_gain initial_slope integrator poles response_time "
    "second_order series simplified static_gain step_response zeros",
    "loopbook.tuning": "good_gain simc tyreus_luyben ziegler_nichols_reaction ziegler_nichols_ultimate",
    "numpy": "gradient interp",
    "sympy": "diff fraction integrate latex",
    __name__: "at in_numbers step_at",
}
LIBRARY = {name: f"{module}:{name}" for module, names in _BY_MODULE.items() for name in names.split()}
LIBRARY["differences"] = "numpy:diff"


def in_numbers(formula: object, **values: object) -> sympy.Expr:
    """Return a formula, or its text, with numbers for all of its symbols. Raises KeyError where one is missing.

    >>> in_numbers("V/q", V=6, q=2)
    3
    """
    found = parse(str(formula))
    return found.subs({symbol: values[symbol.name] for symbol in found.free_symbols})


def at(y: sympy.Expr, time: float) -> float:
    """Return the value of a function of time at a moment.

    >>> from loopbook.expressions import t
    >>> at(2*t, 3)
    6.0
    """
    return float(evaluate(y, [float(time)])[0])


def step_at(H: object, time: float) -> float:
    """Return the value of the step response of a system at a moment.

    >>> from loopbook.transfer import first_order
    >>> round(step_at(first_order(2, 5), 5), 4)
    1.2642
    """
    return float(System(H).step(np.array([0, float(time)]))[-1])
