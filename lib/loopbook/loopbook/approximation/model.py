"""The simple model that tuning rules start from: a gain, one or two lags, and a dead time."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import sympy

from loopbook.laplace import by_delay, roots
from loopbook.transfer import dead_time, transfer_function
from loopbook.types import Number, TransferFunctionLike
from plainmath.expressions import exact, s, written
from plainmath.latex import equalities
from plainmath.validation import exact_nonzero, exact_not_negative


class Step(NamedTuple):
    """One application of a rule: the name of the rule, a part of a transfer function, and what stands for it."""

    rule: str
    before: sympy.Expr
    after: sympy.Expr


@dataclass(frozen=True)
class SOPDT:
    """A second-order-plus-dead-time model, ``K*exp(-delay*s)/((T1*s + 1)*(T2*s + 1))``.

    It is of first order, FOPDT, where T2 = 0. An infinite lag is an integrator, and K is then the slope:
    ``K*exp(-delay*s)/(s*(T2*s + 1))`` for T1 = oo, and ``K*exp(-delay*s)/s**2`` for two of them.

    Arguments:
        K: gain, in units of the measurement for one unit of the control signal; of an integrator, that per time.
        T1, T2: lags, not negative, the larger one first; T1 may be oo, and then T2 too.
        delay: dead time, not negative, in the unit of the lags.
        steps: how the model was found, if by rules.
    Raises:
        ValueError: for a gain that is zero, a time that is negative, or T2 larger than T1.

    >>> SOPDT(2, T1=10, delay=3).expr
    2*exp(-3*s)/(10*s + 1)
    >>> SOPDT(2, T1=sympy.oo, T2=4).expr
    2/(s*(4*s + 1))
    """

    K: sympy.Expr
    T1: sympy.Expr = sympy.S.Zero
    T2: sympy.Expr = sympy.S.Zero
    delay: sympy.Expr = sympy.S.Zero
    steps: tuple[Step, ...] = field(default=(), compare=False, repr=False)

    if TYPE_CHECKING:  # numbers of any kind are given, and kept as exact ones

        def __init__(
            self,
            K: Number,
            T1: Number = 0,
            T2: Number = 0,
            delay: Number = 0,
            steps: tuple[Step, ...] = (),
        ): ...

    def __post_init__(self) -> None:
        for name in ("K", "T1", "T2", "delay"):
            value = getattr(self, name)
            value = exact_nonzero(name, value) if name == "K" else exact_not_negative(name, value, name != "delay")
            object.__setattr__(self, name, value)
            if {"s", "t"} & {symbol.name for symbol in value.free_symbols}:
                raise ValueError(f"{name} is {value}: expected a number or a symbol other than s and t")
        if sympy.oo != self.T1 and (self.T2 - self.T1).is_extended_positive:
            raise ValueError(f"T1 is {self.T1} and T2 is {self.T2}: expected the larger lag first")

    @property
    def expr(self) -> sympy.Expr:
        """The transfer function, an expression in `s` with exact dead time."""
        lags = sympy.Mul(*(1 / s if sympy.oo == T else 1 / (T * s + 1) for T in (self.T1, self.T2)))
        return self.K * lags * dead_time(self.delay)

    @property
    def is_integrating(self) -> bool:
        """Whether the model has an integrator."""
        return sympy.oo == self.T1

    def _shown(self):
        """The gain, and the times that are not zero."""
        return {name: value for name in ("K", "T1", "T2", "delay") if (value := getattr(self, name)) != 0}

    def _repr_latex_(self):
        symbols = {"K": "K", "T1": "T_1", "T2": "T_2", "delay": r"\mathrm{delay}"}
        return equalities({symbols[name]: value for name, value in self._shown().items()})

    def __repr__(self) -> str:
        return f"SOPDT({', '.join(f'{name}={written(value)}' for name, value in self._shown().items())})"


def model_of(H: TransferFunctionLike, largest_first: Sequence[Number] | None = None) -> SOPDT:
    """Return the `SOPDT` that H is, in whatever form it is written.

    Arguments:
        H: an `SOPDT`; or a transfer function with at most two poles, both real, no zero and one dead time or none, or
            what `transfer_function` reads as one.
        largest_first: lags with symbols, sorted, where the symbols leave their order open.
    Raises:
        ValueError: for anything else, or lags of unknown order.

    >>> model_of(6 / (30 * s**2 + 33 * s + 3))
    SOPDT(K=2, T1=10, T2=1)
    """
    if isinstance(H, SOPDT):
        return H
    H, delay, process = factors(H)
    if process.zeros or len(process.lags) > 2 or any(T.is_negative for T in process.lags):
        raise ValueError(f"{H} is not a simple model: expected at most two lags, no zeros; half_rule may find one")
    return SOPDT(process.K, *sort_lags(process.lags, largest_first), delay=delay)


class TimeConstants(NamedTuple):
    """The gain, and the time constants T of the factors ``T*s + 1`` below and above the fraction bar; oo for `s`
    itself."""

    K: sympy.Expr
    lags: list[sympy.Expr]
    zeros: list[sympy.Expr]


def factors(H: TransferFunctionLike) -> tuple[sympy.Expr, sympy.Expr, TimeConstants]:
    """A transfer function as an expression, its dead time, and its factors, which must be of first order."""
    H = transfer_function(H)
    parts = by_delay(H)
    if len(parts) != 1:
        raise ValueError(
            f"{H} {'adds several dead times' if H != 0 else 'is zero'}: expected a gain, lags, a dead time"
        )
    ((delay, rational),) = parts.items()
    above, below = sympy.cancel(rational).as_numer_denom()
    times = []
    for polynomial, what in ((below, "poles"), (above, "zeros")):
        found = roots(polynomial)
        if oscillating := [p for p in found if p.is_real is False]:
            raise ValueError(f"{H} has the complex {what} {oscillating}: expected real ones")
        times.append([sympy.oo if p == 0 else exact(sympy.radsimp(-1 / p)) for p in found])
    lowest = [next(c for c in reversed(sympy.Poly(x, s).all_coeffs()) if c != 0) for x in (above, below)]
    return H, delay, TimeConstants(sympy.cancel(lowest[0] / lowest[1]), *times)


def sort_lags(times: Sequence[sympy.Expr], given: Sequence[Number] | None) -> list[sympy.Expr]:
    """Times sorted, the largest first, by comparing them or as they are given."""
    if given is not None:
        given = [exact(T) for T in given]
        if sympy.oo in times:
            given = [sympy.oo] * (times.count(sympy.oo)) + [T for T in given if sympy.oo != T]
        contradicted = any((after - before).is_extended_positive for before, after in itertools.pairwise(given))
        if contradicted or sorted(given, key=str) != sorted(times, key=str):
            raise ValueError(f"largest_first is {given}: expected the lags {times}, the largest first")
        return given
    rest, found = list(times), []
    while rest:
        largest = [T for T in rest if all(other == T or _not_smaller(T, other) for other in rest)]
        if not largest:
            names = ", ".join(sorted(map(str, rest)))
            raise ValueError(f"which of the lags {names} is the largest is not known: say it with largest_first")
        rest.remove(largest[0])
        found.append(largest[0])
    return found


def _not_smaller(one, other):
    difference = one - other
    known = difference.is_extended_nonnegative
    return sympy.factor(difference).is_extended_nonnegative if known is None else known
