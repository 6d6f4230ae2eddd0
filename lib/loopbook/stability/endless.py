"""An open loop L = A/B at endless frequency, where the highest powers alone count: sums of numbers with dead times.

As the gain k grows, B + k A gets an endless row of unstable roots where its highest powers alone have one: at a limiting
gain. Below that, they have a certain distance from zero, and beyond a certain frequency the lower powers are smaller.
"""

from __future__ import annotations

import functools
import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING

from loopbook.stability.difference import common_unit, prevailing
from loopbook.stability.loops import Loops, _positive_beyond, _square

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy

MOST_ANGLES = 200_000


class Far:
    """The highest powers of a single loop: b + k a, sums of exp(-delay*s) with `delays` (the first one zero).

    Attributes:
        highest, lowest: the gains next to 1 at which the highest powers get roots in the right half-plane or lose their
            undelayed part; infinite and zero without one.
    """

    def __init__(self, loops: Loops):
        import numpy

        A, B = loops.exact
        self.loops = loops
        rows: dict[Fraction, list[Fraction]] = {Fraction(0): [Fraction(0), Fraction(0)]}
        for k, exact in enumerate((A, B)):
            for delay, part in exact.parts.items():
                if len(part) == exact.order + 1:
                    rows.setdefault(delay, [Fraction(0), Fraction(0)])[k] += Fraction(part[-1], exact.divisor)
        self.rows = dict(sorted(rows.items()))
        self.a, self.b = (numpy.array([float(row[k]) for row in self.rows.values()]) for k in range(2))
        self.delays = numpy.array([float(delay) for delay in self.rows])
        self.unit = common_unit(self.delays[1:].tolist()) if len(self.delays) > 1 else (1.0, [])
        self.powers = numpy.array([0, *(self.unit[1] if self.unit else ())])
        self.lowest, self.highest = self._limits()

    @property
    def vanishes(self) -> bool:
        """Whether L vanishes at endless frequency."""
        return not self.a.any()

    def _limits(self):
        """The limiting gains next to 1."""
        below, above = ([k for k in self.gains if (k > 1) == high] for high in (False, True))
        return max(below, default=0.0), min(above, default=math.inf)

    @functools.cached_property
    def gains(self) -> list[float]:
        """All positive gains at which the highest powers may get roots in the right half-plane, or lose them."""
        return sorted(float(gain) for gain in self._gains() if gain > 0)

    def _gains(self):

        rows = list(self.rows.values())
        (a0, b0), later = rows[0], rows[1:]
        gains = [] if not a0 else [-b0 / a0]
        if self.vanishes:
            return gains
        if len(later) == 1:
            ((a1, b1),) = later
            for sign in (1, -1):
                if slope := a1 - sign * a0:
                    gains.append((sign * b0 - b1) / slope)
        elif later and self.unit:
            gains += [gain for gain, _ in self._on_circle]
        elif later:
            if _related(self.delays[1:]):
                raise ValueError("whether the loop has an end of unstable poles is not decided: its highest powers have "
                                 "dead times of which one is the sum or difference of others")  # fmt: skip
            # a sum of sizes is the largest of all sums with signs
            for signs in itertools.product((-1, 1), repeat=len(later)):
                rise = a0 + sum(sign * a for sign, (a, _) in zip(signs, later, strict=True))
                if rise:
                    gain = -(b0 + sum(sign * b for sign, (_, b) in zip(signs, later, strict=True))) / rise
                    least = abs(b0 + gain * a0) - sum(abs(b + gain * a) for a, b in later)
                    if least == 0:
                        gains.append(gain)
        return gains

    @functools.cached_property
    def _on_circle(self) -> list[tuple[float, float]]:
        """The gains for which b + k a has a root on the unit circle of z = exp(-unit*s), and its angle."""
        import numpy

        size = max(self.powers)
        p, q = numpy.zeros(size + 1), numpy.zeros(size + 1)
        p[self.powers], q[self.powers] = self.a, self.b
        # Im a(z) b(1/z) = 0 on the circle, times a power of z
        both = numpy.convolve(p, q[::-1])
        odd = both - both[::-1]
        roots = numpy.roots(odd[::-1]) if odd.any() else numpy.zeros(0)
        angles = numpy.concatenate([[0, math.pi], numpy.angle(roots[abs(abs(roots) - 1) < 1e-5])])
        z = numpy.exp(1j * angles)
        above, below = numpy.polyval(p[::-1], z), numpy.polyval(q[::-1], z)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            gains = -(below / above)
        return [
            (float(k.real), -float(angle))
            for k, angle in zip(gains, angles, strict=True)
            if numpy.isfinite(k) and abs(k.imag) < 1e-6 * abs(k)
        ]

    # ---- how far the highest powers are from what is asked

    def _least(self, size: Callable, steep: float, without=()) -> float:
        """A lower bound, at least half the minimum, of a function of the angle with a bounded slope; zero without.

        Angles that are as near to some as is said do not count.
        """
        import numpy

        count = 64 * max(1, int(max(self.powers)))
        middle, half = (numpy.arange(count) + 0.5) * (math.pi / count), math.pi / (2 * count)
        least = math.inf
        for _ in range(40):
            for angle, near in without:
                for mirrored in (angle, -angle):
                    apart = abs((middle - mirrored + math.pi) % (2 * math.pi) - math.pi)
                    middle = middle[apart + half > near]
            if not len(middle):
                return least / 2 if least < math.inf else 0.0
            values = size(numpy.exp(-1j * numpy.multiply.outer(self.powers, middle)))
            low = values - steep * half
            least = min(least, float(values.min()))
            open_ = low < least / 2
            if least <= 0 or open_.sum() > MOST_ANGLES:
                return 0.0
            if not open_.any():
                return least / 2
            middle, half = numpy.concatenate([middle[open_] - half / 2, middle[open_] + half / 2]), half / 2
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

    def no_crossing_beyond(self, low: float, high: float) -> float:
        """A frequency beyond which L is not -1/k for any k from low to high; nan where none is known."""
        import numpy

        loops = self.loops
        simple = float(loops.beyond(numpy.array([high]))[0])
        if self.vanishes and simple == simple:
            return simple
        limiting = any(abs(gain / high - 1) < 1e-12 for gain in self.gains)
        if limiting and not math.isnan(limit := float(loops.beyond_limit()[0])):
            simple = float(numpy.fmin(simple, limit))
        lower = self._lower(1.0, high)
        if limiting and not lower.any():
            return 0.0
        end = self._end(lower, self._distance(low, high))
        if math.isnan(end) and limiting and self.unit and len(self.a) > 1:
            end = self._beyond_circle(low, high)
        return float(numpy.fmin(simple, end))

    # ---- close to a limiting gain

    def _beyond_circle(self, low: float, high: float) -> float:
        """A frequency beyond which L is not -1/k for any k from `low` to the limiting gain `high`; nan where none is known.

        With v = 1/w, the gain k = -B/A is an analytic function of v and of the angle w*unit. Where it is real, near an
        angle at which it is the limiting gain for v = 0, its expansion tells whether it is larger for small v.
        """

        angles = [angle for gain, angle in self._on_circle if abs(gain / high - 1) < 1e-9]
        series = self._series()
        if series is None or not angles:
            return math.nan
        apart = 1 / (4 * max(self.powers))
        for halvings in range(12):
            near = apart / 2**halvings
            largest = [_larger_than_limit(series, self.powers, angle, near) for angle in angles]
            if min(largest) > 0:
                distance = self._distance(low, high, [(angle, near) for angle in angles])
                end = self._end(self._lower(1.0, high), distance)
                if not math.isnan(end):
                    return max(end, 1 / min(largest))
        return math.nan

    def _series(self):
        """Coefficients of A and B by powers of v = 1/w and multiples of the unit; None where others have dead times."""
        import numpy

        unit, order = self.unit[0], self.loops.B.order
        both = []
        scaled = unit * float(self.loops.unit[0])
        for sums in (self.loops.A, self.loops.B):
            rows: dict[int, numpy.ndarray] = {}
            for part, delay in zip(sums.coefficients[..., 0], sums.delays[:, 0], strict=True):
                multiple = round(delay / scaled)
                if abs(multiple * scaled - delay) > 1e-13 * delay:
                    return None
                rows[multiple] = rows.get(multiple, 0) + part[::-1] * (-1j) ** numpy.arange(order + 1)
            both.append(rows)
        return both

    def _lower(self, of_B, of_A):
        A, B = (abs(x.coefficients[:, :, 0]).sum(axis=0)[:-1] for x in (self.loops.A, self.loops.B))
        return of_B * B + of_A * A

    def _end(self, lower, reserve):
        import numpy

        if reserve <= 0:
            return math.nan
        if not len(lower):
            return 0.0
        sizes = numpy.concatenate([lower, [reserve]])
        return float(prevailing(sizes[None, :, None])[0])

    @functools.cached_property
    def size(self) -> int:
        """-1 or 1 where abs(L) is below or above 1 at endless frequency, whatever the phases; 0 where it is neither.

        Where it is 1, the next power decides.
        """
        if self.vanishes:
            return -1
        if not math.isnan(self._size_end(1)):
            return -1
        return 1 if not math.isnan(self._size_end(-1)) else 0

    def _size_end(self, sign):
        """A frequency beyond which abs(B) - abs(A), times the sign, is positive."""
        import numpy

        if sign > 0 and (end := float(self.loops.beyond(numpy.ones(1))[0])) == end:
            return end
        a, b = self.a, self.b
        if len(a) == 1 or not self.unit:
            reserve = sign * (abs(b[0]) - abs(a[0])) - abs(a[1:]).sum() - abs(b[1:]).sum()
            if len(a) == 2 and not a[0] and not b[1]:
                reserve = sign * (abs(b[0]) - abs(a[1]))
        else:
            reserve = self._least(
                lambda turns: sign * (abs(b @ turns) - abs(a @ turns)), (abs(a) + abs(b)) @ self.powers
            )
        end = self._end(self._lower(1.0, 1.0), reserve)
        if math.isnan(end) and self.loops._squares is not None:
            a, b = self.loops._squares
            rows = sign * (b - a)
            if abs(rows[-1, 0]) > 1e-12:
                end = float(_positive_beyond(rows)[0])
        return end

    def size_end(self) -> float:
        """A frequency beyond which abs(L) is not 1."""
        return self._size_end(-self.size) if self.size else math.nan

    @functools.cached_property
    def sensitivity(self) -> float:
        """The largest abs(b/(a + b))."""
        import numpy

        if self.vanishes:
            return 1.0
        a, b = self.a, self.b
        if len(a) == 1:
            return abs(b[0] / (a[0] + b[0]))
        if len(a) == 2 and not a[0] and not b[1]:
            return float(abs(b[0]) / (abs(b[0]) - abs(a[1])))
        if not self.unit:
            raise ValueError("the largest sensitivity at ever higher frequencies is not decided: the highest powers have "
                             "dead times that are no multiples of one")  # fmt: skip
        angles = numpy.linspace(0, math.pi, 4096 * int(max(self.powers)) + 1)
        for _ in range(3):
            turns = numpy.exp(-1j * numpy.multiply.outer(self.powers, angles))
            values = abs((b @ turns) / ((a + b) @ turns))
            best, step = angles[values.argmax()], angles[1] - angles[0]
            angles = numpy.linspace(max(0, best - step), min(math.pi, best + step), 2001)
        return float(values.max())

    def no_peak_beyond(self, most: float) -> float:
        """A frequency beyond which abs(B/C) is below `most`."""
        import numpy

        if most <= 1:
            return math.nan
        factor = most / (most - 1)
        simple = float(self.loops.beyond(numpy.array([factor]))[0])
        if self.vanishes:
            return simple
        a, b = self.a, self.b
        if len(a) == 2 and not a[0] and not b[1] and math.isnan(simple) and most >= self.sensitivity:
            simple = float(self.loops.beyond_limit()[0])
        if len(a) == 1:
            reserve = most * abs(a[0] + b[0]) - abs(b[0])
            if self.loops.longest[0] == 0 and self.loops._squares is not None:
                C = _square((self.loops.A.coefficients + self.loops.B.coefficients)[0])
                simple = float(numpy.fmin(simple, _positive_beyond(most**2 * C - self.loops._squares[1])[0]))
        elif not self.unit:
            reserve = 0.0
        else:
            reserve = self._least(
                lambda turns: most * abs((a + b) @ turns) - abs(b @ turns),
                (most * abs(a + b) + abs(b)) @ self.powers,
            )
        return float(numpy.fmin(simple, self._end(self._lower(most + 1, most), reserve)))


def _to_segment(start, step):
    """The distance of 0 from start + t*step, with t from 0 to 1."""
    import numpy

    with numpy.errstate(divide="ignore", invalid="ignore"):
        along = numpy.nan_to_num((-start * step.conj()).real / abs(step) ** 2)
    return abs(start + numpy.clip(along, 0, 1) * step)


def _related(delays: numpy.ndarray) -> bool:
    """Whether dead times, no multiples of one, may have a common multiple in sums with small whole factors."""
    if len(delays) < 3:
        return False
    factors = range(-3, 4)
    return any(
        any(mix) and abs(sum(n * delay for n, delay in zip(mix, delays, strict=True))) < 1e-9 * delays.max()
        for mix in itertools.product(factors, repeat=len(delays))
    )


def _larger_than_limit(series, powers, angle: float, near: float) -> float:
    """The largest v up to which k = -B/A, where it is real and the angle near, is at least what it is at v = 0.

    The terms up to the second order decide, and Cauchy's estimate bounds those of higher order; zero if they do not.
    """
    import numpy

    values, bounds = [], []
    for rows in series:
        terms = numpy.zeros((3, 3), dtype=complex)
        for multiple, row in rows.items():
            turn = numpy.exp(-1j * multiple * angle)
            for i in range(3):
                for j in range(min(3, len(row))):
                    terms[i, j] += row[j] * turn * (-1j * multiple) ** i / math.factorial(i)
        values.append(terms)
    # a polydisc in which A does not vanish
    wide, tall = 2 * near, 1.0
    for _ in range(60):
        bounds = [
            sum(
                abs(row[0]) * (math.exp(abs(multiple) * wide) - 1)
                + math.exp(abs(multiple) * wide) * sum(abs(c) * tall**n for n, c in enumerate(row[1:], 1))
                for multiple, row in rows.items()
            )
            for rows in series
        ]
        size = abs(values[0][0, 0])
        if bounds[0] < size / 2:
            break
        if max(abs(m) for m in series[0]) * wide > 0.2:
            wide /= 2
        tall /= 2
    else:
        return 0.0
    if wide < 2 * near:
        return 0.0
    largest = (abs(values[1][0, 0]) + bounds[1]) / (size - bounds[0])
    # k = -B/A by division of power series in the angle (first index) and v
    k = numpy.zeros((3, 3), dtype=complex)
    A, B = values
    for i in range(3):
        for j in range(3 - i):
            lower = sum(A[i - p, j - q] * k[p, q] for p in range(i + 1) for q in range(j + 1) if (p, q) != (i, j))
            k[i, j] = (-B[i, j] - lower) / A[0, 0]
    across = k[1, 0].imag
    if abs(across) < 1e-9 * abs(k[1, 0]) or not across:
        return 0.0
    symmetric = abs(math.sin(angle)) < 1e-9
    v = tall / 8
    for _ in range(60):
        # the angle differs by -c*v, but for what the terms of higher order make
        x, y = near / wide, v / tall
        rest = {n: largest * sum(x**i * y ** (n - i) for i in range(n + 1)) / ((1 - x) * (1 - y)) for n in (2, 3, 4)}
        c = k[0, 1].imag / across
        steep, error = (rest[3] if symmetric else rest[2]) / abs(across), None
        # the angles that are possible shrink with v
        reach = abs(c) * v + steep
        x = min(x, reach / wide)
        rest = {n: largest * sum(x**i * y ** (n - i) for i in range(n + 1)) / ((1 - x) * (1 - y)) for n in (2, 3, 4)}
        error = (rest[3] if symmetric else rest[2]) / abs(across)
        if symmetric:
            rise = v * v * (k[2, 0] * c * c - k[1, 1] * c + k[0, 2]).real
            doubt = rest[4] + abs(k[2, 0]) * error * (2 * abs(c) * v + error) + abs(k[1, 1]) * error * v
        else:
            rise = v * (k[0, 1].real - k[1, 0].real * c)
            doubt = rest[2] + abs(k[1, 0].real) * error
        if rise > doubt and abs(c) * v + error < near:
            return v
        v /= 2
    return 0.0
