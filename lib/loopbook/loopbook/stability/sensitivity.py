"""The largest sensitivity Ms, asked for on intervals of frequency: of one loop, or of many at once."""

from __future__ import annotations

import math

import numpy as np

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.counting import count_closed, of_one_order
from loopbook.stability.crossings import NearZero, Question, View, asked, steps, wider
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.loops import DOUBTFUL, ENOUGH, Loops, positive_beyond, square

AT_ONCE = 2000
MOST_TURNS = 2000.0  # of the phase by dead time, in radians, after which it is given up that has no end in sight


class Peak(Question):
    """Whether abs(B/C) stays below `most`, one for each loop, which is the largest that was seen, and a little more."""

    name = "the largest sensitivity"

    def __init__(self, loops: Loops):
        self.loops = loops
        self.most, self.place = np.zeros(loops.count), np.zeros(loops.count)
        self.width = 0.0  # of the last one whose top was found
        # A and B may both be zero at zero, as with (1 - exp(-s))/s, and only their expansions have a quotient there
        every = np.arange(loops.count)
        A, B = loops.near_zero(every, np.full(loops.count, 1e-300))
        self.see(every, abs(B.terms[0] / (A.terms[0] + B.terms[0])), np.zeros(loops.count))

    def see(self, points: np.ndarray, sizes: np.ndarray, frequencies: np.ndarray) -> None:
        """Remember values, where they are higher than what was seen."""
        order = np.argsort(sizes)
        points, sizes, frequencies = points[order], sizes[order], frequencies[order]
        higher = sizes > self.most[points]
        self.most[points[higher]] = sizes[higher]
        self.place[points[higher]] = frequencies[higher]

    def judge(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        index = view.index
        before = self.most.copy()
        B, C, early = view.B, view.C, view.early
        known = slice(None) if view.precise else ~C.is_noisy
        with np.errstate(divide="ignore", invalid="ignore"):
            self.see(index[known], (B.sizes[0] / C.sizes[0])[known], view.c[known])
        if (self.most > before * (1 + 1e-12)).any():
            to_the_top(self.loops, self)
        most = self.most[index] * (1 + ENOUGH)
        undecided = (most * (B.least - early.most) <= B.most) & (most * C.least <= B.most)
        noisy = np.zeros(len(index), dtype=bool)
        if (some := np.flatnonzero(undecided)).size:
            B, C, most = B[some], C[some], most[some]
            above = (most * most) * (C @ C).real - (B @ B).real
            undecided[some] = ~above.is_positive
            noisy[some] = above.is_noisy | C.is_noisy | (C.noise > 1e-10 * C.sizes[0])
        return undecided, noisy

    def below(self) -> np.ndarray:
        """A frequency up to which it is decided from zero on, and crossings are by `Loops.start`."""
        start = self.loops.start.copy()
        for _ in range(300):
            undecided = self.judge(NearZero(self.loops, start))[0]
            if not undecided.any():
                return start
            start = np.where(undecided, start / 4, start)
        raise ValueError(f"{self.name} is not decided at the frequency zero")


def to_the_top(loops: Loops, question: Peak) -> None:
    """Move the highest values that were seen to the tops of their peaks."""
    every = np.flatnonzero((question.place > 0) & np.isfinite(question.place))
    if not len(every):
        return

    def at(w):
        A, B = loops.values(every, w, 2)
        return B, A + B

    best, places, curvature = _climbed(at, question.place[every], 30)
    question.see(every, best, places)
    with np.errstate(divide="ignore", invalid="ignore"):
        question.width = float(np.clip((-2 / curvature[0]) ** 0.5, 1e-7 * places[0], places[0] / 4))
    place = question.place[every]
    if loops.exact is not None and sum(loops.noise(every, place))[0] > DOUBTFUL * abs(at(place)[1][0, 0]):
        # rounding made what was seen, also if that is higher than what is there
        question.most[0] = 0.0
        question.see(every, *_climbed(lambda w: [each.taylor(w, 2) for each in loops.exact[1:]], place, 8)[:2])


def _climbed(at, w, most):
    """The largest abs(B/C) that Newton's steps find, where, and the second derivative of twice its logarithm there."""
    best, places, settled = -np.ones(len(w)), w.copy(), np.zeros(len(w), dtype=bool)
    for _ in range(most):
        (up, up1, up2), (down, down1, down2) = (
            (abs(x[0]) ** 2, 2 * (x[1] * x[0].conj()).real, 2 * abs(x[1]) ** 2 + 4 * (x[2] * x[0].conj()).real)
            for x in at(w)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            height = np.sqrt(up / down)
            slope = up1 / up - down1 / down
            curvature = up2 / up - (up1 / up) ** 2 - down2 / down + (down1 / down) ** 2
            step = np.where(curvature < 0, -slope / curvature, np.sign(slope) * 0.1 * w)
            # the next step would be about the square of this one, as a share of the peak's width
            small = (curvature < 0) & (abs(step) <= np.maximum(1e-5 * np.sqrt(-2 / curvature), 4e-16 * w))
        step = np.clip(np.nan_to_num(step), -0.3 * w, 0.3 * w)
        better = height > best
        best, places = np.where(better, height, best), np.where(better, w, places)
        if settled.all():
            break
        # what did not rise is tried again with half the step
        settled = settled | small | (~better & (abs(w - places) <= 1e-8 * places))
        w = np.where(better, w + step, (w + places) / 2)
    return best, places, curvature


# ---- many loops


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
    peak.see(every, _at_infinite_frequency(loops), np.full(loops.count, math.inf))
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


def _at_infinite_frequency(loops):
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
    end = np.fmin(end, np.where(most >= _at_infinite_frequency(loops), loops.beyond_limit(), math.nan))
    if not loops.longest.any():
        C = np.array(square((loops.A.coefficients + loops.B.coefficients)[0]))
        end = np.fmin(end, positive_beyond(most**2 * C - loops.squares[1]))
    return end
