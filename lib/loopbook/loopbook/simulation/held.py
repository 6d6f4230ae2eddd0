"""A linear plant whose inputs are held, in time: from sample to sample by an exact recurrence.

What is held in a stretch of time moves the state to ``Phi x + Gamma v`` at its end, by the exponential of one matrix.
What drives the plant and is known beforehand is summed up for each sample before the run; the values of the blocks are
added as they come, those with a dead time that is no multiple of the step in two parts.
"""

from __future__ import annotations

import bisect
import itertools
import math

import numpy as np

from loopbook.signals import CLOSE, PiecewiseSignal, beyond_all_numbers
from loopbook.simulation.integrator import PlantIntegrator, compiled

__all__ = ["HeldIntegrator"]


class HeldIntegrator(PlantIntegrator):
    """The state of a linear plant at the samples; else as `PlantIntegrator`.

    Attributes:
        applies: whether the plant is one, with these inputs: inputs that stay constant may act in products; a state
            with limits must be the only one, and no input jump between two samples, for then it moves one way.
    """

    def _prepare(self):
        late = {name for name, delay in self.driving if delay}
        acting = {name: self.sources[name] for name, _ in self.driving}
        acting = {name: set(_values(x) if name in late else x.values) for name, x in acting.items()}
        held = not any(callable(x) for values in acting.values() for x in values)
        constant = {name: min(x) for name, x in acting.items() if held and len(x) == 1 and name not in self.driven}
        self.moments = np.array([self.begin, *self.ahead])
        one_way = not self.limited or (len(self.states) == 1 and len(self.moments) == len(self.samples))
        matrices = compiled(self.plant).matrices(constant) if held and one_way else None
        self.applies = matrices is not None
        if self.applies:
            self._prepare_recurrence(*matrices)

    def _prepare_recurrence(self, A, B):
        from scipy.linalg import matrix_balance

        # in other units of the states, which change powers of two only, the exponential has more right digits
        balanced, (self.units, _) = matrix_balance(A, permute=False, separate=True)
        self.system = np.zeros((len(A) + B.shape[1],) * 2)
        self.system[: len(A)] = np.hstack([balanced, B / self.units[:, None]])
        self.maps = {}
        self.length = (self.samples[-1] - self.begin) / (len(self.samples) - 1)
        self.given = self._given()
        Phi, Gamma = self._map(self.length)
        columns, factors, values = [Phi], [f"x[{n}]" for n in range(len(A))], {}
        for n, (name, delay) in enumerate(self.driving):
            if name in self.driven:
                whole = math.floor(delay / self.length + CLOSE)
                part = max(delay - whole * self.length, 0.0)
                early = self._map(self.length - part)[1][:, [n]] if part > CLOSE * self.length else Gamma[:, [n]]
                columns += [early, Gamma[:, [n]] - early]
                factors += [f"(u{n}[k - {late}] if k >= {late} else 0.0)" for late in (whole + 1, whole + 2)]
                values[f"u{n}"] = self.sources[name].values
        recurrence = np.hstack(columns)
        self.applies = bool(np.isfinite(recurrence).all())
        if not self.applies:
            return
        # a sum of numbers times names, written out, is evaluated many times as fast as loops over rows and columns
        text = ""
        for n, row in enumerate(recurrence.tolist()):
            text += "".join(f"{a!r} * {x} + " for a, x in zip(row, factors, strict=True) if a) + f"w[{n}], "
        self.onward = eval(f"lambda k, x, w: ({text})", values)
        self.times = self.samples.tolist()
        if not self.driven and not self.limited:
            self.trace = self._all_states(Phi)

    def _map(self, time):
        """Phi and Gamma of a stretch of time."""
        from scipy.linalg import expm

        key, count = round(time / self.length, 9), len(self.states)
        if key not in self.maps:
            scaled = self.system * time
            sizes = abs(scaled[:, count:]).max(axis=0)
            sizes[sizes == 0] = 1.0
            scaled[:, count:] /= sizes
            with np.errstate(all="ignore"):  # of what grows beyond all numbers
                found = self.units[:, None] * expm(scaled)[:count] * np.concatenate([1 / self.units, sizes])
            self.maps[key] = found[:, :count], found[:, count:]
        return self.maps[key]

    def _given(self):
        """For each sample what is known beforehand adds to the state until the next one, a list."""
        start, end = self.moments[:-1], self.moments[1:]
        sample = np.searchsorted(self.samples, start, side="right") - 1
        first = start == self.samples[sample]
        rest = np.where(first, 1.0, (self.samples[sample + 1] - start) / self.length)
        held = [values_at(self.sources[name], (start + end) / 2 - delay) for name, delay in self.driving]
        held = np.column_stack([*held, np.ones(len(start))])
        # a jump within a sample changes what is held for the rest of it
        held[1:] -= np.where(first[1:, None], 0.0, held[:-1])
        given = np.zeros((len(self.samples) - 1, len(self.states)))
        lengths, which = np.unique(np.round(rest, 9), return_inverse=True)
        for n in range(len(lengths)):
            chosen = which == n
            given[sample[chosen]] += held[chosen] @ self._map(rest[chosen][0] * self.length)[1].T
        return _rows(given)

    def _all_states(self, Phi):
        """The states at all samples of a plant alone: in blocks, of which all go on together."""
        given = np.array([self.trace[0], *self.given])
        size = math.isqrt(len(given)) + 1
        blocks = np.zeros((size, size, len(Phi)))
        blocks.reshape(-1, len(Phi))[: len(given)] = given
        entering, powers = np.zeros(len(Phi)), [Phi]
        with np.errstate(all="ignore"):  # of a run that grows beyond all numbers
            for k in range(1, size):
                blocks[:, k] += blocks[:, k - 1] @ Phi.T
                powers.append(powers[-1] @ Phi)
            for block in blocks:
                block += powers @ entering
                entering = block[-1]
        return _rows(blocks.reshape(-1, len(Phi))[: len(given)])

    def advance(self, time: float) -> None:
        k = len(self.rows)
        if k == len(self.trace):
            self.trace.append(self._limited(self.onward(k, self.trace[-1], self.given[k - 1])))
        state = self.trace[k]
        if not math.isfinite(sum(state)):
            raise beyond_all_numbers(", ".join(self.names), time)
        needed = [self._at(name, time - delay) for name, delay in self.measuring] if self.measuring else ()
        self.rows.append(tuple(self.measure(*state, *needed)))

    def _between(self, n, time):
        state, begin = np.array(self.trace[n]), self.times[n]
        inside = self.moments[bisect.bisect_right(self.moments, begin) : bisect.bisect_left(self.moments, time)]
        for start, end in itertools.pairwise([begin, *inside, time]):
            Phi, Gamma = self._map(end - start)
            held = [self._around(name, (start + end) / 2 - delay) for name, delay in self.driving]
            state = Phi @ state + Gamma @ [*held, 1.0]
        return self._limited(state.tolist())

    def signals(self, times: np.ndarray) -> dict[str, np.ndarray]:
        found = dict(zip(self.names, np.transpose(self.trace), strict=True))
        found |= dict(zip(self.measured, np.transpose(self.rows), strict=True))
        for name, source in self.sources.items():
            moves = any(map(callable, source.values))
            found[name] = [source.at(time) for time in times] if moves else values_at(source, times)
        return found


def _rows(values):
    """The rows of an array, tuples of numbers: of these, unlike lists, Python's collection of garbage is soon done."""
    return list(zip(*values.T.tolist(), strict=True))


def _values(source):
    """All that a signal was and is: numbers and functions of time."""
    while source is not None:
        yield from source.values
        source = source.past


def values_at(source: PiecewiseSignal, moments: np.ndarray) -> np.ndarray:
    """The values of a held signal at many moments; 0 where a block has yet to say them."""
    places = np.searchsorted(source.times, moments + CLOSE * source.step + 1e-15 * abs(moments), side="right") - 1
    values = np.array(source.values or [0.0], dtype=float)
    found, before = values[np.clip(places, 0, len(values) - 1)], places < 0
    if before.any():
        found[before] = values_at(source.past, moments[before])
    return found
