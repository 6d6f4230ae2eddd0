"""PID settings that weight the setpoint."""

from __future__ import annotations

from typing import NamedTuple

import sympy

from loopbook.pid import PID
from plainmath.expressions import s


class WeightedPID(NamedTuple):
    """PID settings with a weight of the setpoint in the proportional term: what `hang` returns.

    Attributes:
        settings: the `PID` through which the measurement acts.
        w_p: the weight, as the argument of `Controller`; that of the derivative term is zero.
    """

    settings: PID
    w_p: sympy.Expr

    @property
    def from_setpoint(self) -> sympy.Expr:
        """The transfer function from the setpoint to the control signal, the third argument of `Loop`."""
        return self.settings.Kp * (self.w_p + 1 / (self.settings.Ti * s))
