"""A control structure while it runs: the order of its blocks, their signals, and what they remember."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Mapping

import numpy as np

from loopbook.signals import beyond_all_numbers, by_hand, is_given, noise, samples
from loopbook.structures.blocks import ControlLoop, SplitRange
from loopbook.types import Block, ManualStretches, Signal
from plainmath.validation import is_number

__all__ = ["Structure"]


class Structure:
    """The blocks of a control structure while they run on a plant; `simulation.simulate` makes and drives it.

    Arguments:
        blocks: a list of blocks.
        of_plant: the names of the plant's states and measured signals.
        inputs: the names of the plant's inputs.
    Raises:
        ValueError: for two blocks with the same tag or the same output, or one that would write what the plant says.
    """

    loops: dict[str, ControlLoop]
    driven: list[str]
    external: list[str]

    def __init__(self, blocks: Iterable[Block], of_plant: Iterable[str], inputs: Iterable[str]):
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
        self.driven = [name for name in writer if name in self.inputs]
        self._external(writer)  # refuses an inner loop before its outer one
        self.loops = {block.tag: block for block in self.blocks if isinstance(block, ControlLoop)}
        for loop in reversed(self.loops.values()):  # from the inside out, since outer loops come first
            behind = [inner for inner in self.loops.values() if inner.setpoint == loop.output]
            if len(behind) == 1:  # of two loops with one setpoint neither is to be followed
                (loop.inner,) = behind
                loop.reads += loop.inner.following
            loop.following = tuple(x for x in (loop.measurement, loop.mode) if x) + loop.following
        self.external = self._external(writer)  # now with what an outer loop must know of its inner one

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
    def measurement_of(self) -> dict[str, str]:
        """``{setpoint: measurement}``, for the names that are setpoints."""
        return {loop.setpoint: loop.measurement for loop in self.loops.values() if not is_number(loop.setpoint)}

    @property
    def split(self) -> list[str]:
        """The names of the signals that are shared out among actuators."""
        return [block.signal for block in self.blocks if isinstance(block, SplitRange)]

    @property
    def step(self) -> float | None:
        """The shortest step of its blocks, None if none has one."""
        return min((float(block.step) for block in self.blocks if block.step is not None), default=None)

    def prepare(
        self,
        times: np.ndarray,
        signals: Mapping[str, Signal],
        added_noise: Signal | Mapping[str, Signal],
        seed: int,
        manual: ManualStretches | Mapping[str, ManualStretches],
    ) -> None:
        """Take the external signals, the noise and the stretches in manual mode for the moments of a run."""
        for name in signals:
            if name not in self.external:
                raise ValueError(f"{name} is given, but no block reads it and the plant has no such input")
        missing = [name for name in self.external if signals.get(name) is None]
        if missing:
            reader = next(block.tag for block in self.blocks if missing[0] in block.reads)
            raise ValueError(f"{reader} reads {missing[0]}, which nobody gives: expected {missing[0]}=...")
        self.times, self.interval, self.before_last = times, times[1] - times[0], None
        self.k, self.k0, self.values = 0, 0, {}
        self.beginning = {}  # the loops that begin as after manual mode, with their last outputs as far as known
        self.signals = {name: samples(name, signals[name], times) for name in self.external}
        self.noise, self.by_hand = self._noise(added_noise, seed), self._by_hand(manual)
        self.every = {block.tag: self._every(block, self.interval) for block in self.blocks}
        written = dict.fromkeys(name for block in self.blocks for name in block.writes)
        self.seen = {name: [] for name in (*written, *self.external) if name not in self.driven}
        self.rows = {block.tag: [] for block in self.blocks}  # what each block records, a dictionary for each sample

    def _noise(self, added, seed):
        if not is_given(added):
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
        manual = manual if is_given(manual) else {}
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

    def continue_after(self, earlier: Structure, last: Mapping[str, float]) -> None:
        """Take over the memory of an earlier run's blocks; without one, loops begin from the last control signals."""
        before = earlier.before_last or {}
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
            self.k0 = round(earlier.phase * earlier.interval / self.interval)
            self.values = {name: earlier.values[name] for block in earlier.blocks for name in block.writes}

    def seen_by(self, tag: str) -> dict[str, list[float]]:
        """The record of one loop, its signals by their own names, "setpoint" and the like."""
        return {name.removeprefix(f"{tag}."): x for name, x in self.record.items() if name.startswith(f"{tag}.")}

    @property
    def phase(self) -> int:
        """How many samples have passed at the beginning of the last one."""
        return self.k0 + self.k - 1

    def sample(self, readings: dict[str, float]) -> dict[str, float]:
        """Run the blocks once on the plant's signals of this moment, and return ``{input: value}``."""
        k, self.k = self.k, self.k + 1
        time = self.times[k]
        if self.k == len(self.times):  # a run that goes on from here begins with this sample, maybe with other settings
            self.before_last = {block.tag: copy.deepcopy(block) for block in self.blocks}
        for name, added in self.noise.items():
            readings[name] += added[k]
        values = readings | {name: signal[k] for name, signal in self.signals.items()}
        for tag, output in self.by_hand.items():
            self.loops[tag].operator = output[k]
        for block in self.blocks:
            if (self.k0 + k) % self.every[block.tag] == 0 or any(name not in self.values for name in block.writes):
                if block.tag in self.beginning:
                    self._begin(block, values)
                values |= self._checked(block, block.update(values, time), time)
            else:
                values |= {name: self.values[name] for name in block.writes}
            self.rows[block.tag].append(block.recorded)
        self.values = values
        for name, seen in self.seen.items():
            seen.append(values[name])
        return {name: values[name] for name in self.driven}

    @property
    def record(self) -> dict[str, list[float]]:
        """The signals of the run so far, but for the plant's: what the blocks record, write, and read from outside."""
        recorded = {
            f"{tag}.{name}": [row[name] for row in rows]
            for tag, rows in self.rows.items()
            for name in (rows[0] if rows else ())
        }
        return recorded | self.seen

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
            if type(value) is not float or not math.isfinite(value):
                if isinstance(value, float) and not math.isfinite(value):
                    raise beyond_all_numbers(name, time)
                if not is_number(value) and not isinstance(value, bool):
                    raise ValueError(f"{block.tag} gives {name} = {value!r} at t = {time:g}: expected a finite number")
                written = written | {name: float(value)}
        return written
