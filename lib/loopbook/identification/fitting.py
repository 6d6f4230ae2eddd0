"""A simple model fitted to logged data of control signal and measurement, by least squares."""

import itertools
import math
from dataclasses import dataclass

import sympy

from loopbook.approximation import Model
from loopbook.expressions import exact
from loopbook.identification.held import KINDS, responses
from loopbook.identification.records import record, sampling_step

STARTS = ("rest", "unknown")
DELAYS, LAGS = 16, 7  # how many of each are tried at first
BEST = 4  # of these, from which the search begins
DIGITS = 10  # of the model's numbers


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
    points, because the sum of squares over the dead time may have several minima.

    Arguments:
        times: moments of the samples, evenly spaced.
        u, y: control signal and measurement at these moments; u is held until the next one.
        kind: "first order", "second order" (two real lags), "integrator" or "integrator with lag".
        start: "rest", if the process was at rest with the first control signal before the record; or "unknown", and
            then the state at the beginning is estimated, too.
        level: the measurement at rest with the first control signal, if it is known; otherwise it is estimated.
        longest_delay: up to which a dead time is looked for; half of the record if not given.
    Returns:
        A `Fit`.
    Raises:
        ValueError: for arrays that do not fit, uneven samples, another kind or start, or a control signal that does
            not move.

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
    if kind not in KINDS:
        raise ValueError(f"the kind is {kind!r}: expected {', '.join(map(repr, KINDS))}")
    if start not in STARTS:
        raise ValueError(f"the start is {start!r}: expected 'rest' or 'unknown'")
    if not (u != u[0]).any():
        raise ValueError(f"the control signal is {u[0]:g} all the time: expected an experiment that moves it")
    longest_delay = span / 2 if longest_delay is None else float(longest_delay)
    if not 0 < longest_delay <= span:
        raise ValueError(f"the longest dead time is {longest_delay:g}: expected a time up to that of the record")
    lags, _ = KINDS[kind]
    moved = u - u[0]
    target = y - (0 if level is None else float(level))

    def regressors(p):
        forced, free = responses(kind, numpy.exp(p[:-1]), p[-1], step, moved)
        if start == "rest":
            free = numpy.ones((len(u), 0 if level is not None else 1))
        elif level is not None:
            free = free[:, :-1]
        return numpy.column_stack([forced, free])

    def left(p):
        return _without(regressors(p), target)

    shortest = step / 20
    low = numpy.array([math.log(shortest)] * lags + [0.0])
    high = numpy.array([math.log(100 * span)] * lags + [longest_delay])
    tried = numpy.log(numpy.geomspace(step / 2, 2 * span, LAGS))
    sets = itertools.combinations_with_replacement(tried[::-1], lags)
    grid = [[*T, delay] for T in sets for delay in numpy.linspace(0, longest_delay, DELAYS, endpoint=False)]
    grid.sort(key=lambda p: (left(p) ** 2).sum())
    tolerances = {"xtol": 1e-12, "ftol": 1e-12, "gtol": 1e-12, "x_scale": "jac"}
    searched = [
        least_squares(left, numpy.clip(p, low + 1e-9, high - 1e-9), bounds=(low, high), **tolerances)
        for p in _apart(grid, longest_delay / DELAYS)
    ]
    best = min(searched, key=lambda found: found.cost)
    return _described(best.x, regressors, target, times, y, kind)


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


def _described(p, regressors, target, times, y, kind):
    import numpy

    lags, integrators = KINDS[kind]
    T = sorted(numpy.exp(p[:-1]), reverse=True)
    p = numpy.array([*numpy.log(T), p[-1]])
    columns = regressors(p)
    linear = numpy.linalg.lstsq(columns, target, rcond=None)[0]
    fitted = columns @ linear
    # how the response depends on each parameter, in its own unit
    changes = []
    for k, value in enumerate([*T, p[-1]]):
        width = 1e-5 * (value if k < lags else max(value, T[0] if lags else times[1] - times[0]))
        ahead, behind = p.copy(), p.copy()
        if k < lags:
            ahead[k], behind[k] = math.log(value + width), math.log(value - width)
        else:
            ahead[k], behind[k] = value + width, max(value - width, 0.0)
        width = ahead[k] - behind[k] if k == lags else 2 * width
        changes.append((regressors(ahead) - regressors(behind)) @ linear / width)
    jacobian = numpy.column_stack([columns[:, :1], *changes, columns[:, 1:]])
    left = target - fitted
    variance = (left**2).sum() / max(len(target) - jacobian.shape[1], 1)
    errors = numpy.sqrt(variance * numpy.diag(numpy.linalg.pinv(jacobian.T @ jacobian)).clip(0))
    names = ["K", *(f"T{n + 1}" for n in range(lags)), "delay"]
    values = [float(linear[0]), *map(float, T), float(p[-1])]
    named = dict(zip(names, values, strict=True))
    rounded = {name: exact(float(f"{value:.{DIGITS}g}")) for name, value in named.items()}
    if integrators:
        rounded = {"T2": rounded.pop("T1", sympy.S.Zero), "T1": sympy.oo} | rounded
        named = {("T2" if name == "T1" else name): value for name, value in named.items()}
    errors = dict(zip(named, map(float, errors), strict=False))
    return Fit(Model(**rounded), kind, named, errors, math.sqrt(variance), times, y, fitted + (y - target))
