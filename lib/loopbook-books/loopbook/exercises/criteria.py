"""Criteria that many designs of controllers share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from exercisebook.formulas import Formula
from exercisebook.kinds import Criterion

if TYPE_CHECKING:
    import sympy

    from loopbook.pid import PID
    from loopbook.types import Number


def pi_controller() -> Criterion:
    """Return the criterion that a controller is a PI controller."""
    return Criterion(
        "it is a PI controller",
        lambda pid: pid.Td == 0 and pid.Ti.is_finite,
        otherwise="asked is a PI controller: with an integral time, and without a derivative term",
    )


def stable(process: sympy.Expr | None = None, by: Callable[[PID], bool] | None = None) -> Criterion:
    """Return the criterion that a loop is stable.

    Arguments:
        process: transfer function with numbers, in s; its loop is judged exactly.
        by: instead, a function of the controller, where a closed form is quicker.
    """

    def is_stable(pid):
        from loopbook.stability import is_closed_loop_stable

        return pid.Kp != 0 and is_closed_loop_stable(process * pid.expr)

    return Criterion(
        "the loop is stable",
        by or is_stable,
        otherwise="this loop is unstable: look at the sign and the size of the gain, and at the integral time",
    )


def largest_sensitivity(process: sympy.Expr, until: Number, below: Number) -> Criterion:
    """Return the criterion that the largest sensitivity of a stable loop is at most a limit.

    Arguments:
        process: transfer function with numbers, in s.
        until: the highest of the frequencies at which it is sought, four decades of them.

    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> largest_sensitivity(1 / s, until=10, below=1.2).complaint(PID(1))
    ''
    """
    jw = 1j * np.geomspace(1e-4 * float(until), float(until), 3000)
    around = Formula(process, "s")(s=jw)

    def largest(pid):
        return float(np.max(1 / np.abs(1 + around * Formula(pid.expr, "s")(s=jw))))

    return Criterion("the largest sensitivity $M_s$", largest, below=below)
