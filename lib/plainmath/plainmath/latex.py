"""Formulas in LaTeX that both Matplotlib and MathML understand, with factors and terms in the order of books.

Powers of s fall, as in s - a, and s is behind its coefficient, as in tau s; among the rest numbers come first, as in
1 + G, and a minus does not. Decimal numbers are written as such.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import sympy
from sympy.core.function import AppliedUndef
from sympy.printing.latex import LatexPrinter, greek_letters_set, other_symbols

from plainmath.expressions import s, t, written

if TYPE_CHECKING:
    from plainmath.types import Number

__all__ = ["GREEK", "equalities", "latex"]

GREEK = {"alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi",
          "pi", "rho", "sigma", "tau", "phi", "chi", "psi", "omega"}  # fmt: skip

_LETTERS = GREEK | greek_letters_set | other_symbols
# A product begins with its number and ends with s or t; what is not named here comes between.
_FIRST, _LAST = ("k", "K", "C", "G", "P", "Q", "a", "c", "d", "zeta", "omega"), ("beta", "tau", "theta", "s", "F", "t")
_FUNCTIONS = {"sin": "sin", "cos": "cos", "tan": "tan", "atan": "arctan"}


class _Printer(LatexPrinter):
    """SymPy's own, but for the order of factors and terms; fractions are on one line in exponents, and if ``flat``."""

    def __init__(self, flat=False):
        super().__init__({"full_prec": False})
        self.flat = flat

    def _print_Symbol(self, expr, style="plain"):
        name = expr.name
        if name.endswith("_tilde"):
            return rf"\tilde{{{self._print(sympy.Symbol(name.removesuffix('_tilde')))}}}"
        is_word = len(name) > 2 and name.isalpha() and name.lower() not in _LETTERS  # such as a unit
        return rf"\mathrm{{{name}}}" if is_word else super()._print_Symbol(expr).replace(" ", ",")

    def _fraction(self, above, below):
        if not self.flat:
            return rf"\dfrac{{{self._product(above)}}}{{{self._product(below)}}}"
        under = f"[{self._product(below)}]" if below.is_Mul and below.has(sympy.Add) else self._product(below)
        under = f"({under})" if below.is_Add or (below.is_Mul and under[0] != "[") else under
        return f"{self._product(above) if above.is_Mul else self._bracketed(above)}/{under}"

    def _print_Mul(self, expr):
        sign = ""
        if expr.could_extract_minus_sign():
            expr, sign = _without_minus(expr)
            if not expr.is_Mul:
                return sign + self._bracketed(expr)
        above, below = sympy.fraction(expr, exact=True)
        if below == 1:
            return sign + self._product(above)
        return sign + self._fraction(above, below)

    def _product(self, expr):
        """Factors side by side; a sum that stands alone needs no brackets."""
        if not expr.is_Mul:
            return self._print(expr)
        factors = sorted(expr.args, key=_place)
        narrow = [r"\," if n and _is_elementary(factor) else "" for n, factor in enumerate(factors)]
        return " ".join(space + self._bracketed(factor) for space, factor in zip(narrow, factors, strict=True))

    def _bracketed(self, expr):
        text = self._print(expr)
        if not expr.is_Add:
            return text
        return rf"\left({text}\right)" if "frac" in text else f"({text})"

    def _print_Pow(self, expr):
        base, power = expr.as_base_exp()
        if power == sympy.Rational(1, 2):
            return rf"\sqrt{{{self._print(base)}}}"
        if power.is_Integer and power < 0:
            return self._fraction(sympy.S.One, 1 / expr)
        if isinstance(base, sympy.Function) and not isinstance(base, AppliedUndef):
            return super()._print_Pow(expr)
        return f"{self._bracketed(base)}^{{{_Printer(flat=True).doprint(power)}}}"

    def _print_Add(self, expr, order=None):
        terms = _in_order(expr)
        text = self._print(terms[0])
        for term in terms[1:]:
            text += f" - {self._print(-term)}" if term.could_extract_minus_sign() else f" + {self._print(term)}"
        return text

    def _print_Rational(self, expr):
        sign = "-" if expr.p < 0 else ""
        return str(expr.p) if expr.q == 1 else sign + self._fraction(sympy.Integer(abs(expr.p)), sympy.Integer(expr.q))

    def _print_exp(self, expr, exp=None):
        return f"e^{{{_Printer(flat=True).doprint(expr.args[0]).replace('- ', '-')}}}"

    def _print_ExpBase(self, expr, exp=None):
        return self._print_exp(expr)

    def _print_Min(self, expr, exp=None):
        if exp is not None:
            return super()._print_Min(expr, exp)
        return rf"\min({', '.join(self._print(sympy.factor(x)) for x in sorted(expr.args, key=sympy.count_ops))})"

    def _print_Function(self, expr, exp=None):
        if isinstance(expr, AppliedUndef):
            name = self._print(sympy.Symbol(expr.func.__name__)) + ("" if exp is None else f"^{{{exp}}}")
            return f"{name}({', '.join(map(self._print, expr.args))})"
        if exp is not None or expr.func.__name__ not in _FUNCTIONS:
            return super()._print_Function(expr, exp)
        (argument,) = expr.args
        text = self._print(argument)
        text = rf"\left({text}\right)" if argument.is_Add or "frac" in text or "/" in text else text
        return rf"\{_FUNCTIONS[expr.func.__name__]} {text}"


def _without_minus(product):
    """A product without its minus, and the sign before it: none where a difference in it is turned around instead."""
    for factor in sympy.Mul.make_args(product):
        base, power = factor.as_base_exp()
        signs = {term.could_extract_minus_sign() for term in base.args} if base.is_Add else set()
        if power in (1, -1) and len(signs) == 2:
            return -product / factor * sympy.Pow(sympy.Add(*(-term for term in base.args)), power), ""
    return -product, "- "


def _is_elementary(factor):
    """Whether there is a function in a factor such as exp or sin, which stands off a little from what is before it."""
    return any(not isinstance(one, AppliedUndef) for one in factor.atoms(sympy.Function))


def _place(factor):
    """Where a factor stands in a product."""
    if factor.is_number or (factor.is_Symbol and factor.name[0].isdigit()):
        return 0, 0, ""
    if isinstance(factor, sympy.exp):
        return 4, 0, ""
    base = factor.as_base_exp()[0]
    if base.is_Add and not base.has(s, t):
        return 2, _LAST.index("s"), str(base)
    if not base.is_Symbol:
        return 3 if base.is_Add else 5, 0, str(base)
    letter = base.name.partition("_")[0]
    if letter in _FIRST:
        return 1, _FIRST.index(letter), base.name
    return 2, _LAST.index(letter) + 1 if letter in _LAST else 0, base.name


def _in_order(sum_):
    """The terms of a sum: falling powers of s (rising ones of a dead time's), or a number first; no minus first."""
    if sum_.is_polynomial(s) and sum_.has(s):
        terms = sorted(sum_.args, key=lambda term: (-sympy.degree(term, s), str(term)))
        turned = terms[0].could_extract_minus_sign() or "theta" in map(str, sum_.free_symbols)
        return terms[::-1] if turned else terms

    def rank(term):
        return term.could_extract_minus_sign(), term.has(s) and 1 + term.has(sympy.Add), _term_place(term)

    return sorted(sum_.args, key=rank)


def _term_place(term):
    """Where a term stands in a sum: by the times in it, so that ``T**2 + 2*zeta*T*tau + tau**2`` keeps its order."""
    places = sorted(_place(x) for x in sympy.Mul.make_args(term) if not x.is_number)
    return [x for x in places if x[0] > 1] or places


def latex(expr: Number, flat: bool = False) -> str:
    r"""Return an expression in LaTeX as books write it.

    Arguments:
        expr: a number or an expression of SymPy.
        flat: whether fractions stand on one line, as in tables.

    >>> K, a, tau = sympy.symbols("K a tau")
    >>> print(latex(K * sympy.exp(-tau * s) / (s - a)))
    \dfrac{K \,e^{-\tau s}}{s - a}
    >>> print(latex(sympy.Rational(9, 10) * K / (tau * s + 1), flat=True))
    0.9 K/(\tau s + 1)
    """
    return _Printer(flat).doprint(_with_decimals(sympy.sympify(expr)))


def _with_decimals(expr):
    """Replace fractions of few decimals by these, as 9/10 by 0.9, and 10/63 by 1/6.3; halves and such stay."""
    found = {q: _decimal(q) for q in expr.atoms(sympy.Rational)}
    found = {q: value for q, value in found.items() if value != q}
    return expr.xreplace(found) if found else expr


def _decimal(q):
    if q.is_Integer or (abs(q.p) == 1 and q.q in (2, 3, 4, 8)):
        return q
    if _is_decimal(q.q):
        return sympy.Symbol(_plain(abs(q)), positive=True) * sympy.sign(q)
    return 1 / sympy.Symbol(_plain(1 / q), positive=True) if q.p in (10, 100) else q


def _is_decimal(n):
    return 10**4 % n == 0


def _plain(q):
    return f"{float(q):.4f}".rstrip("0")


def equalities(values: Mapping[str, sympy.Expr]) -> str:
    r"""Return named values as LaTeX between dollar signs, for the display of settings and models.

    Arguments:
        values: ``{symbol as LaTeX: value}``.

    >>> print(equalities({"K_p": sympy.Rational(1, 2), "T_i": 3 * sympy.Symbol("tau")}))
    $\displaystyle K_p = \dfrac{1}{2}, \quad T_i = 3 \tau$
    """
    texts = ((x, value, written(value)) for x, value in values.items())
    shown = (f"{x} = {latex(value) if text == str(value) else text}" for x, value, text in texts)
    return r"$\displaystyle " + r", \quad ".join(shown) + "$"
