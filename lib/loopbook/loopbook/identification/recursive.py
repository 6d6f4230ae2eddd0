"""Least squares as the data come: the estimator of an adaptive controller. (Haugen, Section 10.5.4)

The estimator itself is four lines, and there is none in SciPy or python-control. Libraries of adaptive filters
(padasip) have one for signals; they know neither the covariance nor the way back to a continuous model.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.approximation import SOPDT
from loopbook.types import Number
from plainmath.expressions import exact
from plainmath.validation import number, positive, real_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class RecursiveLeastSquares:
    """Least squares estimate of parameters, y = regressors times parameters, brought up to date with each sample.

    The weight of a sample falls by the forgetting factor with each newer one: with 0.98 about the last 50 count,
    1/(1 - 0.98). Where nothing moves, there is nothing to learn, and a forgetting estimator becomes ever less certain,
    until it is as uncertain as at the beginning: then it forgets no more.

    Arguments:
        count: number of parameters.
        forgetting: forgetting factor, above 0 and at most 1; 1 forgets nothing.
        initial: first estimate, zeros if not given.
        uncertainty: of the first estimate: a large number (in squares of the parameters) if it is only a guess.
    Attributes:
        parameters: the estimate, an array.
        covariance: the uncertainty of the estimate, up to the variance of the noise as a factor; a matrix.
    Raises:
        ValueError: for a count, a forgetting factor or an uncertainty out of range.

    >>> estimator = RecursiveLeastSquares(2)
    >>> for x in (1.0, 2.0, 4.0, 3.0):
    ...     _ = estimator.update([x, 1], y=3 * x + 5)
    >>> estimator.parameters.round(3)
    array([3., 5.])
    """

    parameters: np.ndarray
    covariance: np.ndarray

    def __init__(
        self,
        count: int,
        forgetting: Number = 1.0,
        initial: ArrayLike | None = None,
        uncertainty: Number = 1e6,
    ):
        count = int(number("the number of parameters", count, "1, 2, 3 ...", lambda x: x >= 1 and x == int(x)))
        self.forgetting = number(
            "the forgetting factor", forgetting, "a number above 0 and at most 1", lambda x: 0 < x <= 1
        )
        self.parameters = np.zeros(count) if initial is None else real_numbers("parameters", initial).copy()
        if self.parameters.shape != (count,):
            raise ValueError(f"{self.parameters.size} initial parameters for a count of {count}")
        self.covariance = positive("the uncertainty", uncertainty) * np.eye(count)
        self.largest = self.covariance.trace()

    def update(self, regressors: ArrayLike, y: Number) -> float:
        """Take a sample and return its error, what the estimate so far did not explain."""
        x = real_numbers("regressors", regressors)
        if x.shape != self.parameters.shape:
            raise ValueError(f"{x.size} regressors for {self.parameters.size} parameters")
        error = number("the value of y", y) - x @ self.parameters
        spread = self.covariance @ x
        weight = self.forgetting + x @ spread
        self.parameters = self.parameters + spread / weight * error
        covariance = self.covariance - np.outer(spread, spread) / weight
        covariance = (covariance + covariance.T) / 2  # rounding must not make it less than symmetric
        self.covariance = covariance if covariance.trace() > self.largest else covariance / self.forgetting
        return float(error)

    def __repr__(self) -> str:
        return f"RecursiveLeastSquares(parameters={self.parameters.round(6).tolist()}, forgetting={self.forgetting:g})"


def first_order_of(a: Number, b: ArrayLike, step: Number, whole_delay: int = 0) -> SOPDT:
    """Return the lag with dead time whose samples obey y[k+1] = a y[k] + b0 u[k-n] + b1 u[k-n-1].

    This is the exact relation for a control signal that is held between samples, if the dead time is n steps and a
    part of one: b1 is what the older value still does in that part. A negative b0 or b1, as noise makes one, leaves
    no such model.

    Arguments:
        a: coefficient, above 0 and at most 1; with 1 it is an integrator.
        b: (b0, b1), or b0 alone for a dead time of whole steps.
        step: time between two samples.
        whole_delay: n, how many whole steps the dead time has.
    Returns:
        An `SOPDT`.
    Raises:
        ValueError: for coefficients to which no such model belongs.

    >>> first_order_of(0.9048374180359595, (0.1903251639280810, 0), step=1, whole_delay=3)
    SOPDT(K=2, T1=10, delay=3)
    """
    import sympy

    values = real_numbers("values of b", b)
    if values.shape not in ((), (1,), (2,)):
        raise ValueError(f"b is {b!r}: expected (b0, b1), or b0 alone")
    b0, b1 = (*values.ravel().tolist(), 0.0)[:2]
    a = number("the coefficient a", a, "one above 0 and at most 1", lambda x: 0 < x <= 1)
    step = positive("the step", step)
    whole_delay = number("the whole delay", whole_delay, "0, 1, 2 ... steps", lambda x: x >= 0 and x == int(x))
    if b0 + b1 == 0 or b0 * (b0 + b1) < 0 or b1 * (b0 + b1) < 0:
        raise ValueError(f"b is ({b0:g}, {b1:g}): expected two numbers of the same sign")
    share = b0 / (b0 + b1)
    if a == 1:
        K, T, rest = (b0 + b1) / step, sympy.oo, share * step
    else:
        T = -step / math.log(a)
        K, rest = (b0 + b1) / (1 - a), -T * math.log1p(-share * (1 - a))
    rounded = [x if x == sympy.oo else exact(float(f"{x:.10g}")) for x in (K, T, (whole_delay + 1) * step - rest)]
    return SOPDT(rounded[0], T1=rounded[1], delay=max(rounded[2], sympy.S.Zero))
