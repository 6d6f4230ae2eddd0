"""A process under feedback control, and what goes on in the loop."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np
import sympy

from loopbook.deadtime import System
from loopbook.deadtime.system import return_difference
from loopbook.integrals import Criteria, criteria, ise
from loopbook.integrals.error import MODES, blocks_of, error_after_step
from loopbook.laplace import evaluate
from loopbook.pid import PID
from loopbook.quasipolynomials import DelayFraction
from loopbook.stability import Margins, dominant_poles, is_stable, margins
from loopbook.transfer import transfer_function
from plainmath.expressions import function_of, t
from plainmath.validation import did_you_mean, one_of, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from loopbook.deadtime import Response
    from loopbook.figures import Picture, PlanePlot, TimePlot
    from loopbook.types import TransferFunctionLike

__all__ = ["Loop", "LoopResponse"]


@dataclass(frozen=True, repr=False)
class LoopResponse:
    """Signals of a loop, with exact dead time: what `Loop.run` returns, and `figures.trends` draws.

    Attributes:
        times: the moments, an array.
        signals: ``{"setpoint": ..., "d": ..., "y": ..., "u": ...}``, arrays with a value for each moment.
        time_unit: the unit of the times, as a figure names it.
    """

    times: np.ndarray
    signals: dict[str, np.ndarray]
    output: str = "y"
    manipulated: str = "u"
    held: frozenset[str] = frozenset({"setpoint", "d"})
    time_unit: str = "s"

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.signals:
            raise ValueError(f"the response has no signal {name!r}: {did_you_mean(name, self.signals)}")
        return self.signals[name]

    def unit(self, name: str) -> str:
        """The unit of a signal: all of them are numbers."""
        return "1"

    def __repr__(self) -> str:
        times = np.ravel(self.times)
        span = f"t = {times[0]:g} to {times[-1]:g}" if times.size else "at no time"
        return f"<response of a loop, {span}: {', '.join(self.signals)}>"


class Loop:
    """A process under feedback control, with a load at its input. ::

                              d (load)
                              |
        y_SP --> [R] --> o -- u --> o --> [P] --o--> y          y = P (u + d),  u = R y_SP - C y
                         ^ -                    |
                         +------- [C] <---------+

    With S = 1/(1 + P C), the sensitivity, the four closed loops that decide about it are S, T = P C S (the
    complementary sensitivity), PS = P S (from the load to y) and CS = C S (from measurement noise to -u).

    Arguments:
        process: P, an expression in `s` with numbers, a `System` or a system of python-control.
        controller: C, a `PID`, or as the process; it may be improper where the loop is not.
        from_setpoint: R, from the setpoint to the control signal, as with setpoint weights; equal to C if not given.
    Attributes:
        controller: C, the `PID` that was given, or what else was as a `System` (a fraction where it is improper).
        process, from_setpoint, open: P, R and the open loop C P, expressions in `s`.
        process_fraction, controller_fraction, setpoint_fraction, open_fraction: the same as fractions of sums of
            polynomials with dead times.
        L, S, T, PS, CS: the open and the closed loops, each a `System`.
        servo, regulator: `System` from the setpoint to y, and from the load to y.
        setpoint_to_control, load_to_control: `System` from the setpoint to u, and from the load to u.
    Raises:
        ValueError: for symbols, an algebraic loop without solution, or what is no `System`.

    Loops are equal where their blocks are, however they were written.

    >>> from loopbook import first_order
    >>> loop = Loop(first_order(2, 4, delay=1), PID(1, Ti=4))
    >>> loop
    Loop(2*exp(-s)/(4*s + 1), PID(Kp=1, Ti=4))
    >>> loop.servo
    System(exp(-s)/(2*s + exp(-s)))
    >>> loop == Loop(first_order(2, 4, delay=1), loop.controller.expr)
    True
    """

    def __init__(
        self,
        process: TransferFunctionLike,
        controller: TransferFunctionLike,
        from_setpoint: TransferFunctionLike | None = None,
    ):
        self._given = process, controller, controller if from_setpoint is None else from_setpoint
        self.process_fraction, self.controller_fraction, self.setpoint_fraction = blocks_of(*self._given)
        self.open_fraction = self.controller_fraction * self.process_fraction
        self._difference = return_difference(self.open_fraction)

    @functools.cached_property
    def process(self) -> sympy.Expr:
        return transfer_function(self._given[0])

    @functools.cached_property
    def controller(self) -> PID | DelayFraction:
        given, fraction = self._given[1], self.controller_fraction
        return given if isinstance(given, PID) else System(fraction) if fraction.is_proper else fraction

    @functools.cached_property
    def from_setpoint(self) -> sympy.Expr:
        return transfer_function(self._given[2])

    @functools.cached_property
    def open(self) -> sympy.Expr:
        return transfer_function(self._given[1]) * self.process

    def __repr__(self) -> str:
        controller, R = (x if isinstance(x, PID) else transfer_function(x) for x in self._given[1:])
        same = self.setpoint_fraction == self.controller_fraction
        return f"Loop({self.process}, {controller}{'' if same else f', {R}'})"

    @property
    def _blocks(self) -> tuple[DelayFraction, ...]:
        return self.process_fraction, self.controller_fraction, self.setpoint_fraction

    def __eq__(self, other: object) -> bool:
        return self._blocks == other._blocks if isinstance(other, Loop) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._blocks)

    # ---- open and closed loops

    @functools.cached_property
    def L(self) -> System:
        return System(self.open_fraction)

    def _closed(self, forward: DelayFraction) -> System:
        return System(forward / self._difference)

    @functools.cached_property
    def S(self) -> System:
        return System(DelayFraction.coprime(self._difference.denominator, self._difference.numerator))

    @functools.cached_property
    def T(self) -> System:
        return System(DelayFraction.coprime(self.open_fraction.numerator, self._difference.numerator))

    @functools.cached_property
    def PS(self) -> System:
        return self._closed(self.process_fraction)

    @functools.cached_property
    def CS(self) -> System:
        return self._closed(self.controller_fraction)

    @functools.cached_property
    def servo(self) -> System:
        if self.setpoint_fraction == self.controller_fraction:
            return self.T
        return self._closed(self.setpoint_fraction * self.process_fraction)

    @functools.cached_property
    def regulator(self) -> System:
        return self.PS

    @functools.cached_property
    def setpoint_to_control(self) -> System:
        return self._closed(self.setpoint_fraction)

    @functools.cached_property
    def load_to_control(self) -> System:
        return -self.T

    def error(self, mode: str) -> System:
        """Return E(s), the control error y_SP - y for a unit step of the setpoint ("servo") or load ("regulator").

        >>> from loopbook import s
        >>> Loop(1 / s, PID(2)).error("servo")
        System(1/(s + 2))
        """
        return System(error_after_step(*self._blocks, mode))

    # ---- stability

    @property
    def is_stable(self) -> bool:
        """Whether the loop is internally stable: a pole that controller and process cancel counts, too.

        >>> from loopbook import s
        >>> Loop(1 / (s - 1), 2 * (s - 1) / (s + 1)).is_stable
        False
        """
        return is_stable(self)

    def poles(self, count: int = 2) -> list[complex]:
        """Return the dominant poles of the closed loop, as `stability.dominant_poles` does.

        >>> from loopbook import s
        >>> Loop(1 / s, 2).poles()
        [(-2+0j)]
        """
        return dominant_poles(self, count)

    def margins(self) -> Margins:
        """Return gain margin, phase margin, delay margin and Ms, as `stability.margins` does for the open loop.

        >>> from loopbook import s
        >>> round(Loop(sympy.exp(-s) / s, PID(1)).margins().gain_margin, 4)    # pi/2
        1.5708
        """
        return margins(self)

    @functools.cached_property
    def Ms(self) -> float:
        """The largest sensitivity, the largest value of abs(1/(1 + L)), as in `margins`; infinite if not stable.

        >>> from loopbook import s
        >>> round(Loop(sympy.exp(-s) / s, PID(0.5)).Ms, 4), Loop(sympy.exp(-s) / s, PID(2)).Ms
        (1.5905, inf)
        """
        return self.margins().Ms if self.is_stable else math.inf

    # ---- integral criteria

    def ise(self, mode: str = "servo") -> float:
        """Return the integral of the squared control error after a unit step, as `integrals.ise` does.

        Arguments:
            mode: "servo" for a step of the setpoint, "regulator" for one of the load at the process input.

        >>> from loopbook import first_order
        >>> round(Loop(first_order(1, 1, delay=0.5), PID(1, Ti=1)).ise(), 6)
        0.842898
        """
        return ise(self, mode=mode)

    def criteria(self, mode: str = "servo", tolerance: float = 1e-9) -> Criteria:
        """Return ISE, IAE, ITAE and ITSE of the control error after a unit step, as `integrals.criteria` does.

        Arguments:
            mode: as for `ise`.
            tolerance: the share of each integral that may be left out.

        >>> from loopbook import s
        >>> [round(value, 6) for value in Loop(1 / s, 1).criteria()]
        [0.5, 1.0, 1.0, 0.25]
        """
        return criteria(self, mode=mode, tolerance=tolerance)

    # ---- pictures

    def bode(self, omega: ArrayLike | None = None, **options: object) -> Picture:
        """Plot magnitude and phase of the open loop, with the margins marked if the loop is stable.

        Arguments:
            omega: the lowest and the highest frequency; by themselves a decade around the corner frequencies.
            options: title, unit of time, decibels, axes of one's own, as `pictures.bode_plot` takes them.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, sympy.Rational(1, 2)).bode()
        <magnitude and phase [deg] against omega [rad/s]; gain margin 3.14, phase margin 61.4°>
        """
        from loopbook.deadtime.pictures import bode_plot

        return bode_plot(self, omega, self.margins() if self.is_stable else None, **options)

    def nyquist(self, omega: ArrayLike | None = None, **options: object) -> PlanePlot:
        """Plot the open loop in the complex plane, as `pictures.nyquist_plot` does, with the margins as in `bode`.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, sympy.Rational(1, 2)).nyquist()
        <imaginary part against real part; gain margin 3.14, phase margin 61.4°, Ms 1.59>
        """
        from loopbook.deadtime.pictures import nyquist_plot

        return nyquist_plot(self, omega, self.margins() if self.is_stable else None, **options)

    def plot_step(self, end: float | None = None, **options: object) -> TimePlot:
        """Plot y and u after a unit step of the setpoint, with the step information of y if the loop is stable.

        Arguments:
            end: the last time; by itself late enough for the response to settle.
            options: title, unit of time, axes of one's own, as `pictures.step_plot` takes them.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, sympy.Rational(1, 2)).plot_step()
        <setpoint, y(t); u(t) against t [s]; overshoot 4.05 %, rise time 1.91 s, settling time 6.06 s>
        """
        from loopbook.deadtime.pictures import step_plot

        return step_plot(self, end, self.servo.step_info() if self.is_stable else None, **options)

    # ---- signals

    @overload
    def step(self, times: ArrayLike, mode: str = "servo") -> np.ndarray: ...
    @overload
    def step(self, times: None = None, mode: str = "servo") -> Response: ...
    def step(self, times: ArrayLike | None = None, mode: str = "servo") -> np.ndarray | Response:
        """Return the output y after a unit step, the loop at rest before, as `System.step` does.

        Arguments:
            times: a number or an array, not negative, in the unit of the lags.
            mode: "servo" for a step of the setpoint, "regulator" for one of the load at the process input.
        Returns:
            An array of the shape of the times; without times a `deadtime.Response`, a function of time.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, PID(0.5)).step([2, 3])
        array([0.5  , 0.875])
        """
        return getattr(self, one_of("the mode", mode, MODES)).step(times)

    def run(self, times: ArrayLike | None = None, setpoint: object = 1, load: object = 0) -> LoopResponse:
        """Return the signals of the loop for a setpoint and a load that change in time, the loop at rest before.

        Arguments:
            times: an array of times, not negative; by itself 501 of them up to `System.horizon` of the servo response.
            setpoint, load: expressions in `t`, as `signals.stepwise` writes steps, or numbers.
        Returns:
            A `LoopResponse`, which `figures.trends` draws.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, PID(0.5)).run([2, 3])["y"].round(6)
        array([0.5  , 0.875])
        """
        times = np.linspace(0, self.servo.horizon(), 501) if times is None else times_from_zero(times)
        y_SP, d = (evaluate(function_of(t, signal), times) for signal in (setpoint, load))
        paths = {"y": (self.servo, self.regulator), "u": (self.setpoint_to_control, self.load_to_control)}
        signals = {"setpoint": y_SP, "d": d}
        for name, systems in paths.items():
            responses = [H.response(times, u) for H, u in zip(systems, (setpoint, load), strict=True) if u != 0]
            signals[name] = sum(responses, 0 * times)
        return LoopResponse(times, signals)
