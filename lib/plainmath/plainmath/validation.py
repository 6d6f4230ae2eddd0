"""What functions ask of single arguments: a sentence names the value and what was expected, one for each fault.

Three kinds of arguments are checked. `number`, `positive`, `not_negative` and `whole` are for values to compute with in
floats and integers; `exact_real`, `exact_positive`, `exact_not_negative`, `exact_nonzero` and `exact_in_range` are for
numbers or symbols, of which only what is known to be wrong is refused; `real_numbers`, `positive_numbers` and
`increasing` are for arrays. Of words, `one_of` takes one out of several, and `did_you_mean` ends the sentence on a name
that is not known.
"""

from __future__ import annotations

import difflib
import functools
import inspect
import math
import operator
from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np
import sympy

from plainmath.expressions import exact

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from plainmath.types import Number

__all__ = [
    "did_you_mean", "exact_in_range", "exact_nonzero", "exact_not_negative", "exact_positive", "exact_real",
    "increasing", "is_number", "known_arguments", "limits", "not_negative", "number", "one_of", "positive",
    "positive_numbers", "real_numbers", "times_from_zero", "whole",
]  # fmt: skip

P = ParamSpec("P")
R = TypeVar("R")
A_FINITE_NUMBER = "a finite real number"
A_POSITIVE_NUMBER = "a positive number"
NOT_NEGATIVE = "a number that is not negative"


# -------------------------------------------------------------------------------------------------------- numbers


def is_number(value: object) -> bool:
    """Whether a value is one finite real number, and no text or truth value.

    >>> [is_number(value) for value in (2, sympy.pi, "2", True, float("inf"), sympy.Symbol("K"))]
    [True, True, False, False, False, False]
    """
    try:
        return not isinstance(value, (bool, str)) and math.isfinite(float(value))
    except (TypeError, ValueError, OverflowError):
        return False


def number(
    name: str, value: Any, expected: str = A_FINITE_NUMBER, holds: Callable[[float], bool] = lambda x: True
) -> float:
    """Return a value as a finite float.

    Arguments:
        name: of the argument, as the sentence begins with it.
        value: a number of any kind: of Python, NumPy or SymPy.
        expected: what the sentence ends with.
        holds: a condition on the float.
    Raises:
        ValueError: for symbols, text, truth values and what is no finite real number, or where the condition fails.

    >>> number("share", 3, "a number between 0 and 1", lambda x: 0 < x < 1)
    Traceback (most recent call last):
    ValueError: share is 3: expected a number between 0 and 1
    """
    if not (is_number(value) and holds(float(value))):
        raise ValueError(f"{name} is {value!r}: expected {expected}")
    return float(value)


def positive(name: str, value: Any) -> float:
    """Return a value as a positive finite float, or raise ValueError."""
    return number(name, value, A_POSITIVE_NUMBER, lambda x: x > 0)


def not_negative(name: str, value: Any) -> float:
    """Return a value as a finite float that is not negative, or raise ValueError."""
    return number(name, value, NOT_NEGATIVE, lambda x: x >= 0)


def whole(name: str, value: Any, least: int = 1) -> int:
    """Return a whole number of any kind as an integer, or raise ValueError; truth values are none.

    >>> whole("order", 2.0)
    Traceback (most recent call last):
    ValueError: order is 2.0: expected a whole number, at least 1
    """
    try:
        found = operator.index(value)
    except TypeError:
        found = least - 1
    if isinstance(value, bool) or found < least:
        raise ValueError(f"{name} is {value!r}: expected a whole number, at least {least}")
    return found


# --------------------------------------------------------------------------------------------- numbers or symbols


def exact_real(name: str, value: Any, infinite: bool = False, symbols: bool = True) -> sympy.Expr:
    """Return a number or an expression with symbols, exact (see `expressions.exact`).

    Arguments:
        name: of the argument, as the sentence begins with it.
        value: a number of any kind, or an expression.
        infinite: whether ``oo`` is one too, as for an integral time that is switched off.
        symbols: whether symbols may stand in it.
    Raises:
        ValueError: for what is neither, or is known not to be real and finite.

    >>> exact_real("K", 0.5), exact_real("K", sympy.Symbol("K"))
    (1/2, K)
    >>> exact_real("K", sympy.I)
    Traceback (most recent call last):
    ValueError: K is I: expected a finite real number
    """
    try:
        found = exact(value)
    except ValueError:
        raise ValueError(f"{name} is {value!r}: expected a number{' or an expression' if symbols else ''}") from None
    is_real = found.is_real is not False or (infinite and found == sympy.oo)
    return _unless(not (is_real and (symbols or found.is_number)), name, found, A_FINITE_NUMBER)


def exact_positive(name: str, value: Any, infinite: bool = False, symbols: bool = True) -> sympy.Expr:
    """Return a number or an expression, exact, that is not known to be zero or less; arguments as `exact_real`.

    >>> exact_positive("Pu", 0)
    Traceback (most recent call last):
    ValueError: Pu is 0: expected a positive number
    """
    found = exact_real(name, value, infinite, symbols)
    return _unless(found.is_extended_positive is False, name, found, A_POSITIVE_NUMBER)


def exact_not_negative(name: str, value: Any, infinite: bool = False, symbols: bool = True) -> sympy.Expr:
    """Return a number or an expression, exact, that is not known to be negative; arguments as `exact_real`.

    >>> exact_not_negative("Tc", -1)
    Traceback (most recent call last):
    ValueError: Tc is -1: expected a number that is not negative
    """
    found = exact_real(name, value, infinite, symbols)
    return _unless(found.is_negative, name, found, NOT_NEGATIVE)


def exact_nonzero(name: str, value: Any) -> sympy.Expr:
    """Return a number or an expression, exact, that is not known to be zero, as a gain; raises ValueError.

    >>> exact_nonzero("Ku", 0)
    Traceback (most recent call last):
    ValueError: Ku is 0: expected a number other than zero
    """
    found = exact_real(name, value)
    return _unless(found.is_zero, name, found, "a number other than zero")


def exact_in_range(name: str, value: Any, low: Number, high: Number, extrapolate: bool = False) -> sympy.Expr:
    """Return a number or an expression, exact, that is not known to be outside of the range a formula was made for.

    Arguments:
        name: of the value, as the sentence begins with it.
        value: a number of any kind, or an expression.
        low, high: the ends of the range, which belong to it.
        extrapolate: what the function that checks was told: whether it may be left.
    Raises:
        ValueError: for what is not a number or expression; and outside of the range, unless it may be left.

    >>> exact_in_range("delay/T", 2, 0, 1)
    Traceback (most recent call last):
    ValueError: delay/T is 2.000: expected 0 to 1; extrapolate=True leaves this range
    """
    found = exact_real(name, value)
    is_outside = (low - found).is_positive or (found - high).is_positive
    if is_outside and not extrapolate:
        raise ValueError(f"{name} is {found.evalf(4)}: expected {low} to {high}; extrapolate=True leaves this range")
    return found


def _unless(wrong, name, value, expected):
    if wrong:
        raise ValueError(f"{name} is {value}: expected {expected}")
    return value


def limits(name: str, given: Any, symbols: bool = False) -> tuple[sympy.Expr, sympy.Expr]:
    """Return ``(lowest, highest)``, exact; either may be infinite.

    Arguments:
        name: of the limits, in the plural, as the sentence begins with it.
        given: two numbers.
        symbols: whether symbols may stand in them, of which the order need not be known.
    Raises:
        ValueError: for what is not two numbers, the lower one first.

    >>> limits("the limits of h", (3, 1))
    Traceback (most recent call last):
    ValueError: the limits of h are (3, 1): expected the lower one first
    """
    try:
        low, high = ends = tuple(map(exact, given))
    except (TypeError, ValueError):
        ends = ()
    if not ends or any(x.is_extended_real is False or not (symbols or x.is_number) for x in ends):
        raise ValueError(f"{name} are {given!r}: expected (lowest, highest)")
    if (high - low).is_extended_positive is False:
        raise ValueError(f"{name} are ({low}, {high}): expected the lower one first")
    return low, high


# --------------------------------------------------------------------------------------------------------- arrays


def real_numbers(name: str, values: ArrayLike) -> np.ndarray:
    """Return values as an array of floats, or raise ValueError for what is not real and finite.

    >>> real_numbers("times", [0, 1])
    array([0., 1.])
    """
    try:
        if np.iscomplexobj(values):  # which NumPy would cut down to their real parts
            raise TypeError
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"the {name} are {values!r}: expected real numbers") from None
    return _all(np.isfinite(array), name, array, "finite numbers")


def positive_numbers(name: str, values: ArrayLike, zero: bool = False) -> np.ndarray:
    """Return values as an array of positive floats, with ``zero`` of those that are not negative; or raise ValueError.

    >>> positive_numbers("gain ratios", [1, -2])
    Traceback (most recent call last):
    ValueError: the gain ratios contain -2: expected positive numbers
    """
    array = real_numbers(name, values)
    if zero:
        return _all(array >= 0, name, array, "numbers that are not negative")
    return _all(array > 0, name, array, "positive numbers")


def times_from_zero(values: ArrayLike) -> np.ndarray:
    """Return times as an array of floats, or raise ValueError where one is negative."""
    return positive_numbers("times", values, zero=True)


def increasing(name: str, values: ArrayLike, least: int = 1) -> np.ndarray:
    """Return values as an array of floats, each larger than the one before, or raise ValueError.

    Arguments:
        name: of the values, as the sentence begins with it.
        values: an array or a list.
        least: how many there must be.

    >>> increasing("times", [0, 2, 1])
    Traceback (most recent call last):
    ValueError: the times go from 2 to 1: expected increasing numbers
    """
    array = real_numbers(name, values)
    if array.ndim != 1 or not len(array):
        raise ValueError(f"the {name} have the shape {array.shape}: expected a row of numbers")
    if len(array) < least:
        raise ValueError(f"the number of {name} is {len(array)}: expected {least} or more")
    not_more = np.flatnonzero(np.diff(array) <= 0)
    if not_more.size:
        before, after = array[not_more[0] :][:2]
        raise ValueError(f"the {name} go from {before:.12g} to {after:.12g}: expected increasing numbers")
    return array


def _all(right, name, array, expected):
    if not right.all():
        raise ValueError(f"the {name} contain {array[~right][0]:g}: expected {expected}")
    return array


# ---------------------------------------------------------------------------------------------------------- words


def one_of(name: str, word: str, words: Collection[str]) -> str:
    """Return a word that is one of several, or raise ValueError, which lists them.

    >>> one_of("kind", "PD", ("P", "PI", "PID"))
    Traceback (most recent call last):
    ValueError: kind is 'PD': expected one of P, PI, PID
    """
    if not isinstance(word, str) or word not in words:
        raise ValueError(f"{name} is {word!r}: {_listed(words)}")
    return word


def did_you_mean(name: object, known: Iterable[object], otherwise: str | None = None) -> str:
    """Return the end of a sentence on a name that is not known: the one that is like it, or all that there are.

    Arguments:
        name: what was given; capitals and small letters are alike.
        known: the names that there are.
        otherwise: what is said where none is like it; the list of all, if not given.

    >>> did_you_mean("setpont", ["setpoint", "load"])
    "did you mean 'setpoint'?"
    >>> did_you_mean("noise", ["setpoint", "load"])
    'expected one of setpoint, load'
    """
    names = list(map(str, known))
    alike = {one.casefold(): one for one in names}
    if close := difflib.get_close_matches(str(name).casefold(), alike, n=1):
        return f"did you mean {alike[close[0]]!r}?"
    if otherwise is not None:
        return otherwise
    return _listed(names) if names else "there are none"


def known_arguments(function: Callable[P, R]) -> Callable[P, R]:
    """Return a function that says which arguments it has where it is called with the name of another one.

    >>> @known_arguments
    ... def lag(K, T, delay=0): ...
    >>> lag(2, 5, theta=4)
    Traceback (most recent call last):
    TypeError: lag has no argument 'theta': expected one of K, T, delay
    """
    names = [name for name in inspect.signature(function).parameters if name != "self"]

    @functools.wraps(function)
    def called(*args: P.args, **options: P.kwargs) -> R:
        if options.keys() - names:
            unknown = next(name for name in options if name not in names)
            whose = function.__qualname__.removesuffix(".__init__")
            raise TypeError(f"{whose} has no argument {unknown!r}: {did_you_mean(unknown, names)}")
        return function(*args, **options)

    return called


def _listed(names):
    return f"expected one of {', '.join(names)}"
