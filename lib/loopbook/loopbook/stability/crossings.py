"""Where closed-loop poles cross the imaginary axis, as the gain or the dead time of a loop L = A/B grows.

With a gain k, they cross where L is real, at k = -1/L: Im A conj(B) = 0. With a dead time, they cross where L has the
size 1, whatever its phase: abs(A) = abs(B). (K. Walton and J. E. Marshall, IEE Proceedings D 134, 1987)

A question is asked on intervals of frequency, and decided on each by enclosures: there is no zero, or the function is
monotone, so that the signs at the ends tell whether there is one. What cannot be decided is never taken for a zero.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.stability.enclosures import Enclosure, divided, divided_about, enclosed, geometric, walk
from loopbook.stability.loops import DOUBTFUL, FEW

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from loopbook.stability.loops import Loops

LARGEST_GAIN = 1e12  # times 1, or times that which brings abs(L) to 1 about the fastest pole: larger ones are infinite


class View:
    """Loops on intervals of frequency: what the questions look at, each thing computed once."""

    def __init__(self, loops: Loops, index: np.ndarray, a: np.ndarray, b: np.ndarray, precise: bool = False):
        self.loops, self.index, self.a, self.b, self.precise = loops, index, a, b, precise
        self.c, self.r = (a + b) / 2, (b - a) / 2

    @functools.cached_property
    def A(self) -> Enclosure:
        return enclosed(self.loops.A, self.index, self.c, self.r, self.loops.exact[0] if self.precise else None)

    @functools.cached_property
    def B(self) -> Enclosure:
        return enclosed(self.loops.B, self.index, self.c, self.r, self.loops.exact[1] if self.precise else None)

    @functools.cached_property
    def early(self) -> Enclosure:
        """A without its common dead time, which does not change its size."""
        if self.precise or float((self.r * self.loops.lag[self.index]).max(initial=0.0)) < 0.3:
            return self.A
        return enclosed(self.loops.early, self.index, self.c, self.r)

    @functools.cached_property
    def C(self) -> Enclosure:
        if self.precise:
            return enclosed(self.loops.C, self.index, self.c, self.r, self.loops.exact[2])
        return self.B + self.A


class NearZero(View):
    """The intervals from -b to b, without zeros at zero that A and B have in common."""

    def __init__(self, loops: Loops, b: np.ndarray):
        super().__init__(loops, np.arange(loops.count), 0 * b, b)
        self.c, self.r = 0 * b, b
        self.A, self.B = loops.near_zero(self.index, b)
        self.early = self.A

    @functools.cached_property
    def C(self) -> Enclosure:
        total = self.B + self.A
        lost = abs(total.terms[0]) <= 4e-16 * (abs(self.A.terms[0]) + abs(self.B.terms[0]))
        total.terms[0] = np.where(lost, 0, total.terms[0])
        return total


class Question:
    """What is asked on intervals.

    `judge` says which are undecided, and for which of them rounding is a reason; `take` gets those about which all
    questions are decided. About `place`, a frequency for each loop, intervals are divided more finely.
    """

    name = ""
    place: np.ndarray | None = None

    def judge(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        raise NotImplementedError

    def take(self, view: View, chosen: np.ndarray) -> None:
        pass


class SizeOne(Question):
    """Where abs(L) = 1."""

    name = "whether the loop's gain is 1"

    def __init__(self):
        self.brackets = []

    def judge(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        A, B = view.early, view.B
        undecided = (B.least <= A.most) & (A.least <= B.most)
        self.crossing, noisy = np.zeros((2, len(view.index)), dtype=bool)
        if (some := np.flatnonzero(undecided)).size:
            A, B = A[some], B[some]
            rest = (B @ B).real - (A @ A).real
            away = (rest.least > 0) | rest.is_positive | (-1 * rest).is_positive
            crossing = ~away & rest.is_monotone
            self.crossing[some], noisy[some], undecided[some] = crossing, rest.is_noisy, ~away & ~crossing
        return undecided, noisy

    def take(self, view: View, chosen: np.ndarray) -> None:
        some = np.flatnonzero(self.crossing & chosen)
        if len(some):
            index, a, b = (x[some] for x in (view.index, view.a, view.b))
            low, high = (
                abs(B[0]) ** 2 - abs(A[0]) ** 2
                for A, B in (view.loops.values(index, end, 0, view.precise) for end in (a, b))
            )
            some = (low > 0) != (high > 0)
            self.brackets.append([x[some] for x in (index, a, b, low, high)])

    def solved(self, loops: Loops) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The points and frequencies, and A and B there."""
        if not self.brackets:
            nothing = np.zeros(0)
            return nothing.astype(int), nothing, nothing, nothing
        index, a, b, low, high = (np.concatenate(x) for x in zip(*self.brackets, strict=True))
        return index, *solved(loops, index, a, b, difference, low, high)


class Real(Question):
    """Where L is real and negative, with a gain in between `lowest` and `highest`, each an array over the loops.

    The crossings nearest to the gain 1 are wanted, on either side, and those that are found draw the limits together;
    with `all_gains` all are wanted, and they do not.
    """

    name = "whether poles cross the imaginary axis"

    def __init__(self, loops: Loops, all_gains: bool = False):
        self.loops, self.all_gains = loops, all_gains
        _ = loops.start  # which finds the loops that are always real
        every, one = np.arange(loops.count), np.ones(loops.count)
        A, B = (abs(x[0]) for x in loops.values(every, one))
        with np.errstate(divide="ignore"):
            self.infinite_from = LARGEST_GAIN * np.maximum(1, np.where(A > 0, B / A, 1))
        self.lowest, self.highest = np.zeros(loops.count), self.infinite_from.copy()
        self.points, self.gains, self.frequencies = np.zeros(0, dtype=int), np.zeros(0), np.zeros(0)

    def add(self, points: np.ndarray, gains: np.ndarray, frequencies: np.ndarray) -> None:
        """Remember crossings."""
        self.points = np.concatenate([self.points, points])
        self.gains = np.concatenate([self.gains, gains])
        self.frequencies = np.concatenate([self.frequencies, frequencies])
        if not self.all_gains:
            above, below = gains > 1, gains < 1
            np.minimum.at(self.highest, points[above], gains[above])
            np.maximum.at(self.lowest, points[below], gains[below])

    def is_known(self, points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Whether a crossing was found in an interval before."""
        if len(self.points) > 1000:
            return np.zeros(len(points), dtype=bool)
        w = self.frequencies
        return ((self.points == points[:, None]) & (w >= a[:, None]) & (w <= b[:, None])).any(axis=1)

    def judge(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        index = view.index
        undecided = ~self.loops.is_real[index]
        undecided &= (self.highest[index] * view.early.most >= view.B.least) & (
            self.lowest[index] * view.early.least <= view.B.most
        )
        noisy = np.zeros(len(index), dtype=bool)
        some = np.flatnonzero(undecided)
        if not len(some):
            return undecided, noisy
        A, B = view.A[some], view.B[some]
        product = A @ B
        middle = product.terms[0]
        away = np.where(middle.real < 0, abs(middle.imag), abs(middle)) > product.spread
        monotone = ~away & product.imag.is_monotone
        if len(candidates := some[monotone]):
            points, a, b = (x[candidates] for x in (index, view.a, view.b))
            ends = (self.loops.values(points, end, 0, view.precise) for end in (a, b))
            self.solve(points, a, b, *((A[0] * B[0].conj()).imag for A, B in ends))
        left = ~away & ~monotone
        if not self.all_gains:
            left &= ~_misses(A, B, self.lowest[index[some]], self.highest[index[some]])
        undecided[some] = left
        noisy[some] = product.is_noisy | (abs(middle.imag) < 16 * product.noise)
        return undecided, noisy

    def solve(self, points: np.ndarray, a: np.ndarray, b: np.ndarray, at_a: np.ndarray, at_b: np.ndarray) -> None:
        """Find the crossings in intervals with values of Im A conj(B) at the ends, if these have different signs."""
        new = np.flatnonzero(((at_a > 0) != (at_b > 0)) & ~self.is_known(points, a, b))
        if len(new):
            points, a, b, at_a, at_b = (x[new] for x in (points, a, b, at_a, at_b))
            w, A, B = solved(self.loops, points, a, b, imaginary, at_a, at_b)
            with np.errstate(divide="ignore", invalid="ignore"):
                gain = -(B / A).real
            seen = (gain > 0) & np.isfinite(gain)
            self.add(points[seen], gain[seen], w[seen])


def _misses(A: Enclosure, B: Enclosure, low, high):
    """Whether 0 is farther from all B + k A, with k from low to high, than these differ from those in the middle."""
    first, last = B + low * A, B + high * A
    start, step = first.terms[0], last.terms[0] - first.terms[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.clip(np.nan_to_num((-start * step.conj()).real / abs(step) ** 2), 0, 1)
    return abs(start + along * step) > np.maximum(first.spread, last.spread)


# ---- zeros


def imaginary(A: Sequence, B: Sequence) -> tuple:
    """Im A conj(B) and its first two derivatives."""
    A0, A1, A2 = A
    B0, B1, B2 = (x.conjugate() for x in B)
    return (A0 * B0).imag, (A1 * B0 + A0 * B1).imag, 2 * (A2 * B0 + A1 * B1 + A0 * B2).imag


def difference(A: Sequence, B: Sequence) -> tuple:
    """``abs(B)**2 - abs(A)**2`` and its first two derivatives."""
    (A0, A1, A2), (B0, B1, B2) = A, B
    size_A, size_B = abs(A0), abs(B0)
    first = 2 * (B1 * B0.conjugate() - A1 * A0.conjugate()).real
    second = 4 * (B2 * B0.conjugate() - A2 * A0.conjugate()).real + 2 * (abs(B1) ** 2 - abs(A1) ** 2)
    return (size_B - size_A) * (size_B + size_A), first, second


def solved(
    loops: Loops,
    index: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    function: Callable,
    at_a: np.ndarray,
    at_b: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The zeros between a and b of monotone functions, and A and B there, from the values at both ends.

    With more digits where rounding has a share in A or B.
    """
    # where a straight line has its zero, not too close to the ends
    w = a + (b - a) * np.clip(at_a / np.where(at_a == at_b, 1, at_a - at_b), 0.02, 0.98)
    w = _solved(loops, index, a, b, function, at_a < at_b, w, False)
    A, B = (x[0] for x in loops.values(index, w))
    if loops.exact is not None and 0 < len(w) < FEW:
        noise = loops.noise(index, w)
        again = np.flatnonzero((noise[0] > DOUBTFUL * abs(A)) | (noise[1] > DOUBTFUL * abs(B)))
        if len(again):
            some = index[again]
            w[again] = _solved(loops, some, a[again], b[again], function, (at_a < at_b)[again], w[again], True)
            A[again], B[again] = (x[0] for x in loops.values(some, w[again], precise=True))
    return w, A, B


def _solved(loops, index, a, b, function, rising, w, precise):
    """Halley's steps, and halves where they lead out."""
    a, b, moving = a.copy(), b.copy(), np.arange(len(index))
    enough = 3e-6 * (b - a)
    for _ in range(100):
        if not len(moving):
            break
        value, slope, curvature = function(*loops.values(index[moving], w[moving], 2, precise))
        before = (value < 0) == rising[moving]
        a[moving] = np.where(before, w[moving], a[moving])
        b[moving] = np.where(before, b[moving], w[moving])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = value / slope  # no squares of values, which for a high order would be smaller than all numbers
            better = w[moving] - 2 * step / (2 - step * (curvature / slope))
        outside = ~((better >= a[moving]) & (better <= b[moving]))
        better[outside] = ((a + b) / 2)[moving][outside]
        change = abs(better - w[moving])
        w[moving] = better
        # the next change would be about the cube of this one
        moving = moving[(change > np.maximum(enough[moving] * ~outside, 4e-16 * better)) & (value != 0)]
    return w


def phase_left(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """How much more the phase of L = A/B may fall until L is negative, between 0 and 2 pi."""
    angle = np.angle(-A / B)
    return np.where(abs(angle) < 1e-12, 0, angle) % (2 * math.pi)


# ---- asking


def asked(
    loops: Loops,
    questions: list[Question],
    index: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    most: int | None = None,
) -> int:
    """Ask questions about all intervals, dividing them until all are decided; return how many there were."""

    def judge(index, a, b, precise):
        view = View(loops, index, a, b, precise)
        undecided, noisy = np.zeros(len(index), dtype=bool), np.zeros(len(index), dtype=bool)
        for question in questions:
            open_, doubtful = question.judge(view)
            undecided |= open_
            noisy |= open_ & doubtful
        for question in questions:
            question.take(view, ~undecided)
        return undecided, noisy, loops.longest[index]

    peaked = next((question for question in questions if question.place is not None), None)

    def divide(index, a, b, pieces):
        if peaked is None:
            return divided(index, a, b, pieces)
        about = (a < peaked.place[index]) & (peaked.place[index] < b)
        others = divided(*(x[~about] for x in (index, a, b, pieces)))
        near = divided_about(peaked.place, *(x[about] for x in (index, a, b)))
        return tuple(np.concatenate(x) for x in zip(others, near, strict=True))

    names = " and ".join(question.name for question in questions)
    return walk(judge, index, a, b, names, loops.unit, loops.exact is not None, divide, most)


def wider(loops: Loops, done: np.ndarray) -> np.ndarray:
    """The end of the next window of frequency: four times as far, or so far that dead times turn by 20 rad."""
    with np.errstate(divide="ignore"):
        return np.maximum(4 * done, done + np.where(loops.longest > 0, 20 / loops.longest, 0))


def steps(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals from start to end, in geometric steps, for each loop for which the end is the larger one."""
    points = np.flatnonzero(end > start)
    index, a, b = geometric(start[points], end[points])
    some = a >= start[points[index]]
    return points[index[some]], a[some], b[some]
