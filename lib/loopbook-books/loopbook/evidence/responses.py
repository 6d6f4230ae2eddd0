"""Evidence about step responses: overshoot and damping."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bookledger.evidence.comparisons import Comparison, within
from bookledger.evidence.sides import numbers
from loopbook.evidence.criteria import NO_OVERSHOOT, WELL_DAMPED

if TYPE_CHECKING:
    from plainmath.types import Number


def no_overshoot(overshoot: Number, quantity: str = "overshoot") -> Comparison:
    """Evidence that a step response stays below 102 percent of the step.

    Arguments:
        overshoot: as a fraction of the step.
        quantity: its name, where a book speaks of more than one.

    >>> no_overshoot(0.013)
    holds: overshoot 1.3 % ≤ 2 % (no overshoot: at most 2 % of the step)
    """
    (share,) = numbers(overshoot)
    return within(100 * share, quantity, "%", NO_OVERSHOOT)


def overshoots(overshoot: Number, quantity: str = "overshoot") -> Comparison:
    """Evidence that a step response rises above 102 percent of the step; `overshoot` is a fraction of the step.

    >>> overshoots(0.28).holds
    True
    """
    return no_overshoot(overshoot, quantity).turned()


def well_damped(decay_ratio: Number, quantity: str = "decay ratio") -> Comparison:
    """Evidence that each peak of a response is at most a quarter of the one before it.

    >>> well_damped(0.11).holds, well_damped(0.4).holds
    (True, False)
    """
    (ratio,) = numbers(decay_ratio)
    return within(ratio, quantity, "", WELL_DAMPED)


def poorly_damped(decay_ratio: Number, quantity: str = "decay ratio") -> Comparison:
    """Evidence that a peak of a response is more than a quarter of the one before it.

    >>> poorly_damped(0.4)
    holds: decay ratio 0.4 > 0.25 (well damped: a decay ratio of at most 1/4)
    """
    return well_damped(decay_ratio, quantity).turned()
