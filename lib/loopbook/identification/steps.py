"""Gain, lag and dead time read off a recorded step response, as with a ruler. (Haugen, Figures 10.8 and 10.9)"""

from loopbook.approximation import Model
from loopbook.expressions import exact
from loopbook.identification.records import record
from loopbook.inputs import number, one_of

RISE = 0.6321205588285577  # of a lag after one time-constant, 1 - 1/e
EARLY_RISE = 0.2834686894262108  # after a third of it, 1 - exp(-1/3)
LAST = 10  # the final value is the mean over this part of the record: a tenth
EARLY = 0.05  # share of the record by which an asymptote may start too early
SETTLED = 0.03  # by how much of the change the last two tenths may differ


def first_order_from_step(times, y, U=1, at=0, delay_by="tangent"):
    """Return gain, lag and dead time of a lag with dead time, read off a step response.

    The gain is the final change of y divided by that of the control signal. The dead time is where the steepest slope
    leaves the initial level ("tangent"), and the lag the time from there to 63 % of the final change. Two points of the
    curve say both without a slope ("two points"): 63 % is reached one lag after the dead time, 28 % a third of one.
    Between samples the response is read by straight lines. Of noisy data, `fit` makes more.

    Arguments:
        times, y: the record, two arrays; it begins before the step and ends at rest.
        U: height of the step of the control signal, not zero.
        at: the time of the step, not before the record begins.
        delay_by: "tangent", as in the figure, or "two points".
    Returns:
        A `Model` with K, T1 and delay.
    Raises:
        ValueError: for arrays that do not fit, a step of zero, a response that has not come to rest, or a tangent to
            nothing but noise.
    Source: Haugen, Figure 10.9.

    >>> import numpy, sympy
    >>> from loopbook import s
    >>> from loopbook.deadtime import System
    >>> times = numpy.linspace(0, 60, 601)
    >>> y = System(2 * sympy.exp(-3 * s) / (8 * s + 1)).step(times)
    >>> model = first_order_from_step(times, y)
    >>> [round(float(x), 2) for x in (model.K, model.T1, model.delay)]
    [2.0, 7.98, 3.0]
    """
    import numpy

    one_of("delay_by", delay_by, ("tangent", "two points"))
    times, y, before, U = _from_the_step(times, y, U, at)
    tenth = max(1, len(y) // LAST)
    change = y[-tenth:].mean() - before
    drift = abs(y[-tenth:].mean() - y[-2 * tenth : -tenth].mean())
    if change == 0 or drift > SETTLED * abs(change):
        raise ValueError("the response has not come to rest: expected a longer record, or use integrator_from_step")
    rise = (y - before) / change
    t_63 = _first_time(times, rise, RISE)
    if delay_by == "two points":
        T = 1.5 * (t_63 - _first_time(times, rise, EARLY_RISE))
        return _model(change / U, T, t_63 - T)
    slopes = numpy.diff(rise) / numpy.diff(times)
    k = slopes.argmax()
    delay = times[k] - rise[k] / slopes[k]
    if delay >= t_63:
        raise ValueError("the steepest slope is that of noise: expected a smooth record; or use 'two points', or fit")
    return _model(change / U, t_63 - delay, delay)


def integrator_from_step(times, y, U=1, at=0, part=0.5):
    """Return the gain and the dead time of an integrator with dead time, read off a step response.

    The response ends on a straight line, its asymptote. Its slope is K*U, and it leaves the initial level one dead time
    after the step; of an integrator with a lag, one dead time and one lag after it.

    Arguments:
        times, y, U, at: as for `first_order_from_step`; the record ends on the asymptote.
        part: the share of the response, its end, that lies on the asymptote.
    Returns:
        A `Model` with K, T1 = oo and delay.
    Raises:
        ValueError: for arrays that do not fit, a step of zero, or a response without such an asymptote.
    Source: Haugen, Figure 10.8.

    >>> import numpy
    >>> times = numpy.linspace(0, 10, 101)
    >>> integrator_from_step(times, 5 + 3 * numpy.maximum(times - 4, 0), U=2)
    Model(K=3/2, T1=oo, delay=4)
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


def _first_time(times, rise, share):
    """When the response first reaches a share of its change."""
    k = int((rise >= share).argmax())
    if k == 0:
        raise ValueError("the response is there from the beginning: expected a record that begins with the step")
    part = (share - rise[k - 1]) / (rise[k] - rise[k - 1])
    return times[k - 1] + part * (times[k] - times[k - 1])


def _model(K, T, delay):
    import sympy

    rounded = (x if x == sympy.oo else exact(float(f"{x:.10g}")) for x in (K, T, delay))
    K, T, delay = rounded
    return Model(K, T1=T, delay=max(delay, sympy.S.Zero))
