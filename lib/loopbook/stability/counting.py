"""The poles of a closed loop in the right half-plane, counted by the argument principle."""

import math
from fractions import Fraction

import sympy

from loopbook.quasipolynomials import normal_form
from loopbook.expressions import s
from loopbook.stability.sums import MOST_INTERVALS, ROUNDING, Sums, prevailing, refined
from loopbook.transfer import transfer_function

ON_LIMIT, ENDLESS = -1, 10**9  # in place of a number of roots


class StabilityLimitError(ValueError):
    """The closed loop has poles on the imaginary axis: it is neither stable nor unstable."""


def is_stable(loop):
    """Say whether the closed loop of L(s), with negative feedback, is stable; one on the limit is not.

    Raises ValueError as `unstable_poles` does, but not for a loop on the limit.

    >>> is_stable(sympy.exp(-s) / s), is_stable(2 * sympy.exp(-s) / s)
    (True, False)
    """
    try:
        return unstable_poles(loop) == 0
    except StabilityLimitError:
        return False


def unstable_poles(loop):
    """Return the number of closed-loop poles in the right half-plane, for negative feedback around a loop.

    A pole that controller and process cancel in the open loop cannot be seen there: if it is unstable, the loop is, and
    the caller has to know. With `deadtime.Loop` as the argument the same holds, because its open loop is what counts.

    Arguments:
        loop: the transfer function L(s) of the open loop, an expression with numbers, a `System` or a `Loop`. Dead
            times may stand anywhere. It may have as many zeros as poles, but no more.
    Returns:
        An integer; ``math.inf`` where the loop's gain at high frequencies returns with a dead time and is above 1.
    Raises:
        StabilityLimitError: for closed-loop poles on the imaginary axis.
        ValueError: for letters, zero, an improper loop, an algebraic loop without solution, or as `unstable_roots`.

    >>> unstable_poles(sympy.exp(-s) / s), unstable_poles(2 * sympy.exp(-s) / s)
    (0, 2)
    >>> unstable_poles(2 * sympy.exp(-s) / s + sympy.exp(-3 * s) / (s + 1))
    2
    """
    L = open_loop(loop)
    try:
        return unstable_roots(characteristic(L))
    except StabilityLimitError:
        raise StabilityLimitError(f"the closed loop of {L} has poles on the imaginary axis") from None


def unstable_roots(denominator):
    """Return the number of roots in the right half-plane of a sum of polynomials with dead times.

    The argument principle counts them, by the phase of the sum along the imaginary axis. Between two frequencies the
    phase is believed only where a bound of the derivative proves that the sum has no zero there; otherwise the interval
    is halved. Beyond a certain frequency the highest power prevails, also by a bound.

    Arguments:
        denominator: ``{delay: polynomial in s}`` with numbers, as `deadtime.System` and `deadtime.normal_form` have it.
    Returns:
        An integer; ``math.inf`` where the highest power returns with dead times so strongly that there is no end of
        roots.
    Raises:
        StabilityLimitError: for roots on the imaginary axis, or so close to it that rounding would decide.
        ValueError: for letters, a sum that is zero, or one whose highest powers leave open whether it has an end of
            roots: where they have several dead times, and the sizes of their coefficients add up to that of the
            undelayed one or more.
    Source: the criterion of A. V. Mikhailov (1938), extended to dead times.

    >>> from loopbook.deadtime import System
    >>> unstable_roots(System(1 / (s + 2 * sympy.exp(-s) + sympy.exp(-sympy.sqrt(2) * s))).denominator)
    2
    """
    polynomials = {d: part if isinstance(part, sympy.Poly) else sympy.Poly(part, s) for d, part in denominator.items()}
    parts = {delay: part for delay, part in polynomials.items() if not part.is_zero}
    written = sympy.Add(*(part.as_expr() * sympy.exp(-delay * s) for delay, part in parts.items()))
    if letters := sorted(map(str, written.free_symbols - {s})):
        raise ValueError(f"give a number for {', '.join(letters)} in {written}")
    if 0 not in parts or any(delay < 0 for delay in parts):
        raise ValueError(f"the sum is {written}: expected a part without dead time, and later ones")
    order = max(part.degree() for part in parts.values())
    count = int(count_roots(Sums.exact(parts, order, parts[0].LC()))[0])
    if count == ON_LIMIT:
        raise StabilityLimitError(f"{written} has roots on the imaginary axis, or an endless row that approaches it")
    return math.inf if count == ENDLESS else count


# ---- from the loop to the sum


def open_loop(loop):
    """The open loop L(s) of whatever stands for it, with the errors that all questions share."""
    L = loop.open if hasattr(loop, "open_fraction") else transfer_function(loop)
    if letters := sorted(map(str, L.free_symbols - {s})):
        raise ValueError(f"give a number for {', '.join(letters)} in {L}")
    if L.has(sympy.I):
        raise ValueError(f"{L} is complex: expected real coefficients")
    if L == 0:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    return L


def _fraction(L):
    """Numerator and denominator of L, sums with dead times, for a loop that is proper."""
    above, below = normal_form(L)
    if not above:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    order = below[0].degree()
    for part in (*above.values(), *below.values()):
        if part.degree() > order:
            raise ValueError(
                f"{L} is improper: it has s**{part.degree()} over s**{order}; expected no more zeros than poles"
            )
    return above, below


def fraction_sums(L):
    """Numerator A and denominator B of a loop, as `Sums` with as many powers."""
    above, below = _fraction(L)
    order, divisor = below[0].degree(), below[0].LC()
    return Sums.exact(above, order, divisor), Sums.exact(below, order, divisor)


def characteristic(L):
    """The sum A + B whose roots are the poles of the closed loop of L = A/B."""
    above, below = _fraction(L)
    parts = dict(below)
    for delay, part in above.items():
        parts[delay] = parts.get(delay, 0) + part
    if 0 not in parts or parts[0].degree() < below[0].degree():
        raise ValueError(f"the algebraic loop of {L} has no solution: its gain at infinite frequency is -1")
    return parts


# ---- counting


def count_roots(sums):
    """The number of roots in the right half-plane of many sums; ON_LIMIT with some on the axis, ENDLESS without end."""
    import numpy

    coefficients, delays = sums.coefficients.copy(), sums.delays
    for part, delay in zip(coefficients[1:], delays[1:], strict=True):  # what has no dead time at some points
        coefficients[0] += numpy.where(delay == 0, part, 0)
        part[:, delay == 0] = 0
    counts = numpy.zeros(sums.count, dtype=int)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        returning = coefficients[1:, -1] / coefficients[0, -1]
    counts[coefficients[0, -1] == 0] = ENDLESS
    for point in numpy.flatnonzero(~(abs(returning).sum(axis=0) < 1) & (counts == 0)):
        later = returning[:, point]
        counts[point] = _without_end(later[later != 0], delays[1:, point][later != 0])
    points = numpy.flatnonzero(counts == 0)
    if len(points):
        coefficients = coefficients[:, :, points] / coefficients[0, -1, points]
        counts[points] = _by_turns(Sums(coefficients, delays[:, points]).slower(prevailing(coefficients)))
    return counts


def _by_turns(sums):
    """The number of roots by the turns of the phase, from zero to the frequency 1 where the highest power prevails."""
    import numpy

    every, longest = numpy.arange(sums.count), sums.delays.max(axis=0)
    zero, one = numpy.zeros(sums.count), numpy.ones(sums.count)
    phase, limit = numpy.zeros(sums.count), numpy.zeros(sums.count, dtype=bool)

    def mark_limit(which, values, w, size):
        limit[which[abs(values) <= (ROUNDING + 4e-16 * w * longest[which]) * size]] = True

    def undecided(intervals):
        which, a, b, at_a, at_b = intervals
        size, slope = sums.bounds(which, b)
        mark_limit(which, at_b, b, size)
        # a zero in between would need more change than the bound of the derivative allows
        proven = abs(at_a) + abs(at_b) > (b - a) * slope + ROUNDING * size
        turns = numpy.angle(at_b[proven] * at_a[proven].conj())
        phase[:] += numpy.bincount(which[proven], weights=turns, minlength=sums.count)
        return ~proven & ~limit[which]

    mark_limit(every, sums.value(every, zero), zero, sums.bounds(every, zero)[0])
    refined(sums.value, every, zero, one, undecided, MOST_INTERVALS + 3000 * sums.count)
    # of n roots on the left, each turns the phase by a quarter turn; the rest of it comes beyond the frequency 1
    rest = numpy.angle(sums.value(every, one) * (-1j) ** sums.order)
    return numpy.where(limit, ON_LIMIT, numpy.rint(sums.order / 2 - (phase - rest) / math.pi))


def _without_end(later, delays):
    """ENDLESS or ON_LIMIT where 1 + sum(later*exp(-delays*s)) has roots in the right half-plane or on the axis."""
    import numpy

    # with dead times that are multiples of one, these are roots of a polynomial in exp(unit*s)
    ratios = [Fraction(float(delay / delays[0])).limit_denominator(1000) for delay in delays]
    unit = Fraction(math.gcd(*(r.numerator for r in ratios)), math.lcm(*(r.denominator for r in ratios)))
    powers = [int(ratio / unit) for ratio in ratios]
    exact = all(abs(r * delays[0] / delay - 1) < 1e-14 for r, delay in zip(ratios, delays, strict=True))
    if exact and max(powers) <= 100:
        polynomial = numpy.zeros(max(powers) + 1)
        polynomial[0] = 1
        numpy.add.at(polynomial, powers, later)
        if abs(numpy.roots(polynomial)).max() > 1 + 1e-9:
            return ENDLESS
        if len(later) == 1:
            return ON_LIMIT
    raise ValueError(
        f"whether there is an end of unstable roots is not decided: the highest power returns with the coefficients "
        f"{', '.join(f'{c:g}' for c in later)}, whose sizes add up to 1 or more, and with the dead times "
        f"{', '.join(f'{delay:g}' for delay in delays)}"
    )
