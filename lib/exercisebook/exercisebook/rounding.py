"""A formula whose numbers may be off, and the numbers with which it has the values of another one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from exercisebook.arithmetic import Decimals, worked_out
from exercisebook.formulas import Formula
from exercisebook.freedoms import Freedom, freedoms

#: Numbers are sought where all of them together change the logarithm of a value by no more than this, ...
CALM = 0.7
#: ... and where what a number changes is nearly in proportion to it.
BENT = 0.1
#: So many steps to the best numbers, from the nominal ones.
STEPS = 8
#: A formula of more numbers than these is compared as it stands.
MOST_NUMBERS = 40
#: Two numbers change the values in the same way where the cosine between what they change, seen at no fewer points, is
#: 1 but for this.
ALIKE, FEWEST = 1e-8, 4
#: A term grows that becomes so many times what it is in the first third of the times.
GROWN = 10
#: By this fraction numbers are changed to see what they do.
_STEP = 1e-5


class Measure(Protocol):
    """How the difference of two values is measured, and up to which one numbers are sought."""

    @property
    def most(self) -> float:
        """Up to this difference."""

    def __call__(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """The difference."""


class InRatio:
    """By the logarithm of the ratio, which has no turns where it is small.

    >>> InRatio()(np.array([1.01]), np.array([1.0])).round(4)
    array([0.01])
    """

    most = CALM

    def __call__(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """The difference."""
        return np.where(one == other, 0, np.log(one / other))


class InTime:
    """Beside the size of a function, which may be another one at each time.

    >>> InTime(np.array([20]))(np.array([11.0]), np.array([10.0]))
    array([0.05])
    """

    most = np.inf

    def __init__(self, size: np.ndarray):
        self.size = size

    def __eq__(self, other: object) -> bool:
        """Whether both measure in the same way."""
        return isinstance(other, InTime) and np.array_equal(self.size, other.size)

    __hash__ = None

    def __call__(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """The difference."""
        return (one - other) / self.size


class Rounded:
    """A formula whose numbers may be off, each by a fraction of it.

    Numbers that change the values in the same way, as both of 110*s - 73*s, are off together, as the one number that
    they make.

    Arguments:
        measure: how the difference of two values is measured.

    Attributes:
        slopes: the difference that each number makes when it is off by as much as it may, at each point.
        reach: the difference that all of them together may make; `most`, with what is more than in proportion.
        calm: where these differences tell the numbers, since they are small, and in proportion to what is changed.
    """

    def __init__(self, formula: Formula, points: Mapping[str, np.ndarray], within: float, measure: Measure):
        self.formula, self.points, self.measure = formula, points, measure
        self.values = formula.told_at(points)[0]
        found = [one for one in freedoms(formula.tree) if not one.decides]
        self.numbers = [(one,) for one in found] if len(found) <= MOST_NUMBERS else []
        self.bounds = np.array([self._bound(one, within) for (one,) in self.numbers])
        self._look()
        if merged := self._alike():
            self.numbers = [sum((self.numbers[k] for k in group), ()) for group in merged]
            self.bounds = np.array([min(self.bounds[group]) for group in merged])
            self._look()

    def _look(self):
        """See what the numbers change."""
        count, axes = len(self.numbers), (slice(None),) + (None,) * self.values.ndim
        self.slopes, bent = np.zeros((count, *self.values.shape)), np.zeros(self.values.shape)
        if count:
            steps = _STEP / self.bounds
            shares = np.concatenate([np.diag(steps), np.diag(-steps), np.eye(count), -np.eye(count)])
            more, less, most, least = np.split(self.changed(shares), 4)
            self.slopes = self.measure(more, less) / (2 * steps[axes])
            bent = np.sum(np.abs(self.measure(most, self.values) + self.measure(least, self.values)), axis=0) / 2
        self.reach = np.sum(np.abs(self.slopes), axis=0)
        self.calm = np.isfinite(self.reach) & (self.reach < self.measure.most) & (bent < BENT)
        self.most = 1.5 * self.reach + bent

    def _alike(self):
        """The numbers in groups that change the values in the same way; none where each does so in its own."""
        slopes = self.slopes[:, self.calm] / self.bounds[:, None]
        size = np.linalg.norm(slopes, axis=1)
        if slopes.shape[1] < FEWEST or not np.all(size > 0):
            return []
        groups: list[list[int]] = []
        ways = slopes / size[:, None]
        for k, way in enumerate(ways):
            same = [group for group in groups if abs(np.vdot(ways[group[0]], way)) > 1 - ALIKE]
            if same:
                same[0].append(k)
            else:
                groups.append([k])
        return groups if len(groups) < len(self.numbers) else []

    @classmethod
    def of(cls, formula: Formula, points: Mapping[str, np.ndarray], within: float, measure: Measure) -> Rounded:
        """The same, kept with the formula: an answer is compared with many others."""
        for known, *how, one in formula.rounded:
            if known is points and how == [within, measure]:
                return one
        one = cls(formula, points, within, measure)
        formula.rounded[:] = [*formula.rounded[-3:], (points, within, measure, one)]
        return one

    def _bound(self, one: Freedom, within: float) -> float:
        """By which fraction a number may be off; in time, also by half of the decimal of the largest that is added."""
        if "t" not in self.points or not one.beside:
            return within
        changing, constant = {}, {}
        for term in one.beside:
            values = np.broadcast_to(worked_out(term, Decimals(self.points)), self.values.shape)
            early = values[: len(values) // 3]  # what grows without end is known to the decimal that it begins with
            values = early if np.max(np.abs(values)) > GROWN * np.max(np.abs(early)) else values
            by_place = changing if np.ptp(values.real) else constant
            by_place[id(term)] = np.ptp(values.real) or np.max(np.abs(values))
        others = changing if id(one.node) in changing else changing | constant
        own, largest = others.get(id(one.node), 0), max(others.values(), default=0)
        if not (0 < own < np.inf and largest < np.inf):
            return within
        return max(within, 0.5 * 10 ** np.floor(np.log10(within * largest) + 0.01) / own)

    def changed(self, shares: np.ndarray) -> np.ndarray:
        """Its values with other numbers: in a row those for a row of shares of what they may be off by."""
        axes = (slice(None),) + (None,) * self.values.ndim
        factors = {}
        for share, bound, ones in zip(shares.T, self.bounds, self.numbers, strict=True):
            factors |= dict.fromkeys((id(one.node) for one in ones), 1 + (share * bound)[axes])
        return np.broadcast_to(self.formula.changed(factors, self.points), (len(shares), *self.values.shape))

    def reaches(self, target: np.ndarray, known: np.ndarray, left: float) -> bool:
        """Whether it has the values of another formula with some of its numbers, up to what may be left."""
        calm = known & self.calm
        off = self.measure(target, self.values)
        if not (self.numbers and calm.any() and np.all(np.abs(off[calm]) <= self.most[calm] + left)):
            return False
        slopes = self.slopes[:, calm].T
        system, best = np.concatenate([slopes.real, slopes.imag]), np.zeros(len(self.numbers))
        for _ in range(STEPS):
            wanted = np.concatenate([off.real[calm], off.imag[calm]]) + system @ best
            best = _within_bounds(system, wanted)
            off = self.measure(target, self.changed(best[None])[0])
            if not np.isfinite(off[known]).all():
                return False
            if np.all(np.abs(off[known]) <= left):
                return True
        return False


def _within_bounds(system, wanted):
    """The best solution with no part above 1."""
    best = np.linalg.lstsq(system, wanted, rcond=1e-10)[0]
    if np.all(np.abs(best) <= 1):
        return best
    from scipy.optimize import lsq_linear

    return lsq_linear(system, wanted, (-1, 1), method="bvls", tol=1e-12).x
