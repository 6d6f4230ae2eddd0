"""The contents of the cheat sheet: formulas as SymPy expressions, each of them what a function of the library returns.

What no function derives with symbols (a relay's ultimate gain, the margins of one loop) stands in stated.py, and
tests/site/test_cheat_sheet.py compares it with the numbers of the library.
"""

from cheat_sheet import dynamics, rules

TITLE = "Process control on one page"
LETTERS = (
    r"$K$ gain, $T$ and $T_1 \geq T_2 \geq T_3$ lags, $\theta$ dead time, $r = \theta/T$, $\zeta$ damping; "
    "$T_c$ time constant that the closed loop should have",
    "$K_p$, $T_i$, $T_d$, $T_f$ gain, integral time, derivative time, filter of a PID controller in parallel form, "
    "unless the serial one is named",
    r"$K_u$, $P_u$ gain and period of the loop that oscillates forever; $K_{pGG}$, $T_{ou}$ gain and time from "
    "overshoot to undershoot of Good Gain",
)


def sections():
    """Return all sections in the order of the page."""
    parts = (
        (dynamics.laplace_pairs, dynamics.responses, dynamics.oscillations, dynamics.controllers, dynamics.loops),
        (dynamics.smith_predictor, dynamics.dead_times, dynamics.half_rules, dynamics.zero_rules, rules.skogestad),
        (rules.internal_model, rules.experiments, rules.reaction_curves, rules.lag_alone, dynamics.squared_error),
        (dynamics.limits,),
    )
    return [make() for part in parts for make in part]
