"""What the words of control engineering mean in numbers: "no overshoot", "well damped", "good stability"."""

from __future__ import annotations

from fractions import Fraction

from bookledger.evidence.criteria import CRITERIA, Criterion

NO_OVERSHOOT = Criterion(
    "no overshoot",
    Fraction(2),
    "at most 2 % of the step",
    "the band of 2 % within which a response counts as settled",
    published=True,
)
WELL_DAMPED = Criterion(
    "well damped",
    Fraction(1, 4),
    "a decay ratio of at most 1/4",
    "quarter decay, the least damping that published rules aim at",
    published=True,
)
GAIN_MARGIN = Criterion(
    "good stability",
    Fraction(2),
    "a gain margin of at least 2",
    "the usual lower limit of textbooks",
    published=True,
)
PHASE_MARGIN = Criterion(
    "good stability",
    Fraction(30),
    "a phase margin of at least 30 degrees",
    "the usual lower limit of textbooks",
    published=True,
)

CRITERIA += [NO_OVERSHOOT, WELL_DAMPED, GAIN_MARGIN, PHASE_MARGIN]
