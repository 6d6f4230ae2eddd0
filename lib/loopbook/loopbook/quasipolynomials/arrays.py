"""Many sums of polynomials with dead times at once, as arrays of numbers, and expansions on the imaginary axis."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING, Self

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

__all__ = ["DEGREE", "Quasipolynomials"]

DEGREE = 4  # of the expansions in the frequency


class Quasipolynomials:
    """Sums of ``p(s)*exp(-delay*s)`` of one shape, one for each point of a map, a boundary or a family.

    Arguments:
        coefficients: array [part, power, point], the lowest power first.
        delays: array [part, point]. The first part has no dead time.

    >>> from fractions import Fraction
    >>> two = Quasipolynomials.exact({Fraction(0): (0, 2), Fraction(1): (1,)}, order=1, divisor=2)
    >>> two.coefficients[:, :, 0].tolist(), two.delays[:, 0].tolist()
    ([[0.0, 1.0], [0.5, 0.0]], [0.0, 1.0])
    """

    __array_ufunc__ = None  # so that an array of factors, one for each point, leaves its multiplication to this class

    def __init__(self, coefficients: np.ndarray, delays: np.ndarray):
        count = max(coefficients.shape[-1], delays.shape[-1])
        if coefficients.shape[-1] != count:
            coefficients = np.broadcast_to(coefficients, (*coefficients.shape[:2], count))
        if delays.shape[-1] != count:
            delays = np.broadcast_to(delays, (len(delays), count))
        self.coefficients, self.delays = coefficients, delays

    @classmethod
    def exact(cls, parts: Mapping[Fraction, tuple[int, ...]], order: int, divisor: int) -> Self:
        """One quasipolynomial ``{delay: coefficients}`` over a divisor, as numbers; no part is one that is zero.

        It is divided before, because exact numbers may be too large or too small for floating point.
        """
        parts = dict(sorted(parts.items())) or {0: ()}  # the undelayed part first
        rows = [[*(c / divisor for c in part), *[0.0] * (order + 1 - len(part))] for part in parts.values()]
        return cls(np.array(rows, dtype=float)[:, :, None], np.array([[float(delay)] for delay in parts]))

    @property
    def order(self) -> int:
        """The highest power."""
        return self.coefficients.shape[1] - 1

    @property
    def count(self) -> int:
        """The number of quasipolynomials."""
        return self.coefficients.shape[-1]

    @functools.cached_property
    def longest(self) -> np.ndarray:
        """The longest dead time of each quasipolynomial."""
        return self.delays.max(axis=0)

    # ---- algebra

    def __getitem__(self, points: object) -> Quasipolynomials:
        return Quasipolynomials(self.coefficients[..., points], self.delays[..., points])

    def __rmul__(self, factor: float | np.ndarray) -> Quasipolynomials:
        return Quasipolynomials(factor * self.coefficients, self.delays)

    def __add__(self, other: Quasipolynomials) -> Quasipolynomials:
        """What has the same dead times becomes one part, the undelayed one first, so that terms cancel."""
        order, count = max(self.order, other.order), max(self.count, other.count)
        parts = {np.zeros(count).tobytes(): (np.zeros(count), np.zeros((order + 1, count)))}
        for sums in (self, other):
            for part, delay in zip(sums.coefficients, sums.delays, strict=True):
                delay = np.broadcast_to(delay, count) + 0.0
                total = parts.setdefault(delay.tobytes(), (delay, np.zeros((order + 1, count))))[1]
                total[: len(part)] += part
        return Quasipolynomials(
            np.stack([part for _, part in parts.values()]), np.stack([delay for delay, _ in parts.values()])
        )

    def __mul__(self, other: Quasipolynomials) -> Quasipolynomials:
        parts, delays = [], []
        for p, delay in zip(self.coefficients, self.delays, strict=True):
            for q, later in zip(other.coefficients, other.delays, strict=True):
                part = np.zeros((len(p) + len(q) - 1, max(self.count, other.count)))
                for n, row in enumerate(p):
                    part[n : n + len(q)] += row * q
                parts.append(part)
                delays.append(delay + later)
        return Quasipolynomials(np.stack(parts), np.stack(delays))

    def delayed(self, delay: np.ndarray) -> Quasipolynomials:
        """The quasipolynomials with an additional dead time, or one less."""
        return Quasipolynomials(self.coefficients, self.delays + delay)

    def derivative(self) -> Quasipolynomials:
        """The derivative with respect to s."""
        return Quasipolynomials(_derivative(self.coefficients) - self.delays[:, None] * self.coefficients, self.delays)

    def slower(self, unit: np.ndarray) -> Quasipolynomials:
        """The quasipolynomials divided by ``unit**order``, with time in a unit in which the frequency `unit` is 1."""
        powers = np.arange(self.order + 1) - self.order
        return Quasipolynomials(self.coefficients * unit ** powers[:, None].astype(float), self.delays * unit)

    def at(self, points: np.ndarray) -> np.ndarray:
        """The values of a single quasipolynomial at complex points."""
        parts = zip(self.coefficients[..., 0], self.delays[:, 0], strict=True)
        return sum(np.polynomial.polynomial.polyval(points, part) * np.exp(-delay * points) for part, delay in parts)

    # ---- on the imaginary axis

    def value(self, points: np.ndarray, w: np.ndarray) -> np.ndarray:
        """The values of some quasipolynomials at s = j w, one frequency for each."""
        return self.taylor(points, w, 0)[0]

    def taylor(self, points: np.ndarray, w: np.ndarray, degree: int = DEGREE) -> np.ndarray:
        """The coefficients of the powers of h in the quasipolynomials at s = j (w + h): array [power, frequency]."""
        if self.count == 1:
            return expanded(self.turned, self.delays[:, 0], w, degree).sum(axis=0)
        # in powers of w alone, which is quicker: the even powers are real, the odd ones imaginary
        powers = powers_of(w, self.order + 1) * np.resize([1.0, 1.0, -1.0, -1.0], self.order + 1)[:, None]
        total = np.zeros((degree + 1, len(w)), dtype=complex)
        for matrix, delay in zip(self._expansion, self.delays, strict=True):
            chosen = matrix[: degree + 1].take(points, axis=2)
            even, odd = (np.einsum("kij,ij->kj", chosen[:, first::2], powers[first::2]) for first in (0, 1))
            value = even + 1j * odd
            total += value * np.exp(-1j * (w * delay[points])) if delay.any() else value
        return total * turns(degree + 1)

    def sizes(self, points: np.ndarray, w: np.ndarray, degree: int = DEGREE) -> np.ndarray:
        """Bounds of the coefficients of the powers 0 to degree + 1 in `taylor`, from zero to the frequency w.

        They are those of the sum of the sizes of all terms, and the last one bounds the remainder.
        """
        sizes, powers = self._sizes[: degree + 2], powers_of(w, self.order + 1)
        if self.count == 1:
            return sizes[..., 0] @ powers
        return np.einsum("kij,ij->kj", sizes.take(points, axis=2), powers)

    @functools.cached_property
    def _expansion(self):
        """Array [part, k, power, point]: polynomials that, times ``exp(-delay*s)``, are the derivatives over k!."""
        return _derivatives(self.coefficients, -self.delays, DEGREE)

    @functools.cached_property
    def turned(self) -> np.ndarray:
        """What a single quasipolynomial is expanded with: arrays [part, k, power], in powers of the frequency."""
        return self._expansion[..., 0] * (turns(DEGREE + 1) * turns(self.order + 1).T)

    @functools.cached_property
    def _sizes(self):
        return _derivatives(abs(self.coefficients), abs(self.delays), DEGREE + 1).sum(axis=0)


def expanded(matrices: np.ndarray, delays: np.ndarray, w: np.ndarray, degree: int) -> np.ndarray:
    """The parts of the expansions of single quasipolynomials at frequencies: array [part, power, frequency]."""
    parts = matrices[:, : degree + 1] @ powers_of(w, matrices.shape[2])
    if delays.any():
        parts *= np.exp(-1j * np.multiply.outer(delays, w))[:, None]
    return parts


def _derivatives(coefficients, rates, degree):
    """Array [part, k, power, point]: ``(d/ds + rate)**k / k!`` of polynomials [part, power, point]."""
    parts, powers, count = coefficients.shape
    padded = np.zeros((parts, powers + degree, count), dtype=coefficients.dtype)
    padded[:, :powers] = coefficients
    indices, binomials = _taylor(powers, degree)
    terms = padded[:, indices] * binomials
    if not rates.any():
        return terms
    late = np.ones((parts, degree + 1, 1, count))
    late[:, 1:, 0] = rates[:, None] / np.arange(1, degree + 1)[:, None]
    late = late.cumprod(axis=1)
    total = terms[:, :1] * late
    for i in range(1, min(degree + 1, powers)):
        total[:, i:] += terms[:, i, None] * late[:, : degree + 1 - i]
    return total


@functools.cache
def _taylor(powers, degree):
    """Which coefficient, and how many times, is that of a power in a derivative over k!: arrays [k, power]."""
    indices = np.arange(degree + 1)[:, None] + np.arange(powers)
    binomials = [[float(math.comb(n, k)) for n in row] for k, row in enumerate(indices.tolist())]
    return indices, np.array(binomials)[..., None]


@functools.cache
def turns(count: int) -> np.ndarray:
    """The powers 0, 1 ... of j, a column."""
    return np.array([1, 1j, -1, -1j])[np.arange(count) % 4, None]


def _derivative(coefficients):
    lower = np.zeros_like(coefficients)
    lower[:, :-1] = coefficients[:, 1:] * np.arange(coefficients.shape[1])[1:, None]
    return lower


def powers_of(w: np.ndarray, count: int) -> np.ndarray:
    """The powers 0, 1 ... of numbers: array [power, number]."""
    return w ** np.arange(count)[:, None] if count > 1 else (0 * w + 1)[None]
