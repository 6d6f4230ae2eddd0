"""Sums of polynomials with dead times on the imaginary axis: values, bounds of their change, and zeros.

A `Sums` holds many sums of one shape, one for each point of a map or a boundary, and computes all of them at once.
"""

import math
from typing import NamedTuple

from loopbook.stability import counting

ROUNDING = 1e-12  # a sum that is smaller than this share of its terms is zero but for rounding
MOST_INTERVALS = 3_000_000


class Sums:
    """The sums of p(s)*exp(-delay*s): coefficients[part, power, point], lowest power first, and delays[part, point].

    The first part has no dead time.
    """

    __array_ufunc__ = None  # so that an array of factors, one for each point, leaves its multiplication to this class

    def __init__(self, coefficients, delays):
        import numpy

        count = max(coefficients.shape[-1], delays.shape[-1])
        self.coefficients = numpy.broadcast_to(coefficients, (*coefficients.shape[:2], count))
        self.delays = numpy.broadcast_to(delays, (len(delays), count))

    @classmethod
    def exact(cls, parts, order, divisor):
        """One sum ``{delay: Poly}`` over a divisor, as numbers.

        It is divided before, because exact numbers may be too large or too small for floating point.
        """
        import numpy

        rows = [[part.coeff_monomial((n,)) / divisor for n in range(order + 1)] for part in parts.values()]
        return cls(numpy.array(rows, dtype=float)[:, :, None], numpy.array([[float(delay)] for delay in parts]))

    @property
    def order(self):
        return self.coefficients.shape[1] - 1

    @property
    def count(self):
        return self.coefficients.shape[-1]

    # ---- algebra

    def __getitem__(self, points):
        return Sums(self.coefficients[..., points], self.delays[..., points])

    def __rmul__(self, factor):
        return Sums(factor * self.coefficients, self.delays)

    def __add__(self, other):
        """What has the same dead times becomes one part, the undelayed one first, so that terms cancel."""
        import numpy

        order, count = max(self.order, other.order), max(self.count, other.count)
        parts = {(0.0,) * count: numpy.zeros((order + 1, count))}
        for sums in (self, other):
            for part, delay in zip(sums.coefficients, sums.delays, strict=True):
                key = tuple(numpy.broadcast_to(delay, count).tolist())
                total = parts.setdefault(key, numpy.zeros((order + 1, count)))
                total[: len(part)] += part
        return Sums(numpy.stack(list(parts.values())), numpy.array(list(parts)))

    def __sub__(self, other):
        return self + -1 * other

    def __mul__(self, other):
        import numpy

        parts, delays = [], []
        for p, delay in zip(self.coefficients, self.delays, strict=True):
            for q, later in zip(other.coefficients, other.delays, strict=True):
                part = numpy.zeros((len(p) + len(q) - 1, max(self.count, other.count)))
                for n, row in enumerate(p):
                    part[n : n + len(q)] += row * q
                parts.append(part)
                delays.append(delay + later)
        return Sums(numpy.stack(parts), numpy.stack(delays))

    def mirrored(self):
        """The sums with -s in place of s: on the imaginary axis, the conjugate."""
        import numpy

        return Sums((-1.0) ** numpy.arange(self.order + 1)[:, None] * self.coefficients, -self.delays)

    def derivative(self):
        """The derivative with respect to s."""
        import numpy

        lowered = numpy.roll(numpy.arange(self.order + 1)[:, None] * self.coefficients, -1, axis=1)
        return Sums(lowered - self.delays[:, None] * self.coefficients, self.delays)

    def slower(self, unit):
        """The sums divided by unit**order, with time in a unit in which the frequency `unit` is 1."""
        import numpy

        return Sums(
            self.coefficients * unit ** (numpy.arange(self.order + 1) - self.order)[:, None], self.delays * unit
        )

    # ---- on the imaginary axis

    def value(self, points, w):
        """The values of some sums at s = j w, one frequency for each."""
        import numpy

        total = 0
        for part, delay in zip(self.coefficients, self.delays, strict=True):
            # in powers of w alone, which is quicker: the even powers are real, the odd ones imaginary
            square = -w * w
            halves = []
            for powers in (part[0::2], part[1::2]):
                half = 0.0
                for row in powers[::-1]:
                    half = half * square + row[points]
                halves.append(half)
            value = halves[0] + 1j * (w * halves[1])
            total = total + (value * numpy.exp(-1j * (w * delay[points])) if delay.any() else value)
        return total

    def bounds(self, points, w):
        """The sum of the sizes of all terms, and a bound of the derivative, from zero to the frequency w."""
        size, slope = 0.0, 0.0
        for part, delay in zip(self.coefficients, self.delays, strict=True):
            own, own_slope = 0.0, 0.0
            for row in part[::-1]:
                own_slope = own_slope * w + own
                own = own * w + abs(row[points])
            size = size + own
            slope = slope + own_slope + (abs(delay)[points] * own if delay.any() else 0)
        return size, slope


def prevailing(coefficients):
    """A frequency beyond which the highest power of the first part outweighs all other terms; nan without one."""
    import numpy

    sizes = abs(coefficients).sum(axis=0)
    order = len(sizes) - 1
    reserve = 2 * abs(coefficients[0, -1]) - sizes[-1]
    reserve = numpy.where(reserve > 0, reserve, math.nan)
    # Fujiwara's bound: there each lower term is below a half, a quarter, an eighth ... of the highest
    bounds = 2 * (sizes[:-1] / reserve) ** (1 / numpy.arange(order, 0, -1)[:, None])
    end = bounds.max(axis=0) if order else 0 * reserve
    return numpy.where(end == 0, 1.0, end)


class Intervals(NamedTuple):
    """Intervals of frequency from a to b, each of one of the sums, with the values at their ends."""

    which: object
    a: object
    b: object
    at_a: object
    at_b: object

    def halves(self, rest, values):
        """The halves of those intervals that are left."""
        import numpy

        which, a, b, at_a, at_b = (x[..., rest] for x in self)
        middle = (a + b) / 2
        at_middle = values(which, middle)
        joined = ((which, which), (a, middle), (middle, b), (at_a, at_middle), (at_middle, at_b))
        return Intervals(*(numpy.concatenate(pair, axis=-1) for pair in joined))


def refined(values, which, start, end, undecided, most=MOST_INTERVALS):
    """Walk from `start` to `end`, halving the intervals that `undecided` marks until there are none.

    Arguments:
        values: function of points and frequencies, whose values at the ends of the intervals are handed on.
        undecided: function of `Intervals`; it says which are to be halved, and takes what it wants from the others.
    """
    intervals = Intervals(which, start, end, values(which, start), values(which, end))
    while len(intervals.which):
        rest = undecided(intervals)
        if (most := most - rest.sum()) < 0:
            raise ValueError(
                "the frequency response is not resolved: its dead times are too long beside its lags, or several "
                "resonances with hardly any damping lie at one frequency"
            )
        intervals = intervals.halves(rest, values)


def axis_zeros(sums, turn, start, end):
    """Where the real part of turn*sum is zero on the imaginary axis: points and frequencies from `start` to `end`.

    An interval is done where bounds prove that it has no zero, or that the derivative has none; down to places where
    both vanish, which count as one zero.
    """
    import numpy

    derivative = sums.derivative()
    brackets, touching = [], []

    def values(which, w):
        return numpy.array([(turn * sums.value(which, w)).real, (1j * turn * derivative.value(which, w)).real])

    def undecided(intervals):
        which, a, b, at_a, at_b = intervals
        size, slope = sums.bounds(which, b)
        bend = derivative.bounds(which, b)[1]
        away, steady = abs(at_a) + abs(at_b) > (b - a) * numpy.array([slope, bend]) + 1e-15 * numpy.array([size, slope])
        rising = at_a[0] < 0
        crossing = ~away & steady & (rising != (at_b[0] < 0))
        brackets.append((which[crossing], a[crossing], b[crossing], rising[crossing]))
        small = ~away & ~steady & (b - a < 1e-9 * b)
        touching.append((which[small], (a + b)[small] / 2))
        return ~away & ~steady & ~small & (b > 1e-9 * end[which])

    which = numpy.flatnonzero((end > start) & sums.coefficients.any(axis=(0, 1)))
    if not len(which):
        return which, numpy.zeros(0)
    refined(values, which, start[which], end[which], undecided)
    which, a, b, rising = (numpy.concatenate(x) for x in zip(*brackets, strict=True))
    w = _newton(values, which, a, b, rising)
    return tuple(numpy.concatenate(x) for x in zip(*touching, (which, w), strict=True))


def _newton(values, which, a, b, rising):
    """The zeros between a and b of functions that rise there, or fall: Newton's steps, halves where they lead out."""
    import numpy

    w, moving = (a + b) / 2, numpy.arange(len(which))
    for _ in range(100):
        if not len(moving):
            break
        value, rise = values(which[moving], w[moving])
        before = (value < 0) == rising[moving]
        a[moving] = numpy.where(before, w[moving], a[moving])
        b[moving] = numpy.where(before, b[moving], w[moving])
        with numpy.errstate(divide="ignore", invalid="ignore"):
            better = w[moving] - value / rise
        outside = ~((better > a[moving]) & (better < b[moving]))
        better[outside] = ((a + b) / 2)[moving][outside]
        change = abs(better - w[moving])
        w[moving] = better
        moving = moving[change > 1e-15 * better]
    return w


def fraction_sums(L):
    return tuple(Sums(x.coefficients, x.delays) for x in counting.fraction_sums(L))
