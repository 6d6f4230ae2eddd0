"""Names for what many functions take, as their type hints write it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol, TypeAlias, Union

import sympy

from plainmath.types import Number

if TYPE_CHECKING:
    import control
    import numpy as np

__all__ = [
    "Block", "HasTransferFunction", "Limits", "ManualStretches", "Number", "SampledController", "Signal",
    "TransferFunctionLike", "Values",
]  # fmt: skip

#: A signal in time: a number, an expression in `t`, or an array with a value for each sample.
Signal: TypeAlias = Union[Number, Sequence[float], "np.ndarray"]

#: Numbers in a row, such as the moments of a plot.
Values: TypeAlias = Union[Sequence[Number], "np.ndarray"]

#: The lowest and the highest value of an axis.
Limits: TypeAlias = tuple[Number, Number]

#: What `transfer_function` reads: an expression in `s`, a number, a `PID`, an `SOPDT`, a `System`, python-control's.
TransferFunctionLike: TypeAlias = Union[Number, "HasTransferFunction", "control.TransferFunction", "control.StateSpace"]

#: Stretches of time in manual mode: (beginning, end, control signal), None for the last control signal.
ManualStretches: TypeAlias = Sequence[tuple[Number, Number, Number | None]]


class HasTransferFunction(Protocol):
    """What has a transfer function, an expression in `s`, as its attribute `expr`."""

    @property
    def expr(self) -> sympy.Expr:
        """The transfer function."""


class SampledController(Protocol):
    """What can stand for a `pid.Controller`: it runs once a sample."""

    @property
    def step(self) -> float:
        """The time between two samples."""

    def update(
        self, setpoint: float, measurement: float, feedforward: float = 0.0, manual: float | None = None
    ) -> float:
        """Take the signals of a sample and return the control signal.

        In manual mode `manual` is the operator's, or `pid.HOLD`, a NaN, to keep the last one; else it is None.
        """


class Block(Protocol):
    """A block of a control structure: a loop, a calculation, a split range, a chart."""

    tag: str
    reads: tuple[str, ...]
    writes: tuple[str, ...]

    @property
    def step(self) -> Number | None:
        """The time between two runs; None for every sample."""

    @property
    def recorded(self) -> Mapping[str, float]:
        """Further signals of the last sample, by names of the block's own: a run calls them "tag.name"."""

    def update(self, values: Mapping[str, float], time: float) -> dict[str, float]:
        """Run once on the signals of a moment and return what it writes."""
