"""The slowest modes of an error, of infinitely many: all poles to the right of a line, and their integrals."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from loopbook.integrals.error import ErrorFraction
from loopbook.stability.poles import roots_right_of

DIGITS = 40
MOST_MODES, FEW_MODES = 80, 20  # more than a few are sought only where it would last long to wait until they are few
MOST_SAMPLES = 15_000_000  # of a sum of several modes, before one of them is left
CHUNK = 8192
STEP = 0.4  # between samples, as a share of the fastest mode's time


class ManyModesError(Exception):
    """Several modes last too long together."""


@dataclass(frozen=True)
class Modes:
    """The sum of the real parts of ``weight*residue*exp(pole*t)``, the weight 2 for one of a pair and 1 for a real
    pole.

    Attributes:
        poles, residues: arrays, of each pair the upper pole.
    """

    poles: np.ndarray
    residues: np.ndarray

    @property
    def weights(self) -> np.ndarray:
        return np.where(self.poles.imag > 0, 2.0, 1.0)

    def __call__(self, times: np.ndarray) -> np.ndarray:
        total = np.zeros(np.shape(times))
        for p, c, weight in zip(self.poles, self.residues, self.weights, strict=True):
            total += weight * (c * np.exp(p * times)).real
        return total

    def later(self, time: float) -> Modes:
        """The same as a function of the time since then."""
        return Modes(self.poles, self.residues * np.exp(self.poles * time))

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Of each mode, bounds of its integral from zero on, without and with the time as a weight."""
        sizes, rates = self.weights * abs(self.residues), -self.poles.real
        return sizes / rates, sizes / rates**2

    def squares(self) -> tuple[float, float]:
        """The integrals of the square from zero on, without and with the time as a weight."""
        pairs = self.poles.imag > 0
        p = np.concatenate([self.poles, self.poles[pairs].conj()])
        c = np.concatenate([self.residues, self.residues[pairs].conj()])
        products, sums = c[:, None] * c, p[:, None] + p
        return float(-(products / sums).sum().real), float((products / sums**2).sum().real)

    def sizes(self, begin: float, allowed: tuple[float, float]) -> tuple[float, float]:
        """The integrals of the absolute value, and of that with begin + t as a weight, from zero on.

        Arguments:
            begin: the time at which t is zero.
            allowed: the errors that both may have.
        Raises:
            ManyModesError: if several modes last so long together that their zeros would be too many.
        """
        if not len(self.poles):
            return 0.0, 0.0
        order = np.argsort(-self.poles.real)
        modes, now, total, samples = Modes(self.poles[order], self.residues[order]), 0.0, np.zeros(2), 0
        while True:
            plain, weighted = modes.bounds()
            weighted = weighted + (begin + now) * plain
            # what is small enough is left out, the fastest first
            rest = np.maximum(plain[::-1].cumsum() / allowed[0], weighted[::-1].cumsum() / allowed[1])[::-1]
            keep = max(1, int((rest > 1).sum()))
            if keep == 1:
                return tuple(total + modes._alone(begin + now))
            amplitudes = modes.weights * abs(modes.residues)
            if not modes.poles[0].imag and amplitudes[0] > amplitudes[1:].sum():  # it changes its sign no more
                return tuple(total + abs(modes._signed(begin + now)))
            if keep < len(modes.poles) or not samples:
                modes = Modes(modes.poles[:keep], modes.residues[:keep])
                times = STEP / abs(modes.poles).max() * np.arange(CHUNK + 1)
                waves = np.exp(modes.poles[:, None] * times)  # the same for each chunk
            samples += CHUNK
            if samples > MOST_SAMPLES:
                raise ManyModesError
            total += modes._chunk(begin + now, times, waves)
            modes, now = modes.later(times[-1]), now + float(times[-1])

    def _antiderivatives(self, times: np.ndarray, begin: float) -> np.ndarray:
        """Functions of time whose changes are integrals, without and with begin + t as a weight: array [2, time]."""
        p, c, waves = self.poles, self.weights * self.residues, np.exp(self.poles[:, None] * times)
        plain = ((c / p) @ waves).real
        return np.array([plain, (begin + times) * plain - ((c / p**2) @ waves).real])

    def _signed(self, begin: float) -> np.ndarray:
        """The integrals from zero on, without and with begin + t as a weight."""
        return -self._antiderivatives(np.zeros(1), begin)[:, 0]

    def _alone(self, begin: float) -> np.ndarray:
        """The integrals of `sizes` for the first mode: of a pair, half periods that shrink by one factor."""
        mode, p, c = Modes(self.poles[:1], self.residues[:1]), complex(self.poles[0]), complex(self.residues[0])
        if not p.imag:
            return abs(mode._signed(begin))
        half, first = math.pi / p.imag, (math.pi / 2 - math.atan2(c.imag, c.real)) % math.pi / p.imag
        head, one = abs(np.diff(mode._antiderivatives(np.array([0.0, first, first + half]), begin))).T
        shrunk, lost = math.exp(p.real * half), -math.expm1(p.real * half)
        return head + one / lost + [0.0, half * shrunk * one[0] / lost**2]

    def _chunk(self, begin: float, times: np.ndarray, waves: np.ndarray) -> np.ndarray:
        """The integrals of `sizes` over times, between zeros that are sought between the samples."""
        p, c = self.poles, self.weights * self.residues
        value, slope = (np.stack([c, c * p]) @ waves).real

        def at(times, k):
            return (np.stack([c * p**k, c * p ** (k + 1)]) @ np.exp(p[:, None] * times)).real

        # between two samples it may dip through zero and come back
        turns = (value[:-1] * slope[:-1] < 0) & (value[1:] * slope[1:] > 0) & (value[:-1] * value[1:] > 0)
        if len(dips := np.flatnonzero(turns)):
            turning = _zeros(functools.partial(at, k=1), times[dips], times[dips + 1], slope[dips], slope[dips + 1])
            times = np.insert(times, dips + 1, turning)
            value = np.insert(value, dips + 1, at(turning, 0)[0])
        negative = value < 0
        change = np.flatnonzero(negative[:-1] != negative[1:])
        zeros = _zeros(functools.partial(at, k=0), times[change], times[change + 1], value[change], value[change + 1])
        knots = np.concatenate([times[:1], zeros, times[-1:]])
        signs = np.where(np.concatenate([negative[change], negative[-1:]]), -1.0, 1.0)
        return np.diff(self._antiderivatives(knots, begin)) @ signs


def _zeros(function, a, b, at_a, at_b):
    """The zeros between a and b, one in each interval, of functions that are nearly straight there."""
    with np.errstate(all="ignore"):
        x = np.where(at_a == at_b, a, a + (b - a) * at_a / (at_a - at_b))
        for _ in range(4):
            value, slope = function(x)
            step = value / slope
            x = np.where(np.isfinite(step), np.clip(x - step, a, b), x)
            if not len(x) or (abs(step) < 1e-9 * (b - a)).all():
                break
    return x


# ---- finding them


def slow_modes(fraction: ErrorFraction, rate: float, most: int = MOST_MODES) -> Modes | None:
    """The modes of all poles of an error with real parts above -rate, as many as the argument principle counts.

    The time is counted from when the error begins.

    None if there are too many, or they are not found, as `roots_right_of` says.
    """
    poles = roots_right_of(fraction.sums(rate)[1], -1.0, most, fraction.removable)
    exact = [None] if poles is None else [_exact(fraction, p * rate) for p in poles]
    if any(e is None for e in exact):
        return None
    return Modes(*np.array(exact, dtype=complex).reshape(-1, 2).T)


def _exact(fraction: ErrorFraction, pole: complex) -> tuple[complex, complex] | None:
    """A pole, from one that is nearly that, and its residue, each with all digits of floating point."""
    import mpmath

    def value(parts, p, k):
        total = mpmath.mpf(0)
        for delay, part in parts.items():
            late = mpmath.mpf(delay.numerator) / delay.denominator
            polynomial, slope = mpmath.polyval(part[::-1], p, derivative=True)
            total += (slope - late * polynomial if k else polynomial) * mpmath.exp(-late * p)
        return total

    with mpmath.workdps(DIGITS):
        p = mpmath.mpf(pole.real) if not pole.imag else mpmath.mpc(pole)
        for _ in range(20):
            step = value(fraction.D, p, 0) / value(fraction.D, p, 1)
            p -= step
            if abs(step) <= mpmath.mpf(10) ** (5 - DIGITS) * abs(p):
                break
        else:
            return None
        if abs(p - mpmath.mpmathify(pole)) > 1e-5 * abs(p) or not p.real < 0:
            return None
        residue = value(fraction.N, p, 0) / value(fraction.D, p, 1) / p**fraction.pole
        return complex(p), complex(residue)
