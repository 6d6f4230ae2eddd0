"""The margins of a stable loop: how far its gain, its phase and its dead time are from the limit, and Ms."""

import math
from fractions import Fraction
from typing import NamedTuple

from loopbook.stability.counting import is_closed_loop_stable, open_loop
from loopbook.stability.crossings import equal_sizes, limiting_gains, phase_left
from loopbook.stability.sums import axis_zeros, fraction_sums, prevailing, refined

LARGEST_GAIN = 1e6  # up to which a gain margin is looked for


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


def delay_margin(loop):
    """Return the additional dead time in the loop that brings a stable closed loop to the limit of stability.

    Arguments:
        loop: the open loop L(s), as for `unstable_poles`.
    Returns:
        The additional dead time, in the unit of the lags; infinite where none makes the loop unstable.
    Raises:
        ValueError: if the loop is not stable to begin with, or as `unstable_poles`.

    >>> import sympy
    >>> from loopbook import s
    >>> round(delay_margin(sympy.exp(-s) / s), 4)    # pi/2 in all
    0.5708
    """
    A, B = _stable_loop(loop)
    return _delay_margin(*_gain_crossings(A, B))


def margins(loop):
    """Return gain margin, phase margin, delay margin and Ms of a stable loop, with any dead times, as `Margins`.

    All crossings are found, by bounds that exclude others, and of several the nearest one counts. The search for a gain
    margin has an end: one above 1e6, or at a frequency where the dead times alone turn the phase by more than 400 rad,
    is reported as infinite.

    Arguments:
        loop: the open loop L(s), as for `unstable_poles`.
    Raises:
        ValueError: if the closed loop is not stable, or as `unstable_poles`.

    >>> import sympy
    >>> from loopbook import s
    >>> found = margins(sympy.exp(-s) / (2 * s))
    >>> round(found.gain_margin, 4), round(found.phase_margin, 4), round(found.delay_margin, 4)
    (3.1416, 61.3521, 2.1416)
    """
    import numpy

    A, B = _stable_loop(loop)
    gain_margin, gain_reduction, omega_180 = _gain_margin(A, B)
    w, left, fading = _gain_crossings(A, B)
    either_way = numpy.minimum(left, 2 * math.pi - left)
    phase_margin, omega_c = math.inf, math.nan
    if len(w):
        nearest = either_way.argmin()
        phase_margin, omega_c = math.degrees(either_way[nearest]), float(w[nearest])
    Ms, omega_ms = _largest_sensitivity(A, B)
    return Margins(
        gain_margin, gain_reduction, phase_margin, _delay_margin(w, left, fading), Ms, omega_180, omega_c, omega_ms
    )


def _stable_loop(loop):
    """Numerator and denominator of a loop that is stable."""
    L = open_loop(loop)
    if not is_closed_loop_stable(L):
        raise ValueError(f"the closed loop of {L.expr} is not stable: it has no margin")
    return fraction_sums(L)


def _gain_margin(A, B):
    """How far the gain may grow and fall, and the frequency of the former."""
    reduction = 0.0
    for _, gains, frequencies, (top,), (endless,) in limiting_gains(A, B):
        higher = gains > 1
        reduction = float(gains[gains < 1].max(initial=0.0))
        if higher.any() and gains[higher].min() <= top:
            nearest = gains[higher].argmin()
            return float(gains[higher][nearest]), reduction, float(frequencies[higher][nearest])
        if top == endless < math.inf:
            return float(endless), reduction, math.inf
        if top > LARGEST_GAIN:
            break
    return math.inf, reduction, math.nan


def _gain_crossings(A, B):
    """The frequencies where abs(L) = 1, how far the phase may still fall there, and whether abs(L) ends below 1."""
    import numpy

    equal, end, fading = equal_sizes(A, B)
    if numpy.isnan(end).any():
        raise ValueError("whether the loop's gain at ever higher frequencies stays away from 1 is not decided")
    which, w = axis_zeros(equal, 1, 0 * end, end)
    return w, phase_left(A, B, which, w), bool(fading[0])


def _delay_margin(w, left, fading):
    # where the gain at ever higher frequencies is 1 or more, any additional dead time is too much
    return float((left / w).min(initial=math.inf)) if fading else 0.0


# ---- the largest sensitivity


def _largest_sensitivity(A, B):
    """The largest value of abs(1/(1 + L)) = abs(B/(A + B)) and its frequency; bounds exclude all other places.

    Where the loop's gain does not vanish at high frequencies, the tail is taken as periodic beyond 1000 times the
    frequency at which the highest powers begin to prevail.
    """
    import numpy

    C, one = A + B, numpy.zeros(1, dtype=int)

    def values(which, w):
        return numpy.array([B.value(which, w), C.value(which, w)])

    def sensitivity(w):
        above, below = abs(values(one, numpy.array([w])))
        return float(above[0] / below[0])

    best, place = max((_sensitivity_far_out(B, C), math.inf), (sensitivity(0.0), 0.0))

    def undecided(intervals):
        nonlocal best, place
        which, a, b, at_a, at_b = intervals
        height = abs(at_b[0] / at_b[1])
        if height.max() > best:
            best, place = float(height.max()), float(b[height.argmax()])
        sizes, change = abs(at_a) + abs(at_b), (b - a) * numpy.array([f.bounds(which, b)[1] for f in (B, C)])
        return sizes[0] + change[0] > best * (1 + 1e-5) * (sizes[1] - change[1])

    begin, end = numpy.zeros(1), 4 * prevailing(B.coefficients)
    last = 1000 * end
    while begin < end:
        refined(values, one, begin, end, undecided)
        # beyond this frequency abs(L) is so small that 1/(1 - abs(L)) stays below what was found
        most = 1 - 1 / max(best, 1.0003)
        small = prevailing(numpy.concatenate([B.coefficients, A.coefficients / most]))
        begin, end = end, numpy.where(numpy.isnan(small), last, small)
    return _top(sensitivity, best, place) if 0 < place < math.inf else (best, place)


def _top(sensitivity, best, place):
    """The top of the peak on whose side a place is."""
    from scipy.optimize import minimize_scalar

    width = 1e-7 * place
    while width < place / 4 and max(sensitivity(place - width), sensitivity(place + width)) >= best * (1 - 1e-9):
        width *= 2
    peak = minimize_scalar(
        lambda w: -sensitivity(w),
        bounds=(place - width, place + width),
        method="bounded",
        options={"xatol": 1e-10 * place},
    )
    return max((best, place), (float(-peak.fun), float(peak.x)))


def _sensitivity_far_out(B, C):
    """The largest abs(B/C) for ever higher frequencies, where only the highest powers count."""
    import numpy

    highest = [dict(zip(x.delays[:, 0].tolist(), x.coefficients[:, -1, 0].tolist(), strict=True)) for x in (B, C)]
    later = sorted({delay for each in highest for delay, c in each.items() if c and delay})
    if not later:
        return abs(highest[0][0] / highest[1][0])
    ratios = [Fraction(delay / later[0]).limit_denominator(100) for delay in later]
    unit = later[0] / math.lcm(*(r.denominator for r in ratios))
    # with dead times that are no multiples of one, the phases come as near to any as one wants
    angle = numpy.linspace(0, 2 * math.pi, 400_001) if len(later) == 1 else numpy.linspace(0, 2000 * math.pi, 4_000_001)
    above, below = (
        sum(c * numpy.exp(-1j * angle * (delay / unit)) for delay, c in each.items() if c) for each in highest
    )
    return float(abs(above / below).max())
