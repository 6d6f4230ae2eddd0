"""Shinskey's window: the changes of gain and dead time that a robust loop has to bear."""

import itertools
import math

from loopbook.stability.robustness import open_loop_without_dead_time, robustness
from loopbook.stability.sums import prevailing, refined


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

    >>> import sympy
    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> process = 2 * sympy.exp(-s) / (4 * s + 1)
    >>> robust_in_window(process, PID(0.5, Ti=4)), robust_in_window(process, PID(1.6, Ti=4))
    (True, False)
    """
    nominal = robustness(process, controller, 1)
    if not any(low < 1 < high for low, high in nominal.regions):
        return False
    return _misses_window(*open_loop_without_dead_time(process, controller))


def _misses_window(A, B, delay):
    """Whether the limit of stability, a curve over the frequency, stays out of Shinskey's window."""
    import numpy

    end = prevailing(numpy.concatenate([B.coefficients, 2 * A.coefficients]))
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

    misses = True

    def undecided(intervals):
        nonlocal misses
        which, a, b, _, at_b = intervals
        angle, (A_b, B_b) = numpy.angle(-at_b[0] / at_b[1]), abs(at_b)
        if meets(B_b / A_b, B_b / A_b, b, b, angle, 0).any() or (b - a < 1e-13 * end).any():
            misses = False
            return numpy.zeros(len(which), dtype=bool)
        change_A, change_B = ((b - a) * f.bounds(which, b)[1] for f in (A, B))
        with numpy.errstate(divide="ignore", invalid="ignore"):
            low = numpy.maximum(B_b - change_B, 0) / (A_b + change_A)
            high = numpy.where(change_A < A_b, (B_b + change_B) / (A_b - change_A), math.inf)
            turn = sum(
                numpy.where(change < size, numpy.arcsin(numpy.minimum(change / size, 1)), math.pi)
                for change, size in ((change_A, A_b), (change_B, B_b))
            )
        return meets(low, high, a, b, angle, turn)

    refined(values, numpy.zeros(1, dtype=int), numpy.zeros(1), end, undecided)
    return misses
