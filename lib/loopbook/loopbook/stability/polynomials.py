"""What needs no digits: the roots of a polynomial on either side of the imaginary axis, by Sturm's chain."""

from __future__ import annotations

from itertools import pairwise
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
    # one has the powers n, n - 2 ..., the other the rest
    one, other = (
        sympy.Poly(
            [c * (-1) ** (k // 2) if (n - k) % 2 == odd else 0 for k, c in enumerate(coefficients)][::-1],
            s,
            domain=sympy.QQ,
        )
        for odd in (0, 1)
    )
    chain = [one, -other if n % 2 == 0 else other]
    while chain[-1]:
        chain.append(-chain[-2].rem(chain[-1]).clear_denoms(convert=True)[1].primitive()[1].set_domain(sympy.QQ))
    chain.pop()
    common = chain[-1]
    if common.degree() and common.count_roots():
        return None
    signs = [[sympy.sign(f.LC()) * side ** f.degree() for f in chain] for side in (-1, 1)]
    changes = [sum(a != b for a, b in pairwise(row)) for row in signs]
    return int(n - (changes[0] - changes[1])) // 2
