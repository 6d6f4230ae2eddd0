"""The roots of a sum with dead times in the right half-plane, counted with a certificate: in balls, by Arb.

Each number is a ball that holds what it stands for, rounded outwards, so what is proved with it is true whatever the
rounding is. Where a ball is too wide to decide, the question is asked again with more digits. The lemmas are in
docs/stability.md.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

from loopbook.quasipolynomials.arrays import DEGREE
from loopbook.quasipolynomials.fraction import taylor_coefficient
from loopbook.stability.enclosures import UndecidedError

try:
    import flint
    from flint import acb, acb_poly, acb_series, arb, fmpq
except ImportError:  # it is an extra, and the page's Python has none
    flint = None

if TYPE_CHECKING:
    from loopbook.quasipolynomials.fraction import Quasipolynomial

BITS = (128, 512, 2048)  # of the balls, tried in turn where a value is not told from zero
NARROWEST = 2.0**-80  # of an interval, as a share of its frequency; what is no fraction is known to 30 digits
MOST_INTERVALS = 2_000


def certified_count(parts: Quasipolynomial, removable: int = 0) -> int | None:
    """Return the number of roots in the right half-plane of ``{delay: coefficients}``, certified.

    Arguments:
        parts: one without dead time that has the highest power, and others. The sum has as many roots at zero as are
            removable, and no more.
        removable: how many roots at zero do not count.
    Returns:
        An integer; None where it is not certified: without python-flint, where the highest powers with dead times are
        together as strong as the one without, and where 2,000 intervals of frequency are not enough.
    Raises:
        UndecidedError: for roots that are on the axis, or closer to it than 2,048 binary digits tell.
    Source: Mikhailov's criterion, by the lemmas of docs/stability.md.

    >>> certified_count({Fraction(0): (0, 1), Fraction(1): (2,), Fraction(7, 5): (1,)})    # s + 2 exp(-s) + exp(-1.4 s)
    2
    """
    order, highest = len(parts[Fraction(0)]) - 1, parts[Fraction(0)][-1]
    end = flint and _prevailing(parts, order)
    if end is None:
        return None
    with flint.ctx.workprec(BITS[0]):
        whole, first = _Balls(parts), _Balls({Fraction(0): parts[Fraction(0)]})
        others = [acb_poly(list(part)) for delay, part in parts.items() if delay]
        end = _ball(end)
        start, turned = _from_zero(parts, whole, removable, end)
        # of n roots on the left each turns the phase by a quarter turn, the last part of it beyond the end
        turned -= (whole.at(end) / (acb(0, end) ** order * highest)).arg()
        intervals = []
        while start < end:  # powers of two, so that the middle of an interval is a number of few digits
            intervals.append((start, whole.at(start), 4 * start, whole.at(4 * start)))
            start *= 4
        for _ in range(MOST_INTERVALS):
            if not intervals:
                count = (arb(order - removable) / 2 - turned / arb.pi()).unique_fmpz()
                return None if count is None else int(count)
            a, at_a, b, at_b = intervals.pop()
            c = (a + b) / 2
            at_c, is_decided = _is_about(whole, c, b - c)
            if is_decided:
                turned += (at_b / at_c).arg() - (at_a / at_c).arg()
            elif _is_about(first, c, b - c, others)[1]:
                # the part without dead time outweighs the others, whose share of the phase is below a quarter turn
                one, other = first.at(a), first.at(b)
                turned += (other / one).arg() + (at_b / other).arg() - (at_a / one).arg()
            elif b - a < NARROWEST * b:
                raise UndecidedError("the number of unstable poles", float(a), float(b))
            else:
                intervals += [(c, at_c, b, at_b), (a, at_a, c, at_c)]
    return None


def _prevailing(parts, order):
    """A power of two, as a frequency beyond which the highest power outweighs all other terms; None without one."""
    sizes = [sum(abs(part[i]) for part in parts.values() if i < len(part)) for i in range(order + 1)]
    reserve = 2 * abs(parts[Fraction(0)][-1]) - sizes.pop()
    if reserve <= 0:
        return None
    # Fujiwara's bound: there each lower term is below a half, a quarter, an eighth ... of the highest
    bounds = ((math.log2(size) - math.log2(reserve)) / (order - i) for i, size in enumerate(sizes) if size)
    return Fraction(2) ** math.ceil(1 + 1e-9 + max(bounds, default=-1))


def _from_zero(parts, whole, removable, end):
    """A frequency up to which a sum is about its lowest power, that of the roots at zero, and the turn of the rest."""
    degree = removable + DEGREE + 1
    series = [_ball(taylor_coefficient(parts, k)) for k in range(removable, degree)]
    # on the axis exp(-delay*s) has the size 1, and its derivatives those of powers of the dead time
    sizes = _Balls({delay: tuple(map(abs, part)) for delay, part in parts.items()}, degree)
    while not _spread(series, sizes.most(end, degree), end) < abs(series[0]):
        end /= 4
    return end, (whole.at(end) / acb(0, end) ** removable / series[0]).arg()


def _is_about(one, c, r, others=()):
    """The value in the middle of an interval, and whether all lie in a disc about it without zero, others added."""
    for bits in BITS:
        with flint.ctx.workprec(bits):
            around = acb(0, arb(c, r))
            if r * one.longest > 2:
                return one.at(c), False
            terms = one.taylor(acb(0, c))
            rest = one.taylor(around, DEGREE + 1)[DEGREE + 1]
            spread = _spread(terms, rest, r) + sum(abs(other(around)) for other in others)
            if spread < abs(terms[0]):
                return terms[0], True
            if terms[0].rad() * 16 < abs(terms[0]):
                break
    return terms[0], False


def _spread(terms, rest, r):
    """How far values within r are from that in the middle, at most."""
    return sum((abs(terms[k]) * r**k for k in range(1, DEGREE + 1)), abs(rest) * r ** (DEGREE + 1))


class _Balls:
    """A quasipolynomial, as what its expansions on the axis are made of.

    Attributes:
        parts: of each the dead time, and the derivatives of its polynomial over 0!, 1!, 2! ...
    """

    def __init__(self, parts: Quasipolynomial, degree: int = DEGREE + 1):
        self.longest, self.parts = _ball(max(parts, default=Fraction(0))), []
        for delay, part in parts.items():
            rows = ([math.comb(n, k) * c for n, c in enumerate(part)][k:] for k in range(degree + 1))
            late = (Fraction((-delay) ** k, math.factorial(k)) for k in range(degree + 1))
            self.parts.append((delay, [acb_poly(row) for row in rows], list(late)))

    def taylor(self, s: acb, degree: int = DEGREE) -> acb_series:
        """The coefficients of the powers of h in the value at s + h."""
        total = acb_series([], degree + 1)
        for delay, derivatives, late in self.parts:
            value = acb_series([derivative(s) for derivative in derivatives[: degree + 1]], degree + 1)
            if delay:
                value *= acb_series([_ball(c) for c in late[: degree + 1]], degree + 1) * (-s * _ball(delay)).exp()
            total += value
        return total

    def at(self, w: arb) -> acb:
        """The value at s = j w."""
        return self.taylor(acb(0, w), 0)[0]

    def most(self, w: arb, degree: int) -> arb:
        """A bound of that coefficient up to a frequency, for coefficients that are not negative."""
        return sum(
            derivatives[degree - k](w).real * abs(_ball(late[k]))
            for _, derivatives, late in self.parts
            for k in range(degree + 1)
        )


def _ball(number: Fraction) -> arb:
    return arb(fmpq(number.numerator, number.denominator))
