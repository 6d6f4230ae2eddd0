"""The curve H(j omega) for a picture: where to look, how densely, and a phase that is known to be continuous.

Numerator and denominator are followed one by one. Between two neighbouring frequencies a Taylor polynomial with a bound
of its remainder proves that each stays within a cone that does not contain zero, so that no turn is missed, however
sharp a resonance is.
"""

from __future__ import annotations

import functools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.quasipolynomials import DelayFraction
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import Quasipolynomial, earlier, lowest_term, plus
from loopbook.stability.counting import above_origin
from loopbook.stability.enclosures import Enclosure, Exact, enclosed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = ["FrequencyCurve", "frequency_curve", "natural_range"]

CONE = math.sin(math.radians(20))  # so far from a third two values of a side may be, seen from zero
NARROWEST = 1e-12  # of an interval, as a share of the frequency; one as narrow and undecided holds a zero
MOST_POINTS = 300_000
STEP = math.radians(3)  # of the phase, from point to point
SHARE = 0.01  # of the decades of magnitude that are shown, from point to point
TURNS = 10.0  # radians that dead times may turn the phase within a natural range, if nothing else asks for more
SHARP = 0.3  # the damping of a pair of roots below which its frequency is shown in any case


class FrequencyCurve(NamedTuple):
    """The frequency response of a system at increasing frequencies, dense where it bends.

    At a zero or pole on the imaginary axis, where the phase jumps, value and phase are nan.

    Attributes:
        omega: frequencies in radians for one unit of time, an array.
        values: H(j omega), complex.
        phase: in degrees, continuous. Far below all corners, ``K*s**n`` has n times 90 degrees, less 180 if K is
            negative.
    """

    omega: np.ndarray
    values: np.ndarray
    phase: np.ndarray


def frequency_curve(
    H: DelayFraction,
    low: float,
    high: float,
    coarse: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
) -> FrequencyCurve:
    """Return the frequency response between two frequencies, dense enough for a picture, with a continuous phase.

    Points are added until the phase changes by 3 degrees at most from one to the next, which gives peaks their height
    to one part in a thousand. At a zero or pole on the imaginary axis the phase jumps as if it were just to the left.

    Arguments:
        H: the fraction; an improper one is allowed.
        low, high: positive frequencies, increasing.
        coarse: function of the values at the beginnings and the ends of intervals, true where a point is missing.
    Raises:
        ValueError: for frequencies that do not increase, a transfer function that is zero, or a curve that turns too
            often between the two.

    >>> import sympy
    >>> from plainmath.expressions import s
    >>> from loopbook.quasipolynomials import read
    >>> curve = frequency_curve(read(sympy.exp(-s)), 0.1, 100)
    >>> round(math.radians(curve.phase[-1]), 9)
    -100.0
    """
    if not 0 < low < high < math.inf:
        raise ValueError(f"the frequencies go from {low:g} to {high:g}: expected positive ones that increase")
    if not H.numerator:
        raise ValueError("the transfer function is 0: it has no phase")
    scale = H.denominator[Fraction(0)][-1]
    above, below = sides = [_OnAxis(parts, scale) for parts in (H.numerator, H.denominator)]
    start = min(low, *(side.begins for side in sides))
    first = np.geomspace(start, low, 2 + int(16 * math.log10(low / start)))[:-1]
    grid = np.r_[first, np.geomspace(low, high, 2 + int(64 * math.log10(high / low)))]
    grid, is_gap = _followed(sides, grid)
    values = [side(grid) for side in sides]
    phases = [side.phases(grid, at, is_gap) for side, at in zip(sides, values, strict=True)]

    kept = grid >= low
    grid, is_gap = grid[kept], is_gap[kept[:-1]]
    values, phases = ([row[kept] for row in rows] for rows in (values, phases))
    delay = above.delay - below.delay
    for _ in range(60):
        turn = phases[0] - phases[1] - delay * grid
        with np.errstate(divide="ignore"):
            height = np.log10(abs(values[0])) - np.log10(abs(values[1]))
        finite = height[np.isfinite(height)]
        missing = abs(np.diff(turn)) > STEP
        missing |= abs(np.diff(height)) > SHARE * max(np.ptp(finite), 1)
        for phase in phases:  # what turns in both would cancel in the quotient
            missing |= abs(np.diff(phase)) > 3 * STEP
        if coarse is not None:
            H_there = values[0] / values[1] * np.exp(-1j * delay * grid)
            missing |= coarse(H_there[:-1], H_there[1:])
        missing &= ~is_gap & (np.diff(grid) > 4 * NARROWEST * grid[1:])
        where = np.flatnonzero(missing)
        if not len(where) or len(grid) > MOST_POINTS:
            break
        middle = (grid[where] + grid[where + 1]) / 2
        for n, side in enumerate(sides):
            there = side(middle)
            between = phases[n][where] + np.angle(there / values[n][where])
            values[n], phases[n] = np.insert(values[n], where + 1, there), np.insert(phases[n], where + 1, between)
        grid, is_gap = np.insert(grid, where + 1, middle), np.insert(is_gap, where, False)
    phase = np.degrees(phases[0] - phases[1] - delay * grid) - (180 if above.sign != below.sign else 0)
    gaps = np.flatnonzero(is_gap)
    omega = np.insert(grid, gaps + 1, (grid[gaps] + grid[gaps + 1]) / 2)
    values = H(1j * omega)
    values[gaps + 1 + np.arange(len(gaps))] = np.nan
    return FrequencyCurve(omega, values, np.insert(phase, gaps + 1, np.nan))


class _OnAxis:
    """A quasipolynomial q(w) = Q(jw) without its shortest dead time."""

    def __init__(self, parts: Quasipolynomial, scale: int):
        self.delay, (self.power, lowest) = float(min(parts)), lowest_term(parts)
        parts = earlier(parts, min(parts))
        self.sign = 1 if lowest > 0 else -1
        order = max(map(len, parts.values())) - 1
        self.sums = Quasipolynomials.exact(parts, order, scale)
        self.begins = float(above_origin(self.sums, self.power, Exact(parts, order, scale, 1.0))[0][0])

    def __call__(self, w: np.ndarray) -> np.ndarray:
        return self.sums.value(np.zeros(len(w), dtype=int), w)

    def around(self, a: np.ndarray, b: np.ndarray) -> Enclosure:
        """The quasipolynomial on intervals."""
        return enclosed(self.sums, np.zeros(len(a), dtype=int), (a + b) / 2, (b - a) / 2)

    def phases(self, grid: np.ndarray, values: np.ndarray, is_gap: np.ndarray) -> np.ndarray:
        """The continuous phase of the quasipolynomial, divided by its sign, at frequencies close to each other."""
        turns = np.angle(values[1:] / values[:-1])
        for k in np.flatnonzero(is_gap):
            around = np.angle(self.beside(grid[k], grid[k + 1]))
            turns[k] = np.sum((np.diff(around) + math.pi) % (2 * math.pi) - math.pi)
        first = np.angle(values[0] * self.sign / 1j**self.power) + self.power * math.pi / 2
        return first + np.r_[0, np.cumsum(turns)]

    def beside(self, a: float, b: float) -> np.ndarray:
        """The values on the way from ja to jb along a half circle in the right half-plane.

        So goes Nyquist's contour, which counts a zero on the axis as one to the left of it.
        """
        return self.sums.at(1j * (a + b) / 2 + (b - a) / 2 * np.exp(1j * np.linspace(-math.pi / 2, math.pi / 2, 129)))


def _followed(sides: list[_OnAxis], grid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The grid so fine that each side is followed from point to point, and which intervals are gaps with a zero."""
    points, gaps = [grid], []
    a, b = grid[:-1], grid[1:]
    while len(a):
        open_, empty = np.zeros((2, len(a)), dtype=bool)
        for side in sides:
            around = side.around(a, b)
            value, most, noise = around.sizes[0], around.spread, around.noise / CONE
            undecided = ~(most <= CONE * value)
            small = (b - a <= NARROWEST * b) | ((value <= 3 * noise) & (most <= 100 * noise))
            empty |= undecided & small
            open_ |= undecided & ~small
        gaps += zip(a[empty], b[empty], strict=True)
        open_ &= ~empty
        a, b = a[open_], b[open_]
        c = (a + b) / 2
        points.append(c)
        a, b = np.r_[a, c], np.r_[c, b]
        if sum(map(len, points)) > MOST_POINTS:
            raise ValueError(
                f"the curve turns too often between {grid[0]:g} and {grid[-1]:g} rad per unit of time: "
                f"expected a narrower range of frequencies"
            )
    grid = np.unique(np.concatenate(points))
    gaps = _wide_enough(sides, gaps)
    for a, b in gaps:
        grid = np.r_[grid[grid < a], a, b, grid[grid > b]]
    return grid, np.isin(grid[:-1], [a for a, _ in gaps])


def _wide_enough(sides: list[_OnAxis], gaps: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Gaps that hang together as one, and so wide that values beside the axis are more than rounding."""
    merged: list[tuple[float, float]] = []
    for a, b in sorted(gaps):
        if merged and a - merged[-1][1] < 4 * (b - a + merged[-1][1] - merged[-1][0]):
            a = merged.pop()[0]
        middle, radius = (a + b) / 2, (b - a) / 2
        for _ in range(40):
            a, b = middle - radius, middle + radius
            here = np.array([b])
            if all(abs(side.beside(a, b)).min() > 100 * side.around(here, here).noise[0] for side in sides):
                break
            radius *= 2
        merged.append((a, b))
    return merged


# ------------------------------------------------------------------------------------------------ where to look


def natural_range(systems: Iterable[DelayFraction], also: Iterable[float] = ()) -> tuple[float, float]:
    """Return the lowest and the highest frequency of a picture of these systems: a decade around all corners.

    Corners are the sizes of zeros and poles without the dead times, and 1/delay. Where dead times turn the phase many
    times before the last corner, the range ends earlier, but not before a resonance.

    Arguments:
        systems: fractions.
        also: frequencies that the range holds in any case, with some room.

    >>> import sympy
    >>> from plainmath.expressions import s
    >>> from loopbook.quasipolynomials import read
    >>> natural_range([read(sympy.exp(-s) / (20 * s + 1))])
    (0.005, 10.0)
    """
    ranges = [_own_range(H) for H in systems]
    also = [float(w) for w in also if 0 < w < math.inf]
    low = min([*(low for low, _ in ranges), *(w / 3 for w in also)], default=0.1)
    high = max([*(high for _, high in ranges), *(3 * w for w in also)], default=10.0)
    return _round_number(low, up=False), _round_number(high, up=True)


def _own_range(H: DelayFraction) -> tuple[float, float]:
    delays = [float(delay) for delay in H.delays]
    roots = [root for parts in (H.numerator, H.denominator) for root in _roots_without_delay(parts)]
    sharp = [abs(root) for root in roots if abs(root.real) < SHARP * abs(root)]
    corners = [*map(abs, roots), *(1 / delay for delay in delays)]
    if not corners:
        return 0.1, 10.0
    turned = max([TURNS / max(delays), *(3 * w for w in sharp)]) if delays else math.inf
    return min(corners) / 10, min(10 * max(corners), turned)


def _roots_without_delay(parts: Quasipolynomial) -> list[complex]:
    """The roots of a quasipolynomial's first part, and of all its parts, with either sign of what comes later."""
    first, *later = [{Fraction(0): part} for _, part in sorted(parts.items())] or [{}]
    late = functools.reduce(plus, later, {})
    sums = [first, plus(first, late), plus(first, late, -1)] if later else [first]
    scaled = [[c / part[-1] for c in reversed(part)] for total in sums for part in total.values()]
    return [root for coefficients in scaled for root in np.roots(coefficients).tolist() if root]


def _round_number(value: float, up: bool) -> float:
    """The next 1, 2 or 5 times a power of ten."""
    numbers = [x * 10.0 ** math.floor(math.log10(value)) for x in (1, 2, 5, 10)]
    found = (
        min(x for x in numbers if x >= value * (1 - 1e-9)) if up else max(x for x in numbers if x <= value * (1 + 1e-9))
    )
    return float(f"{found:.6g}")
