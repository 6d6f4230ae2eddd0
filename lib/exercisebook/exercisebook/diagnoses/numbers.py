"""Mistakes in a number, as a table: a sentence, and the wrong value that it makes.

The order of `TABLE` decides where two mistakes make the same value: what happens more often, and what can hardly be
true by chance, comes first. A value is recognised within half a unit of the last digit that the reader gives.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from decimal import Decimal

import numpy as np

from exercisebook import units
from exercisebook.diagnoses.background import Amount, Background, follows
from exercisebook.diagnoses.finding import Finding, explained
from exercisebook.diagnoses.own_formulas import of_formulas
from exercisebook.kinds import Number
from exercisebook.kinds.numeric import in_unit

#: A value is recognised within this fraction of it, however many digits the answer has, and never beyond the other.
NARROWEST, WIDEST = 0.001, 0.006
#: What is true of many numbers by chance is said of those with so many digits, and within half a unit of the last one
#: or these fractions; of fewer digits only where it is the very value.
ENOUGH_DIGITS, NEAREST, NEAR_ENOUGH, EXACTLY = 3, 0.0004, 0.0021, 1e-6
#: What follows from a rounded number is recognised within this fraction at most.
CARRIED = 0.012
#: Whole numbers without unit up to this are taken for counts.
MOST = 12
#: An answer that is off by less than this is in the neighbourhood of the right one.
NEARBY = 0.05
#: A rounded answer is off by less than this.
ROUNDED = 0.3


#: A wrong value and the sentence for it.
Wrong = tuple[float, str]


@dataclass(frozen=True)
class Case:
    """A number that is asked for, and what is around it.

    Attributes:
        key, unit, within: of the number.
        asked: the quantity in words, with its unit.
        others: the other numbers that are asked for.
        givens: the numbers that are given.
        changed: pairs of the number that comes out with a change of the givens, either a likely change (True) or
            another one, and a sentence.
        before: a wrong number before it, in words, on which it depends; empty where there is none.
        carried: pairs of the number that follows from a wrong one before it, and a sentence.
    """

    key: float
    unit: str
    asked: str
    within: float = 0.01
    others: list[Amount] = field(default_factory=list)
    givens: list[Amount] = field(default_factory=list)
    changed: Callable[[bool], Iterator[Wrong]] = lambda _: iter(())
    before: str = ""
    carried: Callable[[], Iterator[Wrong]] = lambda: iter(())

    def is_count(self, answer: float) -> bool:
        """Whether the number is exact, or both it and an answer look like small counts."""
        whole = self.unit == "" and all(float(one).is_integer() and abs(one) <= MOST for one in (self.key, answer))
        return self.within == 0 or whole


@dataclass(frozen=True)
class Mistake:
    """A mistake that can be made in any number.

    Attributes:
        name: of the mistake.
        wrongs: function of a `Case` that gives the wrong values, each with its sentence.
        is_rare: whether it is made so seldom that a number of two digits is more likely equal to it by chance.
        is_rarest: whether even the very value says nothing where it has few digits.
        is_plain: whether it is made with a number that is as near to the right one as is asked.
    """

    name: str
    wrongs: Callable[[Case], Iterator[Wrong]]
    is_rare: bool = False
    is_rarest: bool = False
    is_plain: bool = False


def found_in(answer: float, case: Case, agrees: Callable[[float], bool] | None = None) -> Finding | None:
    """Return the mistake in a wrong number; the nearest ones before those within its rounding.

    >>> case = Case(12, "s", "the period, in s", givens=[Amount(4, "s", "4 s"), Amount(3, "", "3")])
    >>> found_in(4, case).says
    'that is the same number as the 4 s of the question: how does one get from there to the period, in s?'
    >>> found_in(17.9, case)
    """
    agrees = agrees or (lambda wrong: abs(wrong - case.key) <= case.within * abs(case.key))
    if case.is_count(answer):  # nearly any count is something of the givens by chance
        return _in_tables(answer, case, agrees, (TABLE,))
    found = (
        _in_tables(answer, case, agrees, (TABLE,))
        or _carried_on(answer, case, agrees)
        or _in_tables(answer, case, agrees, (GIVENS,))
        or _rounded(answer, case)
        or _in_tables(answer, case, agrees, (FACTORS,))
        or _plain(answer, case, agrees)
        or _in_tables(answer, case, agrees, (MORE,))
    )
    if not found and answer * case.key < 0:
        beside = _in_tables(-answer, case, agrees, (TABLE, GIVENS, FACTORS))
        return beside and Finding(f"the sign is not right; and but for the sign, {beside.says}")
    return found


def _in_tables(answer, case, agrees, tables):
    for mistakes in tables:
        wrongs = [
            (mistake, wrong, says)
            for mistake in mistakes
            if answer or not (mistake.is_rare or mistake.is_rarest)
            for wrong, says in mistake.wrongs(case)
            if math.isfinite(wrong) and not agrees(wrong)
        ]
        for narrow in (True, False):
            for mistake, wrong, says in wrongs:
                if is_recognised(answer, wrong, mistake.is_rare, narrow, mistake.is_rarest):
                    return Finding(says)
    return None


def _plain(answer, case, agrees):
    """A sign, a unit or an inverse in a number that is only as near to the right one as is asked."""
    for mistake in TABLE:
        for wrong, says in mistake.wrongs(case) if mistake.is_plain else ():
            if math.isfinite(wrong) and not agrees(wrong) and abs(answer - wrong) <= case.within * abs(wrong):
                return Finding(says)
    return None


def _carried_on(answer, case, agrees):
    """Whether a number follows, by the right way, from a wrong one before it, which may be rounded."""
    for wrong, says in case.carried():
        if math.isfinite(wrong) and not agrees(wrong) and abs(answer - wrong) <= CARRIED * abs(wrong):
            return Finding(says, is_mistake=False)
    return None


def is_recognised(
    answer: float, wrong: float, is_rare: bool = False, narrow: bool = False, is_rarest: bool = False
) -> bool:
    """Whether an answer is a wrong value, as far as the digits of the answer can tell.

    >>> is_recognised(0.67, 2 / 3), is_recognised(0.66, 2 / 3), is_recognised(0.7, 2 / 3)
    (True, False, False)
    """
    if answer == 0 or wrong == 0:
        return answer == wrong
    digits, half_unit = _digits(answer)
    within = NARROWEST if narrow else min(max(half_unit / abs(wrong), NARROWEST), WIDEST)
    if is_rare or is_rarest:
        within = min(max(half_unit / abs(wrong), NEAREST), NEAR_ENOUGH)
        if digits < ENOUGH_DIGITS:
            within = 0 if is_rarest else EXACTLY
    return within > 0 and abs(answer - wrong) <= within * abs(wrong)


def are_recognised(answers: np.ndarray, halves: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    """Which answers are the wrong values in the same places, as `is_recognised` says it of one.

    Arguments:
        answers: numbers.
        halves: of each, half a unit of its last digit.
        wrong: values, NaN where there is none; zero is taken for none.

    >>> answers = np.array([0.67, 0.66, 0.7, 1])
    >>> are_recognised(answers, half_units(answers), np.array([2 / 3, 2 / 3, 2 / 3, np.nan])).tolist()
    [True, False, False, False]
    """
    size = np.abs(wrong)
    return (np.abs(answers - wrong) <= np.clip(halves, NARROWEST * size, WIDEST * size)) & (wrong != 0)


def half_units(answers: Iterable[float]) -> np.ndarray:
    """Half a unit of the last digit of each number."""
    return np.array([_digits(answer)[1] for answer in answers])


def _digits(answer):
    """How many digits a number is given with, and half a unit of the last one."""
    _, digits, exponent = Decimal(repr(float(answer))).normalize().as_tuple()
    return len(digits), 0.5 * 10.0**exponent


# ------------------------------------------------------------------------------------------------------- the table


def _other(case):
    for other in case.others:
        if other.unit == case.unit:
            says = f", itself: asked here is {case.asked}" if other.is_had else ": have you interchanged the two?"
            yield other.value, f"that is {other.words}{says}"


def _sign(case):
    yield -case.key, "the size is right, the sign is not"


def _unit(case):
    for unit, converted in units.neighbours(case.unit).items():
        if unit == "ms":  # of a plant that answers in seconds, nobody thinks in these: rather a litre is no cubic metre
            continue
        yield converted(case.key), f"that would be the value {in_unit(unit)}; asked: {case.asked}"


_TIMES = ("ms", "s", "min", "h")
_FREQUENCIES = tuple(f"rad/{unit}" for unit in _TIMES)


def _inverse(case):
    if case.key:
        yield 1 / case.key, "that is the inverse: one divided by the answer"
        if case.unit in _TIMES and "period" in case.asked:
            yield 2 * math.pi / case.key, "that is 2π divided by the answer: an angular frequency instead of a period"
        if case.unit in _FREQUENCIES and "frequency" in case.asked:
            yield 2 * math.pi / case.key, "that is 2π divided by the answer: a period instead of an angular frequency"


def _given(case):
    for given in case.givens:
        if given.unit == case.unit:
            says = f"that is the same number as the {given.words} of the question"
            says += f": how does one get from there to {case.asked}?"
            yield given.value, says


def _decibel(case):
    if case.unit == "" and case.key > 0 and case.key != 1:
        yield 20 * math.log10(case.key), "that is the value in dB; asked is the factor itself"


def _complement(case):
    wholes = {"deg": (90, 180, 360), "rad": (math.pi / 2, math.pi, 2 * math.pi), "%": (100,), "": (1,)}
    for whole in wholes.get(case.unit, ()):
        if case.unit in ("deg", "rad") or 0 < case.key < whole:
            angle = {90: "a right angle", 180: "half a turn", 360: "a whole turn"}
            names = angle.get(round(math.degrees(whole))) if case.unit == "rad" else angle.get(whole)
            what = names or f"{whole}{chr(160) + case.unit if case.unit else ''}"
            sides = "from which side does the angle count?" if names else "which of the two parts is asked for?"
            yield whole - case.key, f"that is what is missing to {what}: {sides}"
            if names:
                yield case.key - whole, f"that is off by {what}: from where does the angle count?"


def _as_large_as(given):
    return f"it is off by a factor as large as the {given.words}: is that missing, or in it once too often?"


def _is_common(value):
    """Whether a factor is so common a number that it is some other quantity by chance."""
    return float(value).is_integer() and abs(value) <= MOST


def _with_given(case):
    for given in case.givens:
        if not _is_common(given.value):
            yield case.key * given.value, _as_large_as(given)
            yield case.key / given.value, _as_large_as(given)


_FACTORS = (
    (2, "it is off by a factor of 2: does something count twice that counts once, or only half?"),
    (100, "it is off by a factor of 100: look at percent and fraction, or at a prefix such as centi"),
    (1000, "it is off by a factor of 1000: look at the units, at a prefix such as kilo or milli"),
    (60, "it is off by a factor of 60: look at the units, at seconds and minutes"),
    (10, "it is off by a factor of 10: look at the decimal point, and at the units"),
    (3600, "it is off by a factor of 3600: look at the units, at seconds and hours"),
)
_SHARES = (1 - math.exp(-1), 0.63)
_RARE_FACTORS = (
    (2 * math.pi, "it is off by a factor of 2π: count in radians or in whole turns?"),
    (180 / math.pi, "it is off by the factor between degrees and radians"),
    (math.log(2), "it is off by a factor of ln 2: that is the way from a time constant to the time for one half"),
    (math.log(10), "it is off by a factor of ln 10: the natural logarithm and the decimal one are interchanged"),
    *((share, "it is off by a factor of 0.63: that is the share reached after one time constant") for share in _SHARES),
)


def _factor(case):
    yield from _times(case, _FACTORS)


def _rare_factor(case):
    yield from _times(case, _RARE_FACTORS)


def _times(case, factors):
    for factor, says in factors:
        for given in case.givens:  # what is in the question explains more than units
            if factor not in (2, 4, 10) and given.value in (factor, 1 / factor):
                says = _as_large_as(given)
        yield case.key * factor, says
        yield case.key / factor, says


def _changed(case):
    zero = [wrong for wrong in case.changed(True) if wrong[0] == 0]
    yield from (wrong for wrong in case.changed(True) if wrong[0] or len(zero) == 1)  # many factors make a product zero


def _changed_otherwise(case):
    yield from case.changed(False)


TABLE = (
    Mistake("interchanged", _other),
    Mistake("sign", _sign, is_plain=True),
    Mistake("unit", _unit, is_plain=True),
    Mistake("inverse", _inverse, is_plain=True),
    Mistake("decibel", _decibel),
    Mistake("complement", _complement),
)
#: Then, unless it follows from a wrong number before it, what is a given.
GIVENS = (Mistake("given", _given),)
#: What is off by a factor.
FACTORS = (
    Mistake("factor", _factor),
    Mistake("with a given", _with_given, is_rare=True),
)
#: After them, the rest: to change the givens takes time.
MORE = (
    Mistake("changed", _changed, is_rare=True),
    Mistake("changed otherwise", _changed_otherwise, is_rarest=True),
    Mistake("rare factor", _rare_factor, is_rarest=True),
)


# ---------------------------------------------------------------------------------------------- what is said at last


def rounded(answer: float, key: float) -> bool:
    """Whether an answer is the key, rounded to the digits that the answer has.

    >>> rounded(0.7, 2 / 3), rounded(0.66, 2 / 3)
    (True, False)
    """
    return abs(answer - key) < _digits(answer)[1] and answer * key > 0


def _rounded(answer, case):
    key, digits = case.key, _digits(answer)[0]
    if not (key and rounded(answer, key) and abs(answer / key - 1) < ROUNDED):
        return None
    places = f"{digits} digit{'' if digits == 1 else 's'}"
    says = f"that is rounded to {places}, but the accuracy asked for is {100 * case.within:g}\N{NO-BREAK SPACE}%"
    return Finding(f"{says}: keep more digits, here and on the way", is_mistake=False)


def in_general(answer: float, case: Case) -> Finding:
    """Return what is true of any wrong number.

    Sizes are compared in powers of two that do not depend on the key, so that asking again does not narrow it down.

    >>> in_general(15, Case(12, "s", "the time, in s")).says
    'not right, though of about the right size; asked: the time, in s'
    """
    key = case.key
    if found := _rounded(answer, case):
        return found
    is_counted = case.unit == "" and float(key).is_integer() and float(answer).is_integer()
    if key and not (is_counted or case.is_count(answer)) and not case.before and abs(answer / key - 1) < NEARBY:
        return Finding("that is off by a few percent, which is more than the rounding of a result", is_mistake=False)
    says = f"not right{size_of(answer, case)}; asked: {case.asked}"
    more = to_check(case) if answer else ". What would it mean here if that were zero?"
    return Finding(says + more, is_mistake=False, is_bare=True)


def to_check(case: Case) -> str:
    """Return what a reader can look at: a number before it that is not right either; empty where there is none."""
    return f". What you have for {case.before}, is not right either: look at it first" if case.before else ""


def size_of(answer: float, case: Case) -> str:
    """How large a wrong number is beside the right one, in words behind "not right"."""
    key = case.key
    if answer == 0 or key == 0 or case.within == 0:
        return ", and not zero" if answer == 0 else ""
    if answer * key < 0:
        return ": the sign is not, nor is the size"
    steps = math.floor(math.log2(abs(answer))) - math.floor(math.log2(abs(key)))
    if steps == 0:
        return ", though of about the right size"
    much = "much " if abs(steps) > 3 else ""
    return f": {much}too {'large' if steps > 0 else 'small'}{' in size' if key < 0 else ''}"


# -------------------------------------------------------------------------------------------------------- one number


def others_asked(background: Background) -> list[tuple[str, Amount]]:
    """The other numbers that are asked for, each with its name; what one is stays open until it is right."""
    return [
        (name, _asked_amount(name, kind, background))
        for name, kind in background.key.items()
        if type(kind) is Number and name != background.name
    ]


_ANOTHER = "another quantity that is asked for"


def _asked_amount(name, kind, background):
    one = background.answered(name)
    if one and one.is_right:
        return Amount(kind.key, kind.unit, one.words, is_had=True)
    mine = background.key.get(background.name)
    is_swapped = one is not None and type(mine) is Number and mine.unit == kind.unit and mine.agrees(one.answer)
    return Amount(kind.key, kind.unit, one.words if one and is_swapped else _ANOTHER)


def wrong_before(background: Background) -> str:
    """The last wrong number before this one on which it depends, in words; empty where there is none."""
    for one in reversed(background.wrong_before):
        if type(one.kind) is Number and one.name in background.depends_on:
            return one.words
    return ""


@explained.register
def _(kind: Number, answer: float, background: Background) -> Finding:
    def numbers(keys):
        return ((key.key, says) for says, key in keys if isinstance(key, Number))

    case = Case(
        kind.key,
        kind.unit,
        kind.asked,
        kind.within,
        others=[amount for _, amount in others_asked(background)],
        givens=background.givens,
        changed=lambda likely: numbers(background.changed_keys(likely)),
        before=wrong_before(background),
        carried=lambda: itertools.chain(
            ((own, follows(words)) for words, own in of_formulas(kind.key, background)),
            numbers(background.carried_on()),
        ),
    )
    return found_in(answer, case, kind.agrees) or in_general(answer, case)
