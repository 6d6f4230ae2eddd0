"""Formulas of the cheat sheet in LaTeX that both Matplotlib and MathML understand, ordered and rounded as books do."""

import sympy
from sympy.printing.latex import LatexPrinter

from loopbook import s

# A product begins with its number and ends with s or t; what is not named here comes between.
FIRST, LAST = ("k", "K", "C", "G", "P", "Q", "a", "c", "d", "zeta", "omega"), ("beta", "tau", "theta", "s", "F", "t")
FUNCTIONS = {"sin": "sin", "cos": "cos", "tan": "tan", "atan": "arctan"}


class Printer(LatexPrinter):
    """SymPy's own, but for the order of factors and terms; fractions are on one line in exponents, and if `flat`."""

    def __init__(self, flat=False):
        super().__init__()
        self.flat = flat

    def fraction(self, above, below):
        if not self.flat:
            return rf"\dfrac{{{self.product(above)}}}{{{self.product(below)}}}"
        under = f"[{self.product(below)}]" if below.is_Mul and below.has(sympy.Add) else self.product(below)
        under = f"({under})" if below.is_Add or (below.is_Mul and under[0] != "[") else under
        return f"{self.product(above) if above.is_Mul else self.bracketed(above)}/{under}"

    def _print_Mul(self, expr):
        sign = ""
        if expr.could_extract_minus_sign():
            expr, sign = -expr, "- "
            if not expr.is_Mul:
                return sign + self.bracketed(expr)
        above, below = sympy.fraction(expr, exact=True)
        if below == 1:
            return sign + self.product(above)
        return sign + self.fraction(above, below)

    def product(self, expr):
        """Factors side by side; a sum that stands alone needs no brackets."""
        if not expr.is_Mul:
            return self._print(expr)
        factors = sorted(expr.args, key=place)
        narrow = ["" if n == 0 or not factor.has(sympy.Function) else r"\," for n, factor in enumerate(factors)]
        return " ".join(space + self.bracketed(factor) for space, factor in zip(narrow, factors, strict=True))

    def bracketed(self, expr):
        text = self._print(expr)
        if not expr.is_Add:
            return text
        return rf"\left({text}\right)" if "frac" in text else f"({text})"

    def _print_Pow(self, expr):
        base, power = expr.as_base_exp()
        if power == sympy.Rational(1, 2):
            return rf"\sqrt{{{self._print(base)}}}"
        if power.is_Integer and power < 0:
            return self.fraction(sympy.S.One, 1 / expr)
        return f"{self.bracketed(base)}^{{{self._print(power)}}}"

    def _print_Add(self, expr, order=None):
        terms = in_order(expr)
        text = self._print(terms[0])
        for term in terms[1:]:
            text += f" - {self._print(-term)}" if term.could_extract_minus_sign() else f" + {self._print(term)}"
        return text

    def _print_Rational(self, expr):
        return str(expr.p) if expr.q == 1 else self.fraction(sympy.Integer(expr.p), sympy.Integer(expr.q))

    def _print_exp(self, expr, exp=None):
        return f"e^{{{Printer(flat=True).doprint(expr.args[0]).replace('- ', '-')}}}"

    def _print_ExpBase(self, expr, exp=None):
        return self._print_exp(expr)

    def _print_Min(self, expr, exp=None):
        return rf"\min({', '.join(self._print(sympy.factor(x)) for x in sorted(expr.args, key=sympy.count_ops))})"

    def _print_Function(self, expr, exp=None):
        (argument,) = expr.args
        text = self._print(argument)
        text = rf"\left({text}\right)" if argument.is_Add or "frac" in text or "/" in text else text
        return rf"\{FUNCTIONS[expr.func.__name__]} {text}"


def place(factor):
    """Where a factor stands in a product."""
    if factor.is_number or (factor.is_Symbol and factor.name[0].isdigit()):
        return 0, 0, ""
    if isinstance(factor, sympy.exp):
        return 4, 0, ""
    base = factor.as_base_exp()[0]
    if not base.is_Symbol:
        return 3 if base.is_Add else 5, 0, str(base)
    letter = base.name.partition("_")[0]
    if letter in FIRST:
        return 1, FIRST.index(letter), base.name
    return 2, LAST.index(letter) + 1 if letter in LAST else 0, base.name


def in_order(sum_):
    """The terms of a sum: falling powers of s (rising ones of a dead time's), or a number first; no minus first."""
    if sum_.is_polynomial(s) and sum_.has(s):
        terms = sorted(sum_.args, key=lambda term: (-sympy.degree(term, s), str(term)))
        turned = terms[0].could_extract_minus_sign() or sum_.has(sympy.Symbol("theta", positive=True))
        return terms[::-1] if turned else terms

    def rank(term):
        return term.could_extract_minus_sign(), term.has(s) and 1 + term.has(sympy.Add), term_place(term)

    return sorted(sum_.args, key=rank)


def term_place(term):
    """Where a term stands in a sum: by the times in it, so that T**2 + 2*zeta*T*tau + tau**2 stays in this order."""
    places = sorted(place(x) for x in sympy.Mul.make_args(term) if not x.is_number)
    return [x for x in places if x[0] > 1] or places


def latex(expr, flat=False):
    """Return an expression in LaTeX; `flat` writes fractions on one line."""
    return Printer(flat).doprint(with_decimals(sympy.sympify(expr)))


def with_decimals(expr):
    """Replace fractions of a decimal kind by decimals, as 9/10 by 0.9, and 10/63 by 1/6.3; halves and such stay."""
    found = {q: decimal(q) for q in expr.atoms(sympy.Rational)}
    found = {q: value for q, value in found.items() if value != q}
    return expr.xreplace(found) if found else expr


def decimal(q):
    if q.is_Integer or (abs(q.p) == 1 and q.q in (2, 3, 4, 8)):
        return q
    if is_decimal(q.q):
        return sympy.Symbol(plain(abs(q)), positive=True) * sympy.sign(q)
    return 1 / sympy.Symbol(plain(1 / q), positive=True) if is_decimal(q.p) and q.p > 1 else q


def is_decimal(n):
    return not set(sympy.primefactors(n)) - {2, 5}


def plain(q):
    return f"{float(q):.4f}".rstrip("0")
