"""A system with exact dead time anywhere in it: its algebra, its responses, its poles."""

from __future__ import annotations

import functools
import itertools
import math
from typing import TYPE_CHECKING, Self, overload

import numpy as np
import sympy

from loopbook.deadtime.curves import frequency_curve, natural_range
from loopbook.deadtime.response import Response
from loopbook.deadtime.state_space import ChannelModel, state_space
from loopbook.deadtime.step_info import StepInfo, first_time_at, settled_response, step_info
from loopbook.deadtime.superposition import response_to_samples
from loopbook.laplace import transform
from loopbook.quasipolynomials import DelayFraction, read
from loopbook.quasipolynomials.fraction import ZERO, Quasipolynomial, plus
from loopbook.stability import is_stable
from loopbook.stability import margins as margins_of
from loopbook.stability.poles import dominant_roots
from plainmath.expressions import function_of, s, t
from plainmath.validation import increasing, number, positive_numbers, real_numbers, times_from_zero, whole

if TYPE_CHECKING:
    import control
    from numpy.typing import ArrayLike

    from loopbook.figures import Picture, PlanePlot, TimePlot
    from loopbook.types import TransferFunctionLike

__all__ = ["System", "closed_loop"]

DIFFERENTIATOR = read(s)


class System(DelayFraction):
    """A linear system with exact dead time, anywhere in it, as behind a feedback loop.

    The operators ``+ - * / **`` work with other systems, expressions in `s`, controllers and numbers, so that an
    expression of systems is the block diagram. Common factors cancel exactly, as `DelayFraction` says. Called with a
    complex number, a system returns its transfer function there.

    Arguments:
        H: transfer function with numbers, an expression in `s` with dead times ``exp(-delay*s)``; a system itself; or a
            continuous single-input single-output system of python-control, whose decimal numbers are taken as meant.
    Attributes:
        expr: the transfer function with common factors cancelled.
        numerator, denominator: ``{delay: coefficients}``, whole numbers, the lowest power first.
    Raises:
        ValueError: for symbols, an improper system, a negative dead time, or one whose output would depend on later
            inputs.

    >>> System(sympy.exp(-s) / s) * 2
    System(2*exp(-s)/s)
    >>> closed_loop(System(sympy.exp(-s) / s))
    System(exp(-s)/(s + exp(-s)))
    """

    def __init__(self, H: object):
        fraction = read(H)
        self.numerator, self.denominator = fraction.numerator, fraction.denominator
        if not self.is_proper:
            delay, part = max((*self.denominator.items(), *self.numerator.items()), key=lambda item: len(item[1]))
            late = f" with the dead time {delay}" if delay else ""
            raise ValueError(
                f"{self.expr} is improper: it has s**{len(part) - 1}{late} over s**{self.order}; expected no more "
                f"zeros than poles, as with a filter in the derivative term"
            )

    @classmethod
    def _make(cls, above: Quasipolynomial, below: Quasipolynomial) -> Self:
        return cls(DelayFraction(above, below))

    # ---- what it is

    @property
    def static_gain(self) -> sympy.Expr:
        """H(0), exact: what a constant input is multiplied with in the end, if the output settles.

        It is infinite for an integrator.

        >>> closed_loop(3 * sympy.exp(-s) / (s + 1)).static_gain
        3/4
        """
        if not self.numerator:
            return sympy.S.Zero
        zeros, poles, factor = self.at_origin
        if zeros > poles:
            return sympy.S.Zero
        factor = sympy.Rational(factor.numerator, factor.denominator)
        return factor if zeros == poles else sympy.oo * factor

    @property
    def is_stable(self) -> bool:
        """Whether all poles lie in the left half-plane, proved; with one proved to be on the axis it is not stable.

        What is not decided is an UndecidedError that says at which frequencies.

        >>> System(1 / (s + 1)).is_stable, closed_loop(2 * sympy.exp(-s) / s).is_stable
        (True, False)
        """
        return is_stable(self)

    def poles(self, count: int | None = None) -> list[complex]:
        """Return the poles with the largest real parts; that none of them is missing is proved.

        Arguments:
            count: how many; by itself all of a system without dead time in its denominator, and the two dominant ones
                of another, which has infinitely many. A complex pair is never divided.
        Returns:
            Complex numbers, sorted, the largest real part first; a pole stands there as often as it occurs.
        Raises:
            ValueError: as `stability.dominant_poles`.

        >>> System(1 / (s**2 + 3 * s + 2)).poles()
        [(-1+0j), (-2+0j)]
        >>> [complex(round(p.real, 4), round(p.imag, 4)) for p in closed_loop(sympy.exp(-s) / s).poles()]
        [(-0.3181+1.3372j), (-0.3181-1.3372j)]
        """
        return dominant_roots(self.denominator, count, f"{self.expr}", self.removable)

    # ---- python-control's names

    def feedback(self, other: TransferFunctionLike = 1, sign: int = -1) -> System:
        """Return ``G/(1 - sign*G*H)``, this system in the forward path and another in the path back: `closed_loop`.

        ``control.feedback(G, H)`` calls this for a `System` G, so the result is exact. Where python-control's own
        system comes first, make a `System` of it: ``System(G).feedback(H)``.

        Arguments:
            other: H, as for `closed_loop`.
            sign: -1 for negative feedback, 1 for positive feedback.
        Raises:
            ValueError: for another sign, or as `closed_loop`.

        >>> import control
        >>> control.feedback(System(sympy.exp(-s) / s), 1)
        System(exp(-s)/(s + exp(-s)))
        """
        if sign not in (-1, 1):
            raise ValueError(f"the sign is {sign!r}: expected -1 or 1")
        return closed_loop(self, other if sign == -1 else -read(other))

    # ---- frequency

    def frequency(self, omega: ArrayLike) -> np.ndarray:
        """Return the frequency response H(j omega), exact but for rounding.

        Arguments:
            omega: frequencies in radians for one unit of time, a number or an array.
        Returns:
            A complex array of the same shape; not finite at a pole on the axis, also one that only dead times cancel,
            as in (1 - exp(-s))/s.

        >>> System(sympy.exp(-s) / s).frequency(2.0).round(6)
        np.complex128(-0.454649+0.208073j)
        """
        return self(1j * real_numbers("frequencies", omega))

    # ---- responses in time

    @overload
    def step(self, times: ArrayLike) -> np.ndarray: ...
    @overload
    def step(self, times: None = None) -> Response: ...
    def step(self, times: ArrayLike | None = None) -> np.ndarray | Response:
        """Return the output for a unit step at t = 0 of the input, the system being at rest before.

        At a jump it is the value after the jump. The error is about 1e-13 of the largest value up to then; of a high
        order at first, while the response is still powers of ten smaller, about 1e-13 of what it is a lag later.

        Arguments:
            times: a number or an array, not negative, in the unit of the lags.
        Returns:
            An array of that shape; without times the response itself up to `horizon`, as `step_until` returns it.
        Raises:
            ValueError: for negative times, or where so many combinations of the dead times are points of discontinuity
                that the response cannot be followed.

        >>> closed_loop(System(sympy.exp(-s) / s)).step([0.5, 1.5, 2.5]).round(6)
        array([0.   , 0.5  , 1.375])
        """
        if times is None:
            return self.step_until()
        times = times_from_zero(times)
        return self.step_until(times.max(initial=0.0))(times)

    def step_until(self, end: float | None = None) -> Response:
        """Return the step response up to the time `end` as a `Response`, a function of time with its integrals.

        Without an end it is followed up to `horizon`.

        >>> System(1 / (s + 1)).step_until(5)(1.0).round(6)
        np.float64(0.632121)
        """
        return Response(self.state_space(), self.horizon() if end is None else end)

    def horizon(self, info: StepInfo | None = None) -> float:
        """Return a round time by which the step response has settled, or is seen not to.

        Arguments:
            info: what `step_info` says, if it is known.

        >>> System(sympy.exp(-s) / (2 * s + 1)).horizon(), System(1 / s).horizon()
        (12.0, 5.0)
        """
        slowest, delays = 10 * natural_range([self])[0], 2 * float(sum(self.delays))
        if info is None and self.is_stable:
            info = self.step_info()
        if info is None or not math.isfinite(info.settling_time):
            return _round_time(5 / slowest + delays)
        last = max(info.settling_time, info.peak_time if math.isfinite(info.peak_time) else 0)
        return _round_time(min(1.35 * last, 60 / slowest + 5 * delays) or 5 / slowest)

    def impulse(self, times: ArrayLike) -> np.ndarray:
        """Return the output for a unit impulse at t = 0: the step response of ``s*H``, with the accuracy of `step`.

        Raises ValueError if the system is not strictly proper, so that the output itself contains impulses.

        >>> System(sympy.exp(-s) / (s + 1)).impulse([0.5, 1, 2]).round(6)
        array([0.      , 1.      , 0.367879])
        """
        if any(len(part) > self.order for part in self.numerator.values()):
            raise ValueError(f"{self.expr} is not strictly proper: its response to an impulse contains impulses")
        return (self * DIFFERENTIATOR).step(times)

    def response(self, times: ArrayLike, u: object, hold: str = "zero order") -> np.ndarray:
        """Return the output for an input u(t) that begins at t = 0, the system being at rest before.

        Arguments:
            times: an array of times, not negative.
            u: an expression in `t` that has a rational Laplace transform apart from dead times (steps, ramps,
                polynomials, exponentials, sines, also later ones); or an array with a value for each of the times,
                increasing; the first one is a step from 0.
            hold: what samples are between their times: "zero order", kept until the next one, as a digital controller
                does and as `identification.fit` reads them; or "first order", joined by straight lines.
        Returns:
            An array, exact in the sense of `step` for all kinds of input.
        Raises:
            ValueError: for a signal without a transform, an input with impulses where the output would have impulses,
                or arrays that do not fit.

        >>> System(2 / s).response([3, 4], sympy.Heaviside(t - 2)).round(6)
        array([2., 4.])
        >>> System(1 / s).response([0, 1, 2], [0, 1, 3], hold="first order").round(6)
        array([0. , 0.5, 2.5])
        """
        times = times_from_zero(times)
        if hasattr(u, "__len__") and not isinstance(u, str):
            return response_to_samples(self.state_space(), times, u, hold)
        return System(self.fraction * read(transform(function_of(t, u)))).impulse(times)

    def step_info(self, settling: float = 0.02, rise: tuple[float, float] = (0.1, 0.9)) -> StepInfo:
        """Return rise time, settling time, overshoot, undershoot and peak of the unit step response, as `StepInfo`.

        Arguments:
            settling: half the width of the band in which the response has settled, as a share of the final value.
            rise: the shares of the final value between which the rise time is counted.
        Raises:
            ValueError: for a system that is not stable, shares that are none, or a response of which it is not decided
                when it settles, because several modes of it last too long.

        >>> info = closed_loop(sympy.exp(-s) / (2 * s)).step_info()
        >>> round(info.overshoot, 4), round(info.peak_time, 4)
        (0.0405, 4.7401)
        """
        return step_info(self.step_until, *self._ends_and_final_value(), self._slowest, settling, rise)

    def _slowest(self) -> list[complex]:
        """Some of the slowest poles; none where infinitely many may be as slow."""
        if any(len(part) > self.order for delay, part in self.denominator.items() if delay):
            return []
        try:
            return self.poles(4)
        except ValueError:
            return []

    def response_time(self, share: float = 1 - math.exp(-1)) -> float:
        """Return the time at which the unit step response first reaches a share of its final value, by default 63 %.

        Raises ValueError for a system that is not stable, a final value of zero, or a share that is none.

        >>> round(System(1 / (5 * s + 1)).response_time(), 6)
        5.0
        """
        number("the share", share, "one between 0 and 1", lambda x: 0 < x < 1)
        *ends, final = self._ends_and_final_value()
        if not final:
            raise ValueError(f"the step response of {self.expr} settles at 0: expected a number other than zero")
        return first_time_at(settled_response(self.step_until, *ends, final, 0.5, self._slowest)[0], share * final)

    def _ends_and_final_value(self) -> tuple[float, float, float]:
        """Two times to begin with, of 2,000 radians of the fastest pole and so, and the value of the step response."""
        if not self.is_stable:
            raise ValueError(f"{self.expr} is not stable: its step response does not settle")
        lags = [c / d for part in self.denominator.values() for c, d in itertools.pairwise(map(abs, part[::-1])) if d]
        slow = min((ratio for ratio in lags if ratio), default=0)
        *lower, highest = self.denominator[0]
        sizes = ((math.log(abs(c)) - math.log(highest)) / k for k, c in enumerate(reversed(lower), 1) if c)
        fast = math.exp(max(sizes, default=-math.inf))
        end = float(sum(self.delays)) * 2 + (4 / float(slow) if slow else 1.0)
        return 2000 / fast if fast else end, end, float(self.static_gain)

    # ---- pictures

    def bode(self, omega: ArrayLike | None = None, margins: bool = False, **options: object) -> Picture:
        """Plot magnitude and phase against frequency, as `pictures.bode_plot` does.

        Arguments:
            omega: the lowest and the highest frequency; by themselves a decade around the corner frequencies.
            margins: mark the margins of the closed loop around this system as the open one.
            options: title, unit of time, decibels, axes of one's own, as `pictures.bode_plot` takes them.

        >>> System(sympy.exp(-s) / (2 * s)).bode(margins=True)
        <magnitude and phase [deg] against omega [rad/s]; gain margin 3.14, phase margin 61.4°>
        """
        from loopbook.deadtime.pictures import bode_plot

        return bode_plot(self, omega, margins_of(self) if margins else None, **options)

    def nyquist(self, omega: ArrayLike | None = None, margins: bool = False, **options: object) -> PlanePlot:
        """Plot H(j omega) in the complex plane, as `pictures.nyquist_plot` does; `margins` as for `bode`.

        >>> System(sympy.exp(-s) / (2 * s)).nyquist(margins=True)
        <imaginary part against real part; gain margin 3.14, phase margin 61.4°, Ms 1.59>
        """
        from loopbook.deadtime.pictures import nyquist_plot

        return nyquist_plot(self, omega, margins_of(self) if margins else None, **options)

    def plot_step(self, end: float | None = None, info: bool = True, **options: object) -> TimePlot:
        """Plot the unit step response, as `pictures.step_plot` does.

        Arguments:
            end: the last time; by itself late enough for the response to settle.
            info: mark what `step_info` says, of a system that is stable.
            options: title, unit of time, axes of one's own, as `pictures.step_plot` takes them.

        >>> System(1 / (s**2 + s + 1)).plot_step()
        <y(t) against t [s]; overshoot 16.3 %, rise time 1.64 s, settling time 8.08 s>
        """
        from loopbook.deadtime.pictures import step_plot

        return step_plot(self, end, self.step_info() if info and self.is_stable else None, **options)

    # ---- other forms

    def state_space(self) -> ChannelModel:
        """Return a state-space model with delay channels, with balanced states.

        It is the controllable canonical form; from order 12 on Schwarz's, which keeps its digits (see `schwarz_form`).

        Each dead time of the denominator is a channel that leads back to the states, and each one of the numerator a
        channel that leads to the output.

        >>> System(sympy.exp(-3 * s) / (s + 2)).state_space().delays
        [Fraction(3, 1)]
        """
        return self._state_space

    @functools.cached_property
    def _state_space(self) -> ChannelModel:
        return state_space(self)

    def to_control(
        self, order: int | None = None, omega: ArrayLike | None = None
    ) -> control.StateSpace | control.FrequencyResponseData:
        """Return the system as one of python-control: its exact frequency response, or an approximation by states.

        Arguments:
            order: of a Pade approximation in place of each dead time, at least 1: the result is a state-space system.
                There is no default, because it decides what that is worth. Without an order the result is the data of
                the frequency response, exact, which python-control's Bode, Nyquist and Nichols plots accept.
            omega: the frequencies of these data, positive and increasing; by themselves as many as a picture needs.
        Raises:
            ValueError: for another order, frequencies beside an order, or others, or a pole at one of them.

        The way back is `System` itself, and every function of ours takes python-control's systems. Its operators take
        ours: ``G + H`` and ``G * H`` are a `System` where one of them is. Its functions ask for its own types, but for
        ``control.feedback`` (see `feedback`): ``control.bode(H.to_control())``, ``control.step_response(
        H.to_control(order=6))``.

        >>> H = System(sympy.exp(-s) / (s + 1))
        >>> H.to_control(order=4).nstates
        5
        >>> H.to_control(omega=[0.5, 1]).magnitude.round(4)
        array([0.8944, 0.7071])
        """
        import control

        if order is None:
            if omega is None:
                curve = frequency_curve(self, *natural_range([self]))
                omega = curve.omega[np.isfinite(curve.phase)]
            omega = increasing("frequencies", np.atleast_1d(positive_numbers("frequencies", omega)))
            values = self.frequency(omega)
            if not np.isfinite(values).all():
                pole = omega[~np.isfinite(values)][0]
                raise ValueError(f"{self.expr} has a pole at the frequency {pole:g}: expected others")
            return control.FrequencyResponseData(values, omega, dt=0, name="H")
        if omega is not None:
            raise ValueError(f"order is {order!r} and omega is given: expected one of the two")
        order = whole("order", order)
        A, B1, B2, C1, C2, D11, D12, D21, D22, delays = self.state_space()
        B, C = np.hstack([B1, B2]), np.vstack([C1, C2])
        D = np.block([[D11, D12], [D21, D22]])
        model = control.ss(A, B, C, D)
        if not delays:
            return model
        channels = control.append(*(control.ss(control.tf(*control.pade(float(delay), order))) for delay in delays))
        return model.lft(channels)


def _round_time(value: float) -> float:
    decade = 10.0 ** math.floor(math.log10(value))
    steps = (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)
    return float(f"{next(x for x in steps if x * decade >= value * 0.999) * decade:g}")


def closed_loop(G: object, H: object = 1) -> System:
    """Return the closed loop ``G/(1 + G*H)``, with G in the forward path and H in the path back, as a `System`.

    Arguments:
        G, H: systems, controllers, expressions in `s`, or systems of python-control. Each may be improper.
    Raises:
        ValueError: for an algebraic loop that has no solution because ``1 + G*H`` is zero at infinite frequency, or as
            `System`.

    >>> closed_loop(2 * sympy.exp(-s) / s, sympy.Rational(1, 2))
    System(2*exp(-s)/(s + exp(-s)))
    """
    G, H = read(G).fraction, read(H).fraction
    return System(G / return_difference(G * H))


def return_difference(L: DelayFraction) -> DelayFraction:
    """1 + L, if a loop with the open loop L has a solution."""
    above = plus(L.denominator, L.numerator)
    if len(above.get(ZERO, ())) < L.order + 1:
        raise ValueError(f"the algebraic loop around {L.expr} has no solution: its gain at infinite frequency is -1")
    return DelayFraction.coprime(above, L.denominator)  # a common factor would be one of L
