"""Judging an answer: right, a mistake with a name, wrong, or nothing that can be judged."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook import diagnoses, units
from exercisebook.credit import NOTHING, Credit, worth
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable, shortened
from exercisebook.kinds import Number
from exercisebook.latex import latex
from exercisebook.reading import NOT_ANSWERED
from exercisebook.timeout import limited

if TYPE_CHECKING:
    from exercisebook.diagnoses import Background
    from exercisebook.kinds import Kind

RIGHT, MISTAKE, WRONG, UNJUDGED, OPEN = "right", "mistake", "wrong", "not judged", "open"
#: What is taken down for a person, who says what it is worth.
WAITING = "to be marked"
#: Reading and comparing may take so many seconds: an answer may be a function, or an object with methods of its own.
SECONDS = 5
#: Two mistakes in a number have one value within this fraction of it.
SAME = 1e-9


@dataclass(frozen=True)
class Verdict:
    """What became of the answer to one asked quantity: a status and a sentence."""

    name: str
    status: str
    says: str
    #: Whether it says little more than that the answer is not right: then a hint may help.
    is_bare: bool = field(default=False, repr=False)
    #: Why an instructor should see the answer; empty where there is no need.
    look: str = field(default="", repr=False)
    #: What it brings of the points of the quantity, in percent, where it is not right and the author says so.
    percent: float = field(default=0, repr=False)
    #: The formula that was read, in LaTeX; empty for other answers.
    formula: str = field(default="", repr=False)

    @property
    def is_right(self) -> bool:
        """Whether the answer counts."""
        return self.status == RIGHT

    @property
    def shown(self) -> str:
        """The sentence with the formula in two dimensions, between two dollars, where it says how that was read."""
        words, read, _ = self.says.rpartition("read as ")
        return rf"{words}{read}$\displaystyle {self.formula}$" if read and self.formula else self.says


def earned(points: float, right: float, asked: float) -> float:
    """Return what some right answers bring of the points of an exercise.

    Arguments:
        points: of the exercise.
        right, asked: what the right ones and all of them weigh; where each brings the same, how many they are.

    >>> earned(4, right=2, asked=3)
    2.6666666666666665
    """
    return points * right / asked


def judge(
    name: str,
    kind: Kind,
    given: object,
    mistakes: Iterable[tuple[str, Any]] = (),
    background: Background | None = None,
    credit: Credit = NOTHING,
) -> Verdict:
    """Return the `Verdict` on an answer. Whatever the answer is, this raises nothing.

    Arguments:
        name: of the asked quantity.
        kind: its kind, with the key.
        given: the answer, of any type.
        mistakes: those of the exercise, pairs of a sentence and a wrong value; they come before the general ones.
        background: what else is known of the exercise, for the general ones.
        credit: what is worth something though it is not right.

    >>> from exercisebook.kinds import Number
    >>> judge("T", Number(120, "s", "the period"), 2)
    Verdict(name='T', status='mistake', says='that would be the value in min; asked: the period, in s')
    """
    try:
        return Verdict(name, *limited(SECONDS, _judged, kind, given, mistakes, background, credit))
    except Unreadable as problem:
        status = OPEN if str(problem) == NOT_ANSWERED else UNJUDGED
        return Verdict(name, status, harmless(str(problem)))
    except TimeoutError:
        return Verdict(name, UNJUDGED, f"judging this takes too long: expected {kind.expected}")
    except Exception as problem:  # the answer may be an object that fails in any way
        says = f"this cannot be judged ({type(problem).__name__}): expected {kind.expected}"
        return Verdict(name, UNJUDGED, harmless(says))


def is_right(kind: Kind, given: object) -> bool:
    """Whether an answer would be right, without a word on what is wrong with it. Raises nothing.

    >>> from exercisebook.kinds import Number
    >>> is_right(Number(120, "s"), "2 min"), is_right(Number(120, "s"), "two")
    (True, False)
    """
    try:
        return limited(SECONDS, _agrees, kind, given)
    except Exception:  # the answer may be an object that fails in any way
        return False


def _agrees(kind, given):
    answer, _ = kind.read(given)
    return not any(kind.incomparable(answer)) and kind.agrees(answer)


def _judged(kind, given, mistakes, background, credit):
    """Status, sentence, whether it is bare, why an instructor should look, what it is worth, and the formula."""
    answer, remark = kind.read(given)
    if kind.by_hand:
        return WAITING, "a person marks this" + (f" · {remark}" if remark else ""), False
    says, look = kind.incomparable(answer)
    if says:
        return WRONG, harmless(says), False, harmless(look)
    formula = latex(answer.tree) if isinstance(answer, Formula) else ""
    if kind.agrees(answer):
        return RIGHT, "right" + (f", {remark}" if remark else ""), False, "", 0, formula
    if named := _in_its_unit(kind, answer, remark):
        says = f"the number is right, but in {kind.unit}: you have given it in {named}"
        return MISTAKE, says, False, "", credit.unit
    status, says, is_bare, percent = _explained(kind, answer, mistakes, background, credit)
    if credit.unit and any(kind.agrees(value) for _, value in kind.in_other_units(answer)):
        percent = max(percent, credit.unit)
    if credit.follows and background and any(diagnoses.followed(kind, answer, background)):
        percent = max(percent, credit.follows)
    shown = harmless(kind.as_read(answer))
    said = f"read as {shown}" if shown else harmless(remark)
    return status, says + (f" · {said}" if said else ""), is_bare, "", percent, formula


def _in_its_unit(kind, answer, remark):
    """The unit that was given with a number that is right in the asked one; empty where it is not so."""
    found = re.fullmatch(r"converted from (\S+)", remark)
    if not (found and type(kind) is Number):
        return ""
    return found[1] if kind.agrees(units.convert(answer, kind.unit, to=found[1])) else ""


def _explained(kind, answer, mistakes, background, credit):
    """Status, sentence, whether it is bare, and what a named mistake is worth, of an answer that is not right."""
    background = background or diagnoses.Background()
    if found := diagnoses.swapped(kind, answer, background):
        return MISTAKE, found.says, False, 0
    for known in (mistakes, kind.mistakes()):
        near = [(kind.off_by(answer, wrong), sentence) for sentence, wrong in known if kind.is_value(answer, wrong)]
        if near:  # the nearest one, of several the first; what follows from a wrong number is no mistake
            is_number = isinstance(answer, float)
            same, least = SAME * abs(answer) if is_number else 0.0, min(off for off, _ in near)
            sentence = next(sentence for off, sentence in near if off <= least + same)
            followed = diagnoses.followed(kind, answer, background)
            nearer = [says for says, off in followed if off < least - same or (off <= least and not is_number)]
            if nearer:
                return WRONG, nearer[0], False, 0
            percent, sentence = worth(sentence)
            is_own = known is mistakes
            return MISTAKE, sentence, False, (credit.mistake if is_own else 0) if percent is None else percent
    try:
        with np.errstate(all="ignore"):
            found = diagnoses.explained(kind, answer, background)
    except Unreadable:
        raise
    except Exception:  # whatever a diagnosis stumbles over, the answer is wrong
        found = None
    if found:
        return MISTAKE if found.is_mistake else WRONG, found.says, found.is_bare, 0
    hint = kind.hint(answer)
    return WRONG, hint or f"not right; asked: {kind.asked}", not hint, 0


def harmless(text: str) -> str:
    """A sentence that may quote a reader: not long, in one line, without formulas, in signs that can be printed."""
    line = " ".join(text.replace("$", "").split())
    return shortened(line.encode("utf-8", "backslashreplace").decode(), 400)
