"""A simple model fitted to logged data of control signal and measurement, by least squares."""

import itertools
import math
from dataclasses import dataclass

import sympy

from loopbook.approximation import Model
from loopbook.expressions import exact
from loopbook.identification.held import KINDS, responses
from loopbook.identification.records import record, sampling_step
from loopbook.inputs import number, one_of

STARTS = ("rest", "unknown")
DELAYS, LAGS = 16, 7  # how many of each are tried at first
BEST = 4  # of these, from which the search begins
DIGITS = 10  # of the model's numbers
SHORTEST = 1 / 20  # lag that is looked for, in steps
CLOSE = 1e-5  # a dead time of so few steps is none


@dataclass(frozen=True, repr=False)
class Fit:
    """A model that fits logged data: what `fit` returns.

    Attributes:
        model: the `Model`.
        kind: as given to `fit`.
        parameters: K, T1 or T1 and T2, and delay, floats by name.
        errors: the standard error of each of them, if what is left of the data is white noise.
        residual: standard deviation of what is left, in the unit of the measurement.
        times, y, fitted: the record, and what the model makes of the control signal; arrays.
    """

    model: Model
    kind: str
    parameters: dict
    errors: dict
    residual: float
    times: object
    y: object
    fitted: object

    @property
    def expr(self):
        """The transfer function of the model."""
        return self.model.expr

    def __repr__(self):
        values = ", ".join(f"{name} = {value:.4g} ± {self.errors[name]:.1g}" for name, value in self.parameters.items())
        return f"<fit, {self.kind} with dead time: {values}; residual {self.residual:.3g}>"


def fit(times, u, y, kind="first order", *, start="rest", level=None, longest_delay=None):
    """Fit a simple model with dead time to logged data, so that the sum of squared output errors is least.

    The output error is the measurement minus what the model makes of the control signal alone. The control signal is
    held between samples, and the model's response is exact. For given lags and dead time the rest of the problem is
    linear. Lags and dead time are searched with `scipy.optimize.least_squares`, from the best of a grid of starting
    points, because the sum of squares over the dead time may have several minima. A lag that is shorter than the time
    between two samples is not resolved: its standard error is then too small.

    Arguments:
        times: moments of the samples, evenly spaced.
        u, y: control signal and measurement at these moments; u is held until the next one.
        kind: "first order", "second order" (two real lags), "integrator" or "integrator with lag".
        start: "rest", if the process was at rest with the first control signal before the record; or "unknown", and
            then the state at the beginning is estimated, too. Before the record, u had its first value for as long as
            the dead time.
        level: the measurement at rest with the first control signal, if it is known; otherwise it is estimated.
        longest_delay: up to which a dead time is looked for; half of the record if not given.
    Returns:
        A `Fit`.
    Raises:
        ValueError: for arrays that do not fit, uneven samples, another kind or start, a signal that does not move, or
            a dead time as long as the longest one.

    >>> import numpy
    >>> times = numpy.arange(60.0)
    >>> u = numpy.where(times < 5, 0, 1)
    >>> y = 2 * (1 - numpy.exp(-numpy.maximum(times - 7.5, 0) / 10))
    >>> fit(times, u, y).model
    Model(K=2, T1=10, delay=5/2)
    """
    import numpy
    from scipy.optimize import least_squares

    times, u, y = record(times, u=u, y=y)
    step, span = sampling_step(times), times[-1] - times[0]
    one_of("the kind", kind, KINDS)
    one_of("the start", start, STARTS)
    if not (u[:-1] != u[0]).any():
        raise ValueError(f"the control signal is {u[0]:g} all the time: expected an experiment that moves it")
    if not (y != y[0]).any():
        raise ValueError(f"the measurement is {y[0]:g} all the time: expected an experiment that moves it")
    longest_delay = span / 2 if longest_delay is None else longest_delay
    number(
        "the longest dead time", longest_delay, f"a time up to that of the record, {span:g}", lambda x: 0 < x <= span
    )
    lags, integrators = KINDS[kind]
    # neither the search nor the standard errors may depend on units: time counts in steps, signals in their own spans
    unit_u, unit_y = abs(u - u[0]).max(), numpy.ptp(y)
    moved = (u - u[0]) / unit_u
    rest = y[0] if level is None else number("the level", level)
    target = (y - rest) / unit_y

    def regressors(p):
        forced, free = responses(kind, numpy.exp(p[:-1]), p[-1], 1.0, moved)
        if start == "rest":
            free = numpy.ones((len(u), 0 if level is not None else 1))
        elif level is not None:
            free = free[:, :-1]
        return numpy.column_stack([forced, free])

    def left(p):
        return _without(regressors(p), target)

    count, longest = span / step, float(longest_delay) / step
    low = numpy.array([math.log(SHORTEST)] * lags + [0.0])
    high = numpy.array([math.log(100 * count)] * lags + [longest])
    tried = numpy.log(numpy.geomspace(0.5, 2 * count, LAGS))
    sets = itertools.combinations_with_replacement(tried[::-1], lags)
    grid = [[*T, delay] for T in sets for delay in numpy.linspace(0, longest, DELAYS, endpoint=False)]
    grid.sort(key=lambda p: (left(p) ** 2).sum())
    tolerances = {"xtol": 1e-12, "ftol": 1e-12, "gtol": 1e-12, "x_scale": "jac"}
    searched = [
        least_squares(left, numpy.clip(p, low + 1e-9, high - 1e-9), bounds=(low, high), **tolerances)
        for p in _apart(grid, longest / DELAYS)
    ]
    best = min(searched, key=lambda found: found.cost)
    if best.x[-1] > longest * (1 - 1e-6):
        raise ValueError(f"the dead time would be {longest_delay:g} or longer: expected a larger longest_delay")
    units = numpy.array([unit_y / unit_u / step**integrators, *[step] * (lags + 1)])
    parameters, errors, residual, fitted = _described(best.x, regressors, target, units)
    names = ["K", *("T2" if integrators else f"T{n + 1}" for n in range(lags)), "delay"]
    parameters, errors = (dict(zip(names, map(float, x), strict=True)) for x in (parameters, errors))
    rounded = {name: exact(float(f"{value:.{DIGITS}g}")) for name, value in parameters.items()}
    model = Model(**({"T1": sympy.oo} if integrators else {}), **rounded)
    return Fit(model, kind, parameters, errors, float(residual * unit_y), times, y, rest + unit_y * fitted)


def _without(columns, target):
    """What is left of the target when the columns have explained what they can: Gram and Schmidt, twice for rounding.

    For so few columns that is quicker than a general routine.
    """
    import numpy

    found, left = [], target
    for column in columns.T:
        size = numpy.sqrt(column @ column)
        for _ in range(2):
            for q in found:
                column = column - (q @ column) * q
        rest = numpy.sqrt(column @ column)
        if rest > 1e-9 * size:
            found.append(column / rest)
            left = left - (found[-1] @ left) * found[-1]
    return left


def _apart(grid, distance):
    """The best starting points, no more than one for each dead time."""
    chosen = []
    for p in grid:
        if all(abs(p[-1] - other[-1]) > distance / 2 for other in chosen):
            chosen.append(p)
        if len(chosen) == BEST:
            break
    return chosen


def _described(p, regressors, target, units):
    """The parameters and their standard errors in the units given, the standard deviation of the rest, and the fit."""
    import numpy

    lags = len(p) - 1
    T, delay = sorted(numpy.exp(p[:-1]), reverse=True), p[-1] if p[-1] > CLOSE else 0.0
    p = numpy.array([*numpy.log(T), delay])
    columns = regressors(p)
    linear = numpy.linalg.lstsq(columns, target, rcond=None)[0]
    fitted = columns @ linear
    # how the response depends on each parameter
    changes = []
    for k, value in enumerate([*T, delay]):
        width = 1e-5 * (value if k < lags else max(value, T[0] if lags else 1.0))
        ahead, behind = p.copy(), p.copy()
        if k < lags:
            ahead[k], behind[k] = math.log(value + width), math.log(value - width)
        else:
            ahead[k], behind[k] = value + width, max(value - width, 0.0)
        width = ahead[k] - behind[k] if k == lags else 2 * width
        changes.append((regressors(ahead) - regressors(behind)) @ linear / width)
    jacobian = numpy.column_stack([columns[:, :1], *changes, columns[:, 1:]])
    variance = ((target - fitted) ** 2).sum() / max(len(target) - jacobian.shape[1], 1)
    # two equal lags act alike: their difference, which only the second order shows, is left out
    sizes = numpy.linalg.norm(jacobian, axis=0)
    inverse = numpy.linalg.pinv(jacobian / numpy.where(sizes, sizes, 1), rcond=1e-4)
    errors = numpy.sqrt(variance * (inverse**2).sum(axis=1))[: lags + 2] / sizes[: lags + 2]
    return units * [linear[0], *T, delay], units * errors, math.sqrt(variance), fitted
