"""Evidence: what decides a claim in words, with its numbers.

A book says "through a wall of twice the thickness less heat flows". The claim is a sentence, true or false; evidence is
what a computation has to say about it, and a check shows both:

>>> less(288, 576, "heat flow [W]")
holds: heat flow 288 W < 576 W

What cannot fail is no evidence. A truth value is refused, because it shows no number; so is a list without cases.
Words such as "much", "somewhat" or "in general" have one meaning in all chapters, in `evidence.criteria`, and evidence
that rests on one says so, and whether half or twice the limit would give another verdict. The quantity that it names
must be the one that the claim is about.
"""

from bookledger.evidence.cases import Cases, decreasing, every, increasing, most, some
from bookledger.evidence.comparisons import (
    Comparison,
    Evidence,
    Ratio,
    about_equal,
    at_least,
    at_most,
    different,
    equal,
    greater,
    less,
    much_greater,
    much_less,
    negative,
    negligible,
    nonzero,
    not_negligible,
    positive,
    roughly_equal,
    somewhat_greater,
    somewhat_less,
    visibly_greater,
    visibly_less,
    zero,
)
from bookledger.evidence.criteria import CRITERIA, Criterion
from bookledger.evidence.refusals import Refusal, refused
from bookledger.evidence.sides import EvidenceError

__all__ = [
    "CRITERIA", "Cases", "Comparison", "Criterion", "Evidence", "EvidenceError", "Ratio", "Refusal", "about_equal",
    "at_least", "at_most", "decreasing", "different", "equal", "every", "greater", "increasing", "less", "most",
    "much_greater", "much_less", "negative", "negligible", "nonzero", "not_negligible", "positive", "refused",
    "roughly_equal", "some", "somewhat_greater", "somewhat_less", "visibly_greater", "visibly_less", "zero",
]  # fmt: skip
