"""The step response of a state-space model with delay channels, segment by segment, by implicit collocation.

In each segment all signals are polynomials of degree 19, known at Radau's nodes, and the equations hold there (Radau
IIA with 20 stages: of order 39, and what has died out stays dead, however long the segment). What comes out of a
channel is the polynomial of an earlier segment, or of this one, for a delay may be shorter than the segment. For a
length the whole step is a matrix, from the state and what comes out of the channels to the signals.
"""

from __future__ import annotations

import functools
import math
from bisect import bisect_right
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.breaking_points import MOST_POINTS, UNSEEN, BreakingPoints

if TYPE_CHECKING:
    from loopbook.deadtime.state_space import ChannelModel

NODES = 20  # where a segment is known, so that it is a polynomial of degree 19
GOAL = 1e-13  # the share of a signal that its last two coefficients may have
RESOLVED = 1e-12  # the same where rounding does not allow more
MOST_SECONDS = 1.6  # about, by the sizes of what is to be done and not by the clock
SECONDS, SECONDS_CHANNEL, SECONDS_POINT = (
    1.6e-5,
    1e-5,
    1.5e-5,
)  # of a segment, of each channel in it, of a point
OFTEN = 256  # segments after which that is looked at
MOST_NUMBERS = 20_000_000  # that are kept of the signals
MOST_MATRICES = 200  # that are kept
AHEAD = 8  # how many segments before a breakpoint they are made equal
PATIENCE = 8  # segments before a longer one is tried again
ROUNDING = 4e-15  # of what a signal is the sum of
RANGE = 1e3  # times the largest value so far, up to which a signal may grow in a segment
WORTH = 12  # segments that a matrix for another length costs


def follow(model: ChannelModel, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of the segments, and the Legendre coefficients of the output, a row for each segment."""
    if any(delay <= 0 for delay in model.delays):
        raise ValueError(f"the delays of the channels are {', '.join(map(str, model.delays))}: expected positive ones")
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # said in words below
        follower = _Follower(_merged(model), end)
        try:
            return follower.run()
        except OverflowError:
            late = ", ".join(f"{float(delay):g}" for delay in follower.model.delays)
            raise ValueError(
                f"the dead times {late} have more than {MOST_POINTS} sums before t = {end:g} at which the response is "
                f"not smooth: expected an earlier end, or dead times that are multiples of one"
            ) from None


def _merged(model):
    """The model with one channel for those of the same delay that carry the same signal but for a factor."""
    rows, delays = np.hstack([model.C2, model.D21, model.D22]), model.delays
    kept: list[int] = []
    shares = np.zeros((len(delays), len(delays)))  # of each channel in those that are kept
    for k, delay in enumerate(delays):
        for j in kept:
            place = abs(rows[j]).argmax()
            factor = rows[k, place] / rows[j, place] if delays[j] == delay and rows[j, place] else 0.0
            if factor and (abs(rows[k] - factor * rows[j]) <= 4e-16 * abs(rows[k])).all():
                shares[k, j] = factor
                break
        else:
            kept.append(k)
            shares[k, k] = 1.0
    if len(kept) == len(delays):
        return model
    B2, D12, D22 = (into @ shares[:, kept] for into in (model.B2, model.D12, model.D22[kept]))
    delays = [delays[k] for k in kept]
    return model._replace(B2=B2, D12=D12, C2=model.C2[kept], D21=model.D21[kept], D22=D22, delays=delays)


class _Follower:
    def __init__(self, model, end):
        self.model, self.end = model, end
        self.n, self.q = len(model.A), len(model.delays)
        # time in whole ticks, so that sums of delays are exact
        exact_end = Fraction(end)
        per = math.lcm(*(delay.denominator for delay in model.delays))
        smallest = min([*model.delays, *([exact_end] if end else [])], default=Fraction(1))
        size = math.log2(per) + math.log2(smallest.numerator) - math.log2(smallest.denominator)
        self.per = per = per << max(0, 90 - math.floor(size))
        self.delays = [delay.numerator * (per // delay.denominator) for delay in model.delays]
        self.last = last = round(exact_end * per)
        try:
            ticks = float(per)
        except OverflowError:
            raise ValueError(
                f"the dead times {', '.join(map(str, model.delays))} have too many digits: expected fewer"
            ) from None
        self.breaking = BreakingPoints(
            model, end or float(sum(model.delays)) or 1.0, ticks, self.delays, last + (last >> 48)
        )
        self.seconds = 0.0  # about, that the matrices of steps took
        self._steps = {}
        self.edges = [0]
        self.signals = np.zeros((32, self.q + 1, NODES))
        self._looks = {}

    def run(self):
        breaking, edges, last, n, q = self.breaking, self.edges, self.last, self.n, self.q
        moments, maximum, high = breaking.moments, np.maximum.reduce, radau().high
        scale, values = np.zeros(q + 1), np.zeros(1 + n + q * NODES)
        values[0] = 1.0
        longest, start = breaking.longest, breaking.start
        wish = min(start, moments[0][2] if moments else longest) or 1
        shortest = wish >> 40
        position, index, waiting, patience, length = 0, 0, 0, PATIENCE, 0
        finished = last - (last >> 48)
        count = 0
        while True:
            # what lies ahead
            before, length, forced = length, wish, 0
            threshold = UNSEEN * scale[:, None]
            while index < len(moments) and moments[index][0] <= position:
                index += 1
            k = index
            while k < len(moments) or breaking.find(position + AHEAD * length, length, threshold):
                tick, allowed, _ = moments[k]
                gap = tick - position
                if gap <= 0:
                    k += 1
                    continue
                if gap >= length and (allowed >= length or gap > AHEAD * length):
                    break
                if allowed <= gap:
                    forced = gap
                    break
                length = min(length, allowed)
                k += 1
            rest = last - position
            if position >= finished:  # only for the value after a jump at the end
                length = min(length, before or length)
            elif not forced:
                if length != before and rest < WORTH * before and before <= length and before <= wish:
                    length = before  # a new matrix would not pay
                if length != before and rest < AHEAD * length:
                    forced = rest
            if forced:
                length = -(-forced // -(-forced // length))
            # one segment
            if q:
                self._inputs(values, position, length)
            result = self._step(length / self.per, length) @ values
            signals = result[n:].reshape(q + 1, NODES)
            largest = np.maximum(scale, maximum(abs(signals), axis=1))
            left = abs(signals @ high)
            tail = maximum(left[:, 8:], axis=1)
            if length > start and True in ((largest > RANGE * scale) & (scale > 0)).tolist():
                wish, waiting = max(length >> 1, start), 1
                continue
            if False in (tail <= GOAL * largest).tolist():
                if not np.isfinite(largest).all():
                    raise ValueError(f"the response grows beyond all numbers before t = {self.end:g}")
                # where it does not fall any more it is rounding, as where large states make a small signal
                flat = tail >= 0.1 * left[:, :8].max(axis=1)
                rounding = ROUNDING * self._size(values, result)
                if not ((tail <= GOAL * largest) | (tail <= rounding) | flat & (tail <= RESOLVED * largest)).all():
                    wish = length >> 1
                    waiting, patience = patience, min(2 * patience, 8 * PATIENCE)
                    if wish <= shortest:
                        left = (tail / largest).max()
                        raise ValueError(
                            f"the response up to t = {self.end:g} is not resolved: {left:.0e} of it is left"
                        )
                    continue
            scale = largest
            values[1 : n + 1] = result[:n]
            if count == len(self.signals) or not count % OFTEN:
                self._grow(count)
            self.signals[count] = signals
            count += 1
            position += length
            edges.append(position)
            waiting -= 1
            if waiting <= 0 and 4 * length > 3 * wish < 3 * longest and last - position > WORTH * wish:
                rest = maximum(left, axis=1)
                # half of the coefficients are not needed, or rounding
                if not (rest > np.where(tail > 0.1 * rest, RESOLVED, GOAL) * scale).any():
                    wish = min(2 * wish, longest)
            if waiting < -PATIENCE:
                patience = PATIENCE
            if forced and k < len(moments) and abs(moments[k][0] - position) <= position >> 48:
                wish = min(wish, moments[k][2])
                if position <= last + (last >> 48):
                    continue
            if position >= finished:
                return self._done()

    def _step(self, h, length):
        """The matrix of a step: from 1, the state and what comes out of the channels to the state and the signals."""
        mantissa, exponent = math.frexp(h)
        key = round(mantissa * 2**44), exponent
        step = self._steps.get(key)
        if step is None:
            if len(self._steps) >= MOST_MATRICES:
                self._steps.clear()
            self.seconds += 2e-4 + 1.5e-10 * (NODES * self.n) ** 3
            overlaps = [(k, delay / length) for k, delay in enumerate(self.delays) if delay < length - (length >> 44)]
            step = self._steps[key] = step_matrix(self.model, h, overlaps)
        return step

    def _size(self, values, result):
        """The sizes of what the signals are made of.

        A signal that has only begun, as t^20 after twenty lags, is no polynomial of degree 19 beside its own size.
        """
        _, _, _, C1, C2, D11, D12, D21, D22, _ = self.model
        states = max(np.linalg.norm(x) for x in (values[1 : self.n + 1], result[: self.n]))
        direct, to, through = np.vstack([D21, D11])[:, 0], np.vstack([C2, C1]), np.vstack([D22, D12])
        own = abs(direct) + np.linalg.norm(to, axis=1) * states
        into = abs(values[self.n + 1 :]).reshape(self.q, NODES).max(axis=1, initial=0.0)
        return own + abs(through) @ np.maximum(into, own[:-1])

    def _grow(self, count):
        seconds = count * (SECONDS + SECONDS_CHANNEL * self.q) + self.seconds
        seconds += SECONDS_POINT * self.breaking.count
        if seconds > MOST_SECONDS or count * (self.q + 1) * NODES > MOST_NUMBERS:
            speed = self.breaking.speed
            raise ValueError(
                f"the response up to t = {self.end:g} needs too many segments, more than {count} up to "
                f"t = {self.edges[-1] / self.per:g}: its fastest lag, about {1 / speed if speed else math.inf:.2g}, is "
                f"too short beside the end, or its jumps are too many"
            )
        if count == len(self.signals):
            self.signals = np.concatenate([self.signals, np.zeros_like(self.signals)])

    def _inputs(self, values, position, length):
        """What comes out of the channels, at the nodes of a segment, as far as it went in before its beginning."""
        edges, signals, nodes = self.edges, self.signals, radau().nodes_list
        place, count = 1 + self.n, len(edges) - 1
        for channel, delay in enumerate(self.delays):
            start = position - delay
            into = values[place : place + NODES]
            place += NODES
            if start + length <= 0 or count == 0:
                into[:] = 0.0
                continue
            source = min(max(bisect_right(edges, start) - 1, 0), count - 1)
            slack = length >> 44
            offset = edges[source] - start
            if -slack <= offset <= slack and abs(edges[source + 1] - edges[source] - length) <= slack:
                into[:] = signals[source, channel]
                continue
            if edges[source + 1] - start <= slack and source < count - 1:
                source += 1
            into[:] = 0.0
            # before the beginning there was nothing
            first = bisect_right(nodes, -2 * start / length - 1 + 1e-13) if start < 0 else 0
            while first < NODES and source < count:
                after = bisect_right(nodes, 2 * (edges[source + 1] - start) / length - 1 + 1e-13, first)
                if after > first:
                    own = edges[source + 1] - edges[source]
                    look = self._look(length / own, 2 * (start - edges[source]) / own, first, after)
                    into[first:after] = look @ signals[source, channel]
                first, source = after, source + 1

    def _look(self, ratio, offset, first, after):
        """The matrix from the values of an earlier segment to those at some nodes of this one."""
        key = round(ratio, 13), round(offset, 13), first, after
        look = self._looks.get(key)
        if look is None:
            if len(self._looks) > MOST_MATRICES:
                self._looks.clear()
            places = offset - 1 + ratio * (radau().nodes[first:after] + 1)
            look = self._looks[key] = interpolation(places)
        return look

    def _done(self):
        per, edges = self.per, self.edges
        rule, signal = radau(), self.signals[: len(edges) - 1, -1]
        ends = np.array([edge / per for edge in edges])
        if edges[-1] > self.last > edges[-2] + (edges[-2] >> 48):  # the last segment ends where it was asked for
            share = (self.last - edges[-2]) / (edges[-1] - edges[-2])
            signal[-1] = interpolation(share * (rule.nodes + 1) - 1) @ signal[-1]
            ends[-1] = self.end
        ends[-1] = max(ends[-1], self.end)  # which may differ by rounding
        return ends, signal @ rule.to_coefficients.T


def step_matrix(model: ChannelModel, h: float, overlaps: list[tuple[int, float]]) -> np.ndarray:
    """The matrix of one step of length h.

    Arguments:
        overlaps: the channels whose delay is shorter than h, and the delay as a share of h.
    """
    A, B1, B2, C1, C2, D11, D12, D21, D22, _ = model
    n, q, rule, half = len(A), len(D22), radau(), h / 2
    inner, of_states = [k for k, _ in overlaps], NODES * n
    # unknown are the states at the nodes, a row for each node, and what the overlapping channels give, one by one;
    # known are 1, the state at the beginning, and what came into the channels before
    unknown = np.eye(of_states + NODES * len(inner))
    columns = 1 + n + NODES * q
    known = np.zeros((len(unknown), columns))
    into_states = half * (B2[None, :, :, None] * rule.integration[:, None, None, :]).reshape(of_states, q, NODES)
    from_channels = known[:, n + 1 :].reshape(len(known), q, NODES)
    unknown[:of_states, :of_states] -= half * _kron(rule.integration, A)
    unknown[:of_states, of_states:] -= into_states[:, inner].reshape(of_states, NODES * len(inner))
    known[:of_states, 0] = half * np.outer(rule.nodes + 1, B1).ravel()
    known[:of_states, 1 : n + 1] = np.tile(np.eye(n), (NODES, 1))
    from_channels[:of_states] = into_states
    from_channels[:of_states, inner] = 0.0
    outer = np.ones(q)
    outer[inner] = 0.0
    for number, (k, share) in enumerate(overlaps):
        rows = slice(of_states + number * NODES, of_states + (number + 1) * NODES)
        late = np.zeros((NODES, NODES))
        inside = rule.nodes > 2 * share - 1 + 1e-13
        late[inside] = interpolation(rule.nodes[inside] - 2 * share)
        # w_k = past + late z_k,  z_k = C2 x + D21 + D22 w
        known[rows, 0] = late.sum(axis=1) * D21[k, 0]
        from_channels[rows] = late[:, None] * (outer * D22[k])[:, None]
        from_channels[rows, k] = np.eye(NODES)
        unknown[rows, :of_states] -= _kron(late, C2[k : k + 1])
        unknown[rows, of_states:] -= _kron(D22[k : k + 1, inner], late)
    solved = np.linalg.solve(unknown, known)
    from_state, direct_input, direct = np.vstack([C2, C1]), np.vstack([D21, D11]), np.vstack([D22, D12])
    step = np.empty((n + NODES * (q + 1), columns))
    step[:n] = solved[of_states - n : of_states]
    signals = step[n:].reshape(q + 1, NODES, columns)
    signals[...] = (from_state @ solved[:of_states].reshape(NODES, n, columns)).transpose(1, 0, 2)
    signals[:, :, 0] += direct_input
    places = np.arange(NODES)
    signals[:, :, n + 1 :].reshape(q + 1, NODES, q, NODES)[:, places, :, places] += outer * direct
    if inner:
        signals += np.tensordot(direct[:, inner], solved[of_states:].reshape(len(inner), NODES, columns), 1)
    return step


def _kron(one, other):
    """The Kronecker product of two matrices, quicker than NumPy's for small ones."""
    blocks = one[:, None, :, None] * other[:, None]
    return blocks.reshape(one.shape[0] * other.shape[0], one.shape[1] * other.shape[1])


class _Radau:
    """Nodes between -1 and 1, the last at 1; matrices to Legendre coefficients, and of integrals from the beginning."""

    def __init__(self):
        series = np.r_[np.zeros(NODES - 1), 1, -1]
        nodes = np.sort(legendre.legroots(series).real)
        for _ in range(3):
            nodes = nodes - legendre.legval(nodes, series) / legendre.legval(nodes, legendre.legder(series))
        nodes[-1] = 1.0
        values = legendre.legvander(nodes, NODES)
        self.nodes, self.nodes_list = nodes, nodes.tolist()
        self.to_coefficients = np.linalg.inv(values[:, :-1])  # more exact than by the weights
        self.high = self.to_coefficients[NODES // 2 :].T.copy()
        # the integral of P_m from -1 is (P_{m+1} - P_{m-1})/(2m + 1)
        integrals = np.c_[nodes + 1, (values[:, 2:] - values[:, :-2]) / (2 * np.arange(1, NODES) + 1)]
        self.integration = integrals @ self.to_coefficients
        differences = nodes[:, None] - nodes + np.eye(NODES)
        self.barycentric = 1 / (2 * differences).prod(axis=1)  # a factor 2, near the capacity


radau = functools.cache(_Radau)


def interpolation(places: np.ndarray) -> np.ndarray:
    """The matrix from values at the nodes to those at some places."""
    rule = radau()
    differences = np.asarray(places)[:, None] - rule.nodes
    differences[differences == 0] = 1e-200
    weights = rule.barycentric / differences
    return weights / weights.sum(axis=1, keepdims=True)
