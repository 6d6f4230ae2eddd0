"""A plant with delayed states in time, as behind a recycle or in a balance with a dead time.

The method of steps: in a stretch of time no longer than the shortest such dead time, what is delayed is known already,
from a history that is as exact as the integration. A jump of an input returns as a jump of a higher derivative after
each of these dead times; the integration stops there until it is too smooth to matter. The method is that of Dormand
and Prince of order 8 with its interpolation of order 7 (SciPy), to a relative tolerance of 1e-11.

The history goes back as far as the longest dead time. A later run whose plant has a longer one asks for more: then the
run is integrated once more, by the same steps, and all of it is kept.
"""

from __future__ import annotations

import bisect
import itertools
import math

import numpy as np

from loopbook.signals import CLOSE, beyond_all_numbers, too_many_steps
from loopbook.simulation.integrator import PlantIntegrator

__all__ = ["DelayedStateIntegrator"]

TOLERANCE = {"rtol": 1e-11, "atol": 1e-13}
SMOOTH = 8  # the derivative that may jump without a stop
TOO_STIFF = 2000  # steps of the explicit method in one stretch
MOST_STEPS = 100_000  # of the method for stiff systems
MOST_STRETCHES = 1_000_000


class DelayedStateIntegrator(PlantIntegrator):
    """The state of a plant with delayed states, from one discontinuity to the next; else as `PlantIntegrator`."""

    def _prepare(self):
        self.reach = max(delay for name, delay in self.driving + self.measuring if name in self.names)
        self._begin_history()

    def _begin_history(self):
        from scipy.integrate import DOP853, LSODA

        self.methods, self.first = [(DOP853, TOO_STIFF), (LSODA, MOST_STEPS)], None
        self.ends, self.pieces = [], []  # the history: up to which time each interpolant holds
        self.oldest = self.begin  # when it begins

    def _begins(self):
        return [self.begin, *(self.past._begins() if isinstance(self.past, DelayedStateIntegrator) else ())]

    def _discontinuities(self, times):
        """The samples, where an input jumps, and where such jumps come back; no two further apart than a dead time."""
        inner = sorted({delay for _, delay in self.delayed_states})
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
        return min(max(float(self._piece(time)(time)[n]), low), high)

    def _piece(self, time):
        """The interpolant of a moment."""
        if time < self.oldest:
            self.reach = math.inf
            self._begin_history()
            for (start, end), state in zip(itertools.pairwise(self.times), self.trace, strict=False):
                self._integrated(state, start, end)
        return self.pieces[min(bisect.bisect_left(self.ends, time), len(self.pieces) - 1)]

    def _between(self, n, time):
        return self._limited(self._piece(time)(time).tolist())

    def _integrated(self, state, start, end):
        """The state at the end of a stretch of time; what lies between becomes history."""
        self._freeze_inputs(start, end)
        for method, most in tuple(self.methods):
            found = self._stepped(method, most, state, start, end)
            if self.failure:
                raise self.failure
            if found is not None:
                ends, pieces, state = found
                self.ends += ends
                self.pieces += pieces
                self._drop_before(start - self.reach)
                return self._limited(state)
            self.methods = self.methods[1:] or self.methods  # what was too stiff once remains so
        raise beyond_all_numbers(", ".join(self.names), end)

    def _drop_before(self, time):
        """Drop the history before a moment, once it is half of it."""
        old = bisect.bisect_left(self.ends, time)
        if 2 * old > len(self.ends):
            self.oldest = self.ends[old - 1]
            del self.ends[:old], self.pieces[:old]

    def _stepped(self, method, most, state, start, end):
        """The steps of a method with their interpolants, and the state at the end; None if it gets stuck."""
        first = None if self.first is None else min(self.first, end - start)
        try:
            solver = method(self._rate_of_change, start, state, end, first_step=first, **TOLERANCE)
        except ValueError:  # of rates that are no numbers
            return None
        ends, pieces = [], []
        while solver.status == "running" and len(pieces) < most:
            solver.step()
            if solver.status == "failed" or not all(map(math.isfinite, solver.y)):
                return None
            ends.append(solver.t)
            pieces.append(solver.dense_output())
        if solver.status != "finished" and most == MOST_STEPS:
            raise too_many_steps(", ".join(self.names), most, start, end)
        if solver.status != "finished":
            return None
        proposed = getattr(solver, "h_abs", math.inf)  # LSODA proposes none
        self.first = None if proposed > end - start else proposed
        return ends, pieces, solver.y.tolist()
