"""Whether two formulas are the same but for the rounding of their numbers.

An answer agrees with the key where it has the key's values at all points, or where it has those of the key with other
numbers, each of them at most the fraction `within` from its own; or where the answer itself, with its numbers changed
by no more than that, has the values of the key. So a formula of any form may have rounded numbers, and one with a wrong
number is wrong, however little of it is seen at one point. An answer without a value where the key has one does not
agree.

In functions of time, numbers that are added may be rounded to the same decimal, that to which the largest of them is
known: beside 2, known to 0.02, a 0.0337 may be 0.03. Near a moment at which the key jumps, as near as this moment may
be off, the values do not count.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exercisebook.arithmetic import Decimals, worked_out
from exercisebook.formulas import Formula
from exercisebook.freedoms import freedoms, switches
from exercisebook.points import moments_of
from exercisebook.rounding import InRatio, InTime, Measure, Rounded

#: The fraction by which forms of one expression differ: their digits may cancel.
EXACT = 1e-9
#: With the best numbers, values differ by no more than this share of `within`; functions of time by no more than the
#: second of it, and one that is given by its values, which may be of a simulation, by the third.
LEFT, LEFT_IN_TIME, LEFT_OF_VALUES = 0.02, 0.005, 0.1
#: A function of time is as large as it becomes soon, in this part of the times, and at least this part of the whole.
SOON, SLIGHT = 0.1, 1e-6
#: The key of a mistake must have a value at this part of the points.
ENOUGH = 0.3
#: An answer may differ from the key by so many times what the numbers of the key may change, and `within`; and all of
#: its own numbers together may change it by no more than so many times each of these, or a difference of two large ones
#: would be any number.
MORE_THAN_KEY, REACH_OF_KEY, REACH_OF_WITHIN = 1.5, 2, 4


@np.errstate(all="ignore")
def agree(key: Formula, given: Formula, points: Mapping[str, np.ndarray], within: float) -> bool:
    """Whether a formula is the key but for its numbers, each of which may be off by a fraction of it.

    Arguments:
        key, given: `Formula` in the same symbols.
        points: {symbol: array of values}, where the key has values.
        within: the fraction; 0 for an exact formula.

    >>> from exercisebook.points import points_for
    >>> key = Formula("2*exp(-8*s)/(10*s + 1)", "s")
    >>> given = ("0.2*exp(-8.01*s)/(s + 0.1)", "2*exp(-8.2*s)/(10*s + 1)", "2*exp(-8*s)/(10.3*s + 1)")
    >>> [agree(key, Formula(one, "s"), points_for(key), within=0.01) for one in given]
    [True, False, False]
    """
    s = points.get("s")
    alike = np.True_ if s is None else np.real(s) >= 0  # elsewhere, forms of one function cancel
    comparison = Comparison(key, points, within, InRatio(), max(LEFT * within, EXACT), np.True_, alike)
    return comparison.holds_for(given)


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
    expected, _ = key.told_at(points)
    if not np.isfinite(expected).any():
        return False
    measure = InTime(sizes_in_time(expected, points["t"], isinstance(given, np.ndarray)))
    left = max((LEFT_OF_VALUES if isinstance(given, np.ndarray) else LEFT_IN_TIME) * within, EXACT)
    counts = ~near_switches(key, points, within)
    comparison = Comparison(key, points, within, measure, left, counts, counts)
    if isinstance(given, np.ndarray):
        return comparison.holds_of_values(given)
    return comparison.holds_for(given) and not _has_spike(key, given, points["t"], within)


def sizes_in_time(expected: np.ndarray, times: np.ndarray, is_flat: bool) -> np.ndarray:
    """Return the size of a function beside which a difference counts, at each time: of one that grows, near there.

    Where it is flat, it is the same at all times.
    """
    largest = np.nanmax(np.abs(expected))
    size = np.nanmax(np.abs(expected - np.nanmean(expected)))
    size = float(size if size > EXACT * largest else largest or 1.0)
    if is_flat:
        return np.full(times.shape, size)
    order = np.argsort(times)
    until = np.maximum.accumulate(np.nan_to_num(np.abs(expected[order])))
    soon = np.searchsorted(times[order], times + SOON * times.max(), side="right") - 1
    return np.clip(until[soon], SLIGHT * size, size)


def _has_spike(key, given, times, within):
    """Whether a function leaves the key at a moment of its own, or the values of the key beside a moment of that."""
    points = {"t": np.unique(np.concatenate([times, moments_of(given, times.max())]))}
    found, expected = given.values_at(points), key.values_at(points)
    measure = InTime(sizes_in_time(expected, points["t"], False))
    allowed = measure.size * (Rounded.of(key, points, within, measure).most + MORE_THAN_KEY * within + EXACT)
    far = np.abs(found - expected) > allowed
    near = near_switches(key, points, within)
    if not np.isfinite(found).all() or far[~near].any():
        return True
    if not far.any():
        return False
    beside = np.linspace(1 - 2.5 * within, 1 + 2.5 * within, 11)
    values = np.real(key.values_at({"t": np.outer(points["t"][near & far], beside)}))
    value, slack = np.real(found[near & far]), allowed[near & far]
    return bool(np.any((value < np.min(values, axis=1) - slack) | (value > np.max(values, axis=1) + slack)))


@dataclass(frozen=True)
class Comparison:
    """The comparison of answers with a key.

    Arguments:
        key, points, within: as of `agree`.
        measure: of the difference of two values.
        left: what may be left of a difference.
        counts: where a difference counts.
        alike: where a rounded answer differs from the key by no more than some rounding of the key does.
    """

    key: Formula
    points: Mapping[str, np.ndarray]
    within: float
    measure: Measure
    left: float
    counts: np.ndarray
    alike: np.ndarray

    def holds_for(self, given: Formula) -> bool:
        """Whether a formula agrees; one that takes many digits is looked at where it takes few at first."""
        found, told = given.told_at(self.points)
        if not self._holds(found, told, given):
            return False
        return bool(told.all()) or self._holds(given.values_at(self.points), np.True_, given)

    def holds_of_values(self, found: np.ndarray) -> bool:
        """Whether the values of a function agree."""
        return self._holds(found, np.True_, None)

    def _holds(self, found, told, given):
        expected = self._of_key()
        known = np.isfinite(expected)
        if np.mean(known) < ENOUGH or not np.isfinite(found[known & told]).all():
            return False
        known = known & told & self.counts
        off = np.abs(self.measure(found, expected))
        if np.all(off[known] <= self.left):
            return True
        if self.within == 0 or not known.any():
            return False
        key = self._rounded(self.key)
        if key.reaches(found, known, self.left):
            return True
        near = known & self.alike & key.calm
        if (
            given is None
            or not given.in_decimals_at(self.points, np.isfinite(expected))
            or np.any(off[near] > MORE_THAN_KEY * (key.reach[near] + self.within))
        ):
            return False
        answer, most = self._rounded(given), REACH_OF_KEY * key.reach[near] + REACH_OF_WITHIN * self.within
        return bool(np.all(answer.reach[near] <= most)) and answer.reaches(expected, known, self.left)

    def _of_key(self):
        """Its values, in many digits only where it has too few without them."""
        few, _ = self.key.told_at(self.points)
        return few if np.mean(np.isfinite(few)) >= ENOUGH else self.key.values_at(self.points)

    def _rounded(self, formula):
        return Rounded.of(formula, self.points, self.within, self.measure)


def near_switches(key: Formula, points: Mapping[str, np.ndarray], within: float) -> np.ndarray:
    """Where a step, limiter or piece of a formula may begin or not, with its numbers off by a fraction."""
    shape = np.broadcast_shapes(*(np.shape(values) for values in points.values()))
    near = np.zeros(shape, bool)
    for switch in switches(key.tree):
        nominal = np.real(worked_out(switch, Decimals(points)))
        # of its terms one is only the scale
        reaches = [
            np.abs(np.real(worked_out(switch, Decimals(points), {id(one.node): 1 + within})) - nominal)
            for one in freedoms(switch, is_switch=True)
        ]
        reach = np.sum(reaches, axis=0) - np.max(reaches, axis=0, initial=0)
        near = near | (np.abs(nominal) <= reach)
    return near
