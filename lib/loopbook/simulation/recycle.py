"""A plant in time, some of whose states act on it late, as behind a recycle or in a balance with a dead time.

The method of steps: in a stretch of time no longer than the shortest such dead time, what acts late is known already,
from a history that is as exact as the integration. A jump of an input returns as a jump of a higher derivative after
each of these dead times; the integration stops there until it is too smooth to matter. The method is that of Dormand
and Prince of order 8 with its interpolation of order 7 (SciPy), to a relative tolerance of 1e-11.
"""

from __future__ import annotations

import bisect
import math

import numpy as np

from loopbook.signals import CLOSE, beyond_all_numbers
from loopbook.simulation.system import System

__all__ = ["RecycleSystem"]

TOLERANCE = {"rtol": 1e-11, "atol": 1e-13}
SMOOTH = 8  # the derivative that may jump without a stop
MOST_STEPS = 2000  # in one stretch; for more, a system is too stiff for an explicit method
MOST_STRETCHES = 1_000_000


class RecycleSystem(System):
    """The state of a plant, of which some states act late, from one discontinuity to the next; else as `System`."""

    def _prepare(self):
        from scipy.integrate import DOP853, LSODA

        self.methods, self.first = [DOP853, LSODA], None
        self.ends, self.pieces = [], []  # the history: up to which time each interpolant holds

    def _begins(self):
        return [self.begin, *(self.past._begins() if isinstance(self.past, RecycleSystem) else ())]

    def _discontinuities(self, times):
        """The samples, where an input jumps, and where such jumps come back; no two further apart than a dead time."""
        inner = sorted({delay for _, delay in self.late_states})
        count = (times[-1] - self.begin) / inner[0]
        if count > MOST_STRETCHES:
            raise ValueError(
                f"the dead time {inner[0]:g} inside the plant makes {count:.0f} stretches of time: "
                f"expected at most {MOST_STRETCHES}, in a shorter run"
            )
        found = [np.concatenate([*self._jumps(), self._begins()])]
        for _ in range(SMOOTH):
            known = np.unique(found[-1][np.isfinite(found[-1]) & (found[-1] < times[-1])])
            found.append(np.concatenate([known + delay for delay in inner]))
        moments = self._with_samples(np.concatenate(found), times)
        parts = np.ceil(np.diff(moments) / inner[0] * (1 - CLOSE)).astype(int)
        cuts = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(moments[:-1], moments[1:], parts, strict=True)]
        return np.concatenate(cuts).tolist()

    def _around(self, name, moment):
        if name in self.names:
            n = self.names.index(name)
            return lambda time: self._history(n, time)
        return super()._around(name, moment)

    def _history(self, n, time):
        """A state in the past."""
        if time <= self.begin:
            return self.past.state_at(time)[n] if self.past else self.at_rest[n]
        low, high = self.limits[n]
        return min(max(float(self.pieces[self._piece(time)](time)[n]), low), high)

    def _piece(self, time):
        return min(bisect.bisect_left(self.ends, time), len(self.pieces) - 1)

    def _between(self, n, time):
        return self._limited(self.pieces[self._piece(time)](time).tolist())

    def _integrated(self, state, start, end):
        """The state at the end of a stretch of time; what lies between becomes history."""
        self._look(start, end)
        for method in tuple(self.methods):
            found = self._stepped(method, state, start, end)
            if self.failure:
                raise self.failure
            if found is not None:
                ends, pieces, state = found
                self.ends += ends
                self.pieces += pieces
                return self._limited(state)
            self.methods = self.methods[1:] or self.methods  # what was too stiff once remains so
        raise beyond_all_numbers(", ".join(self.names), end)

    def _stepped(self, method, state, start, end):
        """The steps of a method with their interpolants, and the state at the end; None if it gets stuck."""
        first = None if self.first is None else min(self.first, end - start)
        try:
            solver = method(self._rate_of_change, start, state, end, first_step=first, **TOLERANCE)
        except ValueError:  # of rates that are no numbers
            return None
        ends, pieces = [], []
        while solver.status == "running" and len(pieces) < MOST_STEPS:
            solver.step()
            if solver.status == "failed" or not all(map(math.isfinite, solver.y)):
                return None
            ends.append(solver.t)
            pieces.append(solver.dense_output())
        if solver.status != "finished":
            return None
        self.first = None if solver.h_abs > end - start else solver.h_abs
        return ends, pieces, solver.y.tolist()
