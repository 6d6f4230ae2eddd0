"""The blocks of a control structure: a control loop, a calculation, a split range.

A block has a tag, the names that it reads and writes, a step (None: every sample) and ``update(values, time)``, which
returns {name: number}; `recorded` holds further signals of the last sample, by names of the block's own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from loopbook.pid import HOLD, Controller
from loopbook.scaling import Scaling
from loopbook.types import Number, SampledController
from plainmath.expressions import exact, t
from plainmath.validation import is_number, number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Calculation", "ControlLoop", "SplitRange"]

ON = 0.5  # a signal above it is TRUE


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
        manual: the output in manual mode; if not given, the last one is kept.
    Raises:
        ValueError: for a name that is none, or no controller.

    >>> from loopbook.pid import PID
    >>> ControlLoop("LC1", Controller(PID(2, 10), step=1), setpoint=1.5, measurement="h", output="u")
    <LC1: h at 1.5 by u>
    """

    reads: tuple[str, ...]
    writes: tuple[str, ...]
    recorded: dict[str, float]
    inner: ControlLoop | None
    operator: float | None
    following: tuple[str, ...]

    def __init__(
        self,
        tag: str,
        controller: SampledController,
        setpoint: str | Number,
        measurement: str,
        output: str,
        feedforward: str | None = None,
        scheduling: str | None = None,
        mode: str | None = None,
        manual: Number | None = None,
    ):
        if not (hasattr(controller, "update") and is_number(getattr(controller, "step", None))):
            raise ValueError(f"the controller is {controller!r}: expected one such as Controller(PID(2, 10), step=1)")
        self.tag, self.controller, self.step = _name("tag", tag), controller, controller.step
        self.setpoint = setpoint if is_number(setpoint) else _name("setpoint", setpoint)
        self.measurement, self.output = _name("measurement", measurement), _name("output", output)
        further = feedforward, scheduling, mode
        self.feedforward, self.scheduling, self.mode = (None if x is None else _name("signal", x) for x in further)
        if (scheduling is None) == hasattr(controller, "schedule"):
            raise ValueError(f"scheduling is {scheduling!r} for {controller!r}: expected a signal for a gain schedule")
        self.manual = HOLD if manual is None else number("manual", manual)
        named = (self.setpoint, self.measurement, self.feedforward, self.scheduling, self.mode)
        self.reads, self.writes = tuple(x for x in named if isinstance(x, str)), (self.output,)
        self.inner, self.operator, self.recorded = None, None, {}
        self.following = ()  # what an outer loop must know of this one in order to follow it

    def manual_output(self, values: Mapping[str, float]) -> float | None:
        """The output that is prescribed in this sample, None in automatic mode.

        An outer loop follows the inner one's measurement while that does not listen, so that nothing jumps when it
        listens again.
        """
        if self.inner is not None and self.inner.manual_output(values) is not None:
            return values[self.inner.measurement]
        if self.operator is not None:
            return self.operator
        if self.mode and values[self.mode] <= ON:
            return self.manual
        return None

    def update(self, values: Mapping[str, float], time: float) -> dict[str, float]:
        """Run the controller once and return ``{output: value}``."""
        manual = self.manual_output(values)
        if self.inner is not None:  # do not integrate beyond what the inner loop can do
            self.controller.hold_integration = self.inner.at_limit()
        controller, measurement = self.controller, values[self.measurement]
        setpoint = values[self.setpoint] if isinstance(self.setpoint, str) else self.setpoint
        more = {}
        if self.feedforward:
            more["feedforward"] = values[self.feedforward]
        if self.scheduling:
            more["scheduling"] = values[self.scheduling]
        u = controller.update(setpoint, measurement, manual=manual, **more)
        self.recorded = recorded = {"setpoint": setpoint, "measurement": measurement}
        if hasattr(controller, "terms"):
            recorded["ramped"], recorded["filtered"] = controller.setpoint, controller.filtered
            recorded["u_p"], recorded["u_i"], recorded["u_d"] = controller.terms
        if self.scheduling:
            recorded["scheduling"] = more["scheduling"]
        for name in getattr(controller, "recorded", ()):
            recorded[name] = getattr(controller, name)
        return {self.output: u}

    def at_limit(self) -> int:
        """Which way the setpoint has no effect any more, +1 up or -1 down, because the output is at a limit; else 0."""
        controller = self.controller
        if not isinstance(controller, Controller) or controller.u is None:
            return 0
        low, high = controller.limits
        direction = (controller.u >= high) - (controller.u <= low)
        if not direction and self.inner is not None:
            direction = self.inner.at_limit()
        return int(math.copysign(direction, direction * controller.Kp)) if direction else 0

    def __repr__(self) -> str:
        return f"<{self.tag}: {self.measurement} at {self.setpoint} by {self.output}>"


class Calculation:
    """A function block: a new signal, or an input of the plant, by a formula.

    Arguments:
        output: the name of the signal that it writes.
        formula: an expression whose symbols are the names of signals, or that has signals of a plant such as h(t).
    Raises:
        ValueError: for a name that is none, or no expression, or one with signals of other moments, as a derivative.

    >>> K, F_A = sympy.symbols("K F_A")
    >>> Calculation("F_BSP", K * F_A).update({"K": 2, "F_A": 3}, 0)
    {'F_BSP': 6.0}
    """

    reads: tuple[str, ...]
    writes: tuple[str, ...]
    step: ClassVar[None] = None
    recorded: ClassVar[dict[str, float]] = {}

    def __init__(self, output: str, formula: Number):
        self.tag = self.output = _name("output", output)
        self.formula = exact(formula)
        of_plant = self.formula.atoms(AppliedUndef)
        if self.formula.has(sympy.Derivative, sympy.Integral) or any(x.args != (t,) for x in of_plant):
            raise ValueError(f"{output} = {self.formula}: expected a formula of the signals of one moment")
        signals = of_plant | self.formula.free_symbols  # one symbol for each name
        self.formula = self.formula.xreplace({x: sympy.Symbol(getattr(x, "name", str(x.func))) for x in signals})
        symbols = sorted(self.formula.free_symbols, key=str)
        self.reads, self.writes = tuple(map(str, symbols)), (self.output,)
        self.function = sympy.lambdify(symbols, self.formula, "math")

    def __deepcopy__(self, memory: dict) -> Calculation:
        return self  # it remembers nothing

    def update(self, values: Mapping[str, float], time: float) -> dict[str, float]:
        try:
            return {self.output: float(self.function(*(values[name] for name in self.reads)))}
        except (ArithmeticError, ValueError, TypeError, NameError):  # the last two: complex, or not for numbers
            raise ValueError(f"{self.output} = {self.formula} has no value at t = {time:g}") from None

    def __repr__(self) -> str:
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

    reads: tuple[str, ...]
    writes: tuple[str, ...]
    step: ClassVar[None] = None
    recorded: ClassVar[dict[str, float]] = {}

    def __init__(self, signal: str, actuators: Mapping[str, tuple[Sequence[Number], Sequence[Number]]]):
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

    def openings(self, u: ArrayLike) -> dict[str, float | np.ndarray]:
        """The openings for a control signal, a number or an array: ``{input: opening}``."""
        found = {name: np.clip(a * np.asarray(u) + b, *ends) for name, (a, b, ends) in self.lines.items()}
        return {name: x if x.ndim else float(x) for name, x in found.items()}

    def update(self, values: Mapping[str, float], time: float) -> dict[str, float]:
        u = values[self.signal]
        return {name: min(max(a * u + b, low), high) for name, (a, b, (low, high)) in self.lines.items()}

    def __repr__(self) -> str:
        return f"<{self.tag}: {', '.join(self.writes)}>"


def _name(what, name):
    if not isinstance(name, str) or not name.isidentifier():
        raise ValueError(f"the {what} is {name!r}: expected a name, a text of letters, digits and underscores")
    return name
