"""The largest sensitivity, asked for on intervals of frequency, and the tops of its peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from loopbook.stability.crossings import NearZero, Question, View
from loopbook.stability.loops import DOUBTFUL, ENOUGH

if TYPE_CHECKING:
    from loopbook.stability.loops import Loops


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
        which = view.which
        before = self.most.copy()
        B, C, early = view.B, view.C, view.early
        known = slice(None) if view.precise else ~C.is_noisy
        with np.errstate(divide="ignore", invalid="ignore"):
            self.see(which[known], (B.sizes[0] / C.sizes[0])[known], view.c[known])
        if (self.most > before * (1 + 1e-12)).any():
            to_the_top(self.loops, self)
        most = self.most[which] * (1 + ENOUGH)
        undecided = (most * (B.least - early.most) <= B.most) & (most * C.least <= B.most)
        noisy = np.zeros(len(which), dtype=bool)
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

    best, places, bend = _climbed(at, question.place[every], 30)
    question.see(every, best, places)
    with np.errstate(divide="ignore", invalid="ignore"):
        question.width = float(np.clip((-2 / bend[0]) ** 0.5, 1e-7 * places[0], places[0] / 4))
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
            bend = up2 / up - (up1 / up) ** 2 - down2 / down + (down1 / down) ** 2
            step = np.where(bend < 0, -slope / bend, np.sign(slope) * 0.1 * w)
            # the next step would be about the square of this one, as a share of the peak's width
            small = (bend < 0) & (abs(step) <= np.maximum(1e-5 * np.sqrt(-2 / bend), 4e-16 * w))
        step = np.clip(np.nan_to_num(step), -0.3 * w, 0.3 * w)
        better = height > best
        best, places = np.where(better, height, best), np.where(better, w, places)
        if settled.all():
            break
        # what did not rise is tried again with half the step
        settled = settled | small | (~better & (abs(w - places) <= 1e-8 * places))
        w = np.where(better, w + step, (w + places) / 2)
    return best, places, bend
