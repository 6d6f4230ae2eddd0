"""Skogestad's rules, derived from a model and a desired closed loop, and what follows for a process that changes."""

from __future__ import annotations

import sympy
from sympy import Max, Min
from sympy import Rational as Q

from loopbook.approximation import model_of
from loopbook.pid import PID
from loopbook.tuning.registry import rule
from loopbook.tuning.step_response_rules import steepest_slope
from loopbook.types import Number, TransferFunctionLike
from plainmath.validation import exact_not_negative, exact_positive, one_of


@rule("Skogestad", needs="one or two lags or integrators")
def simc(model: TransferFunctionLike, Tc: Number | None = None, c: Number = 4) -> PID:
    """Return Skogestad's settings, of a PI or PID controller in serial form.

    A lag T1 and an integrator are one case, since an integrator is an infinite lag with a finite slope K/T1: the rows
    ``K/s``, ``K/(T1*s + 1)``, ``K/(s*(T2*s + 1))`` and ``K/((T1*s + 1)*(T2*s + 1))`` of the tables have one formula.
    For one lag the controller is PI; a second one is cancelled by Td = T2. A double integrator has a row of its own,
    without c.

    Arguments:
        model: one or two lags or integrators, with or without dead time.
        Tc: the desired time constant of the closed loop, in the unit of the lags; the dead time if not given.
        c: factor of the integral time, also called k1: 4 in the original, 2 or 1.44 for faster recovery from loads.
    Raises:
        ValueError: for a process that has neither dead time nor a Tc, or no lag; or a c that is not positive.
    Source: Skogestad (2003); Haugen, Table 10.1, and the tuning chapter's Tables 7.1 and 7.2.

    >>> from loopbook import s
    >>> K, delay, Tc = sympy.symbols("K delay T_c", positive=True)
    >>> simc(K * sympy.exp(-delay * s) / s, Tc)
    PID(Kp=1/(K*(T_c + delay)), Ti=4*T_c + 4*delay, form='serial')
    >>> simc(2 * sympy.exp(-s) / ((10 * s + 1) * (3 * s + 1)))
    PID(Kp=5/2, Ti=8, Td=3, form='serial')
    """
    model, c = model_of(model), exact_positive("c", c)
    if Tc is None and model.delay == 0:
        raise ValueError(f"{model} has no dead time to take Tc from: choose Tc, for example half of the largest lag")
    total = model.delay + (model.delay if Tc is None else exact_not_negative("Tc", Tc))
    if total == 0:
        raise ValueError("Tc and the dead time are both 0: expected a positive Tc")
    if model.T2.is_infinite:
        return PID(1 / (4 * model.K * total**2), 4 * total, 4 * total, form="serial")
    slope = steepest_slope(model, "Skogestad's rule")
    return PID(1 / (slope * total), Min(model.T1, c * total), model.T2, form="serial")


def skogestad_integral_time(T1: Number, Tc: Number, delay: Number, c: Number = 4) -> sympy.Expr:
    """Return Skogestad's integral time: the lag, but no more than c times the closed loop's time and the dead time.

    Arguments:
        T1, Tc, delay: largest lag, desired time constant of the closed loop, dead time, in one unit.
        c: 4 in the original.
    Raises:
        ValueError: for a time that is negative, no lag, or neither dead time nor a Tc.
    Source: Seborg et al., equation (12-34).

    >>> skogestad_integral_time(100, Tc=1, delay=1)
    8
    """
    total = exact_positive("Tc + delay", exact_not_negative("Tc", Tc) + exact_not_negative("delay", delay))
    return Min(exact_positive("T1", T1, infinite=True), exact_positive("c", c) * total)


def closed_loop_time(model: TransferFunctionLike, guideline: str = "skogestad") -> sympy.Expr | sympy.Interval:
    """Return the desired time constant Tc of the closed loop by one of three guidelines for IMC.

    Arguments:
        model: a lag with dead time; for "skogestad" anything with dead time.
        guideline: "rivera": Tc/delay > 0.8 and Tc > 0.1 T;  "chien": T > Tc > delay;  "skogestad": Tc = delay.
    Returns:
        An open `sympy.Interval`, or for "skogestad" the value.
    Raises:
        ValueError: for a process to which the guideline does not apply: by "chien" no Tc is left where the dead time
            is not shorter than the lag.
    Source: Rivera et al. (1986), Chien and Fruehauf (1990), Skogestad (2003), in Seborg et al., chapter 12.

    >>> from loopbook import s
    >>> closed_loop_time(sympy.exp(-4 * s) / (20 * s + 1), "rivera")
    Interval.open(16/5, oo)
    """
    model = model_of(model)
    if model.delay == 0:
        raise ValueError(f"{model} has no dead time: the guidelines for Tc need one")
    if one_of("guideline", guideline, ("rivera", "chien", "skogestad")) == "skogestad":
        return model.delay
    if model.is_integrating or model.T1 == 0 or model.T2 != 0:
        raise ValueError(f"the guideline {guideline!r} is for one lag with dead time, not for {model}")
    if guideline == "rivera":
        return sympy.Interval.open(Max(Q("0.8") * model.delay, Q("0.1") * model.T1), sympy.oo)
    if (model.delay - model.T1).is_nonnegative:
        raise ValueError(f"by 'chien' no Tc lies between the dead time and the lag of {model}")
    return sympy.Interval.open(model.delay, model.T1)


def adjusted(
    settings: PID, before: TransferFunctionLike, after: TransferFunctionLike, Tc: Number | None = None, c: Number = 4
) -> PID:
    """Return settings for a process that has changed, from those that suited it before.

    Each is multiplied by the ratio of Skogestad's settings after and before, in the form (serial or parallel) that the
    settings have. Where Skogestad's rule has no derivative term, Td follows Ti. The filter follows Td.

    Arguments:
        settings: a `PID`, found by whatever rule.
        before, after: the process, of the same kind both times, as for `simc`.
        Tc, c: as for `simc`.
    Raises:
        ValueError: for processes of different kinds, or as `simc`.
    Source: Haugen, Section 10.5.2.

    >>> from loopbook import s
    >>> before, after = sympy.exp(-s) / s, sympy.exp(-2 * s) / s
    >>> adjusted(PID(0.6, Ti=5), before, after)
    PID(Kp=3/10, Ti=10)
    """
    if not isinstance(settings, PID):
        raise ValueError(f"the settings are {settings!r}: expected a PID")
    before, after = model_of(before), model_of(after)
    kinds = [(m.is_integrating, m.T2.is_infinite, m.T2 == 0, m.delay == 0) for m in (before, after)]
    if kinds[0] != kinds[1]:
        raise ValueError(f"{before} becomes {after}: expected a process of the same kind")
    old, new = (simc(m, Tc, c) for m in (before, after))
    if settings.form == "parallel":
        old, new = old.parallel(), new.parallel()
    factor = {name: sympy.cancel(getattr(new, name) / getattr(old, name)) for name in ("Kp", "Ti")}
    slower = factor["Ti"] if old.Td == 0 else sympy.cancel(new.Td / old.Td)
    times = (settings.Ti * factor["Ti"], settings.Td * slower, settings.Tf * slower)
    return PID(settings.Kp * factor["Kp"], *times, form=settings.form)
