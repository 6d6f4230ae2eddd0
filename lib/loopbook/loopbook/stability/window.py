"""Shinskey's window: the changes of gain and dead time that a robust loop has to bear."""

from __future__ import annotations

import itertools
import math

import numpy as np

from loopbook.stability.crossings import View
from loopbook.stability.enclosures import UndecidedError, geometric, walk
from loopbook.stability.loops import Loops
from loopbook.stability.robustness import open_loop_without_dead_time, robustness
from plainmath.validation import whole


def shinskey_window(points: int = 25) -> tuple[np.ndarray, np.ndarray]:
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
    points = whole("points", points, least=2)
    corners = np.array([(1, 0), (0, 1), (-1, 0), (0, -1), (1, 0)], dtype=float)
    along = np.linspace(0, 1, points)[:-1, None]
    sides = [one + along * (other - one) for one, other in itertools.pairwise(corners)]
    gains, delays = 2.0 ** np.vstack([*sides, corners[:1]]).T
    return gains, delays


def robust_in_window(process: object, controller: object) -> bool:
    """Say whether a loop is stable in all of Shinskey's window, so that the controller counts as robust.

    The limit of stability is a curve with the frequency as its parameter: abs(L) = 1 gives the gain ratio, the phase
    the delay ratio. Bounds prove for each range of frequencies that it does not meet the window, or a point of it is
    found in there. A curve that touches the window, as far as numbers can tell, meets it.

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
    loops = Loops(A, B)
    end, delay = loops.beyond(np.full(1, 2.0)), delay * float(loops.unit[0])
    if math.isnan(end[0]):  # with twice the gain there is no end of unstable poles
        return False

    def meets(low, high, w_low, w_high, angle, more):
        """Whether a gain ratio between low and high has a delay ratio in the window, for these phases."""
        middle = np.clip(1.0, low, high)  # where the window is widest
        shortest = np.maximum(1 / (2 * middle), middle / 2) * delay * w_low - angle - more
        longest = np.minimum(2 / middle, 2 * middle) * delay * w_high - angle + more
        return (high >= 0.5) & (low <= 2) & (np.ceil(shortest / (2 * math.pi)) <= longest / (2 * math.pi))

    misses = True

    def undecided(index, a, b, precise):
        nonlocal misses
        view = View(loops, index, a, b)
        A, B = view.A, view.B
        size_A, size_B, angle = A.sizes[0], B.sizes[0], np.angle(-A.terms[0] / B.terms[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            if meets(size_B / size_A, size_B / size_A, view.c, view.c, angle, 0).any():
                misses = False
                return np.zeros(len(index), dtype=bool), False, loops.longest[index]
            low = np.maximum(B.least, 0) / A.most
            high = np.where(A.least > 0, B.most / np.maximum(A.least, 0), math.inf)
            turn = sum(np.where(x.least > 0, np.arcsin(np.minimum(x.spread / x.sizes[0], 1)), math.pi) for x in (A, B))
        return meets(low, high, a, b, angle, turn), False, loops.longest[index] + delay

    try:
        walk(undecided, *geometric(np.minimum(loops.start, end / 2), end), "the limit of stability", loops.unit)
    except UndecidedError:
        return False
    return misses
