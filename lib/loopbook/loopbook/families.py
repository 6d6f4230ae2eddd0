"""Whole families of loops: one loop with symbols, for arrays of their values at once.

Tuning, maps and sliders ask the same question of many settings. A family answers it in one call, which takes a small
part of the time of as many single ones.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime.channels import ChannelModel
from loopbook.deadtime.family import step_family
from loopbook.ise.family import ise_family
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.symbols import broadcast_values, with_values
from loopbook.stability.counting import count_roots
from loopbook.stability.sensitivity import largest_sensitivities
from loopbook.transfer import transfer_function
from plainmath.validation import one_of, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Family"]

MODES = ("servo", "regulator")


class Family:
    """A process under feedback control, for many values of the symbols in it: of settings, or of the process.

    The loop is that of `deadtime.Loop`. All results are arrays of the shape that the values have together.

    Arguments:
        process, controller: as for `deadtime.Loop`, with symbols.
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
        if above.order > below.order:
            raise ValueError(f"the signal {signal} is improper: expected no more zeros than poles")
        model = _state_space(_padded(above, below.order), below)
        return step_family(model, times).reshape(*self.shape, len(times))


def _padded(sums: Quasipolynomials, order: int) -> Quasipolynomials:
    """The same quasipolynomials with more powers."""
    missing = ((0, 0), (0, order - sums.order), (0, 0))
    return Quasipolynomials(np.pad(sums.coefficients, missing), sums.delays)


def _shifted(rows):
    """Coefficients of quasipolynomials, times s."""
    return np.pad(rows, ((0, 0), (1, 0), (0, 0)))


def _state_space(above: Quasipolynomials, below: Quasipolynomials) -> ChannelModel:
    """The controllable canonical forms of many systems, arrays with a leading axis for the systems.

    Time is in a unit of each system's own for the states, so that their sizes are alike.
    """
    n, count = below.order, max(above.count, below.count)
    above, below = (
        [np.broadcast_to(x, (*x.shape[:-1], count)) for x in (sums.coefficients, sums.delays)]
        for sums in (above, below)
    )
    leading = below[0][0, -1]
    # a frequency at which the powers weigh about the same
    sizes = abs(below[0] / leading).sum(axis=0)
    with np.errstate(divide="ignore"):
        rates = (sizes[:-1] ** (1 / np.arange(n, 0, -1)[:, None])).max(axis=0, initial=0.0) if n else leading * 0
    rate = np.where(rates > 0, rates, 1.0)

    def rows(coefficients):  # [system, part, power], of s/rate
        scale = rate ** (np.arange(n + 1) - n)[:, None]
        return np.moveaxis(coefficients * scale / leading, -1, 0)

    undelayed = (above[1] == 0).all(axis=1)
    parts, late = rows(above[0]), np.moveaxis(above[1], -1, 0)
    direct, ahead = parts[:, undelayed].sum(axis=1, keepdims=True), parts[:, ~undelayed]
    denominator = rows(below[0])
    own, back = denominator[:, 0, :n], denominator[:, 1:]
    channels = np.concatenate([back, ahead], axis=1)
    delays = np.concatenate([np.moveaxis(below[1], -1, 0)[:, 1:], late[:, ~undelayed]], axis=1)
    returns = np.r_[-np.ones(back.shape[1]), np.zeros(ahead.shape[1])]
    to_output = np.r_[np.zeros(back.shape[1]), np.ones(ahead.shape[1])]
    A = np.zeros((count, n, n))
    B1, B2 = np.zeros((count, n, 1)), np.zeros((count, n, len(returns)))
    if n:
        A[:, range(n - 1), range(1, n)] = 1
        A[:, -1] = -own
        A *= rate[:, None, None]
        B1[:, -1, 0], B2[:, -1] = rate, rate[:, None] * returns
    C1, C2 = (c[..., :n] - c[..., n:] * own[:, None] for c in (direct, channels))
    D11, D21 = direct[..., n:], channels[..., n:]
    return ChannelModel(A, B1, B2, C1, C2, D11, D11 * returns + to_output, D21, D21 * returns, delays)
