"""What every export needs of an asked quantity: the right answer, and the wrong ones that the exercise knows by name.

All of it is what the exercise declares, in the order and within the limits of `judging`; what a diagnosis finds out
from the answers to other quantities has no place in a fixed list.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from exercisebook import units
from exercisebook.credit import NOTHING, Credit, worth
from exercisebook.diagnoses.numbers import NARROWEST
from exercisebook.judging import MISTAKE, SAME, judge
from exercisebook.kinds import Kind, Number, Word
from exercisebook.kinds.numeric import NOTHING as TRACE
from exercisebook.kinds.numeric import ROUNDED
from exercisebook.question import Question


class CannotHoldError(Exception):
    """A kind of answers that a form of export has no place for."""


@dataclass(frozen=True)
class Known:
    """An answer that is known beforehand.

    Attributes:
        value: the answer as its kind reads it.
        says: the sentence on it, in which formulas are between dollars; empty for the right one.
        share: what it brings, in percent.
        low, high: between which a number is taken for it, both ends included.
        is_own: whether the exercise declares it; what its kind knows of any answer comes behind.
    """

    value: Any
    says: str = ""
    share: float = 100
    low: float = 0
    high: float = 0
    is_own: bool = True


@dataclass(frozen=True)
class Cell:
    """An asked quantity.

    Attributes:
        name, kind: as the key has them.
        weight: a whole number, beside those of the other quantities.
        known: the right answer, and then the wrong ones in the order in which they are looked for.
    """

    name: str
    kind: Kind
    weight: int
    known: tuple[Known, ...]


def cells(question: Question, credit: Credit = NOTHING) -> list[Cell]:
    """Return the asked quantities of a variant.

    Arguments:
        credit: what is worth something though it is not right.

    >>> from exercisebook.authoring import answers, between, exercise, number
    >>> @exercise("1.1", title="Force")
    ... def force(k=between(1, 9, "N/m", reference=3), x=between(1, 9, "m", reference=2)):
    ...     "A spring of {k} is longer by {x}. How large is the force?"
    ...     return answers(F=number(k * x, "N", "the force"))
    >>> @force.mistake("(50 %) That is the work.")
    ... def work(k, x):
    ...     return {"F": k * x**2}
    >>> [(one.value, one.share) for one in cells(force.question())[0].known]
    [(6.0, 100), (12.0, 50.0), (0.006, 0), (-6.0, 0)]
    """
    weights = [Fraction(question.exercise.weights.get(name, 1)).limit_denominator(100) for name in question.key]
    whole = Fraction(1)
    while any((whole * one).denominator > 1 for one in weights):
        whole += 1
    pairs = zip(question.key.items(), weights, strict=True)
    return [
        Cell(name, kind, int(whole * one), tuple(_known(question, name, kind, credit))) for (name, kind), one in pairs
    ]


def _known(question, name, kind, credit):
    """The right answer, and the wrong ones; of a number the intervals."""
    judged = functools.partial(_judged, question, name, kind, credit)
    if type(kind) is Number:
        within = kind.within * (abs(kind.key) or 1)
        yield Known(kind.key, low=kind.key - within, high=kind.key + within)
        declared = [kind.like(value).key for _, value in question.mistakes[name]]
        yield from _apart(kind, filter(None, map(judged, declared)))
        others = [units.convert(kind.key, kind.unit, to=unit) for unit in units.neighbours(kind.unit)]
        for value in [*others, -kind.key]:  # the most usual mistakes of numbers, where they are none of these
            for typed in dict.fromkeys([value, *_shorter(value, 2, 3)]):
                if found := judged(typed):
                    off = abs(value) * NARROWEST if typed == value and kind.within else 0.0
                    yield Known(typed, found.says, found.share, typed - off, typed + off)
    elif type(kind) is Word:
        yield Known(kind.key)
        yield from (judged(word) or Known(word, share=0) for word in kind.among if word != kind.key)
    else:
        yield Known(kind.key)
        for is_own, pairs in ((True, question.mistakes[name]), (False, kind.mistakes())):
            for sentence, value in pairs:
                share, says = worth(sentence)
                wrong = kind.like(value).key
                if not kind.agrees(wrong):
                    yield Known(
                        wrong, says, (credit.mistake if is_own else 0) if share is None else share, is_own=is_own
                    )


def _judged(question, name, kind, credit, wrong):
    """What is said of a wrong answer; None where that is no more than that it is wrong, or where it is right."""
    around = question.background.of(name, {name: wrong})
    found = judge(name, kind, wrong, question.mistakes[name], around, credit)
    return Known(wrong, found.says, found.percent) if found.status == MISTAKE else None


def _apart(kind, wrong):
    """Wrong numbers as intervals that do not overlap: each has what is nearer to it than to another one."""
    found: list[Known] = []
    for one in wrong:
        if all(abs(one.value - two.value) > SAME * abs(one.value) for two in found):
            found.append(one)
    for one in found:  # a number of few digits may be farther off
        for short in _shorter(one.value, 1, 2):
            near = [two for two in found if kind.is_value(short, two.value)]
            nearest = min(near, key=lambda two, short=short: abs(two.value - short), default=None)
            if nearest is one and abs(short - one.value) > _reach(kind, one.value) and not kind.agrees(short):
                yield Known(short, one.says, one.share, short, short)
    found.sort(key=lambda one: one.value)
    low = [one.value - _reach(kind, one.value) for one in found]
    high = [one.value + _reach(kind, one.value) for one in found]
    for k in range(len(found) - 1):
        if high[k] > low[k + 1]:
            middle = (found[k].value + found[k + 1].value) / 2
            high[k] = low[k + 1] = min(max(middle, low[k + 1]), high[k])
    for one, least, most in zip(found, low, high, strict=True):
        yield Known(one.value, one.says, one.share, least, most)


def _shorter(value, *digits):
    """A number rounded to so many digits."""
    return [float(f"{value:.{count}g}") for count in digits]


def _reach(kind, value):
    """By how much a number of many digits may be off the value of a mistake."""
    if kind.within == 0:
        return 0.0
    if value == 0:
        return TRACE * abs(kind.key)
    return abs(value) * (ROUNDED / 2 if kind.within <= ROUNDED else kind.within)
