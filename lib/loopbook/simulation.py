"""Simulation: a continuous plant, a controller that runs once a sample, and signals in time.

Between two samples the control signal is held, and the plant's state is integrated from one discontinuity to the next
by the Dormand-Prince method of order 5 (SciPy) to a relative tolerance of 1e-9. Dead time is a delayed signal, exact
on any grid: the moments at which a held signal arrives late are among the discontinuities.
"""

import bisect
import copy
import math
import warnings
from dataclasses import dataclass

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import exact, t
from loopbook.laplace import between_steps, evaluate
from loopbook.plants import name_of
from loopbook.signals import noise as noise_of

__all__ = ["Run", "simulate"]

CLOSE = 1e-9  # two moments that are so close together, for rounding, are one
INFINITE = (-sympy.oo, sympy.oo)
TOLERANCE = {"rtol": 1e-9, "atol": 1e-12, "nsteps": 100_000}


@dataclass(frozen=True, repr=False)
class Run:
    """What `simulate` returns: named signals at the sampling times.

    Attributes:
        times: the moments, an array.
        signals: ``{name: array}``, one value for each moment.
        plant: the plant, which knows the units.
    """

    times: object
    signals: dict
    plant: object
    _past: object = None  # what a later run needs in order to go on

    def __getitem__(self, name):
        if name not in self.signals:
            raise ValueError(f"the run has no signal {name!r}: it has {', '.join(self.signals)}")
        return self.signals[name]

    def __repr__(self):
        return (
            f"<run of {len(self.times)} samples, t = {self.times[0]:g} to {self.times[-1]:g}: "
            f"{', '.join(self.signals)}>"
        )


def simulate(
    plant, controller=None, *, until, step=None, setpoint=None, noise=0, seed=1, feedforward=0, manual=(), after=None,
    **inputs,
):  # fmt: skip
    """Simulate a plant, alone or under control.

    A signal in time is a number, an expression in `t` (steps as `signals.stepwise` writes them), or an array with a
    value for each sample, which is held until the next one.

    Arguments:
        plant: a `plants.Plant`. Before the start it has been at rest at its operating point.
        controller: a `pid.Controller`, or any object with a `step` and a method `update` like its own. The object
            itself is not changed.
        until: end of the run, a whole number of steps after its beginning at 0 (or at the end of `after`).
        step: time between two samples, in the plant's unit of time; with a controller, the controller's own.
        setpoint: a signal, needed with a controller.
        noise: standard deviation of normally distributed measurement noise, or an array to be added.
        seed: names the sequence of random numbers.
        feedforward: a signal that is added to the control signal.
        manual: ``[(beginning, end, u)]``, the stretches of time in manual mode; u is None for the last control signal.
        after: an earlier run that this one continues, with its state, its past and its controller's memory; the plant
            and the settings may be others. The result contains the earlier run.
        inputs: signals for the plant's inputs, by name; an input not named keeps its value at the operating point.
    Returns:
        A `Run` with the plant's states, inputs and outputs by their names, and with a controller "setpoint",
        "measurement" (with noise), "ramped" and "filtered" (what the controller makes of the two), and the terms
            "u_p", "u_i" and "u_d".
    Raises:
        ValueError: for an unknown or a missing signal, one of the wrong length or with a value that is no finite
            number, a step longer than a dead time, an end that is no whole number of steps away, or a run that grows
            beyond all numbers.

    >>> from loopbook.plants import RCCircuit
    >>> run = simulate(RCCircuit(), until=2, step=1, v_in=5)
    >>> run["v_out"].round(6)
    array([0.      , 3.160603, 4.323324])
    """
    begin = 0.0 if after is None else float(after.times[-1])
    past = None if after is None else after._past
    names = [str(x.func) for x in plant.inputs]
    driven = str(plant.manipulated.func)
    for name in inputs:
        if name not in names:
            raise ValueError(f"{type(plant).__name__} has no input {name!r}: it has {', '.join(names)}")
    if controller is None:
        if setpoint is not None or manual or not _is_zero(feedforward):
            raise ValueError("a setpoint, a manual mode or a feedforward was given, but no controller")
        if step is None:
            raise ValueError("the step is missing: expected the time between two samples")
    else:
        if setpoint is None:
            raise ValueError("the setpoint is missing: expected a signal for the controller to follow")
        if driven in inputs:
            raise ValueError(f"{driven} is given, but it is the controller that sets it")
        if step is not None and step != controller.step:
            raise ValueError(f"the step is {step}, but the controller runs every {controller.step:g}")
        step = controller.step
    times = _grid(begin, until, step)

    if past is not None and not set(past.sources) >= set(names):
        raise ValueError(f"the earlier run has the inputs {', '.join(past.sources)}, this plant has {', '.join(names)}")
    at_rest = {name: plant.values[plant.signal(name)] for name in names}
    sources = {name: _source(name, signal, times) for name, signal in (at_rest | inputs).items()}
    if controller is not None:
        sources[driven] = _Held(times)
    for name, source in sources.items():
        source.past = _Held([-math.inf], [float(at_rest[name])]) if past is None else past.sources[name]
    system = _System(plant, sources, times, past)
    loop = None
    if controller is not None:
        noise = noise_of(times, noise, (seed, round(begin / step))) if _is_number(noise) else noise
        loop = _Loop(
            copy.deepcopy(controller), times, setpoint, noise, feedforward, manual, None if past is None else past.loop
        )
    for time in times:
        system.advance(time)
        if loop:
            u = loop.sample(system.output())
            if not math.isfinite(u):
                raise _beyond_all_numbers(driven, time)
            sources[driven].values.append(u)
    signals = system.signals(times) | (loop.signals() if loop else {})
    return _joined(plant, after, times, signals, _Past(system.trace, sources, loop))


@dataclass(frozen=True)
class _Past:
    """What a later run needs in order to go on."""

    trace: object
    sources: dict
    loop: object


class _Loop:
    """The controller with its signals, one value for each sample."""

    def __init__(self, controller, times, setpoint, noise, feedforward, manual, earlier):
        self.controller, self.times, self.k = controller, times, 0
        given = {"setpoint": setpoint, "noise": noise, "feedforward": feedforward}
        self.setpoint, self.noise, self.feedforward = (_samples(name, x, times) for name, x in given.items())
        self.manual = _by_hand(manual, times)
        self.record = {}
        if earlier is not None:
            self.controller.take_over(earlier.before_last)

    def sample(self, output):
        """Run the controller once, and return the control signal."""
        k, self.k = self.k, self.k + 1
        if self.k == len(self.times):  # a run that goes on from here begins with this sample, maybe with other settings
            self.before_last = copy.deepcopy(self.controller)
        measurement = output + self.noise[k]
        u = self.controller.update(
            self.setpoint[k], measurement, feedforward=self.feedforward[k], manual=self.manual[k]
        )
        now = {"setpoint": self.setpoint[k], "measurement": measurement}
        if hasattr(self.controller, "terms"):
            now["ramped"], now["filtered"] = self.controller.setpoint, self.controller.filtered
            now["u_p"], now["u_i"], now["u_d"] = self.controller.terms
        for name, value in now.items():
            self.record.setdefault(name, []).append(value)
        return u

    def signals(self):
        return self.record


class _System:
    """The plant's equations as programs, and the trace of its state from discontinuity to discontinuity."""

    def __init__(self, plant, sources, times, past):
        from scipy.integrate import ode

        self.plant, self.sources, self.rows = plant, sources, []
        equations = plant.state_equations()
        self.states = list(equations)
        self.names = [name_of(x) for x in self.states]
        self.rates, self.driving = self._compiled(equations.values())
        self.measure, self.measuring = self._compiled(plant.measured.values())
        self._refuse_delays(times[1] - times[0])

        self.limits = [tuple(float(plant.numbers(x)) for x in plant.limits.get(x, INFINITE)) for x in self.states]
        if past is None:
            at_rest = [0.0 if x.is_Derivative else float(plant.values[x]) for x in self.states]
            self.trace = _Trace(self.names, [-math.inf, times[0]], [at_rest, at_rest])
        elif past.trace.names != self.names:
            raise ValueError(f"the earlier run has the states {past.trace.names}, this plant has {self.names}")
        else:
            self.trace = _Trace(self.names, list(past.trace.times), list(past.trace.states))
        self.ahead = iter(self._discontinuities(times))
        self.solver = ode(self._rate_of_change).set_integrator("dopri5", first_step=times[1] - times[0], **TOLERANCE)

    def _compiled(self, formulas):
        """A program for the formulas, and the signals besides the undelayed states that it needs: (name, delay)."""
        formulas = [self.plant.numbers(formula) for formula in formulas]
        letters = {x: sympy.Dummy() for x in self.states}
        formulas = [formula.xreplace(letters) for formula in formulas]
        found = sorted({x for formula in formulas for x in formula.atoms(AppliedUndef)}, key=str)
        others = {x: sympy.Dummy() for x in found}
        program = sympy.lambdify([*letters.values(), *others.values()], [f.xreplace(others) for f in formulas], "math")
        return program, [(str(x.func), float(t - x.args[0])) for x in found]

    def _refuse_delays(self, step):
        for name, delay in self.driving + self.measuring:
            if delay < 0:
                raise ValueError(f"{name} acts {-delay:g} before its time: expected a dead time that is not negative")
            if 0 < delay < step * (1 - CLOSE):
                raise ValueError(f"the step {step:g} is longer than the dead time {delay:g}: expected a shorter step")
        if any(name in self.names for name, _ in self.driving):
            raise ValueError(
                f"{type(self.plant).__name__} has a dead time inside: expected one at an input or an output"
            )
        if any(name == name_of(self.plant.manipulated) and not delay for name, delay in self.measuring):
            raise ValueError(f"{self.plant.manipulated} acts on the output at once: expected a lag between the two")

    def _discontinuities(self, times):
        """The moments to stop at: the samples, and where a signal, maybe delayed, jumps between two of them."""
        import numpy

        begin, step = times[0], times[1] - times[0]
        late = [numpy.array(self.sources[name].jumps()) + delay for name, delay in self.driving]
        early = [times - delay for name, delay in self.measuring if name in self.names]
        moments = numpy.concatenate([*late, *early, []])
        moments = numpy.unique(moments[(moments > begin) & (moments < times[-1])])
        between = abs(moments - begin - step * numpy.round((moments - begin) / step)) > CLOSE * step
        return numpy.sort(numpy.concatenate([times[1:], moments[between]])).tolist()

    def advance(self, time):
        """Integrate up to the sample at `time`, and measure there."""
        while self.trace.times[-1] < time:
            self._integrate(self.trace.times[-1], next(self.ahead))
        needed = [self._at(name, time - delay) for name, delay in self.measuring]
        self.rows.append(self.measure(*self.trace.states[-1], *needed))

    def _integrate(self, start, end):
        middle = (start + end) / 2
        self.now = [(self.sources[name].between(middle - delay), delay) for name, delay in self.driving]
        self.held = [value for value, _ in self.now if isinstance(value, float)]
        state = self.trace.states[-1]
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)
                state = self.solver.set_initial_value(state, start).integrate(end).tolist()
        except OverflowError:
            state = [math.inf]
        if not (self.solver.successful() and all(map(math.isfinite, state))):
            raise _beyond_all_numbers(", ".join(self.names), end)
        # With held inputs a single state moves one way only, so that cutting it off here is exact.
        state = [min(max(x, low), high) for x, (low, high) in zip(state, self.limits, strict=True)]
        self.trace.times.append(end)
        self.trace.states.append(state)

    def _rate_of_change(self, time, state):
        if len(self.held) == len(self.now):
            return self.rates(*state.tolist(), *self.held)
        values = [x if isinstance(x, float) else x(time - delay) for x, delay in self.now]
        return self.rates(*state.tolist(), *values)

    def _at(self, name, time):
        return self.trace.at(name, time) if name in self.names else self.sources[name].at(time)

    def output(self):
        """The plant's output at the last sample."""
        name = name_of(self.plant.output)
        if name in self.names:
            return self.trace.states[-1][self.names.index(name)]
        return self.rows[-1][list(self.plant.measured).index(self.plant.output)]

    def signals(self, times):
        found = {name: [self.trace.at(name, time) for time in times] for name in self.names}
        found |= {name_of(x): [row[n] for row in self.rows] for n, x in enumerate(self.plant.measured)}
        return found | {name: [source.at(time) for time in times] for name, source in self.sources.items()}


@dataclass(frozen=True)
class _Trace:
    """The states at the moments at which the integration stopped; the first moment stands for all time before."""

    names: list
    times: list
    states: list

    def at(self, name, time):
        return self.states[_last_not_after(time, self.times)][self.names.index(name)]


class _Held:
    """A signal that is constant between its moments; before the first one it is what its past says."""

    past = None

    def __init__(self, times, values=None):
        self.times, self.values = list(times), [] if values is None else values

    def at(self, time):
        n = _last_not_after(time, self.times)
        return self.past.at(time) if n < 0 else self.values[min(n, len(self.values) - 1)]

    between = at

    def jumps(self):
        return (self.past.jumps() if self.past else []) + self.times


class _Formula:
    """A signal that an expression gives, stretch by stretch between its steps."""

    past = None

    def __init__(self, expression, begin):
        stretches = [(max(start, begin), f) for start, end, f in between_steps(expression) if end > begin]
        self.times = [start for start, _ in stretches]
        self.stretches = [sympy.lambdify(t, f, "math") for _, f in stretches]

    def at(self, time):
        n = _last_not_after(time, self.times)
        return self.past.at(time) if n < 0 else float(self.stretches[n](time))

    def between(self, time):
        n = _last_not_after(time, self.times)
        return self.past.between(time) if n < 0 else self.stretches[n]

    jumps = _Held.jumps


def _last_not_after(time, times):
    """The index of the last of the increasing times that is not after `time`, but for rounding; -1 if there is none."""
    return bisect.bisect_right(times, time + CLOSE * max(1.0, abs(time))) - 1


# ------------------------------------------------------------------------------------------------ what is given


def _grid(begin, until, step):
    import numpy

    for name, value in (("step", step), ("end", until)):
        if not _is_number(value) or not math.isfinite(value):
            raise ValueError(f"the {name} is {value!r}: expected a number")
    if step <= 0:
        raise ValueError(f"the step is {step}: expected a positive time")
    count = (float(until) - begin) / float(step)
    if count < 0.5 or abs(count - round(count)) > 1e-6:
        raise ValueError(f"the end {until} is not a whole number of steps of {step} after {begin:g}")
    return begin + float(step) * numpy.arange(round(count) + 1)


def _is_number(value):
    try:
        return not isinstance(value, (bool, str)) and math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


def _is_zero(value):
    return _is_number(value) and value == 0


def _source(name, signal, times):
    """A signal in time as an input of the plant."""
    if isinstance(signal, sympy.Expr) and signal.has(t):
        evaluate(signal, times[:1])  # says what is wrong with it
        if all(f.is_number for *_, f in between_steps(exact(signal))):
            stretches = [(max(a, times[0]), float(f)) for a, b, f in between_steps(exact(signal)) if b > times[0]]
            return _Held([start for start, _ in stretches], [value for _, value in stretches])
        return _Formula(exact(signal), times[0])
    if _is_number(signal):
        return _Held(times[:1], [float(signal)])
    return _Held(times, _samples(name, signal, times))


def _samples(name, signal, times):
    """A signal in time as a list with one value for each sample."""
    import numpy

    if isinstance(signal, (sympy.Expr, str)) or _is_number(signal):
        try:
            values = evaluate(exact(signal), times)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    else:
        try:
            values = numpy.asarray(list(signal), dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{name} is {signal!r}: expected a number, an expression in t or an array") from None
    if values.shape != times.shape:
        raise ValueError(f"{name} has {values.size} values for {times.size} samples")
    if not numpy.isfinite(values).all():
        when = times[~numpy.isfinite(values)][0]
        raise ValueError(f"{name} is {values[~numpy.isfinite(values)][0]} at t = {when:g}: expected finite numbers")
    return values.tolist()


def _by_hand(manual, times):
    """For each sample None in automatic mode, else the operator's control signal, NaN for the last one."""
    found = [None] * len(times)
    for stretch in manual:
        try:
            begin, end, u = stretch
            u = math.nan if u is None else float(u)
        except (TypeError, ValueError):
            raise ValueError(f"manual has {stretch!r}: expected (beginning, end, control signal)") from None
        for k, time in enumerate(times):
            if begin <= time < end:
                found[k] = u
    return found


def _beyond_all_numbers(names, time):
    return ValueError(
        f"{names} grows beyond all numbers before t = {time:g}: the system is unstable, end the run earlier"
    )


def _joined(plant, after, times, signals, past):
    import numpy

    signals = {name: numpy.array(values) for name, values in signals.items()}
    if after is None:
        return Run(times, signals, plant, past)
    earlier = len(after.times) - 1
    gap = {True: numpy.full(earlier, numpy.nan), False: numpy.full(len(times), numpy.nan)}
    names = [*after.signals, *(name for name in signals if name not in after.signals)]
    both = {
        name: numpy.concatenate(
            [after.signals[name][:-1] if name in after.signals else gap[True], signals.get(name, gap[False])]
        )
        for name in names
    }
    return Run(numpy.concatenate([after.times[:-1], times]), both, plant, past)
