"""Gain, lag and dead time read off a recorded step response, as with a ruler. (Haugen, Figures 10.8 and 10.9)"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from loopbook.approximation import SOPDT
from loopbook.identification.records import record
from plainmath.expressions import exact
from plainmath.validation import number, one_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

RISE = 0.6321205588285577  # of a lag after one time constant, 1 - 1/e
EARLY_RISE = 0.2834686894262108  # after a third of it, 1 - exp(-1/3)
LAST = 10  # the final value is the mean over this part of the record: a tenth
EARLY = 0.05  # share of the record by which an asymptote may start too early
SETTLED = 0.03  # by how much of the change the last two tenths may differ, beside noise
WINDOW = 5.0  # how wide a window is where the response is smoothed, beside what noise and sampling time ask for
WIDEST = 0.7  # of them, in lags
FEWEST = 3  # samples in a window; below, the response is read by straight lines
COARSE = 5  # samples in a lag; of fewer, noise is not to be told from what the response does
LEVELS = 10  # from so many on, the smallest difference of two values may be that of a converter
STRIDES = 8  # of windows, within their width


def first_order_from_step(
    times: ArrayLike, y: ArrayLike, U: float = 1, at: float = 0, delay_by: str = "tangent"
) -> SOPDT:
    """Return gain, lag and dead time of a lag with dead time, read off a step response.

    The gain is the final change of y divided by that of the control signal. The dead time is where the steepest slope
    leaves the initial level ("tangent"), and the lag the time from there to 63 % of the final change. Two points of the
    curve say both without a slope ("two points"): 63 % is reached one lag after the dead time, 28 % a third of one.
    Between samples the response is read by straight lines. If there is noise, which shows where the response is at
    rest, the ruler is laid through all samples of a window: a straight line by least squares for the slope, a parabola
    for the points. The window is as wide as noise and sampling time ask for, up to 0.7 lags; it makes the slope of a
    lag a little smaller, and the dead time by a few per cent of the lag shorter. The noise is taken for white. The
    level before the step is the mean of the samples before it, and so should be more than one. Of noisy data, `fit`
    makes more.

    Arguments:
        times, y: the record, two arrays; it begins before the step and ends at rest.
        U: height of the step of the control signal, not zero.
        at: the time of the step, not before the record begins.
        delay_by: "tangent", as in the figure, or "two points".
    Returns:
        An `SOPDT` with K, T1 and delay.
    Raises:
        ValueError: for arrays that do not fit, a step of zero, a response that has not come to rest, or one that is not
            to be told from noise.
    Source: Haugen, Figure 10.9.

    >>> import numpy as np
    >>> import sympy
    >>> from loopbook import s
    >>> from loopbook.deadtime import System
    >>> times = np.linspace(0, 60, 601)
    >>> y = System(2 * sympy.exp(-3 * s) / (8 * s + 1)).step(times)
    >>> model = first_order_from_step(times, y)
    >>> [round(float(x), 2) for x in (model.K, model.T1, model.delay)]
    [2.0, 7.98, 3.0]
    """
    one_of("delay_by", delay_by, ("tangent", "two points"))
    times, y, before, U = _from_the_step(times, y, U, at)
    tenth = max(1, len(y) // LAST)
    change = y[-tenth:].mean() - before
    drift = abs(y[-tenth:].mean() - y[-2 * tenth : -tenth].mean())
    noise = _noise(times, y)
    if change == 0 or drift > SETTLED * abs(change) + 3 * noise * math.sqrt(2 / tenth):
        raise ValueError("the response has not come to rest: expected a longer record, or use integrator_from_step")
    if noise > abs(change) / 3:
        raise ValueError(
            f"the noise of {noise:.2g} hides a change of {abs(change):.2g}: expected a larger step, or use fit"
        )
    rise = (y - before) / change
    window = _window(times, rise, noise / abs(change))
    curve = _smoothed(times, rise, window)
    t_63 = _first_time(*curve, RISE)
    if delay_by == "two points":
        T = 1.5 * (t_63 - _first_time(*curve, EARLY_RISE))
        return _model(change / U, T, t_63 - T)
    delay = _tangent(times, rise, window, t_63)
    if delay >= t_63:
        raise ValueError("the steepest slope is that of noise: expected a smooth record; or use 'two points', or fit")
    return _model(change / U, t_63 - delay, delay)


def integrator_from_step(times: ArrayLike, y: ArrayLike, U: float = 1, at: float = 0, part: float = 0.5) -> SOPDT:
    """Return the gain and the dead time of an integrator with dead time, read off a step response.

    The response ends on a straight line, its asymptote. Its slope is ``K*U``, and it leaves the initial level one dead
    time after the step; of an integrator with a lag, one dead time and one lag after it.

    Arguments:
        times, y, U, at: as for `first_order_from_step`; the record ends on the asymptote.
        part: the share of the response, its end, that lies on the asymptote.
    Returns:
        An `SOPDT` with K, T1 = oo and delay.
    Raises:
        ValueError: for arrays that do not fit, a step of zero, or a response without such an asymptote.
    Source: Haugen, Figure 10.8.

    >>> import numpy as np
    >>> times = np.linspace(0, 10, 101)
    >>> integrator_from_step(times, 5 + 3 * np.maximum(times - 4, 0), U=2)
    SOPDT(K=3/2, T1=oo, delay=4)
    """
    import sympy

    part = number("the part on the asymptote", part, "a share from 0 to 1", lambda x: 0 < x <= 1)
    times, y, before, U = _from_the_step(times, y, U, at)
    late = times >= times[-1] * (1 - part)
    if late.sum() < 2:
        raise ValueError(f"only {late.sum()} samples are in the last {part:.0%} of the response: expected more")
    t_mean, y_mean = times[late].mean(), y[late].mean()
    slope = ((times[late] - t_mean) * (y[late] - y_mean)).sum() / ((times[late] - t_mean) ** 2).sum()
    if slope == 0:
        raise ValueError("the response ends at rest: use first_order_from_step")
    delay = t_mean - (y_mean - before) / slope
    if delay < -EARLY * times[-1]:
        raise ValueError(f"the asymptote starts {-delay:.3g} before the step: expected the response of an integrator")
    return _model(slope / U, sympy.oo, delay)


def _from_the_step(times, y, U, at):
    """The response counted from the step, the level before it, and the step as a number."""
    times, y = record(times, y=y)
    U = number("the step U", U, "a step of the control signal", lambda x: x != 0)
    at = number("the time of the step", at, "a time within the record", lambda x: times[0] <= x < times[-1])
    before = y[times <= at].mean()
    return times[times >= at] - at, y[times >= at], before, U


def _noise(times, y):
    """The standard deviation of white noise: how far samples are from the line between their neighbours.

    At the end, where the response is at rest, and in the middle of all of them; and what rounding to steps makes.
    """
    share = (times[1:-1] - times[:-2]) / (times[2:] - times[:-2])
    off = (y[1:-1] - (1 - share) * y[:-2] - share * y[2:]) / np.sqrt(1 + share**2 + (1 - share) ** 2)
    at_rest = off[-max(2, len(off) // 5) :]
    values = np.unique(y)
    rounding = np.diff(values).min() / math.sqrt(12) if len(values) >= LEVELS else 0.0
    return max(math.sqrt((at_rest**2).mean()), 1.48 * float(np.median(abs(off))), rounding)


def _window(times, rise, noise):
    """How many samples are looked at together, so that what noise does to a slope and what the window does balance."""
    step = times[-1] / (len(times) - 1)
    # where most samples before are below and most after are above, whatever noise does to single ones
    t_63, t_28 = (times[np.cumsum(rise - share).argmin()] for share in (RISE, EARLY_RISE))
    T = max(1.5 * (t_63 - t_28), step)
    if step > T / COARSE:
        return 1
    width = T * min(WINDOW * (noise**2 * step / T) ** 0.2, WIDEST)
    return min(round(width / step) + 1, len(times) // 2)


def _windows(times, rise, count):
    """Times, their mean, and values in windows of some samples, not all of them where there are many."""
    stride = max(1, count // STRIDES)
    t, x = (sliding_window_view(signal, count)[::stride] for signal in (times, rise))
    mean = t.mean(axis=1)
    return t - mean[:, None], mean, x


def _smoothed(times, rise, count):
    """The response by parabolas through windows, at their middles; or as it is."""
    count += 1 if count == FEWEST else 0  # a parabola meets three samples
    if count < FEWEST:
        return times, rise
    t, mean, x = _windows(times, rise, count)
    width = np.ptp(t, axis=1)
    powers = np.stack([np.ones_like(t), t / width[:, None], (t / width[:, None]) ** 2], axis=2)
    turned = powers.transpose(0, 2, 1)
    parabolas = np.linalg.solve(turned @ powers, turned @ x[:, :, None])[:, :, 0]
    first = powers[0, 0] @ parabolas[0]
    return np.append(times[0], mean), np.append(first, parabolas[:, 0])


def _tangent(times, rise, count, before):
    """Where the steepest line through a window leaves the initial level; through two samples if windows are short."""
    t, mean, x = _windows(times, rise, count if count >= FEWEST else 2)
    slopes = (t * x).sum(axis=1) / (t**2).sum(axis=1)
    k = slopes[t[:, 0] + mean < before].argmax()  # later, noise alone is steeper
    return mean[k] - x[k].mean() / slopes[k]


def _first_time(times, rise, share):
    """When the response first reaches a share of its change."""
    k = int((rise >= share).argmax())
    if k == 0:  # at once, or never
        raise ValueError("the response is there from the beginning: expected a record that begins with the step")
    part = (share - rise[k - 1]) / (rise[k] - rise[k - 1])
    return times[k - 1] + part * (times[k] - times[k - 1])


def _model(K, T, delay):
    import sympy

    rounded = (x if x == sympy.oo else exact(float(f"{x:.10g}")) for x in (K, T, delay))
    K, T, delay = rounded
    return SOPDT(K, T1=T, delay=max(delay, sympy.S.Zero))
