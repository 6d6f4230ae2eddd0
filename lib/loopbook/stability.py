"""Stability of a feedback loop with dead time, without approximation.

A closed loop with dead times has infinitely many poles, the roots of a sum of polynomials in `s` with exp(-delay*s).
Two methods count those in the right half-plane, and both are exact.

- One dead time, D(s) + N(s) exp(-delay*s): the roots enter the right half-plane only across the imaginary axis, at
  frequencies where abs(D) = abs(N), and these are roots of a polynomial. (K. Walton and J. E. Marshall, IEE Proceedings
  D 134, 1987)
- Several dead times: the argument principle, with a bound that proves that no turn of the phase was missed.
"""

import itertools
import math
import time
from fractions import Fraction
from typing import NamedTuple

import mpmath
import sympy

from loopbook.deadtime import Loop, normal_form, transfer_function
from loopbook.expressions import s
from loopbook.laplace import by_delay
from loopbook.transfer import polynomials

__all__ = [
    "DelayRatios", "Margins", "StabilityLimitError", "boundary_pi", "boundary_pi_approximate", "boundary_pid",
    "delay_margin", "is_stable", "margins", "robust_in_window", "robustness", "robustness_pi_first_order",
    "shinskey_window", "stability_map", "ultimate", "unstable_poles", "unstable_roots",
]  # fmt: skip

CLOSE = 1e-9
ON_AXIS = 1e-12  # a sum that is smaller than this share of its terms is zero but for rounding
ON_LIMIT, ENDLESS = -1, 10**9  # in place of a number of roots
MOST_INTERVALS = 3_000_000
MOST_TURNS = 400  # of the phase by dead time in which a limiting gain is looked for
LARGEST_GAIN = 1e6
CHUNK = 2000  # points of a map at once


class StabilityLimitError(ValueError):
    """The closed loop has poles on the imaginary axis: it is neither stable nor unstable."""


# ------------------------------------------------------------------------------------------------ counting


def unstable_poles(loop):
    """Return the number of closed-loop poles in the right half-plane, for negative feedback around a loop.

    A pole that controller and process cancel in the open loop cannot be seen there: if it is unstable, the loop is, and
    the caller has to know. With `deadtime.Loop` as the argument the same holds, because its open loop is what counts.

    Arguments:
        loop: the transfer function L(s) of the open loop, an expression with numbers, a `System` or a `Loop`. Dead
            times may stand anywhere. It may have as many zeros as poles, but no more.
    Returns:
        An integer; ``math.inf`` where the loop's gain at high frequencies returns with a dead time and is above 1.
    Raises:
        StabilityLimitError: for closed-loop poles on the imaginary axis.
        ValueError: for letters, zero, an improper loop, an algebraic loop without solution, or as `unstable_roots`.

    >>> unstable_poles(sympy.exp(-s) / s), unstable_poles(2 * sympy.exp(-s) / s)
    (0, 2)
    >>> unstable_poles(2 * sympy.exp(-s) / s + sympy.exp(-3 * s) / (s + 1))
    2
    """
    L = _open_loop(loop)
    if (single := _one_dead_time(L)) is None:
        try:
            return unstable_roots(_characteristic(L))
        except StabilityLimitError:
            raise StabilityLimitError(f"the closed loop of {L} has poles on the imaginary axis") from None
    N, D, delay = single
    limit = StabilityLimitError(f"the closed loop of {L} has poles on the imaginary axis")
    count, on_axis = 0, []
    for p, n in _roots(D + N):
        if abs(sympy.re(p)) <= 1e-15 * abs(p):
            on_axis.append(p)
        elif sympy.re(p) > 0:
            count += n
    if on_axis and (not delay or 0 in on_axis):
        raise limit
    for crossing, period, direction in _crossings(N, D):
        turns = (float(delay) - crossing) / period
        if delay and turns > -CLOSE and abs(turns - round(turns)) < CLOSE:
            raise limit
        # A pair of poles crosses at this dead time, and again with each full turn more. One that lies on the axis
        # without dead time has not been counted yet, so that it only counts where it goes to the right.
        times = 0 if turns < 0 else math.floor(turns) + 1
        count += 2 * direction * times + (2 if times and crossing == 0 and direction < 0 else 0)
    return count


def unstable_roots(denominator):
    """Return the number of roots in the right half-plane of a sum of polynomials with dead times.

    The argument principle counts them, by the phase of the sum along the imaginary axis. Between two frequencies the
    phase is believed only where a bound of the derivative proves that the sum has no zero there; otherwise the interval
    is halved. Beyond a certain frequency the highest power prevails, also by a bound.

    Arguments:
        denominator: ``{delay: polynomial in s}`` with numbers, as `deadtime.System` and `deadtime.normal_form` have it.
    Returns:
        An integer; ``math.inf`` where the highest power returns with dead times so strongly that there is no end of
        roots.
    Raises:
        StabilityLimitError: for roots on the imaginary axis, or so close to it that rounding would decide.
        ValueError: for letters, a sum that is zero, or one whose highest powers leave open whether it has an end of
            roots: where they have several dead times, and the sizes of their coefficients add up to that of the
            undelayed one or more.
    Source: the criterion of A. V. Mikhailov (1938), extended to dead times.

    >>> from loopbook.deadtime import System
    >>> unstable_roots(System(1 / (s + 2 * sympy.exp(-s) + sympy.exp(-sympy.sqrt(2) * s))).denominator)
    2
    """
    parts = {delay: sympy.Poly(part, s) for delay, part in denominator.items() if part != 0}
    if letters := sorted({str(x) for d, part in parts.items() for x in (d + part.as_expr()).free_symbols - {s}}):
        raise ValueError(f"give a number for {', '.join(letters)} in {_written(parts)}")
    if not parts or 0 not in parts or any(delay < 0 for delay in parts):
        raise ValueError(f"the sum is {_written(parts)}: expected a part without dead time, and later ones")
    order = max(part.degree() for part in parts.values())
    first = parts[0].coeff_monomial(s**order)
    if first == 0:
        return math.inf
    count = int(_counts(*_arrays(parts))[0])
    if count == ON_LIMIT:
        raise StabilityLimitError(
            f"{_written(parts)} has roots on the imaginary axis, or an endless row that approaches it"
        )
    return math.inf if count == ENDLESS else count


def _written(parts):
    return sympy.Add(*(part.as_expr() * sympy.exp(-delay * s) for delay, part in parts.items()))


def _open_loop(loop):
    """The open loop L(s) of whatever stands for it, with the errors that all questions share."""
    L = loop.open if isinstance(loop, Loop) else transfer_function(loop)
    if letters := sorted(map(str, L.free_symbols - {s})):
        raise ValueError(f"give a number for {', '.join(letters)} in {L}")
    if L.has(sympy.I):
        raise ValueError(f"{L} is complex: expected real coefficients")
    if L == 0:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    return L


def _one_dead_time(L):
    """The polynomials N, D and the dead time of a strictly proper loop with one dead time; None of another."""
    try:
        parts = by_delay(L)
    except ValueError:
        return None
    if len(parts) != 1:
        return None
    numerator, denominator = sympy.cancel(next(iter(parts.values()))).as_numer_denom()
    return polynomials(L) if sympy.degree(numerator, s) < sympy.degree(denominator, s) else None


def _fraction(L):
    """Numerator and denominator of L, sums with dead times, for a loop that is proper."""
    above, below = normal_form(L)
    if not above:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    order = below[0].degree()
    for part in (*above.values(), *below.values()):
        if part.degree() > order:
            raise ValueError(
                f"{L} is improper: it has s**{part.degree()} over s**{order}; expected no more zeros than poles"
            )
    return above, below


def _characteristic(L):
    """The sum whose roots are the poles of the closed loop of L."""
    above, below = _fraction(L)
    parts = dict(below)
    for delay, part in above.items():
        parts[delay] = parts.get(delay, 0) + part
    order = below[0].degree()
    if 0 not in parts or parts[0].degree() < order:
        raise ValueError(f"the algebraic loop of {L} has no solution: its gain at infinite frequency is -1")
    return parts


# ---- many sums at once: coefficients[part, power, point] and delays[part, point]


def _arrays(parts, order=None, divisor=None):
    """Coefficients, lowest power first, and delays of a sum, as a family of one point."""
    import numpy

    order = max(part.degree() for part in parts.values()) if order is None else order
    divisor = parts[0].LC() if divisor is None else divisor
    # divided as exact numbers, which may be too large or small for floating point
    rows = [[part.coeff_monomial(s**n) / divisor for n in range(order + 1)] for part in parts.values()]
    return numpy.array(rows, dtype=float)[:, :, None], numpy.array([float(delay) for delay in parts])[:, None]


class _Sums:
    """Sums of polynomials with dead times on the imaginary axis, and bounds of how they change between frequencies."""

    def __init__(self, coefficients, delays):
        self.coefficients, self.delays = coefficients, delays
        self.sizes = abs(coefficients)

    def value(self, points, w):
        """The values at s = j w."""
        import numpy

        total = 0
        for part, delay in zip(self.coefficients, self.delays, strict=True):
            # with powers of w alone: the even powers are real, the odd ones imaginary
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
        for part, delay in zip(self.sizes, self.delays, strict=True):
            own, own_slope = 0.0, 0.0
            for row in part[::-1]:
                own_slope = own_slope * w + own
                own = own * w + row[points]
            size = size + own
            slope = slope + own_slope + (abs(delay)[points] * own if delay.any() else 0)
        return size, slope

    def derivative(self):
        """The derivative with respect to s."""
        import numpy

        powers = numpy.arange(self.coefficients.shape[1])[:, None]
        raised = numpy.roll(self.coefficients * powers, -1, axis=1)
        return _Sums(raised - self.delays[:, None] * self.coefficients, self.delays)


def _prevailing(coefficients):
    """A frequency beyond which the highest power of the undelayed part prevails; nan where there is none."""
    import numpy

    sizes = abs(coefficients).sum(axis=0)
    order = len(sizes) - 1
    reserve = 2 * abs(coefficients[0, -1]) - sizes[-1]
    reserve = numpy.where(reserve > 0, reserve, math.nan)
    # Fujiwara's bound: there each lower term is below a half, a quarter, an eighth ... of the highest
    bounds = 2 * (sizes[:-1] / reserve) ** (1 / numpy.arange(order, 0, -1)[:, None])
    end = bounds.max(axis=0) if order else 0 * reserve
    return numpy.where(end == 0, 1.0, end)


def _slower(coefficients, delays, end):
    """The sums divided by end**order, in a unit of time in which the frequency `end` is 1."""
    import numpy

    order = coefficients.shape[1] - 1
    return coefficients * end ** (numpy.arange(order + 1) - order)[:, None], delays * end


def _counts(coefficients, delays):
    """The number of roots in the right half-plane of many sums; ON_LIMIT with some on the axis, ENDLESS without end."""
    import numpy

    coefficients, delays = numpy.array(coefficients), numpy.array(delays)
    order, count = coefficients.shape[1] - 1, coefficients.shape[2]
    for part, delay in zip(coefficients[1:], delays[1:], strict=True):  # what has no dead time at some points
        coefficients[0] += numpy.where(delay == 0, part, 0)
        part[:, delay == 0] = 0
    counts = numpy.zeros(count, dtype=int)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        returning = abs(coefficients[1:, -1] / coefficients[0, -1])
    counts[coefficients[0, -1] == 0] = ENDLESS
    for point in numpy.flatnonzero(~(returning.sum(axis=0) < 1) & (counts == 0)):
        later = coefficients[1:, -1, point] / coefficients[0, -1, point]
        counts[point] = _endless(later[later != 0], delays[1:, point][later != 0])
    points = numpy.flatnonzero(counts == 0)
    if not len(points):
        return counts
    coefficients = coefficients[:, :, points] / coefficients[0, -1, points]
    coefficients, delays = _slower(coefficients, delays[:, points], _prevailing(coefficients))
    sums, longest = _Sums(coefficients, delays), delays.max(axis=0)
    phase, limit = numpy.zeros(len(points)), numpy.zeros(len(points), dtype=bool)

    def on_axis(which, values, w, size):
        limit[which[abs(values) <= (ON_AXIS + 4e-16 * w * longest[which]) * size]] = True

    which = numpy.arange(len(points))
    a, b = numpy.zeros(len(points)), numpy.ones(len(points))
    at_a, at_b = sums.value(which, a), sums.value(which, b)
    on_axis(which, at_a, a, sums.bounds(which, a)[0])
    at_end = at_b * (-1j) ** order
    allowed = MOST_INTERVALS + 3000 * len(points)
    while len(which):
        size, slope = sums.bounds(which, b)
        on_axis(which, at_b, b, size)
        # a zero in between would need more change than the bound of the derivative allows
        proven = abs(at_a) + abs(at_b) > (b - a) * slope + ON_AXIS * size
        turns = numpy.angle(at_b[proven] * at_a[proven].conj())
        phase += numpy.bincount(which[proven], weights=turns, minlength=len(points))
        rest = ~proven & ~limit[which]
        allowed = _allowed(allowed, rest)
        which, a, b, at_a, at_b = _halved(rest, which, a, b, at_a, at_b, sums.value)
    found = order / 2 - (phase - numpy.angle(at_end)) / math.pi
    counts[points] = numpy.where(limit, ON_LIMIT, numpy.rint(found))
    return counts


def _halved(rest, which, a, b, at_a, at_b, values):
    """The halves of those intervals that are left, with the values at their ends."""
    import numpy

    which, a, b, at_a, at_b = (x[..., rest] for x in (which, a, b, at_a, at_b))
    middle = (a + b) / 2
    at_middle = values(which, middle)
    joined = ((which, which), (a, middle), (middle, b), (at_a, at_middle), (at_middle, at_b))
    return tuple(numpy.concatenate(pair, axis=-1) for pair in joined)


def _allowed(allowed, rest):
    """How many intervals may still be halved after this."""
    if (allowed := allowed - rest.sum()) < 0:
        raise ValueError("the frequency response is not resolved: its dead times are too long beside its lags")
    return allowed


def _endless(later, delays):
    """ENDLESS or ON_LIMIT where 1 + sum(later*exp(-delays*s)) has roots in the right half-plane or on the axis."""
    import numpy

    # with dead times that are multiples of one, these are roots of a polynomial in exp(unit*s)
    ratios = [Fraction(float(delay / delays[0])).limit_denominator(1000) for delay in delays]
    unit = Fraction(math.gcd(*(r.numerator for r in ratios)), math.lcm(*(r.denominator for r in ratios)))
    powers = [int(ratio / unit) for ratio in ratios]
    if max(powers) <= 100 and all(
        abs(r * delays[0] / delay - 1) < 1e-14 for r, delay in zip(ratios, delays, strict=True)
    ):
        polynomial = numpy.zeros(max(powers) + 1)
        polynomial[0] = 1
        numpy.add.at(polynomial, powers, later)
        if abs(numpy.roots(polynomial)).max() > 1 + CLOSE:
            return ENDLESS
        if len(later) == 1:
            return ON_LIMIT
    raise ValueError(
        f"whether there is an end of unstable roots is not decided: the highest power returns with the coefficients "
        f"{', '.join(f'{c:g}' for c in later)}, whose sizes add up to 1 or more, and with the dead times "
        f"{', '.join(f'{delay:g}' for delay in delays)}"
    )


# ---- where a sum is real, or two are of equal size


def _product(one, other):
    """The product of two families of sums."""
    import numpy

    (first, first_delays), (second, second_delays) = one, other
    parts, delays = [], []
    for p, delay in zip(first, first_delays, strict=True):
        for q, later in zip(second, second_delays, strict=True):
            part = numpy.zeros((len(p) + len(q) - 1, max(p.shape[-1], q.shape[-1])))
            for n, row in enumerate(p):
                part[n : n + len(q)] += row * q
            parts.append(part)
            delays.append(delay + later)
    return numpy.stack(parts), numpy.stack(delays)


def _mirrored(sums):
    """The sums with -s in place of s: on the imaginary axis, the conjugate."""
    coefficients, delays = sums
    signs = [(-1) ** n for n in range(coefficients.shape[1])]
    return (coefficients.swapaxes(1, 2) * signs).swapaxes(1, 2), -delays


def _together(*families):
    """The sum of families; what has one dead time is one part, the undelayed one first, so that terms cancel."""
    import numpy

    order = max(coefficients.shape[1] for coefficients, _ in families)
    count = max(coefficients.shape[-1] for coefficients, _ in families)
    parts = {(0.0,) * count: numpy.zeros((order, count))}
    for coefficients, delays in families:
        for part, delay in zip(coefficients, delays, strict=True):
            key = tuple(numpy.broadcast_to(delay, count).tolist())
            parts[key] = parts.get(key, 0) + numpy.pad(part, ((0, order - len(part)), (0, 0)))
    return numpy.stack([part + numpy.zeros(count) for part in parts.values()]), numpy.array(list(parts))


def _times(factor, sums):
    return factor * sums[0], sums[1]


def _axis_zeros(sums, turn, start, end):
    """Where the real part of turn*sum is zero on the imaginary axis: points and frequencies from `start` to `end`.

    An interval is done where bounds prove that it has no zero, or that the derivative has none; it is halved otherwise,
    down to places where both vanish, which count as one zero.
    """
    import numpy

    sums = _Sums(*sums)
    derivative = sums.derivative()

    def values(which, w):
        return numpy.array([(turn * sums.value(which, w)).real, (1j * turn * derivative.value(which, w)).real])

    which = numpy.flatnonzero((end > start) & sums.sizes.any(axis=(0, 1)))
    a, b = start[which], end[which]
    at_a, at_b = values(which, a), values(which, b)
    brackets, touching = [], []
    allowed = MOST_INTERVALS
    while True:
        size, slope = sums.bounds(which, b)
        bend = derivative.bounds(which, b)[1]
        away, steady = abs(at_a) + abs(at_b) > (b - a) * numpy.array([slope, bend]) + 1e-15 * numpy.array([size, slope])
        rising = at_a[0] < 0
        crossing = ~away & steady & (rising != (at_b[0] < 0))
        brackets.append((which[crossing], a[crossing], b[crossing], rising[crossing]))
        small = ~away & ~steady & (b - a < 1e-9 * b)
        touching.append((which[small], (a + b)[small] / 2))
        rest = ~away & ~steady & ~small & (b > 1e-9 * end[which])
        if not rest.any():
            break
        allowed = _allowed(allowed, rest)
        which, a, b, at_a, at_b = _halved(rest, which, a, b, at_a, at_b, values)
    which, a, b, rising = (numpy.concatenate(x) for x in zip(*brackets, strict=True))
    w, moving = (a + b) / 2, numpy.arange(len(which))
    for _ in range(100):  # Newton's steps, and halves where they lead outside
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
        if not len(moving):
            break
    return tuple(numpy.concatenate(x) for x in zip(*touching, (which, w), strict=True))


# ------------------------------------------------------------------------------------------------ questions


class Margins(NamedTuple):
    """How far a stable loop is from the limit of stability: what `margins` returns.

    Attributes:
        gain_margin: the factor by which the gain may grow; infinite where it may grow without end.
        gain_reduction: the factor to which the gain may fall; 0 where it may fall without end.
        phase_margin: the angle by which the phase may turn, either way, in degrees.
        delay_margin: the additional dead time, in the unit of the lags.
        Ms: the largest value of abs(1/(1 + L)) at any frequency; 1/Ms is the distance of L from -1.
        omega_180, omega_c, omega_ms: the frequencies of gain margin, phase margin and Ms, in radians for one unit of
            time; nan where a margin is infinite, inf where Ms is that of ever higher frequencies.
    """

    gain_margin: float
    gain_reduction: float
    phase_margin: float
    delay_margin: float
    Ms: float
    omega_180: float
    omega_c: float
    omega_ms: float


class DelayRatios(NamedTuple):
    """The delay ratios for which a loop is stable: what `robustness` returns.

    Attributes:
        lower, upper: the ends of the region that holds the delay ratio 1, or else of the one nearest to it; arrays
            like the gain ratios, or numbers. Both are nan where there is none, and `upper` is infinite where no dead
            time is too long.
        regions: for each gain ratio the list of all regions, as (lower, upper).
    """

    lower: object
    upper: object
    regions: list


def is_stable(loop):
    """Say whether the closed loop of L(s), with negative feedback, is stable; one on the limit is not.

    Raises ValueError as `unstable_poles` does, but not for a loop on the limit.

    >>> is_stable(sympy.exp(-s) / s), is_stable(2 * sympy.exp(-s) / s)
    (True, False)
    """
    try:
        return unstable_poles(loop) == 0
    except StabilityLimitError:
        return False


def delay_margin(loop):
    """Return the additional dead time in the loop that brings a stable closed loop to the limit of stability.

    Arguments:
        loop: the open loop L(s), as for `unstable_poles`.
    Returns:
        The additional dead time, in the unit of the lags; infinite where none makes the loop unstable.
    Raises:
        ValueError: if the loop is not stable to begin with, or as `unstable_poles`.

    >>> round(delay_margin(sympy.exp(-s) / s), 4)    # pi/2 in all
    0.5708
    """
    above, below = _stable_loop(loop)
    w, turned, fading = _gain_crossings(above, below)
    return _delay_margin(w, turned, fading)


def margins(loop):
    """Return gain margin, phase margin, delay margin and Ms of a stable loop, with any dead times, as `Margins`.

    All crossings are found, by bounds that exclude others, and of several the nearest one counts.

    Arguments:
        loop: the open loop L(s), as for `unstable_poles`.
    Raises:
        ValueError: if the closed loop is not stable, or as `unstable_poles`.
    Source: Haugen, Section 7.5 and Example 10.2, of gain and phase margin.

    >>> found = margins(sympy.exp(-s) / (2 * s))
    >>> round(found.gain_margin, 4), round(found.phase_margin, 4), round(found.delay_margin, 4)
    (3.1416, 61.3521, 2.1416)
    """
    import numpy

    above, below = _stable_loop(loop)
    gain_margin, gain_reduction, omega_180 = math.inf, 0.0, math.nan
    for _, gains, frequencies, top, endless in _limiting_gains(above, below):
        higher, lower = gains > 1, gains < 1
        gain_reduction = float(gains[lower].max(initial=0.0))
        if higher.any() and gains[higher].min() <= top[0]:
            nearest = gains[higher].argmin()
            gain_margin, omega_180 = float(gains[higher][nearest]), float(frequencies[higher][nearest])
            break
        if top[0] == endless[0] < math.inf:
            gain_margin, omega_180 = float(endless[0]), math.inf
            break
        if top[0] > LARGEST_GAIN:
            break
    w, turned, fading = _gain_crossings(above, below)
    either_way = numpy.minimum(turned, 2 * math.pi - turned)
    phase_margin, omega_c = math.inf, math.nan
    if len(w):
        nearest = either_way.argmin()
        phase_margin, omega_c = float(math.degrees(either_way[nearest])), float(w[nearest])
    Ms, omega_ms = _largest_sensitivity(above, below)
    return Margins(
        gain_margin, gain_reduction, phase_margin, _delay_margin(w, turned, fading), Ms, omega_180, omega_c, omega_ms
    )


def ultimate(process):
    """Return the ultimate gain Ku and the ultimate period Pu: with the gain Ku the loop oscillates with that period.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere. Of a loop with a controller in it, Ku is
            the factor by which its gain may grow.
    Returns:
        The floats ``(Ku, Pu)``, Pu in the unit of the lags. Ku is the upper end of the lowest range of gains for which
        the closed loop is stable; infinite, with Pu zero, where no gain makes it unstable.
    Raises:
        ValueError: if no positive gain makes the closed loop stable, or as `unstable_poles`.

    >>> Ku, Pu = ultimate(sympy.exp(-s) / s)
    >>> round(Ku, 4), round(Pu, 4)    # pi/2 and 4
    (1.5708, 4.0)
    """
    L = _open_loop(process)
    above, below = _families(L)
    gain, frequency = (float(found[0]) for found in _stable_range(above, below))
    if math.isnan(gain):
        other = _stable_range(_times(-1, above), below)[0][0]
        hint = "" if math.isnan(other) else ", but a negative one does"
        raise ValueError(f"no positive gain makes the closed loop of {L} stable{hint}")
    return gain, 2 * math.pi / frequency if frequency else math.inf


# ---- maps and boundaries


def boundary_pi(process, Ti):
    """Return the gain Kp on the limit of stability for PI control, Kp*(1 + 1/(Ti*s)), of any process.

    Of a first-order lag with dead time, the limit solves equations (4) and (5) of the source, here without their
    approximation.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere.
        Ti: integral time in the unit of the lags, a number or an array; ``math.inf`` is not among them.
    Returns:
        Kp, a number or an array: the upper end of the lowest range of positive gains with a stable loop; infinite where
        no gain is too high, nan where no positive one makes the loop stable.
    Raises:
        ValueError: for an integral time that is not positive and finite, or as `ultimate`.
    Source: Syder, Heeg and O'Dwyer, equations (4) and (5), Figure 1.

    >>> boundary_pi(2 * sympy.exp(-1.4 * s) / (0.7 * s + 1), [1, 2]).round(4)
    array([0.5183, 0.671 ])
    """
    return boundary_pid(process, Ti, 0)


def boundary_pid(process, Ti, Td, Tf=0):
    """Return the gain Kp on the limit of stability for PID control, Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1)).

    Arguments:
        process: as for `boundary_pi`.
        Ti, Td, Tf: integral time, derivative time and lag of its filter, in the unit of the lags, numbers or arrays
            that fit together.
    Returns:
        Kp, as `boundary_pi`.
    Raises:
        ValueError: for times that are negative or infinite, Ti = 0, or a loop that is improper without filter.

    >>> round(boundary_pid(sympy.exp(-s) / (s + 1), Ti=2, Td=0.5, Tf=0.05), 4)
    1.7547
    """
    import numpy

    try:
        Ti, Td, Tf = numpy.broadcast_arrays(*(numpy.asarray(x, dtype=float) for x in (Ti, Td, Tf)))
    except (TypeError, ValueError):
        raise ValueError(f"Ti, Td and Tf are {Ti!r}, {Td!r} and {Tf!r}: expected numbers, or arrays that fit") from None
    for name, times in (("Ti", Ti), ("Td", Td), ("Tf", Tf)):
        if wrong := [x for x in times.flat if not 0 <= x < math.inf or (x == 0 and name == "Ti")]:
            raise ValueError(f"{name} is {wrong[0]:g}: expected a {'positive' if name == 'Ti' else 'finite'} time")
    L = _open_loop(process)
    process = _families(L)
    i, d, f = 1 / Ti.ravel(), Td.ravel(), Tf.ravel()
    found = numpy.empty(Ti.size)
    # PI, and PID without and with filter, are loops of different order
    kinds = numpy.where(d > 0, numpy.where(f > 0, 2, 1), 0)
    for kind in set(kinds.tolist()):
        points = kinds == kind
        i_, d_, f_ = i[points], d[points], f[points]
        one, nil = numpy.ones(len(i_)), numpy.zeros(len(i_))
        controller = (
            ([i_, one], [nil, one]),
            ([i_, one, d_], [nil, one]),
            ([i_, one + i_ * f_, f_ + d_], [nil, one, f_]),
        )[kind]
        above, below = (
            _product(part, (numpy.array([rows]), numpy.zeros((1, len(i_)))))
            for part, rows in zip(process, controller, strict=True)
        )
        order = below[0].shape[1]
        if above[0][:, order:].any():
            raise ValueError(f"PID control of {L} without filter is improper: expected a lag Tf that is positive")
        rest = max(0, order - above[0].shape[1])
        above = numpy.pad(above[0][:, :order], ((0, 0), (0, rest), (0, 0))), above[1]
        found[points] = _stable_range(above, below)[0]
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)


def boundary_pi_approximate(T, delay, Ti, K=1):
    """Return the gain Kp on the limit of stability for PI control of a lag with dead time, as the source approximates.

    The difference of two arc tangents in equation (5) is one, of x = w*(Ti - T)/(1 + w**2*T*Ti). Where abs(x) <= 1 it
    is replaced by pi/4*x, which makes (5) the cubic equation (6); elsewhere by pi/2 - pi/(4*x), which makes it the
    quadratic equation (7). A root counts where it is positive and its x lies in the branch from which it came. Of
    several the lowest frequency is taken, as in the exact problem.

    The second branch is printed for x > 1 alone: for x < -1 it would need -pi/2. As abs(x) is never above
    abs(Ti - T)/(2*sqrt(Ti*T)), it is needed only for Ti > 5.8 T, and the other one for Ti < 0.17 T. There, and wherever
    no root lies in its branch, the result is nan.

    Arguments:
        T, delay: lag and dead time of the process, positive.
        Ti: integral time, in the same unit; a number or an array.
        K: gain of the process, positive.
    Returns:
        Kp, a number or an array.
    Raises:
        ValueError: for numbers that are not positive.
    Source: Syder, Heeg and O'Dwyer, equations (4), (6) and (7).

    >>> round(boundary_pi_approximate(0.7, 1.4, 1, K=2), 4)    # without approximation 0.5183
    0.5094
    """
    import numpy

    Ti = numpy.asarray(Ti, dtype=float)
    for name, value in (("T", T), ("delay", delay), ("K", K), ("Ti", Ti)):
        if not (numpy.asarray(value, dtype=float) > 0).all():
            raise ValueError(f"{name} is {value}: expected a positive number")
    T, delay, K = float(T), float(delay), float(K)
    found = numpy.full(Ti.size, math.nan)
    for number, I in enumerate(Ti.flat):
        cubic = [4 * delay * I * T / math.pi, -2 * I * T, (4 * delay - math.pi * I + math.pi * T) / math.pi, -2]
        quadratic = [delay * (I - T) + math.pi / 4 * I * T, -math.pi * (I - T), math.pi / 4]
        valid = []
        for equation, outer in ((cubic, False), (quadratic, True)):
            for root in numpy.roots(equation):
                w = root.real
                x = w * (I - T) / (1 + w**2 * I * T)
                if abs(root.imag) <= 1e-9 * abs(root) and w > 0 and (x > 1 if outer else abs(x) <= 1):
                    valid.append(w)
        if valid:
            w = min(valid)
            found[number] = I * w / K * math.sqrt((1 + (w * T) ** 2) / (1 + (w * I) ** 2))
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)


def robustness(process, controller, gain_ratio):
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

    >>> from loopbook.pid import PID
    >>> ratios = robustness(2 * sympy.exp(-s) / (4 * s + 1), PID(1, Ti=4), [1, 2])
    >>> ratios.upper.round(4)    # pi over the gain ratio
    array([3.1416, 1.5708])
    """
    import numpy

    gains = _gain_ratios(gain_ratio)
    rational, delay = _with_one_dead_time(process)
    above, below = _families(transfer_function(controller) * rational)
    above = above[0] * gains.ravel(), above[1] + 0 * gains.ravel()
    below = below[0] + 0 * gains.ravel(), below[1] + 0 * gains.ravel()
    regions = _stable_delays(above, below)
    regions = [[(low / delay, high / delay) for low, high in each] for each in regions]
    chosen = numpy.array([min(each, key=_distance_from_1, default=(math.nan, math.nan)) for each in regions])
    lower, upper = (x.reshape(gains.shape) for x in chosen.T)
    return DelayRatios(lower, upper, regions) if gains.ndim else DelayRatios(float(lower), float(upper), regions[0])


def robustness_pi_first_order(K, T, delay, Kp, Ti, gain_ratio):
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
    import numpy

    gains = _gain_ratios(gain_ratio)
    k = (float(K) * float(Kp) * gains) ** 2
    T, delay, Ti = float(T), float(delay), float(Ti)
    middle = (k - 1) * Ti
    root = numpy.sqrt(middle**2 + 4 * k * T**2)
    # the sum under the root, or where it would cancel the quotient that is equal to it
    sum_ = numpy.where(middle > 0, middle + root, 4 * k * T**2 / (root - numpy.minimum(middle, 0)))
    w = numpy.sqrt(sum_ / (2 * Ti * T**2))
    ratio = (math.pi / 2 + numpy.arctan(w * Ti) - numpy.arctan(w * T)) / w / delay
    return ratio if ratio.ndim else float(ratio)


def shinskey_window(points=25):
    """Return the outline of Shinskey's window in the plane of gain ratio and delay ratio, for a robustness plot.

    In the window the product of the two ratios lies between 0.5 and 2, and so does their quotient. (The source prints
    "products" for the quotients.) Its corners are (2, 1), (1, 2), (0.5, 1) and (1, 0.5).

    Arguments:
        points: how many there are on each of the four sides, both corners included.
    Returns:
        Two arrays, gain ratios and delay ratios, of the closed outline.
    Source: Syder, Heeg and O'Dwyer, Section 3 and Figure 2, after Shinskey (1990).

    >>> gains, delays = shinskey_window(2)
    >>> gains.round(3).tolist(), delays.round(3).tolist()
    ([2.0, 1.0, 0.5, 1.0, 2.0], [1.0, 2.0, 1.0, 0.5, 1.0])
    """
    import numpy

    if isinstance(points, bool) or not isinstance(points, int) or points < 2:
        raise ValueError(f"points is {points!r}: expected a whole number, at least 2")
    corners = numpy.array([(1, 0), (0, 1), (-1, 0), (0, -1), (1, 0)], dtype=float)
    along = numpy.linspace(0, 1, points)[:-1, None]
    sides = [one + along * (other - one) for one, other in itertools.pairwise(corners)]
    gains, delays = 2.0 ** numpy.vstack([*sides, corners[:1]]).T
    return gains, delays


def robust_in_window(process, controller):
    """Say whether a loop is stable in all of Shinskey's window, so that the controller counts as robust.

    The limit of stability is a curve with the frequency as its parameter: abs(L) = 1 gives the gain ratio, the phase
    the delay ratio. Bounds prove for each range of frequencies that it does not meet the window, or a point of it is
    found in there.

    Arguments:
        process, controller: as for `robustness`.
    Raises:
        ValueError: as `robustness`.
    Source: Syder, Heeg and O'Dwyer, Section 3, after Shinskey (1990).

    >>> from loopbook.pid import PID
    >>> process = 2 * sympy.exp(-s) / (4 * s + 1)
    >>> robust_in_window(process, PID(0.5, Ti=4)), robust_in_window(process, PID(1.6, Ti=4))
    (True, False)
    """
    rational, delay = _with_one_dead_time(process)
    nominal = robustness(process, controller, 1)
    if not any(low < 1 < high for low, high in nominal.regions):
        return False
    return _misses_window(*_families(transfer_function(controller) * rational), delay)


def stability_map(loop, progress=None, **values):
    """Return the number of unstable closed-loop poles for many values of two letters.

    Arguments:
        loop: the open loop L(s), an expression with two letters, in its coefficients or dead times.
        progress: whether to show a progress bar; None shows one when the work takes more than two seconds.
        **values: the values of the two letters by their names, one-dimensional arrays.
    Returns:
        An array of integers, with a row for each value of the second letter and a column for each of the first; -1
        on the limit of stability, and 1000000000 where there is no end of unstable poles.
    Raises:
        ValueError: for other letters than two with values, a negative dead time, a loop that is improper or loses its
            highest power at a point, or as `unstable_roots`.

    >>> K, delay = sympy.symbols("K delay")
    >>> stability_map(K * sympy.exp(-delay * s) / s, K=[1, 2], delay=[0.5, 1, 3])
    array([[0, 0],
           [0, 2],
           [2, 2]])
    """
    import numpy

    L = transfer_function(loop)
    letters = {str(letter): letter for letter in L.free_symbols - {s}}
    if set(letters) != set(values) or len(values) != 2:
        raise ValueError(
            f"the loop {L} has the letters {', '.join(sorted(letters)) or 'none'}, and there are values for "
            f"{', '.join(values) or 'none'}: expected two letters, and values for both"
        )
    grids = []
    for name, grid in values.items():
        try:
            grids.append(numpy.asarray(grid, dtype=float))
        except (TypeError, ValueError):
            raise ValueError(f"the values of {name} are {grid!r}: expected an array of numbers") from None
        if grids[-1].ndim != 1 or not numpy.isfinite(grids[-1]).all():
            raise ValueError(f"the values of {name} are {grid!r}: expected a one-dimensional array of finite numbers")
    # letters in dead times are ordered as positive ones
    positive = {name: sympy.Symbol(name, positive=True) for name in values}
    parts = _characteristic(L.xreplace({letters[name]: positive[name] for name in values}))
    order = parts[0].degree()
    rows = [part.coeff_monomial(s**n) for part in parts.values() for n in range(order + 1)]
    numbers = sympy.lambdify([positive[name] for name in values], [*rows, *parts], "numpy", cse=True)
    points = [grid.ravel() for grid in numpy.meshgrid(*grids)]
    counts = numpy.empty(points[0].size, dtype=int)
    chunks = [slice(k, k + CHUNK) for k in range(0, counts.size, CHUNK)]
    for chunk in _watched(chunks, progress):
        here = [x[chunk] for x in points]
        found = [row + 0.0 * here[0] for row in numbers(*here)]
        coefficients, delays = numpy.array(found[: len(rows)]), numpy.array(found[len(rows) :])
        if (delays < 0).any():
            raise ValueError(f"the values make a dead time {delays.min():g}: expected one that is not negative")
        coefficients = coefficients.reshape(len(parts), order + 1, -1)
        if (lost := numpy.flatnonzero(coefficients[0, -1] == 0)).size:
            where = ", ".join(f"{name} = {x[lost[0]]:g}" for name, x in zip(values, here, strict=True))
            raise ValueError(f"the closed loop of {L} loses its highest power at {where}: expected other values")
        counts[chunk] = _counts(coefficients, delays)
    return counts.reshape(len(grids[1]), len(grids[0]))


def _watched(chunks, progress):
    """The chunks, with a progress bar where it is wanted or the work takes more than two seconds."""
    begun, bar = time.monotonic(), None
    try:
        for number, chunk in enumerate(chunks):
            if bar is None and progress is not False and (progress or time.monotonic() - begun > 2):
                from rich.progress import Progress

                bar = Progress(transient=True)
                bar.start()
                task = bar.add_task("stability map", total=len(chunks))
            if bar is not None:
                bar.update(task, completed=number)
            yield chunk
    finally:
        if bar is not None:
            bar.stop()


# ---- what the questions stand on


def _families(L):
    """Numerator and denominator of a loop as families of one point, with as many powers."""
    above, below = _fraction(L)
    order, divisor = below[0].degree(), below[0].LC()
    return _arrays(above, order, divisor), _arrays(below, order, divisor)


def _stable_loop(loop):
    """The families of a loop that is stable."""
    L = _open_loop(loop)
    if not is_stable(L):
        raise ValueError(f"the closed loop of {L} is not stable: it has no margin")
    return _families(L)


def _gain_crossings(above, below):
    """The frequencies where abs(L) = 1, how far the phase may still fall there, and whether abs(L) ends below 1."""
    import numpy

    equal, end, fading = _equal_sizes(above, below)
    if numpy.isnan(end).any():
        raise ValueError("whether the loop's gain at ever higher frequencies stays away from 1 is not decided")
    here, w = _axis_zeros(equal, 1, 0 * end, end)
    return w, _phase_left(above, below, here, w), bool(fading[0])


def _equal_sizes(above, below):
    """abs(B)**2 - abs(A)**2, a frequency beyond which it is not zero, and whether it is positive there."""
    import numpy

    sums, delays = _together(_product(below, _mirrored(below)), _times(-1, _product(above, _mirrored(above))))
    while len(sums[0]) > 1 and not sums[:, -1].any():
        sums = sums[:, :-1]
    end = _prevailing(sums)
    half = (sums.shape[1] - 1) // 2
    return (sums, delays), end, ~numpy.isnan(end) & ((-1) ** half * sums[0, -1] > 0)


def _phase_left(above, below, which, w):
    """How much more the phase of L may fall until L is negative, between 0 and 2 pi."""
    import numpy

    angle = numpy.angle(-_Sums(*above).value(which, w) / _Sums(*below).value(which, w))
    return numpy.where(abs(angle) < CLOSE, 0, angle) % (2 * math.pi)


def _delay_margin(w, left, fading):
    # where the gain at ever higher frequencies is 1 or more, any additional dead time is too much
    return float((left / w).min(initial=math.inf)) if fading else 0.0


def _limiting_gains(above, below):
    """Find the gains with poles on the axis, in ever wider ranges of frequency, of many loops.

    Yields points, gains and frequencies of all found so far; and for each loop a gain below which they are complete,
    and the one at which infinitely many poles become unstable, which is where the former ends.
    """
    import numpy

    count = above[0].shape[-1]
    scale = _prevailing(below[0])
    if numpy.isnan(scale).any():
        raise ValueError("the highest power of the open loop's denominator returns so strongly that nothing is decided")
    above, below = _slower(*above, scale), _slower(*below, scale)
    numerator, denominator = _Sums(*above), _Sums(*below)
    longest = numpy.maximum(above[1].max(axis=0), below[1].max(axis=0))
    # L is real where A(s) B(-s) is; what is left after division by a power of s is real or imaginary
    both = _product(above, _mirrored(below))
    odd = _together(_times(0.5, both), _times(-0.5, _mirrored(both)))
    rows = numpy.flatnonzero(odd[0].any(axis=(0, 2)))
    lowest, highest = (rows[0], rows[-1]) if len(rows) else (0, 0)
    odd = odd[0][:, lowest : highest + 1], odd[1]
    last = numpy.where(odd[0].any(axis=(0, 1)), _prevailing(odd[0]), 0)  # no crossing beyond it; nan if there may be
    endless = _endless_gain(above, below)
    if (ending := numpy.flatnonzero(endless < math.inf)).size:
        last[ending] = numpy.fmin(
            last[ending], _last_of_ending(_at(above, ending), _at(below, ending), endless[ending])
        )
    static_above, static_below = above[0][:, 0].sum(axis=0), below[0][:, 0].sum(axis=0)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        static = -static_below / static_above
    exact = abs(static_below) > ON_AXIS * abs(below[0][:, 0]).sum(axis=0)  # not an integrator but for rounding
    at_zero = numpy.flatnonzero((static > 0) & numpy.isfinite(static) & exact)
    points, gains, frequencies = at_zero, static[at_zero], 0 * static[at_zero]
    begin, end = numpy.zeros(count), numpy.full(count, 4.0)
    for _ in range(40):
        end = numpy.where(end >= last, last, end)
        which, w = _axis_zeros(odd, 1j ** (lowest - 1), begin, end)
        A, B = numerator.value(which, w), denominator.value(which, w)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            gain = (-B / A).real
        seen = (gain > 0) & numpy.isfinite(gain) & (w > 1e-9)
        points = numpy.concatenate([points, which[seen]])
        gains = numpy.concatenate([gains, gain[seen]])
        frequencies = numpy.concatenate([frequencies, (w * scale[which])[seen]])
        # beyond `end` abs(L) only falls below this bound
        powers = numpy.maximum(end, 1.0) ** numpy.arange(above[0].shape[1])[:, None]
        most = (abs(above[0]).sum(axis=0) * powers).sum(axis=0)
        least = 2 * abs(below[0][0, -1]) * powers[-1] - (abs(below[0]).sum(axis=0) * powers).sum(axis=0)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            top = numpy.where(end >= last, math.inf, numpy.where(least > 0, least / most, 0))
        yield points, gains, frequencies, numpy.minimum(top, endless), endless
        far = end * longest > MOST_TURNS
        if (far | (top == math.inf)).all():
            return
        begin, end = end, numpy.where(far, end, 4 * end)


def _last_of_ending(above, below, endless):
    """The frequency beyond which no gain lower than the endless one is a limit."""
    import numpy

    equal, end, _ = _equal_sizes(_times((1 - CLOSE) * endless, above), below)
    decided = end == end
    which, w = _axis_zeros(equal, 1, 0 * endless, numpy.where(decided, end, 0))
    last = numpy.zeros(len(endless))
    numpy.maximum.at(last, which, w)
    # where the sizes do not decide, the highest powers do, but for the last thousandth of the gain
    sizes = abs(below[0]).sum(axis=0) + endless * abs(above[0]).sum(axis=0)
    sizes[-1] = (2 * abs(below[0][0, -1]) - abs(below[0][:, -1]).sum(axis=0)) / 1000
    return numpy.where(decided, last, _prevailing(sizes[None]))


def _endless_gain(above, below):
    """The gain at which the highest powers of B + gain*A with dead times outweigh the one without; or infinite."""
    import numpy

    # both with the same dead times in the same order
    A = _together(above, _times(0, below))[0][:, -1]
    B = _together(_times(0, above), below)[0][:, -1]
    lowest = numpy.full(A.shape[-1], math.inf)
    for signs in itertools.product((-1, 1), repeat=len(A) - 1):
        # a sum of sizes is the largest of all sums with signs
        signs = numpy.array([1, *signs])[:, None]
        falling = -(signs * A).sum(axis=0)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            lowest = numpy.where(falling > 0, numpy.minimum(lowest, (signs * B).sum(axis=0) / falling), lowest)
    return lowest


def _stable_range(above, below):
    """The upper end of the lowest range of gains for which loops are stable, and its frequency; nan without such."""
    import numpy

    count = above[0].shape[-1]
    found, frequency, lower = numpy.full(count, math.nan), numpy.full(count, math.nan), numpy.zeros(count)
    searched = numpy.ones(count, dtype=bool)

    def stable(which, gain):
        return _counts(*_together(_at(below, which), _times(gain, _at(above, which)))) == 0

    for points, gains, frequencies, top, endless in _limiting_gains(above, below):
        # one after the other in each loop: is it stable between this gain and the one before?
        new = searched[points] & (gains > lower[points]) & (gains < top[points])
        points, gains, frequencies = (x[new] for x in (points, gains, frequencies))
        order = numpy.lexsort((gains, points))
        points, gains, frequencies = (x[order] for x in (points, gains, frequencies))
        while len(points):
            which, first = numpy.unique(points, return_index=True)
            good = stable(which, (lower[which] + gains[first]) / 2)
            found[which[good]], frequency[which[good]] = gains[first][good], frequencies[first][good]
            searched[which[good]] = False
            lower[which] = gains[first]
            left = searched[points]
            left[first] = False
            points, gains, frequencies = (x[left] for x in (points, gains, frequencies))
        last = numpy.flatnonzero(searched & (top == endless))
        if len(last):
            good = last[stable(last, numpy.where(endless < math.inf, (lower + endless) / 2, 2 * lower + 1)[last])]
            found[good], frequency[good] = endless[good], math.inf
            searched[last] = False
        if not searched.any():
            return found, frequency
    last = numpy.flatnonzero(searched)
    highest = numpy.maximum(top, lower)
    if (last := last[stable(last, (lower + highest)[last] / 2)]).size:
        raise ValueError(
            f"no gain on the limit of stability was found up to {highest[last[0]]:.3g}, where the loop is still stable"
        )
    return found, frequency


def _at(family, points):
    """Some points of a family."""
    coefficients, delays = family
    return coefficients[..., points], delays[..., points if delays.shape[-1] > 1 else slice(None)]


def _largest_sensitivity(above, below):
    """The largest value of abs(B/(A + B)) and its frequency; bounds exclude all other places.

    Where the loop's gain does not vanish at high frequencies, the tail is taken as periodic beyond 1000 times the
    frequency at which the highest powers begin to prevail.
    """
    import numpy
    from scipy.optimize import minimize_scalar

    closed = _together(below, above)
    at_zero = abs(below[0][:, 0].sum() / closed[0][:, 0].sum()), 0.0
    best, place = max(_far(below, closed), at_zero)
    B, C = _Sums(*below), _Sums(*closed)

    def values(which, w):
        return numpy.array([B.value(which, w), C.value(which, w)])

    def sensitivity(w):
        above, below = abs(values(numpy.zeros(1, dtype=int), numpy.array([w])))
        return float(above[0] / below[0])

    begin, end = numpy.zeros(1), 4 * _prevailing(below[0])
    last, allowed = 1000 * end, MOST_INTERVALS
    while begin < end:
        which, a, b = numpy.zeros(1, dtype=int), begin, end
        at_a, at_b = values(which, a), values(which, b)
        while len(which):
            height = abs(at_b[0] / at_b[1])
            if height.max() > best:
                best, place = float(height.max()), float(b[height.argmax()])
            sizes, change = abs(at_a) + abs(at_b), (b - a) * numpy.array([f.bounds(which, b)[1] for f in (B, C)])
            higher = sizes[0] + change[0] > best * (1 + 1e-5) * (sizes[1] - change[1])
            allowed = _allowed(allowed, higher)
            which, a, b, at_a, at_b = _halved(higher, which, a, b, at_a, at_b, values)
        # beyond this frequency abs(L) is so small that 1/(1 - abs(L)) stays below what was found
        small = _prevailing(numpy.concatenate([below[0], above[0] / (1 - 1 / max(best, 1.0003))]))
        begin, end = end, numpy.where(numpy.isnan(small), last, small)
    if 0 < place < math.inf:
        width = 1e-7 * place
        while width < place / 4 and max(sensitivity(place - width), sensitivity(place + width)) >= best * (1 - 1e-9):
            width *= 2
        peak = minimize_scalar(
            lambda w: -sensitivity(w),
            bounds=(place - width, place + width),
            method="bounded",
            options={"xatol": 1e-10 * place},
        )
        if -peak.fun > best:
            best, place = float(-peak.fun), float(peak.x)
    return float(best), place


def _far(below, closed):
    """The largest abs(B/(A + B)) for ever higher frequencies, where only the highest powers count."""
    import numpy

    tops = [(coefficients[:, -1, 0], delays[:, 0]) for coefficients, delays in (below, closed)]
    later = sorted({float(delay) for top, delays in tops for c, delay in zip(top, delays, strict=True) if c and delay})
    if not later:
        return float(abs(tops[0][0].sum() / tops[1][0].sum())), math.inf
    ratios = [Fraction(delay / later[0]).limit_denominator(100) for delay in later]
    unit = later[0] / math.lcm(*(r.denominator for r in ratios))
    # with dead times that are no multiples of one, the phases come as near to any as one wants
    angle = numpy.linspace(0, 2 * math.pi, 400_001) if len(later) == 1 else numpy.linspace(0, 2000 * math.pi, 4_000_001)
    values = [
        sum(c * numpy.exp(-1j * angle * (delay / unit)) for c, delay in zip(*top, strict=True) if c) for top in tops
    ]
    return float(abs(values[0] / values[1]).max()), math.inf


def _gain_ratios(gain_ratio):
    import numpy

    try:
        gains = numpy.asarray(gain_ratio, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"the gain ratio is {gain_ratio!r}: expected a number or an array of numbers") from None
    if wrong := [x for x in gains.flat if not 0 < x < math.inf]:
        raise ValueError(f"the gain ratio is {wrong[0]:g}: expected a positive number")
    return gains


def _with_one_dead_time(process):
    """The rational part of a process and its dead time."""
    P = _open_loop(process)
    parts = by_delay(P)
    if len(parts) != 1 or 0 in parts:
        raise ValueError(f"the process is {P}: expected a fraction of polynomials with one dead time exp(-delay*s)")
    ((delay, rational),) = parts.items()
    return rational, float(delay)


def _distance_from_1(region):
    low, high = region
    return 0 if low <= 1 <= high else math.log(low) if low > 1 else -math.log(high)


def _stable_delays(above, below):
    """For each loop with one more dead time in it, the regions of that dead time in which it is stable."""
    import numpy

    equal, end, fading = _equal_sizes(above, below)
    # where the gain at ever higher frequencies is 1 or more, no dead time is small enough
    decided = numpy.flatnonzero(fading)
    regions = [[] for _ in end]
    if not len(decided):
        return regions
    above, below, equal = (_at(family, decided) for family in (above, below, equal))
    end = end[decided]
    which, w = _axis_zeros(equal, 1, 0 * end, end)
    rise = (1j * _Sums(*equal).derivative().value(which, w)).real
    first, period = _phase_left(above, below, which, w) / w, 2 * math.pi / w
    direction = 2 * numpy.sign(rise).astype(int)
    # counted before the first crossing, because poles may lie on the axis without any dead time
    earliest = numpy.full(len(decided), math.inf)
    numpy.minimum.at(earliest, which, numpy.where(first > 0, first, period))
    earliest = numpy.where(earliest < math.inf, earliest, 1.0)
    begun = _counts(*_together(below, (above[0], above[1] + earliest / 2)))
    for k, point in enumerate(decided):
        mine = which == k
        regions[point] = _regions(begun[k], first[mine], period[mine], direction[mine])
    return regions


def _regions(count, first, period, direction):
    """The intervals of dead time without unstable poles, from their number at the beginning and all crossings."""
    import numpy

    if not len(first):
        return [(0.0, math.inf)] if count == 0 else []
    if count < 0:
        return []
    # later, more has come than the crossings of the other direction can take away
    rate = float((direction / period).sum())
    until = (count + abs(direction).sum()) / rate + 2 * period.max() if rate > 0 else 100 * period.max()
    until = min(until, 10_000 * period.max())
    times, steps = [], []
    for start, length, step in zip(first, period, direction, strict=True):
        turns = start + length * numpy.arange(max(0, math.floor((until - start) / length) + 1))
        turns = turns[turns > 0]
        times.append(turns)
        steps.append(numpy.full(len(turns), step))
    times, steps = numpy.concatenate(times), numpy.concatenate(steps)
    order = numpy.argsort(times, kind="stable")
    edges = [0.0, *times[order].tolist()]
    counts = [count, *(count + numpy.cumsum(steps[order])).tolist()]
    found = [
        (low, high) for n, (low, high) in zip(counts, itertools.pairwise(edges), strict=False) if n == 0 and low < high
    ]
    return found


def _misses_window(above, below, delay):
    """Whether the limit of stability, a curve over the frequency, stays out of Shinskey's window."""
    import numpy

    A, B = _Sums(*above), _Sums(*below)
    end = _prevailing(numpy.concatenate([below[0], 2 * above[0]]))
    if numpy.isnan(end).any():  # with twice the gain there is no end of unstable poles
        return False

    def values(which, w):
        return numpy.array([A.value(which, w), B.value(which, w)])

    def meets(low, high, w_low, w_high, angle, more):
        """Whether a gain ratio between low and high has a delay ratio in the window, for these phases."""
        middle = numpy.clip(1.0, low, high)  # where the window is widest
        shortest = numpy.maximum(1 / (2 * middle), middle / 2) * delay * w_low - angle - more
        longest = numpy.minimum(2 / middle, 2 * middle) * delay * w_high - angle + more
        return (high >= 0.5) & (low <= 2) & (numpy.ceil(shortest / (2 * math.pi)) <= longest / (2 * math.pi))

    which, a, b = numpy.zeros(1, dtype=int), numpy.zeros(1), end
    at_a, at_b = values(which, a), values(which, b)
    while len(which):
        angle, (A_b, B_b) = numpy.angle(-at_b[0] / at_b[1]), abs(at_b)
        if meets(B_b / A_b, B_b / A_b, b, b, angle, 0).any() or (b - a < 1e-13 * end).any():
            return False
        change_A, change_B = ((b - a) * f.bounds(which, b)[1] for f in (A, B))
        with numpy.errstate(divide="ignore", invalid="ignore"):
            low = numpy.maximum(B_b - change_B, 0) / (A_b + change_A)
            high = numpy.where(change_A < A_b, (B_b + change_B) / (A_b - change_A), math.inf)
            turn = sum(
                numpy.where(change < size, numpy.arcsin(numpy.minimum(change / size, 1)), math.pi)
                for change, size in ((change_A, A_b), (change_B, B_b))
            )
        left = meets(low, high, a, b, angle, turn)
        which, a, b, at_a, at_b = _halved(left, which, a, b, at_a, at_b, values)
    return True


# ---- the method of Walton and Marshall


def _roots(polynomial):
    """The roots of a polynomial with how often each occurs, to 30 digits."""
    for factor, n in polynomial.sqf_list()[1]:
        # a scale of frequency at which the coefficients are of one size
        first, *_, last = factor.all_coeffs()
        scale = sympy.Rational(10) ** round(math.log10(abs(last / first)) / factor.degree()) if last else sympy.S.One
        scaled = sympy.Poly(factor.as_expr().subs(s, scale * s), s)
        try:
            roots = scaled.nroots(n=30, maxsteps=1000)
        except mpmath.NoConvergence:
            raise ValueError(f"the roots of {polynomial.as_expr()} are too far apart to be found") from None
        yield from ((scale * root, n) for root in roots)


def _crossings(N, D):
    """Where poles cross the imaginary axis: (first dead time, period to the next, direction: 1 to the right)."""
    square = sympy.Symbol("square")

    def power(polynomial):  # abs(polynomial)^2 on the imaginary axis, in the square of the frequency
        even = sympy.Poly(polynomial.as_expr() * polynomial.as_expr().subs(s, -s), s)
        return sympy.Poly({(n // 2,): c * (-1) ** (n // 2) for (n,), c in even.terms()}, square)

    difference = power(D) - power(N)
    for root, n in difference.real_roots(multiple=False) if difference.degree() > 0 else []:
        if root <= 0 or n % 2 == 0:  # a pole that touches the axis comes back from it
            continue
        frequency = math.sqrt(root.evalf(30))
        there = sympy.I * sympy.Float(frequency, 30)
        ratio = complex((-N.as_expr() / D.as_expr()).subs(s, there).evalf(30))
        angle = math.atan2(ratio.imag, ratio.real)
        angle = 0.0 if abs(angle) < CLOSE else angle % (2 * math.pi)
        rising = sympy.N(difference.diff((square, n)).eval(root), 30) > 0
        yield angle / frequency, 2 * math.pi / frequency, 1 if rising else -1
