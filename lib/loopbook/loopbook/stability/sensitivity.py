"""The largest sensitivity Ms, of one loop or of many at once."""

from __future__ import annotations

import math

import numpy as np

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.counting import count_closed, of_one_order
from loopbook.stability.crossings import asked, steps, wider
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.loops import ENOUGH, Loops, positive_beyond, square
from loopbook.stability.peaks import Peak

AT_ONCE = 2000
MOST_TURNS = 2000.0  # of the phase by dead time, in radians, after which it is given up that has no end in sight


def largest_sensitivities(A: Quasipolynomials, B: Quasipolynomials) -> np.ndarray:
    """Return Ms for many loops L = A/B at once; infinite for those that are not stable.

    It is nan where double precision does not decide whether one is.

    Arguments:
        A, B: numerators and denominators, with as many powers, as `Quasipolynomials`; B may be a single one.
    Raises:
        ValueError: where it is not decided, with the frequencies between which it is not.

    >>> import numpy as np
    >>> B = Quasipolynomials(np.array([[[0.0], [1.0]]]), np.zeros((1, 1)))    # s
    >>> A = Quasipolynomials(np.array([[[0.3, 0.5, 2.0], [0.0] * 3]]), np.ones((1, 1)))    # K exp(-s)
    >>> largest_sensitivities(A, B).round(3).tolist()
    [1.307, 1.59, inf]
    """
    found = np.full(max(A.count, B.count), math.nan)
    for points, numerators, denominators in of_one_order(A, B):
        counts = count_closed(numerators, denominators)
        found[points[counts > 0]] = math.inf
        stable = np.flatnonzero(counts == 0)
        for start in range(0, len(stable), AT_ONCE):
            some = stable[start : start + AT_ONCE]
            found[points[some]] = _largest(Loops(numerators[some], denominators[some]))
    return found


def _largest(loops):
    every = np.arange(loops.count)
    peak = Peak(loops)
    peak.see(every, _at_endless_frequency(loops), np.full(loops.count, math.inf))
    done = peak.below()
    end = np.maximum(np.clip(np.nan_to_num(loops.beyond(np.full(loops.count, 2.0)), nan=4.0), 0, 64), 4 * done)
    while True:
        asked(loops, [peak], *steps(done, end))
        done = np.maximum(done, end)
        need = np.nan_to_num(_no_peak_beyond(loops, peak.most * (1 + ENOUGH)), nan=math.inf)
        if (need <= done).all():
            return peak.most
        far_out = (need == math.inf) & ((done * loops.longest > MOST_TURNS) | (done > 1e15))
        if (lost := np.flatnonzero(far_out)).size:
            raise UndecidedError(peak.name, float(done[lost[0]]), math.inf, float(loops.unit[lost[0]]))
        end = np.where(need > done, np.minimum(need, wider(loops, done)), done)


def _at_endless_frequency(loops):
    """The largest abs(B/C) of the highest powers."""

    a, b = loops.A.coefficients[:, -1], loops.B.coefficients[:, -1]
    if b[1:].any():
        raise ValueError("the highest power of a denominator returns with a dead time: expected loops without that")
    undelayed = loops.A.delays == 0
    at_once, later = (a * undelayed).sum(axis=0), abs(a * ~undelayed).sum(axis=0)
    return abs(b[0]) / (abs(b[0] + at_once) - later)


def _no_peak_beyond(loops, most):
    """A frequency beyond which abs(B/C) is below `most`."""
    with np.errstate(divide="ignore", invalid="ignore"):
        end = loops.beyond(np.where(most > 1, most / (most - 1), math.nan))
    if loops.squares is None:
        return end
    end = np.fmin(end, np.where(most >= _at_endless_frequency(loops), loops.beyond_limit(), math.nan))
    if not loops.longest.any():
        C = np.array(square((loops.A.coefficients + loops.B.coefficients)[0]))
        end = np.fmin(end, positive_beyond(most**2 * C - loops.squares[1]))
    return end
