"""Least squares for many starting points or many fixed values at once, by the method of Levenberg and Marquardt.

SciPy's searches take one problem at a time. Here a problem is a column, and all columns move together, each within
bounds of its own and until it has arrived.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

WIDTH = 1e-7  # of a difference for a derivative
DAMPED, FREE, STUCK = 1e-2, 1e-12, 1e10  # the damping: at first, the least, and when nothing helps
ENOUGH = 1e-15  # a step that lessens a sum by no more than this part is the last
ARRIVED = 1e-11  # a step so short, as a part of a lag or of a sample, is none


def least_squares(
    left: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    *,
    rounds: int = 60,
) -> tuple[np.ndarray, np.ndarray]:
    """Return where each column's sum of squares is least, near its starting point, and these sums.

    Arguments:
        left: what is left of the data, a column of residuals for each column of parameters.
        start: the starting points, a row for each parameter and a column for each problem.
        low, high: bounds of the same shape.
        rounds: the most steps that are tried.

    >>> import numpy as np
    >>> data = np.array([[1.0], [2.0]])
    >>> left = lambda p: data - np.exp(p)
    >>> zero = np.zeros((1, 2))
    >>> found, sums = least_squares(left, zero, zero - 1, np.array([[1.0, 0.2]]))
    >>> np.exp(found).round(4), sums.round(4)
    (array([[1.5   , 1.2214]]), array([0.5   , 0.6552]))
    """
    p = np.clip(start, low, high)
    count, columns = p.shape
    if count == 0:
        return p, (left(p) ** 2).sum(axis=0)
    at_work = np.arange(columns)
    sums, slopes, squares = _described(left, p, low, high)
    damping, best = np.full(columns, DAMPED), p
    diagonal = np.arange(count)
    for _ in range(rounds):
        # a parameter at a bound that would have to leave stays there
        held = ((best <= low) & (slopes.T > 0)) | ((best >= high) & (slopes.T < 0))
        gradient = np.where(held.T, 0.0, slopes)
        matrix = np.where(held.T[:, :, None] | held.T[:, None, :], 0.0, squares)
        size = matrix[:, diagonal, diagonal]
        size = size + 1e-14 * size.max(axis=1, keepdims=True)
        matrix[:, diagonal, diagonal] = np.where(held.T | (size == 0), 1.0, size * (1 + damping[:, None]))
        step = -np.linalg.solve(matrix, gradient[:, :, None])[:, :, 0].T
        tried = np.clip(best + step, low, high)
        step = tried - best
        new, new_slopes, new_squares = _described(left, tried, low, high)
        better = new < sums
        gain = np.where(better, sums - new, 0.0)
        arrived = (abs(step) < ARRIVED).all(axis=0) | (better & (gain <= ENOUGH * sums)) | (damping > STUCK)
        best = np.where(better, tried, best)
        sums = np.where(better, new, sums)
        slopes = np.where(better[:, None], new_slopes, slopes)
        squares = np.where(better[:, None, None], new_squares, squares)
        damping = np.where(better, np.maximum(damping / 8, FREE), damping * 6)
        if arrived.any():
            p[:, at_work[arrived]] = best[:, arrived]
            on = ~arrived
            at_work, best, low, high = at_work[on], best[:, on], low[:, on], high[:, on]
            sums, slopes, squares, damping = sums[on], slopes[on], squares[on], damping[on]
            if not on.any():
                break
    p[:, at_work] = best
    return p, (left(p) ** 2).sum(axis=0)


def _described(left, p, low, high):
    """The sums of squares, half their slopes, and the products of the residuals' derivatives, one after another."""
    count, columns = p.shape
    forward = np.where(p + WIDTH > high, -WIDTH, WIDTH)
    points = np.concatenate([p] + [p + forward * (np.arange(count) == k)[:, None] for k in range(count)], axis=1)
    r = left(points).reshape(-1, count + 1, columns)
    here = r[:, 0]
    derivatives = (r[:, 1:] - here[:, None]) / forward
    slopes = np.einsum("nkc,nc->ck", derivatives, here)
    squares = np.einsum("nkc,nmc->ckm", derivatives, derivatives)
    return (here**2).sum(axis=0), slopes, squares
