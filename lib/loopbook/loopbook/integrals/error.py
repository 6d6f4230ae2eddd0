"""The error of a loop as a fraction that has an integral, after the proof that it does."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from loopbook.deadtime import Loop
from loopbook.quasipolynomials import DelayFraction, read
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import Quasipolynomial, taylor_coefficient
from loopbook.stability import StabilityLimitError, unstable_roots

__all__ = ["ErrorFraction", "NotApplicableError", "UnstableLoopError", "error_of"]

ZERO = Fraction(0)


class UnstableLoopError(ValueError):
    """The loop is not stable, so that the integral of the squared error is infinite."""


class NotApplicableError(Exception):
    """Why a method is not the one for this error."""


def error_of(process: object, controller: object, mode: str, from_setpoint: object) -> DelayFraction:
    """E(s) of a loop for a unit step, with common factors cancelled once."""
    if isinstance(process, Loop):
        if controller is not None or from_setpoint is not None:
            raise ValueError("a loop has its controller already: expected no other one")
        loop = process
    elif controller is None:
        raise ValueError("the controller is missing: expected one, or a loop in place of the process")
    else:
        loop = Loop(process, controller, from_setpoint)
    return loop.error(mode)


@dataclass(frozen=True)
class ErrorFraction:
    """An error that has an integral: E = N/(s^pole D), all poles of 1/D in the left half-plane.

    The step of the input makes a pole at zero, which N cancels. A Smith predictor does that by its dead times, as in
    (1 - exp(-s))/s, and no common factor can be taken out.
    """

    fraction: DelayFraction
    N: Quasipolynomial  # begins without dead time: what it has at least of that is left out
    D: Quasipolynomial
    pole: int
    earliest: Fraction  # when the error begins

    @classmethod
    def of(cls, E: object) -> ErrorFraction | None:
        """The fraction of an error; None for one that is zero."""
        fraction = read(E)
        if not fraction.numerator:
            return None
        order = fraction.order
        if not fraction.is_proper or any(len(part) > order for part in fraction.numerator.values()):
            raise ValueError(f"{fraction.expr} is not strictly proper: e(t) contains an impulse")
        N, D = fraction.numerator, fraction.denominator
        first = min(N)
        if first:  # later by a dead time, the integral is the same
            N = {delay - first: part for delay, part in N.items()}
        pole = min(next(k for k, c in enumerate(part) if c) for part in D.values())
        if pole:
            D = {delay: part[pole:] for delay, part in D.items()}
        found = cls(fraction, N, D, pole, first)
        try:
            unstable = unstable_roots(D)
        except StabilityLimitError:
            raise UnstableLoopError(
                f"E(s) = {fraction.expr} is not stable: it has poles on the imaginary axis"
            ) from None
        if unstable:
            raise UnstableLoopError(f"{fraction.expr} is not stable: {unstable} poles in the right half-plane")
        for k in range(pole):
            if taylor_coefficient(N, k):
                raise ValueError(f"the error does not vanish: E(s) = {fraction.expr} has a pole at zero")
        return found

    @property
    def order(self) -> int:
        """The degree of D."""
        return len(self.D[ZERO]) - 1

    @property
    def speed(self) -> float:
        """A frequency beside which no pole without dead time is large."""
        leading = abs(self.D[ZERO][-1])
        sizes = [sum(abs(part[k]) for part in self.D.values() if k < len(part)) for k in range(self.order)]
        found = [(size / leading) ** (1 / (self.order - k)) for k, size in enumerate(sizes)]
        longest = float(max((*self.N, *self.D)))
        return max(found, default=1 / longest if longest else 1.0)

    def sums(self, speed: float) -> tuple[Quasipolynomials, Quasipolynomials]:
        """N and D in s/speed, over the leading coefficient of D."""
        leading, unit = self.D[ZERO][-1], np.full(1, speed)
        return tuple(Quasipolynomials.exact(x, self.order, leading).slower(unit) for x in (self.N, self.D))
