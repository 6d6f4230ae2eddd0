"""The output of simple processes at the samples, exact, for a recorded control signal, however the samples come.

Between two samples the control signal is constant or a straight line, so that the states of a chain of lags are known
in closed form from one sample to the next. A dead time only asks for them at earlier moments than those of the
samples. So neither a Pade approximation nor a small step is needed, nor one step between all the samples. Everything is
done for many sets of lags and dead times at once.
"""

from __future__ import annotations

import math

import numpy as np

KINDS = {  # how many lags, and how many integrators
    "first order": (1, 0),
    "second order": (2, 0),
    "integrator": (0, 1),
    "integrator with lag": (1, 1),
}
HOLDS = ("zero order", "first order")


class DrivenChain:
    """Lags in a row, and perhaps an integrator at their end, with gain one, driven by a recorded control signal.

    Arguments:
        kind: one of `KINDS`.
        times: moments of the samples, increasing.
        u: the control signal at these moments; it is 0 before, and the chain at rest.
        hold: "zero order", if u is held until the next sample, or "first order", if its values are joined by straight
            lines.
        step: the time between two samples, if they come evenly, which is quicker.

    >>> import numpy as np
    >>> chain = DrivenChain("integrator", np.arange(5.0), np.array([0, 1, 1, 0, 0]), "zero order")
    >>> chain.forced(np.empty((0, 1)), np.array([0.5])).ravel()
    array([0. , 0. , 0.5, 1.5, 2. ])
    """

    def __init__(self, kind: str, times: np.ndarray, u: np.ndarray, hold: str, step: float | None = None) -> None:
        self.kind, self.step = kind, step
        self.lags, self.integrators = KINDS[kind]
        self.times = times - times[0]
        self.u = u[:, None].astype(float)
        self.slopes = None
        if hold == "first order":
            self.slopes = np.append(np.diff(u) / np.diff(times), 0.0)[:, None]
        self.between = np.diff(self.times)[:, None] if step is None else np.array([[step]])

    def forced(self, lags: np.ndarray, delay: np.ndarray) -> np.ndarray:
        """Return the responses, a column for each set of lags and dead time.

        Arguments:
            lags: a row for each lag, the longest first.
            delay: as many dead times as there are columns in `lags`; or more, if that is one column.
        """
        before, elapsed = self._places(delay)
        signals = [*self._states(lags), self.u, self.slopes]
        shares = self._shares(lags, elapsed)[-1]
        if self.step is None:
            return _sum(shares, [None if x is None else _at(x, before) for x in signals])
        late = _sum(shares, signals)  # by less than a sample, alike for all samples
        return _at(np.concatenate([np.zeros((1, late.shape[1])), late]), before)

    def free(self, lags: np.ndarray) -> np.ndarray:
        """Return what the chain does without the control signal, an array of samples, sets of lags, and ways to move.

        One way for each state that is 1 at the first sample, and the last one for a constant input of 1.
        """
        shares = self._shares(lags, self.times[:, None])[-1]
        shape = (len(self.times), lags.shape[1])
        return np.stack([np.broadcast_to(share, shape) for share in shares[:-1]], axis=2)

    def _places(self, delay):
        """For each sample and dead time: the sample before the moment that is seen, and the time from there.

        Of samples that come evenly these are counted from one, zero being any before the record, and the time is one.
        """
        if self.step is not None:
            whole = np.ceil(delay / self.step)
            before = np.arange(1, len(self.times) + 1)[:, None] - whole.astype(int)
            return np.maximum(before, 0), (whole * self.step - delay)[None]
        seen = self.times[:, None] - delay
        before = np.maximum(np.searchsorted(self.times, seen, side="right") - 1, 0)
        return before, np.maximum(seen - self.times[before], 0.0)

    def _states(self, lags):
        """The states at the samples, from rest."""
        states = []
        for k, (*before, own, u, slope) in enumerate(self._shares(lags, self.between)):
            known = [None if x is None else x[:-1] for x in (*states, self.u, self.slopes)]
            states.append(_accumulated(own if k < self.lags else None, _sum([*before, u, slope], known)))
        return states

    def _shares(self, lags, elapsed):
        """What each state is some time later: how much of itself, of those before it, of the input and of its slope.

        In the order of the chain, for an input that begins at u and rises with a slope.
        """
        found = []
        for k in range(self.lags):
            lost = -np.expm1(-elapsed / lags[k])
            line = lags[: k + 1].sum(axis=0)  # so far a state is behind a line
            if k == 0:
                found.append([1 - lost, lost, elapsed - line * lost])
                first = lost
            else:  # the second lag also follows what is left in the first, which is the longer one
                faster = elapsed / lags[1] - elapsed / lags[0]
                follows = elapsed / lags[1] * (1 - first) * _share(faster)
                rest = lost - follows
                found.append([follows, 1 - lost, rest, elapsed - line * lost + follows * lags[0]])
        if self.integrators:
            one = np.ones_like(elapsed)
            if self.lags:
                passed = lags[0] * first
                late = elapsed - passed
                found.append([passed, one, late, elapsed**2 / 2 - lags[0] * late])
            else:
                found.append([one, elapsed, elapsed**2 / 2])
        return found


def _sum(shares, signals):
    """The sum of shares times signals; of a slope that is None there is none."""
    total = 0.0
    for share, signal in zip(shares, signals, strict=True):
        if signal is not None:
            total = total + share * signal
    return total


def _at(x, rows):
    """The values of each column, or of the only one, in rows of its own."""
    columns = x.shape[1]
    return x.ravel().take(rows * columns + (np.arange(columns) if columns > 1 else 0))


def _share(x):
    """(1 - exp(-x))/x, for x not negative."""
    small = x < 1e-8
    return np.where(small, 1 - x / 2, -np.expm1(-x) / np.where(small, 1.0, x))


def _accumulated(decay, change):
    """x from x[0] = 0 and x[k+1] = decay[k] x[k] + change[k], in columns; decay None is 1, one row is all of them.

    In blocks of about the root of the length: all blocks go on at once, and then what each leaves to the next.
    """
    count, columns = change.shape
    x = np.zeros((count + 1, columns))
    if decay is None:
        np.cumsum(change, axis=0, out=x[1:])
        return x
    size = math.isqrt(count - 1) + 1
    blocks = -(-count // size)
    inside = np.zeros((blocks * size, columns))
    inside[:count] = change
    inside = inside.reshape(blocks, size, columns)
    if len(decay) == 1:
        decays = np.broadcast_to(decay[None], (1, size, columns))
    else:
        decays = np.ones((blocks * size, columns))
        decays[:count] = decay
        decays = decays.reshape(blocks, size, columns)
    for k in range(1, size):
        inside[:, k] += decays[:, k] * inside[:, k - 1]
    products = np.cumprod(decays, axis=1)
    whole, last = np.broadcast_to(products[:, -1], (blocks, columns)), inside[:, -1]
    entering = np.zeros((blocks, columns))
    for k in range(1, blocks):
        entering[k] = whole[k - 1] * entering[k - 1] + last[k - 1]
    inside += products * entering[:, None]
    x[1:] = inside.reshape(-1, columns)[:count]
    return x
