"""Sums of polynomials in `s`, each with a dead time ``exp(-delay*s)``: exact ones, their fractions, and many in
numbers.

In mathematics such a sum is a quasipolynomial. The characteristic equation of a loop with dead time is one, and has
infinitely many roots.
"""

from loopbook.quasipolynomials.fraction import DelayFraction, read
from loopbook.quasipolynomials.symbols import normal_form

__all__ = ["DelayFraction", "normal_form", "read"]
