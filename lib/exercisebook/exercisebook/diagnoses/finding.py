"""What is found in a wrong answer."""

from __future__ import annotations

import copy
import functools
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook.kinds import Design

if TYPE_CHECKING:
    from exercisebook.diagnoses.background import Background
    from exercisebook.kinds import Kind


@dataclass(frozen=True)
class Finding:
    """A sentence on a wrong answer.

    Attributes:
        says: the sentence.
        is_mistake: whether it names the mistake; otherwise it says something true about the answer.
        is_bare: whether it says little more than that the answer is not right.
    """

    says: str
    is_mistake: bool = True
    is_bare: bool = False


@functools.singledispatch
def explained(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return what is found in a wrong answer; None where that is nothing.

    Arguments:
        kind: the asked quantity with its key.
        answer: as it was read.
        background: what else is known of the exercise.
    """
    if isinstance(kind, Design):  # judged by its criteria, whatever its key: no other key makes an answer right
        return of_another(kind, answer, background)
    return recomputed(kind, answer, background)


def swapped(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return that each of two answers is right for the other."""
    if not isinstance(kind.key, float | np.ndarray) or kind.agrees(answer):
        return None
    for name, other in background.key.items():
        if type(other) is type(kind) and name != background.name and not kind.agrees(other.key):
            one = background.answered(name)
            if one and other.agrees(answer) and kind.agrees(one.answer):
                return Finding(f"this and {one.words}, are interchanged")
    return None


def of_another(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return that an answer is right for another quantity of the same kind."""
    for name, other in background.key.items():
        same = type(other) is type(kind) and other.unit == kind.unit and name != background.name
        if same and not other.agrees(kind.key) and other.agrees(answer):
            had = background.answered(name)
            if had and had.is_right:
                return Finding(f"that is {had.words}, itself: asked here is {kind.asked}")
            return Finding("that fits another quantity that is asked for: have you interchanged the two?")
    return None


def followed(kind: Kind, answer: Any, background: Background) -> Iterator[tuple[str, float]]:
    """Yield from which wrong numbers before it an answer follows, and how far it is from what follows."""
    for says, key in background.carried_on() if background.wrong_before else ():
        if type(key) is type(kind) and kind.is_value(answer, key.key) and not kind.agrees(key.key):
            yield says, kind.off_by(answer, key.key)


def carried_on(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return whether an answer follows from a wrong number before it."""
    for says, key in background.carried_on():
        if _is_right_with(key, kind, answer):
            return Finding(says, is_mistake=False)
    return None


def recomputed(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return the change of a given with which the answer would be right, or that it is right for another quantity."""
    if found := of_another(kind, answer, background) or carried_on(kind, answer, background):
        return found
    for how, key in itertools.chain(background.changed_keys(), background.changed_keys(likely=False)):
        if _is_right_with(key, kind, answer):
            return Finding(how)
    return None


def _is_right_with(key, kind, answer):
    """Whether an answer that is not right would be so with the key of another variant."""
    if type(key) is not type(kind):
        return False
    wrong = copy.copy(kind)  # with its own symbols, times and tolerance
    wrong.key = key.key
    return wrong.may_agree(answer) and wrong.agrees(answer) and not wrong.agrees(kind.key)
