"""A simple model fitted to logged data of control signal and measurement, by least squares."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import sympy

from loopbook.approximation import SOPDT
from loopbook.identification.records import even_step, record
from loopbook.identification.residuals import CORRELATED, Residuals
from loopbook.identification.search import least_squares
from loopbook.identification.zero_order_hold import HOLDS, KINDS, DrivenChain
from plainmath.expressions import exact
from plainmath.validation import number, one_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from loopbook.figures import TimePlot

STARTS = ("rest", "unknown")
LAGS = 7  # how many of each are tried at first
FEWEST, MOST = 16, 110  # dead times that are tried at first
POINTS = 3_000_000  # samples times sets of lags and dead times, computed for the grid
BEST = 6  # of these, from which the search begins
PATIENCE = 300  # steps of the last search
DIGITS = 10  # of the model's numbers
CLOSE = 1e-5  # a dead time of so few steps is none
CLEAR = 6  # so many standard errors away, a parameter is told well


@dataclass(frozen=True, repr=False)
class Fit:
    """A model that fits logged data: what `fit` returns.

    Attributes:
        model: the `SOPDT`.
        kind, hold: as given to `fit`.
        parameters: K, T1 or T1 and T2, and delay, floats by name.
        errors: the standard error of each of them, if what is left of the data is noise, and if the response is
            nearly linear in them over some standard errors. It is not where two lags may be equal, or one be too short
            to be seen, or noise is large; then they are rough. `inf` is what cannot be said.
        residual: standard deviation of what is left, in the unit of the measurement.
        whiteness: the p-value of the test of Ljung and Box on what is left. Below 0.01 it is not white noise. Then the
            errors are those for noise of first order, AR(1), with the correlation of what is left. An unmeasured load,
            a coarse converter or a wrong kind of model is no such noise: it shifts the parameters, and they may be
            wrong by far more than their errors. Look at `plot`.
        times, u, y, fitted: the record, and what the model makes of the control signal; arrays.
    """

    model: SOPDT
    kind: str
    parameters: dict[str, float]
    errors: dict[str, float]
    residual: float
    whiteness: float
    times: np.ndarray
    u: np.ndarray
    y: np.ndarray
    fitted: np.ndarray
    hold: str

    @property
    def expr(self) -> sympy.Expr:
        """The transfer function of the model."""
        return self.model.expr

    def __repr__(self) -> str:
        values = [f"{name} = {value:.4g} ± {self.errors[name]:.1g}" for name, value in self.parameters.items()]
        shown = f"residual {self.residual:.3g}"
        if self.whiteness < CORRELATED:
            shown += (
                f", correlated (Ljung-Box p = {self.whiteness:.1g}): ± holds for noise of first order, "
                "not where something unmeasured acts"
            )
        rough = "" if self._is_regular() else ", the errors are rough"
        return f"<fit, {self.kind} with dead time: {', '.join(values)}; {shown}{rough}>"

    def plot(self, title: str | None = None, unit: str = "s", of_y: str = "", of_u: str = "") -> TimePlot:
        """Plot the record and the model, the residuals, and the control signal, one below the other.

        Arguments:
            title: written above the plot.
            unit, of_y, of_u: units of time, measurement and control signal, as the axes name them.

        >>> import numpy as np
        >>> times, u = np.arange(60.0), np.repeat([0, 1], [5, 55])
        >>> noise = np.random.default_rng(1).normal(0, 0.02, 60)
        >>> y = 2 * (1 - np.exp(-np.maximum(times - 7.5, 0) / 10)) + noise
        >>> fit(times, u, y).plot("A tank", of_y="°C", of_u="%")
        <A tank: measurement, model; residual; u against t [s]>
        """
        from loopbook.figures import time_plot
        from loopbook.figures.style import ZERO

        panels = [
            {"measurement": (self.y, "raw"), "model": (self.fitted, "measurement")},
            {"residual": (self.y - self.fitted, "raw")},
            {"$u$": (self.u, "control signal")},
        ]
        names = [f"{name} [{of}]" if of else name for name, of in zip(("$y$", "residual", "$u$"), (of_y, of_y, of_u))]  # noqa: B905
        plot = time_plot(panels, self.times, title=title, xlabel=f"$t$ [{unit}]", ylabel=names)
        plot.figure.axes[1].axhline(0, **ZERO)
        if self.hold == "zero order":
            plot.lines["$u$"].set_drawstyle("steps-post")
        return plot

    def _is_regular(self):
        """Whether all parameters are so many standard errors from where they are not regular that these say enough."""
        far = [abs(value) > CLEAR * self.errors[name] for name, value in self.parameters.items() if name != "delay"]
        delay, lags = self.parameters["delay"], [name for name in self.parameters if name.startswith("T")]
        apart = len(lags) < 2 or self.parameters["T1"] - self.parameters["T2"] > CLEAR * self.errors["T2"]
        return all(far) and apart and delay >= 3 * self.errors["delay"]


def fit(
    times: ArrayLike,
    u: ArrayLike,
    y: ArrayLike,
    kind: str = "first order",
    *,
    hold: str = "zero order",
    start: str = "rest",
    level: float | None = None,
    longest_delay: float | None = None,
) -> Fit:
    """Fit a simple model with dead time to logged data, so that the sum of squared output errors is least.

    The output error is the measurement minus what the model makes of the control signal alone; this response is exact,
    and the samples need not come evenly. For given lags and dead time the rest of the problem is linear. Lags and dead
    time are searched by the method of Levenberg and Marquardt, from the best of a grid of starting points, because the
    sum of squares over the dead time may have several minima. A lag that is shorter than a twentieth of the mean time
    between two samples is not looked for.

    Arguments:
        times: moments of the samples, increasing.
        u, y: control signal and measurement at these moments.
        kind: "first order", "second order" (two real lags), "integrator" or "integrator with lag".
        hold: what the control signal does between samples: "zero order", if it is held until the next one, as by a
            computer; or "first order", if its values are joined by straight lines.
        start: "rest", if the process was at rest with the first control signal before the record; or "unknown", and
            then the state at the beginning is estimated, too. Before the record, u had its first value for as long as
            the dead time.
        level: the measurement at rest with the first control signal, if it is known; otherwise it is estimated.
        longest_delay: up to which a dead time is looked for; half of the record if not given.
    Returns:
        A `Fit`.
    Raises:
        ValueError: for arrays that do not fit, times that do not increase, another kind, hold or start, a signal that
            does not move, or a dead time as long as the longest one.

    >>> import numpy as np
    >>> times = np.arange(60.0)
    >>> u = np.where(times < 5, 0, 1)
    >>> y = 2 * (1 - np.exp(-np.maximum(times - 7.5, 0) / 10))
    >>> fit(times, u, y).model
    SOPDT(K=2, T1=10, delay=5/2)
    """
    times, u, y = record(times, u=u, y=y)
    one_of("the kind", kind, KINDS)
    one_of("the hold", hold, HOLDS)
    one_of("the start", start, STARTS)
    span = times[-1] - times[0]
    step = span / (len(times) - 1)
    if not (u[:-1] != u[0]).any():
        raise ValueError(f"the control signal is {u[0]:g} all the time: expected an experiment that moves it")
    if not (y != y[0]).any():
        raise ValueError(f"the measurement is {y[0]:g} all the time: expected an experiment that moves it")
    longest_delay = span / 2 if longest_delay is None else longest_delay
    number(
        "the longest dead time", longest_delay, f"a time up to that of the record, {span:g}", lambda x: 0 < x <= span
    )
    _, integrators = KINDS[kind]
    # neither the search nor the standard errors may depend on units: time counts in steps, signals in their own spans
    unit_u, unit_y = abs(u - u[0]).max(), np.ptp(y)
    rest = y[0] if level is None else number("the level", level)
    even = even_step(times) is not None
    chain = DrivenChain(
        kind, np.arange(len(times)) * 1.0 if even else (times - times[0]) / step, (u - u[0]) / unit_u, hold,
        1.0 if even else None,
    )  # fmt: skip
    units = {"K": unit_y / unit_u / step**integrators, "T1": step, "T2": step, "delay": step}
    longest = float(longest_delay) / step
    residuals = Residuals(chain, (y - rest) / unit_y, start, level is not None, longest)
    p = _search(residuals)
    if p[-1] > longest * (1 - 1e-6):
        raise ValueError(f"the dead time would be {longest_delay:g} or longer: expected a larger longest_delay")
    if p[-1] < CLOSE:
        p[-1] = 0.0
    found, errors, residual, fitted, white = residuals.described(p)
    parameters = {name: float(units[name] * value) for name, value in found.items()}
    errors = {name: float(units[name] * value) for name, value in errors.items()}
    rounded = {name: exact(float(f"{value:.{DIGITS}g}")) for name, value in parameters.items()}
    model = SOPDT(**({"T1": sympy.oo} if integrators else {}), **rounded)
    fitted = rest + unit_y * fitted
    return Fit(model, kind, parameters, errors, float(residual * unit_y), white, times, u, y, fitted, hold)


def _search(residuals):
    """The lags and the dead time, as `Residuals` counts them, with the least sum of squares."""
    low, high = residuals.low, residuals.high
    count, longest = len(residuals.target), high[-1]
    tried = np.geomspace(0.5, 2 * count, LAGS)
    sets = list(itertools.combinations_with_replacement(tried[::-1], residuals.chain.lags))
    many = min(MOST, math.ceil(longest), POINTS // (count * len(sets)))
    delays = np.linspace(0, longest, max(FEWEST, many), endpoint=False)
    sums = [(residuals.of(np.reshape(T, (-1, 1)), delays) ** 2).sum(axis=0) for T in sets]
    order = np.argsort(np.ravel(sums), kind="stable")
    chosen = []  # no more than one for each dead time
    for k in order:
        T, delay = sets[k // len(delays)], delays[k % len(delays)]
        if all(abs(delay - other[-1]) > longest / FEWEST / 2 for other in chosen):
            chosen.append([*residuals.counted(T), delay])
        if len(chosen) == BEST:
            break
    start = np.array(chosen).T
    wide = np.ones_like(start)
    found, sums = least_squares(residuals.at, start, low[:, None] * wide, high[:, None] * wide)
    best = found[:, sums.argmin()]
    # where a dead time is a number of samples, the sum of squares has a kink: the pieces beside it, each for itself
    floor = math.floor(best[-1])
    floors = np.array([x for x in (floor - 1, floor, floor + 1) if 0 <= x < longest], dtype=float)
    lows, highs = (np.repeat(x[:, None], len(floors), axis=1) for x in (low, high))
    lows[-1], highs[-1] = floors, np.minimum(floors + 1, longest)
    found, pieces = least_squares(
        residuals.at, np.repeat(best[:, None], len(floors), axis=1), lows, highs, rounds=PATIENCE
    )
    return found[:, pieces.argmin()] if pieces.min() <= sums.min() else best
