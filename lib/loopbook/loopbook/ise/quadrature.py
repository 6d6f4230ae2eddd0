"""Parseval's integral in numbers, for any dead times, with what E is for large s and near the axis taken out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.ise.error import ErrorFraction, NotApplicableError
from loopbook.ise.modes import slow_modes

if TYPE_CHECKING:
    from loopbook.ise.modes import Modes

ERROR = 1e-9
NARROW = 1e-5  # intervals beside a pole, as a share of the speed, that are too short for floating point
WIDER = 1e3  # how many times as far as the nearest pole the poles are taken out


def by_quadrature(fraction: ErrorFraction) -> float:
    """Parseval's integral, after what E is for large s has been taken out and integrated by a formula.

    Poles very near to the axis are taken out, too. With m(t) the sum of their modes, the integral of e^2 is that of
    (e - m)^2, and twice that of e m, which is the sum of residue times E(-pole), less that of m^2.
    """
    fraction.need_retarded()
    problem = _Problem(fraction)
    try:
        return problem.integral(None, 0.0)
    except _NearPoleError as near:
        rate = WIDER * near.radius
    for _ in range(4):
        modes = slow_modes(fraction, rate * problem.speed)
        if modes is not None:
            try:
                return problem.integral(modes, rate)
            except _NearPoleError:
                rate *= 10
        else:
            rate /= 4
    raise NotApplicableError("a pole lies too near to the imaginary axis")


class _NearPoleError(Exception):
    """A pole is so near to the axis that it has to be taken out."""

    def __init__(self, radius: float):
        super().__init__(radius)
        self.radius = radius


class _Problem:
    """E in a unit of time in which the speed is 1, and its integral."""

    def __init__(self, fraction: ErrorFraction):
        self.speed, self.pole = fraction.speed, fraction.pole
        self.above, self.above_delays, self.below, self.below_delays = fraction.arrays(self.speed)
        self.powers = np.arange(self.below.shape[1])
        self.levels = _for_large_s(self.above, self.above_delays, self.below, self.below_delays, fraction.pole)

    def E(self, w: np.ndarray) -> np.ndarray:
        below = _sum(self.below, self.below_delays, w) * (1j * w) ** self.pole
        return _sum(self.above, self.above_delays, w) / below

    def near(self, center: np.ndarray, radius: np.ndarray) -> np.ndarray:
        """Whether a pole may lie within two radii."""
        far, size = center + 2 * radius, abs(self.below)
        growth = np.exp(2 * radius[:, None] * self.below_delays)
        terms = size[:, 1:] * self.powers[1:]
        slope = np.stack([np.polyval(row[::-1], far) for row in terms], axis=1)
        slope = slope + self.below_delays * np.stack([np.polyval(row[::-1], far) for row in size], axis=1)
        reach = 2 * radius * (growth * slope).sum(axis=1)
        return (abs(_sum(self.below, self.below_delays, center)) <= reach) | (2 * radius > np.hypot(center, 1))

    def integral(self, modes: Modes | None, rate: float) -> float:
        """The integral, with the modes taken out; they are all to the right of -rate."""
        poles = residues = np.zeros(0, dtype=complex)
        total = 0.0
        if modes is not None:
            pairs = modes.poles.imag > 0
            poles, residues, mirrored = (
                np.concatenate([each, each[pairs].conj()])
                for each in (modes.poles / self.speed, modes.residues / self.speed, modes.mirrored)
            )
            total = float((2 * residues * mirrored).sum().real)
            total += float((residues[:, None] * residues / (poles[:, None] + poles)).sum().real)
        levels = [dict(level) for level in self.levels]
        for k, level in enumerate(levels[1:]):
            level[0.0] = level.get(0.0, 0.0) - float((residues * (poles + 1) ** k).sum().real)
        expansion = {(delay, k): c for k, level in enumerate(levels[:-1]) for delay, c in level.items() if c}
        sizes = [sum(map(abs, level.values())) for level in levels]
        total += _square_of_expansion(expansion)

        def integrand(w):
            turns = {delay: np.exp(-1j * w * delay) for delay in {delay for delay, _ in expansion}}
            falls = {k: (1j * w + 1) ** -k for k in {k for _, k in expansion}}
            asymptotic = sum(c * falls[k] * turns[delay] for (delay, k), c in expansion.items())
            E = self.E(w) - sum(c / (1j * w - p) for c, p in zip(residues, poles, strict=True))
            return abs(E) ** 2 - abs(asymptotic) ** 2

        nodes, weights = np.polynomial.legendre.leggauss(16)
        fewer, their_weights = np.polynomial.legendre.leggauss(12)
        # the integrand turns with twice the longest dead time
        longest = max(self.below_delays.max(), self.above_delays.max())
        error, begin, end = 0.0, 0.0, 8.0
        narrowest = math.inf
        for _ in range(12):
            ends = np.linspace(begin, end, 1 + math.ceil((end - begin) * max(longest, 1)))
            a, b = ends[:-1], ends[1:]
            while len(a):
                center, radius = (a + b) / 2, (b - a) / 2
                split = self.near(center, radius) & (2 * radius > rate)
                c, r = center[~split, None], radius[~split, None]
                one, other = (integrand(c + r * x) @ w * r[:, 0] for x, w in ((nodes, weights), (fewer, their_weights)))
                total += float(one.sum()) / math.pi
                error += float(abs(one - other).sum()) / math.pi
                a, b = np.concatenate([a[split], center[split]]), np.concatenate([center[split], b[split]])
                if len(a):
                    narrowest = min(narrowest, float(radius[split].min()) / 2)
                    if modes is None and narrowest < NARROW:
                        # as far as the intervals were to be halved, to see how near the pole is
                        raise _NearPoleError(self._distance(center[split], radius[split]))
            if not math.isfinite(total) or error > ERROR * abs(total) / 20:
                raise _NearPoleError(max(narrowest if narrowest < math.inf else 1e-3, 1e-16))
            leading = sum(size / end**k for k, size in enumerate(sizes[:-1]) if k)
            left = 4 * leading * sizes[-1] * end**-TERMS / TERMS / math.pi
            if error + left <= ERROR * abs(total) / 10:
                return float(total) * self.speed
            begin, end = end, 2 * end
        raise NotApplicableError(f"an error of {(error + left) / abs(total):.0e} was left")

    def _distance(self, center: np.ndarray, radius: np.ndarray) -> float:
        """About how near the nearest pole is."""
        for _ in range(60):
            a, b = center - radius, center + radius
            a, b = np.concatenate([a, center]), np.concatenate([center, b])
            center, radius = (a + b) / 2, (b - a) / 2
            still = self.near(center, radius)
            if not still.any():
                break
            center, radius = center[still], radius[still]
        return float(radius.min())


def _sum(coefficients: np.ndarray, delays: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The value of a sum of polynomials with dead times at s = j w."""
    return sum(
        np.polyval(row[::-1] * 1j ** np.arange(len(row))[::-1], w) * np.exp(-1j * w * delay)
        for row, delay in zip(coefficients, delays, strict=True)
    )


TERMS = 3  # of the expansion for large s


def _for_large_s(above, above_delays, below, below_delays, pole):
    """E for large s, a sum of ``c exp(-delay*s)/(s + 1)^k``: {delay: c} for k = 0, 1 ..., the last one for the rest."""

    def in_powers(row, order):  # the polynomial divided by (s + 1)^order, in powers of u = 1/(s + 1)
        shifted = np.polynomial.Polynomial(row)(np.polynomial.Polynomial([-1, 1])).coef  # in powers of s + 1
        found = np.zeros(TERMS + 2)
        for k, c in enumerate(shifted):
            if order - k < len(found):
                found[order - k] += c
        return found

    order = below.shape[1] - 1 + pole
    below = np.hstack([np.zeros((len(below), pole)), below])
    numerator, denominator = (
        [(round(delay, 12), in_powers(row, order)) for delay, row in zip(delays, rows, strict=True)]
        for delays, rows in ((above_delays, above), (below_delays, below))
    )
    levels = []  # the coefficients of u^k, by their dead times
    for k in range(TERMS + 2):
        level = {}
        for delay, row in numerator:
            level[delay] = level.get(delay, 0.0) + row[k]
        for delay, row in denominator:
            for q in range(1, k + 1):
                for earlier, c in levels[k - q].items():
                    later = round(delay + earlier, 12)
                    level[later] = level.get(later, 0.0) - row[q] * c
        levels.append({delay: c for delay, c in level.items() if c})
    return levels


def _square_of_expansion(expansion):
    """The integral of the square of the sum of c t^(k-1)/(k-1)! exp(-t), each beginning at its dead time."""
    total = 0.0
    for (one, k), c in expansion.items():
        for (other, n), d in expansion.items():
            (p, q), apart = ((k - 1, n - 1) if one >= other else (n - 1, k - 1)), abs(one - other)
            # the integral of t^p/p! (t + apart)^q/q! exp(-2 t - apart)
            total += c * d * math.exp(-apart) * sum(
                apart ** (q - r) / math.factorial(q - r) * math.comb(p + r, p) / 2 ** (p + r + 1) for r in range(q + 1)
            )  # fmt: skip
    return total
