"""What a simulation returns: signals by their names, and what a later run needs in order to go on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.plants import Plant, name_of
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.simulation.integrator import PlantIntegrator
    from loopbook.structures import Structure

__all__ = ["Run"]

LIKE_THE_MEASUREMENT = ("setpoint", "measurement", "ramped", "filtered")  # what a loop records in its unit
LIKE_THE_OUTPUT = ("u_p", "u_i", "u_d", "feedforward")  # what adds up to the control signal


class Past(NamedTuple):
    """What a later run needs in order to go on: the plant with its history, and the blocks with their memory."""

    integrator: PlantIntegrator
    structure: Structure


@dataclass(frozen=True, repr=False)
class Run:
    """What `simulate` returns: named signals at the sampling times.

    Attributes:
        times: the moments, an array, in the plant's unit of time.
        signals: ``{name: array}``, one value for each moment.
        plant: the plant, which knows the units.
        manipulated: the name of the input that the controller acts on.
        held: the names of the signals that are constant from one sample to the next.
        measured: the name of the controlled signal, the plant's output if not said.
    """

    times: np.ndarray
    signals: dict[str, np.ndarray]
    plant: Plant
    manipulated: str
    held: set[str]
    measured: str | None = None
    _past: Past | None = None

    @property
    def output(self) -> str:
        """The name of the controlled signal."""
        return self.measured or name_of(self.plant.output)

    @property
    def time_unit(self) -> str:
        """The unit of the times: the plant's."""
        return self.plant.time_unit

    def unit(self, name: str) -> str:
        """The unit of a signal of the plant or of a loop; "1" for a number.

        Setpoints have that of the measurement, the terms of a controller that of the control signal. Raises ValueError
        for a name that is not a signal of the run or the plant.
        """
        of_plant = {name_of(x) for x in self.plant.quantities}
        if self._past and name not in of_plant and name in self.signals:
            structure = self._past.structure
            tag, _, own = name.rpartition(".")
            if tag in structure.loops:
                return self.loop(tag).unit(own)
            if name in LIKE_THE_MEASUREMENT:
                name = self.output
            elif name in LIKE_THE_OUTPUT:
                of_output = [loop.controller for loop in structure.loops.values() if loop.output == self.manipulated]
                if any(getattr(controller, "from_percent", None) for controller in of_output):
                    return "%"
                name = self.manipulated
            while name in structure.measurement_of and name not in of_plant:
                name = structure.measurement_of[name]
            if name not in of_plant:
                return "%" if name in structure.split else "1"
        return self.plant.quantities[self.plant.signal(name)].unit or "1"

    def loop(self, tag: str) -> Run:
        """Return the run as one loop of a control structure sees it, for `figures.trends` and the like.

        Raises ValueError for a tag that no loop has.
        """
        loops = self._past.structure.loops if self._past else {}
        if tag not in loops:
            raise ValueError(f"the run has no loop {tag!r}: {did_you_mean(tag, loops)}")
        own = {name.removeprefix(f"{tag}."): name for name in self.signals if name.startswith(f"{tag}.")}
        signals = self.signals | {name: self.signals[full] for name, full in own.items()}
        held = self.held | {name for name, full in own.items() if full in self.held}
        return replace(self, signals=signals, held=held, manipulated=loops[tag].output, measured=loops[tag].measurement)

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.signals:
            raise ValueError(f"the run has no signal {name!r}: {did_you_mean(name, self.signals)}")
        return self.signals[name]

    def __repr__(self) -> str:
        return (
            f"<run of {len(self.times)} samples, t = {self.times[0]:g} to {self.times[-1]:g}: "
            f"{', '.join(self.signals)}>"
        )


def joined(earlier: Run, later: Run) -> Run:
    """Two runs as one; what only one of them has is NaN in the other. The moment where they meet is the later one's."""

    def part(run, name, length):
        return run.signals[name][:length] if name in run.signals else np.full(length, np.nan)

    shorter, names = len(earlier.times) - 1, [*earlier.signals, *later.signals]
    signals = {
        name: np.concatenate([part(earlier, name, shorter), part(later, name, len(later.times))])
        for name in dict.fromkeys(names)
    }
    times = np.concatenate([earlier.times[:-1], later.times])
    held = later.held - (set(earlier.signals) - earlier.held)
    return replace(later, times=times, signals=signals, held=held)
