"""The relay experiment: an on/off controller makes the loop oscillate, and amplitude and period tell how to tune it.

Between two switches the control signal is constant, so that the output of a linear process is a sum of its exact step
responses, shifted to the moments of the switches. The moments are found as roots of that sum.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime import System
from loopbook.identification.records import record
from loopbook.laplace import zero_between
from loopbook.stability import ultimate
from loopbook.types import Number, TransferFunctionLike
from plainmath.validation import not_negative, number, positive

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

SAME = 1e-9  # two half periods in a row that differ by no larger share belong to a limit cycle
MOST_SWITCHES = 400
POINTS = 400  # at which a stretch is looked at before a root or a peak is refined
PERIODS = 5  # of the limit cycle that a noisy record is averaged over


@dataclass(frozen=True, repr=False)
class LimitCycle:
    """What a relay experiment tells: `relay_experiment` and `limit_cycle` return it.

    Attributes:
        Ku, Pu: estimates of the ultimate gain, 4 d/(pi a), and of the ultimate period, that of the oscillation.
        amplitude: a, half of what lies between the highest and the lowest measurement.
        phase: where on the frequency response of the process the experiment took place, in degrees: -180 without
            hysteresis h, and asin(h/a) above it with one, by the describing function of the relay.
        times, u, y: the record, arrays.
        switches: the moments at which the relay switched.
    """

    Ku: float
    Pu: float
    amplitude: float
    phase: float
    times: np.ndarray
    u: np.ndarray
    y: np.ndarray
    switches: np.ndarray

    def __repr__(self) -> str:
        return f"<limit cycle: Ku = {self.Ku:.4g}, Pu = {self.Pu:.4g}, amplitude {self.amplitude:.4g}>"


def relay_experiment(
    process: TransferFunctionLike, amplitude: Number = 1, hysteresis: Number = 0, periods: Number = 6
) -> LimitCycle:
    """Return the limit cycle of a process under relay control, exact, with the record of how it begins.

    The relay puts out +d while the control error -y is positive, and -d while it is negative; with a hysteresis h it
    switches when y passes +h or -h. The process is at rest at the beginning, and the relay switched to +d. The control
    signal counts from the operating point.

    Arguments:
        process: transfer function with numbers and dead times, strictly proper, with positive gain.
        amplitude: d, that of the relay, in units of the control signal.
        hysteresis: h, in units of the measurement.
        periods: of the limit cycle, which the record shows at least.
    Returns:
        A `LimitCycle`; Ku has the unit of d/a, Pu that of the lags.
    Raises:
        ValueError: for numbers that are not positive, a process that answers too quickly for a limit cycle (a single
            lag or integrator without dead time and hysteresis), or one that does not settle into one.
    Source: Haugen, Section 10.4, Figure 10.10.

    >>> import sympy
    >>> from loopbook import s
    >>> cycle = relay_experiment(sympy.exp(-s) / s)    # a triangle with the amplitude 1 and the period 4
    >>> round(cycle.amplitude, 6), round(cycle.Pu, 6), round(cycle.Ku, 4)
    (1.0, 4.0, 1.2732)
    """
    d, h = positive("the amplitude of the relay", amplitude), not_negative("the hysteresis", hysteresis)
    system, periods = System(process), positive("the number of periods", periods)
    period = _expected_period(system, d, h)
    steps = _Steps(system, period)
    signs, switches = [1.0], [0.0]  # the relay's output changes to sign*d at these moments

    def output(t):
        y = np.zeros(np.shape(t))
        for n, (sign, moment) in enumerate(zip(signs, switches, strict=True)):
            y += sign * (1 if n == 0 else 2) * d * steps.since(t, moment)
        return y

    while not _settled(switches):
        if len(switches) > MOST_SWITCHES:
            raise ValueError(f"the relay does not settle into a limit cycle within {MOST_SWITCHES} switches")
        if len(switches) == 1 and h == 0 and 0 in system.numerator:
            following = period / 4  # without dead time and hysteresis the rest is left at once: any push will do
        else:
            following = _next_switch(lambda t: signs[-1] * output(t) - h, switches[-1], period)
        if following - switches[-1] < 1e-6 * period:
            raise ValueError("the relay switches ever faster: expected a process with dead time, or a hysteresis")
        switches.append(following)
        signs.append(-signs[-1])
    Pu = switches[-1] - switches[-3]
    while switches[-1] < periods * Pu:
        switches.append(switches[-2] + Pu)
        signs.append(-signs[-1])
    corners = [moment + float(delay) for moment in switches for delay in [0, *system.delays]]
    times = np.unique(np.concatenate([np.linspace(0, switches[-1], 60 * len(switches)), switches, corners]))
    times = times[times <= switches[-1]]
    y = output(times)
    last = times >= switches[-3]
    a = (_peak(output, times[last], y[last]) + _peak(lambda t: -output(t), times[last], -y[last])) / 2
    if h > a * (1 + 1e-9):
        raise ValueError(f"the hysteresis {h:g} is larger than the amplitude {a:g}")
    u = d * np.array(signs)[np.searchsorted(switches, times, side="right") - 1]
    a = float(a)
    Ku, phase = 4 * d / (math.pi * a), -180 + math.degrees(math.asin(min(h / a, 1)))
    return LimitCycle(Ku, Pu, a, phase, times, u, y, np.array(switches[1:]))


def _expected_period(system, d, h):
    """About the period, as a scale of time."""
    if any(len(part) > system.order for part in system.numerator.values()):
        raise ValueError(f"{system.expr} answers at once: expected a strictly proper process")
    Ku, Pu = ultimate(system)
    if math.isfinite(Ku) and Pu > 0 and math.isfinite(Pu):
        return Pu
    if h == 0:
        raise ValueError(
            f"no positive gain makes the loop of {system.expr} oscillate, and so does no relay without hysteresis"
        )
    # the frequency, to a factor of two, at which the process lets through as much as the hysteresis wants
    frequency = 1.0
    while abs(system.frequency(frequency)) > h / d:
        frequency *= 2
    while abs(system.frequency(frequency)) < h / d:
        frequency /= 2
        if frequency < 1e-30:
            raise ValueError(f"the output of {system.expr} does not reach the hysteresis {h:g}: expected a smaller one")
    return 2 * math.pi / frequency


class _Steps:
    """The step response of a process, as far as it is needed, on demand."""

    def __init__(self, system, end):
        self.system, self.end = system, 8 * end
        self.response = system.step_until(self.end)

    def since(self, t, moment):
        """The response to a unit step at a moment."""
        elapsed = np.asarray(t, dtype=float) - moment
        if elapsed.size and elapsed.max() > self.end:
            self.end = 2 * float(elapsed.max())
            self.response = self.system.step_until(self.end)
        return np.where(elapsed >= 0, self.response(np.maximum(elapsed, 0)), 0.0)


def _settled(switches):
    """Whether the last two half periods are alike."""
    if len(switches) < 5:
        return False
    early, late = switches[-2] - switches[-3], switches[-1] - switches[-2]
    before = switches[-3] - switches[-4]
    return abs(late - early) <= SAME * late and abs(early - before) <= SAME * late


def _next_switch(distance, since, period):
    """The first moment after a switch at which the distance to the next one becomes positive."""
    for stretch in itertools.count():
        t = since + period * (stretch + np.linspace(0, 1, POINTS + 1))
        beyond = distance(t) > 0
        if stretch == 0:
            # just after a switch y is still on the side from where it came
            beyond[: 1 + int((~beyond).argmax())] = False
        if beyond.any():
            k = int(beyond.argmax())
            if distance(t[k - 1]) == 0:  # at rest up to the end of a dead time
                return _last(lambda x: distance(x) <= 0, t[k - 1], t[k])
            return zero_between(distance, t[k - 1], t[k], 1e-14 * max(t[k], period))
        if stretch > 1000:
            raise ValueError(
                "the measurement does not come to the next switch: expected a process with positive gain, "
                "and a hysteresis that it reaches"
            )


def _last(holds, low, high):
    """The last moment from low to high at which a condition holds that ends once, by halves."""
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if holds(middle) else (low, middle)
    return float(low)


def _peak(function, times, values):
    """The highest value, refined between the neighbours of the highest sample."""
    from scipy.optimize import minimize_scalar

    k = int(values.argmax())
    found = [values[k]]
    for a, b in itertools.pairwise(times[max(k - 1, 0) : k + 2]):
        options = {"xatol": 1e-9 * (b - a)}
        refined = minimize_scalar(lambda t: -float(function(t)), bounds=(a, b), method="bounded", options=options)
        found.append(-refined.fun)
    return max(found)


class Relay:
    """An on/off controller that runs once a sample, for a simulated experiment with noise. (Haugen, Figure 10.10)

    Arguments:
        amplitude: d, positive: the control signal is u0 + d while the control error is positive, else u0 - d.
        step: time between two samples, positive.
        hysteresis: h, in units of the measurement: it switches when the error passes -h or +h; larger than the noise.
        u0: nominal control signal.

    >>> relay = Relay(amplitude=5, step=1, hysteresis=0.1, u0=50)
    >>> [relay.update(setpoint=20, measurement=y) for y in (19, 20.05, 20.2, 19.95, 19.8)]
    [55.0, 55.0, 45.0, 45.0, 55.0]
    """

    def __init__(self, amplitude: Number, step: Number, hysteresis: Number = 0, u0: Number = 0):
        self.amplitude, self.step = positive("the amplitude", amplitude), positive("the step", step)
        self.hysteresis, self.u0 = not_negative("the hysteresis", hysteresis), number("the signal u0", u0)
        self.on, self.u = True, self.u0

    def update(
        self, setpoint: Number, measurement: Number, feedforward: Number = 0.0, manual: Number | None = None
    ) -> float:
        """Take the signals of this sample and return the control signal, in manual mode the operator's.

        >>> from loopbook.pid import HOLD
        >>> relay = Relay(amplitude=5, step=1, u0=50)
        >>> [relay.update(20, 19, manual=u) for u in (None, 47, HOLD, None)]
        [55.0, 47.0, 47.0, 55.0]
        """
        error = float(setpoint) - float(measurement)
        if abs(error) > self.hysteresis:
            self.on = error > 0
        if manual is None:
            self.u = self.u0 + (self.amplitude if self.on else -self.amplitude) + float(feedforward)
        elif not math.isnan(manual):
            self.u = float(manual)
        return self.u


def limit_cycle(times: ArrayLike, u: ArrayLike, y: ArrayLike, hysteresis: Number = 0) -> LimitCycle:
    """Return amplitude and period of an oscillation under relay control from a record, which may be noisy.

    The mean over the last five periods counts: the period is that between the relay's switches upwards, and the
    amplitude that of the measurement's mean period, so that noise is averaged away. In a sampled loop the relay
    switches up to a sample late, which makes the period longer.

    Arguments:
        times: increasing moments; u, y: the relay's control signal and the measurement, arrays.
        hysteresis: that of the relay.
    Returns:
        A `LimitCycle`.
    Raises:
        ValueError: for a record with fewer than two whole periods, or with periods of very different lengths, as where
            noise switches the relay; or arrays that do not fit.
    """
    times, u, y = record(times, u=u, y=y)
    h = not_negative("the hysteresis", hysteresis)
    low, high = u.min(), u.max()
    up = np.flatnonzero((u[1:] > u[:-1]) & (u[1:] > (low + high) / 2)) + 1
    if len(up) < 3:
        raise ValueError(f"the relay switched on {len(up)} times: expected a record with two whole periods at least")
    up = up[-1 - PERIODS :]
    shortest, *_, longest = sorted(np.diff(times[up]))
    if longest > 2 * shortest:
        raise ValueError(
            f"the last periods are from {shortest:.3g} to {longest:.3g} long: expected a steady oscillation; "
            "a hysteresis above the noise keeps it from switching the relay"
        )
    Pu = (times[up[-1]] - times[up[0]]) / (len(up) - 1)
    # one mean period, on as many points as a period has samples
    count = max(4, round(len(times) * Pu / (times[-1] - times[0])))
    phase = np.arange(count) / count
    periods = [np.interp(a + phase * (b - a), times, y) for a, b in itertools.pairwise(times[up])]
    mean = np.mean(periods, axis=0)
    a, d = float(mean.max() - mean.min()) / 2, float(high - low) / 2
    if a == 0:
        raise ValueError(f"the measurement is {y[0]:g} all the time: expected one that oscillates")
    angle = -180 + math.degrees(math.asin(min(h / a, 1)))
    return LimitCycle(4 * d / (math.pi * a), float(Pu), a, angle, times, u, y, times[1:][np.diff(u) != 0])
