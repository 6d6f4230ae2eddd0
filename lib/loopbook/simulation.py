"""Simulation: a continuous plant, a controller that runs once a sample, and signals in time.

Between two samples the control signal is held, and the plant's state is integrated from one discontinuity to the next
by the Dormand-Prince method of order 5 (SciPy) to a relative tolerance of 1e-9. Dead time is a delayed signal, exact
on any grid: the moments at which a held signal arrives late are among the discontinuities.
"""

from __future__ import annotations

import copy
import inspect
import math
import warnings
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import t
from loopbook.plants import Plant, name_of
from loopbook.signals import CLOSE, Stretches, by_hand, in_time, is_number, last_not_after, noise, samples
from loopbook.structures import Structure
from loopbook.types import Block, ManualStretches, Number, SampledController, Signal

if TYPE_CHECKING:
    import numpy

__all__ = ["Run", "simulate"]

INFINITE = (-sympy.oo, sympy.oo)
MOST_SAMPLES = 10_000_000
TOLERANCE = {"rtol": 1e-9, "atol": 1e-12, "nsteps": 100_000}


@dataclass(frozen=True, repr=False)
class Run:
    """What `simulate` returns: named signals at the sampling times.

    Attributes:
        times: the moments, an array.
        signals: ``{name: array}``, one value for each moment.
        plant: the plant, which knows the units.
        manipulated: the name of the input that the controller acts on.
        held: the names of the signals that are constant from one sample to the next.
        measured: the name of the controlled signal, the plant's output if not said.
    """

    times: numpy.ndarray
    signals: dict[str, numpy.ndarray]
    plant: Plant
    manipulated: str
    held: set[str]
    measured: str | None = None
    _past: _Past | None = None  # what a later run needs in order to go on

    @property
    def output(self) -> str:
        """The name of the controlled signal."""
        return self.measured or name_of(self.plant.output)

    def unit(self, name: str) -> str:
        """The unit of a signal of the plant, or of a setpoint, as that of the measurement; "1" for a number."""
        structure, of_plant = self._past.loop if self._past else None, {name_of(x) for x in self.plant.quantities}
        if isinstance(structure, Structure):
            found = structure.measurement_of
            while name in found and name not in of_plant:
                name = found[name]
            if name not in of_plant:
                return "%" if name in structure.split else "1"
        return self.plant.quantities[self.plant.signal(name)].unit or "1"

    def loop(self, tag: str) -> Run:
        """Return the run as one loop of a control structure sees it, for `figures.trends` and the like.

        Raises ValueError for a tag that no loop has.
        """
        loops = getattr(self._past.loop, "loops", {}) if self._past else {}
        if tag not in loops:
            raise ValueError(f"the run has no loop {tag!r}: it has {', '.join(loops) or 'no list of blocks'}")
        own = {name.removeprefix(f"{tag}."): x for name, x in self.signals.items() if name.startswith(f"{tag}.")}
        measured, output = loops[tag].measurement, loops[tag].output
        return replace(self, signals=self.signals | own, manipulated=output, measured=measured)

    def __getitem__(self, name: str) -> numpy.ndarray:
        if name not in self.signals:
            raise ValueError(f"the run has no signal {name!r}: it has {', '.join(self.signals)}")
        return self.signals[name]

    def __repr__(self) -> str:
        return (
            f"<run of {len(self.times)} samples, t = {self.times[0]:g} to {self.times[-1]:g}: "
            f"{', '.join(self.signals)}>"
        )


def simulate(
    plant: Plant,
    controller: SampledController | Sequence[Block] | None = None,
    *,
    until: Number,
    step: Number | None = None,
    setpoint: Signal | None = None,
    noise: Signal | Mapping[str, Signal] = 0,
    seed: int = 1,
    feedforward: Signal = 0,
    scheduling: Signal | None = None,
    manual: ManualStretches | Mapping[str, ManualStretches] = (),
    after: Run | None = None,
    manipulated: str | sympy.Expr | None = None,
    **inputs: Signal,
) -> Run:
    """Simulate a plant, alone or under control.

    A signal in time is a number, an expression in `t` (steps as `signals.stepwise` writes them), or an array with a
    value for each sample, which is held until the next one. It must not change much faster than the samples come:
    a pulse far shorter than a step would be stepped over.

    Arguments:
        plant: a `plants.Plant`. Before the start it has been at rest at its operating point.
        controller: a `pid.Controller`, or any object with a `step` and a method `update` like its own. The object
            itself is not changed. For several of them on one plant, a list of the blocks of `structures`: loops,
            calculations, split ranges, and a `sequence.Chart`.
        until: end of the run, a whole number of steps after its beginning at 0 (or at the end of `after`).
        step: time between two samples, in the plant's unit of time; with a controller, the controller's own.
        setpoint: a signal, needed with a single controller.
        noise: standard deviation of normally distributed measurement noise, or an array to be added; for a list of
            blocks ``{measured signal: one of the two}``.
        seed: names the sequence of random numbers.
        feedforward: a signal that is added to the control signal.
        scheduling: a signal for a controller with a gain schedule, such as `identification.ScheduledController`.
        manual: ``[(beginning, end, u)]``, the stretches of time in manual mode; u is None for the last control signal.
            For a list of blocks ``{tag: such a list}``.
        after: an earlier run that this one continues, with its state, its past and its controller's memory; the plant
            and the settings may be others. If it was without control, the controller begins as after manual mode. The
            result contains the earlier run.
        manipulated: the input that the controller acts on, if it is not the plant's own, as the outflow of a tank.
        inputs: signals for the plant's inputs, by name; an input not named keeps its value at the operating point. For
            a list of blocks also the setpoints and other signals that the blocks read and nobody else writes.
    Returns:
        A `Run` with the plant's states, inputs and outputs by their names, and with a controller "setpoint",
        "measurement" (with noise), "ramped" and "filtered" (what the controller makes of the two), and the terms
        "u_p", "u_i" and "u_d"; with a signal for scheduling that, and of a controller whose settings change its
        "Kp" and "Ti". Of a list of blocks all signals that they write, and of each loop such terms as "LC1.u_p";
        `Run.loop` is the view of one loop.
    Raises:
        ValueError: for an unknown or a missing signal, one of the wrong length or with a value that is no finite
            number, a step longer than a dead time, an end that is no whole number of steps away, or a run that grows
            beyond all numbers.

    >>> from loopbook.plants import RCCircuit
    >>> run = simulate(RCCircuit(), until=2, step=1, v_in=5)
    >>> run["v_out"].round(6)
    array([0.      , 3.160603, 4.323324])
    """
    if not isinstance(plant, Plant):
        raise ValueError(f"the plant is {plant!r}: expected one such as WoodChipTank()")
    if after is not None and not isinstance(after, Run):
        raise ValueError(f"after is {after!r}: expected an earlier run")
    driven = [name_of(plant.manipulated if manipulated is None else plant.signal(manipulated))]
    given = {"setpoint": setpoint, "noise": noise, "feedforward": feedforward, "manual": manual}
    given["scheduling"] = scheduling
    if isinstance(controller, (list, tuple)):
        structure, inputs, external, step = _structure(plant, controller, step, manipulated, given, inputs)
        driven = structure.driven
    else:
        structure, external = None, {}
        step = _fitting_step(plant, controller, step, driven[0], given, inputs)
    begin, past = (0.0, None) if after is None else (float(after.times[-1]), after._past)
    times = _grid(begin, until, step)

    sources = _sources(plant, times, inputs, past)
    for name in driven if controller is not None else ():
        sources[name].times, sources[name].values = times.tolist(), []
    system = _System(plant, sources, times, past.system if past else None)
    loop = None
    if structure:
        loop = structure
        loop.prepare(times, external, noise, seed, manual)
    elif controller is not None:
        loop = _Loop(copy.deepcopy(controller), times, given, seed, driven[0])
    if loop and past:
        loop.continue_after(past.loop, {name: sources[name].past.at(begin) for name in driven})
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", module="scipy")  # of a step that fails, before it is tried in another way
        for time in times:
            system.advance(time)
            if loop:
                for name, value in loop.sample(system.readings(time, driven)).items():
                    sources[name].values.append(value)
    signals = system.signals(times) | (loop.record if loop else {})
    held = {name for name, source in sources.items() if not any(map(callable, source.values))}
    held |= {"setpoint"} if loop else set()
    if structure:
        held |= set(loop.record)
    main = driven[0] if driven else name_of(plant.manipulated)
    run = Run(times, _arrays(signals), plant, main, held, _past=_Past(system, loop))
    return run if after is None else _joined(after, run)


def _structure(plant, blocks, step, manipulated, given, inputs):
    """The control structure that a list of blocks makes, the signals for the plant and for it, and the step."""
    names = [name_of(x) for x in plant.inputs]
    structure = Structure(blocks, [name_of(x) for x in (*plant.states, *plant.measured)], names)
    for name in structure.external:
        if name in inspect.signature(simulate).parameters:
            reader = next(block.tag for block in structure.blocks if name in block.reads)
            raise ValueError(f"{reader} reads {name}, which is an argument of simulate: expected another name")
    for name in ("setpoint", "feedforward", "scheduling"):
        if not (given[name] is None or (is_number(given[name]) and given[name] == 0)):
            raise ValueError(f"{name} is given, but there are several controllers: give each loop's by its own name")
    if manipulated is not None:
        raise ValueError("manipulated is given, but there are several controllers: each loop names its output")
    for name in inputs:
        if name in structure.driven:
            raise ValueError(f"{name} is given, but it is a block that sets it")
    step = step if step is not None else structure.step
    if step is None:
        raise ValueError("the step is missing: expected the time between two samples")
    of_plant = {name: signal for name, signal in inputs.items() if name in names}
    return structure, of_plant, {name: signal for name, signal in inputs.items() if name not in names}, step


def _fitting_step(plant, controller, step, driven, given, inputs):
    """The time between two samples, after a look at whether what was given fits together."""
    names = [name_of(x) for x in plant.inputs]
    for name in (driven, *inputs):
        if name not in names:
            raise ValueError(f"{type(plant).__name__} has no input {name!r}: it has {', '.join(names)}")
    if controller is None:
        defaults = {name: given[name] is None for name in ("setpoint", "scheduling")}
        defaults["manual"] = given["manual"] in ((), [])
        for name, signal in given.items():
            if not defaults.get(name, is_number(signal) and signal == 0):
                raise ValueError(f"{name} is given, but no controller")
        if step is None:
            raise ValueError("the step is missing: expected the time between two samples")
        return step
    if not (hasattr(controller, "update") and is_number(getattr(controller, "step", None))):
        raise ValueError(f"the controller is {controller!r}: expected one such as Controller(PID(2, 10), step=1)")
    if given["setpoint"] is None:
        raise ValueError("the setpoint is missing: expected a signal for the controller to follow")
    if given["scheduling"] is not None and not hasattr(controller, "schedule"):
        raise ValueError(f"scheduling is given, but {controller!r} has no gain schedule")
    if driven in inputs:
        raise ValueError(f"{driven} is given, but it is the controller that sets it")
    if step is not None and step != controller.step:
        raise ValueError(f"the step is {step}, but the controller runs every {controller.step:g}")
    return controller.step


def _sources(plant, times, inputs, past):
    """All inputs of the plant as signals in time, with their past."""
    at_rest = {name_of(x): plant.values[x] for x in plant.inputs}
    if past and not set(past.system.sources) >= set(at_rest):
        earlier, now = (", ".join(names) for names in (past.system.sources, at_rest))
        raise ValueError(f"the earlier run has the inputs {earlier}, this plant has {now}")
    sources = {name: in_time(name, signal, times) for name, signal in (at_rest | inputs).items()}
    for name, source in sources.items():
        before = Stretches([-math.inf], [float(at_rest[name])], source.step)
        source.past = past.system.sources[name] if past else before
    return sources


@dataclass(frozen=True)
class _Past:
    """What a later run needs in order to go on."""

    system: object
    loop: object


class _Loop:
    """The controller with its signals, one value for each sample."""

    def __init__(self, controller, times, given, seed, name):
        self.controller, self.times, self.name, self.k = controller, times, name, 0
        self.record, self.before_last = {}, None
        self.manual = by_hand(given["manual"], times)
        added = given["noise"]
        if is_number(added):  # a run that goes on has noise of its own
            added = noise(times, added, (seed, round(times[0] / controller.step)))
        self.setpoint, self.feedforward = (samples(name, given[name], times) for name in ("setpoint", "feedforward"))
        self.noise = samples("noise", added, times)
        scheduling = given["scheduling"]
        self.scheduling = None if scheduling is None else samples("scheduling", scheduling, times)

    def continue_after(self, earlier, last):
        """Take over the memory of an earlier run's controller; without one, begin from its last control signal."""
        earlier = earlier if isinstance(earlier, _Loop) else None
        if earlier and type(earlier.controller) is type(self.controller) and hasattr(self.controller, "take_over"):
            self.controller.take_over(earlier.before_last)
        elif hasattr(self.controller, "start_from"):
            self.controller.start_from(last[self.name])

    def sample(self, readings):
        """Run the controller once, and return ``{input: control signal}``."""
        k, self.k = self.k, self.k + 1
        output, name = readings[""], self.name
        if self.k == len(self.times):  # a run that goes on from here begins with this sample, maybe with other settings
            self.before_last = copy.deepcopy(self.controller)
        now = {"setpoint": self.setpoint[k], "measurement": output + self.noise[k]}
        more = {} if self.scheduling is None else {"scheduling": self.scheduling[k]}
        u = self.controller.update(*now.values(), feedforward=self.feedforward[k], manual=self.manual[k], **more)
        if not is_number(u):
            if isinstance(u, float):
                raise _beyond_all_numbers(name, self.times[k])
            raise ValueError(f"the controller returned {u!r} at t = {self.times[k]:g}: expected a number")
        if hasattr(self.controller, "terms"):
            now["ramped"], now["filtered"] = self.controller.setpoint, self.controller.filtered
            now["u_p"], now["u_i"], now["u_d"] = self.controller.terms
        now |= more | {name: getattr(self.controller, name) for name in getattr(self.controller, "recorded", ())}
        for signal, value in now.items():
            self.record.setdefault(signal, []).append(value)
        return {name: float(u)}


class _Programs:
    """The equations of a plant as programs, and the signals besides the undelayed states that each needs."""

    def __init__(self, plant):
        equations = plant.state_equations()
        self.plant, self.states = plant, list(equations)
        self.rates, self.driving = self._compiled(equations.values())
        self.measure, self.measuring = self._compiled(plant.measured.values())
        del self.plant  # it would keep itself alive

    def _compiled(self, formulas):
        """A program for the formulas, and what else it needs: (name, delay)."""
        formulas = [self.plant.numbers(formula) for formula in formulas]
        if any(formula.has(sympy.zoo, sympy.nan, sympy.oo) for formula in formulas):
            raise ValueError(f"{self.plant} divides by zero: expected parameters that are not zero")
        letters = {x: sympy.Dummy() for x in self.states}
        formulas = [formula.xreplace(letters) for formula in formulas]
        found = sorted({x for formula in formulas for x in formula.atoms(AppliedUndef)}, key=str)
        others = {x: sympy.Dummy() for x in found}
        program = sympy.lambdify([*letters.values(), *others.values()], [f.xreplace(others) for f in formulas], "math")
        return program, [(name_of(x), float(t - x.args[0])) for x in found]


_PROGRAMS = weakref.WeakKeyDictionary()  # of the plants in use: a plant never changes, and compiling takes its time


class _System:
    """The plant's equations as programs, and its state from one discontinuity to the next."""

    def __init__(self, plant, sources, times, past):
        from scipy.integrate import ode

        self.plant, self.sources, self.past, self.rows = plant, sources, past, []
        self.begin, self.step = times[0], times[1] - times[0]
        if plant not in _PROGRAMS:
            _PROGRAMS[plant] = _Programs(plant)
        programs = _PROGRAMS[plant]
        self.rates, self.driving = programs.rates, programs.driving
        self.measure, self.measuring = programs.measure, programs.measuring
        self.states, self.names = programs.states, [name_of(x) for x in programs.states]
        if past and past.names != self.names:
            raise ValueError(f"the earlier run has the states {past.names}, this plant has {self.names}")
        self.measured, self.output = [name_of(x) for x in plant.measured], name_of(plant.output)
        self._refuse_delays()

        self.at_rest = [0.0 if x.is_Derivative else float(plant.values[x]) for x in self.states]
        self.limits = [tuple(float(plant.numbers(x)) for x in plant.limits.get(x, INFINITE)) for x in self.states]
        self.limited = any(map(math.isfinite, sum(self.limits, ())))
        # the state at each discontinuity so far
        self.times, self.trace = [self.begin], [past.state_at(self.begin) if past else self.at_rest]
        self.ahead = iter(self._discontinuities(times))
        self.method, self.solvers = (
            "dopri5",
            {
                "dopri5": ode(self._rate_of_change).set_integrator("dopri5", first_step=self.step, **TOLERANCE),
                "lsoda": ode(self._rate_of_change).set_integrator("lsoda", **TOLERANCE),
            },
        )

    def _refuse_delays(self):
        for name, delay in self.driving + self.measuring:
            if delay < 0:
                raise ValueError(f"{name} acts {-delay:g} before its time: expected a dead time that is not negative")
            if 0 < delay < self.step * (1 - CLOSE):
                raise ValueError(
                    f"the step {self.step:g} is longer than the dead time {delay:g}: expected a shorter step"
                )
        if any(name in self.names for name, _ in self.driving):
            raise ValueError(
                f"{type(self.plant).__name__} has a dead time inside: expected one at an input or an output"
            )
        for name, delay in self.measuring:
            if name in self.sources and not self.sources[name].values and not delay:
                raise ValueError(f"{name} acts on a measured signal at once: expected a lag between the two")

    def _discontinuities(self, times):
        """The moments to stop at: the samples, and where a signal, maybe delayed, jumps between two of them."""
        import numpy

        late = [numpy.array(self.sources[name].jumps()) + delay for name, delay in self.driving]
        moments = numpy.unique(numpy.concatenate([*late, []]))
        moments = moments[(moments > self.begin) & (moments < times[-1])]
        steps = (moments - self.begin) / self.step
        rounding = CLOSE + 1e-15 * abs(moments) / self.step
        return numpy.sort(numpy.concatenate([times[1:], moments[abs(steps - numpy.round(steps)) > rounding]])).tolist()

    def advance(self, time):
        """Integrate up to the sample at `time`, and measure there."""
        while self.times[-1] < time:
            end = next(self.ahead)
            self.trace.append(self._integrated(self.trace[-1], self.times[-1], end))
            self.times.append(end)
        needed = [self._at(name, time - delay) for name, delay in self.measuring]
        self.rows.append(self.measure(*self.trace[-1], *needed))

    def _integrated(self, state, start, end):
        """The state at the end of a stretch of time in which no signal jumps."""
        middle = (start + end) / 2
        self.inside = [(self.sources[name].around(middle - delay), delay) for name, delay in self.driving]
        self.held = None if any(callable(x) for x, _ in self.inside) else [x for x, _ in self.inside]
        self.failure = None
        # what is too stiff for the explicit method goes to the one that switches to an implicit method by itself
        for method in dict.fromkeys((self.method, "lsoda")):
            solver = self.solvers[method]
            found = solver.set_initial_value(state, start).integrate(end).tolist()
            if self.failure:
                raise self.failure
            if solver.successful() and all(map(math.isfinite, found)):
                self.method = method
                return [min(max(x, low), high) for x, (low, high) in zip(found, self.limits, strict=True)]
        raise _beyond_all_numbers(", ".join(self.names), end)

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

    def state_at(self, time):
        """The state at any moment so far; between two discontinuities it is integrated once more."""
        n = last_not_after(time, self.times, self.step)
        if n < 0:
            return self.past.state_at(time) if self.past else self.at_rest
        if abs(time - self.times[n]) <= CLOSE * self.step + 1e-15 * abs(time):
            return self.trace[n]
        return self._integrated(self.trace[n], self.times[n], time)

    def _at(self, name, time):
        if name in self.names:
            return self.state_at(time)[self.names.index(name)]
        return self.sources[name].at(time)

    def readings(self, time, driven):
        """What the plant says at the last sample: states, measured signals and inputs by name, the output as ""."""
        inputs = {name: source.at(time) for name, source in self.sources.items() if name not in driven}
        measured = dict(zip(self.measured, self.rows[-1], strict=True))
        found = inputs | dict(zip(self.names, self.trace[-1], strict=True)) | measured
        return found | {"": found[self.output]}

    def signals(self, times):
        """The states, the measured signals and the inputs at the samples."""
        states = [self.state_at(time) for time in times]
        found = {name: [state[n] for state in states] for n, name in enumerate(self.names)}
        found |= {name_of(x): [row[n] for row in self.rows] for n, x in enumerate(self.plant.measured)}
        return found | {name: [source.at(time) for time in times] for name, source in self.sources.items()}


def _grid(begin, until, step):
    """The moments of the samples, rounded so that 49 steps of 0.1 end at 4.9."""
    import numpy

    for name, value in (("step", step), ("end", until)):
        if not is_number(value):
            raise ValueError(f"the {name} is {value!r}: expected a number")
    if step <= 0:
        raise ValueError(f"the step is {step}: expected a positive time")
    count = (float(until) - begin) / float(step)
    if count < 0.5 or abs(count - round(count)) > 1e-6:
        raise ValueError(f"the end {until} is not a whole number of steps of {step} after {begin:g}")
    if count > MOST_SAMPLES:
        raise ValueError(f"the run would have {count:.0f} samples: expected at most {MOST_SAMPLES}")
    digits = 13 - math.ceil(math.log10(abs(float(until)) + begin))
    return numpy.around(begin + float(step) * numpy.arange(round(count) + 1), digits)


def _beyond_all_numbers(names, time):
    reason = "the system is unstable or a signal infinite, end the run earlier"
    return ValueError(f"{names} grows beyond all numbers before t = {time:g}: {reason}")


def _arrays(signals):
    import numpy

    return {name: numpy.array(values) for name, values in signals.items()}


def _joined(earlier, later):
    """Two runs as one; what only one of them has is NaN in the other. The moment where they meet is the later one's."""
    import numpy

    def part(run, name, length):
        return run.signals[name][:length] if name in run.signals else numpy.full(length, numpy.nan)

    shorter, names = len(earlier.times) - 1, [*earlier.signals, *later.signals]
    signals = {
        name: numpy.concatenate([part(earlier, name, shorter), part(later, name, len(later.times))])
        for name in dict.fromkeys(names)
    }
    times = numpy.concatenate([earlier.times[:-1], later.times])
    held = later.held & (earlier.held | {"setpoint"})
    return replace(later, times=times, signals=signals, held=held)
