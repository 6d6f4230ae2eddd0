"""The PID controller: its settings and their forms, and the practical digital controller of Haugen, Section 7.4."""

from __future__ import annotations

import copy
import functools
import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import sympy

from loopbook.scaling import PERCENT, Scaling
from loopbook.transfer import transfer_function
from loopbook.types import Number
from plainmath.expressions import exact, s, written
from plainmath.latex import equalities
from plainmath.validation import (
    exact_nonzero,
    exact_not_negative,
    exact_positive,
    exact_real,
    known_arguments,
    limits,
    not_negative,
    number,
    one_of,
    positive,
)

__all__ = ["HOLD", "PID", "Controller", "LowpassFilter"]

FORMS = ("parallel", "serial")

#: The operator's control signal in manual mode that keeps the last one; a NaN, so that it fits among numbers.
HOLD = math.nan


@dataclass(frozen=True, init=False)
class PID:
    """Settings of a PID controller: exact numbers or symbols.

    The parallel form is ``Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1))``; the serial form, also called cascade or series
    form, is ``Kp*(1 + 1/(Ti*s))*(Td*s + 1)/(Tf*s + 1)``. A controller without integral term has Ti = oo.

    Arguments:
        Kp: gain, in units of the control signal for one unit of the measurement; negative for direct action.
        Ti, Td: integral time and derivative time, in the unit of the process's lags.
        Tf: lag of the filter in the derivative term, often 0.1 Td; of the whole controller in the serial form.
        form: "parallel" or "serial".
    Raises:
        ValueError: for a time that is negative, an integral time of zero, or another form.
    Source: Haugen, equations (7.11), (7.16) to (7.18), (10.22) and (10.23).

    >>> PID(2, Ti=10).expr
    2 + 1/(5*s)
    """

    Kp: sympy.Expr
    Ti: sympy.Expr = sympy.oo
    Td: sympy.Expr = sympy.S.Zero
    Tf: sympy.Expr = sympy.S.Zero
    form: str = "parallel"

    @known_arguments
    def __init__(self, Kp: Number, Ti: Number = sympy.oo, Td: Number = 0, Tf: Number = 0, form: str = "parallel"):
        for name, value in (("Kp", Kp), ("Ti", Ti), ("Td", Td), ("Tf", Tf)):
            check = exact_real if name == "Kp" else exact_not_negative
            object.__setattr__(self, name, check(name, value, infinite=name == "Ti"))
        if self.Ti == 0:
            raise ValueError("Ti is 0: expected a positive integral time, or oo for a controller without integral term")
        object.__setattr__(self, "form", one_of("form", form, FORMS))

    @functools.cached_property
    def expr(self) -> sympy.Expr:
        """The transfer function from control error to control signal, an expression in `s`.

        >>> Kp, Ti = sympy.symbols("Kp Ti", positive=True)
        >>> PID(Kp, Ti, form="serial").expr
        Kp*(1 + 1/(Ti*s))
        """
        integral = 0 if self.Ti == sympy.oo else 1 / (self.Ti * s)
        if self.form == "parallel":
            return self.Kp * (1 + integral + self.Td * s / (self.Tf * s + 1))
        return self.Kp * (1 + integral) * (self.Td * s + 1) / (self.Tf * s + 1)

    def parallel(self) -> PID:
        """Return the same controller in parallel form. (Haugen, equations 10.24 to 10.26, here with the filter)

        Raises ValueError where there is none, because the filter is slower than the derivative action.

        >>> PID(2, Ti=8, Td=2, form="serial").parallel()
        PID(Kp=5/2, Ti=10, Td=8/5)
        """
        if self.form == "parallel":
            return self
        if self.Ti == sympy.oo:
            Kp, Ti, Td = self.Kp, self.Ti, self.Td - self.Tf
        else:
            Ti = self.Ti + self.Td - self.Tf
            Kp, Td = self.Kp * Ti / self.Ti, self.Ti * self.Td / Ti - self.Tf
        if Td.is_negative or Ti.is_negative:
            raise ValueError(f"{self} has no parallel form: its filter is slower than its derivative action")
        return PID(Kp, Ti, Td, self.Tf)

    def serial(self) -> PID:
        """Return the same controller in serial form.

        Raises ValueError where there is none, because the zeros of the controller are complex (Ti < 4 Td if there is
        no filter).

        >>> PID(2.5, Ti=10, Td=1.6).serial()
        PID(Kp=2, Ti=8, Td=2, form='serial')
        """
        if self.form == "serial":
            return self
        if self.Ti == sympy.oo:
            return PID(self.Kp, Td=self.Td + self.Tf, Tf=self.Tf, form="serial")
        # the zeros of the controller: (Ti_serial s + 1)(Td_serial s + 1) = product s^2 + total s + 1
        total, product = self.Ti + self.Tf, self.Ti * (self.Tf + self.Td)
        discriminant = sympy.factor(total**2 - 4 * product)
        if discriminant.is_negative:
            raise ValueError(f"{self} has complex zeros and no serial form: expected (Ti - Tf)**2 of at least 4 Ti Td")
        Ti = (total + sympy.sqrt(discriminant)) / 2
        return PID(self.Kp * Ti / self.Ti, Ti, total - Ti, self.Tf, form="serial")

    def with_filter(self, N: Number = 10) -> PID:
        """Return the same settings with the filter Tf = Td/N for the derivative term. (Haugen, Section 7.4.1)

        >>> PID(6, Ti=3, Td=0.75).with_filter()
        PID(Kp=6, Ti=3, Td=3/4, Tf=3/40)
        """
        return PID(self.Kp, self.Ti, self.Td, self.Td / exact_positive("N", N), self.form)

    @property
    def proportional_band(self) -> sympy.Expr:
        """The proportional band P_B in percent, for a gain without unit. (Haugen, equation 7.12)

        >>> PID(0.2).proportional_band
        500
        """
        return 100 / self.Kp

    def repeats_per_minute(self, minute: Number = 60) -> sympy.Expr:
        """Return how often in a minute the integral term repeats the proportional one. (Haugen, Section 7.3)

        Arguments:
            minute: a minute in the unit of Ti: 60 for seconds, 1 for minutes.

        >>> PID(1, Ti=12).repeats_per_minute()
        5
        """
        return exact(minute) / self.Ti

    @classmethod
    def from_panel(
        cls,
        proportional_band: Number,
        repeats_per_minute: Number = 0,
        Td: Number = 0,
        Tf: Number = 0,
        minute: Number = 60,
    ) -> Self:
        """Return the settings of a controller whose panel shows proportional band [%] and repeats per minute.

        Arguments:
            Td, Tf: in the unit of time that is wanted.
            minute: a minute in that unit: 60 for seconds, 1 for minutes.

        >>> PID.from_panel(50, repeats_per_minute=5)
        PID(Kp=2, Ti=12)
        """
        band, repeats = exact_nonzero("proportional_band", proportional_band), exact(repeats_per_minute)
        return cls(100 / band, sympy.oo if repeats == 0 else exact(minute) / repeats, Td, Tf)

    def __mul__(self, block: object) -> sympy.Expr:
        """Return the product with an expression, another controller or a number, an expression in `s`.

        >>> PID(2, Ti=10) * (3 / s)
        3*(2 + 1/(5*s))/s
        """
        if isinstance(block, (sympy.Expr, PID, numbers.Real)):
            return self.expr * transfer_function(block)
        return NotImplemented  # a system multiplies by itself

    __rmul__ = __mul__

    def _shown(self):
        """The settings that are not what they are by themselves."""
        default = {"Kp": None, "Ti": sympy.oo, "Td": 0, "Tf": 0}
        return {name: value for name in default if (value := getattr(self, name)) != default[name]}

    def _repr_latex_(self):
        shown = equalities({f"{name[0]}_{name[1]}": value for name, value in self._shown().items()})
        # without derivative term and filter both forms are one
        return shown if self.form == "parallel" or self.Td == self.Tf == 0 else f"{shown} (serial form)"

    def __repr__(self) -> str:
        parts = [f"{name}={written(value)}" for name, value in self._shown().items()]
        return f"PID({', '.join(parts + ([] if self.form == 'parallel' else ['form=' + repr(self.form)]))})"


class LowpassFilter:
    """A first-order lag as a program: gain 1, lag `T`, exact for an input that changes evenly from sample to sample.

    Arguments:
        T: lag, not negative; 0 lets the input through.
        step: time between two samples, positive, in the unit of T.
    Source: Haugen, equation (7.1).

    >>> smooth = LowpassFilter(T=2, step=1)
    >>> [round(smooth.update(x), 4) for x in (0, 1, 1, 1)]
    [0.0, 0.2131, 0.5227, 0.7105]
    """

    T: float
    step: float
    input: float | None
    output: float | None

    def __init__(self, T: Number, step: Number):
        T, self.step = not_negative("T", T), positive("step", step)
        self.T, self.remains = T, math.exp(-self.step / T) if T else 0.0
        self.output = self.input = None

    def update(self, x: float) -> float:
        """Take the input of this sample and return the output of this sample; at the first one it is at rest."""
        if self.output is None:
            self.input = self.output = x
        behind = self.T * (x - self.input) / self.step  # how far the output of an unending ramp stays behind
        self.output = x - behind + self.remains * (self.output - self.input + behind)
        self.input = x
        return self.output


class Controller:
    """The practical PID controller, run once a sample. (Haugen, Sections 7.2 to 7.4)

    The control signal is u = u0 + u_p + u_i + u_d + u_f, limited, with the feedforward u_f and

        u_p = Kp (w_p y_SP - y),    du_i/dt = Kp/Ti (y_SP - y),    u_d = Kp Td d/dt (w_d y_SP - y), filtered by Tf.

    Proportional and integral term are exact for signals that are held between samples; the derivative term is the mean
    of the exact one over the coming sample.

    Arguments:
        settings: a `PID` with numbers; a serial one is converted to parallel form.
        step: time between two samples, in the unit of the settings' times.
        u0: nominal (manual) control signal. It, the limits, the feedforward, the operator's control signal and the
            terms are in the unit of u, which is percent if there is a `control_range`.
        action: "reverse", or "direct" for a controller that must raise u when the measurement rises: its gain is -Kp.
        limits: lowest and highest control signal, of the actuator; none, or 0 to 100 % with a `control_range`.
        pid_limits: lowest and highest u_PID = u - u_f, as in the note to Haugen, Example 8.1; none if not given.
        w_p, w_d: setpoint weights of the proportional and the derivative term.
        ramp: the highest rate at which the setpoint moves, in units of the measurement for one unit of time.
        T_filter: lag of the measurement filter.
        anti_windup: halt the integration where it would drive a control signal at its limit further.
        bumpless: let the integral term take up the difference when the mode changes from manual to automatic.
        measurement_range: (lowest, highest) of the measurement; the controller then works in percent of this range.
        control_range: (lowest, highest) of what it puts out; u is then in percent of this range inside.

    Attributes:
        hold_integration: +1 or -1 while a rise or a fall of the control signal has no effect, as that of an outer loop
            whose inner loop is at its limit: with anti wind-up, the integration halts in this direction. 0 otherwise.

    Raises:
        ValueError: for settings with symbols, a step that is not positive, limits in the wrong order, or another value
            that makes no controller.

    >>> controller = Controller(PID(2, Ti=10), step=1, u0=50, limits=(0, 100))
    >>> [controller.update(setpoint=5, measurement=0) for _ in range(3)]
    [60.0, 61.0, 62.0]
    """

    settings: PID
    limits: tuple[float, float]
    pid_limits: tuple[float, float]
    hold_integration: int
    setpoint: float | None
    u: float | None
    terms: tuple[float, float, float]

    def __init__(
        self,
        settings: PID,
        step: Number,
        *,
        u0: Number = 0,
        action: str = "reverse",
        limits: Sequence[Number] | None = None,
        pid_limits: Sequence[Number] | None = None,
        w_p: Number = 1,
        w_d: Number = 1,
        ramp: Number = math.inf,
        T_filter: Number = 0,
        anti_windup: bool = True,
        bumpless: bool = True,
        measurement_range: Sequence[Number] | None = None,
        control_range: Sequence[Number] | None = None,
    ):
        self.step, self.u0 = positive("step", step), number("u0", u0)
        self.action = one_of("action", action, ("reverse", "direct"))
        self._use(settings)
        if limits is None and control_range is not None:
            limits = PERCENT
        self.limits, self.pid_limits = _limits("limits", limits), _limits("pid_limits", pid_limits)
        self.w_p, self.w_d = number("w_p", w_p), number("w_d", w_d)
        self.ramp = positive("ramp", ramp) * self.step if ramp != math.inf else math.inf
        self.anti_windup, self.bumpless = bool(anti_windup), bool(bumpless)
        self.to_percent = self.from_percent = self.back_to_percent = None
        if measurement_range is not None:
            self.to_percent = _in_floats(Scaling(measurement_range, PERCENT))
        if control_range is not None:
            scaling = Scaling(PERCENT, control_range)
            self.from_percent, self.back_to_percent = _in_floats(scaling), _in_floats(scaling.inverse)
        self.measurement_filter = LowpassFilter(T_filter, step)
        self.derivative_filter_output = None
        self.integral = 0.0
        self.in_manual = False
        self.hold_integration = 0
        self.setpoint = self.u = None  # as of the last sample
        self.terms = (0.0, 0.0, 0.0)

    def _use(self, settings):
        if not isinstance(settings, PID):
            raise ValueError(f"settings is {settings!r}: expected a PID")
        parallel = settings.parallel()
        Kp, self.Td, self.Tf = (number(x, getattr(parallel, x)) for x in ("Kp", "Td", "Tf"))
        if self.action == "direct" and Kp < 0:
            raise ValueError(f"Kp is {Kp:g} and the action is direct: give a positive gain with an action")
        self.Kp = -Kp if self.action == "direct" else Kp
        self.Ti = math.inf if parallel.Ti == sympy.oo else number("Ti", parallel.Ti)
        self.derivative_filter_decay = math.exp(-self.step / self.Tf) if self.Tf else 0.0
        self.settings = settings

    def change(self, settings: PID) -> None:
        """Go on with other settings from the next sample, as a gain schedule does; a loop at rest feels no bump.

        >>> controller = Controller(PID(2, Ti=10), step=1, u0=50)
        >>> _ = controller.update(setpoint=5, measurement=5)
        >>> controller.change(PID(4, Ti=20))
        >>> controller.update(setpoint=5, measurement=5)
        50.0
        """
        before = copy.copy(self)
        self._use(settings)
        self.take_over(before)

    @property
    def filtered(self) -> float | None:
        """The measurement behind the filter at the last sample, in the unit of the measurement."""
        return self.measurement_filter.output

    def update(
        self, setpoint: Number, measurement: Number, feedforward: Number = 0.0, manual: Number | None = None
    ) -> float:
        """Take the signals of this sample and return the control signal, which is held until the next one.

        Before the first sample the loop was at rest: the setpoint equal to the measurement, the control signal u0.

        Arguments:
            setpoint, measurement: in the unit of the measurement.
            feedforward: u_f, in the unit of u.
            manual: the operator's control signal in manual mode, in the unit of u; `HOLD` keeps the last one.
                None for automatic mode.
        Returns:
            The control signal, in the unit of u, or with a `control_range` in the unit of that range.
        Raises:
            ValueError: for a signal that is not a number.
        """
        try:
            setpoint, measurement, feedforward = float(setpoint), float(measurement), float(feedforward)
            manual = None if manual is None else float(manual)
        except (TypeError, ValueError):
            given = f"({setpoint!r}, {measurement!r}, {feedforward!r}, {manual!r})"
            raise ValueError(f"setpoint, measurement, feedforward and manual are {given}: expected numbers") from None
        y = self.measurement_filter.update(measurement)
        if self.setpoint is None:
            self.setpoint, at_rest = y, self._in_percent(y)
            self.derivative_filter_output = (self.w_d - 1) * at_rest
            self.integral = self.Kp * (1 - self.w_p) * at_rest  # so that the control signal was u0
        # the setpoint that the controller sees moves no faster than the ramp
        self.setpoint += _between(setpoint - self.setpoint, (-self.ramp, self.ramp))
        y, y_SP = self._in_percent(y), self._in_percent(self.setpoint)

        by_hand = manual is not None
        begins_without_bump = self.in_manual and self.bumpless and not by_hand
        if by_hand or begins_without_bump:
            self.derivative_filter_output = self.w_d * y_SP - y  # so that the derivative term begins at zero
        u_p = self.Kp * (self.w_p * y_SP - y)
        u_d = self._differentiate(self.w_d * y_SP - y)
        growth = 0.0
        if by_hand:
            last = self.u0 if self.u is None else self.u
            self.u = _between(last if math.isnan(manual) else manual, self.limits)
        else:
            if begins_without_bump:
                self._transfer_without_bump(u_p + u_d, feedforward)
            u_PID = self.u0 + u_p + self.integral + u_d
            u = _between(u_PID, self.pid_limits) + feedforward
            self.u = _between(u, self.limits)
            growth = self.Kp * self.step / self.Ti * (y_SP - y)
            if self.anti_windup and self._is_clamped(u_PID, u, growth):
                growth = 0.0
        self.in_manual = by_hand
        self.terms = (u_p, self.integral, u_d)
        self.integral += growth
        return self.from_percent(self.u) if self.from_percent else self.u

    def take_over(self, other: Controller) -> None:
        """Continue where another controller stopped, as after a change of settings; a loop at rest feels no bump."""
        self.setpoint, self.u, self.integral, self.in_manual = other.setpoint, other.u, other.integral, other.in_manual
        mine, others = self.measurement_filter, other.measurement_filter
        mine.input, mine.output = others.input, others.output
        self.derivative_filter_output = other.derivative_filter_output
        if self.setpoint is not None:
            y_SP = self._in_percent(self.setpoint)
            self.integral += other.u0 - self.u0 + (other.Kp * (other.w_p - 1) - self.Kp * (self.w_p - 1)) * y_SP
            self.derivative_filter_output += (self.w_d - other.w_d) * y_SP

    def start_from(self, u: Number) -> None:
        """Begin as after manual mode with a control signal such as `update` returns."""
        u = number("u", u)
        self.u, self.in_manual = self.back_to_percent(u) if self.back_to_percent else u, True

    def _in_percent(self, y):
        return self.to_percent(y) if self.to_percent else y

    def _differentiate(self, x):
        """The derivative term, its mean over the coming sample: the slope behind the filter, exact for ramps."""
        slope = (1 - self.derivative_filter_decay) * (x - self.derivative_filter_output) / self.step
        self.derivative_filter_output += slope * self.step
        return self.Kp * self.Td * slope

    def _transfer_without_bump(self, u_pd, feedforward):
        """Bumpless transfer from manual to automatic mode: the integral term takes up the difference."""
        self.integral = _between(self.u - feedforward, self.pid_limits) - (self.u0 + u_pd)

    def _is_clamped(self, u_PID, u, growth):
        """Conditional integration (clamping): whether the integral term would drive a limited signal further out."""
        if growth * self.hold_integration > 0:
            return True
        if growth > 0:
            return u_PID > self.pid_limits[1] or u > self.limits[1]
        return growth < 0 and (u_PID < self.pid_limits[0] or u < self.limits[0])

    def __repr__(self) -> str:
        return f"Controller({self.settings}, step={self.step:g})"


def _between(x, limits):
    return min(max(x, limits[0]), limits[1])


def _in_floats(scaling):
    a, b = float(scaling.a), float(scaling.b)
    return lambda x: a * x + b


def _limits(name, given):
    low, high = (-math.inf, math.inf) if given is None else limits(name, given)
    return float(low), float(high)
