"""Whole families of loops: one loop with symbols, for arrays of their values at once.

Tuning, maps and sliders ask the same question of many settings. A family answers it in one call, which for stability,
sensitivity and integrals takes a small part of the time of as many single ones.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime import System
from loopbook.integrals.error import MODES
from loopbook.integrals.family import ise_family
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.symbols import broadcast_values, fraction_of, with_values
from loopbook.stability.counting import count_roots
from loopbook.stability.sensitivity import largest_sensitivities
from loopbook.transfer import transfer_function
from plainmath.validation import one_of, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Family"]


class Family:
    """A process under feedback control, for many values of the symbols in it: of settings, or of the process.

    The loop is that of `loops.Loop`. All results are arrays of the shape that the values have together.

    Arguments:
        process, controller: as for `loops.Loop`, with symbols.
        **values: the values of the symbols by their names, numbers or arrays that fit together.
    Attributes:
        shape: that of the results.
    Raises:
        ValueError: for symbols without values, values without symbols, shapes that do not fit, or a negative dead time.

    >>> import sympy
    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> Kp, Ti = sympy.symbols("Kp Ti", positive=True)
    >>> family = Family(sympy.exp(-s) / (2 * s + 1), PID(Kp, Ti), Kp=[0.5, 1, 5], Ti=2)
    >>> family.is_stable
    array([ True,  True, False])
    >>> family.Ms().round(4)
    array([1.2489, 1.5905,    inf])
    >>> family.ise().round(4)
    array([2.5749, 1.6858,    inf])
    """

    def __init__(self, process: object, controller: object, **values: ArrayLike):
        P, C = transfer_function(process), transfer_function(controller)
        symbols = {str(symbol) for symbol in (P + C).free_symbols} - {"s"}
        if symbols != set(values):
            raise ValueError(
                f"the loop has the symbols {', '.join(sorted(symbols)) or 'none'}, and there are values for "
                f"{', '.join(sorted(values)) or 'none'}: expected the same"
            )
        self._values, self.shape = broadcast_values(values)
        self._process, self._controller = P, C

    # ---- the loop in numbers

    @functools.cached_property
    def _open(self) -> tuple[Quasipolynomials, Quasipolynomials]:
        """Numerator and denominator of the open loop, with as many powers."""
        A, B = with_values(self._controller * self._process, self._values)
        order = B.order
        if A.order > order:
            raise ValueError(f"{self._controller * self._process} is improper: expected no more zeros than poles")
        return _padded(A, order), B

    @functools.cached_property
    def _closed(self) -> Quasipolynomials:
        A, B = self._open
        return B + A

    def _forward(self, signal: str) -> tuple[Quasipolynomials, Quasipolynomials]:
        """Numerator and denominator of a closed loop."""
        A, B = self._open
        if signal in ("T", "S"):
            return A if signal == "T" else B, self._closed
        (p, q), (c, d) = (with_values(block, self._values) for block in (self._process, self._controller))
        return p * d if signal == "PS" else c * q, d * q + c * p

    # ---- questions

    @functools.cached_property
    def is_stable(self) -> np.ndarray:
        """Whether each closed loop is stable; a pole that controller and process cancel is not seen."""
        return (count_roots(self._closed) == 0).reshape(self.shape)

    def Ms(self) -> np.ndarray:
        """Return the largest sensitivities, the largest values of abs(1/(1 + L)); infinite for unstable loops."""
        found = largest_sensitivities(*self._open)
        return np.where(np.isnan(found), math.inf, found).reshape(self.shape)

    def ise(self, mode: str = "servo") -> np.ndarray:
        """Return the integrals of the squared error after a unit step, infinite for unstable loops.

        Arguments:
            mode: "servo" for a step of the setpoint, "regulator" for one of the load at the process input.
        Raises:
            ValueError: for another mode, or an error that does not vanish, as without integral action.
        """
        above, below = self._forward("S" if one_of("the mode", mode, MODES) == "servo" else "PS")
        rows = above.coefficients
        if not rows[:, 0].any():  # the step's pole at zero is cancelled
            above = Quasipolynomials(rows[:, 1:], above.delays)
        else:
            below = Quasipolynomials(_shifted(below.coefficients), below.delays)
        return ise_family(above, below).reshape(self.shape)

    def step(self, times: ArrayLike, signal: str = "T") -> np.ndarray:
        """Return the responses to a unit step, with an axis for the times behind those of the values.

        Arguments:
            times: an array of times, not negative, of one dimension.
            signal: "T" for the measurement after a step of the setpoint, "S" for the control error, "PS" for the
                measurement after a step of the load, "CS" for the control signal after a step of the setpoint.
        Raises:
            ValueError: for another signal or other times, an improper system, or as `System.step`.

        >>> import sympy
        >>> from loopbook import s
        >>> K = sympy.Symbol("K")
        >>> Family(sympy.exp(-s) / s, K, K=[0.5, 1]).step([2, 2.5]).round(6)
        array([[0.5    , 0.71875],
               [1.     , 1.375  ]])
        """
        times = np.atleast_1d(times_from_zero(times))
        if times.ndim != 1:
            raise ValueError(f"the times have the shape {times.shape}: expected one dimension")
        above, below = self._forward(one_of("the signal", signal, ("T", "S", "PS", "CS")))
        count = math.prod(self.shape)
        responses = [System(fraction_of(above, below, point)).step(times) for point in range(count)]
        return np.reshape(responses, (*self.shape, len(times)))


def _padded(sums: Quasipolynomials, order: int) -> Quasipolynomials:
    """The same quasipolynomials with more powers."""
    missing = ((0, 0), (0, order - sums.order), (0, 0))
    return Quasipolynomials(np.pad(sums.coefficients, missing), sums.delays)


def _shifted(rows):
    """Coefficients of quasipolynomials, times s."""
    return np.pad(rows, ((0, 0), (1, 0), (0, 0)))
