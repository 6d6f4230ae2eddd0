"""What needs no digits: the roots of a polynomial on either side of the imaginary axis, by Sturm's chain."""

from __future__ import annotations

import math
from itertools import pairwise, zip_longest
from typing import TYPE_CHECKING

import sympy

from plainmath.expressions import s

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["unstable_roots_of"]


def unstable_roots_of(coefficients: Sequence[int]) -> int | None:
    """Return how many roots of a polynomial, the lowest power first, lie in the right half-plane; None with some on it.

    On the axis its real and its imaginary part are polynomials in the frequency. What they have in common has its roots
    on the axis and in pairs on both sides of it; for the rest, Cauchy's index of their quotient says how many more are
    on the left.

    >>> unstable_roots_of([1, 0, 1]), unstable_roots_of([-1, 0, 1]), unstable_roots_of([10**40, 1, 10**40])
    (None, 1, 0)
    """
    n = len(coefficients) - 1
    # one has the powers n, n - 2 ..., the other the rest, the highest power first
    one, other = (
        [c * (-1) ** (k // 2) if (n - k) % 2 == odd else 0 for k, c in enumerate(coefficients)][::-1] for odd in (0, 1)
    )
    chain = [one, [c if n % 2 else -c for c in _trimmed(other)]]
    while chain[-1]:
        chain.append([-c for c in _remainder(*chain[-2:])])
    chain.pop()
    common = chain[-1]
    if len(common) > 1 and sympy.Poly(common, s).count_roots():
        return None
    signs = [[math.copysign(1, f[0]) * side ** (len(f) - 1) for f in chain] for side in (-1, 1)]
    changes = [sum(a != b for a, b in pairwise(row)) for row in signs]
    return (n - (changes[0] - changes[1])) // 2


def _trimmed(f: list[int]) -> list[int]:
    """Without zeros before the highest power."""
    return f[next((k for k, c in enumerate(f) if c), len(f)) :]


def _remainder(f: list[int], g: list[int]) -> list[int]:
    """A positive multiple of the remainder of f over g, without a common divisor."""
    factor = abs(g[0])
    while len(f) >= len(g):
        quotient = f[0] if g[0] > 0 else -f[0]
        f = _trimmed([factor * a - quotient * b for a, b in zip_longest(f, g, fillvalue=0)])
    divisor = math.gcd(*f) or 1
    return [c // divisor for c in f]
