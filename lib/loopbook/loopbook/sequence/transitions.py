"""A transition: the steps before it, the steps after it, and the condition on which it is cleared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

__all__ = ["Transition"]


@dataclass(frozen=True)
class Transition:
    """A way from one or several steps to one or several others.

    Arguments:
        sources: the step before it; a tuple of steps ends simultaneous branches, all of which must be active.
        targets: the step after it; a tuple of steps begins simultaneous branches.
        condition: a text, as `Formula` reads it; "TRUE" makes the transition unconditional.

    >>> Transition("Fill", "Heat", "h >= 0.9")
    T_Fill_Heat: h >= 0.9
    >>> Transition(("Heat", "Dose"), "Discharge").name
    'T_Heat_Dose_Discharge'
    """

    sources: tuple[str, ...]
    targets: tuple[str, ...]
    condition: str = "TRUE"

    if TYPE_CHECKING:  # what is given, where what is kept is of one kind

        def __init__(
            self, sources: str | Sequence[str], targets: str | Sequence[str], condition: str | bool = "TRUE"
        ): ...

    def __post_init__(self) -> None:
        for side in ("sources", "targets"):
            steps = getattr(self, side)
            steps = tuple(steps) if isinstance(steps, (list, tuple)) else (steps,)
            if not steps or not all(isinstance(step, str) for step in steps):
                raise ValueError(f"the {side} of a transition are {steps!r}: expected the names of steps")
            if twice := [step for step in steps if steps.count(step) > 1]:
                raise ValueError(f"a transition has the step {twice[0]} twice among its {side}")
            object.__setattr__(self, side, steps)
        if isinstance(self.condition, bool):
            object.__setattr__(self, "condition", str(self.condition).upper())

    @property
    def name(self) -> str:
        """How the book names it: T_Step1_Step2."""
        return "_".join(["T", *self.sources, *self.targets])

    def __repr__(self) -> str:
        return f"{self.name}: {self.condition}"
