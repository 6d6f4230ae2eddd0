"""An adaptive controller: its settings follow from a model that is estimated while it works. (Haugen, Figure 10.18)"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from loopbook.identification.recursive import RecursiveLeastSquares, first_order_of
from loopbook.pid import Controller
from loopbook.tuning import simc
from loopbook.types import Number
from plainmath.validation import not_negative, positive

if TYPE_CHECKING:
    from loopbook.approximation import SOPDT
    from loopbook.pid import PID

WAIT = 20  # samples before the settings follow the model for the first time


class AdaptiveController(Controller):
    """The practical PI controller with Skogestad's settings for a lag with dead time that it estimates itself.

    At each sample it compares the measurement with what the last ones and its own control signal let it expect,
    y[k+1] = a y[k] + b u[k-n] + c, and corrects a, b and c by recursive least squares. They give gain and lag; the dead
    time is known, to whole steps of n. Each time that a new model makes sense (0 < a < 1, and b of the sign of Kp), the
    settings follow it. Noise makes a too small, as in every equation that has the measurement on its right hand side.

    Arguments:
        settings: at the beginning, a `PID`; its sign, or that of the action, has to be right.
        step: time between two samples.
        delay: the dead time of the process, known, rounded to whole steps.
        Tc, c: as for `tuning.simc`.
        forgetting: forgetting factor of the estimator.
        options: as of `Controller`.
    Raises:
        ValueError: as `Controller`, and where neither the dead time nor Tc says how fast the loop should be.
    Attributes:
        model: the last `SOPDT` that makes sense, of signals in percent where they have ranges; None before the first.
        estimator: the `RecursiveLeastSquares`.

    >>> from loopbook.pid import PID
    >>> controller = AdaptiveController(PID(1, Ti=10), step=1, delay=3)
    >>> controller.model is None
    True
    """

    model: SOPDT | None
    estimator: RecursiveLeastSquares

    recorded = ("Kp", "Ti")  # what a simulation notes besides the signals

    def __init__(
        self,
        settings: PID,
        step: Number,
        delay: Number,
        Tc: Number | None = None,
        c: Number = 4,
        forgetting: Number = 0.99,
        **options: Any,
    ):
        super().__init__(settings, step, **options)
        self.whole_delay = round(not_negative("the dead time", delay) / self.step)
        self.Tc = None if Tc is None else not_negative("the time constant Tc", Tc)
        self.c, self.wait = positive("the factor c", c), WAIT
        if not (self.whole_delay or self.Tc):
            raise ValueError(f"the dead time is {delay}, less than a step, and Tc is {Tc}: expected a positive Tc")
        self.estimator, self.scale = RecursiveLeastSquares(3, forgetting), abs(self.Kp) or 1.0
        self.model, self.last, self.inputs = None, None, []

    def update(
        self, setpoint: Number, measurement: Number, feedforward: Number = 0.0, manual: Number | None = None
    ) -> float:
        """Take the signals of this sample, learn from them, and return the control signal."""
        # in units of the control signal, so that a, b and c are learnt alike in all units of the measurement
        y, known = self.scale * self._in_percent(float(measurement)), self.inputs
        if len(known) > self.whole_delay:
            self.estimator.update([self.last, known[-1 - self.whole_delay], 1.0], y)
            self.wait -= 1
            if self.wait <= 0:
                self._follow()
        self.last = y
        u = super().update(setpoint, measurement, feedforward, manual)
        self.inputs = [*known[-self.whole_delay - 1 :], self.u]
        return u

    def _follow(self):
        a, b, _ = self.estimator.parameters
        if 0 < a < 1 and b * self.Kp > 0:
            self.model = first_order_of(a, b / self.scale, self.step, self.whole_delay)
            settings = simc(self.model, self.Tc, self.c)
            self.change(replace(settings, Kp=-settings.Kp) if self.action == "direct" else settings)

    def take_over(self, other: Controller) -> None:
        super().take_over(other)
        if isinstance(other, AdaptiveController):
            self.estimator, self.scale, self.model = other.estimator, other.scale, other.model
            self.last, self.inputs, self.wait = other.last, other.inputs, other.wait
