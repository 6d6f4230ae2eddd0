"""What words of degree mean in numbers: one home for "about the same", "negligible", "much".

A book says that one value is much larger, that two curves are nearly the same. Each such word is a `Criterion` with
a limit and a reason. Evidence that rests on one shows it, and says that it is a near
thing if half or twice the limit gave another verdict.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

__all__ = ["CRITERIA", "Criterion"]


@dataclass(frozen=True)
class Criterion:
    """A word, the limit that it stands for, and why that one.

    Attributes:
        word: as it is used in a sentence.
        limit: a number, in the unit that `meaning` says.
        meaning: the criterion in a few words.
        reason: where the limit comes from.
        published: whether it is a usual one of the literature; otherwise it is ours.
    """

    word: str
    limit: Fraction
    meaning: str
    reason: str
    published: bool


SAME = Criterion(
    "about equal",
    Fraction(5, 100),
    "at most 5 % of the larger one apart",
    "the band of 5 % within which a response counts as settled; the eye sees no less in a printed plot",
    published=True,
)
NEGLIGIBLE = Criterion(
    "negligible",
    Fraction(5, 100),
    "at most 5 % of what it is compared with",
    "the band of 5 % within which a response counts as settled",
    published=True,
)
ROUGHLY = Criterion(
    "roughly equal",
    Fraction(1, 2),
    "less than half of the smaller one apart",
    "a number of ours, where much begins",
    published=False,
)
MUCH = Criterion(
    "much",
    Fraction(1, 2),
    "by half of the smaller one or more",
    "a number of ours: no book says how much that is; half is where a plot looks like another one",
    published=False,
)
SUBSTANTIALLY = Criterion(
    "substantially",
    Fraction(1, 5),
    "to a fifth or less",
    "a number of ours: where one improvement is called substantial and another one is not, a fifth parts the two",
    published=False,
)
#: All criteria, as a page can list them; what a subject adds is here as well.
CRITERIA = [SAME, NEGLIGIBLE, ROUGHLY, MUCH, SUBSTANTIALLY]
