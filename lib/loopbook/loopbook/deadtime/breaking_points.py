"""The breaking points of a model with delay channels: where its signals are not smooth, and up to which frequencies.

A step at the input comes back from each channel one delay later, smoother after each integration on its way, and so on.
What comes back at a moment is known by its transform on a grid of frequencies. A polynomial of degree 19 over a segment
of length h is blind to what lies above the frequency 40/h: where less than the last digit is left there, the moment is
smooth for such a segment, and where nothing is left above the lowest of these frequencies it is forgotten.
"""

from __future__ import annotations

import heapq
import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from loopbook.deadtime.state_space import ChannelModel

BLIND = 40.0  # frequency times length above which a polynomial of degree 19 does not see a signal
UNSEEN = 1e-14  # the share of a signal that is nothing
STEP = 1.6  # from one frequency of the grid to the next
SLANT = 0.01  # how far right of the imaginary axis, so that a resonance is not infinite
REACH = 4.0  # how many times the fastest lag a segment may be long
LONGEST = 12.0  # the same for the fastest motion that may grow unseen
ROUNDED = Fraction(1, 2**48)  # by how much, as a share of them, two moments that are meant to be one may differ
ROUNDS = 50.0  # delays that a segment may be long, so that two of its nodes look back before its beginning
KEPT = 0.5  # of what goes round in channels alone: less is gone before such a segment ends
MOST_POINTS = 30_000


class BreakingPoints:
    """The moments at which something comes back from the channels, in the order of time, as far as they are asked for.

    Arguments:
        model: a `ChannelModel`.
        end: of the response.
        per: ticks for one unit of time.
        delays, last: of the channels, and the end, in whole ticks.
    Attributes:
        moments: (tick, length, start): a segment may reach across the moment if it is not longer than `length`, and one
            that begins there may not be longer than `start`; all in ticks.
        longest: of the segments, in ticks.
        start: the length of a segment in which the fastest motion is seen, in ticks.
    """

    def __init__(self, model: ChannelModel, end: float, per: float, delays: list[int], last: int):
        self.delays, self.last = delays, last
        self.moments: list[tuple[int, int, int]] = []
        speeds, growing = _speeds(model)
        self.speed = fastest = max(speeds, default=0.0)
        top = 1e3 * max(fastest, 1 / end)
        count = math.ceil(math.log(top * end * 10) / math.log(STEP))
        grid = np.sort(np.r_[top * STEP ** -np.arange(count + 1.0), speeds])
        grid = grid[np.searchsorted(grid, 0.1 / end) :]
        from_input, channels = _transfer(model, grid)
        q = len(delays)
        # what goes round in the channels becomes smaller each time where the spectral radius of the sizes is below 1
        radii = abs(np.linalg.eigvals(abs(np.moveaxis(channels[:q], -1, 0)))).max(axis=1, initial=0.0)
        loud = np.flatnonzero(radii >= 1)
        if len(loud) and loud[-1] == len(grid) - 1:  # what comes back is never smooth
            longest = REACH / fastest if fastest else math.inf
        else:
            growing = max(growing, grid[loud[-1]] if len(loud) else 0.0)
            longest = LONGEST / growing if growing else math.inf
        longest = min(longest, end, _memory(model))
        self.longest = int(longest * per)
        start = min(REACH / fastest if fastest else math.inf, longest)
        # slow motion is of all sizes at first, as of a chain of integrators
        self.start = int(start * per) if start < end or len(model.A) < 2 else int(end / 16 * per)
        seen = min(int(np.searchsorted(grid, BLIND / longest)), len(grid) - 1)
        grid = grid[seen:]
        self.from_channels = np.ascontiguousarray(channels[..., seen:])
        self._empty = np.zeros((q, len(grid)), complex)
        self._lengths = (BLIND * per / grid).tolist()
        self._lengths[-1] = 0.0  # what is seen at the end of the grid, is always
        self._starts = (REACH * per / np.minimum(STEP * grid, fastest or REACH / end)).tolist()
        self.count = 1
        self._heap: list[int] = []
        self._pending: dict[int, np.ndarray] = {}
        self._arrive(0, from_input[:, seen:], 0.0)

    def _arrive(self, tick: int, content: np.ndarray, threshold: np.ndarray | float) -> bool:
        """Whether something new comes back at this moment; then also what comes back from that."""
        signals, places = (abs(content) > threshold).nonzero()
        if not len(places):
            return False
        top = int(places.max())
        self.moments.append((tick, int(self._lengths[top]), max(1, int(self._starts[top]))))
        for channel in set(signals.tolist()) - {len(self.delays)}:
            later = tick + self.delays[channel]
            if later <= self.last:
                if later not in self._pending:
                    self._pending[later] = self._empty.copy()
                    heapq.heappush(self._heap, later)
                    self.count += 1
                self._pending[later][channel] += content[channel]
        return True

    def find(self, ahead: int, length: int, threshold: np.ndarray) -> bool:
        """Find moments up to the tick `ahead`, or up to the first that a segment of the length cannot cross.

        Returns whether there are new ones.
        """
        before = len(self.moments)
        heap, pending = self._heap, self._pending
        while heap and heap[0] <= ahead:
            now = heapq.heappop(heap)
            content = pending.pop(now)
            near = now + (now >> 48)
            while heap and heap[0] <= near:  # one but for rounding, as sums of irrational dead times
                content += pending.pop(heapq.heappop(heap))
            if self.count > MOST_POINTS:
                raise OverflowError
            new = self._arrive(now, (self.from_channels * content).sum(axis=1), threshold)
            if new and self.moments[-1][1] < length:
                break
        return len(self.moments) > before


def _speeds(model):
    """How fast the signals can change, in 1/time: without the channels, and with each closed either way."""
    # independent of the unit of time
    changes = model.B2.T[:, :, None] * model.C2[:, None, :]
    values = np.linalg.eigvals(model.A + np.concatenate([0 * model.A[None], changes, -changes]))
    growing = max((abs(value) for value in values[0].tolist() if value.real > 0), default=0.0)
    return abs(values).ravel().tolist(), growing


def _memory(model):
    """How long a segment may be so that it is tied to what is still in the channels that feed each other directly.

    Where the jumps have died out, something smooth may still go round there, of which the states know nothing. Only if
    that is gone after a few rounds, too, a segment need not look back.
    """
    if not model.D22.any():
        return math.inf
    round_trip = abs(model.D22)
    for _ in range(len(round_trip).bit_length()):
        round_trip = round_trip + round_trip @ round_trip
    inside = [float(delay) for k, delay in enumerate(model.delays) if round_trip[k, k]]
    kept = max(abs(np.linalg.eigvals(abs(model.D22)))) if inside else 0.0
    return ROUNDS * min(inside) if kept > KEPT else math.inf


def _transfer(model, grid):
    """From the input and from the channels to the channels and the output, on the grid of frequencies."""
    A, B1, B2, C1, C2, D11, D12, D21, D22, _ = model
    points = (SLANT + 1j) * grid
    states = np.linalg.solve(points[:, None, None] * np.eye(len(A)) - A, np.hstack([B1, B2])[None] + 0j)
    values = np.vstack([C2, C1]) @ states + np.block([[D21, D22], [D11, D12]])
    values = np.moveaxis(values, 0, -1)
    return np.ascontiguousarray(values[:, 0]), values[:, 1:]
