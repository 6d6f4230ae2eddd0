"""The error of a loop as a fraction that has an integral, after the proof that it does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime.system import return_difference
from loopbook.quasipolynomials import DelayFraction, read
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import ZERO, Quasipolynomial, earlier, plus, times
from loopbook.stability import StabilityLimitError, unstable_roots
from loopbook.transfer import transfer_function
from plainmath.expressions import s
from plainmath.validation import one_of

if TYPE_CHECKING:
    from fractions import Fraction

__all__ = [
    "MODES", "ErrorFraction", "NotApplicableError", "UnstableLoopError", "blocks_of", "error_after_step", "error_of",
]  # fmt: skip

MODES = ("servo", "regulator")

STEP: Quasipolynomial = {ZERO: (0, 1)}  # what a transfer function is divided by for a step


class UnstableLoopError(ValueError):
    """The loop is not stable, so that the integral of the squared error is infinite."""


class NotApplicableError(Exception):
    """Why a method is not the one for this error."""


def error_of(process: object, controller: object, mode: str, from_setpoint: object) -> DelayFraction:
    """E(s) of a loop for a unit step, with common factors cancelled once."""
    if hasattr(process, "error"):
        if controller is not None or from_setpoint is not None:
            raise ValueError("a loop has its controller already: expected no other one")
        return process.error(mode)
    if controller is None:
        raise ValueError("the controller is missing: expected one, or a loop in place of the process")
    blocks = blocks_of(process, controller, controller if from_setpoint is None else from_setpoint)
    return error_after_step(*blocks, mode)


def blocks_of(*given: object) -> list[DelayFraction]:
    """Process, controller and what is between setpoint and control signal, as fractions without common factors."""
    try:
        fractions = {id(x): read(x).fraction for x in given}  # the setpoint's is often the controller
        return [fractions[id(x)] for x in given]
    except ValueError:
        blocks = [transfer_function(x) for x in given]
        if symbols := sorted(map(str, set().union(*(x.free_symbols for x in blocks)) - {s})):
            raise ValueError(f"give a number for {', '.join(symbols)} in the loop of {blocks[0]}") from None
        raise


def error_after_step(P: DelayFraction, C: DelayFraction, R: DelayFraction, mode: str) -> DelayFraction:
    """E(s) of the loop of these blocks for a unit step, with common factors cancelled once."""
    L = C * P
    difference = return_difference(L)
    returned = times(STEP, difference.numerator)
    if one_of("the mode", mode, MODES) == "regulator":
        return DelayFraction(plus({}, times(P.numerator, L.denominator), -1), times(P.denominator, returned))
    if C == R:
        return DelayFraction(L.denominator, returned)
    # 1/(1 + L) - (R/C) L/(1 + L), over the denominator of R P
    own = times(R.denominator, P.denominator)
    through = times(times(R.numerator, P.numerator), L.denominator)
    return DelayFraction(plus(times(difference.numerator, own), through, -1), times(own, returned))


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
    removable: int = 0  # zeros of D at the origin that N has as well

    @classmethod
    def of(cls, E: object) -> ErrorFraction | None:
        """The fraction of an error; None for one that is zero."""
        fraction = read(E)
        if not fraction.numerator:
            return None
        if not fraction.is_proper or max(map(len, fraction.numerator.values())) > fraction.order:
            raise ValueError(f"{fraction.expr} is not strictly proper: e(t) contains an impulse")
        first = min(fraction.numerator)
        N, D = earlier(fraction.numerator, first), fraction.denominator
        pole = min(next(k for k, c in enumerate(part) if c) for part in D.values())
        D = {delay: part[pole:] for delay, part in D.items()}
        # zeros of D at the origin that only its dead times make, as those of a moving average do
        zeros, poles, _ = fraction.at_origin
        found = cls(fraction, N, D, pole, first, max(0, min(zeros, poles) - pole))
        try:
            if poles > zeros + 1:  # one would be that of the step, where the error does not vanish
                raise StabilityLimitError
            unstable = unstable_roots(D, poles - pole)
        except StabilityLimitError:
            raise UnstableLoopError(
                f"E(s) = {fraction.expr} is not stable: it has poles on the imaginary axis"
            ) from None
        if unstable:
            raise UnstableLoopError(f"{fraction.expr} is not stable: {unstable} poles in the right half-plane")
        if zeros < poles:
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
