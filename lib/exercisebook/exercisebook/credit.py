"""What an answer is worth that is not right, by the author's word: a part of the points of its quantity."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass

#: How the sentence of a mistake begins that is worth something, as "(50 %) The gain is missing."
_WORTH = re.compile(r"\((\d{1,2}) ?%\) ")
_WORDS = {
    "unit": "the right number in another unit",
    "follows": "what follows in the right way from a wrong number before it",
    "mistake": "a mistake that the exercise knows by name",
}


@dataclass(frozen=True)
class Credit:
    """Percent of the points of a quantity that an answer brings which is not right.

    Arguments:
        unit: the right number in another unit than is asked.
        follows: what follows in the right way from a wrong number before it.
        mistake: a mistake that the exercise knows, where its own sentence says nothing else.
    Raises:
        ValueError: for what is no percentage below 100.

    >>> Credit(unit=50).says
    'Of the points of a quantity, the right number in another unit brings 50 %.'
    """

    unit: float = 0
    follows: float = 0
    mistake: float = 0

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 100:
                raise ValueError(f"credit for {name} is {value!r}: expected percent of the points, from 0 to 99")

    @property
    def says(self) -> str:
        """A sentence for students; empty where nothing but a right answer brings points."""
        given = [(_WORDS[name], value) for name, value in asdict(self).items() if value]
        if not given:
            return ""
        (first, much), *others = given
        more = "".join(f", and {what} {value:g} %" for what, value in others)
        return f"Of the points of a quantity, {first} brings {much:g} %{more}."


NOTHING = Credit()


def worth(sentence: str) -> tuple[float | None, str]:
    """Return what the sentence of a mistake says that it is worth, in percent or None, and the sentence without it.

    >>> worth("(50 %) The gain is missing."), worth("The gain is missing.")
    ((50.0, 'The gain is missing.'), (None, 'The gain is missing.'))
    """
    found = _WORTH.match(sentence)
    return (float(found[1]), sentence[found.end() :]) if found else (None, sentence)
