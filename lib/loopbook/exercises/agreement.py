"""Whether two formulas are the same but for the rounding of their numbers.

An answer agrees with the key where it has the key's values at all points, or where it has those of the key with other
numbers, each of them at most the fraction `within` from its own; or where the answer itself, with its numbers changed
by no more than that, has the values of the key. So a formula of any form may have rounded numbers, and one with a wrong
number is wrong, however little of it is seen at one point. An answer without a value where the key has one does not
agree.

In functions of time, numbers that are added may be rounded to the same decimal: a term may be off by half of `within`
of the largest of those that change, too. Near a moment at which the key jumps, as near as this moment may be off, the
values do not count.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.optimize

from loopbook.exercises.arithmetic import Decimals, worked_out
from loopbook.exercises.formulas import Formula
from loopbook.exercises.freedoms import Freedom, freedoms, switches

#: The fraction by which forms of one expression differ: their digits may cancel.
EXACT = 1e-9
#: With the best numbers, values differ by no more than this share of `within`.
LEFT = 0.02
#: The key of a mistake must have a value at this part of the points.
ENOUGH = 0.3
#: Numbers are sought where all of them together change a value by no more than this part of it.
CALM = 0.7
#: So many steps to the best numbers, from the nominal ones.
STEPS = 8
#: A formula of more numbers than these is compared as it stands.
MOST_NUMBERS = 40
#: The numbers of an answer may change its values by so many times what those of the key may change.
MORE_THAN_KEY = 2
#: By this fraction numbers are changed to see what they do.
_STEP = 1e-5

Difference = Callable[[np.ndarray, np.ndarray], np.ndarray]


@np.errstate(all="ignore")
def agree(key: Formula, given: Formula, points: Mapping[str, np.ndarray], within: float) -> bool:
    """Whether a formula is the key but for its numbers, each of which may be off by a fraction of it.

    Arguments:
        key, given: `Formula` in the same symbols.
        points: {symbol: array of values}, where the key has values.
        within: the fraction; 0 for an exact formula.

    >>> from loopbook.exercises.points import points_for
    >>> key = Formula("2*exp(-8*s)/(10*s + 1)", "s")
    >>> given = ("0.2*exp(-8.01*s)/(s + 0.1)", "2*exp(-8.2*s)/(10*s + 1)", "2*exp(-8*s)/(10.3*s + 1)")
    >>> [agree(key, Formula(one, "s"), points_for(key), within=0.01) for one in given]
    [True, False, False]
    """
    s = points.get("s")
    is_seen = np.True_ if s is None else np.real(s) >= 0  # on the left, forms of one function cancel
    return _agree(key, given, points, within, _ratio, is_seen)


@np.errstate(all="ignore")
def agree_in_time(key: Formula, given: Formula | np.ndarray, points: Mapping[str, np.ndarray], within: float) -> bool:
    """Whether a function of time is the key but for its numbers, each of which may be off by a fraction of it.

    Arguments:
        key: `Formula` in t.
        given: the same, or the values of a function at the times.
        points: {"t": array of times}.

    >>> points = {"t": np.linspace(0.01, 20, 50)}
    >>> key = Formula("2 - 2*exp(-t/5) + 0.0337*exp(-t)", "t")
    >>> given = ("2 - 2*exp(-t/5.04) + 0.03*exp(-t)", "2 - 2*exp(-t/5.2) + 0.0337*exp(-t)")
    >>> [agree_in_time(key, Formula(one, "t"), points, within=0.01) for one in given]
    [True, False]
    """
    expected = key.values_at(points)
    if not np.isfinite(expected).any():
        return False
    largest = np.nanmax(np.abs(expected))
    size = np.nanmax(np.abs(expected - np.nanmean(expected)))
    measure = InTime(size if size > EXACT * largest else largest or 1.0)
    return _agree(key, given, points, within, measure, np.True_, ~near_switches(key, points, within))


def _agree(key, given, points, within, difference, is_seen, counts=np.True_):
    """Whether values agree at all points that count.

    Arguments:
        is_seen: where an answer may differ from the key no more than some rounding of its numbers does.
    """
    expected = key.values_at(points)
    known = np.isfinite(expected)
    if np.mean(known) < ENOUGH:
        return False

    def agrees_at(known, found):
        if not np.isfinite(found[known]).all():
            return False
        known, left = known & counts, max(LEFT * within, EXACT)
        if np.all(np.abs(difference(found, expected))[known] <= left):
            return True
        if within == 0 or not known.any():
            return False
        of_key = Rounded.of(key, points, within, difference)
        if of_key.reaches(found, known, left):
            return True
        if isinstance(given, np.ndarray):
            return False
        off, near = np.abs(difference(found, expected)), known & is_seen & (of_key.reach < CALM)
        if np.any(off[near] > MORE_THAN_KEY * (of_key.reach[near] + within)):
            return False
        return Rounded.of(given, points, within, difference).reaches(expected, known, left)

    if isinstance(given, np.ndarray):
        return agrees_at(known, given)
    found, told = given.told_at(points)
    if not agrees_at(known & told, found):
        return False
    return bool(told.all()) or agrees_at(known, given.values_at(points))


def _ratio(one, other):
    return np.where(one == other, 0, np.log(one / other))


@dataclass(frozen=True)
class InTime:
    """The difference of two values beside the size of a function."""

    size: float

    def __call__(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """The difference of two values."""
        return (one - other) / self.size


def near_switches(key: Formula, points: Mapping[str, np.ndarray], within: float) -> np.ndarray:
    """Where a step, limiter or piece of a formula may begin or not, with its numbers off by a fraction."""
    shape = np.broadcast_shapes(*(np.shape(values) for values in points.values()))
    near = np.zeros(shape, bool)
    for switch in switches(key.tree):
        nominal = np.real(worked_out(switch, Decimals(points)))
        reach = sum(
            np.abs(np.real(worked_out(switch, Decimals(points), {id(one.node): 1 + within})) - nominal)
            for one in freedoms(switch)
        )
        near = near | (np.abs(nominal) <= reach)
    return near


class Rounded:
    """A formula whose numbers may be off, each by a fraction of it.

    Arguments:
        difference: how the difference of two values is measured.

    Attributes:
        slopes: the difference that each number makes when it is off by as much as it may, at each point.
        reach: the difference that all of them together may make.
    """

    def __init__(self, formula: Formula, points: Mapping[str, np.ndarray], within: float, difference: Difference):
        self.formula, self.points, self.difference = formula, points, difference
        self.values = formula.told_at(points)[0]
        found = [one for one in freedoms(formula.tree) if not one.decides]
        self.numbers = found if len(found) <= MOST_NUMBERS else []
        self.bounds = np.array([self._bound(one, within) for one in self.numbers])
        self.slopes = np.zeros((0, *self.values.shape))
        if self.numbers:
            steps = _STEP * np.eye(len(self.numbers)) / self.bounds
            up, down = np.split(self.changed(np.concatenate([steps, -steps])), 2)
            slopes = difference(up, down) / (2 * _STEP) * self.bounds[(...,) + (None,) * self.values.ndim]
            self.slopes = np.where(np.isfinite(slopes), slopes, np.inf)
        self.reach = np.sum(np.abs(self.slopes), axis=0)

    @classmethod
    def of(cls, formula: Formula, points: Mapping[str, np.ndarray], within: float, difference: Difference) -> Rounded:
        """The same, kept with the formula: an answer is compared with many others."""
        for known, *how, one in formula.rounded:
            if known is points and how == [within, difference]:
                return one
        one = cls(formula, points, within, difference)
        formula.rounded[:] = [*formula.rounded[-3:], (points, within, difference, one)]
        return one

    def _bound(self, one: Freedom, within: float) -> float:
        """By which fraction a number may be off; in time, one that is added also by half of that of the largest."""
        if "t" not in self.points or not one.beside:
            return within
        sizes = {}
        for term in one.beside:
            values = np.broadcast_to(worked_out(term, Decimals(self.points)), self.values.shape)
            sizes[id(term)] = np.ptp(values.real) or np.max(np.abs(values)), not np.ptp(values.real)
        own, is_constant = sizes.get(id(one.node), (0, False))
        largest = max((size for size, constant in sizes.values() if is_constant or not constant), default=0)
        return max(within, within / 2 * largest / own) if own and np.isfinite(largest / own) else within

    def changed(self, shares: np.ndarray) -> np.ndarray:
        """Its values with other numbers: in a row those for a row of shares of what they may be off by."""
        axes = (slice(None),) + (None,) * self.values.ndim
        factors = {id(one.node): 1 + (shares[:, k] * self.bounds[k])[axes] for k, one in enumerate(self.numbers)}
        return np.broadcast_to(self.formula.changed(factors, self.points), (len(shares), *self.values.shape))

    def reaches(self, target: np.ndarray, known: np.ndarray, left: float) -> bool:
        """Whether it has the values of another formula with some of its numbers, up to what may be left."""
        calm = known & (self.reach < CALM)
        off = self.difference(target, self.values)
        if not (self.numbers and calm.any() and np.all(np.abs(off[calm]) <= 1.5 * self.reach[calm] + left)):
            return False
        slopes = self.slopes[:, calm].T
        system, best = np.concatenate([slopes.real, slopes.imag]), np.zeros(len(self.numbers))
        for _ in range(STEPS):
            wanted = np.concatenate([off.real[calm], off.imag[calm]]) + system @ best
            best = _within_bounds(system, wanted)
            off = self.difference(target, self.changed(best[None])[0])
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
    return scipy.optimize.lsq_linear(system, wanted, (-1, 1), method="bvls", tol=1e-12).x
