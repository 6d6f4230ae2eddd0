"""How well a record tells each parameter of a simple model: standard errors, and intervals by the profile likelihood.

The sum of squares of a model with two lags is symmetric in them, so that it is not regular in the lags where they are
equal; it is in their sum and in how equal they are, ``4*T1*T2/(T1 + T2)**2``, a number from 0 to 1. (Both count from
the shortest lag that is looked for.) A profile is the
least sum of squares for each value of one parameter, whatever the others are then.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.identification.search import least_squares
from loopbook.identification.zero_order_hold import DrivenChain

if TYPE_CHECKING:
    from collections.abc import Sequence

SHORTEST = 1 / 20  # lag that is looked for, in steps
LONGEST = 100  # lag that is looked for, in records
DEPENDENT = 1e-9  # a regressor of which so little is left by others is none
EQUAL = 1e-9  # share by which equal lags differ
WIDTH = 1e-5  # of a difference for a standard error
MARCH = (0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.5, 6.0)  # standard errors at which a profile is looked at
FURTHER = 1.6  # factor from there on
MORE = 8  # values at once, from there on
INSIDE = 5  # values between the last that fits and the first that does not
ZOOMS = 2
SHARES = (0.9, 0.2)  # of a shorter lag in the longer one, from which the search begins, too
MOST_STEPS = 80  # of the march
ROUNDS, ENOUGH = 25, 1e-6  # of the search for the other parameters


class Residuals:
    """What a model leaves of the data, as a function of its lags and its dead time; the rest is linear.

    Times count in steps, the measurement in its span, the control signal in its greatest change.

    Arguments:
        chain: the `DrivenChain` of the record.
        target: the measurement, from a level near that of the beginning.
        start: "rest" or "unknown".
        leveled: whether that level is known.
        longest: dead time.
        units: of the parameters, by name.
    """

    def __init__(
        self, chain: DrivenChain, target: np.ndarray, start: str, leveled: bool, longest: float, units: dict[str, float]
    ) -> None:
        self.chain, self.target, self.start, self.leveled, self.units = chain, target, start, leveled, units
        self.longest_lag = LONGEST * len(target)
        lags = chain.lags
        self.low = np.array([[], [math.log(SHORTEST)], [math.log(SHORTEST * 1e-3), 0.0]][lags] + [0.0])
        self.high = np.array(
            [[], [math.log(self.longest_lag)], [math.log(2 * self.longest_lag), 1.0]][lags] + [longest]
        )
        beside = 0 if leveled else 1
        if start == "unknown":
            beside += chain.lags + chain.integrators
        self.numbers = 1 + len(self.low) + beside
        self.freedom = len(target) - self.numbers

    def lags(self, p: np.ndarray) -> np.ndarray:
        """The lags, the longest first, of parameters as the search counts them, in columns."""
        if self.chain.lags < 2:
            return np.exp(p[:-1])
        together, alike = np.exp(p[0]), p[1]
        longer = together / 2 * (1 + np.sqrt(1 - alike))
        shorter = together * alike / 2 / (1 + np.sqrt(1 - alike))
        return SHORTEST + np.array([longer, shorter])

    def counted(self, lags: Sequence[float | np.ndarray]) -> list[float | np.ndarray]:
        """The other way round: what the search counts instead of lags, numbers or arrays."""
        if len(lags) < 2:
            return [np.log(T) for T in lags]
        longer, shorter = (T - SHORTEST for T in lags)
        together = longer + shorter
        return [np.log(together), 4 * longer * shorter / together**2]

    def at(self, p: np.ndarray, which: np.ndarray | None = None) -> np.ndarray:
        """What is left, for parameters as the search counts them, in columns."""
        return self.of(self.lags(p), p[-1])

    def of(self, lags: np.ndarray, delay: np.ndarray, K: np.ndarray | None = None) -> np.ndarray:
        """What is left, a column for each set of lags and dead time, and gain if it is given."""
        target = self.target[:, None]
        basis, forced = self._free(lags), self.chain.forced(lags, delay)
        orthonormal = []
        if K is not None:
            target = target - K * forced
        for column in [*basis, *([forced] if K is None else [])]:
            size = rest = _norm(column)
            for _ in range(2 if orthonormal else 0):  # twice for rounding, if much was taken away
                for q in orthonormal:
                    column = column - (q * column).sum(axis=0) * q
                rest = _norm(column)
                if (rest > 0.1 * size).all():
                    break
            there = rest > DEPENDENT * size
            orthonormal.append(column * (there / np.where(there, rest, 1.0)))
        left = target
        for q in orthonormal:
            left = left - (q * left).sum(axis=0) * q
        return np.broadcast_to(left, forced.shape)

    def _free(self, lags):
        """The regressors beside the response to the control signal."""
        if self.start == "rest":
            return [] if self.leveled else [np.ones((len(self.target), 1))]
        free = self.chain.free(lags)
        return [free[:, :, k] for k in range(free.shape[2] - self.leveled)]

    def described(self, p: np.ndarray) -> tuple[dict[str, float], dict[str, float], float, np.ndarray]:
        """Parameters and standard errors by name, the standard deviation of what is left, and the model's response."""

        def response(p, linear=None):
            lags = self.lags(p[:, None])
            columns = np.column_stack([self.chain.forced(lags, p[-1:]), *self._free(lags)])
            if linear is None:
                linear = np.linalg.lstsq(columns, self.target, rcond=None)[0]
            return columns, linear

        columns, linear = response(p)
        fitted = columns @ linear
        T, delay = self.lags(p[:, None])[:, 0], p[-1]
        changes = []
        for k in range(len(p)):
            width = WIDTH * (max(delay, T.max(initial=1.0)) if k == len(p) - 1 else 1.0)
            ahead, behind = p.copy(), p.copy()
            ahead[k], behind[k] = min(p[k] + width, self.high[k]), max(p[k] - width, self.low[k])
            if len(T) == 2 and k == 1 and T[1] < 1:  # so short that it is hardly seen: as if it were longer
                behind[k], ahead[k] = min(p[k], 1 - width), min(p[k] + 2 / T.sum(), 1.0)
            changes.append((response(ahead, linear)[0] - response(behind, linear)[0]) @ linear / (ahead[k] - behind[k]))
        jacobian = np.column_stack([columns[:, :1], *changes, columns[:, 1:]])
        names = ["K", *self.names, "delay"]
        # how the named parameters depend on those of the search
        named = np.eye(len(names), jacobian.shape[1])
        if len(T) == 1:
            named[1, 1] = T[0]
        elif len(T) == 2:
            apart = max(math.sqrt(1 - p[1]), EQUAL)
            bend = math.exp(p[0]) / 4 / apart
            named[1, 1:3], named[2, 1:3] = [T[0] - SHORTEST, -bend], [T[1] - SHORTEST, bend]
        variance = ((self.target - fitted) ** 2).sum() / max(self.freedom, 1)
        sizes = np.linalg.norm(jacobian, axis=0)
        seen = sizes > DEPENDENT * sizes.max()
        errors = np.full(len(names), math.inf)
        _, R = np.linalg.qr(jacobian[:, seen] / sizes[seen])
        if abs(np.diag(R)).min() > DEPENDENT and self.freedom > 0:
            shares = np.linalg.solve(R.T, (named[:, seen] / sizes[seen]).T)
            errors = math.sqrt(variance) * np.linalg.norm(shares, axis=0)
            errors[(named[:, ~seen] != 0).any(axis=1) | (abs(named) > 0.1 / EQUAL * (1 + T.sum())).any(axis=1)] = (
                math.inf
            )
        parameters = dict(zip(names, [linear[0], *T, delay], strict=True))
        return parameters, dict(zip(names, errors, strict=True)), math.sqrt(variance), fitted

    @property
    def names(self) -> list[str]:
        """Of the lags."""
        return ["T2"] if self.chain.integrators and self.chain.lags else ["T1", "T2"][: self.chain.lags]


def _norm(columns):
    return np.sqrt(np.einsum("nb,nb->b", columns, columns))


class _Profile:
    """The least sum of squares for given values of one parameter."""

    def __init__(self, residuals, name, best):
        """The best parameters, by name, all in the units of the residuals."""
        self.residuals, self.name = residuals, name
        self.best, self.longest_lag = best, residuals.longest_lag
        low, high = residuals.low, residuals.high
        if name == "delay":
            low, high = low[:-1], high[:-1]
            self.bottom, self.top = 0.0, residuals.high[-1]
        elif name == "K":
            self.bottom, self.top = -math.inf, math.inf
        else:
            self.bottom, self.top = math.log(SHORTEST), math.log(self.longest_lag)
            low, high = low[-1:], high[-1:]
            if residuals.chain.lags == 2:  # T2 as a part of T1; or T1 by how many times it is longer
                low = np.array([0.0, *low])
                high = np.array([1.0 if name == "T1" else math.log(self.longest_lag / SHORTEST), *high])
        self.low, self.high = low[:, None], high[:, None]

    def starts(self, values):
        """Places from which to look for the other parameters: as they are at the best, and others as late in all.

        What a record tells first is how late the response is in all, the sum of dead time and lags.
        """
        own = [self.best[n] for n in self.residuals.names]
        total, delay = self.best["delay"] + sum(own), self.best["delay"]
        places = [(own, delay)]
        if self.name in ("K", "delay"):
            late = total - (values if self.name == "delay" else delay)
            if len(own) == 2:
                places += [([late / (1 + share), late * share / (1 + share)], delay) for share in SHARES]
            elif len(own) == 1:
                places.append(([late], delay))
        elif len(own) == 2:
            T = np.exp(values)
            pairs = [[T, share * T] if self.name == "T1" else [T / share, T] for share in SHARES]
            places += [(pair, total - sum(pair)) for pair in pairs]
        else:
            places.append((own, total - np.exp(values)))
        return [self._counted(lags, delay, values) for lags, delay in places]

    def _counted(self, lags, delay, values):
        """The parameters that are free, as the search counts them, from all of them."""
        lags = [np.maximum(T, 1.01 * SHORTEST) for T in lags]
        if self.name in ("K", "delay"):
            free = self.residuals.counted(lags)
        elif len(lags) == 1:
            free = []
        elif self.name == "T1":
            free = [(lags[1] - SHORTEST) / (lags[0] - SHORTEST)]
        else:
            free = [np.log(lags[0] / np.exp(values))]
        free = free if self.name == "delay" else [*free, delay]
        return np.array([x * np.ones_like(values) for x in free]).reshape(len(free), len(values))

    def left(self, p, values):
        of = self.residuals
        if self.name == "K":
            return of.of(of.lags(p), p[-1], K=values)
        if self.name == "delay":
            return of.of(of.lags(np.vstack([p, values])), values)
        T = np.exp(values)
        if of.chain.lags == 1:
            return of.of(T[None], p[-1])
        if self.name == "T1":
            return of.of(np.array([T, SHORTEST + p[0] * (T - SHORTEST)]), p[-1])
        return of.of(np.array([np.minimum(T * np.exp(p[0]), self.longest_lag), T]), p[-1])

    def sums(self, values, near=None, everywhere=True):
        """The least sums for these values, and where they are; from several starts each, the better one."""
        starts = [*(self.starts(values) if everywhere else []), *([] if near is None else [near])]
        columns, count = np.arange(len(values)), len(starts)

        def search(start, taken):
            wide = np.ones((1, len(taken)))
            return least_squares(
                lambda p, which: self.left(p, taken[which]), start, self.low * wide, self.high * wide, rounds=ROUNDS,
                enough=ENOUGH,
            )  # fmt: skip

        found, sums = search(np.concatenate(starts, axis=1), np.tile(values, count))
        best = sums.reshape(count, -1).argmin(axis=0) * len(values) + columns
        found, sums = found[:, best], sums[best]
        if len(found):  # a neighbour may have found a better place
            shifted = np.clip([columns - 1, columns + 1], 0, len(values) - 1).ravel()
            both = np.tile(columns, 2)
            promising = (self.left(found[:, shifted], values[both]) ** 2).sum(axis=0) < sums[both] * (1 - ENOUGH)
            if promising.any():
                others, theirs = search(found[:, shifted[promising]], values[both[promising]])
                for k, place, found_sum in zip(both[promising], others.T, theirs, strict=True):
                    if found_sum < sums[k]:
                        found[:, k], sums[k] = place, found_sum
        return sums, found


def interval(
    residuals: Residuals, name: str, parameters: dict[str, float], errors: dict[str, float], level: float
) -> tuple[float, float]:
    """Return the values of one parameter whose profile does not exceed the least sum of squares by too much.

    Arguments:
        residuals: of the record.
        name: of the parameter.
        parameters, errors: the best ones and their standard errors, by name.
        level: the probability that the interval holds the true value.
    """
    from scipy.special import stdtrit  # scipy.stats takes a second to import

    units = residuals.units
    best = {key: value / units[key] for key, value in parameters.items()}
    T = np.array([[best[n]] for n in residuals.names]).reshape(-1, 1)
    least = (residuals.of(T, np.array([best["delay"]])) ** 2).sum()
    limit = least * (1 + stdtrit(residuals.freedom, (1 + level) / 2) ** 2 / residuals.freedom)
    if not least > 0:
        return parameters[name], parameters[name]
    profile = _Profile(residuals, name, best)
    is_lag = name.startswith("T")
    centre = math.log(best[name]) if is_lag else best[name]
    error = errors[name] / units[name]
    error = error / best[name] if is_lag else error
    usual = 0.3 if is_lag else 0.3 * abs(centre) if name == "K" else 1.0
    error = usual if not math.isfinite(error) or error <= 0 else min(error, 3 * usual + abs(centre))
    ends = []
    for side, end in ((-1, profile.bottom), (1, profile.top)):
        ends.append(_end(profile, centre, error * side, end, least, limit))
    if is_lag:
        ends = [
            0.0 if ends[0] <= profile.bottom else math.exp(ends[0]),
            math.inf if ends[1] >= profile.top else math.exp(ends[1]),
        ]
    return tuple(float(x * units[name]) for x in ends)


def _end(profile, centre, error, bound, least, limit):
    """Where, on one side, the profile last exceeds the limit; or the bound."""

    def looked_at(values, near, everywhere):
        sums, places = profile.sums(values, near, everywhere)
        excess = np.sqrt(np.maximum(sums - least, 0) / (limit - least)) - 1  # -1 at the best, 0 at the limit
        fits = np.flatnonzero(excess < 0)
        return excess, places, fits[-1] if len(fits) else -1

    inner, inner_excess, inner_place = centre, -1.0, profile.starts(np.array([centre]))[0][:, 0]
    steps = np.array(MARCH)
    while True:
        values = np.clip(centre + steps * error, min(bound, centre), max(bound, centre))
        values = np.unique(values)[:: 1 if error > 0 else -1]
        excess, places, last = looked_at(values, np.repeat(inner_place[:, None], len(values), axis=1), True)
        if last >= 0:
            inner, inner_excess, inner_place = values[last], excess[last], places[:, last]
        if last + 1 < len(values):
            outer, outer_excess, outer_place = values[last + 1], excess[last + 1], places[:, last + 1]
            break
        if inner == bound or steps[-1] > FURTHER**MOST_STEPS:
            return bound
        steps = steps[-1] * FURTHER ** np.arange(1, MORE + 1)
    for _ in range(ZOOMS):
        share = (np.arange(INSIDE) + 1) / (INSIDE + 1)
        values = inner + share * (outer - inner)
        excess, places, last = looked_at(
            values, inner_place[:, None] + share * (outer_place - inner_place)[:, None], False
        )
        if last + 1 < INSIDE:
            outer, outer_excess, outer_place = values[last + 1], excess[last + 1], places[:, last + 1]
        if last >= 0:
            inner, inner_excess, inner_place = values[last], excess[last], places[:, last]
    return inner + (outer - inner) * inner_excess / (inner_excess - outer_excess)
