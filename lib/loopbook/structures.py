"""Control structures: several controllers on one plant, as blocks that read and write signals by their names.

A structure is a list of blocks, which run in this order once a sample: cascade is a loop whose output is another loop's
setpoint, ratio control is a multiplication in between, split range is one signal shared out among several valves.
"""

import copy
import math

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import exact, function_of, s, t
from loopbook.inputs import number
from loopbook.laplace import by_delay
from loopbook.pid import Controller
from loopbook.scaling import Scaling
from loopbook.signals import by_hand, is_number, noise, samples
from loopbook.transfer import poles, simplified

__all__ = ["Calculation", "ControlLoop", "SplitRange", "Structure", "controller_action"]

ON = 0.5  # a signal above it is TRUE


def controller_action(process):
    """Return the action that a controller needs for a process: "reverse" or "direct". (Haugen, Section 7.3.3)

    The sign of the process gain decides, the limit of s**n H(s) at s = 0 with the number n of integrators: where the
    measurement rises with the control signal, the controller must lower that against a rise.

    Arguments:
        process: the transfer function from the control signal to the measurement, with numbers or positive letters.
    Raises:
        ValueError: where the sign depends on the letters, the control signal has no lasting effect, or the process is
            unstable, so that this sign does not decide.

    >>> from loopbook.plants import BufferTank
    >>> tank = BufferTank()
    >>> controller_action(tank.transfer_function("F_in")), controller_action(tank.transfer_function("F_out"))
    ('reverse', 'direct')
    """
    H = simplified(function_of(s, process))
    gain, power = H.leadterm(s) if H.has(s) else (H, 0)
    if H == 0 or power > 0:
        raise ValueError(f"the control signal has no lasting effect through {H}: expected a process gain")
    if not H.free_symbols - {s} and any(sympy.re(p).evalf() > 0 for part in by_delay(H).values() for p in poles(part)):
        raise ValueError(f"{H} is unstable: expected a stable or integrating process, whose gain decides the action")
    if not (gain.is_positive or gain.is_negative):
        raise ValueError(f"the sign of the process gain {gain} is not known: expected numbers or positive letters")
    return "reverse" if gain.is_positive else "direct"


# ---------------------------------------------------------------------------------------------------- the blocks
# A block has a tag, the names that it reads and writes, a step (None: every sample) and `update(values, time)`, which
# returns {name: number}; `recorded` holds further signals of the last sample.


class ControlLoop:
    """A controller between the signals of its loop.

    Arguments:
        tag: of the controller in the P&I diagram, such as "LC1".
        controller: a `pid.Controller` or an object with a step and a method `update` like its own.
        setpoint: the name of a signal, or a number. Another loop's output makes this one the inner loop of a cascade.
        measurement: the name of a signal of the plant.
        output: the name of an input of the plant or of a new signal.
        feedforward: the name of a signal to be added, if any.
        scheduling: the name of the signal by which a controller with a gain schedule takes its settings.
        mode: the name of a signal; the loop is in automatic mode while it is TRUE, above 0.5. Always, if not given.
        manual: the output in manual mode; None keeps the last one.
    Raises:
        ValueError: for a name that is none, or no controller.

    >>> from loopbook.pid import PID
    >>> ControlLoop("LC1", Controller(PID(2, 10), step=1), setpoint=1.5, measurement="h", output="u")
    <LC1: h at 1.5 by u>
    """

    def __init__(
        self, tag, controller, setpoint, measurement, output, feedforward=None, scheduling=None, mode=None, manual=None
    ):  # fmt: skip
        if not (hasattr(controller, "update") and is_number(getattr(controller, "step", None))):
            raise ValueError(f"the controller is {controller!r}: expected one such as Controller(PID(2, 10), step=1)")
        self.tag, self.controller, self.step = _name("tag", tag), controller, controller.step
        self.setpoint = setpoint if is_number(setpoint) else _name("setpoint", setpoint)
        self.measurement, self.output = _name("measurement", measurement), _name("output", output)
        further = feedforward, scheduling, mode
        self.feedforward, self.scheduling, self.mode = (None if x is None else _name("signal", x) for x in further)
        if (scheduling is None) == hasattr(controller, "schedule"):
            raise ValueError(f"scheduling is {scheduling!r} for {controller!r}: expected a signal for a gain schedule")
        self.manual = math.nan if manual is None else number("manual", manual)
        named = (self.setpoint, self.measurement, self.feedforward, self.scheduling, self.mode)
        self.reads, self.writes = tuple(x for x in named if isinstance(x, str)), (self.output,)
        self.inner, self.operator, self.recorded = None, None, {}
        self.following = ()  # what an outer loop must know of this one in order to follow it

    def in_manual(self, values):
        """The output that is prescribed in this sample, None in automatic mode.

        An outer loop follows the inner one's measurement while that does not listen, so that nothing jumps when it
        listens again.
        """
        if self.inner is not None and self.inner.in_manual(values) is not None:
            return values[self.inner.measurement]
        if self.operator is not None:
            return self.operator
        if self.mode and values[self.mode] <= ON:
            return self.manual
        return None

    def update(self, values, time):
        """Run the controller once and return ``{output: value}``."""
        manual = self.in_manual(values)
        if self.inner is not None:  # do not integrate beyond what the inner loop can do
            self.controller.blocked = self.inner.stuck()
        setpoint = self.setpoint if is_number(self.setpoint) else values[self.setpoint]
        more = {name: values[x] for name in ("feedforward", "scheduling") if (x := getattr(self, name))}
        u = self.controller.update(setpoint, values[self.measurement], manual=manual, **more)
        self.recorded = {f"{self.tag}.setpoint": setpoint, f"{self.tag}.measurement": values[self.measurement]}
        if isinstance(self.controller, Controller):
            terms = dict(zip(("u_p", "u_i", "u_d"), self.controller.terms, strict=True))
            terms |= {"ramped": self.controller.setpoint, "filtered": self.controller.filtered}
            terms |= {name: getattr(self.controller, name) for name in getattr(self.controller, "recorded", ())}
            self.recorded |= {f"{self.tag}.{name}": value for name, value in terms.items()}
        return {self.output: u}

    def stuck(self):
        """Which way the setpoint has no effect any more, +1 up or -1 down, because the output is at a limit; else 0."""
        controller = self.controller
        if not isinstance(controller, Controller) or controller.u is None:
            return 0
        low, high = controller.limits
        direction = (controller.u >= high) - (controller.u <= low)
        if not direction and self.inner is not None:
            direction = self.inner.stuck()
        return int(math.copysign(direction, direction * controller.Kp)) if direction else 0

    def __repr__(self):
        return f"<{self.tag}: {self.measurement} at {self.setpoint} by {self.output}>"


class Calculation:
    """A function block: a new signal, or an input of the plant, by a formula.

    Arguments:
        output: the name of the signal that it writes.
        formula: an expression whose letters are the names of signals, or that has signals of a plant such as h(t).
    Raises:
        ValueError: for a name that is none, or no expression, or one with signals of other moments, as a derivative.

    >>> K, F_A = sympy.symbols("K F_A")
    >>> Calculation("F_BSP", K * F_A).update({"K": 2, "F_A": 3}, 0)
    {'F_BSP': 6.0}
    """

    step, recorded = None, {}

    def __init__(self, output, formula):
        self.tag = self.output = _name("output", output)
        self.formula = exact(formula)
        of_plant = self.formula.atoms(AppliedUndef)
        if self.formula.has(sympy.Derivative, sympy.Integral) or any(x.args != (t,) for x in of_plant):
            raise ValueError(f"{output} = {self.formula}: expected a formula of the signals of one moment")
        signals = of_plant | self.formula.free_symbols  # one letter for each name
        self.formula = self.formula.xreplace({x: sympy.Symbol(getattr(x, "name", str(x.func))) for x in signals})
        letters = sorted(self.formula.free_symbols, key=str)
        self.reads, self.writes = tuple(map(str, letters)), (self.output,)
        self.function = sympy.lambdify(letters, self.formula, "math")

    def __deepcopy__(self, memory):
        return self  # it remembers nothing

    def update(self, values, time):
        try:
            return {self.output: float(self.function(*(values[name] for name in self.reads)))}
        except (ArithmeticError, ValueError, TypeError, NameError):  # the last two: complex, or not for numbers
            raise ValueError(f"{self.output} = {self.formula} has no value at t = {time:g}") from None

    def __repr__(self):
        return f"<{self.output} = {self.formula}>"


class SplitRange:
    """One control signal shared out among several actuators. (Haugen, Section 11.3)

    Arguments:
        signal: the name of the control signal.
        actuators: ``{input: ((from, to), (opening there, opening there))}``: the range of the signal in which the
            actuator works, and its opening at both ends of this range, which it keeps beyond them.
    Raises:
        ValueError: for a range that is not two different numbers.

    >>> valves = SplitRange("u", {"u_cold": ((0, 50), (100, 0)), "u_hot": ((50, 100), (0, 100))})
    >>> valves.update({"u": 60}, 0)
    {'u_cold': 0.0, 'u_hot': 20.0}
    """

    step, recorded = None, {}

    def __init__(self, signal, actuators):
        self.tag = "split range of " + _name("signal", signal)
        if not isinstance(actuators, dict) or not actuators:
            raise ValueError(f"the actuators are {actuators!r}: expected {{input: (range, openings)}}")
        self.signal, self.lines = signal, {}
        for name, ends in actuators.items():
            try:
                span, openings = ends
            except (TypeError, ValueError):
                raise ValueError(f"{name} is {ends!r}: expected its range and the openings at its two ends") from None
            line = Scaling(span, openings)
            self.lines[_name("actuator", name)] = float(line.a), float(line.b), sorted(map(float, openings))
        self.reads, self.writes = (signal,), tuple(actuators)

    def openings(self, u):
        """The openings for a control signal, a number or an array: ``{input: opening}``."""
        import numpy

        found = {name: numpy.clip(a * numpy.asarray(u) + b, *ends) for name, (a, b, ends) in self.lines.items()}
        return {name: x if x.ndim else float(x) for name, x in found.items()}

    def update(self, values, time):
        u = values[self.signal]
        return {name: min(max(a * u + b, low), high) for name, (a, b, (low, high)) in self.lines.items()}

    def __repr__(self):
        return f"<{self.tag}: {', '.join(self.writes)}>"


def _name(what, name):
    if not isinstance(name, str) or not name.isidentifier():
        raise ValueError(f"the {what} is {name!r}: expected a name, a text of letters, digits and underscores")
    return name


# ---------------------------------------------------------------------------------------------------- the whole


class Structure:
    """The blocks of a control structure while they run on a plant; `simulation.simulate` makes and drives it.

    Arguments:
        blocks: a list of blocks.
        of_plant: the names of the plant's states and measured signals.
        inputs: the names of the plant's inputs.
    Raises:
        ValueError: for two blocks with the same tag or the same output, or one that would write what the plant says.
    """

    def __init__(self, blocks, of_plant, inputs):
        self.blocks, self.of_plant, self.inputs = copy.deepcopy(list(blocks)), list(of_plant), list(inputs)
        writer = {}
        for block in self.blocks:
            if not (hasattr(block, "update") and hasattr(block, "reads") and hasattr(block, "writes")):
                raise ValueError(f"the structure has {block!r}: expected blocks such as ControlLoop(...)")
            if [other.tag for other in self.blocks].count(block.tag) > 1:
                raise ValueError(f"two blocks are called {block.tag}: expected different tags")
            for name in block.writes:
                if name in writer:
                    raise ValueError(f"both {writer[name]} and {block.tag} write {name}: expected one of them")
                if name in self.of_plant:
                    raise ValueError(f"{block.tag} writes {name}, but it is the plant that says what it is")
                writer[name] = block.tag
        self.loops = {block.tag: block for block in self.blocks if isinstance(block, ControlLoop)}
        for loop in reversed(self.loops.values()):  # from the inside out
            behind = [inner for inner in self.loops.values() if inner.setpoint == loop.output]
            if len(behind) == 1:  # of two loops with one setpoint neither is to be followed
                (loop.inner,) = behind
                loop.reads += loop.inner.following
            loop.following = tuple(x for x in (loop.measurement, loop.mode) if x) + loop.following
        self.driven = [name for name in writer if name in self.inputs]
        self.external = self._external(writer)

    def _external(self, writer):
        """The names that are read and that neither the plant nor a block gives."""
        given, external = {*self.of_plant, *self.inputs} - set(self.driven), []
        for block in self.blocks:
            for name in block.reads:
                if name in writer and name not in given:
                    raise ValueError(f"{block.tag} reads {name}, which {writer[name]} writes: put {writer[name]} first")
                if name not in writer and name not in given and name not in external:
                    external.append(name)
            given |= set(block.writes)
        return external

    @property
    def measurement_of(self):
        """``{setpoint: measurement}``, for the names that are setpoints."""
        return {loop.setpoint: loop.measurement for loop in self.loops.values() if not is_number(loop.setpoint)}

    @property
    def split(self):
        """The names of the signals that are shared out among actuators."""
        return [block.signal for block in self.blocks if isinstance(block, SplitRange)]

    @property
    def step(self):
        """The shortest step of its blocks, None if none has one."""
        return min((float(block.step) for block in self.blocks if block.step is not None), default=None)

    def prepare(self, times, signals, added_noise, seed, manual):
        """Take the external signals, the noise and the stretches in manual mode for the moments of a run."""
        for name in signals:
            if name not in self.external:
                raise ValueError(f"{name} is given, but no block reads it and the plant has no such input")
        missing = [name for name in self.external if signals.get(name) is None]
        if missing:
            reader = next(block.tag for block in self.blocks if missing[0] in block.reads)
            raise ValueError(f"{reader} reads {missing[0]}, which nobody gives: expected {missing[0]}=...")
        self.times, self.interval, self.record, self.before_last = times, times[1] - times[0], {}, None
        self.k, self.k0, self.values = 0, 0, {}
        self.beginning = {}  # the loops that begin as after manual mode, with their last outputs as far as known
        self.signals = {name: samples(name, signals[name], times) for name in self.external}
        self.noise, self.by_hand = self._noise(added_noise, seed), self._by_hand(manual)
        self.every = {block.tag: self._every(block, self.interval) for block in self.blocks}

    def _noise(self, added, seed):
        if is_number(added) and added == 0:
            return {}
        if not isinstance(added, dict):
            raise ValueError(f"noise is {added!r}: expected {{measurement: standard deviation}}")
        found = {}
        for n, (name, deviation) in enumerate(added.items()):
            if name not in self.of_plant:
                raise ValueError(f"noise has {name!r}: expected signals of the plant, {', '.join(self.of_plant)}")
            if is_number(deviation):  # a run that goes on has noise of its own
                deviation = noise(self.times, deviation, (seed, n, round(self.times[0] / self.interval)))
            found[name] = samples("noise", deviation, self.times)
        return found

    def _by_hand(self, manual):
        manual = {} if manual in ((), []) else manual
        if not isinstance(manual, dict) or not set(manual) <= set(self.loops):
            raise ValueError(f"manual is {manual!r}: expected {{tag: stretches of time}} for {', '.join(self.loops)}")
        return {tag: by_hand(stretches, self.times) for tag, stretches in manual.items()}

    @staticmethod
    def _every(block, step):
        if block.step is None:
            return 1
        every = round(float(block.step) / step)
        if every < 1 or abs(every * step - float(block.step)) > 1e-6 * step:
            raise ValueError(f"{block.tag} runs every {block.step:g}: expected a whole multiple of the step {step:g}")
        return every

    def continue_after(self, earlier, last):
        """Take over the memory of an earlier run's blocks; without one, loops begin from the last control signals."""
        before = earlier.before_last if isinstance(earlier, Structure) else {}
        for block in self.blocks:
            old = before.get(block.tag)
            if isinstance(block, ControlLoop):
                same = old is not None and type(old.controller) is type(block.controller)
                same = same and (old.measurement, old.output) == (block.measurement, block.output)
                if same and hasattr(block.controller, "take_over"):
                    block.controller.take_over(old.controller)
                elif hasattr(block.controller, "start_from"):
                    self.beginning[block.tag] = last.get(block.output)
            elif old is not None and hasattr(block, "take_over"):
                block.take_over(old)
        if before:
            self.k0, self.values = round(earlier.phase * earlier.interval / self.interval), dict(earlier.values)

    @property
    def phase(self):
        """How many samples have passed at the beginning of the last one."""
        return self.k0 + self.k - 1

    def sample(self, readings):
        """Run the blocks once on the plant's signals of this moment, and return ``{input: value}``."""
        k, self.k = self.k, self.k + 1
        time = self.times[k]
        if self.k == len(self.times):  # a run that goes on from here begins with this sample, maybe with other settings
            self.before_last = {block.tag: copy.deepcopy(block) for block in self.blocks}
        measured = {name: readings[name] + values[k] for name, values in self.noise.items()}
        values = readings | measured | {name: signal[k] for name, signal in self.signals.items()}
        for tag, output in self.by_hand.items():
            self.loops[tag].operator = output[k]
        for block in self.blocks:
            if (self.k0 + k) % self.every[block.tag] == 0 or any(name not in self.values for name in block.writes):
                if block.tag in self.beginning:
                    self._begin(block, values)
                values |= self._checked(block, block.update(values, time), time)
            else:
                values |= {name: self.values[name] for name in block.writes}
            for name, value in block.recorded.items():
                self.record.setdefault(name, []).append(value)
        self.values = {name: values[name] for block in self.blocks for name in block.writes}
        for name in {*self.values, *self.external} - set(self.driven):
            self.record.setdefault(name, []).append(values[name])
        return {name: values[name] for name in self.driven}

    def _begin(self, loop, values):
        """Let a loop that is new on a running plant begin without a bump."""
        last = self.beginning.pop(loop.tag)
        if last is None and loop.inner is not None:
            last = values[loop.inner.measurement]
        if last is not None:
            loop.controller.start_from(last)

    @staticmethod
    def _checked(block, written, time):
        for name, value in written.items():
            if not is_number(value) and not isinstance(value, bool):
                raise ValueError(f"{block.tag} gives {name} = {value!r} at t = {time:g}: expected a finite number")
        return {name: float(value) for name, value in written.items()}
