"""Rules that start from an experiment in the closed loop: Good Gain, and the ultimate gain and period."""

from __future__ import annotations

import sympy
from sympy import Min
from sympy import Rational as Q

from loopbook.pid import PID
from loopbook.tuning.registry import rule
from loopbook.tuning.weighted import WeightedPID
from loopbook.types import Number
from plainmath.expressions import exact
from plainmath.validation import exact_in_range, exact_nonzero, exact_positive, one_of


@rule("Good Gain", needs="the Good Gain experiment", kind=("P", "PI", "PID"))
def good_gain(KpGG: Number, Tou: Number, kind: str = "PI") -> PID:
    """Return the settings of the Good Gain method.

    Arguments:
        KpGG: the gain with which the loop, under P control, overshoots after a setpoint step, and then undershoots
            barely.
        Tou: the time from that overshoot to the undershoot.
        kind: "P" (the experiment's own gain), "PI" or "PID".
    Raises:
        ValueError: for a gain of zero, a time that is not positive, or another kind.
    Source: Haugen, equations (10.1) to (10.3).

    >>> good_gain(1.5, 12)
    PID(Kp=6/5, Ti=18)
    """
    KpGG, Tou = exact_nonzero("KpGG", KpGG), exact_positive("Tou", Tou)
    Kp, Ti = Q("0.8") * KpGG, Q("1.5") * Tou
    rules = {"P": PID(KpGG), "PI": PID(Kp, Ti), "PID": PID(Kp, Ti, Ti / 4)}
    return rules[one_of("kind", kind, rules)]


@rule("Ziegler-Nichols", needs="the ultimate gain and period", kind=("P", "PI", "PID"))
def ziegler_nichols_ultimate(Ku: Number, Pu: Number, kind: str = "PID") -> PID:
    """Return the settings of Ziegler and Nichols from the ultimate gain and period.

    Arguments:
        Ku: the gain with which the loop oscillates forever under P control; negative for a negative process gain.
        Pu: the period of that oscillation.
        kind: "P", "PI" or "PID" (parallel form).
    Raises:
        ValueError: for a gain that is zero or infinite, a period that is not positive, or another kind.
    Source: Ziegler and Nichols (1942); Seborg et al., Table 12.6.

    >>> ziegler_nichols_ultimate(10, 6)
    PID(Kp=6, Ti=3, Td=3/4)
    """
    Ku, Pu = exact_nonzero("Ku", Ku), exact_positive("Pu", Pu)
    rules = {
        "P": PID(Q("0.5") * Ku),
        "PI": PID(Q("0.45") * Ku, Pu / Q("1.2")),
        "PID": PID(Q("0.6") * Ku, Pu / 2, Pu / 8),
    }
    return rules[one_of("kind", kind, rules)]


@rule(
    "Ziegler-Nichols",
    needs="the ultimate gain and period",
    overshoot={"some": "some overshoot", "none": "no overshoot"},
)
def modified_ziegler_nichols(Ku: Number, Pu: Number, overshoot: str = "some") -> PID:
    """Return PID settings from the ultimate gain and period, for less overshoot than Ziegler and Nichols' own.

    The settings for no overshoot are as the slide has them, and overshoot nevertheless. Its two times seem to be
    interchanged: with Ti = Pu/2 and Td = Pu/3, as in other publications, there is less of it (chapter 16).

    Arguments:
        Ku, Pu: as for `ziegler_nichols_ultimate`.
        overshoot: "some" or "none".
    Raises:
        ValueError: as `ziegler_nichols_ultimate`.
    Source: Seborg et al., slide on modified settings.

    >>> modified_ziegler_nichols(10, 6, overshoot="none")
    PID(Kp=2, Ti=2, Td=3)
    """
    Ku, Pu = exact_nonzero("Ku", Ku), exact_positive("Pu", Pu)
    rules = {"some": PID(Q("0.33") * Ku, Pu / 2, Pu / 3), "none": PID(Q("0.2") * Ku, Pu / 3, Pu / 2)}
    return rules[one_of("overshoot", overshoot, rules)]


@rule("Tyreus-Luyben", needs="the ultimate gain and period", kind=("PI", "PID"))
def tyreus_luyben(Ku: Number, Pu: Number, kind: str = "PI") -> PID:
    """Return the settings of Tyreus and Luyben, calmer than those of Ziegler and Nichols.

    Arguments:
        Ku, Pu: as for `ziegler_nichols_ultimate`.
        kind: "PI" or "PID" (parallel form).
    Raises:
        ValueError: as `ziegler_nichols_ultimate`.
    Source: Luyben and Luyben (1997); Seborg et al., Table 12.6.

    >>> tyreus_luyben(10, 5)
    PID(Kp=31/10, Ti=11)
    """
    Ku, Pu = exact_nonzero("Ku", Ku), exact_positive("Pu", Pu)
    rules = {
        "PI": PID(Q("0.31") * Ku, Q("2.2") * Pu),
        "PID": PID(Q("0.45") * Ku, Q("2.2") * Pu, Pu / Q("6.3")),
    }
    return rules[one_of("kind", kind, rules)]


@rule("Hang", needs="the static gain, and the ultimate gain and period")
def hang(K: Number, Ku: Number, Pu: Number, extrapolate: bool = False) -> WeightedPID:
    """Return PID settings by the refinement of Ziegler and Nichols' that weights the setpoint, as a `WeightedPID`.

    With ``k = K*Ku``. From 2.25 to 15 the settings are Ziegler and Nichols', and ``w_p = (15 - k)/(15 + k)``. From 1.5
    to 2.25 the integral time is shortened by the factor ``mu = 4*k/9``, and ``w_p = 8*(mu + 1)/17``.

    Arguments:
        K: static gain of the process.
        Ku, Pu: as for `ziegler_nichols_ultimate`.
        extrapolate: use the nearer formula also for k outside of 1.5 to 15.
    Raises:
        ValueError: as `ziegler_nichols_ultimate`, and outside of the range, unless it may be left.
    Source: Hang, Astrom and Ho, IEE Proceedings D 138 (1991) 111, named by Syder, Heeg and O'Dwyer, Table 1.

    >>> hang(2, 5, 6)
    WeightedPID(settings=PID(Kp=3, Ti=3, Td=3/4), w_p=1/5)
    """
    Kp, Ti, Td = (getattr(ziegler_nichols_ultimate(Ku, Pu), name) for name in ("Kp", "Ti", "Td"))
    k = exact_in_range("K*Ku", exact_nonzero("K", K) * exact(Ku), Q("1.5"), 15, extrapolate)
    mu = Min(4 * k / 9, 1)
    w_p = sympy.Piecewise(((15 - k) / (15 + k), k >= Q("2.25")), (8 * (mu + 1) / 17, True))
    return WeightedPID(PID(Kp, mu * Ti, Td), w_p)
