"""The integral of the squared error of any stable loop, by the first method that applies, and of many loops at once."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.integrals.error import ErrorFraction, NotApplicableError, UnstableLoopError, error_of
from loopbook.integrals.residues import by_residues, sums_of_residues
from loopbook.integrals.responses import by_response
from loopbook.quasipolynomials.symbols import fraction_of
from loopbook.stability.counting import ON_LIMIT, count_roots
from loopbook.stability.enclosures import UndecidedError
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.quasipolynomials.arrays import Quasipolynomials

__all__ = ["integral_of_square", "ise", "ise_family"]

METHODS = {"residues": by_residues, "response": by_response}


def ise(
    process: object,
    controller: object = None,
    mode: str = "servo",
    from_setpoint: object = None,
    method: str | None = None,
) -> float:
    """Return the integral of the squared control error after a unit step, with exact dead time.

    Arguments:
        process, controller, from_setpoint: as for `loops.Loop`; or a loop alone in place of the process.
        mode: "servo" for a step of the setpoint, "regulator" for one of the load at the process input.
        method: as for `integral_of_square`.
    Returns:
        A float, in the output's unit squared, times the unit of time.
    Raises:
        UnstableLoopError: if the loop is not stable. A pole that controller and process cancel is not seen in the error
            after a step of the setpoint: if it is unstable, the loop is, and the caller has to know.
        ValueError: for an error that does not vanish, as under proportional control, or as `integral_of_square`.

    >>> import sympy
    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> round(ise(sympy.exp(-s / 2) / (s + 1), PID(1, Ti=1)), 6)
    0.842898
    """
    return integral_of_square(error_of(process, controller, mode, from_setpoint), method)


def integral_of_square(E: object, method: str | None = None) -> float:
    """Return the integral of e(t)^2 from zero to infinity, for the transform E(s) of e(t).

    There are two methods, of which the first that can be applied is taken unless one is named:

    - "residues": one dead time, or none; the formula of `residue_method` in floating point. It does not apply where it
      may lose more than five digits of sixteen, because zeros lie close together or the loop is near its limit.
    - "response": any dead times. The exact step response is followed until its slowest modes are left, as in
      `criteria`; the relative error is about 1e-11.

    Arguments:
        E: expression in `s` with numbers, a `System`, or a system of python-control.
        method: one of the names, or None.
    Returns:
        A float.
    Raises:
        UnstableLoopError: for poles of E in the right half-plane or on the imaginary axis.
        UndecidedError: for poles of E so close to the axis that it is not told on which side they are.
        ValueError: if e(t) does not vanish, contains an impulse, or the method cannot be applied to it.

    >>> import sympy
    >>> from loopbook import s
    >>> integral_of_square(1 / (s + 1))
    0.5
    >>> E = 1 / (s + sympy.exp(-s) + sympy.exp(-2 * s) / 5)
    >>> round(integral_of_square(E), 8)
    2.5688072
    """
    names = METHODS if method is None else [one_of("method", method, METHODS)]
    fraction = ErrorFraction.of(E)
    if fraction is None:
        return 0.0
    reasons = []
    for name in names:
        try:
            return METHODS[name](fraction)
        except NotApplicableError as reason:
            reasons.append(f"{name}: {reason}")
    raise ValueError(f"the integral cannot be found by {'; '.join(reasons)}")


def ise_family(above: Quasipolynomials, below: Quasipolynomials) -> np.ndarray:
    """Return the integrals of e(t)^2 for many errors ``E = above/below`` of one form, as for settings of a controller.

    With one dead time or none at a point, residues are computed for all points at once, each with the bound of the
    digits that it loses. Points that fail it, or have several dead times, are left to `integral_of_square`.

    Returns:
        An array with a value for each point; ``math.inf`` where E has poles in the right half-plane or on the axis, nan
        where that is not decided.
    Raises:
        ValueError: as `integral_of_square`.
    """
    count = max(above.count, below.count)
    parts = [
        np.broadcast_to(x, (*x.shape[:-1], count)) for sums in (above, below) for x in (sums.coefficients, sums.delays)
    ]
    counts = np.broadcast_to(count_roots(below), count)
    # a pole at zero may be cancelled, and without its highest power a denominator has another order
    left = (counts == ON_LIMIT) | (parts[2][0, -1] == 0)
    values = np.where(left, math.nan, np.where(counts > 0, math.inf, sums_of_residues(*parts)))
    for point in np.flatnonzero(np.isnan(values)):
        try:
            values[point] = integral_of_square(fraction_of(above, below, point))
        except UnstableLoopError:
            values[point] = math.inf
        except UndecidedError:
            values[point] = math.nan
    return values
