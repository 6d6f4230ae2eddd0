"""Where closed-loop poles cross the imaginary axis, as the gain or the dead time of a loop L = A/B grows.

With a gain k, they cross where L is real, at k = -1/L: Im A(s) B(-s) = 0. With a dead time, they cross where L has the
size 1, whatever its phase: A(s) A(-s) = B(s) B(-s). (K. Walton and J. E. Marshall, IEE Proceedings D 134, 1987)
"""

import itertools
import math

from loopbook.stability.sums import ROUNDING, Sums, axis_zeros, prevailing

CLOSE = 1e-9
MOST_TURNS = 400  # of the phase by dead time, in radians, in which a limiting gain is looked for


def equal_sizes(A, B):
    """abs(B)**2 - abs(A)**2, a frequency beyond which it is not zero, and whether it is positive there."""
    import numpy

    difference = B * B.mirrored() - A * A.mirrored()
    order = numpy.flatnonzero(difference.coefficients.any(axis=(0, 2))).max(initial=0)
    difference = Sums(difference.coefficients[:, : order + 1], difference.delays)
    end = prevailing(difference.coefficients)
    highest = (-1) ** (order // 2) * difference.coefficients[0, -1]
    return difference, end, ~numpy.isnan(end) & (highest > 0)


def phase_left(A, B, which, w):
    """How much more the phase of L may fall until L is negative, between 0 and 2 pi."""
    import numpy

    angle = numpy.angle(-A.value(which, w) / B.value(which, w))
    return numpy.where(abs(angle) < CLOSE, 0, angle) % (2 * math.pi)


def limiting_gains(A, B):
    """Find the gains with poles on the axis, in ever wider ranges of frequency, of many loops.

    Yields points, gains and frequencies of all found so far; and for each loop a gain below which they are complete,
    and the one at which infinitely many poles become unstable, which is where the former ends.
    """
    import numpy

    unit = prevailing(B.coefficients)
    if numpy.isnan(unit).any():
        raise ValueError("the highest power of the open loop's denominator returns so strongly that nothing is decided")
    A, B = A.slower(unit), B.slower(unit)
    longest = numpy.maximum(A.delays.max(axis=0), B.delays.max(axis=0))
    imaginary, turn = _imaginary_part(A, B)
    endless = _endless_gain(A, B)
    # no crossing beyond it; nan if there may be
    last = numpy.where(imaginary.coefficients.any(axis=(0, 1)), prevailing(imaginary.coefficients), 0)
    if (ending := numpy.flatnonzero(endless < math.inf)).size:
        last[ending] = numpy.fmin(last[ending], _last_below(endless[ending], A[ending], B[ending]))
    points, gains = _static_limits(A, B)
    frequencies = 0 * gains
    begin, end = numpy.zeros(A.count), numpy.full(A.count, 4.0)
    while True:
        end = numpy.where(end >= last, last, end)
        which, w = axis_zeros(imaginary, turn, begin, end)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            gain = (-B.value(which, w) / A.value(which, w)).real
        seen = (gain > 0) & numpy.isfinite(gain) & (w > 1e-9)
        points = numpy.concatenate([points, which[seen]])
        gains = numpy.concatenate([gains, gain[seen]])
        frequencies = numpy.concatenate([frequencies, (w * unit[which])[seen]])
        top = numpy.where(end >= last, math.inf, _least_beyond(end, A, B))
        yield points, gains, frequencies, numpy.minimum(top, endless), endless
        far = end * longest > MOST_TURNS
        if (far | (top == math.inf)).all():
            return
        begin, end = end, numpy.where(far, end, 4 * end)


def _imaginary_part(A, B):
    """The sum that is zero where L is real, and the turn that makes its values real on the axis.

    It is the odd part of A(s) B(-s), divided by a power of s.
    """
    import numpy

    both = A * B.mirrored()
    odd = both - both.mirrored()
    powers = numpy.flatnonzero(odd.coefficients.any(axis=(0, 2)))
    lowest, highest = (powers[0], powers[-1]) if len(powers) else (0, 0)
    return Sums(odd.coefficients[:, lowest : highest + 1], odd.delays), 1j ** (lowest - 1)


def _static_limits(A, B):
    """The loops with a gain for which a pole is at zero, and that gain."""
    import numpy

    above, below = A.coefficients[:, 0].sum(axis=0), B.coefficients[:, 0].sum(axis=0)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        gain = -below / above
    integrating = abs(below) <= ROUNDING * abs(B.coefficients[:, 0]).sum(axis=0)
    points = numpy.flatnonzero((gain > 0) & numpy.isfinite(gain) & ~integrating)
    return points, gain[points]


def _least_beyond(w, A, B):
    """A gain that is too small for poles on the axis beyond the frequency w: there abs(L) only falls below a bound."""
    import numpy

    powers = numpy.maximum(w, 1.0) ** numpy.arange(B.order + 1)[:, None]
    most = (abs(A.coefficients).sum(axis=0) * powers).sum(axis=0)
    least = 2 * abs(B.coefficients[0, -1]) * powers[-1] - (abs(B.coefficients).sum(axis=0) * powers).sum(axis=0)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return numpy.where(least > 0, least / most, 0)


def _endless_gain(A, B):
    """The gain at which the highest powers of B + gain*A with dead times outweigh the one without; or infinite."""
    import numpy

    # both with the same dead times in the same order
    a, b = (A + 0 * B).coefficients[:, -1], (0 * A + B).coefficients[:, -1]
    lowest = numpy.full(A.count, math.inf)
    for signs in itertools.product((-1, 1), repeat=len(a) - 1):
        # a sum of sizes is the largest of all sums with signs
        signs = numpy.array([1, *signs])[:, None]
        falling = -(signs * a).sum(axis=0)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            lowest = numpy.where(falling > 0, numpy.minimum(lowest, (signs * b).sum(axis=0) / falling), lowest)
    return lowest


def _last_below(endless, A, B):
    """The frequency beyond which no gain lower than the endless one is a limit."""
    import numpy

    equal, end, _ = equal_sizes((1 - CLOSE) * endless * A, B)
    decided = ~numpy.isnan(end)
    which, w = axis_zeros(equal, 1, 0 * endless, numpy.where(decided, end, 0))
    last = numpy.zeros(len(endless))
    numpy.maximum.at(last, which, w)
    # where the sizes do not decide, the highest powers do, but for the last thousandth of the gain
    sizes = abs(B.coefficients).sum(axis=0) + endless * abs(A.coefficients).sum(axis=0)
    sizes[-1] = (2 * abs(B.coefficients[0, -1]) - abs(B.coefficients[:, -1]).sum(axis=0)) / 1000
    return numpy.where(decided, last, prevailing(sizes[None]))
