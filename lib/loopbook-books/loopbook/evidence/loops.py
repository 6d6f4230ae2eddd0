"""Evidence about systems and loops: stable or not, with the margins that say how far from the limit."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from bookledger.evidence.cases import Cases, every
from bookledger.evidence.comparisons import Comparison, Evidence
from bookledger.evidence.sides import EvidenceError, Typeset, numbers, rounded
from bookledger.evidence.values import in_one_line
from loopbook.evidence.criteria import GAIN_MARGIN, PHASE_MARGIN
from loopbook.stability import StabilityLimitError, margins, unstable_poles

_CLOSE = 1.05  # a stable loop that 5 percent more gain makes unstable is so by a near thing


@dataclass(frozen=True, repr=False)
class Stability(Evidence):
    """Whether a system is stable.

    Attributes:
        is_stable: whether it is said to be.
        unstable_poles: how many poles are in the right half-plane; nan for a system on the limit.
        margins: (gain margin, phase margin in degrees, Ms, gain reduction) of a stable loop; empty for what is none.
        quantity: of what the stability is.
    """

    is_stable: bool
    unstable_poles: float
    margins: tuple[float, ...] = ()
    quantity: str = "stability"

    @property
    def quantities(self) -> frozenset[str]:
        """Of what the stability is."""
        return frozenset({self.quantity})

    @property
    def holds(self) -> bool:
        """Whether it is as said; a system on the limit is neither stable nor unstable."""
        return self.unstable_poles == 0 if self.is_stable else self.unstable_poles > 0

    @property
    def near(self) -> bool:
        """Whether a few percent of gain, up or down, would make a stable loop unstable."""
        return bool(self.margins) and (self.margins[0] < _CLOSE or self.margins[3] * _CLOSE > 1)

    def turned(self) -> Stability:
        """The contrary of what is said."""
        return replace(self, is_stable=not self.is_stable)

    def told(self, typeset: Typeset = str) -> str:
        """The margins of what is stable, the number of unstable poles of what is not."""
        if math.isnan(self.unstable_poles):
            return "on the limit of stability: poles on the imaginary axis"
        if self.unstable_poles:
            poles = rounded(Fraction(self.unstable_poles) if self.unstable_poles < math.inf else math.inf)
            return f"unstable: {poles} {'pole' if poles == '1' else 'poles'} in the right half-plane"
        if not self.margins:
            return "stable: no pole in the right half-plane"
        gain, phase, Ms = (rounded(x if x == math.inf else Fraction(x)) for x in self.margins[:3])
        return f"stable: gain margin {gain}, phase margin {phase}°, Ms {Ms}"

    @property
    def data(self) -> dict[str, Any]:
        """The number of poles and the margins."""
        poles = "nan" if math.isnan(self.unstable_poles) else f"{self.unstable_poles:g}"
        return {
            "kind": "stability", "is_stable": self.is_stable, "unstable_poles": poles,
            "margins": [f"{x:.6g}" for x in self.margins], "holds": self.holds, "near": self.near,
        }  # fmt: skip


def stable(system: object, quantity: str = "stability") -> Stability:
    """Evidence that a system or a loop is stable, with the margins of a loop.

    Arguments:
        system: a `Loop`, a `System` or a transfer function with numbers.
        quantity: of what the stability is, where a book says it of more than one loop.
    Raises:
        ValueError: as `stability.unstable_poles`.

    >>> from loopbook import PID, Loop, s
    >>> stable(Loop(1 / (5 * s + 1) ** 2, PID(2, Ti=8)))
    holds: stable: gain margin ∞, phase margin 54°, Ms 1.46
    >>> stable(1 / (s - 1))
    does not hold: unstable: 1 pole in the right half-plane
    """
    if hasattr(system, "nstates"):
        raise EvidenceError("a model in state space may have modes that no input or output sees: expected its matrix A")
    try:
        count = unstable_poles(system)
    except StabilityLimitError:
        return Stability(True, math.nan, quantity=quantity)
    except ArithmeticError as error:
        raise EvidenceError(f"whether {in_one_line(repr(system))[:60]} is stable is not known: {error}") from None
    if count or not hasattr(system, "margins"):
        return Stability(True, count, quantity=quantity)
    return Stability(True, 0, _margins(system), quantity)


def _margins(loop):
    found = margins(loop)
    return found.gain_margin, found.phase_margin, found.Ms, found.gain_reduction


def unstable(system: object, quantity: str = "stability") -> Stability:
    """Evidence that a system or a loop has poles in the right half-plane; otherwise as `stable`.

    >>> from loopbook import s
    >>> unstable(1 / (s - 1))
    holds: unstable: 1 pole in the right half-plane
    """
    return stable(system, quantity).turned()


def good_stability(loop: object, of: str = "") -> Cases:
    """Evidence that a loop has a gain margin of at least 2 and a phase margin of at least 30 degrees.

    Arguments:
        loop: as for `stable`.
        of: the loop in a word, where a book says it of more than one.

    >>> from loopbook import PID, Loop, s
    >>> good_stability(Loop(1 / (s * (s + 1) ** 2), PID(0.5)))
    holds: gain margin 4 ≥ 2 (good stability: a gain margin of at least 2); phase margin 44.1° ≥ 30° (good stability: a phase margin of at least 30 degrees)
    """  # noqa: E501
    of = f" {of}" if of else ""
    found = stable(loop, f"stability{of}")
    if found.unstable_poles > 0:
        return every(found)
    if found.holds and not found.margins:
        raise EvidenceError(f"{in_one_line(repr(loop))[:60]} has no margins: expected a Loop")
    # on the limit of stability nothing is left
    gain, phase = numbers(*found.margins[:2]) if found.margins else (Fraction(1), Fraction(0))
    return every(
        Comparison(gain, "≥", GAIN_MARGIN.limit, f"gain margin{of}", "", GAIN_MARGIN),
        Comparison(phase, "≥", PHASE_MARGIN.limit, f"phase margin{of}", "°", PHASE_MARGIN),
    )


def poor_stability(loop: object, of: str = "") -> Cases:
    """Evidence that a loop misses what `good_stability` asks for, or is not stable.

    >>> from loopbook import PID, Loop, s
    >>> poor_stability(Loop(1 / (s * (s + 1) ** 2), PID(3))).holds
    True
    """
    return Cases(tuple((name, case.turned()) for name, case in good_stability(loop, of).cases), "some")
