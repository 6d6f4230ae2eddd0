"""What functions ask of single inputs, in one sentence that names the value and what was expected."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy
    from numpy.typing import ArrayLike


def number(
    name: str, value: object, expected: str = "a finite number", holds: Callable[[float], bool] = lambda x: True
) -> float:
    """Return a value as a finite float.

    Arguments:
        name: of the input, as the sentence begins with it.
        value: a number of any kind: of Python, NumPy or SymPy.
        expected: what the sentence ends with.
        holds: a condition on the float.
    Raises:
        ValueError: for letters, text, truth values and what is no finite real number, or where the condition fails.

    >>> number("step", -1, "a positive number", lambda x: x > 0)
    Traceback (most recent call last):
    ValueError: step is -1: expected a positive number
    """
    try:
        x = math.nan if isinstance(value, (bool, str)) else float(value)
    except (TypeError, ValueError):
        x = math.nan
    if not (math.isfinite(x) and holds(x)):
        raise ValueError(f"{name} is {value!r}: expected {expected}")
    return x


def positive(name: str, value: object) -> float:
    """Return a value as a positive finite float, or raise ValueError."""
    return number(name, value, "a positive number", lambda x: x > 0)


def not_negative(name: str, value: object) -> float:
    """Return a value as a finite float that is not negative, or raise ValueError."""
    return number(name, value, "a number that is not negative", lambda x: x >= 0)


def one_of(name: str, word: str, words: Collection[str]) -> str:
    """Return a word that is one of several, or raise ValueError.

    >>> one_of("kind", "PD", ("P", "PI", "PID"))
    Traceback (most recent call last):
    ValueError: kind is 'PD': expected 'P', 'PI', 'PID'
    """
    if not isinstance(word, str) or word not in words:
        raise ValueError(f"{name} is {word!r}: expected {', '.join(map(repr, words))}")
    return word


def real_numbers(name: str, values: ArrayLike) -> numpy.ndarray:
    """Return values as an array of floats, or raise ValueError for what is not real and finite.

    >>> real_numbers("times", [0, 1])
    array([0., 1.])
    """
    import numpy

    try:
        if numpy.iscomplexobj(values):  # which NumPy would cut down to their real parts
            raise TypeError
        array = numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"the {name} are {values!r}: expected real numbers") from None
    if not numpy.isfinite(array).all():
        raise ValueError(f"the {name} contain {array[~numpy.isfinite(array)][0]:g}: expected finite numbers")
    return array


def times_from_zero(values: ArrayLike) -> numpy.ndarray:
    """Return times as an array of floats, or raise ValueError where one is negative."""
    times = real_numbers("times", values)
    if (times < 0).any():
        raise ValueError(f"the times begin at {times.min():g}: expected zero or later")
    return times
