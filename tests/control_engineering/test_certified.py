"""Counts of unstable poles: certified by Arb's balls, validated in double precision, and for polynomials Sturm's."""

import math
import random
from fractions import Fraction

import pytest
import sympy

from loopbook import s
from loopbook.stability import UndecidedError, certified, counting, unstable_closed_loop_poles, unstable_poles
from loopbook.stability.certified import certified_count
from loopbook.stability.polynomials import unstable_roots_of

pytest.importorskip("flint")


def validated(parts, removable=0):
    """The count in double precision alone."""
    with pytest.MonkeyPatch.context() as without:
        without.setattr(certified, "flint", None)
        return counting._count_of(parts, removable, lambda: "the sum")


def quasipolynomial(random):
    """One of order 1 to 8, with up to three dead times from 0.01 to 30 and coefficients over four decades."""
    order = random.randint(1, 8)
    parts = {Fraction(0): (*(random.randint(-999, 9999) for _ in range(order)), random.randint(1000, 9999))}
    for _ in range(random.randint(1, 3)):
        delay = Fraction(random.choice((1, 30, 700, 3000)) + random.randint(0, 20), 100)
        parts[delay] = tuple(random.randint(-3000, 3000) for _ in range(random.randint(1, order)))
    return parts


@pytest.mark.parametrize("seed", range(40))
def test_both_ways_count_the_same(seed):
    for k in range(3):
        parts = quasipolynomial(random.Random(f"{seed}.{k}"))
        assert certified_count(parts) == validated(parts), parts


@pytest.mark.parametrize("seed", range(20))
def test_a_polynomial_is_counted_as_sturm_does(seed):
    chance = random.Random(seed)
    row = (*(chance.choice((1, 1, 1, -1)) * chance.randint(1, 10**6) for _ in range(chance.randint(1, 12))), 7)
    assert certified_count({Fraction(0): row}) == unstable_roots_of(row)


def test_a_moving_average_has_no_pole_at_zero():
    average = {Fraction(0): (1, 4, 4), Fraction(1): (-1,)}  # of (1 - exp(-s) + 4 s + 4 s**2)/s
    assert certified_count(average, removable=1) == validated(average, removable=1) == 0


@pytest.mark.parametrize(("share", "count"), [(-(10**-15), 0), (10**-15, 2), (-1e-20, 0), (1e-20, 2)])
def test_what_double_precision_does_not_tell_is_certified(share, count):
    gain = sympy.pi.evalf(40) / 2 * (1 + sympy.Float(str(share), 40))
    L = sympy.Rational(str(gain)) * sympy.exp(-s) / s
    assert unstable_closed_loop_poles(L) == count
    parts = counting.characteristic(counting.open_loop(L))
    with pytest.raises(UndecidedError, match="between the frequencies"):
        validated(parts)


def test_what_is_on_the_axis_is_not_certified():
    with pytest.raises(UndecidedError):
        certified_count({Fraction(0): (1, 1, 1, 1)})  # (s + 1)(s**2 + 1)


def test_what_no_lemma_covers_is_validated():
    neutral = {Fraction(0): (3, 1), Fraction(1): (0, Fraction(3, 2))}
    assert certified_count({Fraction(0): (6, 2), Fraction(1): (0, 3)}) is None
    assert counting.unstable_roots(neutral) == math.inf
    assert unstable_poles(1 / (s + 2 + sympy.exp(-s) * s / 3)) == 0
