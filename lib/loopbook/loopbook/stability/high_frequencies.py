"""An open loop L = A/B at infinite frequency, where the highest powers alone count: a/b, numbers with dead times.

As the gain k grows, B + k A gets an infinite row of unstable roots where b + k a has one: at a limiting gain. Below
that, b + k a has a certain distance from zero, and beyond a certain frequency the lower powers are smaller. Close to
the limiting gain that frequency would be too high. There L is expanded in v = 1/w and in the angle of the dead times,
of which it is an analytic function, and Cauchy's estimates bound the rest.
"""

from __future__ import annotations

import functools
import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.crossings import Positive, Real, View, asked, steps
from loopbook.stability.difference import common_unit, prevailing
from loopbook.stability.loops import ENOUGH, Loops, positive_beyond, square

if TYPE_CHECKING:
    from collections.abc import Callable

MOST_ANGLES = 200_000
MOST_EXPANSIONS = 50


def _remembered(method):
    """A method whose last result is kept, because it is asked again in each window of frequency."""

    @functools.wraps(method)
    def kept(self, *values):
        last = self.last.get(method.__name__)
        if last is None or last[0] != values:
            self.last[method.__name__] = last = values, method(self, *values)
        return last[1]

    return kept


class Far:
    """The highest powers of a single loop: b + k a, sums of ``exp(-delay*s)`` with `delays` (the first one zero).

    Arguments:
        loops: a single loop, with more digits.
        pivot: the gain next to which limiting gains are wanted, 1 for margins and 0 for an ultimate gain.
    Attributes:
        highest, lowest: the gains next to the pivot at which the highest powers get roots in the right half-plane or
            lose their undelayed part; infinite and zero without one.
    """

    def __init__(self, loops: Loops, pivot: float = 1.0):
        A, B = loops.exact[:2]
        self.loops, self.pivot, self.last = loops, pivot, {}
        rows: dict[Fraction, list[Fraction]] = {Fraction(0): [Fraction(0), Fraction(0)]}
        for k, exact in enumerate((A, B)):
            for delay, part in exact.parts.items():
                if len(part) == exact.order + 1:
                    rows.setdefault(delay, [Fraction(0), Fraction(0)])[k] += Fraction(part[-1], exact.divisor)
        self.rows = dict(sorted(rows.items()))
        self.a, self.b = (np.array([float(row[k]) for row in self.rows.values()]) for k in range(2))
        self.delays = np.array([float(delay) for delay in self.rows])
        self.vanishes = not self.a.any()
        self.lowest, self.highest = 0.0, math.inf
        if not self.vanishes:
            gains = self.gains
            self.lowest = max((k for k in gains if k < pivot), default=0.0)
            self.highest = min((k for k in gains if k > pivot), default=math.inf)

    @functools.cached_property
    def unit(self) -> tuple[float, list[int]] | None:
        """The dead time of which all are multiples, and these; None where they are none of one."""
        return common_unit(self.delays[1:].tolist()) if len(self.delays) > 1 else (1.0, [])

    @functools.cached_property
    def powers(self) -> np.ndarray:
        return np.array([0, *(self.unit[1] if self.unit else ())])

    @property
    def is_one_delayed(self) -> bool:
        """Whether L is ``a/b*exp(-delay*s)`` there, so that its size does not depend on the frequency."""
        return len(self.a) == 1 or (len(self.a) == 2 and not self.a[0] and not self.b[1])

    # ---- limiting gains

    @functools.cached_property
    def gains(self) -> list[float]:
        """Positive gains with which the highest powers get roots in the right half-plane, or no undelayed part."""
        (a0, b0), *later = self.rows.values()
        gains = [] if not a0 else [-b0 / a0]
        if len(later) == 1:
            ((a1, b1),) = later
            for sign in (1, -1):
                if slope := a1 - sign * a0:
                    gains.append((sign * b0 - b1) / slope)
        elif later and self.unit:
            gains += [gain for gain, _ in self.on_circle]
        elif later:
            gains += self._of_independent(a0, b0, later)
        return sorted(float(gain) for gain in gains if gain > 0)

    def _of_independent(self, a0, b0, later):
        if _related(self.delays[1:]):
            raise ValueError(
                "whether there is an end of unstable poles is not decided: the highest powers have dead times of which "
                "one is the sum or difference of others"
            )
        # a sum of sizes is the largest of all sums with signs
        for signs in itertools.product((-1, 1), repeat=len(later)):
            rise = a0 + sum(sign * a for sign, (a, _) in zip(signs, later, strict=True))
            if rise:
                gain = -(b0 + sum(sign * b for sign, (_, b) in zip(signs, later, strict=True))) / rise
                if abs(b0 + gain * a0) == sum(abs(b + gain * a) for a, b in later):
                    yield gain

    @functools.cached_property
    def on_circle(self) -> list[tuple[float, float]]:
        """The gains for which b + k a vanishes at an angle of ``exp(-unit*s)``, and these angles, from 0 to pi."""
        real = Real(self._highest_powers, pivot=self.pivot)
        self._ask(real)
        turns = np.exp(-1j * np.multiply.outer(self.powers, [0.0, math.pi]))
        found = [*zip(real.gains.tolist(), real.frequencies.tolist(), strict=True)]
        for angle, above, below in zip((0.0, math.pi), (self.a @ turns).real, (self.b @ turns).real, strict=True):
            if abs(above) > 1e-15 * abs(self.a).sum() and -below / above > 0:
                found.append((float(-below / above), angle))
        return found

    @functools.cached_property
    def _highest_powers(self) -> Loops:
        """The highest powers as loops of their own, time in the unit of the dead times."""
        multiples = self.powers[:, None].astype(float)
        return Loops(*(Quasipolynomials(row[:, None, None], multiples) for row in (self.a, self.b)))

    def _ask(self, question):
        loops, one = self._highest_powers, np.zeros(1, dtype=int)
        start = np.full(1, 0.1)
        while True:
            view = View(loops, one, -start, start)
            if not question.judge(view)[0].any():
                break
            start = start / 2
            if start[0] < 1e-12:
                raise ValueError(f"{question.name} is not decided at infinite frequency")
        asked(loops, [question], *steps(start, np.full(1, math.pi + 1e-3)))

    # ---- how far the highest powers are from what is asked

    def _least(self, size: Callable, steep: float, without=()) -> float:
        """A lower bound, at least half the minimum, of a function of the angle with a bounded slope; zero without.

        Angles that are as near to some as is said do not count.
        """
        count = 16 * max(4, int(max(self.powers)))
        middle, half = (np.arange(count) + 0.5) * (math.pi / count), math.pi / (2 * count)
        least = math.inf
        for _ in range(40):
            for angle, near in without:
                for mirrored in (angle, -angle):
                    apart = abs((middle - mirrored + math.pi) % (2 * math.pi) - math.pi)
                    middle = middle[apart + half > near]
            if not len(middle):
                return least / 2 if least < math.inf else 0.0
            values = size(np.exp(-1j * np.multiply.outer(self.powers, middle)))
            least = min(least, float(values.min()))
            open_ = values - steep * half < least / 2
            if least <= 0 or open_.sum() > MOST_ANGLES:
                return 0.0
            if not open_.any():
                return least / 2
            middle, half = np.concatenate([middle[open_] - half / 2, middle[open_] + half / 2]), half / 2
        return 0.0

    def _distance(self, low: float, high: float, without=()) -> float:
        """How far 0 is, at least, from b + k a with k from low to high."""
        a, b = self.a, self.b
        if len(a) == 1 or not self.unit:
            ends = [abs(b[0] + k * a[0]) - abs(b[1:] + k * a[1:]).sum() for k in (low, high)]
            crosses = (b[0] + low * a[0]) * (b[0] + high * a[0]) < 0
            return 0.0 if crosses else max(0.0, min(ends))

        def size(turns):
            start, end = (b + low * a) @ turns, (b + high * a) @ turns
            return _to_segment(start, end - start)

        return self._least(size, max(abs(b + k * a) @ self.powers for k in (low, high)), without)

    def _lower(self, of_B, of_A):
        A, B = (abs(x.coefficients[:, :, 0]).sum(axis=0)[:-1] for x in (self.loops.A, self.loops.B))
        return of_B * B + of_A * A

    def _end(self, lower, reserve):
        """A frequency beyond which the lower powers are smaller than the highest one with that factor."""
        if reserve <= 0:
            return math.nan
        if not lower.any():
            return 0.0
        return float(prevailing(np.concatenate([lower, [reserve]])[None, :, None])[0])

    # ---- gains

    @_remembered
    def no_crossing_beyond(self, low: float, high: float) -> float:
        """A frequency beyond which L is not -1/k for any k from low to high; nan where none is known.

        A limiting gain itself is no such k.
        """
        simple = float(self.loops.beyond(np.array([high]))[0])
        if self.vanishes and not math.isnan(simple):
            return simple
        limiting = abs(high / self.highest - 1) < 1e-12 if self.highest < math.inf else False
        if limiting and not math.isnan(limit := float(self.loops.beyond_limit()[0])):
            simple = float(np.fmin(simple, limit))
        lower = self._lower(1.0, high)
        if limiting and not lower.any():
            return 0.0
        end = self._end(lower, self._distance(low, high))
        # the next power may make it better by far
        if not min(end if end == end else math.inf, simple if simple == simple else math.inf) < 30:
            end = float(np.fmin(end, self._beyond_circle(low, high)))
        return float(np.fmin(simple, end))

    def _beyond_circle(self, low: float, high: float) -> float:
        """The same, by expansions about the angles at which the highest powers alone have such a gain."""
        if not self.unit or len(self.a) == 1 or self._series is None:
            return math.nan
        A, B = self._series
        best = math.nan
        angles = [(k, angle) for k, angle in self.on_circle if low / 2 < k < 2 * high]
        if len(angles) > MOST_EXPANSIONS:
            return math.nan
        for halvings in range(0, 12, 3):
            near = 0.25 / max(self.powers) / 2**halvings
            largest = []
            for _, angle in angles:
                gains = Expansion.of(B, A, angle, 1 / max(self.powers), -1.0)
                largest.append(_no_gain_between(gains, low, high * (1 - ENOUGH), near, angle) if gains else 0.0)
            if min(largest, default=1.0) > 0:
                distance = self._distance(low, high, [(angle, near) for _, angle in angles])
                end = self._end(self._lower(1.0, high), distance)
                if not math.isnan(end):
                    best = np.fmin(best, max(end, 1 / min(largest, default=math.inf)))
        return float(best)

    @functools.cached_property
    def _series(self):
        """Coefficients of A and B by multiples of the unit and powers of v; None with dead times that are none."""
        scaled, order = self.unit[0] * float(self.loops.unit[0]), self.loops.B.order
        both = []
        for sums in (self.loops.A, self.loops.B):
            rows: dict[int, np.ndarray] = {}
            for part, delay in zip(sums.coefficients[..., 0], sums.delays[:, 0], strict=True):
                multiple = round(delay / scaled)
                if abs(multiple * scaled - delay) > 1e-12 * delay:
                    return None
                rows[multiple] = rows.get(multiple, 0) + part[::-1] * (-1j) ** np.arange(order + 1)
            both.append(rows)
        return both

    # ---- the size of L

    @functools.cached_property
    def size(self) -> int:
        """-1 or 1 where abs(L) is below or above 1 at infinite frequency, whatever the phases; 0 where it is neither.

        Where it is 1, the next power decides.
        """
        if self.vanishes or not math.isnan(self._size_end(1)):
            return -1
        return 1 if not math.isnan(self._size_end(-1)) else 0

    def _size_end(self, sign):
        """A frequency beyond which abs(B) - abs(A), times the sign, is positive."""
        if sign > 0 and (end := float(self.loops.beyond(np.ones(1))[0])) == end:
            return end
        a, b = self.a, self.b
        if self.is_one_delayed:
            reserve = sign * (abs(b[0]) - abs(a).max())
        elif self.unit:
            reserve = self._least(
                lambda turns: sign * (abs(b @ turns) - abs(a @ turns)), (abs(a) + abs(b)) @ self.powers
            )
        else:
            reserve = abs(b[0]) - abs(b[1:]).sum() - abs(a).sum() if sign > 0 else 0.0
        end = self._end(self._lower(1.0, 1.0), reserve)
        if math.isnan(end) and self.loops.squares is not None:
            a, b = self.loops.squares
            end = float(positive_beyond(sign * (b - a))[0])
        return end

    def size_end(self) -> float:
        """A frequency beyond which abs(L) is not 1."""
        return self._size_end(-self.size) if self.size else math.nan

    @functools.cached_property
    def exceeds_one(self) -> bool:
        """Whether abs(L) is certainly above 1 at ever higher frequencies, if not at all of them."""
        if self.vanishes or self.size:
            return not self.vanishes and self.size > 0
        if not self.unit:
            return abs(self.b).sum() < abs(self.a).max() * 2 - abs(self.a).sum()
        angles = np.linspace(0, math.pi, 16 * int(max(self.powers)) + 1)
        turns = np.exp(-1j * np.multiply.outer(self.powers, angles))
        return bool((abs(self.a @ turns) > abs(self.b @ turns) * (1 + 1e-9)).any())

    # ---- the sensitivity

    @functools.cached_property
    def sensitivity(self) -> float:
        """The largest abs(b/(a + b))."""
        a, b = self.a, self.b
        if self.vanishes:
            return 1.0
        if len(a) == 1:
            return float(abs(b[0] / (a[0] + b[0])))
        if not b[1:].any() and (len(a) == 2 or not self.unit):
            return float(abs(b[0]) / (abs(a[0] + b[0]) - abs(a[1:]).sum()))
        if not self.unit:
            raise ValueError(
                "the largest sensitivity at ever higher frequencies is not decided: the highest powers have dead times "
                "that are not multiples of one"
            )
        return self._peaks[0][0]

    @functools.cached_property
    def _peaks(self) -> list[tuple[float, float]]:
        """The highest abs(b/(a + b)), and the angles where it may be about as high."""
        if len(self.a) == 2 and not self.b[1]:
            sign = (self.a[0] + self.b[0]) * self.a[1]
            return [(self.sensitivity, math.pi if sign > 0 else 0.0)]
        loops = self._highest_powers
        peak = Positive(loops)
        for angle in (0.0, math.pi):
            turns = np.exp(-1j * self.powers * angle)
            value = abs(self.b @ turns) / abs((self.a + self.b) @ turns)
            peak.see(np.zeros(1, dtype=int), np.array([value]), np.array([angle]))
        self._ask(peak)
        return [(float(peak.most[0]), float(peak.place[0]))]

    @_remembered
    def no_peak_beyond(self, most: float) -> float:
        """A frequency beyond which abs(B/C) is below `most`."""
        loops, a, b = self.loops, self.a, self.b
        simple = float(loops.beyond(np.array([most / (most - 1)]))[0]) if most > 1 else math.nan
        if self.vanishes:
            if math.isnan(simple) and loops.longest[0] == 0 and loops.squares is not None:
                simple = self._undelayed_peak_end(most)
            return simple
        if len(a) == 2 and self.is_one_delayed and math.isnan(simple) and most >= self.sensitivity:
            simple = float(loops.beyond_limit()[0])
        reserve = 0.0
        if len(a) == 1:
            reserve = most * abs(a[0] + b[0]) - abs(b[0])
            if loops.longest[0] == 0 and loops.squares is not None:
                simple = float(np.fmin(simple, self._undelayed_peak_end(most)))
        elif self.unit:
            steep = (most * abs(a + b) + abs(b)) @ self.powers
            reserve = self._least(lambda turns: most * abs((a + b) @ turns) - abs(b @ turns), steep)
        elif not b[1:].any():
            reserve = most * (abs(a[0] + b[0]) - abs(a[1:]).sum()) - abs(b[0])
        end = self._end(self._lower(most + 1, most), reserve)
        if not min(end if end == end else math.inf, simple if simple == simple else math.inf) < 30:
            end = float(np.fmin(end, self._beyond_peak(most)))
        return float(np.fmin(simple, end))

    def _undelayed_peak_end(self, most):
        loops = self.loops
        C = square((loops.A.coefficients + loops.B.coefficients)[0])
        return float(positive_beyond(most**2 * C - loops.squares[1])[0])

    def _beyond_peak(self, most):
        """The same, by expansions about the angle at which the highest powers alone have their largest value."""
        if not self.unit or len(self.a) == 1 or self._series is None:
            return math.nan
        A, B = self._series
        C = {m: A.get(m, 0) + B.get(m, 0) for m in {*A, *B}}
        a, b = self.a, self.b
        steep, wide = (most * abs(a + b) + abs(b)) @ self.powers, 1 / max(self.powers)
        around = [(angle, wide / 2) for _, angle in self._peaks]
        reserve = self._least(lambda turns: most * abs((a + b) @ turns) - abs(b @ turns), steep, around)
        end = self._end(self._lower(most + 1, most), reserve)
        best = math.nan
        for near in (wide / 20, wide / 60, wide / 200) if not math.isnan(end) else ():
            largest = []
            for _, angle in self._peaks:
                ratio = Expansion.of(A, C, angle, wide, -1.0, 1.0)
                largest.append(_not_above(ratio, most, near, angle) if ratio else 0.0)
                # from there to where the others' distance is enough
                apart = near
                while apart < wide / 2 and largest[-1]:
                    for beside in (angle + 1.1 * apart, angle - 1.1 * apart):
                        ratio = Expansion.of(A, C, beside, wide, -1.0, 1.0)
                        largest.append(_not_above_beside(ratio, most, 0.1 * apart) if ratio else 0.0)
                    apart *= 1.2
            if min(largest) > 0:
                best = np.fmin(best, max(end, 1 / min(largest)))
        return float(best)


def _to_segment(start, step):
    """The distance of 0 from ``start + t*step``, with t from 0 to 1."""
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.nan_to_num((-start * step.conj()).real / abs(step) ** 2)
    return abs(start + np.clip(along, 0, 1) * step)


def _related(delays: np.ndarray) -> bool:
    """Whether dead times, no multiples of one, may have a common multiple in sums with small whole factors."""
    if len(delays) < 3:
        return False
    return any(
        any(mix) and abs(sum(n * delay for n, delay in zip(mix, delays, strict=True))) < 1e-9 * delays.max()
        for mix in itertools.product(range(-3, 4), repeat=len(delays))
    )


# ---- expansions


class Expansion(NamedTuple):
    """A quotient of two quasipolynomials as a power series in the angle from some angle on and in v = 1/w.

    Attributes:
        terms: coefficients [power of the angle, power of v], up to the second order.
        wide, tall: radii of a polydisc in which it is analytic.
        largest: a bound there of how far it is from its value in the middle, and so of all terms but the first.
    """

    terms: np.ndarray
    wide: float
    tall: float
    largest: float

    @classmethod
    def of(
        cls, above: dict, below: dict, angle: float, wide: float, sign: float, more: float = 0.0
    ) -> Expansion | None:
        numbers = []
        for rows in (above, below):
            terms = np.zeros((3, 3), dtype=complex)
            for multiple, row in rows.items():
                turn = np.exp(-1j * multiple * angle)
                for i in range(3):
                    for j in range(min(3, len(row))):
                        terms[i, j] += row[j] * turn * (-1j * multiple) ** i / math.factorial(i)
            numbers.append(terms)
        N, D = numbers
        if not D[0, 0]:
            return None
        tall, size = 1.0, abs(D[0, 0])
        for _ in range(80):
            change = [_change(rows, wide, tall) for rows in (above, below)]
            if change[1] < size / 2:
                break
            if _change(below, wide, 0.0) > size / 4:
                wide /= 2
            else:
                tall /= 2
        else:
            return None
        largest = (change[0] * size + change[1] * abs(N[0, 0])) / ((size - change[1]) * size)
        quotient = np.zeros((3, 3), dtype=complex)
        for i in range(3):
            for j in range(3 - i):
                known = sum(
                    D[i - p, j - q] * quotient[p, q] for p in range(i + 1) for q in range(j + 1) if (p, q) != (i, j)
                )
                quotient[i, j] = (N[i, j] - known) / D[0, 0]
        quotient *= sign
        quotient[0, 0] += more
        return cls(quotient, wide, tall, float(largest))

    def rest(self, order: int, x: float, v: float, factor: float = 1.0) -> float:
        """A bound of the terms of at least some order, for angles up to x and v."""
        x, y = x / self.wide, v / self.tall
        if x > 0.7 or y > 0.7:
            return math.inf
        return factor * sum(x**i * y ** (order - i) for i in range(order + 1)) / ((1 - x) * (1 - y))


def _change(rows, wide, tall):
    """How far a sum is, at most, in a polydisc from its value in the middle."""
    total = 0.0
    for multiple, row in rows.items():
        turn = math.exp(min(50.0, abs(multiple) * wide))
        total += abs(row[0]) * (turn - 1) + turn * sum(abs(c) * tall**n for n, c in enumerate(row[1:], 1))
    return total


def _no_gain_between(gains: Expansion, low: float, high: float, near: float, angle: float) -> float:
    """A number up to which, with v, no real gain at near angles is between two; zero without one."""
    k, symmetric = gains.terms, abs(math.sin(angle)) < 1e-9
    across, v = k[1, 0].imag, gains.tall / 4
    if abs(across) <= 1e-9 * abs(k[1, 0]):
        return 0.0
    c, base = k[0, 1].imag / across, k[0, 0].real
    # the even and odd terms are real and imaginary at the angles 0 and pi, because all coefficients are real
    order = 3 if symmetric else 2
    for _ in range(60):
        reach = abs(c) * v + gains.rest(order, near, v, gains.largest) / abs(across)
        if reach < near:
            error = gains.rest(order, reach, v, gains.largest) / abs(across)
            if symmetric:
                rise = v * v * (k[2, 0] * c * c - k[1, 1] * c + k[0, 2]).real
                doubt = gains.rest(4, reach, v, gains.largest)
                doubt += abs(k[2, 0]) * error * (2 * abs(c) * v + error) + abs(k[1, 1]) * error * v
            else:
                rise = v * (k[0, 1].real - k[1, 0].real * c)
                doubt = gains.rest(2, reach, v, gains.largest) + abs(k[1, 0].real) * error
            above = base >= high and (rise >= doubt or base + min(0.0, rise) - doubt >= high)
            below = base <= low and (-rise >= doubt or base + max(0.0, rise) + doubt <= low)
            if above or below:
                return v
        v /= 2
    return 0.0


def _square(ratio):
    """The terms of the square of a quotient's size for real angles and v: the product with the conjugate series."""
    u, f = ratio.terms, np.zeros((3, 3))
    for i in range(3):
        for j in range(3 - i):
            f[i, j] = sum((u[p, q] * u[i - p, j - q].conj()).real for p in range(i + 1) for q in range(j + 1))
    return f


def _bounds(ratio, x, y):
    """Bounds of the terms of that square, for shares x and y of the radii."""
    numbers, middle = np.arange(64), abs(ratio.terms[0, 0])
    both = np.outer((numbers + 1) * x**numbers, (numbers + 1) * y**numbers)
    return 1.001 * ratio.largest * (2 * middle * np.outer(x**numbers, y**numbers) + ratio.largest * both)


def _orders():
    return np.add.outer(np.arange(64), np.arange(64))


def _not_above_beside(ratio: Expansion, most: float, near: float) -> float:
    """A number up to which, with v, the size of a quotient at near angles is not above a bound; zero without one."""
    f, v, x = _square(ratio), ratio.tall / 4, near / ratio.wide
    if x > 0.5:
        return 0.0
    there = f[0, 0] + abs(f[1, 0]) * near + abs(f[2, 0]) * near**2
    for _ in range(60):
        if there > most * most:
            return 0.0
        more = max(0.0, f[0, 1]) * v + abs(f[1, 1]) * near * v + abs(f[0, 2]) * v * v
        y = v / ratio.tall
        if y <= 0.5 and there + more + _bounds(ratio, x, y)[_orders() >= 3].sum() <= most * most:
            return v
        v /= 2
    return 0.0


def _not_above(ratio: Expansion, most: float, near: float, angle: float) -> float:
    """The same about an angle at which it is largest for v = 0, by the terms of the second order."""
    symmetric, v = abs(math.sin(angle)) < 1e-9, ratio.tall / 4
    f = _square(ratio)
    base, bend = f[0, 0], f[2, 0]
    if not bend < 0:
        return 0.0
    x = near / ratio.wide
    if x > 0.5:
        return 0.0
    high = _orders() >= (4 if symmetric else 3)
    squared = (np.arange(64) >= 2)[:, None] & high
    for _ in range(60):
        if (y := v / ratio.tall) <= 0.5:
            # bounds of the terms of the square; those with the angle squared make the bend weaker
            terms = _bounds(ratio, x, y)
            weaker = bend + terms[squared].sum() / near**2
            if weaker < 0:
                slope, first = (0.0, 0.0) if symmetric else (abs(f[1, 0]), f[0, 1] * v)
                second = f[0, 2] * v * v + (abs(f[1, 1]) * v + slope) ** 2 / (-4 * weaker)
                rest = terms[high & ~squared].sum()
                rise = first + second + rest
                if base + (0.0 if rise <= 0 else max(0.0, first) + max(0.0, second) + rest) <= most * most:
                    return v
        v /= 2
    return 0.0
