"""Open loops L = A/B in numbers, many at once: their values, what they are at zero, and beyond all intervals."""

from __future__ import annotations

import functools
import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.quasipolynomials.arrays import DEGREE, Quasipolynomials, expanded, turns
from loopbook.quasipolynomials.fraction import Quasipolynomial, plus, taylor_coefficient, times
from loopbook.stability.difference import at_infinite_frequency, power_of_two, prevailing
from loopbook.stability.enclosures import EPSILON, Enclosure, Exact, origin

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loopbook.quasipolynomials import DelayFraction

DOUBTFUL = 1e-12  # the share of rounding in a value above which crossings and peaks are computed with more digits
FEW = 100  # crossings that are computed with more digits if need be
ENOUGH = 1e-9  # two gains that differ by this share need not be told from each other


class Loops:
    """Numerators A and denominators B of loops, with time in units in which the frequency `unit` is 1.

    Arguments:
        A, B: with as many powers; B has an undelayed part first, with the highest power.
        fraction: the exact loop, where there is one only.
    """

    def __init__(self, A: Quasipolynomials, B: Quasipolynomials, fraction: DelayFraction | None = None):
        if B.coefficients[1:, -1].any():
            self.least_at_infinity = np.array([_least_at_infinity(B, k) for k in range(B.count)])
        else:
            self.least_at_infinity = abs(B.coefficients[0, -1])
        if not (self.least_at_infinity > 0).all():
            raise ValueError(
                "the highest power of the open loop's denominator returns so strongly that nothing is decided"
            )
        self.unit = power_of_two(prevailing(B.coefficients, self.least_at_infinity))
        order = B.order
        self.A, self.B = A.slower(self.unit), B.slower(self.unit)
        self.lag = self.A.delays.min(axis=0)
        self.count, self.exact, self.fraction = B.count, None, fraction
        if fraction is not None:
            divisor, scale = fraction.denominator[Fraction(0)][-1], float(self.unit[0])
            above, below = fraction.numerator, fraction.denominator
            self.exact = tuple(Exact(parts, order, divisor, scale) for parts in (above, below, plus(below, above)))

    def __getitem__(self, points: object) -> Loops:
        chosen = object.__new__(Loops)
        for name in ("A", "B", "lag", "unit", "least_at_infinity"):
            setattr(chosen, name, getattr(self, name)[points])
        chosen.count, chosen.exact, chosen.fraction = chosen.B.count, None, None
        return chosen

    @functools.cached_property
    def early(self) -> Quasipolynomials:
        """A without its common dead time."""
        return self.A.delayed(-self.lag)

    @functools.cached_property
    def C(self) -> Quasipolynomials:
        """A + B, whose roots are the poles of the closed loop."""
        return self.B + self.A

    @functools.cached_property
    def longest(self) -> np.ndarray:
        """The longest dead time of each loop."""
        return np.maximum(self.A.longest, self.B.longest)

    def values(
        self, index: np.ndarray, w: np.ndarray, degree: int = 0, precise: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """The expansions of A and B at frequencies."""
        if precise:
            return tuple(each.taylor(w, degree) for each in self.exact[:2])
        if self.count > 1:
            return self.A.taylor(index, w, degree), self.B.taylor(index, w, degree)
        matrices, delays, parts = self._stacked
        values = expanded(matrices, delays, w, degree)
        return values[:parts].sum(axis=0), values[parts:].sum(axis=0)

    @functools.cached_property
    def _stacked(self):
        """What the expansions of A and B take, in one piece."""
        delays = np.concatenate([self.A.delays[:, 0], self.B.delays[:, 0]])
        return np.concatenate([self.A.turned, self.B.turned]), delays, len(self.A.delays)

    def noise(self, index: np.ndarray, w: np.ndarray) -> list[np.ndarray]:
        """Bounds of the rounding in the values of A and B."""
        return [
            EPSILON * (2 * sums.order + 8 + 2 * w * sums.longest[index]) * sums.sizes(index, w, -1)[0]
            for sums in (self.A, self.B)
        ]

    # ---- at zero

    @functools.cached_property
    def at_zero(self) -> tuple:
        """The power series of A and B at zero in j w, zeros that both have removed; and bounds of the next terms."""
        degree = 2 * self.B.order + 6
        exact = self.exact[:2] if self.exact else (None, None)
        (a, more_a), (b, more_b) = (origin(x, degree, e) for x, e in zip((self.A, self.B), exact, strict=True))
        removed = np.argmax((a != 0) | (b != 0), axis=0)
        more_a, more_b = 2 * more_a, 2 * more_b  # for all terms, where the frequency times each delay is below 1/2
        if removed.any():
            for n in set(removed[removed > 0].tolist()):
                some = removed == n
                a[:-n, some], b[:-n, some] = a[n:, some], b[n:, some]
                a[-n:, some] = b[-n:, some] = 0
        return a * turns(degree + 1), b * turns(degree + 1), more_a, more_b, removed

    def near_zero(self, index: np.ndarray, r: np.ndarray) -> tuple[Enclosure, Enclosure]:
        """Enclosures of A and B from -r to r, without the zeros at zero that both have."""
        a, b, more_a, more_b, removed = self.at_zero
        found = []
        for series, more in ((a, more_a), (b, more_b)):
            scale = r ** np.arange(len(series))[:, None]
            terms = series[:, index] * scale
            sizes = abs(terms)
            noise = 8 * EPSILON * sizes.sum(axis=0)
            powers = np.arange(DEGREE + 1, len(series))
            last = more[index] * r ** (len(series) - removed[index])
            rest = sizes[DEGREE + 1 :].sum(axis=0) + last
            slope = powers @ sizes[DEGREE + 1 :] + 2 * len(series) * last
            found.append(Enclosure(terms[: DEGREE + 1], noise, rest + noise, slope + DEGREE * noise))
        return tuple(found)

    @functools.cached_property
    def start(self) -> np.ndarray:
        """A frequency up to which L turns off the real axis and the size 1, if it begins there, but never returns."""
        a, b, more_a, more_b, _ = self.at_zero
        size_a, size_b = abs(a), abs(b)
        of_a, of_b = (size_a, more_a), (size_b, more_b)
        odd = self._without_rounding(_conjugate_product(a, b).imag, _conjugate_product(size_a, size_b), 1)
        self.is_real = ~odd[: len(a)].any(axis=0)
        even, sizes = (
            _conjugate_product(y, y) + sign * _conjugate_product(x, x)
            for x, y, sign in ((a, b, -1), (size_a, size_b, 1))
        )
        even = self._without_rounding(even.real, sizes, 0)
        return np.minimum(
            self._lowest_rules(odd, _conjugate_product(size_a, size_b), [(of_a, of_b)]),
            self._lowest_rules(even, sizes, [(of_a, of_a), (of_b, of_b)]),
        )

    def _without_rounding(self, series, sizes, parity):
        """A power series in w, Im A conj(B) with odd powers or ``abs(B)**2 - abs(A)**2`` with even ones.

        Of a single loop the lowest term that is not zero, which rounding may hide, is exact.
        """
        series[abs(series) <= 1e-12 * sizes] = 0
        series[1 - parity :: 2] = 0
        if self.exact is None:
            return series
        count, removed, (A, B) = len(self.at_zero[0]), int(self.at_zero[4][0]), self.exact[:2]
        product = None
        for n in range(parity, count, 2):
            if abs(series[n, 0]) > 1e-8 * sizes[n, 0]:
                break
            if not sizes[n, 0]:
                continue
            product = product or (self._odd if parity else plus(_square(B.parts), _square(A.parts), -1))
            # of powers of s: those of w have other signs, and 2j Im A conj(B) is the odd one
            value = taylor_coefficient(product, n + 2 * removed) * (-1) ** (n // 2 + removed) / (1 + parity)
            value *= Fraction(A.unit) ** (n + 2 * removed - 2 * A.order) / A.divisor**2
            series[n, 0] = float(value)
            if value:
                break
        return series

    def _lowest_rules(self, series, sizes, pairs):
        """A frequency up to which the lowest term of a power series in w is twice as large as all others together.

        The series ends where those of A and B do, whose products it has; what they leave out is bounded.
        """
        a, *_, removed = self.at_zero
        count, points = len(a), np.arange(self.count)
        some, lowest = series[:count].any(axis=0), np.argmax(series[:count] != 0, axis=0)
        known, others = abs(series[lowest, points]), abs(series)
        others[lowest, points], others[count:] = 0, sizes[count:]
        gaps = np.maximum(np.arange(len(series))[:, None] - lowest, 0)
        # where each of the next powers is still a quarter of the lowest one; then in halves
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = (known / (4 * others[:count])) ** (1 / np.maximum(gaps[:count], 1))
        start = 0.25 / np.maximum(self.longest, 1.0)
        start = np.where(some, np.fmin(start, np.where(gaps[:count], ratios, math.inf).min(axis=0)), start)
        degrees = np.arange(count)[:, None]
        for _ in range(400):
            powers = start**degrees
            beyond = start ** (count - removed)
            rest = sum(
                (x * powers).sum(axis=0) * more_y + (y * powers).sum(axis=0) * more_x + more_x * more_y * beyond
                for (x, more_x), (y, more_y) in pairs
            )
            high = some & ((others * start**gaps).sum(axis=0) + rest * start ** (count - removed - lowest) > known / 2)
            if not high.any():
                break
            start = np.where(high, start / 2, start)
        return start

    @functools.cached_property
    def _odd(self) -> Quasipolynomial:
        """A(s) B(-s) - A(-s) B(s) of a single loop: where it is zero on the axis, L is real."""
        A, B = (each.parts for each in self.exact[:2])
        return plus(times(A, _mirrored(B)), times(_mirrored(A), B), -1)

    def static_gains(self) -> np.ndarray:
        """The gain with which there is a pole at zero; nan without one."""
        a, b, *_ = self.at_zero
        with np.errstate(divide="ignore", invalid="ignore"):
            gain = -b[0].real / a[0].real
        return np.where((gain > 0) & np.isfinite(gain), gain, math.nan)

    # ---- beyond

    def beyond(self, factor: np.ndarray) -> np.ndarray:
        """A frequency beyond which ``abs(L)*factor`` is below 1; nan where none is known."""
        A, B = self._term_sizes
        sizes = B + factor * A
        reserve = self._reserve_at_infinity - factor * A[-1]
        sizes[-1] = np.where(reserve > 0, reserve, math.nan)
        end = prevailing(sizes[None])
        # Fujiwara's bound adds up sizes; where it is far out, the squares, in which terms cancel, may do much better
        if self.squares is not None and not (end < 8).all():
            squares = self.squares
            end = np.fmin(end, positive_beyond(squares[1] - factor**2 * squares[0]))
        return end

    @functools.cached_property
    def _term_sizes(self):
        return abs(self.A.coefficients).sum(axis=0), abs(self.B.coefficients).sum(axis=0)

    @functools.cached_property
    def _reserve_at_infinity(self):
        return np.maximum(2 * abs(self.B.coefficients[0, -1]) - self._term_sizes[1][-1], self.least_at_infinity)

    @functools.cached_property
    def squares(self) -> list[np.ndarray] | None:
        """``abs(A)**2`` and ``abs(B)**2`` of loops with one dead time, polynomials in the square of the frequency."""
        if len(self.A.coefficients) != 1 or len(self.B.coefficients) != 1:
            return None
        if self.exact is None:
            return [np.array(square(x.coefficients[0])) for x in (self.A, self.B)]
        return [self._exact_square(each) for each in self.exact[:2]]

    def _exact_square(self, exact: Exact) -> np.ndarray:
        """The same of a sum with one dead time at most, rounded at the end only."""
        (part,) = exact.parts.values()
        row = np.zeros((self.B.order + 1, 1))
        for n, c in enumerate(square(part)):
            shift = 2 * (n - self.B.order) * (math.frexp(exact.unit)[1] - 1)  # the unit is a power of two
            row[n] = (c << max(shift, 0)) / (exact.divisor**2 << max(-shift, 0))
        return row

    def beyond_limit(self) -> np.ndarray:
        """A frequency beyond which abs(L) is not above what it is at infinite frequency, with one dead time; or nan.

        In numbers, for many loops.
        """
        if self.squares is None:
            return np.full(self.count, math.nan)
        a, b = self.squares
        with np.errstate(divide="ignore", invalid="ignore"):
            rows = b - b[-1] / a[-1] * a
            sizes = abs(b) + b[-1] / a[-1] * abs(a)
        rows[-1] = 0
        # less than that could make no difference to a gain that could be told
        rows[abs(rows) <= 1e-11 * sizes.max(axis=0)] = 0
        return np.where(rows.any(axis=0), positive_beyond(rows), np.where(rows[-1] == 0, 1.0, math.nan))

    @functools.cached_property
    def real_beyond(self) -> float:
        """A frequency beyond which L is never real, of a single loop; nan if it may be, zero if L is always real."""
        if not (odd := self._odd):
            return 0.0
        order, largest = max(map(len, odd.values())) - 1, max(abs(c) for part in odd.values() for c in part)
        sums = Quasipolynomials.exact({Fraction(0): (), **odd}, order, largest).slower(self.unit)
        rows = sums.coefficients[np.argsort(abs(sums.delays[:, 0]))]  # the undelayed part first
        return float(prevailing(rows)[0]) if rows[0, -1, 0] else math.nan

    def real_beyond_all(self) -> np.ndarray:
        """The same for many loops, in numbers."""
        mirrored = [
            Quasipolynomials((-1.0) ** np.arange(x.order + 1)[:, None] * x.coefficients, -x.delays)
            for x in (self.A, self.B)
        ]
        odd = self.A * mirrored[1] + -1 * (mirrored[0] * self.B)
        sizes = abs(self.A.coefficients).sum(axis=0).max(axis=0) * abs(self.B.coefficients).sum(axis=0).max(axis=0)
        coefficients = np.where(abs(odd.coefficients) <= 1e-13 * sizes, 0, odd.coefficients)
        end = np.zeros(self.count)
        for point in range(self.count):
            one = coefficients[:, :, point]
            if one.any():
                last = np.flatnonzero(one.any(axis=0))[-1]
                end[point] = prevailing(one[:, : last + 1, None])[0] if one[0, last] else math.nan
        return end


def _mirrored(parts: Quasipolynomial) -> Quasipolynomial:
    """The quasipolynomial of -s."""
    return {-delay: tuple((-1) ** n * c for n, c in enumerate(part)) for delay, part in parts.items()}


def _square(parts: Quasipolynomial) -> Quasipolynomial:
    """The square of the size of a quasipolynomial on the imaginary axis."""
    return times(parts, _mirrored(parts))


def square(part: Sequence) -> list:
    """The square of a polynomial's size on the imaginary axis, in powers of ``w*w``; coefficients may be arrays."""
    order = len(part) - 1
    return [
        sum((-1) ** abs(n - i) * part[i] * part[2 * n - i] for i in range(max(0, 2 * n - order), min(2 * n, order) + 1))
        for n in range(order + 1)
    ]


def positive_beyond(rows: np.ndarray) -> np.ndarray:
    """The roots of numbers beyond which polynomials [power, point] are positive; nan without one."""
    count = len(rows)
    found = np.full(rows.shape[1], math.inf)
    possible = np.ones(rows.shape[1], dtype=bool)
    for n in range(count - 1, -1, -1):
        lead = rows[n]
        possible = possible & (lead >= 0)
        if not possible.any():
            break
        lower = np.maximum(-rows[:n], 0)
        number = (lower > 0).sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = (lower * number / lead) ** (1 / np.arange(n, 0, -1)[:, None])
        end = np.nan_to_num(ends, nan=math.inf).max(axis=0, initial=1e-6)
        found = np.where(possible & (lead > 0), np.minimum(found, end), found)
    # a little beyond, because such a bound may itself be a zero
    return np.where(found < math.inf, 1.001 * np.sqrt(found), math.nan)


def _conjugate_product(x, y):
    """The power series in w of one times the other's conjugate."""
    other = y.conj()
    if x.shape[1] == 1:
        return np.convolve(x[:, 0], other[:, 0])[:, None]
    product = np.zeros((len(x) + len(y) - 1, x.shape[1]), dtype=x.dtype)
    for i, row in enumerate(x):
        product[i : i + len(y)] += row * other
    return product


def _least_at_infinity(B, point):
    lead = B.coefficients[:, -1, point]
    if not lead[1:].any():
        return abs(lead[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        later = lead[1:] / lead[0]
    return abs(lead[0]) * at_infinite_frequency(later, B.delays[1:, point]).least
