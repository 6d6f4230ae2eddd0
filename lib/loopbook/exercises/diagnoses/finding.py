"""What is found in a wrong answer."""

from __future__ import annotations

import copy
import functools
import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from loopbook.exercises.diagnoses.background import Background
    from loopbook.exercises.kinds import Kind


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
    return recomputed(kind, answer, background)


def recomputed(kind: Kind, answer: Any, background: Background) -> Finding | None:
    """Return the change of a given with which the answer would be right."""
    for how, key in itertools.chain(background.changed_keys(), background.changed_keys(likely=False)):
        if type(key) is type(kind):
            wrong = copy.copy(kind)  # with its own symbols, times and tolerance
            wrong.key = key.key
            if wrong.agrees(answer) and not wrong.agrees(kind.key):
                return Finding(how)
    return None
