"""What words of degree mean in numbers: one home for "about the same", "somewhat", "much", "may", "in general".

A book says that one value is much larger, that a response may oscillate. Such a word stays with the claim, as its
`degree`, and each has one `Criterion` for every row of every book, with a limit and a reason that is none of those
rows. Evidence that rests on a criterion shows it, and says that it is a near thing if half or twice the limit gave
another verdict.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

__all__ = ["CRITERIA", "Criterion", "of_degree"]


@dataclass(frozen=True)
class Criterion:
    """A word, the limit that it stands for, and why that one.

    Attributes:
        word: as it is used in a sentence.
        limit: a number, in the unit that `meaning` says.
        meaning: the criterion in a few words.
        reason: where the limit comes from.
        published: whether it is a usual one of the literature; otherwise it is ours.
        degrees: the words of a book for which it stands.
    """

    word: str
    limit: Fraction
    meaning: str
    reason: str
    published: bool
    degrees: tuple[str, ...] = ()


SAME = Criterion(
    "about equal",
    Fraction(5, 100),
    "at most 5 % of the larger one apart",
    "the band of 5 % within which a response counts as settled; the eye sees no less in a printed plot",
    published=True,
    degrees=("about", "approximately", "nearly", "almost", "similar"),
)
NEGLIGIBLE = Criterion(
    "negligible",
    Fraction(5, 100),
    "at most 5 % of what it is compared with",
    "the band of 5 % within which a response counts as settled",
    published=True,
    degrees=("negligible", "hardly", "little"),
)
VISIBLY = Criterion(
    "visibly",
    Fraction(5, 100),
    "more than 5 % of the larger one apart",
    "the band of 5 % within which a response counts as settled: what seems so in a plot differs by more",
    published=True,
    degrees=("seems", "seem"),
)
SOMEWHAT = Criterion(
    "somewhat",
    Fraction(1, 2),
    "by less than half of the smaller one, and by more than the 5 % that are about equal",
    "a number of ours: less than much, and more than about equal",
    published=False,
    degrees=("somewhat", "slightly", "a little"),
)
ROUGHLY = Criterion(
    "roughly equal",
    Fraction(1, 2),
    "less than half of the smaller one apart",
    "a number of ours, where much begins",
    published=False,
    degrees=("roughly",),
)
MUCH = Criterion(
    "much",
    Fraction(1, 2),
    "by half of the smaller one or more",
    "a number of ours: no book says how much that is; half is where a plot looks like another one",
    published=False,
    degrees=("much", "considerably", "clearly", "substantially"),
)
MAY = Criterion(
    "may",
    Fraction(1),
    "in one case at least",
    "what may happen has happened once",
    published=False,
    degrees=("may", "can", "sometimes"),
)
GENERALLY = Criterion(
    "in general",
    Fraction(1, 2),
    "in more than half of the cases",
    "what happens in general has exceptions, but not as many as cases",
    published=False,
    degrees=("in general", "often", "usually"),
)
#: All criteria, as a page can list them; what a subject adds is here as well.
CRITERIA = [SAME, NEGLIGIBLE, VISIBLY, SOMEWHAT, ROUGHLY, MUCH, MAY, GENERALLY]


def of_degree(word: str) -> Criterion | None:
    """Return the criterion of a book's word of degree, None where the word has none.

    >>> of_degree("considerably").word
    'much'
    """
    return next((criterion for criterion in CRITERIA if word in criterion.degrees), None)
