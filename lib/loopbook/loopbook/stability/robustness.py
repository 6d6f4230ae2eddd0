"""Robustness plots: how long the dead time of a process may become, when its gain has changed as well."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.quasipolynomials import DelayFraction
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.counting import ON_LIMIT, count_closed, fraction_sums, open_loop
from loopbook.stability.crossings import SizeOne, asked, difference, phase_left, steps
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.loops import Loops
from plainmath.validation import positive_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class DelayRatios(NamedTuple):
    """The delay ratios for which a loop is stable: what `robustness` returns.

    Attributes:
        lower, upper: the ends of the region that holds the delay ratio 1, or else of the one nearest to it; arrays
            like the gain ratios, or numbers. Both are nan where there is none, and `upper` is infinite where no dead
            time is too long.
        regions: for each gain ratio the list of all regions, as (lower, upper).
    """

    lower: np.ndarray | float
    upper: np.ndarray | float
    regions: list


def robustness(process: object, controller: object, gain_ratio: ArrayLike) -> DelayRatios:
    """Return how long the dead time of the process may become, for a process whose gain has changed as well.

    The controller stays as it is, with the dead times that it may contain itself, as a Smith predictor does. At the
    frequencies where abs(L) = 1, which do not depend on the dead time of the process, poles cross the axis; the phase
    says at which dead times, and the slope of abs(L) in which direction. A predictor may also become unstable when the
    dead time is shorter than it expects, and stable again for longer ones: hence regions.

    Arguments:
        process: the nominal process, a fraction of polynomials with one dead time.
        controller: a `PID`, or a transfer function that may contain dead times.
        gain_ratio: the gain of the process divided by the nominal one; a positive number or an array.
    Returns:
        `DelayRatios`, of the dead time of the process divided by the nominal one.
    Raises:
        ValueError: for a process without dead time or with several, a gain ratio that is not positive, or a loop that
            is improper.
    Source: Syder, Heeg and O'Dwyer, Section 3, equations (8) and (9), Figure 2.

    >>> import sympy
    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> ratios = robustness(2 * sympy.exp(-s) / (4 * s + 1), PID(1, Ti=4), [1, 2])
    >>> ratios.upper.round(4)    # pi over the gain ratio
    array([3.1416, 1.5708])
    """
    gains = positive_numbers("gain ratios", gain_ratio)
    A, B, delay = open_loop_without_dead_time(process, controller)
    regions = [[(low / delay, high / delay) for low, high in each] for each in _stable_delays(gains.ravel() * A, B)]
    chosen = np.array([min(each, key=_distance_from_1, default=(math.nan, math.nan)) for each in regions])
    lower, upper = (x.reshape(gains.shape) for x in chosen.T)
    return DelayRatios(lower, upper, regions) if gains.ndim else DelayRatios(float(lower), float(upper), regions[0])


def robustness_pi_first_order(
    K: float, T: float, delay: float, Kp: float, Ti: float, gain_ratio: ArrayLike
) -> np.ndarray | float:
    """Return the delay ratio on the limit of stability for PI control of a lag with dead time, in closed form.

    Arguments:
        K, T, delay: gain, lag and dead time of the nominal process, positive.
        Kp, Ti: settings of the controller, positive.
        gain_ratio: the gain of the process divided by K; a number or an array.
    Returns:
        The dead time divided by `delay` at which the loop is on the limit of stability, as `gain_ratio`; negative where
        it is unstable without any dead time.
    Source: Syder, Heeg and O'Dwyer, equations (8) and (9), where T_p under the root of (8) is the lag T.

    >>> round(robustness_pi_first_order(2, 4, 1, Kp=1, Ti=4, gain_ratio=2), 4)    # pi/2
    1.5708
    """
    gains = positive_numbers("gain ratios", gain_ratio)
    k = (float(K) * float(Kp) * gains) ** 2
    T, delay, Ti = float(T), float(delay), float(Ti)
    middle = (k - 1) * Ti
    root = np.sqrt(middle**2 + 4 * k * T**2)
    # the sum under the root, or where it would cancel the quotient that is equal to it
    sum_ = np.where(middle > 0, middle + root, 4 * k * T**2 / (root - np.minimum(middle, 0)))
    w = np.sqrt(sum_ / (2 * Ti * T**2))
    ratio = (math.pi / 2 + np.arctan(w * Ti) - np.arctan(w * T)) / w / delay
    return ratio if ratio.ndim else float(ratio)


def open_loop_without_dead_time(
    process: object, controller: object
) -> tuple[Quasipolynomials, Quasipolynomials, float]:
    """Numerator and denominator of a loop without the one dead time of its process, and that dead time."""
    P = open_loop(process)
    delay = min(P.numerator)
    if len(P.numerator) != 1 or not delay or len(P.denominator) != 1:
        raise ValueError(
            f"the process is {P.expr}: expected a fraction of polynomials with one dead time exp(-delay*s)"
        )
    rational = DelayFraction({Fraction(0): P.numerator[delay]}, P.denominator)
    return *fraction_sums(open_loop(controller) * rational), float(delay)


def _distance_from_1(region):
    low, high = region
    return 0 if low <= 1 <= high else math.log(low) if low > 1 else -math.log(high)


def _stable_delays(A: Quasipolynomials, B: Quasipolynomials) -> list[list[tuple[float, float]]]:
    """For each loop with one more dead time in it, the regions of that dead time in which it is stable."""
    loops = Loops(A, Quasipolynomials(B.coefficients, np.broadcast_to(B.delays, (len(B.delays), A.count))))
    end = loops.beyond(np.ones(A.count))
    # where the gain at ever higher frequencies is 1 or more, no dead time is small enough
    decided = np.flatnonzero(~np.isnan(end))
    regions = [[] for _ in end]
    if not len(decided):
        return regions
    loops, end = loops[decided], end[decided]
    size = SizeOne()
    asked(loops, [size], *steps(loops.start, end))
    index, w, A, B = size.solved(loops)
    rise = difference(*loops.values(index, w, 2))[1]
    first, period = phase_left(A, B) / w, 2 * math.pi / w
    direction = 2 * np.sign(rise).astype(int)
    # counted before the first crossing, because poles may lie on the axis without any dead time
    earliest = np.full(len(decided), math.inf)
    np.minimum.at(earliest, index, np.where(first > 0, first, period))
    earliest = np.where(earliest < math.inf, earliest, 1.0)
    begun = count_closed(loops.A.delayed(earliest / 2), loops.B)
    if (begun == ON_LIMIT).any():
        raise UndecidedError("the number of unstable poles with the shortest dead times", 0.0, math.inf)
    for k, point in enumerate(decided):
        mine, unit = index == k, float(loops.unit[k])
        regions[point] = [
            (low / unit, high / unit)
            for low, high in _regions(int(begun[k]), first[mine], period[mine], direction[mine])
        ]
    return regions


def _regions(count, first, period, direction):
    """The intervals of dead time without unstable poles, from their number at the beginning and all crossings.

    Poles cross at the dead times first, first + period, ``first + 2*period`` ...; direction is by how many more there
    are.
    """
    if not len(first):
        return [(0.0, math.inf)] if count == 0 else []
    # later, more has come than the crossings of the other direction can take away
    rate = float((direction / period).sum())
    until = (count + abs(direction).sum()) / rate + 2 * period.max() if rate > 0 else 100 * period.max()
    until = min(until, 10_000 * period.max())
    turns = [
        start + length * np.arange((until - start) // length + 1) for start, length in zip(first, period, strict=True)
    ]
    times = np.concatenate(turns)
    steps = np.repeat(direction, [len(each) for each in turns])
    order = np.argsort(times, kind="stable")
    order = order[times[order] > 0]
    edges = [0.0, *times[order].tolist()]
    counts = np.cumsum([count, *steps[order]])[:-1]
    return [
        (low, high) for n, (low, high) in zip(counts, itertools.pairwise(edges), strict=True) if n == 0 and low < high
    ]
