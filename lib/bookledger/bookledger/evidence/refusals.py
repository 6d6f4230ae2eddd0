"""Evidence that something cannot be done: a function declines, and says why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from bookledger.evidence.comparisons import Evidence
from bookledger.evidence.sides import EvidenceError, Typeset
from bookledger.evidence.values import in_one_line


@dataclass(frozen=True, repr=False)
class Refusal(Evidence):
    """What a function said when it declined; empty where it did not.

    Attributes:
        sentence: of the error.
        is_refused: whether it is said to decline.
        function: the name of what was called, which is what the evidence is about.
    """

    sentence: str
    is_refused: bool = True
    function: str = ""

    @property
    def holds(self) -> bool:
        """Whether the function declined."""
        return bool(self.sentence) is self.is_refused

    near = False

    @property
    def quantities(self) -> frozenset[str]:
        """What was asked for."""
        return frozenset({self.function})

    def turned(self) -> Refusal:
        """The contrary: that it is accepted."""
        return replace(self, is_refused=not self.is_refused)

    def told(self, typeset: Typeset = str) -> str:
        """The sentence of the error."""
        return f"declined: {self.sentence}" if self.sentence else "accepted"

    @property
    def data(self) -> dict[str, Any]:
        """The sentence."""
        return {"kind": "refusal", "sentence": self.sentence, "is_refused": self.is_refused, "holds": self.holds,
                "near": False}  # fmt: skip


def refused(function: Callable[..., Any], *arguments: Any, **named: Any) -> Refusal:
    """Evidence that something cannot be done: a function declines with a sentence.

    Arguments:
        function: that declines by a ValueError.
        arguments, named: what it is called with.
    Raises:
        EvidenceError: for what cannot be called, and as other evidence that is asked for in it.

    >>> import math
    >>> refused(math.sqrt, -1).holds
    True
    """
    if not callable(function):
        raise EvidenceError(f"{function!r:.60} cannot be called: expected a function, and its arguments after it")
    name = getattr(function, "__name__", type(function).__name__)
    try:
        function(*arguments, **named)
    except EvidenceError:
        raise
    except ValueError as error:
        return Refusal(in_one_line(str(error)) or type(error).__name__, function=name)
    return Refusal("", function=name)
