"""The error of a loop as a fraction that has an integral, after the proof that it does."""

import math
from dataclasses import dataclass
from fractions import Fraction

import sympy

from loopbook.deadtime import Loop, System
from loopbook.expressions import s
from loopbook.stability import StabilityLimitError, unstable_roots

__all__ = ["ErrorFraction", "NotApplicableError", "UnstableLoopError", "checked_mode", "error_of"]

MODES = ("servo", "regulator")


class UnstableLoopError(ValueError):
    """The loop is not stable, so that the integral of the squared error is infinite."""


def checked_mode(mode):
    if mode not in MODES:
        raise ValueError(f"the mode is {mode!r}: expected 'servo' or 'regulator'")
    return mode


def error_of(process, controller, mode, from_setpoint):
    if isinstance(process, Loop):
        if controller is not None or from_setpoint is not None:
            raise ValueError("a loop has its controller already: expected no other one")
        return process.error(checked_mode(mode))
    if controller is None:
        raise ValueError("the controller is missing: expected one, or a loop in place of the process")
    return Loop(process, controller, from_setpoint).error(checked_mode(mode))


def _fraction(number):
    return Fraction(int(number.p), int(number.q))


def _taylor_coefficient(parts, k):
    """The coefficient of s^k of a sum of polynomials with dead times, exact."""
    return sum(
        c * (-delay) ** (k - i) / math.factorial(k - i)
        for delay, part in parts.items()
        for i, c in enumerate(part[: k + 1])
    )


class NotApplicableError(Exception):
    """Why a method is not the one for this error."""


@dataclass(frozen=True)
class ErrorFraction:
    """An error that has an integral: E = N/(s^pole D), all poles of 1/D in the left half-plane.

    The step of the input makes a pole at zero, which N cancels. A Smith predictor does that by its dead times, as in
    (1 - exp(-s))/s, and no common factor can be taken out.
    """

    system: System
    N: dict  # {delay: coefficients, lowest power first}, exact
    D: dict
    pole: int

    @classmethod
    def of(cls, E):
        system = System(E)
        if not system.numerator:
            return None
        order = system.denominator[0].degree()
        if any(part.degree() >= order for part in system.numerator.values()):
            raise ValueError(f"{system.expr} is not strictly proper: e(t) contains an impulse")
        N, D = (
            {_fraction(delay): [_fraction(c) for c in reversed(part.all_coeffs())] for delay, part in parts.items()}
            for parts in (system.numerator, system.denominator)
        )
        first = min(N)
        N = {delay - first: part for delay, part in N.items()}  # later by a dead time, the integral is the same
        pole = min(next(k for k, c in enumerate(part) if c) for part in D.values())
        D = {delay: part[pole:] for delay, part in D.items()}
        try:
            denominator = system.denominator
            if pole:
                factor = sympy.Poly(s**pole, s, domain="QQ")
                denominator = {delay: part.quo(factor) for delay, part in denominator.items()}
            unstable = unstable_roots(denominator)
        except StabilityLimitError:
            raise UnstableLoopError(f"E(s) = {system.expr} is not stable: it has poles on the imaginary axis") from None
        if unstable:
            raise UnstableLoopError(f"E(s) = {system.expr} is not stable: {unstable} poles in the right half-plane")
        for k in range(pole):
            if _taylor_coefficient(N, k):
                raise ValueError(f"the error does not vanish: E(s) = {system.expr} has a pole at zero")
        return cls(system, N, D, pole)

    @property
    def order(self):
        """The degree of D."""
        return len(self.D[0]) - 1

    @property
    def speed(self):
        """A frequency beside which no pole without dead time is large."""
        leading = abs(float(self.D[0][-1]))
        sizes = [sum(abs(float(part[k])) for part in self.D.values() if k < len(part)) for k in range(self.order)]
        found = [(size / leading) ** (1 / (self.order - k)) for k, size in enumerate(sizes)]
        return max(found, default=self._of_dead_times)

    @property
    def mean_speed(self):
        """The geometric mean of the poles, the dead times left out of account."""
        lowest = abs(float(sum(part[0] for part in self.D.values()) / self.D[0][-1]))
        return lowest ** (1 / self.order) if self.order else self._of_dead_times

    @property
    def _of_dead_times(self):
        longest = float(max((*self.N, *self.D)))
        return 1 / longest if longest else 1.0

    def arrays(self, speed):
        """Coefficients of N and D in s/speed, a row for each dead time, and the dead times, as arrays of floats."""
        import numpy

        leading = float(self.D[0][-1]) * speed ** (self.order + self.pole)

        def rows(parts, columns, factor):
            table = numpy.zeros((len(parts), columns))
            for row, part in zip(table, parts.values(), strict=True):
                row[: len(part)] = [float(c) * speed**k * factor / leading for k, c in enumerate(part)]
            return table, numpy.array([float(delay) * speed for delay in parts])

        return *rows(self.N, self.order + self.pole, 1), *rows(self.D, self.order + 1, speed**self.pole)

    def need_retarded(self):
        if self.system.is_neutral:
            raise NotApplicableError("the highest derivative has a dead time")
