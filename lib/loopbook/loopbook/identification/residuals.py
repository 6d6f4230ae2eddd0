"""What a simple model leaves of a record, and how well the record tells each of its parameters: standard errors.

The sum of squares of a model with two lags is symmetric in them, so that it is not regular in the lags where they are
equal; it is in their sum and in how equal they are, ``4*T1*T2/(T1 + T2)**2``, a number from 0 to 1. (Both count from
the shortest lag that is looked for.)
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.identification.zero_order_hold import DrivenChain, _accumulated

if TYPE_CHECKING:
    from collections.abc import Sequence

SHORTEST = 1 / 20  # lag that is looked for, in steps
LONGEST = 100  # lag that is looked for, in records
DEPENDENT = 1e-9  # a regressor of which so little is left by others is none
EQUAL = 1e-9  # share by which equal lags differ
WIDTH = 1e-5  # of a difference for a standard error
CORRELATED = 0.01  # a smaller p-value says that residuals are not white
MOST = 0.99  # correlation from one sample to the next
NOTHING = 1e-7  # as a part of the measurement's span: what is left is rounding


class Residuals:
    """What a model leaves of the data, as a function of its lags and its dead time; the rest is linear.

    Times count in steps, the measurement in its span, the control signal in its greatest change.

    Arguments:
        chain: the `DrivenChain` of the record.
        target: the measurement, from a level near that of the beginning.
        start: "rest" or "unknown".
        leveled: whether that level is known.
        longest: dead time.
    """

    def __init__(self, chain: DrivenChain, target: np.ndarray, start: str, leveled: bool, longest: float) -> None:
        self.chain, self.target, self.start, self.leveled = chain, target, start, leveled
        lags, longest_lag = chain.lags, LONGEST * len(target)
        self.low = np.array([[], [math.log(SHORTEST)], [math.log(SHORTEST * 1e-3), 0.0]][lags] + [0.0])
        self.high = np.array([[], [math.log(longest_lag)], [math.log(2 * longest_lag), 1.0]][lags] + [longest])
        beside = 0 if leveled else 1
        if start == "unknown":
            beside += chain.lags + chain.integrators
        self.freedom = len(target) - (1 + len(self.low) + beside)

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

    def at(self, p: np.ndarray) -> np.ndarray:
        """What is left, for parameters as the search counts them, in columns."""
        return self.of(self.lags(p), p[-1])

    def of(self, lags: np.ndarray, delay: np.ndarray) -> np.ndarray:
        """What is left, a column for each set of lags and dead time."""
        basis, forced = self._free(lags), self.chain.forced(lags, delay)
        orthonormal = []
        for column in [*basis, forced]:
            size = rest = _norm(column)
            for _ in range(2 if orthonormal else 0):  # twice for rounding, if much was taken away
                for q in orthonormal:
                    column = column - (q * column).sum(axis=0) * q
                rest = _norm(column)
                if (rest > 0.1 * size).all():
                    break
            there = rest > DEPENDENT * size
            orthonormal.append(column * (there / np.where(there, rest, 1.0)))
        left = self.target[:, None]
        for q in orthonormal:
            left = left - (q * left).sum(axis=0) * q
        return np.broadcast_to(left, forced.shape)

    def _free(self, lags):
        """The regressors beside the response to the control signal."""
        if self.start == "rest":
            return [] if self.leveled else [np.ones((len(self.target), 1))]
        free = self.chain.free(lags)
        return [free[:, :, k] for k in range(free.shape[2] - self.leveled)]

    def described(self, p: np.ndarray) -> tuple[dict[str, float], dict[str, float], float, np.ndarray, float]:
        """Parameters and standard errors by name, the standard deviation of what is left, the model's response.

        Last the p-value of `whiteness`. Where it is below `CORRELATED`, the standard errors are those of least squares
        in noise of first order, AR(1), with the coefficient that the residuals have.
        """

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
            curvature = math.exp(p[0]) / 4 / apart
            named[1, 1:3], named[2, 1:3] = [T[0] - SHORTEST, -curvature], [T[1] - SHORTEST, curvature]
        left = self.target - fitted
        deviation = math.sqrt((left**2).sum() / max(self.freedom, 1))
        white, first = whiteness(left) if deviation > NOTHING else (1.0, 0.0)
        sizes = np.linalg.norm(jacobian, axis=0)
        seen = sizes > DEPENDENT * sizes.max()
        errors = np.full(len(names), math.inf)
        Q, R = np.linalg.qr(jacobian[:, seen] / sizes[seen])
        if abs(np.diag(R)).min() > DEPENDENT and self.freedom > 0:
            shares = np.linalg.solve(R.T, (named[:, seen] / sizes[seen]).T)
            errors = deviation * np.linalg.norm(shares, axis=0)
            if white < CORRELATED:
                count = len(left)
                first = min(first + (1 + 3 * first) / count, MOST)  # which a record shows too small (Kendall)
                taken = _sizes(Q, first).sum()  # of the noise, by the fit
                errors = np.sqrt((left**2).sum() / max(count - taken, 1) * _sizes(Q @ shares, first))
            errors[(named[:, ~seen] != 0).any(axis=1) | (abs(named) > 0.1 / EQUAL * (1 + T.sum())).any(axis=1)] = (
                math.inf
            )
        parameters = dict(zip(names, [linear[0], *T, delay], strict=True))
        return parameters, dict(zip(names, errors, strict=True)), deviation, fitted, white

    @property
    def names(self) -> list[str]:
        """Of the lags."""
        return ["T2"] if self.chain.integrators and self.chain.lags else ["T1", "T2"][: self.chain.lags]


def whiteness(left: np.ndarray) -> tuple[float, float]:
    """Return the p-value of the test of Ljung and Box that residuals are white, and their first autocorrelation.

    The test takes as many autocorrelations as a fifth of the record has samples, at most ten: correlated noise, a drift
    and an unmeasured load show in the first ones. Of fewer than ten residuals the p-value is 1.

    >>> rng = np.random.default_rng(1)
    >>> round(whiteness(rng.normal(size=200))[0], 2), whiteness(rng.normal(size=200).cumsum())[0] < 1e-9
    (0.06, True)
    """
    from scipy.special import chdtrc

    count = len(left)
    lags = np.arange(1, min(10, count // 5) + 1)
    correlations = np.array([left[k:] @ left[:-k] for k in lags]) / (left @ left)
    if count < 10:
        return 1.0, 0.0
    portmanteau = count * (count + 2) * (correlations**2 / (count - lags)).sum()
    return float(chdtrc(len(lags), portmanteau)), float(correlations[0])


def _sizes(columns, first):
    """The variance of the product of each column with AR(1) noise of variance one, whose first correlation is given."""
    earlier = _accumulated(np.array([[first]]), columns)[1:]  # each entry and those before it, as far as correlated
    return (columns * (2 * earlier - columns)).sum(axis=0)


def _norm(columns):
    return np.sqrt(np.einsum("nb,nb->b", columns, columns))
