"""A plant in time: its equations compiled, and its state from one discontinuity to the next."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Collection, Iterable, Mapping

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from loopbook.plants import Plant, name_of
from loopbook.signals import CLOSE, PiecewiseSignal, beyond_all_numbers, last_not_after, too_many_steps
from plainmath.expressions import t

__all__ = ["PlantIntegrator"]

INFINITE = (-sympy.oo, sympy.oo)
TOLERANCE = {"rtol": 1e-9, "atol": 1e-12}
MOST_STEPS = 100_000  # from one discontinuity to the next
TOO_MANY_STEPS = -1  # how SciPy's LSODA says so


class CompiledModel:
    """The equations of a plant as functions of numbers, and what each needs besides the undelayed states."""

    def __init__(self, plant: Plant):
        equations = plant.state_equations()
        self.states, self.names = list(equations), [name_of(x) for x in equations]
        self.rates, self.driving, self._of_rates = self._compiled(plant, equations.values())
        self.measure, self.measuring, _ = self._compiled(plant, plant.measured.values())

    @property
    def delayed_states(self) -> list[tuple[str, float]]:
        """The states that act on the plant some time later: (name, delay)."""
        return [(name, delay) for name, delay in self.driving if name in self.names]

    def matrices(self, constant: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray] | None:
        """A and B of the rates A x + B v, v being what drives them, and 1; None where they are not linear.

        Inputs that are constant are numbers for this purpose: they are part of A, and of B's last column.
        """
        symbols, formulas = self._of_rates
        driving = zip(symbols[len(self.states) :], self.driving, strict=True)
        known = {x: sympy.Float(constant[name]) for x, (name, _) in driving if name in constant}
        try:
            M, rest = sympy.linear_eq_to_matrix([f.xreplace(known) for f in formulas], symbols)
            M = np.array(M.row_join(-rest), dtype=float)
        except (ValueError, TypeError):  # of what is not linear, and of a formula with the time itself
            return None
        return M[:, : len(self.states)], M[:, len(self.states) :]

    def _compiled(self, plant, formulas):
        """A function for the formulas, what it needs besides the states: (name, delay), and symbols and formulas."""
        formulas = [plant.numbers(formula) for formula in formulas]
        if any(formula.has(sympy.zoo, sympy.nan, sympy.oo) for formula in formulas):
            raise ValueError(f"{plant} divides by zero: expected parameters that are not zero")
        symbols = {x: sympy.Dummy() for x in self.states}
        formulas = [formula.xreplace(symbols) for formula in formulas]
        found = sorted({x for formula in formulas for x in formula.atoms(AppliedUndef)}, key=str)
        others = {x: sympy.Dummy() for x in found}
        formulas = [formula.xreplace(others) for formula in formulas]
        symbols = [*symbols.values(), *others.values()]
        # a case of a Piecewise that does not hold is not to be computed beforehand
        cse = not any(formula.has(sympy.Piecewise) for formula in formulas)
        function = sympy.lambdify(symbols, formulas, "math", cse=cse)
        return function, [(name_of(x), float(t - x.args[0])) for x in found], (symbols, formulas)


_COMPILED = weakref.WeakKeyDictionary()  # of the plants in use: a plant never changes, and compiling takes its time


def compiled(plant: Plant) -> CompiledModel:
    """The equations of a plant, compiled once."""
    if plant not in _COMPILED:
        _COMPILED[plant] = CompiledModel(plant)
    return _COMPILED[plant]


class PlantIntegrator:
    """The state of a plant without delayed states, from one discontinuity to the next.

    Arguments:
        plant: the plant.
        sources: its inputs as signals in time, by name.
        times: the moments of the samples.
        driven: the names of those that blocks drive, whose values come sample by sample.
        past: the integrator of an earlier run, which this one continues.
    """

    def __init__(
        self,
        plant: Plant,
        sources: Mapping[str, PiecewiseSignal],
        times: np.ndarray,
        driven: Collection[str],
        past: PlantIntegrator | None,
    ):
        self.plant, self.sources, self.samples, self.driven, self.past = plant, sources, times, driven, past
        self.rows = []  # what is measured at each sample so far
        self.begin, self.step = times[0], times[1] - times[0]
        model = compiled(plant)
        self.rates, self.driving, self.delayed_states = model.rates, model.driving, model.delayed_states
        self.measure, self.measuring = model.measure, model.measuring
        self.states, self.names = model.states, model.names
        if past and past.names != self.names:
            raise ValueError(f"the earlier run has the states {past.names}, this plant has {self.names}")
        self.measured = [name_of(x) for x in plant.measured]
        self._refuse_delays()

        self.at_rest = [0.0 if x.is_Derivative else float(plant.values[x]) for x in self.states]
        self.limits = [tuple(float(plant.numbers(x)) for x in plant.limits.get(x, INFINITE)) for x in self.states]
        self.limited = any(map(math.isfinite, sum(self.limits, ())))
        # the state at each discontinuity so far
        self.times, self.trace = [self.begin], [past.state_at(self.begin) if past else self.at_rest]
        self.ahead = iter(self._discontinuities(times))
        self._prepare()

    def _prepare(self):
        from scipy.integrate import ode

        exact = TOLERANCE | {"nsteps": MOST_STEPS}
        self.method, self.solvers = (
            "dopri5",
            {
                "dopri5": ode(self._rate_of_change).set_integrator("dopri5", first_step=self.step, **exact),
                "lsoda": ode(self._rate_of_change).set_integrator("lsoda", **exact),
            },
        )

    def _refuse_delays(self):
        for name, delay in self.driving + self.measuring:
            if delay < 0:
                raise ValueError(f"{name} acts {-delay:g} before its time: expected a dead time that is not negative")
        for name, delay in self.measuring:
            if name in self.driven and not delay:
                raise ValueError(f"{name} acts on a measured signal at once: expected a lag between the two")

    def _discontinuities(self, times):
        """The moments to stop at: the samples, and where a signal, maybe delayed, jumps between two of them."""
        return self._with_samples(np.concatenate([*self._jumps(), []]), times)[1:].tolist()

    def _jumps(self):
        """For each input that drives the states the moments at which it may jump there, late as it is."""
        inputs = [(name, delay) for name, delay in self.driving if name in self.sources]
        return [np.array(self.sources[name].jumps()) + delay for name, delay in inputs]

    def _with_samples(self, moments, times):
        """The samples and the moments between them, all that are the same but for rounding as one."""
        moments = np.unique(moments[(moments > self.begin) & (moments < times[-1])])
        rounding = CLOSE * self.step + 1e-15 * abs(moments)
        after_sample = (moments - self.begin) - self.step * np.round((moments - self.begin) / self.step)
        moments = moments[(abs(after_sample) > rounding) & (np.diff(moments, prepend=-np.inf) > rounding)]
        return np.sort(np.concatenate([times, moments]))

    def advance(self, time: float) -> None:
        """Integrate up to the sample at `time`, and measure there."""
        while self.times[-1] < time:
            end = next(self.ahead)
            self.trace.append(self._integrated(self.trace[-1], self.times[-1], end))
            self.times.append(end)
        needed = [self._at(name, time - delay) for name, delay in self.measuring]
        self.rows.append(self.measure(*self.trace[-1], *needed))

    def _integrated(self, state, start, end):
        """The state at the end of a stretch of time in which no signal jumps."""
        self._freeze_inputs(start, end)
        # what is too stiff for the explicit method goes to the one that switches to an implicit method by itself
        for method in dict.fromkeys((self.method, "lsoda")):
            solver = self.solvers[method]
            found = solver.set_initial_value(state, start).integrate(end).tolist()
            if self.failure:
                raise self.failure
            if solver.successful() and all(map(math.isfinite, found)):
                self.method = method
                return self._limited(found)
        if solver.get_return_code() == TOO_MANY_STEPS:
            raise too_many_steps(", ".join(self.names), MOST_STEPS, start, end)
        raise beyond_all_numbers(", ".join(self.names), end)

    def _limited(self, state):
        if not self.limited:
            return state
        return [min(max(x, low), high) for x, (low, high) in zip(state, self.limits, strict=True)]

    def _freeze_inputs(self, start, end):
        """Keep what drives the states in a stretch of time in which no signal jumps: numbers and functions of time."""
        middle = (start + end) / 2
        values = [self._around(name, middle - delay) for name, delay in self.driving]
        self.held = None if any(map(callable, values)) else values
        self.inside = [(x, delay) for x, (_, delay) in zip(values, self.driving, strict=True)] if not self.held else ()
        self.failure = None

    def _around(self, name, moment):
        return self.sources[name].around(moment)

    def _rate_of_change(self, time, state):
        state = state.tolist()
        try:
            inputs = self.held or [x(time - delay) if callable(x) else x for x, delay in self.inside]
            rates = self.rates(*state, *inputs)
        except ArithmeticError:  # of a trial step
            return [math.nan] * len(state)
        except ValueError as error:
            self.failure = error
            return [math.nan] * len(state)
        if self.limited:  # a state stays at its limit while its rate points out of the range
            for n, (x, rate, (low, high)) in enumerate(zip(state, rates, self.limits, strict=True)):
                if (x >= high and rate > 0) or (x <= low and rate < 0):
                    rates[n] = 0.0
        return rates

    def state_at(self, time: float) -> list[float]:
        """The state at any moment so far; between two discontinuities it is integrated once more."""
        n = last_not_after(time, self.times, self.step)
        if n < 0:
            return self.past.state_at(time) if self.past else self.at_rest
        if abs(time - self.times[n]) <= CLOSE * self.step + 1e-15 * abs(time):
            return self.trace[n]
        return self._between(n, time)

    def _between(self, n, time):
        return self._integrated(self.trace[n], self.times[n], time)

    def _at(self, name, time):
        if name in self.names:
            return self.state_at(time)[self.names.index(name)]
        return self.sources[name].at(time)

    def reading(self, name: str) -> Callable[[], float]:
        """A function that says what a state or a measured signal was at the last sample."""
        names, rows = (self.measured, self.rows) if name in self.measured else (self.names, self.trace)
        n = names.index(name)
        return lambda: rows[-1][n]

    def readings(self, time: float) -> dict[str, float]:
        """What the plant says at the last sample: states, measured signals and inputs that no block drives, by name."""
        found = {name: source.at(time) for name, source in self.sources.items() if name not in self.driven}
        found.update(zip(self.names, self.trace[-1], strict=True))
        found.update(zip(self.measured, self.rows[-1], strict=True))
        return found

    def signals(self, times: Iterable[float]) -> dict[str, list[float]]:
        """The states, the measured signals and the inputs at the samples."""
        states = [self.state_at(time) for time in times]
        found = {name: [state[n] for state in states] for n, name in enumerate(self.names)}
        found |= {name_of(x): [row[n] for row in self.rows] for n, x in enumerate(self.plant.measured)}
        return found | {name: [source.at(time) for time in times] for name, source in self.sources.items()}
