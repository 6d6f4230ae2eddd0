"""The poles in the right half-plane, of a system or of a closed loop, counted by the argument principle."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import sympy

from loopbook.expressions import s
from loopbook.quasipolynomials import DelayFraction, read
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import plus, times
from loopbook.stability.difference import Endless, at_endless_frequency, power_of_two, prevailing
from loopbook.stability.enclosures import (
    NARROWEST,
    Exact,
    UndecidedError,
    enclosed,
    exact_coefficient,
    geometric,
    origin,
    walk,
)
from loopbook.transfer import transfer_function

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy

ON_LIMIT, ENDLESS = -1, 10**9  # in place of a number of roots

Sum = dict[Fraction, tuple[int, ...]]


class StabilityLimitError(ValueError):
    """There are poles on the imaginary axis: what has them is neither stable nor unstable."""


# ---- what is asked


def is_stable(x: object) -> bool:
    """Say whether a system or a loop is stable; one on the limit is not.

    Of a `Loop` it is internal stability that is meant: a pole that controller and process cancel counts, too. To close
    the loop around L(s), ask `is_closed_loop_stable`.

    Arguments:
        x: a transfer function with numbers, an expression or a `System`; or a `Loop`.
    Raises:
        ValueError: as `unstable_poles`, but not for poles on the imaginary axis.

    >>> is_stable(1 / (s + sympy.exp(-s))), is_stable(1 / (s + 2 * sympy.exp(-s)))
    (True, False)
    """
    try:
        return unstable_poles(x) == 0
    except StabilityLimitError:
        return False


def unstable_poles(x: object) -> float:
    """Return the number of poles in the right half-plane of a system, or of a loop with all that is in it.

    Arguments:
        x: a transfer function with numbers, an expression or a `System`, which may also be improper; or a `Loop`, of
            which those poles count, too, that controller and process cancel, and those of `from_setpoint`.
    Returns:
        An integer; ``math.inf`` where the highest power of a denominator returns with a dead time too strongly.
    Raises:
        StabilityLimitError: for poles on the imaginary axis. One at zero that a zero of the numerator removes, as in
            (1 - exp(-s))/s, is none.
        ValueError: for letters, a loop that is improper or has no solution, or as `unstable_roots`.

    >>> unstable_poles(1 / (s - 1)), unstable_poles(1 / (s + 2 * sympy.exp(-s)))
    (1, 2)
    """
    if not _is_loop(x):
        H = open_loop(x, zero=True)
        return _count_of(H.denominator, removable=_zeros_at_origin(H.numerator), of=H.expr)
    process, controller = x.process_fraction, x.controller_fraction
    below = times(controller.denominator, process.denominator)
    parts = plus(times(controller.numerator, process.numerator), below)
    if _degree(parts) < _degree(below) or len(parts.get(Fraction(0), ())) < _degree(parts):
        _fraction(x.open_fraction)  # raises for what is improper
        raise ValueError(f"the algebraic loop of {x.open_fraction.expr} has no solution")
    count = _count_of(parts, removable=_common_zeros_at_origin(process, controller), of=f"{x}")
    R = getattr(x, "setpoint_fraction", None)
    if R is not None and R != controller and R.denominator != controller.denominator:
        count += _of_prefilter(R, controller, x)
    return count


def is_closed_loop_stable(loop: object) -> bool:
    """Say whether the closed loop of L(s), with negative feedback, is stable; one on the limit is not.

    Raises ValueError as `unstable_closed_loop_poles` does, but not for a loop on the limit.

    >>> is_closed_loop_stable(sympy.exp(-s) / s), is_closed_loop_stable(2 * sympy.exp(-s) / s)
    (True, False)
    """
    try:
        return unstable_closed_loop_poles(loop) == 0
    except StabilityLimitError:
        return False


def unstable_closed_loop_poles(loop: object) -> float:
    """Return the number of closed-loop poles in the right half-plane, for negative feedback around a loop.

    A pole that controller and process cancel in the open loop cannot be seen there. `unstable_poles` of a `Loop` counts
    it, this does not.

    Arguments:
        loop: the transfer function L(s) of the open loop, an expression with numbers, a `System` or a `Loop`. Dead
            times may stand anywhere. It may have as many zeros as poles, but no more.
    Returns:
        An integer; ``math.inf`` where the loop's gain at high frequencies returns with a dead time and is above 1.
    Raises:
        StabilityLimitError: for closed-loop poles on the imaginary axis.
        ValueError: for letters, an improper loop, an algebraic loop without solution, or as `unstable_roots`.

    >>> unstable_closed_loop_poles(sympy.exp(-s) / s), unstable_closed_loop_poles(2 * sympy.exp(-s) / s)
    (0, 2)
    >>> unstable_closed_loop_poles(2 * sympy.exp(-s) / s + sympy.exp(-3 * s) / (s + 1))
    2
    """
    L = open_loop(loop, zero=True)
    removable = min(_zeros_at_origin(L.numerator), _zeros_at_origin(L.denominator))
    return _count_of(characteristic(L), removable, of=f"the closed loop of {L.expr}")


def unstable_roots(denominator: Mapping) -> float:
    """Return the number of roots in the right half-plane of a sum of polynomials with dead times.

    The argument principle counts them, by the phase of the sum along the imaginary axis. On an interval of frequency the
    phase is believed only where an expansion with a bound of its rest proves that the sum has no zero there; otherwise
    the interval is divided, and computed with more digits where rounding is the reason. Beyond a certain frequency the
    highest power prevails, also by a bound. No more than a million intervals are looked at.

    Arguments:
        denominator: ``{delay: coefficients}``, the lowest power first, as `System.denominator` is; or with polynomials
            in s, as `deadtime.normal_form` has them.
    Returns:
        An integer; ``math.inf`` where the highest power returns with dead times so strongly that there is no end of
        roots.
    Raises:
        StabilityLimitError: for roots on the imaginary axis, or so close to it that their frequencies cannot be told
            from it.
        ValueError: for letters, a sum that is zero, or one whose highest powers leave open whether it has an end of
            roots: where they have several dead times that are no multiples of one, and the sizes of their coefficients
            add up to that of the undelayed one or more.
    Source: the criterion of A. V. Mikhailov (1938), extended to dead times.

    >>> unstable_roots({0: (0, 1), 1: (2,), Fraction(7, 5): (1,)})    # s + 2 exp(-s) + exp(-1.4 s)
    2
    """
    parts = _whole(denominator)
    if Fraction(0) not in parts or any(delay < 0 for delay in parts):
        raise ValueError(f"the sum is {_written(parts)}: expected a part without dead time, and later ones")
    return _count_of(parts, removable=0, of=_written(parts))


# ---- from what is given to sums


def _is_loop(x: object) -> bool:
    return hasattr(x, "open_fraction")


def open_loop(loop: object, zero: bool = False) -> DelayFraction:
    """The open loop L(s) of whatever stands for it, with the errors that all questions share."""
    if _is_loop(loop):
        return loop.open_fraction
    if not isinstance(loop, DelayFraction):
        expression = transfer_function(loop)
        if letters := sorted(map(str, expression.free_symbols - {s})):
            raise ValueError(f"give a number for {', '.join(letters)} in {expression}")
        if expression.has(sympy.I):
            raise ValueError(f"{expression} is complex: expected real coefficients")
        loop = read(expression)
    if not loop.numerator and not zero:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    return loop


def _fraction(L: DelayFraction) -> tuple[Sum, Sum]:
    """Numerator and denominator of L, sums with dead times, for a loop that is proper."""
    above, below = L.numerator, L.denominator
    order = len(below[Fraction(0)]) - 1
    for part in (*above.values(), *below.values()):
        if len(part) - 1 > order:
            raise ValueError(
                f"{L.expr} is improper: it has s**{len(part) - 1} over s**{order}; expected no more zeros than poles"
            )
    return above, below


def fraction_sums(L: DelayFraction) -> tuple[Quasipolynomials, Quasipolynomials]:
    """Numerator A and denominator B of a loop, with as many powers."""
    above, below = _fraction(L)
    order, divisor = len(below[Fraction(0)]) - 1, below[Fraction(0)][-1]
    return Quasipolynomials.exact(above, order, divisor), Quasipolynomials.exact(below, order, divisor)


def characteristic(L: DelayFraction) -> Sum:
    """The sum A + B whose roots are the poles of the closed loop of L = A/B."""
    above, below = _fraction(L)
    parts = plus(below, above)
    if len(parts.get(Fraction(0), ())) < len(below[Fraction(0)]):
        raise ValueError(f"the algebraic loop of {L.expr} has no solution: its gain at infinite frequency is -1")
    return parts


def _whole(denominator: Mapping) -> Sum:
    """A sum given with numbers of any kind, in whole ones."""
    parts = {}
    for delay, part in denominator.items():
        if isinstance(part, (sympy.Expr, sympy.Poly)):
            polynomial = part if isinstance(part, sympy.Poly) else sympy.Poly(part, s)
            if letters := sorted(map(str, polynomial.as_expr().free_symbols - {s})):
                raise ValueError(f"give a number for {', '.join(letters)} in {polynomial.as_expr()}")
            part = polynomial.all_coeffs()[::-1]
        coefficients = [_fraction_of(c) for c in part]
        while coefficients and not coefficients[-1]:
            coefficients.pop()
        if coefficients:
            parts[_fraction_of(delay)] = coefficients
    divisor = math.lcm(*(c.denominator for part in parts.values() for c in part))
    return {delay: tuple(int(c * divisor) for c in part) for delay, part in parts.items()}


def _fraction_of(number: object) -> Fraction:
    if isinstance(number, sympy.Expr):
        number = number if number.is_Rational else sympy.Rational(str(number.evalf(30)))
        return Fraction(int(number.p), int(number.q))
    return Fraction(number)


def _written(parts: Sum) -> str:
    terms = ((sum(c * s**n for n, c in enumerate(part)), sympy.Rational(str(delay))) for delay, part in parts.items())
    return str(sympy.Add(*(part * sympy.exp(-delay * s) for part, delay in terms)))


def _degree(parts: Sum) -> int:
    return max((len(part) for part in parts.values()), default=0)


def _zeros_at_origin(parts: Sum) -> int:
    """How often a sum is zero at s = 0."""
    if not parts:
        return 0
    value, n = Exact(parts, 0, 1, 1.0), 0
    while not exact_coefficient(value, n):
        n += 1
    return n


def _common_zeros_at_origin(*fractions: DelayFraction) -> int:
    """How many zeros at s = 0 numerators and denominators have in common, that are removed."""
    return sum(min(_zeros_at_origin(H.numerator), _zeros_at_origin(H.denominator)) for H in fractions)


def _of_prefilter(R: DelayFraction, C: DelayFraction, loop: object) -> float:
    """The unstable poles of the block from the setpoint that are not the controller's."""
    rest = R / C if C.numerator else R
    # the poles of R/C that are no zeros of C
    own = DelayFraction(rest.denominator, C.numerator or {Fraction(0): (1,)}).numerator
    return _count_of(own, removable=_zeros_at_origin(rest.numerator), of=f"the block from the setpoint of {loop}")


def _count_of(parts: Sum, removable: int, of: object) -> float:
    """The number of roots of an exact sum in the right half-plane, without so many at zero."""
    base = min(parts, default=Fraction(0))
    parts = {delay - base: part for delay, part in parts.items()}
    if not parts:
        raise ValueError(f"{of}: the sum is zero, expected one that is not")
    order = len(parts[Fraction(0)]) - 1
    if _degree(parts) - 1 > order:
        return math.inf
    divisor = parts[Fraction(0)][-1]
    sums = Quasipolynomials.exact(parts, order, divisor)
    count = int(count_roots(sums, Exact(parts, order, divisor, 1.0), removable)[0])
    if count == ON_LIMIT:
        raise StabilityLimitError(f"{of} has poles on the imaginary axis, or an endless row that approaches it")
    return math.inf if count == ENDLESS else count


# ---- counting


def count_roots(sums: Quasipolynomials, exact: Exact | None = None, removable: int = 0) -> numpy.ndarray:
    """The number of roots in the right half-plane of many sums; ON_LIMIT with some on the axis, ENDLESS without end.

    Arguments:
        exact: the same as `sums`, if it is a single one and more digits are at hand.
        removable: how many roots at zero do not count.
    """
    import numpy

    coefficients, delays = sums.coefficients, sums.delays
    if not delays[1:].all():
        coefficients = coefficients.copy()
        for part, delay in zip(coefficients[1:], delays[1:], strict=True):  # what has no dead time at some points
            coefficients[0] += numpy.where(delay == 0, part, 0)
            part[:, delay == 0] = 0
    counts = numpy.zeros(sums.count, dtype=int)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        returning = coefficients[1:, -1] / coefficients[0, -1]
    counts[coefficients[0, -1] == 0] = ENDLESS
    least, far = 1 - abs(returning).sum(axis=0), {}
    for point in numpy.flatnonzero(~(least > 0) & (counts == 0)):
        far[point] = at_endless_frequency(returning[:, point], delays[1:, point])
        least[point] = far[point].least
        if least[point] <= 0:
            counts[point] = ENDLESS if least[point] < 0 else ON_LIMIT
    points = numpy.flatnonzero(counts == 0)
    if len(points):
        coefficients = coefficients[:, :, points] / coefficients[0, -1, points]
        unit = power_of_two(prevailing(coefficients, least[points]))
        scaled = Quasipolynomials(coefficients, delays[:, points]).slower(unit)
        if exact is not None:
            exact = Exact(exact.parts, exact.order, exact.divisor, float(unit[0]))
        counts[points] = _by_turns(scaled, unit, [far.get(point) for point in points] if far else [], exact, removable)
    return counts


def _by_turns(sums, unit, far: list[Endless | None], exact, removable):
    """The number of roots by the turns of the phase, from zero to the frequency 1 where the highest power prevails."""
    import numpy

    one = numpy.ones(sums.count)
    phase, limit = numpy.zeros(sums.count), numpy.zeros(sums.count, dtype=bool)
    first, rest = sums[:1], None
    if len(sums.coefficients) > 1 and sums.coefficients[1:].any():
        first = Quasipolynomials(sums.coefficients[:1], sums.delays[:1])
        rest = Quasipolynomials(sums.coefficients[1:], sums.delays[1:])
    which, a, b = geometric(_lowest(sums, removable), one)
    if removable:
        start, turn = _above_origin(sums, removable, exact)
        phase += turn
        inside = b > start
        which, a, b = which[inside], numpy.maximum(a[inside], start), b[inside]

    def value(which, w, precise):
        return exact.taylor(w, 0)[0] if precise else sums.value(which, w)

    def judge(which, a, b, precise):
        c, r = (a + b) / 2, (b - a) / 2
        around = enclosed(sums, which, c, r, exact if precise else None)
        proven = around.least > 3 * around.noise
        at_a, at_b = value(which, a, precise), value(which, b, precise)
        turns = numpy.angle(at_b * at_a.conj())
        noisy = around.is_noisy
        if rest is not None and not proven.all():
            # where the undelayed part outweighs the others, the phase is its own, and less than a quarter turn more
            open_ = numpy.flatnonzero(~proven)
            alone = enclosed(first, which[open_], c[open_], r[open_])
            outweighs = alone.least > rest.sizes(which[open_], b[open_])[0] + 3 * alone.noise
            of = open_[outweighs]
            if len(of):
                alone_a, alone_b = first.value(which[of], a[of]), first.value(which[of], b[of])
                proven[of] = True
                turns[of] = numpy.angle(alone_b * alone_a.conj())
                turns[of] += numpy.angle(at_b[of] / alone_b) - numpy.angle(at_a[of] / alone_a)
        phase[:] += numpy.bincount(which[proven], weights=turns[proven], minlength=sums.count)
        if precise or exact is None:
            lost = ~proven & (
                (b - a <= 2 * NARROWEST * b) | (b < 1e-200) | (noisy & (around.spread < 64 * around.noise))
            )
            limit[which[lost]] = True
        return ~proven & ~limit[which], noisy, sums.longest[which]

    if not removable:
        # a sum that vanishes at zero; of an exact one, only where it does
        size, at_zero = sums.sizes(numpy.arange(sums.count), 0 * one)[0], sums.coefficients[:, 0].sum(axis=0)
        limit |= abs(at_zero) <= 1e-15 * size if exact is None else numpy.array([not exact_coefficient(exact, 0)])
    some = ~limit[which]
    walk(judge, which[some], a[some], b[some], "the number of unstable poles", unit, exact is not None)
    points = numpy.arange(sums.count)
    ends = sums.value(points, one) * (-1j) ** sums.order
    beyond = (
        numpy.array([each.phase(scale) if each else 0.0 for each, scale in zip(far, unit.tolist(), strict=True)])
        if far
        else 0.0
    )
    # of n roots on the left, each turns the phase by a quarter turn; the rest of it comes beyond the frequency 1
    left = beyond + numpy.angle(ends * numpy.exp(-1j * beyond))
    counts = (sums.order - removable) / 2 - (phase - left) / math.pi
    if (lost := numpy.flatnonzero(~limit & (abs(counts - numpy.rint(counts)) > 0.1))).size:
        raise UndecidedError("the number of unstable poles", 0.0, float(unit[lost[0]]))
    return numpy.where(limit, ON_LIMIT, numpy.rint(counts)).astype(int)


def _lowest(sums, removable):
    """A frequency about which the lowest power begins to give way to the others."""
    import numpy

    series = abs(sums._expansion[:, :, 0].sum(axis=0))
    with numpy.errstate(divide="ignore", invalid="ignore"):
        ratios = [(series[0] / series[k]) ** (1 / k) for k in range(1, len(series))]
    lowest = numpy.fmin.reduce([numpy.where(ratio > 0, ratio, numpy.nan) for ratio in ratios])
    return numpy.clip(numpy.nan_to_num(0.3 * lowest, nan=1e-3), 1e-30, 0.5)


def _above_origin(sums, removable, exact):
    """A frequency up to which a sum is about its lowest power, which is that of roots at zero, and its turn there."""
    import numpy

    series, more = origin(sums, removable + sums.order + 4, exact)
    series = series[:, 0]
    if not series[removable]:
        raise StabilityLimitError("there are poles at zero")
    lowest, start = abs(series[removable]), 0.1 / max(1.0, float(sums.longest[0]))
    powers = numpy.arange(len(series) - removable)
    while (abs(series[removable:]) * start**powers)[1:].sum() + 2 * more[0] * start ** len(powers) > lowest / 2:
        start /= 2
    at_start = sums.value(numpy.zeros(1, dtype=int), numpy.array([start])) if exact is None else exact.taylor(
        numpy.array([start]), 0)[0]  # fmt: skip
    return start, float(numpy.angle(at_start[0] / (1j**removable * series[removable])))
