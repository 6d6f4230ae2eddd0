"""Rules for the model that a step response gives, a lag with dead time: Ziegler and Nichols, Cohen and Coon, ITAE."""

from __future__ import annotations

import sympy
from sympy import Rational as Q

from loopbook.approximation import SOPDT, model_of
from loopbook.pid import PID
from loopbook.tuning.registry import rule
from loopbook.types import TransferFunctionLike
from plainmath.validation import exact_in_range, one_of


@rule("Ziegler-Nichols", needs="a lag or an integrator with dead time", kind=("P", "PI", "PID"))
def ziegler_nichols_reaction(model: TransferFunctionLike, kind: str = "PID") -> PID:
    """Return the settings of Ziegler and Nichols from the reaction curve, a step response without control.

    Only the steepest slope of the response and the dead time count, so that a lag and an integrator with the same slope
    have the same settings. The aim is that each oscillation is a quarter of the one before. The rule is recommended for
    dead times from about 0.1 to 1 lag.

    Arguments:
        model: a lag or an integrator, with dead time.
        kind: "P", "PI" or "PID" (parallel form).
    Raises:
        ValueError: for another process, or another kind.
    Source: Ziegler and Nichols (1942); Seborg et al., slide that compares them with Cohen and Coon.

    >>> from sympy import exp
    >>> from loopbook import s
    >>> ziegler_nichols_reaction(2 * exp(-4 * s) / (20 * s + 1))
    PID(Kp=3, Ti=8, Td=2)
    """
    slope, _, delay = _reaction_curve(model, "the rule of Ziegler and Nichols")
    rules = {
        "P": PID(1 / (slope * delay)),
        "PI": PID(Q("0.9") / (slope * delay), Q("3.33") * delay),
        "PID": PID(Q("1.2") / (slope * delay), 2 * delay, Q("0.5") * delay),
    }
    return rules[one_of("kind", kind, rules)]


@rule("Cohen-Coon", needs="a lag or an integrator with dead time", kind=("P", "PI", "PID"))
def cohen_coon(model: TransferFunctionLike, kind: str = "PID") -> PID:
    """Return the settings of Cohen and Coon, which aim at quarter decay and a small area of the error.

    With ``r = delay/T``, which is zero for an integrator. The rule was derived, and fitted, for dead times from about
    0.1 to 1 lag.

    Arguments:
        model: a lag with dead time, or an integrator as its limit.
        kind: "P", "PI" or "PID" (parallel form).
    Raises:
        ValueError: for another process, or another kind.
    Source: Cohen and Coon (1953); Seborg et al., slide that compares them with Ziegler and Nichols.

    >>> from sympy import exp
    >>> from loopbook import s
    >>> cohen_coon(2 * exp(-4 * s) / (20 * s + 1), "P")
    PID(Kp=8/3)
    """
    slope, r, delay = _reaction_curve(model, "the rule of Cohen and Coon")
    gain = 1 / (slope * delay)
    rules = {
        "P": PID(gain * (1 + r / 3)),
        "PI": PID(gain * (Q("0.9") + Q("0.083") * r), delay * (Q("3.33") + Q("0.33") * r) / (1 + Q("2.2") * r)),
        "PID": PID(
            gain * (Q("1.35") + Q("0.270") * r),
            delay * (32 + 6 * r) / (13 + 8 * r),
            delay * Q("0.37") / (1 + Q("0.2") * r),
        ),
    }
    return rules[one_of("kind", kind, rules)]


# A and B of Table 12.3, for K*Kp, T/Ti and Td/T
_ITAE = {
    ("regulator", "PI"): (("0.859", "-0.977"), ("0.674", "-0.680")),
    ("regulator", "PID"): (("1.357", "-0.947"), ("0.842", "-0.738"), ("0.381", "0.995")),
    ("servo", "PI"): (("0.586", "-0.916"), ("1.03", "-0.165")),
    ("servo", "PID"): (("0.965", "-0.85"), ("0.796", "-0.1465"), ("0.308", "0.929")),
}


@rule(
    "ITAE",
    needs="a lag with dead time",
    kind=("PI", "PID"),
    mode={"regulator": "load", "servo": "setpoint"},
)
def itae(model: TransferFunctionLike, kind: str = "PI", mode: str = "regulator", extrapolate: bool = False) -> PID:
    """Return settings that nearly minimise the integral of ``t*abs(e)``, fitted for dead times of 0.1 to 1 lag.

    Each is ``A*r**B`` with ``r = delay/T``, and for T/Ti after a setpoint step ``A + B*r``. Servo settings do not suit
    a load, and those of a PID controller are for one whose derivative term does not see the setpoint (chapter 16 shows
    it).

    Arguments:
        model: a lag with dead time. An integrator has no such settings: with r, ``K*Kp*r`` goes to zero or infinity.
        kind: "PI" or "PID" (parallel form).
        mode: "regulator" for a step of the load at the process input, "servo" for one of the setpoint.
        extrapolate: use the formulas also for dead times outside of 0.1 to 1 lag.
    Raises:
        ValueError: for another process, kind or mode; or outside of the range, unless it may be left.
    Source: Lopez et al. (1967) and Rovira et al. (1969); Seborg et al., Table 12.3. The range is not in the slides.

    >>> from sympy import exp
    >>> from loopbook import s
    >>> settings = itae(exp(-4 * s) / (20 * s + 1), "PI", "servo")
    >>> settings.Kp.round(3), settings.Ti.round(2)
    (2.559, 20.06)
    """
    rows = _ITAE[one_of("mode", mode, ("servo", "regulator")), one_of("kind", kind, ("PI", "PID"))]
    model = model_of(model)
    if model.is_integrating:
        raise ValueError(f"{model} is integrating: the ITAE rule is for a lag")
    _, r, _ = _reaction_curve(model, "the ITAE rule")
    exact_in_range("delay/T", r, Q("0.1"), 1, extrapolate)
    proportional, integral, *derivative = (tuple(map(Q, row)) for row in rows)
    rate = integral[0] + integral[1] * r if mode == "servo" else _power_law(*integral, r)  # T/Ti
    if rate.is_nonpositive:
        raise ValueError(f"delay/T is {r}: the ITAE rule has no positive integral time there")
    Td = model.T1 * _power_law(*derivative[0], r) if derivative else 0
    return PID(_power_law(*proportional, r) / model.K, model.T1 / rate, Td)


def steepest_slope(model: SOPDT, name: str) -> sympy.Expr:
    """The steepest slope of the step response: the gain over the largest lag."""
    if model.T1 == 0:
        raise ValueError(f"{name} needs a lag or an integrator, and {model} has none: give it a small lag")
    return model.K if model.is_integrating else model.K / model.T1


def _power_law(A, B, r):
    return A * r**B


def _reaction_curve(model, name):
    """The steepest slope, the dead time over the lag and the dead time of a lag or an integrator with dead time."""
    model = model_of(model)
    if model.T2 != 0:
        raise ValueError(f"{name} is for one lag or integrator with dead time, not for {model}: half_rule reduces it")
    if model.delay == 0:
        raise ValueError(f"{model} has no dead time: {name} would have an infinite gain")
    return steepest_slope(model, name), model.delay / model.T1, model.delay
