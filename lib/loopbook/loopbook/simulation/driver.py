"""Driving a plant through a run: the samples one after the other, the plant between them, the blocks at each."""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Mapping, Sequence

import numpy as np
import sympy

from loopbook.pid import Controller
from loopbook.plants import Plant, name_of
from loopbook.signals import PiecewiseSignal, beyond_all_numbers, in_time, is_given
from loopbook.signals import noise as normal_noise
from loopbook.simulation.delayed_states import DelayedStateIntegrator
from loopbook.simulation.held import HeldIntegrator
from loopbook.simulation.integrator import PlantIntegrator, compiled
from loopbook.simulation.run import Past, Run, joined
from loopbook.structures import ControlLoop, Structure
from loopbook.types import Block, ManualStretches, Number, SampledController, Signal
from plainmath.validation import did_you_mean, is_number, number, positive

__all__ = ["simulate"]

MOST_SAMPLES = 10_000_000
SINGLE = "controller"  # the tag of the loop that a single controller makes


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
        plant: a `plants.Plant`. Before the start its inputs and its state have been those of its operating point,
            constant, whether or not that is a steady state.
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
        manual: ``[(beginning, end, u)]``, the stretches of time in manual mode; u is None where the last control
            signal is kept (a controller's `update` then gets `pid.HOLD`).
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
            number, an end that is no whole number of steps away, or a run that grows beyond all numbers.

    >>> from loopbook.plants import RCCircuit
    >>> run = simulate(RCCircuit(), until=2, step=1, v_in=5)
    >>> run["v_out"].round(6)
    array([0.      , 3.160603, 4.323324])
    """
    if not isinstance(plant, Plant):
        raise ValueError(f"the plant is {plant!r}: expected one such as WoodChipTank()")
    if after is not None and not isinstance(after, Run):
        raise ValueError(f"after is {after!r}: expected an earlier run")
    acting_on = name_of(plant.manipulated if manipulated is None else plant.signal(manipulated))
    given = {"setpoint": setpoint, "noise": noise, "feedforward": feedforward, "manual": manual}
    given["scheduling"] = scheduling
    if isinstance(controller, (list, tuple)):
        blocks, of_one_loop = controller, False
    else:
        blocks, of_one_loop = _one_loop(plant, controller, step, acting_on, given, inputs), True
    names = [name_of(x) for x in plant.inputs]
    structure = Structure(blocks, [name_of(x) for x in (*plant.states, *plant.measured)], names)
    if not of_one_loop:
        _refuse_what_belongs_to_one_loop(structure, given, manipulated, inputs)
    step = step if step is not None else structure.step
    if step is None:
        raise ValueError("the step is missing: expected the time between two samples")
    begin, past = (0.0, None) if after is None else (float(after.times[-1]), after._past)
    times = _grid(begin, until, step)

    given_inputs = {name: signal for name, signal in inputs.items() if name in names}
    sources = _sources(plant, times, given_inputs, structure.driven, past)
    integrator = _integrator(plant, sources, times, structure.driven, past.integrator if past else None)
    if of_one_loop:
        external = {name: given[name] for name in structure.external}
        if blocks:
            noise, manual = _of_the_loop(blocks[0], noise, manual, times, seed)
    else:
        external = {name: signal for name, signal in inputs.items() if name not in names}
    structure.prepare(times, external, noise, seed, manual)
    if past:
        structure.continue_after(past.structure, {name: sources[name].past.at(begin) for name in structure.driven})
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", module="scipy")  # of a step that fails, before it is tried in another way
        quick = of_one_loop and type(controller) is Controller
        for time in times[[0, -1]] if quick else times:
            if quick and structure.k == 1:
                between = _all_samples_but_two(integrator, structure, sources)
            integrator.advance(time)
            if blocks:
                for name, value in structure.sample(integrator.readings(time)).items():
                    sources[name].values.append(value)
    record = structure.seen_by(SINGLE) if of_one_loop and blocks else structure.record
    if quick:
        record = {name: [first, *between[name], last] for name, (first, last) in record.items()}
    signals = {name: np.array(values) for name, values in (integrator.signals(times) | record).items()}
    held = {name for name, source in sources.items() if not any(map(callable, source.values))} | set(record)
    main = structure.driven[0] if structure.driven else acting_on
    run = Run(times, signals, plant, main, held, _past=Past(integrator, structure))
    return run if after is None else joined(after, run)


def _integrator(*arguments):
    """What integrates the plant: the exact recurrence, if there is one."""
    if compiled(arguments[0]).delayed_states:
        return DelayedStateIntegrator(*arguments)
    held = HeldIntegrator(*arguments)
    return held if held.applies else PlantIntegrator(*arguments)


def _all_samples_but_two(integrator, structure, sources):
    """Run a single controller as `Structure.sample` does, but for the first and the last sample; what it records."""
    (loop,) = structure.blocks
    times, count, controller = integrator.samples.tolist(), len(integrator.samples), loop.controller
    setpoint, noise = structure.signals["setpoint"], structure.noise.get(loop.measurement, [0.0] * count)
    feedforward = structure.signals.get("feedforward", [0.0] * count)
    manual = structure.by_hand.get(loop.tag, [None] * count)
    values, reading = sources[loop.output].values, integrator.reading(loop.measurement)
    measurements, ramped, filtered, terms = [], [], [], []
    for k in range(1, count - 1):
        integrator.advance(times[k])
        measurement = reading() + noise[k]
        u = controller.update(setpoint[k], measurement, feedforward[k], manual[k])
        if not math.isfinite(u):
            raise beyond_all_numbers(loop.output, times[k])
        values.append(u)
        measurements.append(measurement)
        ramped.append(controller.setpoint)
        filtered.append(controller.measurement_filter.output)
        terms.append(controller.terms)
    structure.k = count - 1
    terms = np.reshape(terms, (-1, 3)).T
    return dict(zip(loop.recorded, (setpoint[1:-1], measurements, ramped, filtered, *terms), strict=True))


def _one_loop(plant, controller, step, acting_on, given, inputs):
    """The list with the loop that a single controller makes, or with none, if what was given fits together."""
    names = [name_of(x) for x in plant.inputs]
    for name in (acting_on, *inputs):
        if name not in names:
            raise ValueError(f"{type(plant).__name__} has no input {name!r}: {did_you_mean(name, names)}")
    if controller is None:
        for name, signal in given.items():
            if is_given(signal):
                raise ValueError(f"{name} is given, but no controller")
        return []
    if given["setpoint"] is None:
        raise ValueError("the setpoint is missing: expected a signal for the controller to follow")
    if given["scheduling"] is not None and not hasattr(controller, "schedule"):
        raise ValueError(f"scheduling is given, but {controller!r} has no gain schedule")
    feedforward = "feedforward" if is_given(given["feedforward"]) else None
    scheduling = None if given["scheduling"] is None else "scheduling"
    loop = ControlLoop(SINGLE, controller, "setpoint", name_of(plant.output), acting_on, feedforward, scheduling)
    if acting_on in inputs:
        raise ValueError(f"{acting_on} is given, but it is the controller that sets it")
    if step is not None and step != controller.step:
        raise ValueError(f"the step is {step}, but the controller runs every {controller.step:g}")
    return [loop]


def _of_the_loop(loop, noise, manual, times, seed):
    """Noise and manual mode of the one loop, as for a list of blocks."""
    if not is_given(noise):
        return {}, {loop.tag: manual}
    if is_number(noise):  # a run that goes on has noise of its own
        noise = normal_noise(times, noise, (seed, round(times[0] / (times[1] - times[0]))))
    return {loop.measurement: noise}, {loop.tag: manual}


def _refuse_what_belongs_to_one_loop(structure, given, manipulated, inputs):
    """Refuse, with a list of blocks, what only a single controller takes."""
    for name in structure.external:
        if name in inspect.signature(simulate).parameters:
            reader = next(block.tag for block in structure.blocks if name in block.reads)
            raise ValueError(f"{reader} reads {name}, which is an argument of simulate: expected another name")
    for name in ("setpoint", "feedforward", "scheduling"):
        if is_given(given[name]):
            raise ValueError(f"{name} is given, but there are several controllers: give each loop's by its own name")
    if manipulated is not None:
        raise ValueError("manipulated is given, but there are several controllers: each loop names its output")
    for name in inputs:
        if name in structure.driven:
            raise ValueError(f"{name} is given, but it is a block that sets it")


def _sources(plant, times, inputs, driven, past):
    """All inputs of the plant as signals in time, with their past; those that blocks drive get their values later."""
    at_rest = {name_of(x): plant.values[x] for x in plant.inputs}
    if past and not set(past.integrator.sources) >= set(at_rest):
        earlier, now = (", ".join(names) for names in (past.integrator.sources, at_rest))
        raise ValueError(f"the earlier run has the inputs {earlier}, this plant has {now}")
    sources = {name: in_time(name, signal, times) for name, signal in (at_rest | inputs).items()}
    sources |= {name: PiecewiseSignal(times.tolist(), [], times[1] - times[0]) for name in driven}
    for name, source in sources.items():
        before = PiecewiseSignal([-math.inf], [float(at_rest[name])], source.step)
        source.past = past.integrator.sources[name] if past else before
    return sources


def _grid(begin, until, step):
    """The moments of the samples, rounded so that 49 steps of 0.1 end at 4.9."""
    positive("step", step), number("until", until)
    count = (float(until) - begin) / float(step)
    if count < 0.5 or abs(count - round(count)) > 1e-6:
        raise ValueError(f"the end {until} is not a whole number of steps of {step} after {begin:g}")
    if count > MOST_SAMPLES:
        raise ValueError(f"the run would have {count:.0f} samples: expected at most {MOST_SAMPLES}")
    digits = 13 - math.ceil(math.log10(abs(float(until)) + begin))
    return np.around(begin + float(step) * np.arange(round(count) + 1), digits)
