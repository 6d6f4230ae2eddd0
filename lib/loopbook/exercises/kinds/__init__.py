"""The kinds of asked quantities: how an answer is read, compared with the key, and responded to."""

from loopbook.exercises.kinds.design import Criterion, Design
from loopbook.exercises.kinds.formula import Expression, TimeFunction, TransferFunction
from loopbook.exercises.kinds.kind import NOT_ANSWERED, Kind
from loopbook.exercises.kinds.numeric import Number, Numbers, Poles
from loopbook.exercises.kinds.settings import Settings
from loopbook.exercises.kinds.words import Word, Words

__all__ = [
    "NOT_ANSWERED", "Criterion", "Design", "Expression", "Kind", "Number", "Numbers", "Poles", "Settings",
    "TimeFunction", "TransferFunction", "Word", "Words",
]  # fmt: skip
