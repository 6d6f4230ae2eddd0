"""Step responses of many models of one shape at once, by Taylor series in cells that all of them share.

The dead times are multiples of a cell, so that what comes out of a channel is the series of an earlier cell as it is.
The sizes of the last and of the largest coefficients say how exact that is; models for which it is not exact enough are
taken again with shorter cells.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime.channels import ChannelModel
from loopbook.deadtime.echoes import ROUNDED
from loopbook.deadtime.response import Response
from plainmath.validation import real_numbers, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["step_family"]

WORTH = 12  # models of the same dead times that are taken together
SPAN = 3.5  # times the fastest lag that a cell may be long
LEFT_OUT = 1e-16  # the term of exp(SPAN) that is the last
EXACT = 1e-11  # the share of a signal that may be left out or lost by rounding
FAINT = 1e-5  # a signal that much smaller than another is not resolved for its own sake
MOST_CELLS = 1500
MOST_TERMS = 40
MOST_NUMBERS = 20_000_000


def step_family(models: ChannelModel, times: ArrayLike) -> np.ndarray:
    """Return the step responses of many models of the same shape at the same times.

    Arguments:
        models: a `ChannelModel` whose arrays have one more axis, the first, for the models; its `delays` is an array of
            numbers, a row for each model.
        times: an array of times, not negative.
    Returns:
        An array with a row for each model, in it a value for each of the times, at a jump the one after it. The error
        is below 1e-10 of the largest value up to then. Models with the same dead times are taken together, what is too
        stiff or too long for that, one by one.
    Raises:
        ValueError: for arrays that do not fit, or as `Response`.

    >>> import numpy as np
    >>> gains = np.array([1.0, 2.0]).reshape(2, 1, 1)
    >>> one, none, zero = np.ones((2, 1, 1)), np.zeros((2, 1, 0)), np.zeros((2, 1, 1))
    >>> loops = ChannelModel(zero, one, -gains, gains, one, zero, zero, zero, zero, np.ones((2, 1)))
    >>> step_family(loops, [0.5, 1.5]).round(6)   # of gain/(s + gain*exp(-s))
    array([[0.5  , 1.375],
           [1.   , 2.5  ]])
    """
    times = times_from_zero(times)
    delays = real_numbers("delays", models.delays)
    parts = zip(ChannelModel._fields, models[:-1], strict=False)
    models = ChannelModel(*(real_numbers(name, part) for name, part in parts), delays)
    shape = _family_shape(models)
    count = shape[0]
    flat = times.ravel()
    values = np.empty((count, flat.size))
    rows, member = np.unique(delays, axis=0, return_inverse=True)
    member = member.ravel()
    end = flat.max(initial=0.0)
    for number, row in enumerate(rows):
        exact = [Fraction(repr(delay)) for delay in row.tolist()]  # as it is written
        if any(delay <= 0 for delay in exact):
            raise ValueError(f"the delays of the channels are {row.tolist()}: expected positive ones")
        here = np.flatnonzero(member == number)
        group = ChannelModel(*(array[here] for array in models[:-1]), exact)
        found = np.full((len(here), flat.size), math.nan)
        if len(here) >= WORTH:
            found = _shared_cells(group, exact, flat)
        for k in np.flatnonzero(np.isnan(found).any(axis=1)):
            found[k] = Response(ChannelModel(*(array[k] for array in group[:-1]), exact), end)(flat)
        values[here] = found
    return values.reshape(count, *times.shape)


def _family_shape(models):
    """The numbers of models, states and channels, or ValueError where arrays do not fit."""
    shapes = [part.shape for part in models]
    if models.A.ndim == 3 and models.delays.ndim == 2:
        (count, n, _), q = models.A.shape, models.delays.shape[1]
        expected = [(n, n), (n, 1), (n, q), (1, n), (q, n), (1, 1), (1, q), (q, 1), (q, q), (q,)]
        if shapes == [(count, *shape) for shape in expected]:
            return count, n, q
    raise ValueError(f"the arrays of the models have the shapes {shapes}: expected an axis of models before the others")


def _shared_cells(models: ChannelModel, delays: list[Fraction], times: np.ndarray) -> np.ndarray:
    """Return the step responses, a row for each model; a row that is not exact enough is nan.

    Arguments:
        models: arrays with an axis of models before the others.
        delays: of the channels, the same for all of the models.
    """
    count = len(models.A)
    end = float(times.max(initial=0.0))
    values = np.full((count, len(times)), math.nan)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # not exact enough
        speeds = _speeds(models)
    cell = _common(delays) if delays else Fraction(end or 1.0)
    todo = np.flatnonzero(np.isfinite(speeds))
    while len(todo):
        # those that can be taken with the same cells
        pieces = max(1, math.ceil(float(cell) * speeds[todo].min() / SPAN))
        pieces = 2 ** math.ceil(math.log2(pieces))
        length = cell / pieces
        here = todo[speeds[todo] * float(length) <= SPAN]
        todo = np.setdiff1d(todo, here)
        cells = int(Fraction(end) / length) + 1
        back = max((int(delay / length) for delay in delays), default=1)
        numbers = min(back, cells) * len(delays) * MOST_TERMS * len(here)
        if cells > MOST_CELLS or numbers > MOST_NUMBERS:
            break
        members = type(models)(*(array[here] for array in models[:-1]), None)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            found, exact = _follow(members, [int(delay / length) for delay in delays], length, times)
        values[here[exact]] = found[exact]
        again = here[~exact]
        speeds[again] = 2.01 * SPAN / float(length)
        todo = np.union1d(todo, again)
    return values


def _common(delays):
    """The greatest number of which all delays are multiples."""
    below = math.lcm(*(delay.denominator for delay in delays))
    return Fraction(math.gcd(*(int(delay * below) for delay in delays)), below)


def _speeds(models):
    """How fast each model can change, in 1/time, not less than the largest of its eigenvalues."""
    A, B2, C2 = models.A, models.B2, models.C2
    if not A.shape[1]:
        return np.zeros(len(A))
    speeds = np.zeros(len(A))
    for channel in [None, *range(B2.shape[2])]:
        change = 0 if channel is None else B2[:, :, channel, None] * C2[:, None, channel, :]
        for sign in (1, -1) if channel is not None else (1,):
            power = A + sign * change
            scale = abs(power).max(axis=(1, 2)) + 1e-300
            power = power / scale[:, None, None]
            for _ in range(3):
                power = power @ power
            size = np.sqrt((power**2).sum(axis=(1, 2))) ** (1 / 8)
            speeds = np.maximum(speeds, size * scale)
    return speeds


def _follow(models, back, length, times):
    """The values at the times, and for which of the models they are exact enough."""
    h = float(length)
    # the axis of models is the last one
    A, B1, B2, C1, C2, D11, D12, D21, D22 = (np.ascontiguousarray(np.moveaxis(array, 0, -1)) for array in models[:-1])
    n, q, count = len(A), len(back), A.shape[-1]
    terms = next(m for m in range(4, MOST_TERMS + 1) if SPAN**m / math.factorial(m) < LEFT_OUT or m == MOST_TERMS)
    A, B1, B2 = A * h, B1[:, 0] * h, B2 * h
    from_state = np.concatenate([C2, C1]).transpose(1, 0, 2)
    from_channels = np.concatenate([D22, D12]).transpose(1, 0, 2)
    direct = np.concatenate([D21, D11])[:, 0]
    through = [k for k in range(q) if from_channels[k].any()]
    into = [k for k in range(q) if B2[:, k].any()]
    known = times * (1 + float(ROUNDED)) / h
    order = np.argsort(known, kind="stable")
    sorted_cells = known[order].astype(int)
    values = np.empty((len(times), count))
    ring = max(back, default=0)
    past = np.zeros((max(ring, 1), q, terms, count))
    state = np.zeros((n, count))
    x = np.empty((terms, n, count))
    signals = np.empty((terms, q + 1, count))
    scale, left, lost = (np.zeros((q + 1, count)) for _ in range(3))
    last = int(sorted_cells[-1]) if len(times) else 0
    for cell in range(last + 1):
        w = [past[(cell - steps) % ring, k] if cell >= steps else None for k, steps in enumerate(back)]
        x[0] = state
        for m in range(terms - 1):
            change = np.einsum("ijk,jk->ik", A, x[m]) if n else x[m]
            if m == 0:
                change += B1
            for k in into:
                if w[k] is not None:
                    change += B2[:, k] * w[k][m]
            np.divide(change, m + 1, out=x[m + 1])
        if n:
            state = x.sum(axis=0)
            np.einsum("jik,mjk->mik", from_state, x, out=signals)
        else:
            signals[:] = 0.0
        signals[0] += direct
        for k in through:
            if w[k] is not None:
                signals += from_channels[k] * w[k][:, None]
        if ring:
            past[cell % ring] = signals[:, :q].transpose(1, 0, 2)
        sizes = abs(signals)
        np.maximum(scale, abs(signals.sum(axis=0)), out=scale)
        np.maximum(scale, sizes[0], out=scale)
        here = np.maximum(scale, FAINT * scale.max(axis=0)) + 1e-300
        np.maximum(left, sizes[-2:].max(axis=0) / here, out=left)
        np.maximum(lost, sizes.max(axis=0) / here, out=lost)
        begins, ends = np.searchsorted(sorted_cells, [cell, cell + 1])
        if ends > begins:
            local = times[order[begins:ends]] / h - cell
            values[order[begins:ends]] = np.vander(local, terms, increasing=True) @ signals[:, -1]
    exact = ((left <= EXACT) & (lost * 1e-15 <= EXACT)).all(axis=0) & np.isfinite(values).all(axis=0)
    return values.T, exact
