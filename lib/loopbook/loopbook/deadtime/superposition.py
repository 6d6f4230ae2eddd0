"""The response to a record of samples as a sum of step responses, in a time that grows with the number of samples.

The record is cut into blocks, these into halves, and so on. Where the step response is one polynomial over all the
differences in time between two blocks, a few numbers of one block, its moments, say what it does to the other; only
where the step response is not smooth, and at the bottom, are its values summed one by one.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.channels import ChannelModel
from loopbook.deadtime.collocation import NODES, interpolation, radau
from loopbook.deadtime.echoes import ROUNDED
from loopbook.deadtime.response import Response
from plainmath.validation import increasing, one_of, real_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["response_to_samples"]

HOLDS = ("zero order", "first order")
SMOOTH = (1e-13, 1e-12)  # shares of the largest value so far by which the step response may differ from a polynomial
FEW = 8  # samples in a block at the bottom, or less
DEEPEST = 16  # times as many blocks as samples
MOST_WORK = 8_000_000  # pairs of samples that are taken one by one, or pairs of blocks, about two seconds
CHUNK = 30_000
MANY = 64  # kernels of one level, above which they are applied by Fourier transform
LEAF = 256  # samples that are taken directly
TEST = 300.0  # pairs that take as long as to look whether a window is smooth
TOUCHED = 40  # segments of the step response that one polynomial may replace
SHARES = (0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99)  # where in each of them it is compared
FAINT = 1e-4  # of the largest value of all: a smaller one is not resolved for its own sake


def response_to_samples(model: ChannelModel, times: ArrayLike, u: ArrayLike, hold: str = "zero order") -> np.ndarray:
    """Return the output at the times of samples of the input, in a time that grows with their number.

    Arguments:
        model: a `ChannelModel`, at rest before the first of the times; the first sample is a step from 0.
        times: an array of times that increase, evenly or not.
        u: the samples, one for each of the times.
        hold: "zero order", each value is kept until the next sample; or "first order", they are joined by straight
            lines.
    Returns:
        An array; the error is about 1e-13 of the largest value.
    Raises:
        ValueError: for arrays that do not fit, another hold, as `Response`; or for uneven times where more than eight
            million pairs of samples had to be taken one by one, as with a step response that jumps hundreds of times.

    >>> import numpy as np
    >>> one = np.ones((1, 1))
    >>> none = np.zeros((1, 0))
    >>> integrator = ChannelModel(0 * one, one, none, one, none.T, 0 * one, none, none.T, none.T @ none, [])
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0])[1:].round(6)
    array([1., 5.])
    >>> response_to_samples(integrator, [0, 1, 3], [1, 2, 0], hold="first order")[1:].round(6)
    array([1.5, 3.5])
    """
    one_of("the hold", hold, HOLDS)
    times, u = increasing("times", times), real_numbers("values of u", u)
    if u.shape != times.shape:
        raise ValueError(f"u has {u.size} values for {times.size} times")
    since = times - times[0]
    response = Response(model, since[-1])
    if len(times) == 1:
        return u * response(since)
    late = float(ROUNDED) * 8 * abs(times).max()
    return _superpose(response, since, u, hold == "first order", late)


def _superpose(response: Response, times: np.ndarray, u: np.ndarray, lines: bool, late: float) -> np.ndarray:
    """Return the values at the times of the response to samples.

    Arguments:
        response: the step response, up to the last of the times.
        times: increasing from 0.
        u: the samples; the first is a step from 0.
        lines: whether they are joined by straight lines, or kept until the next.
        late: how far a difference of times may be from a jump that is meant.
    """
    count, end = len(times), times[-1]
    even = np.linspace(0.0, end, count)
    if abs(times - even).max() <= late:
        return _evenly(response, even, u, lines, late)
    changes = np.diff(u, prepend=0.0)
    # no boundary where a sample or a jump is meant to be
    begin, span = -0.00614 * end, 1.0137 * end
    for smooth in SMOOTH:
        kernel = _Kernel(response, span, smooth)
        level, undecided, applied = 0, np.zeros(0, int), []
        work, pairs = 0.0, math.inf
        while True:
            kernels, undecided = kernel.split(undecided, level)
            applied.append(kernels)
            work += 2.0**level * min(len(kernels[0]), MANY) + TEST * (len(kernels[0]) + len(undecided))
            if work > MOST_WORK:
                break
            if 2**level * FEW >= count:
                blocks = ((times - begin) * (2**level / span)).astype(int)
                held = np.bincount(blocks, minlength=2**level).astype(float)
                pairs = sum(float(held[m:] @ held[: 2**level - m]) for m in undecided.tolist())
                deeper = 2.0 ** (level + 1) * min(2 * len(undecided), MANY)
                pairs *= 1.5 if lines else 1.0  # integrals take longer
                if pairs < 2 * deeper or 2**level > DEEPEST * count or max(work, deeper) > MOST_WORK:
                    break
            level += 1
        if max(work, pairs) <= MOST_WORK:
            break
    else:
        raise ValueError(
            f"the step response is at so many times not smooth, or the {count} samples are so uneven, that most pairs "
            f"of samples had to be taken one by one: expected even distances, or a shorter record"
        )
    points, weights, slopes = times, changes, None
    if lines:  # each line in one block
        points = np.union1d(times, begin + span * np.arange(1, 2**level) / 2**level)
        points = points[(points >= 0) & (points <= end)]
        slopes = (changes[1:] / np.diff(times))[np.searchsorted(times, points[:-1], side="right") - 1]
        weights = np.r_[u[0], np.zeros(len(points) - 1)]
    far = _far(applied, times, points, weights, slopes, begin, span, level)
    near = _near(response, undecided, times, points, weights, slopes, begin, span, level, late)
    return far + near


def _evenly(response, times, u, lines, late):
    """The values at times of one distance, by what a pulse of one sample does."""
    piece = _Piece(response, 0.0, times[-1], late, integrate=False)
    step = piece.values(times)
    if not lines:
        return _causal(np.diff(step, prepend=0.0), u)
    # a straight line is a step for each of its moments: means of the step response between samples
    width = times[-1] / (len(times) - 1)
    inside = response.edges[(response.edges > late) & (response.edges < times[-1] - late)] / width
    inside = inside[abs(inside - np.round(inside)) > late / width]
    points = np.union1d(np.arange(len(times)), inside)  # in samples, so that most pieces are exactly one
    nodes, weights = legendre.leggauss(NODES // 2)
    lengths = np.diff(points)
    places = (points[:-1, None] + lengths[:, None] * (nodes + 1) / 2) * width
    integrals = (piece.values(places.ravel()).reshape(places.shape) @ weights) * lengths / 2
    means = np.bincount(points[:-1].astype(int), integrals, len(times) - 1)
    pulses = np.diff(means, prepend=0.0)
    return u[0] * (step - np.r_[0.0, means]) + np.r_[0.0, _causal(pulses, u[1:])]


def _causal(kernel, u):
    """The convolution of two arrays from their beginnings, each value as exact as those up to it are large."""
    from scipy import linalg, signal

    count, result = len(u), np.zeros(len(u))
    size = min(LEAF, count)
    corner = linalg.toeplitz(kernel[:size], np.zeros(size))
    for begins in range(0, count, size):
        number = begins // size
        ends = min(count, begins + size)
        if number:
            reach = size * (number & -number)  # of what came before, as much as fits into a power of two
            ends_there = min(count, begins + reach)
            there = signal.fftconvolve(u[begins - reach : begins], kernel[: reach + ends_there - begins])
            result[begins:ends_there] += there[reach : reach + ends_there - begins]
        length = ends - begins
        result[begins:ends] += corner[:length, :length] @ u[begins:ends]
    return result


class _Kernel:
    """The step response on windows: where it is one polynomial, and the matrices between blocks there."""

    def __init__(self, response, span, smooth):
        self.response, self.span, self.smooth = response, span, smooth
        largest = np.maximum.accumulate(abs(response.coefficients).max(axis=1))
        self.largest = np.maximum(largest, FAINT * largest[-1])

    def split(self, undecided, level):
        """The distances between blocks, in blocks, where there is one polynomial, with its matrices; and the others.

        Arguments:
            undecided: the distances between blocks twice as long for which there is none.
        Returns:
            (distances, matrices, which), and distances. Where a distance comes of two longer ones and only one is
            undecided, `which` is 0 or 1 and says which blocks are concerned, those of an even or an odd number; else 2.
        """
        rule = radau()
        width = self.span / 2**level
        last = self.response.edges[-1]
        if level:
            windows = np.unique((2 * undecided[:, None] + [-1, 0, 1]).ravel())
            windows = windows[(windows >= 0) & (windows < 2**level)]
            decided = np.ones(2 ** (level - 1) + 1, bool)
            decided[undecided], decided[-1] = False, False  # blocks are never as far from each other as the last
            below, above = (~decided[(windows + side) // 2] for side in (-1, 1))
            which = np.where((windows % 2 == 0) | (below & above), 2, np.where(below, 1, 0))
        else:
            windows, which = np.array([0]), np.array([2])
        low, high = (windows - 1) * width, (windows + 1) * width
        edges = self.response.edges
        first, after = np.searchsorted(edges, low, side="right"), np.searchsorted(edges, high)
        inherited = which < 2
        smooth = (windows > 0) & (high <= last) & (after - first <= TOUCHED) | inherited
        places = windows[:, None] * width + width * rule.nodes
        values = np.zeros(places.shape)
        values[smooth] = self.response(np.minimum(places[smooth], last))
        limit = self.smooth * self.largest[np.minimum(after, len(edges) - 1) - 1]
        steep = abs(values @ rule.to_coefficients[-2:].T).max(axis=1) > limit
        smooth &= inherited | ~steep
        for number in np.flatnonzero(smooth & ~inherited & (after > first)):
            ends = np.r_[low[number], edges[first[number] : after[number]], high[number]]
            inner = (ends[:-1, None] + np.diff(ends)[:, None] * SHARES).ravel()
            found = interpolation(inner / width - windows[number]) @ values[number]
            smooth[number] = abs(found - self.response(inner)).max() <= limit[number]
        matrices = (_between() @ values[smooth].T).T.reshape(-1, NODES, NODES)
        return (windows[smooth], matrices, which[smooth]), windows[~smooth]


@functools.cache
def _between():
    """From values on a window to those at the differences of the nodes of two blocks."""
    nodes = radau().nodes
    return interpolation(((nodes[:, None] - nodes) / 2).ravel())


def _far(applied, times, points, weights, slopes, begin, span, depth):
    """What comes by moments."""
    rule = radau()
    halves = [interpolation((rule.nodes + side) / 2) for side in (-1, 1)]
    # moments of the Legendre polynomials at the bottom
    width = span / 2**depth

    def local(moments, block=None):
        place = (moments - begin) / width
        block = place.astype(int) if block is None else block
        return block, 2 * (place - block) - 1

    block, where = local(points)
    moments = np.zeros((2**depth, NODES))
    used = weights != 0
    np.add.at(moments, block[used], legendre.legvander(where[used], NODES - 1) * weights[used, None])
    if slopes is not None:
        middle, _ = local((points[:-1] + points[1:]) / 2)
        integral = np.zeros((len(middle), NODES))
        for ends, sign in ((points[1:], 1), (points[:-1], -1)):
            values = legendre.legvander(local(ends, middle)[1], NODES)
            integral[:, 0] += sign * values[:, 1]
            integral[:, 1:] += sign * (values[:, 2:] - values[:, :-2]) / (2 * np.arange(1, NODES) + 1)
        np.add.at(moments, middle, integral * (slopes * width / 2)[:, None])
    levels = [moments @ rule.to_coefficients]
    for _ in range(depth):
        levels.append(levels[-1][0::2] @ halves[0] + levels[-1][1::2] @ halves[1])
    levels.reverse()
    total = np.zeros((1, NODES))
    for level, (windows, matrices, which) in enumerate(applied):
        if level:
            total = np.stack([total @ halves[0].T, total @ halves[1].T], axis=1).reshape(-1, NODES)
        sources = levels[level]
        if (which == 2).sum() > MANY:
            total += _convolved(windows[which == 2], matrices[which == 2], sources)
            windows, matrices, which = windows[which < 2], matrices[which < 2], which[which < 2]
        for m, matrix, parity in zip(windows.tolist(), matrices, which.tolist(), strict=True):
            begins, step = (m, 1) if parity == 2 else (m + (m + parity) % 2, 2)
            heard = total[begins::step]
            heard += sources[begins - m :: step][: len(heard)] @ matrix.T
    block, where = local(times)
    return (legendre.legvander(where, NODES - 1) * (total @ rule.to_coefficients.T)[block]).sum(axis=1)


def _convolved(windows, matrices, sources):
    from scipy import fft

    count = len(sources)
    size = fft.next_fast_len(2 * count, real=True)
    heard = fft.rfft(sources, size, axis=0)
    result = np.empty((count, NODES))
    kernel = np.zeros((count, NODES))
    for row in range(NODES):
        kernel[windows] = matrices[:, row]
        result[:, row] = fft.irfft((fft.rfft(kernel, size, axis=0) * heard).sum(axis=1), size)[:count]
    return result


def _near(response, windows, times, points, weights, slopes, begin, span, depth, late):
    """What comes one by one: from blocks at those distances at which the step response is not smooth."""
    count = 2**depth
    blocks = ((times - begin) * (count / span)).astype(int)
    middles = points if slopes is None else (points[:-1] + points[1:]) / 2
    sources = np.searchsorted(((middles - begin) * (count / span)).astype(int), np.arange(count + 1))
    total = np.zeros(len(times))
    runs = np.split(windows, np.flatnonzero(np.diff(windows) > 1) + 1) if len(windows) else []
    width = span / count
    for run in runs:
        near, distant = int(run[0]), int(run[-1])
        first = sources[np.clip(blocks - distant, 0, count)]
        after = sources[np.clip(blocks - near + 1, 0, count)]
        piece = _Piece(response, max(0.0, (near - 1.0) * width), (distant + 1.0) * width, late, slopes is not None)
        lengths = after - first + (0 if slopes is None else (after > first))
        steps = np.cumsum(lengths)
        begins = 0
        while begins < len(times):
            done = steps[begins - 1] if begins else 0
            ends = max(begins + 1, int(np.searchsorted(steps, done + CHUNK, side="right")))
            here = slice(begins, ends)
            size = lengths[here]
            offsets = np.r_[0, np.cumsum(size)[:-1]]
            target = np.repeat(np.arange(len(size)), size)
            number = np.arange(len(target)) - offsets[target] + first[here][target]
            ago = times[here][target] - points[number]
            if slopes is None:
                value = piece.values(ago) * weights[number]
            else:
                # the slope before a point, and the one after it, as far as they are of these blocks
                one = np.where(number < after[here][target], slopes[np.minimum(number, len(slopes) - 1)], 0.0)
                other = np.where(number > first[here][target], slopes[np.maximum(number - 1, 0)], 0.0)
                value = piece.integrals(ago) * (one - other)
            total[here] += np.bincount(target, value, len(size))
            begins = ends
    if slopes is not None and weights[0] != 0:  # the step at the beginning
        block = blocks[0]
        here = np.isin(blocks - block, windows)
        total[here] += weights[0] * response(times[here])
    return total


class _Piece:
    """The step response between two moments, and its integral from the first of them."""

    def __init__(self, response, low, high, late, integrate):
        edges = response.edges
        first = max(0, int(np.searchsorted(edges, low, side="right")) - 1)
        after = min(len(edges) - 1, int(np.searchsorted(edges, high)) + 1)
        self.edges = edges[first : after + 1]
        self.coefficients = response.coefficients[first:after].T
        self.late, self.scale = late, 2 / np.diff(self.edges)
        largest = abs(self.coefficients).max()
        if integrate:
            rows = legendre.legint(self.coefficients, lbnd=-1) / self.scale
            self.integral = rows
            self.integral[0] += np.r_[0.0, np.cumsum(rows.sum(axis=0))[:-1]]
        seen = np.flatnonzero((abs(self.coefficients) > 1e-17 * largest).any(axis=1))
        self.coefficients = self.coefficients[: seen.max(initial=0) + 1]

    def _at(self, series, ago):
        index = np.searchsorted(self.edges, ago + self.late, side="right") - 1
        before = index < 0
        index = np.clip(index, 0, len(self.edges) - 2)
        place = (ago - self.edges[index]) * self.scale[index] - 1
        # Clenshaw's recursion
        last = len(series) - 1
        if last == 0:
            return series[0][index], before
        high, low = np.zeros(len(ago)), series[last][index]
        for degree in range(last - 1, -1, -1):
            high, low = (
                low,
                series[degree][index]
                + (2 * degree + 1) / (degree + 1) * place * low
                - (degree + 1) / (degree + 2) * high,
            )
        return low, before

    def values(self, ago):
        value, before = self._at(self.coefficients, ago)
        value[before] = 0.0
        return value

    def integrals(self, ago):
        value, before = self._at(self.integral, ago)
        value[before] = 0.0
        return value
