"""Charts run on a plant: what they do in several scenarios, held against demands.

A chart that does all that is asked is the *referee*. It sees the same measurements and says what the plant is in need
of; it sets nothing. Demands and scenarios are conditions in the manner of `loopbook.sequence.Formula`, so they are
data.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import sympy

from loopbook.plants import BatchTank
from loopbook.sequence import Chart, Formula

SCAN = 2  # s
#: So many scans after a change of the referee a demand may be violated: what comes one step later is not wrong.
PATIENCE = 3
#: What a scenario may last at most, in s.
LONGEST = 8000
#: How long a run goes on after its end, so that its figure shows what has happened.
AFTERWARDS = 40


class Demand(NamedTuple):
    """What must not be so.

    Arguments:
        says: what happens then, as a clause: "the heater is on while the tank is nearly empty".
        never: a condition on the signals of the plant and the outputs of the chart: "heater AND level < 0.4".
        during: the steps of the referee for which it holds, with blanks between them; all if not given.
    """

    says: str
    never: str
    during: str = ""


class Scenario(NamedTuple):
    """What happens around the plant.

    Arguments:
        says: when it happens, as the beginning of a sentence; empty for what is usual: "if the supply fails for a
        while". rounds: how often the referee must come back to its initial step. signals: ``{name: condition}`` in the
        flags and times of the referee's steps, as "Wait.X AND Wait.T >= 10": when a
            button is pressed, and when a disturbance of the plant acts.
    """

    says: str
    rounds: int
    signals: Mapping[str, str]


class TankRun:
    """The tank of a batch process with a level in m and a temperature in °C, which a chart switches.

    The physics is that of `loopbook.plants.BatchTank`, with a heating element of 90 kW and a stirrer that runs while it
    heats. A disturbance is ``no_supply``; with ``level_stuck`` the transmitter of the level keeps its value.
    """

    units: ClassVar = {"level": "m", "temperature": "°C", "overflow": "kg/s"}
    disturbances = ("no_supply", "level_stuck")

    def __init__(self):
        self.rates, self.spilled, self.state = *_rates(), (0.1, 20.0)
        self.seen = self.state[0]

    def measured(self, acting: Mapping[str, bool]) -> dict[str, float]:
        """What the transmitters say."""
        level, temperature = self.state
        if not acting.get("level_stuck"):
            self.seen = level
        return {"level": self.seen, "temperature": temperature}

    def hidden(self) -> dict[str, float]:
        """What no transmitter says."""
        return {"overflow": self.spilled(self.state[0]), "true_level": self.state[0]}

    def advance(self, on: Mapping[str, float], acting: Mapping[str, bool], seconds: float) -> None:
        """Go on for some seconds, in steps of one."""
        heating = on.get("heater", 0)
        for _ in range(round(seconds)):
            inputs = (on.get("inlet", 0), on.get("outlet", 0), heating, 100 * heating, not acting.get("no_supply"))
            self.state = tuple(x + rate for x, rate in zip(self.state, self.rates(*inputs, *self.state), strict=True))
            self.state = self.state[0], min(self.state[1], 100.0)  # what is boiling becomes no hotter


@functools.cache
def _rates():
    """The rates of the tank, and what runs over its rim, as functions of numbers."""
    tank = BatchTank(P_max=90000)
    names = ("u_valve_in", "u_valve_out", "u_motor", "u_heat", "u_hand", "h", "T")
    signals = {tank.signal(name): sympy.Symbol(name) for name in names}
    others = {x: value for x, value in tank.values.items() if x not in signals}
    rates = [rate.xreplace(signals).xreplace(others) for rate in tank.state_equations().values()]
    spilled = tank.overflow.xreplace(signals).xreplace(others)
    return (
        sympy.lambdify([sympy.Symbol(name) for name in names], rates, "math"),
        sympy.lambdify(sympy.Symbol("h"), spilled, "math"),
    )


#: The plants on which charts are run, by their names.
PLANTS = {"batch tank": TankRun}


@dataclass(frozen=True)
class ChartRun:
    """A run of a chart on a plant, as `loopbook.figures.sequence_trends` draws it.

    Attributes:
        times: of the scans, in s.
        signals: ``{name: array}``, with the steps as "SFC.Fill".
        violated: the demand that was not met, with the time at which; None where all were.
        why: what in the chart has led to it, and `cause`, the same without its names.
        rounds: how often the referee has come back before.
    """

    times: np.ndarray
    signals: dict[str, np.ndarray]
    units: Mapping[str, str]
    violated: tuple[Demand, float] | None
    why: str
    cause: str
    rounds: int
    time_unit = "s"
    held: frozenset[str] = frozenset()
    output, manipulated = "level", "inlet"

    def __getitem__(self, name: str) -> np.ndarray:
        return self.signals[name]

    def unit(self, name: str) -> str:
        """The unit of a signal."""
        return self.units.get(name, "1")


def run_chart(chart: Chart, referee: Chart, plant: TankRun, scenario: Scenario, demands: Iterable[Demand]) -> ChartRun:
    """Run a chart, which has not run yet, in a scenario, until a demand is violated or the referee has seen enough."""
    demands = [(one, Formula(one.never, one.says).condition(), one.during.split()) for one in demands]
    acting_if = {name: Formula(text, name).condition() for name, text in scenario.signals.items()}
    buttons = [name for name in chart.reads if name in acting_if]
    story, since, records, rounds, end, violated, why = _Story(chart), {}, [], 0, math.inf, None, ("", "")
    watch, changed = _Watch(referee), -PATIENCE - 1
    for scan in range(LONGEST // SCAN):
        time = scan * SCAN
        before, flags = referee.active, watch.flags(time)
        acting = {name: formula.true(flags) for name, formula in acting_if.items()}
        seen = plant.measured(acting) | {name: float(acting[name]) for name in buttons}
        referee.update(seen, time)
        given = chart.update(seen, time)
        story.goes_on(scan, time)
        values = seen | given | plant.hidden()
        records.append(values | {f"{chart.tag}.{step}": float(step in chart.active) for step in chart.steps})
        if before and before != referee.active and referee.initial in referee.active:
            rounds += violated is None
            if rounds == scenario.rounds:
                end = min(end, time + AFTERWARDS)
        if before and before != referee.active:
            changed = scan
        for number, (demand, never, during) in enumerate(demands if violated is None else ()):
            if (during and referee.active[0] not in during) or not never.true(values):
                since.pop(number, None)
                continue
            begun = SCAN * since.setdefault(number, scan)
            if not during or scan - changed > PATIENCE:
                violated, end = (demand, begun), time + AFTERWARDS
                why = story.why(never, given, begun)
                break
        if time >= end:
            break
        plant.advance(given, acting, SCAN)
    if violated is None and rounds < scenario.rounds:
        violated = Demand(f"the batch is not finished after {LONGEST} s", "TRUE"), LONGEST
    signals = {name: np.array([record[name] for record in records]) for name in records[0]}
    times = SCAN * np.arange(len(records), dtype=float)
    return ChartRun(times, signals, plant.units, violated, *why, rounds)


class _Watch:
    """The flags and the times of the steps of a chart, for conditions outside it."""

    def __init__(self, chart):
        self.chart, self.since = chart, {}

    def flags(self, time):
        """``{"Fill.X": whether it is active, "Fill.T": for how long}``."""
        active = self.chart.active
        self.since = {step: self.since.get(step, time) for step in active}
        found = {f"{step}.X": float(step in active) for step in self.chart.steps}
        return found | {f"{step}.T": time - self.since.get(step, time) for step in self.chart.steps}


class _Story:
    """What the steps of a chart have done so far, and what of it has led to a fault."""

    def __init__(self, chart):
        self.chart, self.active, self.begun, self.setters = chart, (), {}, {}
        self.reached = {}  # by which transition a step has become active
        self.hurried = None  # a step that was left after one scan, by which transition, and when

    def goes_on(self, scan, time):
        """Take note of a scan."""
        chart = self.chart
        for step in chart.active:
            if step not in self.active:
                self.begun[step] = scan
                self.setters.update((output, step) for output, _ in chart.actions[step])
                ways = [x for x in chart.transitions if step in x.targets and {*x.sources} <= {*self.active}]
                self.reached[step] = next((x for x in ways if not {*x.sources} & {*chart.active}), None)
        for step in self.active:
            if step not in chart.active and scan - self.begun[step] == 1 and step != chart.initial:
                ways = [x for x in chart.transitions if step in x.sources and {*x.targets} <= {*chart.active}]
                self.hurried = step, ways[0], time
        self.active = chart.active

    def why(self, never, given, time):
        """A clause on what led to a fault that began at a time, and the same without names."""
        chart, active = self.chart, " and ".join(self.chart.active)
        if self.hurried and self.hurried[-1] >= time - SCAN:
            step, way, _ = self.hurried
            if way.condition == "TRUE":
                return f"{_arrow(way)} has no condition, so {step} lasts for one scan only", "no condition"
            return f"{step} lasts for one scan only, because {way.condition} is true at once", "at once"
        waits, cause = self._waits()
        for output in (name for name in never.names if name in given):
            setter, switches = self.setters.get(output), f"switches it {'on' if given[output] else 'off'}"
            if setter in chart.active and time - SCAN * self.begun[setter] <= 2 * SCAN:
                if not (way := self.reached[setter]):
                    return f"{setter}, the initial step, {switches}", f"{output} {given[output]} from the beginning"
                cause = f"{output} {given[output]} by {_nameless(way.condition, *way.sources)}"
                return f"{setter} {switches}, and is reached by {_arrow(way)}: {way.condition}", cause
            if given[output] and setter and setter not in chart.active:
                return f"{setter} has switched it on, and {active} does not switch it off", f"{output} stays on"
            if not given[output] and setter not in chart.active and chart.active != (chart.initial,):
                return f"{active} does not switch it on; {waits}", f"{output} stays off, {cause}"
            break
        return waits, cause

    def _waits(self):
        """What the active steps wait for."""
        told, causes = [], []
        for step in self.chart.active:
            ways = [x.condition for x in self.chart.transitions if step in x.sources]
            told.append(f"{step} is active and waits for {' or '.join(ways)}" if ways else
                        f"{step} is active, and no transition leaves it")  # fmt: skip
            causes += [_nameless(way, step) for way in ways] or ["end"]
        return "; ".join(told), " or ".join(causes)


def _arrow(way):
    return f"{' + '.join(way.sources)} -> {' + '.join(way.targets)}"


def _nameless(condition, *steps):
    """A condition without the names of the steps, which every reader chooses."""
    for step in steps:
        condition = condition.replace(f"{step}.", "")
    return condition
