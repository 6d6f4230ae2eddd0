"""A process under feedback control, and what goes on in the loop."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.deadtime import System
from loopbook.deadtime.system import return_difference
from loopbook.integrals.error import blocks_of, error_after_step
from loopbook.laplace import evaluate
from loopbook.quasipolynomials import DelayFraction
from loopbook.stability import Margins, dominant_poles, is_stable, margins
from loopbook.transfer import transfer_function
from plainmath.expressions import function_of, t
from plainmath.validation import did_you_mean, times_from_zero

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from loopbook.figures import Picture, PlanePlot, TimePlot

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
        process, controller, from_setpoint, open: P, C, R and the open loop L = C P, expressions in `s`.
        process_fraction, controller_fraction, setpoint_fraction, open_fraction: the same as fractions of sums of
            polynomials with dead times.
        S, T, PS, CS: each a `System`.
        servo, regulator: `System` from the setpoint to y, and from the load to y.
        setpoint_to_control, load_to_control: `System` from the setpoint to u, and from the load to u.
    Raises:
        ValueError: for symbols, an algebraic loop without solution, or what is no `System`.

    >>> from loopbook import s
    >>> from loopbook.pid import PID
    >>> loop = Loop(2 * sympy.exp(-s) / (4 * s + 1), PID(1, Ti=4))
    >>> loop.servo
    System(exp(-s)/(2*s + exp(-s)))
    >>> loop.S
    System(2*s/(2*s + exp(-s)))
    """

    def __init__(self, process: object, controller: object, from_setpoint: object = None):
        self._given = process, controller, controller if from_setpoint is None else from_setpoint
        self.process_fraction, self.controller_fraction, self.setpoint_fraction = blocks_of(*self._given)
        self.open_fraction = self.controller_fraction * self.process_fraction
        self._difference = return_difference(self.open_fraction)

    @functools.cached_property
    def process(self) -> sympy.Expr:
        return transfer_function(self._given[0])

    @functools.cached_property
    def controller(self) -> sympy.Expr:
        return transfer_function(self._given[1])

    @functools.cached_property
    def from_setpoint(self) -> sympy.Expr:
        return transfer_function(self._given[2])

    @functools.cached_property
    def open(self) -> sympy.Expr:
        return self.controller * self.process

    def __repr__(self) -> str:
        return f"Loop({self.process}, {self.controller})"

    # ---- closed loops

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
        >>> from loopbook.pid import PID
        >>> Loop(1 / s, PID(2)).error("servo")
        System(1/(s + 2))
        """
        return System(error_after_step(self.process_fraction, self.controller_fraction, self.setpoint_fraction, mode))

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
        >>> from loopbook.pid import PID
        >>> round(Loop(sympy.exp(-s) / s, PID(1)).margins().gain_margin, 4)    # pi/2
        1.5708
        """
        return margins(self)

    # ---- pictures

    def bode(self, omega: ArrayLike | None = None, **options: object) -> Picture:
        """Plot magnitude and phase of the open loop, with the margins marked if the loop is stable.

        Arguments:
            omega: the lowest and the highest frequency; by themselves a decade around the corner frequencies.
            options: title, unit of time, decibels, as `pictures.bode_plot` takes them.

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
            options: title, unit of time, as `pictures.step_plot` takes them.

        >>> from loopbook import s
        >>> Loop(sympy.exp(-s) / s, sympy.Rational(1, 2)).plot_step()
        <setpoint, y(t); u(t) against t [s]; overshoot 4.05 %, rise time 1.91 s, settling time 6.06 s>
        """
        from loopbook.deadtime.pictures import step_plot

        return step_plot(self, end, self.servo.step_info() if self.is_stable else None, **options)

    # ---- signals

    def run(self, times: ArrayLike | None = None, setpoint: object = 1, load: object = 0) -> LoopResponse:
        """Return the signals of the loop for a setpoint and a load that change in time, the loop at rest before.

        Arguments:
            times: an array of times, not negative; by itself 501 of them up to `System.horizon` of the servo response.
            setpoint, load: expressions in `t`, as `signals.stepwise` writes steps, or numbers.
        Returns:
            A `LoopResponse`, which `figures.trends` draws.

        >>> from loopbook import s
        >>> from loopbook.pid import PID
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
