"""The residue method for one dead time, step by step and with symbols."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from loopbook.quasipolynomials import normal_form
from plainmath.expressions import s

__all__ = ["ResidueMethod", "residue_method"]


@dataclass(frozen=True)
class ResidueMethod:
    """The residue method for one dead time, step by step: what `residue_method` returns.

    ``E(s) = (B + D z)/(A + C z)`` with ``z = exp(-delay*s)``. Where ``A + C z = 0``, z is -A/C, and E(-s) is the
    rational function ``G(s) = (A B* - C D*)/(A A* - C C*)``, a star meaning -s for s. So ``E(s) (E(-s) - G(s))`` has no
    poles there, and the integral of e(t)^2 is minus the sum of the residues of ``E(s) G(s)`` at the zeros of
    ``Delta = A A* - C C*``.

    Attributes:
        A, B, C, D: polynomials, expressions in `s`.
        delay: the dead time.
    """

    A: sympy.Expr
    B: sympy.Expr
    C: sympy.Expr
    D: sympy.Expr
    delay: sympy.Expr

    @property
    def E(self) -> sympy.Expr:
        """The transform of the error, beginning where e(t) does if that leaves one dead time instead of two."""
        z = sympy.exp(-self.delay * s)
        return (self.B + self.D * z) / (self.A + self.C * z)

    @property
    def Delta(self) -> sympy.Expr:
        """A(s) A(-s) - C(s) C(-s), a polynomial in s^2."""
        return sympy.expand(self.A * _mirrored(self.A) - self.C * _mirrored(self.C))

    @property
    def G(self) -> sympy.Expr:
        """The rational function that E(-s) equals at the poles of E(s)."""
        return sympy.expand(self.A * _mirrored(self.B) - self.C * _mirrored(self.D)) / self.Delta

    @property
    def integrand(self) -> sympy.Expr:
        """``E(s) G(s)``."""
        return self.E * self.G

    @property
    def poles(self) -> list[sympy.Expr]:
        """The zeros of Delta, a list in which each one is followed by its negative."""
        return [sign * sympy.sqrt(x) for x, _ in _squares(self.Delta) for sign in (1, -1)]

    @property
    def expr(self) -> sympy.Expr:
        """The integral of e(t)^2 as an expression, if the loop is stable, which is not examined.

        A zero p of Delta in the right half-plane is taken together with -p: the two residues have the sum F(p), in
        which no exponential grows, and which remains valid if A and C have a common zero at -p (as in regulator mode
        if Ti is equal to the lag), where the residue itself is not defined. A pair on the axis gives Re F(j omega).
        """
        formula, zeros = self.formula
        return formula.subs(zeros)

    @property
    def formula(self) -> tuple[sympy.Expr, dict[sympy.Symbol, sympy.Expr]]:
        """The same with symbols for the zeros of Delta, and what they stand for: an expression and a dictionary.

        The symbols are sigma for a pair on the real axis and omega for one on the imaginary axis, numbered if there are
        several.
        """
        total, zeros = sympy.S.Zero, {}
        squares = _squares(self.Delta)
        for number, (x, sign) in enumerate(squares, start=1):
            if sign is None:
                if x.is_number or self.C == 0:  # not on the axis, so that its root lies to the right
                    p = sympy.Dummy("p")
                    total -= self._share(p, 1).subs(p, sympy.sqrt(x))
                else:
                    total -= self._plain_share(x)
                continue
            name = "sigma" if sign > 0 else "omega"
            if [other for _, other in squares].count(sign) > 1:
                name += f"_{number}"
            p = sympy.Symbol(name, positive=True)
            zeros[p] = sympy.sqrt(sign * x)
            total -= self._share(p, sign)
        return total, zeros

    def _plain_share(self, x):
        """The residues of E G at a zero and its negative, where symbols leave open where they lie."""
        residue = self.integrand * self.Delta / self.Delta.diff(s)
        return residue.subs(s, sympy.sqrt(x)) + residue.subs(s, -sympy.sqrt(x))

    def _share(self, p, sign):
        """The same at p and -p with sign 1, or at j p and -j p with sign -1, p being positive."""
        parts = self.A, self.B, self.C, self.D
        A, B, C, D, slope, *mirrored = (
            sympy.expand(part.subs(s, p if sign > 0 else sympy.I * p))
            for part in (*parts, self.Delta.diff(s), *map(_mirrored, parts))
        )
        if sign > 0:
            z = sympy.Dummy("z")
            above, below = both_residues(A, B, C, D, mirrored[1], mirrored[3], z), (A + C * z) * slope
            return (sympy.factor(above) / sympy.factor(below)).subs(z, sympy.exp(-p * self.delay))
        above, below = _on_axis(A, B, C, D, *mirrored, p * self.delay)
        return sympy.factor(above) / sympy.factor(sympy.expand(below * slope / sympy.I))


def both_residues(A: Any, B: Any, C: Any, D: Any, B_mirrored: Any, D_mirrored: Any, z: Any) -> Any:
    """Delta' times (A + C z) times the sum of the residues of E G at p and -p, all functions taken at p.

    At -p take that of ``E (E* - G)`` instead, which is ``(B + D z)(A* D* - B* C*)/((A* z + C*) Delta)``: the same but
    for its sign, and its denominator has no zero there if the loop is stable. They are expressions or arrays.
    """
    return (B * B_mirrored + D * D_mirrored) * (A - C * z) + 2 * (A * D * B_mirrored * z - B * C * D_mirrored)


def _on_axis(A, B, C, D, A_mirrored, B_mirrored, C_mirrored, D_mirrored, angle):
    """The same at ``p = j omega``, real by ``A A* = C C*`` once ``(A* + C* / z)`` is put above and below the bar."""
    z = sympy.cos(angle) - sympy.I * sympy.sin(angle)
    one, other = sympy.expand(A * C_mirrored), sympy.expand(D * B_mirrored)
    real, imaginary = sympy.expand(one * z.conjugate()).as_real_imag()
    size = sympy.expand(A * A_mirrored)
    above = sympy.expand(B * B_mirrored + D * D_mirrored) * imaginary
    above += 2 * size * sympy.im(sympy.expand(other * z)) + 2 * sympy.im(sympy.expand(one * other))
    return above, size + real


def _mirrored(part):
    return part.subs(s, -s)


def _squares(Delta):
    """The zeros of a polynomial in s^2, as pairs (s^2, its sign or None where that is open or it is complex)."""
    x = sympy.Symbol("x")
    even = sympy.Poly(Delta, s)
    if even.is_zero:
        raise ValueError("A A* and C C* are equal, so that the residue method does not apply")
    found = []
    for factor, n in sympy.factor_list(sympy.Poly({(k // 2,): c for (k,), c in even.terms()}, x).as_expr(), x)[1]:
        polynomial = sympy.Poly(factor, x)
        c, *higher = reversed(polynomial.all_coeffs())
        if n > 1 or c == 0:
            raise ValueError(f"{Delta} has a repeated zero: expected simple ones; `ise` integrates by another method")
        if len(higher) == 1:
            roots = [sympy.factor(-c / higher[0])]
            found += [(roots[0], _sign(roots[0]))]
        elif len(higher) == 2:
            b, a = higher
            root = sympy.sqrt(sympy.factor(b**2 - 4 * a * c))
            if _sign(sympy.factor(c / a)) == -1:  # one on either side of zero
                a, b = (a, b) if _sign(a) == 1 else (-a, -b) if _sign(a) == -1 else (a, b)
            roots = [(-b + root) / (2 * a), (-b - root) / (2 * a)]
            apart = _sign(sympy.factor(c / a)) == -1 and _sign(a) == 1
            found += [(roots[0], 1), (roots[1], -1)] if apart else [(root, _sign(root)) for root in roots]
        else:
            raise ValueError(f"the zeros of {Delta} are not known in radicals; `ise` finds them in numbers")
    return found


def _sign(value):
    return 1 if value.is_positive else -1 if value.is_negative else None


def residue_method(E: sympy.Expr) -> ResidueMethod:
    """Return the pieces of the residue method for an error with one dead time, symbols allowed.

    Arguments:
        E: expression in `s`, a fraction of polynomials with dead time, all dead times the same apart from one that the
            whole numerator has.
    Returns:
        A `ResidueMethod`.
    Raises:
        ValueError: for different dead times.
    Source: Syder, Heeg and O'Dwyer, equations (2) and (3), derived for any such error.

    >>> k, delay = sympy.symbols("k delay", positive=True)
    >>> method = residue_method(1 / (s + k * sympy.exp(-delay * s)))
    >>> method.Delta, method.G, method.poles
    (-k**2 - s**2, s/(-k**2 - s**2), [I*k, -I*k])
    >>> method.expr
    -cos(delay*k)/(2*(k*sin(delay*k) - k))
    """
    above, below = normal_form(E)
    later = {*above, *below} - {0}
    if len(later) > 1:
        common = next((d for d in above if all((other - d).is_nonnegative for other in above)), 0)
        above = {sympy.expand(d - common): part for d, part in above.items()}
        later = {*above, *below} - {0}
    if len(later) > 1:
        raise ValueError(f"{E} has the dead times {', '.join(sorted(map(str, later)))}: expected one")
    delay = next(iter(later), sympy.S.Zero)
    now, late = ([side[d].as_expr() if d in side else sympy.S.Zero for side in (below, above)] for d in (0, delay))
    return ResidueMethod(*now, *(late if delay else [sympy.S.Zero] * 2), delay)
