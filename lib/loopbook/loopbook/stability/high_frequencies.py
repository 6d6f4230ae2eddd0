"""An open loop L = A/B at ever higher frequencies, where the highest powers alone count: a/b, numbers with dead times.

As the gain k grows, B + k A gets an infinite row of unstable roots where b + k a has one: at a limiting gain. Below
that, b + k a keeps a distance from zero, and beyond a certain frequency the lower powers are smaller. The closer to
the limiting gain, the higher that frequency: with one dead time it is found from all powers instead. There what is
asked is whether ``P + 2 Re(Q exp(-j w delay))`` is positive, P and Q being polynomials; it is, whatever the phase,
where ``P > 0`` and ``P*P > 4 abs(Q)**2``, and these are polynomials in the square of the frequency.

With several dead times in the highest powers all bounds add up sizes, as if their phases could meet at will. What that
leaves open is not decided, and said to be so.
"""

from __future__ import annotations

import functools
import math
from fractions import Fraction

import numpy as np

from loopbook.stability.difference import prevailing
from loopbook.stability.loops import ENOUGH, Loops, positive_beyond

NEAR = 30.0  # an end of the search, beside the fastest pole, that is not worth being improved


class HighFrequencies:
    """The highest powers of a single loop: b + k a, sums of ``exp(-delay*s)`` with several delays (the first one zero).

    Arguments:
        loops: a single loop, with more digits.
        pivot: the gain next to which limiting gains are wanted, 1 for margins and 0 for an ultimate gain.
    Attributes:
        lowest, highest: the gains next to the pivot at which the highest powers get roots in the right half-plane or
            lose their undelayed part; zero and infinite without one, and where several dead times leave them open.
        is_open: whether they do.
    """

    def __init__(self, loops: Loops, pivot: float = 1.0):
        self.loops = loops
        A, B = loops.exact[:2]
        delays = sorted({Fraction(0), *A.parts, *B.parts})
        rows = [[_highest(exact, delay) for exact in (A, B)] for delay in delays]
        self._rows = [row for row in rows if row is rows[0] or any(row)]
        self._a, self._b = np.array(self._rows, dtype=float).T
        self.vanishes, self.is_open = not self._a.any(), len(self._rows) > 2
        gains = [] if self.vanishes or self.is_open else self._gains()
        self.lowest = max((k for k in gains if k < pivot), default=0.0)
        self.highest = min((k for k in gains if k > pivot), default=math.inf)

    def _gains(self) -> list[float]:
        """Positive gains with which b + k a has roots on the axis, where both sizes are equal, or no undelayed part."""
        (a0, b0), *later = self._rows
        conditions = [(a0, b0)]
        for a1, b1 in later:
            conditions += [(a0 - a1, b0 - b1), (a0 + a1, b0 + b1)]
        return [float(-b / a) for a, b in conditions if a and -b / a > 0]

    @functools.cached_property
    def _parts(self) -> list[np.ndarray] | None:
        """A and B of a loop with one dead time or none: arrays [undelayed or delayed, power]; None with several.

        They are fractions: a limit from which the highest powers do not tell on which side it is approached leaves that
        to the next, which rounding must not hide.
        """
        delays = {delay for exact in self.loops.exact[:2] for delay in exact.parts if delay}
        if len(delays) > 1:
            return None
        return [
            np.array([exact.coefficients(delay) for delay in (Fraction(0), *(delays or [Fraction(1)]))])
            for exact in self.loops.exact[:2]
        ]

    # ---- bounds

    def _least(self, *squares: tuple[float, np.ndarray]) -> float:
        """A lower bound of a sum of squares of sizes of the highest powers, each with a factor."""
        products = sum(factor * np.outer(part, part) for factor, part in squares)
        diagonal = np.diag(products)
        return float(diagonal.sum() - (abs(products).sum() - abs(diagonal).sum()))

    def _prevails_beyond(self, reserve: float, of_A: float, of_B: float) -> float:
        """A frequency beyond which the lower powers of A and B, times these factors, are smaller than the reserve."""
        if not reserve > 0:
            return math.nan
        sizes = (abs(x.coefficients[:, :, 0]).sum(axis=0)[:-1] for x in (self.loops.A, self.loops.B))
        lower = sum(factor * size for factor, size in zip((of_A, of_B), sizes, strict=True))
        return float(prevailing(np.concatenate([lower, [reserve]])[None, :, None])[0]) if lower.any() else 0.0

    # ---- gains

    def no_crossing_beyond(self, low: float, high: float) -> float:
        """A frequency beyond which L is not -1/k for any k from low to high; nan where none is known.

        A limiting gain itself is no such k, nor what is as good as equal to an end.
        """
        end = float(self.loops.beyond(np.array([high]))[0])
        if end < NEAR or (self.vanishes and not math.isnan(end)):
            return end
        distance = min(self._distance(k) for k in (low, high))
        if (self._b[0] + low * self._a[0]) * (self._b[0] + high * self._a[0]) < 0:
            distance = 0.0
        end = np.fmin(end, self._prevails_beyond(distance, high, 1.0))
        if self._parts is None:
            return end
        A, B = self._parts
        low, high = Fraction(low * (1 + ENOUGH)), Fraction(high * (1 - ENOUGH))
        # abs(B0 + k A0)**2 - abs(B1 + k A1)**2, a parabola in k, is positive where these three are (Bernstein)
        conditions = [_difference(B + k * A, B + m * A) for k, m in ((low, low), (low, high), (high, high))]
        return np.fmin(end, np.max([_positive_beyond(row) for row in conditions]))

    def _distance(self, gain: float) -> float:
        """How far 0 is, at least, from b + k a; between two gains the least distance is at one of them.

        It is a straight line less a sum of sizes, as long as the undelayed part keeps its sign.
        """
        undelayed, *later = abs(self._b + gain * self._a)
        return float(undelayed - sum(later))

    # ---- the size of L

    @functools.cached_property
    def size(self) -> int:
        """-1 or 1 where abs(L) is below or above 1 at infinite frequency, whatever the phases; 0 where it is neither.

        Where it is 1, the next power decides.
        """
        if self.vanishes or not math.isnan(self._size_end(1)):
            return -1
        return 1 if not math.isnan(self._size_end(-1)) else 0

    def size_end(self) -> float:
        """A frequency beyond which abs(L) is not 1."""
        return self._size_end(-self.size) if self.size else math.nan

    def _size_end(self, sign: int) -> float:
        """A frequency beyond which abs(B) - abs(A), times the sign, is positive."""
        if sign > 0 and not math.isnan(end := float(self.loops.beyond(np.ones(1))[0])):
            return end
        least = self._least((sign, self._b), (-sign, self._a)) / abs(np.array([self._a, self._b])).sum()
        end = self._prevails_beyond(least, 1.0, 1.0)
        if math.isnan(end) and self._parts is not None:
            A, B = self._parts
            end = _sum_positive_beyond((sign, B), (-sign, A))
        return end

    @property
    def exceeds_one(self) -> bool:
        """Whether abs(L) is certainly above 1 at ever higher frequencies, if not at all of them."""
        if self.size:
            return self.size > 0
        if self.is_open:
            return False
        return any(abs(a) > abs(b) * (1 + 1e-9) for a, b in zip(*map(_extremes, (self._a, self._b)), strict=True))

    # ---- the sensitivity

    @property
    def sensitivity(self) -> float:
        """The largest abs(b/(a + b)), where it is known: with one dead time, at one of the two extremes of the phase.

        Otherwise what it is at least, if it is analytic in the right half-plane: there it is nowhere larger than on the
        axis, and far to the right only what is undelayed is left of it.
        """
        B, C = self._b, self._a + self._b
        if self.is_open:
            return float(abs(B[0] / C[0]))
        return max(abs(b / c) for b, c in zip(_extremes(B), _extremes(C), strict=True))

    def no_peak_beyond(self, most: float) -> float:
        """A frequency beyond which abs(B/C) is below `most`; nan where none is known."""
        end = float(self.loops.beyond(np.array([most / (most - 1)]))[0]) if most > 1 else math.nan
        if end < NEAR or (self.vanishes and not math.isnan(end)):
            return end
        c = self._a + self._b
        least = self._least((most**2, c), (-1.0, self._b)) / (most * abs(c).sum() + abs(self._b).sum())
        end = np.fmin(end, self._prevails_beyond(least, most, most + 1))
        if self._parts is None:
            return end
        A, B = self._parts
        return np.fmin(end, _sum_positive_beyond((Fraction(most) ** 2, A + B), (-1, B)))


def _highest(exact, delay):
    part = exact.parts.get(delay, ())
    return Fraction(part[-1], exact.divisor) if len(part) > exact.order else Fraction(0)


def _extremes(part) -> list[float]:
    """A sum with one dead time where its phase is 0 and where it is a half turn."""
    return [float(part.sum()), float(2 * part[0] - part.sum())]


# ---- polynomials in fractions, of parts [undelayed or delayed, power]


def _product(one, other):
    """conj(X) Y on the imaginary axis, in powers of s."""
    return np.convolve((-1) ** np.arange(len(one)) * one, other)


def _real(product):
    """The real part on the imaginary axis of a polynomial in s, in powers of ``w*w``."""
    return product[::2] * (-1) ** np.arange(len(product[::2]))


def _difference(one, other):
    """Re(conj(X0) Y0 - conj(X1) Y1), in powers of ``w*w``."""
    return _real(_product(one[0], other[0]) - _product(one[1], other[1]))


def _sum_positive_beyond(*squares: tuple[float, np.ndarray]) -> float:
    """A frequency beyond which a sum of squared sizes with factors is positive, whatever the phase of the dead time."""
    P = sum(factor * _real(_product(part[0], part[0]) + _product(part[1], part[1])) for factor, part in squares)
    Q = sum(factor * _product(part[0], part[1]) for factor, part in squares)
    conditions = [P, np.convolve(P, P) - 4 * _real(_product(Q, Q))] if Q.any() else [P]
    return float(np.max([_positive_beyond(row) for row in conditions]))


def _positive_beyond(row: np.ndarray) -> float:
    return float(positive_beyond(row.astype(float)[:, None])[0])
