"""The poles in the right half-plane, of a system or of a closed loop, counted by the argument principle."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.quasipolynomials import DelayFraction, read
from loopbook.quasipolynomials.arrays import DEGREE, Quasipolynomials
from loopbook.quasipolynomials.fraction import (
    Quasipolynomial,
    common_polynomial,
    expression,
    lowest_term,
    plus,
    taylor_coefficient,
    times,
)
from loopbook.stability.certified import certified_count
from loopbook.stability.difference import AtInfinity, at_infinite_frequency, power_of_two, prevailing
from loopbook.stability.enclosures import (
    NARROWEST,
    Exact,
    UndecidedError,
    enclosed,
    geometric,
    origin,
    walk,
)
from loopbook.stability.polynomials import unstable_roots_of
from loopbook.transfer import transfer_function
from plainmath.expressions import s

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

ON_LIMIT, INFINITELY_MANY = -1, 10**9  # in place of a number of roots
MOST_INTERVALS, MORE_INTERVALS = 400_000, 2_000  # in all, and for each quasipolynomial
FEW_TERMS = 1  # the degree of expansions for many quasipolynomials
DIGITS = 25  # from which a coefficient may be no fraction
RATIO, MANY_RATIO = 1.5, 2.0  # of the frequencies at the ends of an interval, at first; of 50 quasipolynomials and more


class StabilityLimitError(ValueError):
    """There are poles on the imaginary axis, proved: what has them is neither stable nor unstable."""


# ---- what is asked


def is_stable(x: object) -> bool:
    """Say whether a system or a loop is stable; one with poles on the imaginary axis is not.

    With python-flint the answer is certified, without it validated (docs/stability.md).

    Of a `Loop` it is internal stability that is meant: a pole that controller and process cancel counts, too. To close
    the loop around L(s), ask `is_closed_loop_stable`.

    Arguments:
        x: a transfer function with numbers, an expression or a `System`; or a `Loop`.
    Raises:
        UndecidedError, ValueError: as `unstable_poles`, but not for poles on the imaginary axis.

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
        UndecidedError: for poles so close to the axis that it is not told on which side they are.
        ValueError: for symbols, a loop that is improper or has no solution, or as `unstable_roots`.

    >>> unstable_poles(1 / (s - 1)), unstable_poles(1 / (s + 2 * sympy.exp(-s)))
    (1, 2)
    """
    if not _is_loop(x):
        H = open_loop(x, zero=True)
        return _count_of(H.denominator, H.removable, lambda: H.expr)
    process, controller = x.process_fraction, x.controller_fraction
    below = times(controller.denominator, process.denominator)
    parts = plus(times(controller.numerator, process.numerator), below)
    if _degree(parts) < _degree(below) or len(parts.get(Fraction(0), ())) < _degree(parts):
        _fraction(x.open_fraction)  # raises for what is improper
        raise ValueError(f"the algebraic loop of {x.open_fraction.expr} has no solution")
    count = _count_of(parts, process.removable + controller.removable, lambda: x)
    R = getattr(x, "setpoint_fraction", None)
    if R is not None and controller != R and R.denominator != controller.denominator:
        count += _of_prefilter(R, controller, x)
    return count


def is_closed_loop_stable(loop: object) -> bool:
    """Say whether the closed loop of L(s), with negative feedback, is stable; one on the limit, proved, is not.

    Raises UndecidedError and ValueError as `unstable_closed_loop_poles` does, but not for a loop on the limit.

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
        StabilityLimitError, UndecidedError: for closed-loop poles on the imaginary axis or beside it, as
            `unstable_poles`.
        ValueError: for symbols, an improper loop, an algebraic loop without solution, or as `unstable_roots`.

    >>> unstable_closed_loop_poles(sympy.exp(-s) / s), unstable_closed_loop_poles(2 * sympy.exp(-s) / s)
    (0, 2)
    >>> unstable_closed_loop_poles(2 * sympy.exp(-s) / s + sympy.exp(-3 * s) / (s + 1))
    2
    """
    L = open_loop(loop, zero=True)
    return _count_of(characteristic(L), L.removable, lambda: f"the closed loop of {L.expr}")


def unstable_roots(denominator: Mapping, removable: int = 0) -> float:
    """Return the number of roots in the right half-plane of a sum of polynomials with dead times.

    The argument principle counts them, by the phase of the sum along the imaginary axis. On an interval of frequency
    the phase is believed only where an expansion with a bound of its rest proves that the sum has no zero there;
    otherwise the interval is divided. Beyond a certain frequency the highest power prevails, also by a bound. So the
    number is certified, with balls of up to 2,048 binary digits, or validated (docs/stability.md). What is still not
    told is decided without digits for a polynomial, and for one that all parts have in common, if the coefficients are
    fractions of fewer than 25 digits. (Without such a factor there can be roots on the axis other than zero only where
    the highest power returns with a dead time of which the others are multiples, or where several dead times are no
    multiples of one.)

    Arguments:
        denominator: ``{delay: coefficients}``, the lowest power first, as `System.denominator` is.
        removable: how many roots at zero do not count, because a numerator has them as well.
    Returns:
        An integer; ``math.inf`` where the highest power returns with dead times so strongly that there is no end of
        roots.
    Raises:
        StabilityLimitError: for roots on the imaginary axis, or an infinite row that approaches it.
        UndecidedError: for roots that are closer to the axis than can be told; it says at which frequencies.
        ValueError: for a sum that is zero, or one whose highest powers leave open whether it has an end of
            roots: where they have several dead times that are not multiples of one, and the sizes of their coefficients
            add up to that of the undelayed one or more.
    Source: the criterion of A. V. Mikhailov (1938), extended to dead times.

    >>> unstable_roots({0: (0, 1), 1: (2,), Fraction(7, 5): (1,)})    # s + 2 exp(-s) + exp(-1.4 s)
    2
    """
    fractions = {Fraction(delay): [*map(Fraction, part)] for delay, part in denominator.items()}
    divisor = math.lcm(*(c.denominator for part in fractions.values() for c in part))
    parts: Quasipolynomial = {}
    for delay, part in fractions.items():
        parts = plus(parts, {delay: tuple(int(c * divisor) for c in part)})
    if Fraction(0) not in parts or any(delay < 0 for delay in parts):
        raise ValueError(f"the sum is {expression(parts)}: expected a part without dead time, and later ones")
    return _count_of(parts, removable, lambda: expression(parts))


# ---- from what is given to quasipolynomials


def _is_loop(x: object) -> bool:
    return hasattr(x, "open_fraction")


def cancels(loop: object) -> bool:
    """Whether controller and process of a `Loop` cancel a pole in the open loop."""
    if not _is_loop(loop):
        return False
    below = times(loop.controller_fraction.denominator, loop.process_fraction.denominator)
    return _degree(below) > _degree(loop.open_fraction.denominator) or len(below) > len(loop.open_fraction.denominator)


def open_loop(loop: object, zero: bool = False) -> DelayFraction:
    """The open loop L(s) of whatever stands for it, with the errors that all questions share."""
    if _is_loop(loop):
        return loop.open_fraction
    if not isinstance(loop, DelayFraction):
        expression = transfer_function(loop)
        if symbols := sorted(map(str, expression.free_symbols - {s})):
            raise ValueError(f"give a number for {', '.join(symbols)} in {expression}")
        if expression.has(sympy.I):
            raise ValueError(f"{expression} is complex: expected real coefficients")
        loop = read(expression)
    if not loop.numerator and not zero:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    return loop


def _fraction(L: DelayFraction) -> tuple[Quasipolynomial, Quasipolynomial]:
    """Numerator and denominator of L, quasipolynomials with dead times, for a loop that is proper."""
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


def characteristic(L: DelayFraction) -> Quasipolynomial:
    """The quasipolynomial A + B whose roots are the poles of the closed loop of L = A/B."""
    above, below = _fraction(L)
    parts = plus(below, above)
    if len(parts.get(Fraction(0), ())) < len(below[Fraction(0)]):
        raise ValueError(f"the algebraic loop of {L.expr} has no solution: its gain at infinite frequency is -1")
    return parts


def _degree(parts: Quasipolynomial) -> int:
    return max((len(part) for part in parts.values()), default=0)


def _of_prefilter(R: DelayFraction, C: DelayFraction, loop: object) -> float:
    """The unstable poles of the block from the setpoint that are not the controller's."""
    rest = R / C if C.numerator else R
    # the poles of R/C that are no zeros of C
    own = DelayFraction(rest.denominator, C.numerator or {Fraction(0): (1,)}).numerator
    both = min(lowest_term(rest.numerator)[0], lowest_term(own)[0]) if rest.numerator else 0
    return _count_of(own, both, lambda: f"the block from the setpoint of {loop}")


def _count_of(parts: Quasipolynomial, removable: int, name: Callable[[], object]) -> float:
    """The number of roots of an exact quasipolynomial in the right half-plane, without so many at zero."""
    base = min(parts, default=Fraction(0))
    parts = {delay - base: part for delay, part in parts.items()}
    if not parts:
        raise ValueError(f"{name()}: the sum is zero, expected one that is not")
    order, divisor = len(parts[Fraction(0)]) - 1, parts[Fraction(0)][-1]
    if _degree(parts) - 1 > order:
        return math.inf
    count: float | None = ON_LIMIT
    try:
        if taylor_coefficient(parts, removable):
            count = certified_count(parts, removable)
        if count is None:
            count = int(count_roots(Quasipolynomials.exact(parts, order, divisor), removable)[0])
            returning = abs(sum(part[order] for delay, part in parts.items() if delay and len(part) > order))
            if count == ON_LIMIT and returning != abs(divisor):
                raise UndecidedError("the number of unstable poles", 0.0, math.inf)
    except UndecidedError as reason:
        common, rest = common_polynomial(parts)
        zeros = min(removable, next(k for k, c in enumerate(common) if c))
        count = unstable_roots_of(common[zeros:])
        rounded = any(len(str(abs(c)).rstrip("0")) >= DIGITS for c in common)
        if len(common) == 1 or (rounded and count is not None):
            raise UndecidedError(f"{reason.what} of {name()}", reason.low, reason.high) from None
        if count is not None:
            return count + _count_of(rest, removable - zeros, name)
    if count is None or count == ON_LIMIT:
        raise StabilityLimitError(f"{name()} has poles on the imaginary axis, or an infinite row that approaches it")
    return math.inf if count == INFINITELY_MANY else count


# ---- counting


def count_closed(
    A: Quasipolynomials, B: Quasipolynomials, factor: float | np.ndarray = 1.0, near: np.ndarray | None = None
) -> np.ndarray:
    """The number of unstable poles of many closed loops of ``factor*A/B``, as `count_roots` returns it.

    Zeros at the origin that A and B have in common are no poles, as in a moving average (1 - exp(-s))/s, and where the
    highest power of B vanishes, as of a lag that is zero, the loop is one of lower order.
    """
    counts = np.empty(max(A.count, B.count))
    for points, above, below in of_one_order(A, B):
        closed = below + (factor[points] if np.ndim(factor) else factor) * above
        removable = shared_at_origin(above, below)
        for n in set(removable.tolist()):
            some = removable == n
            hints = None if near is None else near[points][some]
            counts[points[some]] = count_roots(closed[some], removable=n, near=hints)
    return counts


def of_one_order(
    A: Quasipolynomials, B: Quasipolynomials
) -> Iterator[tuple[np.ndarray, Quasipolynomials, Quasipolynomials]]:
    """Many loops A/B, as groups in which the highest power of B does not vanish: which ones, and their A and B.

    Raises ValueError where A has a higher power than B.
    """
    count = max(A.count, B.count)
    A, B = (
        Quasipolynomials(np.broadcast_to(x.coefficients, (*x.coefficients.shape[:2], count)), x.delays) for x in (A, B)
    )
    rows = [np.pad(x.coefficients, ((0, 0), (0, max(A.order, B.order) - x.order), (0, 0))) for x in (A, B)]
    tops = [x.any(axis=0)[::-1].argmax(axis=0) for x in rows]
    if (tops[0] < tops[1]).any() and not (rows[0][:, :, tops[0] < tops[1]] == 0).all():
        raise ValueError("the loop is improper: expected no more zeros than poles")
    for top in set(tops[1].tolist()):
        points = np.flatnonzero(tops[1] == top)
        end = rows[0].shape[1] - top
        above, below = (
            Quasipolynomials(x[:, :end, points], y.delays[:, points]) for x, y in zip(rows, (A, B), strict=True)
        )
        yield points, above, below


def shared_at_origin(A: Quasipolynomials, B: Quasipolynomials) -> np.ndarray:
    """How many zeros at the origin A and B have in common, for each point."""
    vanish = [abs(x.coefficients[:, 0].sum(axis=0)) <= 1e-14 * abs(x.coefficients[:, 0]).sum(axis=0) for x in (A, B)]
    shared = np.zeros(A.count, dtype=int)
    if len(some := np.flatnonzero(vanish[0] & vanish[1])):
        (a, _), (b, _) = (origin(x[some], 2 * B.order + 6) for x in (A, B))
        shared[some] = np.argmax((a != 0) | (b != 0), axis=0)
    return shared


def count_roots(
    sums: Quasipolynomials,
    removable: int = 0,
    near: np.ndarray | None = None,
    most: int | None = None,
) -> np.ndarray:
    """The number of roots in the right half-plane of many quasipolynomials.

    It is ON_LIMIT with some on the axis, or so close to it that it is not told, and INFINITELY_MANY without end.

    Arguments:
        removable: how many roots at zero do not count.
        near: a frequency for each sum about which there are roots close to the axis; nan without one. It costs time
            not to know it.
        most: how many intervals may be looked at; 400,000, and 2,000 for each sum, if not given.
    Returns:
        An array of floats. With complex coefficients it is half the number for a sum and the one with the conjugate
        coefficients together, of which the two have different shares.
    """
    coefficients, delays = sums.coefficients, sums.delays
    if not delays[1:].all():
        coefficients = coefficients.copy()
        for part, delay in zip(coefficients[1:], delays[1:], strict=True):  # what has no dead time at some points
            coefficients[0] += np.where(delay == 0, part, 0)
            part[:, delay == 0] = 0
    counts = np.zeros(sums.count)
    with np.errstate(divide="ignore", invalid="ignore"):
        returning = coefficients[1:, -1] / coefficients[0, -1]
    counts[coefficients[0, -1] == 0] = INFINITELY_MANY
    least, at_infinity = 1 - abs(returning).sum(axis=0), {}
    for point in np.flatnonzero(~(least > 0) & (counts == 0)):
        at_infinity[point] = at_infinite_frequency(returning[:, point], delays[1:, point])
        least[point] = at_infinity[point].least
        if least[point] <= 0:
            counts[point] = INFINITELY_MANY if least[point] < 0 else ON_LIMIT
    points = np.flatnonzero(counts == 0)
    if len(points):
        coefficients = coefficients[:, :, points] / coefficients[0, -1, points]
        unit = power_of_two(prevailing(coefficients, least[points]))
        scaled = Quasipolynomials(coefficients, delays[:, points]).slower(unit)
        hints = None if near is None else near[points] / unit
        counts[points] = Turns(scaled, unit, [at_infinity.get(point) for point in points], removable).count(hints, most)
    return counts


class Turns:
    """The turns of the phase of quasipolynomials on the imaginary axis, from 0 to 1, where the highest power rules."""

    name = "the number of unstable poles"

    def __init__(
        self,
        sums: Quasipolynomials,
        unit: np.ndarray,
        at_infinity: list[AtInfinity | None],
        removable: int,
    ):
        self.sums, self.unit, self.at_infinity, self.removable = sums, unit, at_infinity, removable
        self.phase, self.limit = np.zeros(sums.count), np.zeros(sums.count, dtype=bool)
        # many quasipolynomials are quicker done with shorter expansions
        self.degree = DEGREE if sums.count < 50 else FEW_TERMS
        self.first = self.rest = None
        if len(sums.coefficients) > 1 and sums.coefficients[1:].any():
            self.first = Quasipolynomials(sums.coefficients[:1], sums.delays[:1])
            self.rest = Quasipolynomials(sums.coefficients[1:], sums.delays[1:])

    def count(self, near: np.ndarray | None, most: int | None = None) -> np.ndarray:
        """The numbers of roots in the right half-plane."""
        sums = self.sums
        one, points = np.ones(sums.count), np.arange(sums.count)
        index, a, b = geometric(_lowest(sums), one, near, RATIO if sums.count < 50 else MANY_RATIO)
        if self.removable:
            start, turn = above_origin(sums, self.removable)
            self.phase += turn
            some = b > start[index]
            index, a, b = index[some], np.maximum(a[some], start[index[some]]), b[some]
        else:
            size, at_zero = sums.sizes(points, 0 * one)[0], sums.coefficients[:, 0].sum(axis=0)
            self.limit |= abs(at_zero) <= 1e-15 * size
        some = ~self.limit[index]
        most = most or MOST_INTERVALS + MORE_INTERVALS * sums.count
        walk(self.judge, index[some], a[some], b[some], self.name, self.unit, most=most)
        ends = sums.value(points, one) * (-1j) ** sums.order
        beyond = [
            each.phase(scale) if each else 0.0 for each, scale in zip(self.at_infinity, self.unit.tolist(), strict=True)
        ]
        # of n roots on the left, each turns the phase by a quarter turn; the rest of it comes beyond the frequency 1
        left = np.array(beyond) + np.angle(ends * np.exp(-1j * np.array(beyond)))
        counts = (sums.order - self.removable) / 2 - (self.phase - left) / math.pi
        if not np.iscomplexobj(sums.coefficients):
            whole = np.rint(counts)
            if (lost := np.flatnonzero(~self.limit & (abs(counts - whole) > 0.1))).size:
                raise UndecidedError(self.name, 0.0, float(self.unit[lost[0]]))
            counts = whole
        return np.where(self.limit, ON_LIMIT, counts) + 0.0  # no negative zero

    def judge(self, index: np.ndarray, a: np.ndarray, b: np.ndarray, precise: bool) -> tuple:
        """Add the turns on intervals where they are known, and mark quasipolynomials with roots on the axis."""
        sums, c, r = self.sums, (a + b) / 2, (b - a) / 2
        around = enclosed(sums, index, c, r, degree=self.degree)
        # all values then lie in a disc without zero, so that the phase turns by less than a half from one end to the
        # other; three times the noise, because both ends are rounded as well
        proven = around.least > 3 * around.noise
        at_a, at_b = sums.value(index, a), sums.value(index, b)
        turns = np.angle(at_b * at_a.conj())
        if self.rest is not None and not proven.all():
            # where the undelayed part outweighs the others, the phase is its own, and less than a quarter turn more
            left = np.flatnonzero(~proven)
            alone = enclosed(self.first, index[left], c[left], r[left], degree=self.degree)
            outweighs = alone.least > self.rest.sizes(index[left], b[left])[0] + 3 * alone.noise
            of = left[outweighs]
            if len(of):
                proven[of] = True
                alone_a, alone_b = self.first.value(index[of], a[of]), self.first.value(index[of], b[of])
                turns[of] = np.angle(alone_b * alone_a.conj())
                turns[of] += np.angle(at_b[of] / alone_b) - np.angle(at_a[of] / alone_a)
        self.phase += np.bincount(index[proven], weights=turns[proven], minlength=sums.count)
        noisy = around.is_noisy & (around.spread < 64 * around.noise)
        lost = ~proven & ((b - a <= 2 * NARROWEST * b) | (b < 1e-200) | noisy)
        self.limit[index[lost]] = True
        return ~proven & ~self.limit[index], noisy, sums.longest[index]


def _lowest(sums):
    """A frequency about which the lowest power begins to give way to the others."""
    series = abs(sums._expansion[:, :, 0].sum(axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = (series[0] / series[1:]) ** (1 / np.arange(1, len(series)))[:, None]
    ratios[~(ratios > 0)] = math.inf
    lowest = ratios.min(axis=0)
    return np.clip(np.where(lowest < math.inf, 0.3 * lowest, 1e-3), 1e-30, 0.5)


def above_origin(sums: Quasipolynomials, removable: int, exact: Exact | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies up to which quasipolynomials are about their lowest power, that of roots at zero, and their turns.

    Raises StabilityLimitError for more roots at zero than are removable.
    """
    series, more = origin(sums, removable + sums.order + 4, exact)
    if not series[removable].all():
        raise StabilityLimitError("there are poles at zero")
    start = 0.1 / np.maximum(1.0, sums.longest)
    powers = np.arange(len(series) - removable)[:, None]
    lowest = abs(series[removable])
    for _ in range(400):
        others = (abs(series[removable:]) * start**powers)[1:].sum(axis=0) + 2 * more * start ** len(powers)
        if not (high := others > lowest / 2).any():
            break
        start = np.where(high, start / 2, start)
    value = sums.value(np.arange(sums.count), start) if exact is None else exact.taylor(start, 0)[0]
    return start, np.angle(value / (1j**removable * series[removable]))
