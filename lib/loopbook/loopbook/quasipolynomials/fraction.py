"""Exact fractions of sums of polynomials with dead times, and their algebra.

A sum of polynomials in `s`, each with a dead time ``exp(-delay*s)``, is a dictionary {delay: coefficients}: the delay a
fraction, the coefficients whole numbers, the lowest power first. ``5*s + 2 + 3*exp(-s/2)`` is
``{0: (2, 5), 1/2: (3,)}``.
"""

from __future__ import annotations

import functools
import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Self, TypeVar

import numpy as np
import sympy
from sympy.polys.densearith import dup_exquo
from sympy.polys.euclidtools import dup_gcd
from sympy.polys.rings import PolyRing

from loopbook.transfer import transfer_function
from plainmath.expressions import s
from plainmath.tables import typeset

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

__all__ = [
    "ZERO", "DelayFraction", "Quasipolynomial", "common_polynomial", "earlier", "expression", "lowest_term", "plus",
    "read", "taylor_coefficient", "times",
]  # fmt: skip

#: A sum of polynomials in `s`, each with a dead time: {delay: whole coefficients, the lowest power first}.
Quasipolynomial = dict[Fraction, tuple[int, ...]]

ZERO: Fraction = Fraction(0)
ONE: Quasipolynomial = {ZERO: (1,)}
PRIME = 2**61 - 1  # by which polynomials without a common factor are told apart quickly
MOST_MULTIPLES = 60  # of a common base, up to which delays are powers of one symbol
INFINITE = "is infinite: expected a transfer function"
NOT_RATIONAL = "is not a rational function of s and dead times exp(-delay*s)"

T = TypeVar("T")


# ------------------------------------------------------------------------------------------------ quasipolynomials


def plus(one: Quasipolynomial, other: Quasipolynomial, factor: int = 1) -> Quasipolynomial:
    """Return ``one + factor*other``."""
    total = dict(one)
    for delay, part in other.items():
        mine = total.get(delay, ())
        longer = [*mine, *[0] * (len(part) - len(mine))]
        for k, c in enumerate(part):
            longer[k] += factor * c
        if row := _trimmed(longer):
            total[delay] = row
        else:
            total.pop(delay, None)
    return total


def times(one: Quasipolynomial, other: Quasipolynomial) -> Quasipolynomial:
    """Return ``one*other``."""
    if ONE in (one, other):
        return other if one == ONE else one
    products: dict[Fraction, list[int]] = {}
    for delay, p in one.items():
        for later, q in other.items():
            total = products.setdefault(delay + later if delay and later else delay or later, [])
            total += [0] * (len(p) + len(q) - 1 - len(total))
            for i, a in enumerate(p):
                if a:
                    for j, b in enumerate(q, i):
                        total[j] += a * b
    return {delay: part for delay, total in products.items() if (part := _trimmed(total))}


def _trimmed(coefficients: list[int]) -> tuple[int, ...]:
    """Without zeros for the highest powers."""
    while coefficients and not coefficients[-1]:
        coefficients.pop()
    return tuple(coefficients)


def earlier(parts: Quasipolynomial, by: Fraction) -> Quasipolynomial:
    """Return a quasipolynomial with all dead times shorter."""
    return {delay - by: part for delay, part in parts.items()} if by else parts


def taylor_coefficient(parts: Quasipolynomial, k: int) -> Fraction:
    """Return the coefficient of ``s**k`` in the Taylor series of a quasipolynomial at zero, exact.

    >>> taylor_coefficient({Fraction(0): (1,), Fraction(2): (-1,)}, 1)    # of 1 - exp(-2*s)
    Fraction(2, 1)
    """
    return sum(
        (
            c * (-Fraction(delay)) ** (k - i) / math.factorial(k - i)
            for delay, part in parts.items()
            for i, c in enumerate(part[: k + 1])
            if c
        ),
        ZERO,
    )


def lowest_term(parts: Quasipolynomial) -> tuple[int, Fraction]:
    """Return the lowest power of `s` in the Taylor series of a quasipolynomial, not 0, and its exact coefficient."""
    k = 0
    while not (coefficient := taylor_coefficient(parts, k)):
        k += 1
    return k, coefficient


# ------------------------------------------------------------------------------------------------ common factors


def _cancelled(above: Quasipolynomial, below: Quasipolynomial) -> tuple[Quasipolynomial, Quasipolynomial]:
    """Both without common factors, the denominator with a part without dead time and a positive leading coefficient."""
    if not above:
        return {}, ONE
    base, common = min(below), _common(above, below)
    above, below = (_divided(earlier(parts, base), common) for parts in (above, below))
    # only where both have several dead times can a common factor have one
    if len(above) > 1 and len(below) > 1:
        above, below = _without_common_quasipolynomial(above, below)
    return _ordered(above, below)


def _ordered(above: Quasipolynomial, below: Quasipolynomial) -> tuple[Quasipolynomial, Quasipolynomial]:
    if below[ZERO][-1] < 0:
        above, below = plus({}, above, -1), plus({}, below, -1)
    return dict(sorted(above.items())), dict(sorted(below.items()))


def _common(*sums: Quasipolynomial) -> list:
    """The polynomial that all parts of quasipolynomials have in common, the highest power first."""
    parts = [[*map(sympy.ZZ, reversed(part))] for parts in sums for part in parts.values()]
    if min(map(len, parts)) == 1 or (len(parts) > 1 and _surely_coprime(parts)):
        return [math.gcd(*(int(c) for part in parts for c in part))]
    return functools.reduce(lambda f, g: dup_gcd(f, g, sympy.ZZ), parts)


def _divided(parts: Quasipolynomial, common: list) -> Quasipolynomial:
    if common == [1]:
        return parts
    return {
        delay: tuple(int(c) for c in reversed(dup_exquo([*map(sympy.ZZ, reversed(part))], common, sympy.ZZ)))
        for delay, part in parts.items()
    }


def _surely_coprime(parts: list[list[int]]) -> bool:
    """Whether polynomials, highest power first, have no common factor, as seen modulo a prime."""
    if any(part[0] % PRIME == 0 for part in parts):
        return False
    # a common factor of all is one of the first and of any combination of the others
    length = max(map(len, parts[1:]))
    mixed = [0] * length
    for number, part in enumerate(parts[1:], 1):
        for k, c in enumerate(part, length - len(part)):
            mixed[k] += (7919 * number * number + 1) * c
    first, mixed = ([c % PRIME for c in row] for row in (parts[0], mixed))
    while any(mixed):  # Euclid's algorithm
        while not mixed[0]:
            mixed.pop(0)
        inverse = pow(mixed[0], -1, PRIME)
        while len(first) >= len(mixed):
            factor = first[0] * inverse
            first = [(a - factor * b) % PRIME for a, b in itertools.zip_longest(first, mixed, fillvalue=0)][1:]
        first, mixed = mixed, first
    return len(first) == 1


def common_polynomial(parts: Quasipolynomial) -> tuple[tuple[int, ...], Quasipolynomial]:
    """Return the polynomial that all parts of a quasipolynomial have in common, the lowest power first, and the rest.

    >>> common_polynomial({Fraction(0): (0, 2, 2), Fraction(1): (1, 1)})    # 2 s (s + 1) + (s + 1) exp(-s)
    ((1, 1), {Fraction(0, 1): (0, 2), Fraction(1, 1): (1,)})
    """
    common = _common(parts)
    return tuple(map(int, reversed(common))), _divided(parts, common)


def _without_common_quasipolynomial(
    above: Quasipolynomial, below: Quasipolynomial
) -> tuple[Quasipolynomial, Quasipolynomial]:
    """Without common factors that contain dead times, these being powers of a few symbols."""
    powers, units = _as_powers({*above, *below})
    ring = PolyRing(sympy.symbols(f"s z:{len(units)}"), sympy.ZZ)
    f, g = (
        ring.from_dict({(k, *powers[d]): sympy.ZZ(c) for d, part in side.items() for k, c in enumerate(part) if c})
        for side in (above, below)
    )
    common, f, g = f.cofactors(g)
    if common.is_ground:
        return above, below
    sides = []
    for polynomial in (f, g):
        side: Quasipolynomial = {}
        for (k, *exponents), c in polynomial.terms():
            delay = sum((n * unit for n, unit in zip(exponents, units, strict=True)), ZERO)
            side = plus(side, {delay: (*[0] * k, int(c))})
        sides.append(side)
    base = min(sides[1])
    return earlier(sides[0], base), earlier(sides[1], base)


def _as_powers(delays: set[Fraction]) -> tuple[dict[Fraction, tuple[int, ...]], list[Fraction]]:
    """Delays as whole multiples of a few units: {delay: multiples of each unit}, and the units.

    Delays that are multiples of one share a unit; others have one of their own, or are sums of those before.
    """
    families: list[list[Fraction]] = []
    sums: dict[Fraction, tuple[Fraction, Fraction]] = {}
    for delay in sorted(delays - {ZERO}):
        for family in families:
            unit = _unit([*family, delay])
            if max(family[-1], delay) <= MOST_MULTIPLES * unit:
                family.append(delay)
                break
        else:
            known = {ZERO, *sums, *(d for family in families for d in family)}
            pair = next(((d, delay - d) for d in known if d and delay - d in known), None)
            if pair:
                sums[delay] = pair
            else:
                families.append([delay])
    units = [_unit(family) for family in families]
    powers = {ZERO: (0,) * len(units)}
    for k, (family, unit) in enumerate(zip(families, units, strict=True)):
        for delay in family:
            powers[delay] = tuple(int(delay / unit) if n == k else 0 for n in range(len(units)))
    for delay, pair in sums.items():
        powers[delay] = tuple(a + b for a, b in zip(*(powers[d] for d in pair), strict=True))
    return powers, units


def _unit(delays: list[Fraction]) -> Fraction:
    """The largest fraction of which all delays are multiples."""
    return Fraction(math.gcd(*(d.numerator for d in delays)), math.lcm(*(d.denominator for d in delays)))


# ------------------------------------------------------------------------------------------------ the fraction


def _operator(method: Callable[[T, DelayFraction], T]) -> Callable[[T, object], T]:
    """An operator whose other side is what `read` understands, but for what Python may ask about it instead."""

    @functools.wraps(method)
    def operator(self: T, other: object) -> T:
        return NotImplemented if isinstance(other, (str, list, tuple, dict)) else method(self, read(other))

    return operator


class DelayFraction:
    """A transfer function with numbers: a fraction of two sums of polynomials in `s`, each with a dead time.

    It is exact, and may be improper, as a PID controller without filter. The operators ``+ - * / **`` work with other
    fractions, expressions in `s`, controllers and numbers; common factors are cancelled, also those that contain dead
    times, if these are multiples of one, up to 60 times it. Called with a complex number, or an array of such, it
    returns its value there.

    Arguments:
        above, below: numerator and denominator, ``{delay: coefficients}`` with whole numbers, the lowest power first.
    Attributes:
        numerator, denominator: the same without common factors; the denominator has a part without dead time, whose
            leading coefficient is positive. The numerator of zero is empty.
    Raises:
        ValueError: if the output would depend on the input of a later time, or the denominator is zero.

    >>> H = read(sympy.exp(-2 * s) / (5 * s + 1))
    >>> H.numerator
    {Fraction(2, 1): (1,)}
    >>> (1 / (1 + H)).expr
    (5*s + 1)/(5*s + 1 + exp(-2*s))
    """

    def __init__(self, above: Quasipolynomial, below: Quasipolynomial = ONE):
        if not below:
            raise ValueError(f"{expression(above)} is divided by 0: expected a denominator that is not zero")
        self.numerator, self.denominator = _cancelled(above, below)
        if early := [delay for delay in (*self.numerator, *self.denominator) if delay < 0]:
            shift = sympy.exp(-sympy.Rational(early[0].numerator, early[0].denominator) * s)
            raise ValueError(f"{self.expr} contains {shift}: a dead time cannot be negative")

    @classmethod
    def _make(cls, above: Quasipolynomial, below: Quasipolynomial) -> Self:
        return cls(above, below)

    @classmethod
    def coprime(cls, above: Quasipolynomial, below: Quasipolynomial) -> DelayFraction:
        """The fraction of two quasipolynomials that are known to be coprime, the denominator with a part at zero."""
        fraction = DelayFraction.__new__(DelayFraction)
        fraction.numerator, fraction.denominator = _ordered(above, below if above else ONE)
        return fraction

    @property
    def fraction(self) -> DelayFraction:
        """The same as a `DelayFraction`, which may become improper."""
        return DelayFraction.coprime(self.numerator, self.denominator)

    @functools.cached_property
    def expr(self) -> sympy.Expr:
        """The transfer function, an expression in `s` with whole coefficients."""
        return expression(self.numerator) / expression(self.denominator)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.expr})"

    def _repr_latex_(self) -> str:
        return typeset(self.expr)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DelayFraction):
            return NotImplemented
        return (self.numerator, self.denominator) == (other.numerator, other.denominator)

    def __hash__(self) -> int:
        return hash((tuple(self.numerator.items()), tuple(self.denominator.items())))

    # ---- algebra

    @_operator
    def __add__(self, other: DelayFraction) -> Self:
        if self.denominator == other.denominator:
            return self._make(plus(self.numerator, other.numerator), self.denominator)
        above = plus(times(self.numerator, other.denominator), times(other.numerator, self.denominator))
        return self._make(above, times(self.denominator, other.denominator))

    def __neg__(self) -> Self:
        return self._make(plus({}, self.numerator, -1), self.denominator)

    @_operator
    def __sub__(self, other: DelayFraction) -> Self:
        return self + -other

    def __rsub__(self, other: object) -> Self:
        return -self + other

    @_operator
    def __mul__(self, other: DelayFraction) -> Self:
        return self._make(times(self.numerator, other.numerator), times(self.denominator, other.denominator))

    @_operator
    def __truediv__(self, other: DelayFraction) -> Self:
        return self._over(self, other)

    @_operator
    def __rtruediv__(self, other: DelayFraction) -> Self:
        return self._over(other, self)

    def _over(self, one: DelayFraction, other: DelayFraction) -> Self:
        if not other.numerator:
            raise ValueError(f"{one.expr} is divided by 0: expected a system that is not zero")
        return self._make(times(one.numerator, other.denominator), times(one.denominator, other.numerator))

    def __pow__(self, n: int) -> Self:
        if isinstance(n, bool) or not hasattr(n, "__index__"):
            return NotImplemented
        n = n.__index__()
        base = self._over(read(1), self) if n < 0 else self
        return self._make(_power(base.numerator, abs(n)), _power(base.denominator, abs(n)))

    __radd__, __rmul__ = __add__, __mul__

    # ---- what it is

    @property
    def order(self) -> int:
        """The degree of the denominator's part without dead time."""
        return len(self.denominator[ZERO]) - 1

    @property
    def is_proper(self) -> bool:
        """Whether no power of `s` anywhere in it is higher than the denominator's without dead time."""
        return max(map(len, (*self.numerator.values(), *self.denominator.values()))) <= self.order + 1

    @property
    def delays(self) -> list[Fraction]:
        """The dead times in the numerator and in the denominator, sorted, without zero.

        >>> read((1 - sympy.exp(-2 * s)) / (s + sympy.exp(-s))).delays
        [Fraction(1, 1), Fraction(2, 1)]
        """
        return sorted({*self.numerator, *self.denominator} - {ZERO})

    @functools.cached_property
    def at_origin(self) -> tuple[int, int, Fraction]:
        """The zeros and the poles at s = 0, and a factor: about zero it is ``factor*s**(zeros - poles)``.

        Zeros of the numerator and of the denominator that only their dead times make count here, too, and where both
        have some, these are removable.

        >>> read((1 - sympy.exp(-2 * s)) / s).at_origin
        (1, 1, Fraction(2, 1))
        """
        (zeros, above), (poles, below) = map(lowest_term, (self.numerator, self.denominator))
        return zeros, poles, above / below

    @property
    def removable(self) -> int:
        """How many zeros at s = 0 numerator and denominator have in common: 1 of ``(1 - exp(-s))/s``."""
        return min(self.at_origin[:2]) if self.numerator else 0

    # ---- values

    def __call__(self, point: complex | ArrayLike) -> np.ndarray:
        """Return the value H(s) at complex points, an array of their shape; not finite at a pole.

        >>> read(1 / (s + 1))(1j)
        np.complex128(0.5-0.5j)
        """
        point = np.asarray(point, dtype=complex)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return (self._value(self.numerator, point) / self._value(self.denominator, point))[()]

    def _value(self, parts: Quasipolynomial, point: np.ndarray) -> np.ndarray:
        leading, total = self.denominator[ZERO][-1], np.zeros(point.shape, dtype=complex)
        for delay, part in parts.items():
            value = np.polyval([c / leading for c in reversed(part)], point)
            total = total + (value * np.exp(-float(delay) * point) if delay else value)
        return total


def expression(parts: Quasipolynomial) -> sympy.Expr:
    """Return a quasipolynomial as an expression in `s`."""
    return sympy.Add(
        *(
            sympy.Add(*(c * s**k for k, c in enumerate(part) if c))
            * sympy.exp(-sympy.Rational(delay.numerator, delay.denominator) * s)
            for delay, part in parts.items()
        )
    )


# ------------------------------------------------------------------------------------------------ reading


def read(value: object) -> DelayFraction:
    """Return the fraction that a transfer function with numbers is.

    Arguments:
        value: an expression in `s` or a number; whatever has one as its attribute `expr`, as a `PID`; a fraction or a
            `System`; or a continuous single-input single-output system of python-control. Coefficients and dead times
            that are no fractions are taken to 30 digits.
    Raises:
        ValueError: for symbols, complex coefficients, what is no such fraction, or an output that would depend on the
            input of a later time.

    >>> read(sympy.exp(-s) / s + 1)
    DelayFraction((s + exp(-s))/s)
    """
    if isinstance(value, DelayFraction):
        return value
    return _of_expression(transfer_function(value))


@functools.lru_cache(maxsize=256)  # one process is read again for each of its controllers
def _of_expression(H: sympy.Expr) -> DelayFraction:
    if letters := sorted(map(str, H.free_symbols - {s})):
        raise ValueError(f"give a number for {', '.join(letters)} in {H}")
    try:
        above, below = _read(H)
    except NoFractionError as reason:
        raise ValueError(f"{H} {reason}") from None
    return DelayFraction(above, below)


class NoFractionError(Exception):
    """What of an expression keeps it from being a fraction of sums of polynomials with dead times."""


def _read(e: sympy.Expr) -> tuple[Quasipolynomial, Quasipolynomial]:
    """Numerator and denominator of an expression, common factors left in."""
    if e == s:
        return {ZERO: (0, 1)}, ONE
    if e.is_Mul:
        above, below = ONE, ONE
        for factor in e.args:
            p, q = _read(factor)
            above, below = times(above, p), below if q == ONE else times(below, q)
        return above, below
    if e.is_Add:
        above, below = {}, ONE
        for term in e.args:
            p, q = _read(term)
            if q == below:
                above = plus(above, p)
            else:
                above, below = plus(times(above, q), times(p, below)), times(below, q)
        return above, below
    if isinstance(e, sympy.exp) and e.has(s):
        number, delay = dead_time_of(e)
        above, below = _read(number)
        return times(above, {rational(delay): (1,)}), below
    if e.is_Pow and e.exp.is_Integer:
        p, q = _read(e.base)
        if e.exp < 0:
            if not p:
                raise NoFractionError(INFINITE)
            p, q = q, p
        return _power(p, abs(int(e.exp))), _power(q, abs(int(e.exp)))
    if e in (sympy.oo, -sympy.oo, sympy.zoo):
        raise NoFractionError(INFINITE)
    if e.is_number:
        number = rational(e)
        return {ZERO: (number.numerator,)} if number else {}, {ZERO: (number.denominator,)}
    raise NoFractionError(NOT_RATIONAL)


def _power(parts: Quasipolynomial, n: int) -> Quasipolynomial:
    return functools.reduce(times, [parts] * n, ONE)


def dead_time_of(e: sympy.exp) -> tuple[sympy.Expr, sympy.Expr]:
    """The number exp(a) and the dead time of ``exp(a - delay*s)``, as a shift of `s` makes it."""
    number, rest = sympy.expand(e.exp).as_independent(s, as_Add=True)
    delay = sympy.expand(-rest / s)
    if delay.has(s) or not number.is_number:
        raise NoFractionError(NOT_RATIONAL)
    return sympy.exp(number), delay


def rational(number: sympy.Expr) -> Fraction:
    """A number itself if it is a fraction, and otherwise with each irrational part of it to 30 digits.

    So the sum of two dead times is, however it is written, the sum of what they are taken for.
    """
    if number.is_Rational:
        return Fraction(int(number.p), int(number.q))
    if number.is_Add:
        return sum(map(rational, number.args), ZERO)
    if number.is_Mul:
        return math.prod(map(rational, number.args), start=Fraction(1))
    if not number.is_real:
        raise ValueError(f"{number} is complex: expected real coefficients")
    return Fraction(str(number.evalf(30)))
