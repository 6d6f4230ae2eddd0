"""Enclosures of sums with dead times on intervals of frequency, and the walk that halves intervals until all is known.

On an interval from c - r to c + r a sum is its expansion in the frequency around c, a polynomial, and a rest that is
bounded: by the next derivative of the sum of all terms' sizes, and by the rounding of these terms. So an interval may
be as wide as the nearest zero is far away, and few intervals lead to a sharp resonance.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.quasipolynomials.arrays import DEGREE, Quasipolynomials
from loopbook.quasipolynomials.fraction import taylor_coefficient

if TYPE_CHECKING:
    from collections.abc import Callable

EPSILON = 2.0**-52
RATIO = 1.45  # of the frequencies at the ends of an interval, at first
FEW = 50  # intervals, up to which products of all terms are added up by one matrix
CLOSEST = 1e-7  # the smallest step, as a share, towards a frequency near which there is a root
MOST_INTERVALS = 60_000  # in one walk, and for each point of many
MORE_INTERVALS = 2_000
MOST_AT_ONCE = 2**15
MOST_EXACT = 3_000  # intervals that are looked at with more digits
BITS = 256  # at least, behind the binary point, of these
NARROWEST = 1e-14  # the half width, as a share of the frequency, at which an interval is left undecided
NOISY = 16  # times the rounding, below which a value is looked at with more digits


@dataclass
class Enclosure:
    """A function on intervals, scaled to run from -1 to 1: polynomial terms and bounds of the rest.

    Attributes:
        terms: array [power, interval].
        noise: bound of the rounding.
        rest, slope: bounds of the rest of the function, rounding included, and of its derivative.
    """

    __array_ufunc__ = None  # so that an array of factors leaves its multiplication to this class

    terms: np.ndarray
    noise: np.ndarray
    rest: np.ndarray
    slope: np.ndarray

    def __getitem__(self, chosen: object) -> Enclosure:
        return Enclosure(self.terms[:, chosen], self.noise[chosen], self.rest[chosen], self.slope[chosen])

    def __add__(self, other: Enclosure) -> Enclosure:
        terms = self.terms + other.terms
        return Enclosure(terms, self.noise + other.noise, self.rest + other.rest, self.slope + other.slope)

    def __sub__(self, other: Enclosure) -> Enclosure:
        return self + -1 * other

    def __rmul__(self, factor: float | np.ndarray) -> Enclosure:
        size = abs(factor)
        return Enclosure(factor * self.terms, size * self.noise, size * self.rest, size * self.slope)

    def __matmul__(self, other: Enclosure) -> Enclosure:
        """The product with the other's conjugate."""
        count, conjugate = len(self.terms), other.terms.conj()
        if conjugate.shape[1] <= FEW:
            terms = _diagonals(count) @ (self.terms[:, None] * conjugate).reshape(count * count, -1)
        else:
            terms = np.zeros((2 * count - 1, conjugate.shape[1]), dtype=complex)
            for k in range(count):
                terms[k : k + count] += self.terms[k] * conjugate
        noise = self.size * other.noise + other.size * self.noise + 4 * EPSILON * self.size * other.size
        rest = self.size * other.rest + other.size * self.rest + self.rest * other.rest
        steep, other_steep = self.steepness, other.steepness
        slope = (
            steep * other.rest + self.slope * (other.size + other.rest)
            + other_steep * self.rest + other.slope * (self.size + self.rest)
        )  # fmt: skip
        return Enclosure(terms, noise, rest + noise, slope + noise)

    @property
    def real(self) -> Enclosure:
        return Enclosure(self.terms.real, self.noise, self.rest, self.slope)

    @property
    def imag(self) -> Enclosure:
        return Enclosure(self.terms.imag, self.noise, self.rest, self.slope)

    @functools.cached_property
    def sizes(self) -> np.ndarray:
        return abs(self.terms)

    @functools.cached_property
    def size(self) -> np.ndarray:
        """A bound of the polynomial."""
        return self.sizes.sum(axis=0)

    @functools.cached_property
    def steepness(self) -> np.ndarray:
        """A bound of the polynomial's derivative."""
        return np.arange(len(self.terms)) @ self.sizes

    @property
    def spread(self) -> np.ndarray:
        """How far values are from that in the middle, at most."""
        return self.size - self.sizes[0] + self.rest

    @property
    def least(self) -> np.ndarray:
        """A bound from below of the size; negative where there may be a zero."""
        return 2 * self.sizes[0] - self.size - self.rest

    @property
    def most(self) -> np.ndarray:
        return self.size + self.rest

    @property
    def is_noisy(self) -> np.ndarray:
        """Whether rounding is a reason for not knowing."""
        return self.sizes[0] <= NOISY * self.noise

    @property
    def is_monotone(self) -> np.ndarray:
        """Whether a real function certainly rises or falls all the way."""
        return self.sizes[1] > self.steepness - self.sizes[1] + self.slope

    @property
    def is_positive(self) -> np.ndarray:
        """Whether a real function is certainly positive: a parabola is, and the rest does not change that."""
        value, rise = self.terms[0], self.sizes[1]
        curvature = self.terms[2] - (self.size - self.sizes[0] - self.sizes[1] - self.sizes[2])
        with np.errstate(divide="ignore", invalid="ignore"):
            lowest = np.where(rise < 2 * curvature, value - rise * rise / (4 * curvature), value + curvature - rise)
        return lowest > self.rest


@functools.cache
def _diagonals(count):
    """The matrix that adds the products of two polynomials' terms to the terms of their product."""
    matrix = np.zeros((2 * count - 1, count, count))
    for i in range(count):
        for k in range(count):
            matrix[i + k, i, k] = 1
    return matrix.reshape(2 * count - 1, count * count)


def enclosed(
    sums: Quasipolynomials,
    index: np.ndarray,
    c: np.ndarray,
    r: np.ndarray,
    exact: Exact | None = None,
    degree: int = DEGREE,
) -> Enclosure:
    """The quasipolynomials on the intervals from c - r to c + r; with more digits where there is an exact one."""
    end, degrees = c + r, np.arange(degree + 2)
    scale = r ** degrees[:, None]
    sizes = sums.sizes(index, end, degree) * scale
    if exact is None:
        terms = sums.taylor(index, c, degree) * scale[:-1]
        share = EPSILON * (2 * sums.order + 8 + 2 * end * sums.longest[index])
        noise, steep = share * sizes[:-1].sum(axis=0), share * (degrees[:-1] @ sizes[:-1])
    else:
        terms = exact.taylor(c, degree) * scale[:-1]
        noise = 8 * EPSILON * abs(terms).sum(axis=0) + 2.0**-140 * sizes[0]
        steep = degree * noise
    return Enclosure(terms, noise, noise + sizes[-1], steep + (degree + 1) * sizes[-1])


# ---- more digits


class Exact:
    """A quasipolynomial with more digits: ``{delay: coefficients}`` over ``divisor*unit**order``.

    Time is measured so that the frequency `unit` is 1.
    """

    def __init__(self, parts: dict[Fraction, tuple[int, ...]], order: int, divisor: int, unit: float):
        self.parts, self.order, self.divisor, self.unit = parts, order, divisor, unit
        # behind the binary point: of a high order the lowest coefficient is small, and the values with it
        down = divisor.bit_length() + order * math.log2(unit)
        sizes = (
            c.bit_length() + n * math.log2(unit) - down for part in parts.values() for n, c in enumerate(part) if c
        )
        self.bits = BITS + max(0, math.ceil(-min(sizes, default=0)))

    @functools.cached_property
    def _matrices(self):
        """For each part its dead time and the polynomials that, times ``exp(-delay*s)``, are the derivatives over k!.

        The numbers are whole multiples of ``2**-bits``.
        """
        unit = Fraction(self.unit)
        scale = 2**self.bits / (Fraction(self.divisor) * unit**self.order)
        found = []
        for delay, part in self.parts.items():
            late = [(-delay) ** k / math.factorial(k) for k in range(DEGREE + 1)]
            rows = []
            for k in range(DEGREE + 1):
                row = []
                for n in range(len(part)):
                    terms = (
                        math.comb(n + i, i) * part[n + i] * late[k - i] for i in range(min(k, len(part) - 1 - n) + 1)
                    )
                    row.append(round(sum(terms) * scale * unit ** (n + k)))
                rows.append(row)
            found.append((delay * unit, rows))
        return found

    def coefficients(self, delay: Fraction) -> np.ndarray:
        """The polynomial with a dead time, time in the unit: an array of fractions, the lowest power first."""
        part, unit = self.parts.get(delay, ()), Fraction(self.unit)
        whole = [*part, *[0] * (self.order + 1 - len(part))]
        return np.array([Fraction(c, self.divisor) * unit ** (n - self.order) for n, c in enumerate(whole)])

    def taylor(self, w: np.ndarray, degree: int = DEGREE) -> np.ndarray:
        """The coefficients of the powers of h in the quasipolynomial at ``j (w + h)*unit``: array [power,
        frequency]."""
        columns = [self._column(frequency, degree) for frequency in w.tolist()]
        return np.array(columns, dtype=complex).T.reshape(degree + 1, len(columns))

    def _column(self, frequency, degree):
        from mpmath import libmp

        bits = self.bits
        mantissa, below = frequency.as_integer_ratio()
        w = (mantissa << bits) // below
        square = -(w * w >> bits)
        totals = [[0, 0] for _ in range(degree + 1)]
        for delay, rows in self._matrices:
            cos, sin = 1 << bits, 0
            if delay:
                angle = libmp.from_rational(mantissa * delay.numerator, below * delay.denominator, 2 * bits)
                cos, sin = (libmp.to_fixed(x, bits) for x in libmp.mpf_cos_sin(angle, bits + 16))
            for total, row in zip(totals, rows, strict=False):
                even = odd = 0
                for c in row[(len(row) - 1) // 2 * 2 :: -2]:
                    even = (even * square >> bits) + c
                for c in row[(len(row) // 2 * 2 - 1) :: -2] if len(row) > 1 else ():
                    odd = (odd * square >> bits) + c
                odd = odd * w >> bits
                total[0] += even * cos + odd * sin >> bits
                total[1] += odd * cos - even * sin >> bits
        return [complex(real / (1 << bits), imag / (1 << bits)) * 1j**k for k, (real, imag) in enumerate(totals)]


# ---- the walk


class UndecidedError(ValueError):
    """An interval of frequency on which a question could not be decided."""

    def __init__(self, what: str, low: float, high: float, unit: float = 1.0):
        self.what, self.low, self.high = what, low * unit, high * unit
        super().__init__(f"{what} is not decided between the frequencies {self.low:.12g} and {self.high:.12g}")


def geometric(
    start: np.ndarray, end: np.ndarray, near: np.ndarray | None = None, ratio: float = RATIO
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals from zero, and from `start` to `end` in geometric steps: points, and both ends of each.

    About a frequency `near` of each point, if it is not nan, the steps become ever smaller.
    """
    reach = math.log(max(1.0, (end / start).max())) if len(start) else 0.0
    steps = max(1, math.ceil(reach / math.log(ratio)))
    edges = np.empty((steps + 2, len(start)))
    edges[0] = 0
    edges[1:] = start * (end / start) ** (np.arange(steps + 1)[:, None] / steps)
    edges[-1] = end
    if near is not None:
        closer = near * _OFFSETS()[:, None]
        closer = np.where((closer > 0) & (closer < end), closer, end)
        edges = np.sort(np.concatenate([edges, closer]), axis=0)
    index = np.broadcast_to(np.arange(len(start)), edges[1:].shape)
    a, b = edges[:-1], edges[1:]
    some = b > a
    return index[some], a[some], b[some]


@functools.cache
def _OFFSETS():
    steps = CLOSEST * 5.0 ** np.arange(math.ceil(math.log(0.5 / CLOSEST, 5)) + 1)
    return 1 + np.concatenate([-steps[::-1], steps])


def walk(
    judge: Callable,
    index: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    what: str,
    unit: np.ndarray,
    exact: bool = False,
    divide: Callable | None = None,
    most: int | None = None,
) -> int:
    """Divide intervals until `judge` has decided about all.

    Arguments:
        judge: function of points, both ends and whether to compute with more digits; it returns which intervals are
            undecided, for which of these rounding is a reason, and the longest dead time of each.
        index, a, b: the intervals at first.
        what: is asked, for the message.
        exact: whether more digits are at hand.
        divide: another function than `divided`.
        most: how many intervals may be looked at; 60,000, and some more for each point, if not given.
    Returns:
        How many were looked at.
    Raises:
        UndecidedError: for an interval that is so narrow that it cannot be divided any more, or too many intervals.
    """
    most = MOST_INTERVALS + MORE_INTERVALS * len(unit) if most is None else most
    left, digits_left = most, MOST_EXACT
    pending = [(index, a, b)]
    while pending:
        index, a, b = pending.pop()
        if len(index) > MOST_AT_ONCE:
            pending += [(index[MOST_AT_ONCE:], a[MOST_AT_ONCE:], b[MOST_AT_ONCE:])]
            index, a, b = (x[:MOST_AT_ONCE] for x in (index, a, b))
        left -= len(index)
        undecided, noisy, delay = judge(index, a, b, False)
        if not undecided.any():
            continue
        narrow = (b - a) <= 2 * NARROWEST * b
        if exact and (undecided & (noisy | narrow)).any():
            again = np.flatnonzero(undecided & (noisy | narrow))
            digits_left -= len(again)
            if digits_left >= 0:
                undecided[again] = judge(index[again], a[again], b[again], True)[0]
        stuck = np.flatnonzero(undecided & (narrow | (b <= 1e-250)))
        if left < 0 or digits_left < 0 or len(stuck):
            k = stuck[0] if len(stuck) else np.flatnonzero(undecided)[0]
            raise UndecidedError(what, a[k], b[k], float(unit[index[k]]))
        index, a, b, delay = (x[undecided] for x in (index, a, b, delay))
        pieces = np.clip(np.ceil((b - a) * delay / 0.8), 4, 64).astype(int)
        pending.append((divide or divided)(index, a, b, pieces))
    return most - left


def divided(
    index: np.ndarray, a: np.ndarray, b: np.ndarray, pieces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals in equal pieces."""
    source = np.repeat(np.arange(len(index)), pieces)
    number = np.arange(len(source)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    step, pieces = ((b - a) / pieces)[source], pieces[source]
    start = a[source]
    end = np.where(number + 1 == pieces, b[source], start + (number + 1) * step)
    return index[source], start + number * step, end


def divided_about(
    places: np.ndarray, index: np.ndarray, a: np.ndarray, b: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals that hold the places of their points, in three pieces, of which one has the place in its middle."""
    p = places[index]
    r = np.minimum(np.minimum(p - a, b - p), (b - a) / 8)
    edges = (a, p - r, p + r, b)
    index, a, b = np.tile(index, 3), np.concatenate(edges[:3]), np.concatenate(edges[1:])
    some = b > a
    return index[some], a[some], b[some]


# ---- at zero


def origin(sums: Quasipolynomials, degree: int, exact: Exact | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The power series in s at zero: coefficients [power, point] up to a degree, and what bounds the next ones.

    Coefficients that are zero but for rounding are zero; those of an exact sum are zero where they are.
    """
    degrees = np.arange(degree + 2)
    # the powers over the factorials, which alone would overflow
    late = np.repeat(sums.delays[:, None, :], degree + 2, axis=1) / np.maximum(degrees, 1)[:, None]
    late[:, 0] = 1.0
    late = late.cumprod(axis=1)
    bounds = np.zeros((degree + 2, sums.count))
    series = np.zeros_like(bounds, dtype=sums.coefficients.dtype)
    signs = (-1.0) ** degrees[:, None]
    for n in range(min(sums.order, degree + 1) + 1):
        part = sums.coefficients[:, n, None]
        series[n:] += (part * late * signs)[:, : degree + 2 - n].sum(axis=0)
        bounds[n:] += (abs(part) * late)[:, : degree + 2 - n].sum(axis=0)
    small = abs(series) <= 1e-14 * bounds
    if exact is None:
        series[small] = 0
    else:
        for n in np.flatnonzero(((abs(series) <= 1e-9 * bounds) & (bounds > 0))[:, 0]):
            series[n, 0] = float(exact_coefficient(exact, int(n)))
    return series[:-1], bounds[-1]


def exact_coefficient(exact: Exact, n: int) -> Fraction:
    """The coefficient of ``s**n`` in the power series of an exact quasipolynomial at zero, time in its unit."""
    return taylor_coefficient(exact.parts, n) / exact.divisor * Fraction(exact.unit) ** (n - exact.order)
