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
from loopbook.integrals import Criteria, criteria
from loopbook.integrals.error import MODES
from loopbook.integrals.loops import ise_family
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.symbols import broadcast_values, fraction_of, with_values
from loopbook.stability import Margins, is_closed_loop_stable
from loopbook.stability.counting import ON_LIMIT, count_closed
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.sensitivity import largest_sensitivities
from loopbook.transfer import transfer_function
from plainmath.expressions import exact
from plainmath.validation import one_of, positive, times_from_zero

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import sympy
    from numpy.typing import ArrayLike

__all__ = ["Family"]


class Family:
    """A process under feedback control, for many values of the symbols in it: of settings, or of the process.

    The loop is that of `loops.Loop`. All results are arrays of the shape that the values have together.

    Stability and Ms are validated by the bounds of single loops, on all frequencies, but for coefficients that are
    rounded to sixteen digits. Where these do not decide, the member is asked as a `Loop`, with more; what is then still
    open is an `UndecidedError`.

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
    >>> family
    Family(exp(-s)/(2*s + 1), PID(Kp=Kp, Ti=Ti); 3 loops, validated in double precision)
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
        self._given = controller

    def __repr__(self) -> str:
        controller = self._given if isinstance(self._given, PID) else self._controller
        count = math.prod(self.shape)
        return f"Family({self._process}, {controller}; {count:,} loops, validated in double precision)"

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
        """Whether each closed loop is stable; a pole that controller and process cancel is not seen.

        Of a loop so close to the limit that sixteen digits do not decide, the member itself is asked, with more.
        """
        counts = count_closed(*self._open)
        for point in np.flatnonzero(counts == ON_LIMIT):
            counts[point] = 0 if is_closed_loop_stable(self._member(int(point))) else math.inf
        return (counts == 0).reshape(self.shape)

    def Ms(self) -> np.ndarray:
        """Return the largest sensitivities, the largest values of abs(1/(1 + L)); infinite for unstable loops."""
        try:
            found = largest_sensitivities(*self._open)
        except UndecidedError:  # one loop is enough for it
            found = np.full(math.prod(self.shape), math.nan)
        for point in np.flatnonzero(np.isnan(found)):
            found[point] = self._member(int(point)).margins().Ms if self.is_stable.flat[point] else math.inf
        return found.reshape(self.shape)

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

    # ---- member by member

    @functools.cached_property
    def loops(self) -> np.ndarray:
        """Each member as a `Loop`, an array of objects; decimal values are taken as they are meant.

        >>> import sympy
        >>> from loopbook import s
        >>> K = sympy.Symbol("K")
        >>> Family(1 / s, K, K=[0.5, 2]).loops[1].servo
        System(2/(s + 2))
        """
        found = np.empty(math.prod(self.shape), dtype=object)
        for point in range(found.size):
            found[point] = self._member(point)
        return found.reshape(self.shape)

    def _member(self, point: int) -> Loop:
        symbols = [x for x in (self._process + self._controller).free_symbols if str(x) in self._values]
        values = {x: exact(float(self._values[str(x)][point])) for x in symbols}
        return Loop(self._process.xreplace(values), self._controller_with(values))

    def _controller_with(self, values: dict[sympy.Expr, sympy.Expr]) -> PID | sympy.Expr:
        """The controller with numbers for its symbols, a `PID` if one was given."""
        if not isinstance(self._given, PID):
            return self._controller.xreplace(values)
        times = {name: getattr(self._given, name).xreplace(values) for name in ("Kp", "Ti", "Td", "Tf")}
        return PID(**times, form=self._given.form)

    def margins(self) -> Margins:
        """Return gain, phase and delay margins and Ms, with their frequencies: `stability.Margins` of arrays.

        There is no short way for many at once: each loop takes what `Loop.margins` does, 10 to 30 ms. Those that
        are not stable have Ms = inf and nan for all else.

        >>> import sympy
        >>> from loopbook import s
        >>> K = sympy.Symbol("K")
        >>> Family(sympy.exp(-s) / s, K, K=[0.5, 1, 2]).margins().gain_margin.round(4)
        array([3.1416, 1.5708,    nan])
        """
        none = Margins(*[math.nan] * 8)._replace(Ms=math.inf)
        return Margins(*self._of_each(Loop.margins, none))

    def criteria(self, mode: str = "servo", tolerance: float = 1e-9) -> Criteria:
        """Return ISE, IAE, ITAE and ITSE after a unit step: `integrals.Criteria` of arrays, infinite where not stable.

        There is no short way for many at once but for `ise`: each loop takes what `Loop.criteria` does, 10 to
        50 ms.

        Arguments:
            mode: as for `ise`.
            tolerance: the share of each integral that may be left out; 1e-4 is enough to compare settings.

        >>> import sympy
        >>> from loopbook import s
        >>> K = sympy.Symbol("K")
        >>> Family(sympy.exp(-s) / s, K, K=[0.5, 2]).criteria().IAE.round(4)
        array([2.1687,    inf])
        """
        one_of("the mode", mode, MODES)
        return Criteria(*self._of_each(lambda loop: loop.criteria(mode, tolerance), [math.inf] * 4))

    def _of_each(self, question: Callable[[Loop], tuple[float, ...]], unstable: Sequence[float]) -> list[np.ndarray]:
        """The answers of all members, an array for each number in them."""
        members = zip(self.loops.flat, self.is_stable.flat, strict=True)
        rows = [question(loop) if stable else unstable for loop, stable in members]
        return [np.reshape(column, self.shape) for column in zip(*rows, strict=True)]

    def best(self, by: str = "IAE", Ms: float = 1.6, mode: str = "servo") -> dict[str, float]:
        """Return the values with the smallest criterion among the loops whose largest sensitivity is within a limit.

        Arguments:
            by: "ISE", "IAE", "ITAE" or "ITSE". Only ISE is computed for all loops at once; for the others each loop
                within the limit takes 10 to 20 ms.
            Ms: the limit; 1.6 is a usual one, and 2 allows a faster loop.
            mode: as for `ise`.
        Returns:
            A value for each symbol by its name, so that ``PID(**family.best())`` is the controller where the symbols
            are called as its settings.
        Raises:
            ValueError: for another criterion, a limit that no loop is within, or as `ise`.

        >>> import sympy
        >>> from loopbook import first_order
        >>> from loopbook.pid import PID
        >>> Kp, Ti = sympy.symbols("Kp Ti", positive=True)
        >>> settings = {"Kp": [[0.2], [0.3], [0.4]], "Ti": [4, 6, 8]}
        >>> Family(first_order(2, 5, delay=4), PID(Kp, Ti), **settings).best(Ms=1.6)
        {'Kp': 0.3, 'Ti': 6.0}
        """
        by, limit, found = one_of("by", by.upper(), Criteria._fields), positive("Ms", Ms), self.Ms().ravel()
        within = np.flatnonzero(found <= limit)
        if not within.size:
            raise ValueError(f"no loop has an Ms of at most {limit:g}: the smallest is {found.min():.3g}")
        if by == "ISE":
            values = self.ise(mode).ravel()[within]
        else:
            values = [getattr(criteria(loop, mode=mode, tolerance=1e-6), by) for loop in self.loops.ravel()[within]]
        return {name: float(row[within[np.argmin(values)]]) for name, row in self._values.items()}


def _padded(sums: Quasipolynomials, order: int) -> Quasipolynomials:
    """The same quasipolynomials with more powers."""
    missing = ((0, 0), (0, order - sums.order), (0, 0))
    return Quasipolynomials(np.pad(sums.coefficients, missing), sums.delays)


def _shifted(rows):
    """Coefficients of quasipolynomials, times s."""
    return np.pad(rows, ((0, 0), (1, 0), (0, 0)))
