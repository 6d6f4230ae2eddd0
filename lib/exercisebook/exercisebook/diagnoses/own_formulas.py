"""Numbers that belong to a formula: what follows from the reader's own one, which is not right."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator

import numpy as np

from exercisebook.diagnoses.background import Answered, Background
from exercisebook.formulas import Formula
from exercisebook.kinds import Expression, Kind, TimeFunction

#: A number belongs to a formula if it is this near to what the right formula gives.
SAME = 1e-4


def of_formulas(key: float, background: Background) -> Iterator[tuple[str, float]]:
    """What a number would be by each wrong formula of the reader's, and that formula in words.

    Arguments:
        key: the number, which tells how it belongs to the right formula.
        background: with the formulas that are asked for, and what the reader has for them.
    """
    for name, kind in background.key.items():
        follows = background.name in background.sources.get(name, ())  # the formula from the number
        if name != background.name and isinstance(kind, Expression) and not follows:
            one = background.answered(name)
            if one and isinstance(one.answer, Formula) and not one.is_right:
                for right, own in numbers_of(one.kind, one, background):
                    if math.isfinite(own) and abs(right - key) <= SAME * abs(key):
                        yield one.words, own


@functools.singledispatch
def numbers_of(kind: Kind, one: Answered, background: Background) -> Iterator[tuple[float, float]]:
    """Yield numbers of the right formula, and the same ones of the reader's; each kind of formula registers its own."""
    yield from ()


@numbers_of.register
def _(kind: TimeFunction, one: Answered, background: Background) -> Iterator[tuple[float, float]]:
    times = np.array([1e-9, 1e3]) * kind.until
    yield from zip(_real(kind.key, t=times), _real(one.answer, t=times), strict=True)


@numbers_of.register
def _(kind: Expression, one: Answered, background: Background) -> Iterator[tuple[float, float]]:
    values = {name: background.values.get(name) for name in kind.symbols}
    if values and not any(value is None or isinstance(value, str) for value in values.values()):
        numbers = {name: np.array([float(value)]) for name, value in values.items()}
        yield from zip(_real(kind.key, **numbers), _real(one.answer, **numbers), strict=True)


def _real(formula, **values):
    with np.errstate(all="ignore"):
        found = np.broadcast_to(formula(**values), np.shape(next(iter(values.values()), ())))
    return np.where(np.abs(found.imag) < SAME * np.abs(found), found.real, np.nan).ravel().tolist()
