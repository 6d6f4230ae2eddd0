"""Responses in time of a state-space model with delay channels."""

import functools
import itertools
import math
from fractions import Fraction
from typing import NamedTuple

from loopbook.inputs import times_from_zero

NODES = 20  # where a segment of a response is known, so that it is a polynomial of degree 19
REACH = 4.0  # how many times the fastest lag a segment may be long
RESOLVED = 1e-12  # the share of a response that its last two coefficients may have
ROUNDED = Fraction(1, 2**48)  # by how much, as a share of them, two moments that are meant to be one may differ
MOST_SEGMENTS = 200_000
MOST_LENGTHS = 200  # of segments whose propagation is kept


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: object
    B1: object
    B2: object
    C1: object
    C2: object
    D11: object
    D12: object
    D21: object
    D22: object
    delays: list


class Response:
    """The step response of a state-space model with delay channels: polynomials between points of discontinuity.

    Where a delayed signal is not smooth, and what comes back from there, is known exactly: at the sums of the dead
    times. Between two such points a signal is smooth, and what comes out of a channel is known from earlier. The state
    follows by Gauss collocation, in segments short enough for polynomials of degree 19.

    Arguments:
        model: a `ChannelModel`; its input is a unit step.
        end: the time up to which the response is wanted.
    Attributes:
        edges: the ends of the segments, an array; the last one is at `end` or later.
    """

    def __init__(self, model, end):
        import numpy

        try:
            end = float(end)
        except (TypeError, ValueError):
            raise ValueError(f"the end is {end!r}: expected a number") from None
        if not 0 <= end < math.inf:
            raise ValueError(f"the end is {end}: expected a finite time, zero or later")
        speed = _speed(model)
        for _ in range(6):
            with numpy.errstate(over="ignore", invalid="ignore"):  # said in words below
                self.edges, self._coefficients, tail = _collocate(model, end, speed)
            if tail <= RESOLVED:
                return
            if tail == math.inf:
                raise ValueError(f"the response grows beyond all numbers before t = {end:g}")
            speed = 2 * max(speed, 1 / max(end, 1e-300))
        raise ValueError(f"the response up to t = {end:g} is not resolved: {tail:.0e} of it is left")

    def __call__(self, times):
        """Return the values at the given times, at a jump the one after it."""
        import numpy
        from numpy.polynomial import legendre

        times = times_from_zero(times)
        edges = self.edges
        if times.size and times.max() > edges[-1]:
            raise ValueError(f"t = {times.max():g} is later than {edges[-1]:g}, the end of the response")
        # a time that is an edge but for rounding belongs to the segment that begins there
        index = numpy.searchsorted(edges, times * (1 + float(ROUNDED)), side="right") - 1
        index = numpy.clip(index, 0, len(edges) - 2)
        length = edges[index + 1] - edges[index]
        return legendre.legval(2 * (times - edges[index]) / length - 1, self._coefficients[:, index], tensor=False)

    def quadrature(self):
        """Return times and weights, two arrays with a row for each segment, for integrals over the response.

        The sum of weight * response(time)**2 is the integral of the square, exact for these polynomials. It goes to the
        last of the edges, which may lie beyond the end that was asked for.
        """
        import numpy

        nodes, weights = numpy.polynomial.legendre.leggauss(NODES)
        half = numpy.diff(self.edges)[:, None] / 2
        return self.edges[:-1, None] + half * (nodes + 1), half * weights

    @property
    def coefficients(self):
        """The coefficients of the Legendre polynomials, an array with a row for each segment."""
        return self._coefficients.T


def _speed(model):
    """About how fast the signals can change, in 1/time; what it misses is seen in the coefficients."""
    import numpy

    if not len(model.A):
        return 0.0
    # of the system without dead time, with each channel cut or closed either way: independent of the unit of time
    closed = [sign * numpy.outer(into, out) for into, out in zip(model.B2.T, model.C2, strict=True) for sign in (1, -1)]
    return float(max(abs(numpy.linalg.eigvals(model.A + change)).max() for change in [0 * model.A, *closed]))


def _edges(delays, end, speed):
    """The ends of the segments, exact: the sums of the delays, and points between them."""
    end = Fraction(end)
    last = end * (1 + ROUNDED)
    points, newest = {Fraction(0)}, {Fraction(0)}
    while newest:  # each sum is a smaller one plus a delay
        newest = {a + b for a in newest for b in delays if a + b <= last} - points
        points |= newest
        if len(points) > MOST_SEGMENTS:
            raise ValueError(
                f"the dead times {', '.join(map(str, delays))} have more than {MOST_SEGMENTS} sums before "
                f"t = {float(end):g}: expected an earlier end, or dead times that are multiples of one"
            )
    points = sorted(points)  # without those that are one but for rounding, as sums of irrational dead times
    points = [b for a, b in itertools.pairwise([Fraction(-1), *points]) if b - a > b * ROUNDED]
    if points[-1] >= end * (1 - ROUNDED):  # a jump there has a value after it
        points.append(points[-1] + min([*delays, Fraction(REACH / speed if speed else 1)]))
    else:
        points.append(end)
    edges = points[:1]
    for a, b in itertools.pairwise(points):
        pieces = max(1, math.ceil(float(b - a) * speed / REACH))
        if len(edges) + pieces > MOST_SEGMENTS:
            raise ValueError(
                f"the response up to t = {float(end):g} needs more than {MOST_SEGMENTS} segments: its fastest lag, "
                f"about {1 / speed:.2g}, is too short beside the end"
            )
        edges += [a + (b - a) * Fraction(k, pieces) for k in range(1, pieces + 1)]
    return edges


def _collocate(model, end, speed):
    """Edges, Legendre coefficients of the output and the share of the response that they leave out."""
    import numpy
    from numpy.polynomial import legendre

    A, B1, B2, C1, C2, D11, D12, D21, D22, delays = model
    n, q = len(A), len(delays)
    edges = _edges(delays, end, speed)
    ends = numpy.array([float(edge) for edge in edges])
    place = {edge: number for number, edge in enumerate(edges)}
    nodes, weights, to_coefficients, integration = _gauss()
    integrate = weights / 2

    @functools.lru_cache(MOST_LENGTHS)
    def propagation(length):  # from the state at the beginning and the forces to the state at the nodes
        half = float(length) / 2
        system = numpy.eye(NODES * n) - half * numpy.kron(integration, A)
        from_start = numpy.tile(numpy.eye(n), (NODES, 1))
        from_forces = half * numpy.kron(integration, numpy.eye(n))
        solved = numpy.linalg.solve(system, numpy.hstack([from_start, from_forces]))
        return solved[:, :n], solved[:, n:]

    def from_channel(k, channel, delay):  # what went in one delay before, at the nodes of segment k
        source = place.get(edges[k] - delay)
        if source is not None and edges[source + 1] - edges[source] == edges[k + 1] - edges[k]:
            return Z[source, :, channel]
        past = ends[k] - float(delay) + (ends[k + 1] - ends[k]) / 2 * (nodes + 1)
        index = numpy.clip(numpy.searchsorted(ends, past, side="right") - 1, 0, k - 1)
        local = 2 * (past - ends[index]) / (ends[index + 1] - ends[index]) - 1
        return legendre.legval(local, to_coefficients @ Z[index, :, channel].T, tensor=False)

    m = len(edges) - 1
    Y, Z = numpy.zeros((m, NODES)), numpy.zeros((m, NODES, q))
    x = numpy.zeros(n)
    for k in range(m):
        length = edges[k + 1] - edges[k]
        w = numpy.zeros((NODES, q))
        for channel, delay in enumerate(delays):
            if edges[k] >= delay:
                w[:, channel] = from_channel(k, channel, delay)
        X = numpy.zeros((NODES, n))
        if n:
            forces = B1[:, 0] + w @ B2.T
            from_start, from_forces = propagation(length)
            X = (from_start @ x + from_forces @ forces.ravel()).reshape(NODES, n)
            x = x + float(length) * (integrate @ (X @ A.T + forces))
        Z[k] = X @ C2.T + D21[:, 0] + w @ D22.T
        Y[k] = X @ C1[0] + D11[0, 0] + w @ D12[0]
    coefficients = to_coefficients @ Y.T
    signals = [coefficients] + [to_coefficients @ Z[:, :, channel].T for channel in range(q)]
    tail = 0.0
    for signal in signals:
        largest = numpy.maximum.accumulate(abs(signal).max(axis=0))
        left = abs(signal[-2:]).max(axis=0)
        tail = max(tail, (left / numpy.where(largest > 0, largest, 1)).max())
    return ends, coefficients, tail if numpy.isfinite(coefficients).all() else math.inf


@functools.cache
def _gauss():
    """Gauss nodes and weights, the matrix to Legendre coefficients, and the one of integrals from the beginning."""
    import numpy
    from numpy.polynomial import legendre

    nodes, weights = legendre.leggauss(NODES)
    values = legendre.legvander(nodes, NODES)
    degree = numpy.arange(NODES)
    to_coefficients = (degree[:, None] + 0.5) * values[:, :NODES].T * weights
    # the integral of P_m from -1 is (P_{m+1} - P_{m-1})/(2m + 1)
    integrals = numpy.empty((NODES, NODES))
    integrals[:, 0] = nodes + 1
    integrals[:, 1:] = (values[:, 2:] - values[:, :-2]) / (2 * degree[1:] + 1)
    return nodes, weights, to_coefficients, integrals @ to_coefficients
