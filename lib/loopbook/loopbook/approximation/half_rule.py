"""Skogestad's half rule, and his rules for zeros: from a process with many lags to a simple model."""

from __future__ import annotations

import math
from collections.abc import Sequence

import sympy

from loopbook.approximation.model import SOPDT, Step, factors, sort_lags
from loopbook.transfer import dead_time
from loopbook.types import Number, TransferFunctionLike
from plainmath.expressions import s
from plainmath.validation import exact_not_negative, exact_positive, whole


def half_rule(
    H: TransferFunctionLike, order: int = 1, Tc: Number | None = None, largest_first: Sequence[Number] | None = None
) -> SOPDT:
    """Return the `SOPDT` that Skogestad's half rule finds for a process with many lags.

    Half of the largest neglected lag goes to the smallest lag that is kept, the other half to the dead time. All
    smaller lags, and the time constants of zeros in the right half-plane, go to the dead time. Zeros in the left
    half-plane come first: the largest one first, each against a lag beside it, by `zero_rule`.

    Arguments:
        H: transfer function with one dead time or none, with real poles, none of them in the right half-plane; in any
            form, or of python-control.
        order: 1 keeps one lag, 2 keeps two; an integrator counts as an infinite lag.
        Tc: closed-loop time constant for which the model is meant; the rules for zeros compare with it. Without it, it
            is the effective dead time of the model itself.
        largest_first: lags with symbols, sorted, where the symbols leave their order open.
    Returns:
        The model; its `steps` say which rule did what.
    Raises:
        ValueError: for poles in the right half-plane, complex poles or zeros, several dead times, more zeros than
            poles, a zero or several poles too many at the origin, lags of unknown order, or where the rules for zeros
            are made for a dead time and give none that agrees with it, or several: then say Tc.
    Source: Skogestad, slides on the half rule and on the approximation of zeros.

    >>> half_rule(1 / ((s + 1) * (0.6 * s + 1)))
    SOPDT(K=1, T1=13/10, delay=3/10)
    >>> half_rule(5 / (s * (3 * s + 1)))
    SOPDT(K=5, T1=oo, delay=3/2)
    """
    if (order := whole("order", order)) > 2:
        raise ValueError(f"order is {order}: expected 1 or 2")
    if Tc is not None:
        Tc = exact_positive("Tc", Tc, symbols=False)
    H, delay, process = factors(H)
    if len(process.zeros) > len(process.lags):
        raise ValueError(f"{H} has more zeros than poles: expected at least as many poles")
    if sympy.oo in process.zeros:
        raise ValueError(f"{H} has a zero at the origin: the half rule needs a process with a static gain")
    if process.lags.count(sympy.oo) > order:
        raise ValueError(f"{H} has more than {order} integrators: expected at most as many as the order of the model")
    if unstable := [T for T in process.lags if T.is_negative]:
        raise ValueError(f"{H} has a pole at {-1 / unstable[0]} in the right half-plane: the half rule has no answer")
    for T in process.lags + process.zeros:
        if T.is_extended_positive is None and T.is_extended_negative is None:
            raise ValueError(f"the sign of {T} is not known: expected positive symbols")
    inverse = [-T for T in process.zeros if T.is_negative]
    lifting = [T for T in process.zeros if T.is_positive]
    steps = [Step("zero in the right half-plane", 1 - T * s, dead_time(T)) for T in inverse]
    delay += sympy.Add(*inverse)
    lags = sort_lags(process.lags, largest_first)
    if not lifting:
        return _halved(process.K, lags, delay, order, steps)
    if letters := sorted({str(x) for T in [*lags, *lifting, delay] for x in T.free_symbols}):
        raise ValueError(f"the rules for the zeros of {H} compare times: give numbers for {', '.join(letters)}")

    lifting.sort(reverse=True)
    if Tc is None:
        found = _for_itself(lags, lifting, delay, order)
        if len(found) != 1:
            what = " and ".join(map(str, found)) + " agree with themselves" if found else "none agrees with itself"
            raise ValueError(f"the rules for the zeros of {H} leave the dead time of the model open: {what}; say Tc")
        Tc = found[0]
    lags, applied = _without_zeros(lags, lifting, Tc)
    steps += [Step(rule, _factor(T0) / _factor(lag), gain / _factor(left)) for rule, T0, lag, gain, left in applied]
    return _halved(process.K * sympy.Mul(*(gain for _, _, _, gain, _ in applied)), lags, delay, order, steps)


def zero_rule(T0: Number, lag: Number, Tc: Number) -> Step:
    """Return what Skogestad's rules T1, T1a, T1b, T2 and T3 put in place of ``(T0*s + 1)/(lag*s + 1)``.

    Arguments:
        T0: time constant of the zero, positive.
        lag: the lag that it is set against, positive; oo for an integrator, whose place 1/s takes that of the lag.
        Tc: closed-loop time constant for which the approximation is meant; the effective dead time in the source.
    Returns:
        `Step`, from the rule's name to a gain or, by rule T3, a gain with a smaller lag.
    Raises:
        ValueError: for symbols, or a number that is not positive; Tc may be zero.
    Source: Skogestad, slide on the approximation of zeros in the left half-plane.

    >>> zero_rule(15, 20, Tc=0.15)
    Step(rule='T2', before=(15*s + 1)/(20*s + 1), after=3/4)
    """
    T0, lag = exact_positive("T0", T0, symbols=False), exact_positive("lag", lag, infinite=True, symbols=False)
    Tc = exact_not_negative("Tc", Tc, symbols=False)
    rule, gain, left = _rule(T0, lag, Tc)
    return Step(rule, (T0 * s + 1) / _factor(lag), gain / _factor(left))


def _rule(T0, lag, Tc):
    """The name of the rule, the gain, and the lag that remains. Of an integrator, the slope stands for the gain."""
    if T0 >= lag >= Tc:
        return "T1", T0 / lag, 0
    if T0 >= Tc >= lag:
        return "T1a", T0 / Tc, 0
    if lag <= T0:
        return "T1b", 1, 0
    scale = 1 if lag == sympy.oo else lag
    if 5 * Tc <= T0:
        return "T2", T0 / scale, 0
    shorter = min(lag, 5 * Tc)
    return "T3", shorter / scale, shorter - T0


def _factor(lag):
    return s if lag == sympy.oo else lag * s + 1


def _neighbour(T0, lags):
    """The lag that a zero is set against: the next larger one, unless the next smaller one is close and closer."""
    larger = min((T for T in lags if T >= T0), default=None)
    smaller = max((T for T in lags if T < T0), default=None)
    if larger is None or smaller is None:
        return smaller if larger is None else larger
    return smaller if T0 / smaller < larger / T0 and 8 * smaller > 5 * T0 else larger


def _without_zeros(lags, zeros, Tc):
    """The lags that the rules for zeros leave, the largest first, and what each rule did."""
    lags, applied = list(lags), []
    for T0 in zeros:
        lag = _neighbour(T0, lags)
        lags.remove(lag)
        rule, gain, left = _rule(T0, lag, Tc)
        applied.append((rule, T0, lag, gain, left))
        lags += [left] if left != 0 else []
    return sorted(lags, reverse=True), applied


def _for_itself(lags, zeros, delay, order):
    """The dead times for which the model that is made for one has that one, and to which an iteration would return.

    The dead time of the model is piecewise linear in the one it is made for. So from a point on the right piece, one
    step of Newton's method ends on the solution: the search visits many points, and exact numbers have the last word.
    """

    def effective(Tc, lags, zeros, delay):
        neglected = _without_zeros(lags, zeros, Tc)[0][order:]
        return delay + sum(neglected) - (neglected[0] / 2 if neglected else 0)

    def solution(Tc, *process):
        """A dead time that agrees with itself if it is on the piece of Tc; None if an iteration would leave it."""
        found = effective(Tc, *process)
        near = Tc + (Tc or 1) / 10**6
        slope = (effective(near, *process) - found) / (near - Tc)
        return Tc + (found - Tc) / (1 - slope) if abs(slope) < 1 else None

    rough = [float(T) for T in lags], [float(T) for T in zeros], float(delay)
    end = rough[2] + sum(T for T in (*rough[0], *rough[1]) if math.inf > T)
    points = []
    for Tc in [0.0, *(end * 1.05**-k for k in range(200))]:
        point = solution(Tc, *rough)
        agrees = point is not None and point >= 0 and abs(effective(point, *rough) - point) <= 1e-9 * end
        if agrees and all(abs(point - other) > 1e-6 * end for other in points):
            points.append(point)
    exactly = (solution(sympy.Rational(point), lags, zeros, delay) for point in sorted(points))
    return [sympy.sympify(Tc) for Tc in exactly if Tc is not None]


def _halved(K, lags, delay, order, steps):
    """The model that the half rule makes of lags, the largest first."""
    kept, (half, *small) = lags[:order], lags[order:] or [sympy.S.Zero]
    if half != 0:
        last = kept[-1] + half / 2
        before = 1 / (_factor(kept[-1]) * _factor(half))
        steps = [*steps, Step("half rule", before, dead_time(half / 2) / _factor(last))]
        kept[-1] = last
    steps = [*steps, *(Step("small lag", 1 / _factor(T), dead_time(T)) for T in small)]
    if order == 2 and len(kept) == 2 and kept[0] != sympy.oo and (kept[1] - kept[0]).is_positive:
        kept.reverse()  # the lag that grew may be the larger one now
    return SOPDT(K, *kept, delay=delay + half / 2 + sympy.Add(*small), steps=tuple(steps))
