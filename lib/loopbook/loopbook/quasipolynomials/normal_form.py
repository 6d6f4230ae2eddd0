"""The normal form of a transfer function with symbols: a fraction of sums of polynomials with dead times."""

from __future__ import annotations

import math

import sympy

from loopbook.quasipolynomials.fraction import MOST_MULTIPLES
from loopbook.transfer import transfer_function
from plainmath.expressions import s

__all__ = ["normal_form"]


def normal_form(H: object) -> tuple[dict[sympy.Expr, sympy.Poly], dict[sympy.Expr, sympy.Poly]]:
    """Return numerator and denominator of a transfer function, each a sum of polynomials with dead times.

    Common factors are cancelled, also those that contain dead times, if these are multiples of one, up to 60 times it.

    Arguments:
        H: expression in `s`, rational in `s` and in dead times ``exp(-delay*s)``, which may stand anywhere. Other
            symbols are allowed, in delays too. Or a `System`.
    Returns:
        Two dictionaries ``{delay: polynomial}``, the polynomials as SymPy ``Poly`` in `s`. The denominator has a part
        without dead time.
    Raises:
        ValueError: if H is no such fraction, or its output depends on the input of a later time.

    >>> numerator, denominator = normal_form(1 / (s + 2 * sympy.exp(-s)))
    >>> {delay: part.as_expr() for delay, part in denominator.items()}
    {0: s, 1: 2}
    """
    H = transfer_function(H)
    if H.has(sympy.oo, sympy.zoo):
        raise ValueError(f"{H} is infinite: expected a transfer function")
    H = H.xreplace({exponential: _split(exponential) for exponential in H.atoms(sympy.exp)})
    powers, delays = _dead_times(H)
    letters = sorted(H.free_symbols - {s}, key=str)
    field = sympy.QQ.frac_field(s, *delays, *letters)
    known = dict(zip(field.symbols, field.gens, strict=True))
    known |= {exponential: known[symbol] ** n for exponential, (symbol, n) in powers.items()}
    try:
        fraction = _in_field(H, field, known)
    except ZeroDivisionError:
        raise ValueError(f"{H} is infinite: expected a transfer function") from None
    except _NotRationalError:
        raise ValueError(f"{H} is not a rational function of s and dead times exp(-delay*s)") from None
    above, below = (_collected(part, list(delays.values()), letters) for part in (fraction.numer, fraction.denom))
    base = next((d for d in below if all((other - d).is_nonnegative for other in below)), None)
    if base is None:
        raise ValueError(f"the dead times {', '.join(map(str, below))} cannot be ordered: give numbers for symbols")
    above, below = ({delay - base: part for delay, part in parts.items()} for parts in (above, below))
    for delay in above:
        if not delay.is_nonnegative:
            raise ValueError(f"{H} contains exp({-delay * s}): a dead time cannot be negative")
    return above, below


def _split(exponential):
    """``exp(a - delay*s)``, as a shift of `s` makes it, with the number exp(a) to 30 digits as a factor."""
    number, rest = sympy.expand(exponential.exp).as_independent(s, as_Add=True)
    return _rational(sympy.exp(number)) * sympy.exp(rest) if number.is_number and rest.has(s) else exponential


def _dead_times(H):
    """Symbols for the dead times in H: {exponential: (symbol, power)} and {symbol: dead time}.

    Dead times that are multiples of a common one are powers of one symbol, so that common factors are seen.
    """
    families = []
    for exponential in sorted(H.atoms(sympy.exp), key=str):
        if not exponential.has(s):
            continue
        delay = -sympy.expand(exponential.exp / s)
        if delay.has(s):
            raise ValueError(f"{H} is not a rational function of s and dead times exp(-delay*s)")
        delay = _rational(delay) if delay.is_number else delay
        for family in families:
            ratio = sympy.cancel(delay / family[0][1])
            if ratio.is_Rational:
                family.append((exponential, delay, ratio))
                break
        else:
            families.append([(exponential, delay, sympy.S.One)])
    powers, delays = {}, {}
    for family in families:
        ratios = [ratio for *_, ratio in family]
        unit = sympy.Rational(math.gcd(*(r.p for r in ratios)), math.lcm(*(r.q for r in ratios)))
        base = unit * family[0][1]
        unit *= -1 if base.could_extract_minus_sign() else 1
        if max(abs(r / unit) for r in ratios) <= MOST_MULTIPLES:
            symbol = sympy.Dummy()
            delays[symbol] = unit * family[0][1]
            powers |= {exponential: (symbol, int(ratio / unit)) for exponential, _, ratio in family}
        else:
            for exponential, delay, _ in family:
                symbol = sympy.Dummy()
                sign = -1 if delay.could_extract_minus_sign() else 1
                delays[symbol] = sign * delay
                powers[exponential] = symbol, sign
    return powers, delays


class _NotRationalError(Exception):
    """An expression is no fraction of polynomials in the known symbols."""


def _in_field(expression, field, known):
    """An expression as an element of a field of fractions, which cancels common factors."""

    def read(e):
        if e in known:
            return known[e]
        if e.is_number:
            e = _rational(e)
            return field(sympy.QQ(e.p, e.q))
        if e.is_Add:
            return sum(map(read, e.args), field.zero)
        if e.is_Mul:
            return math.prod(map(read, e.args), start=field.one)
        if e.is_Pow and e.exp.is_Integer:
            return read(e.base) ** int(e.exp)
        raise _NotRationalError

    return read(expression)


def _rational(number):
    """A number itself if it is a fraction, and otherwise to 30 digits."""
    if number.is_Rational:
        return number
    if not number.is_real:
        raise ValueError(f"{number} is complex: expected real coefficients")
    return sympy.Rational(str(number.evalf(30)))


def _collected(part, delays, letters):
    """A polynomial in s, symbols for dead times and other symbols, as {delay: polynomial in s}."""
    collected = {}
    for (power, *powers), coefficient in part.terms():
        delay = sympy.Add(*(n * d for n, d in zip(powers, delays, strict=False)))
        others = sympy.Mul(*(x**n for x, n in zip(letters, powers[len(delays) :], strict=True)))
        terms = collected.setdefault(sympy.expand(delay), {})
        terms[power,] = terms.get((power,), 0) + sympy.Rational(coefficient.numerator, coefficient.denominator) * others
    polynomials = {delay: sympy.Poly.from_dict(terms, s) for delay, terms in collected.items()}
    kept = {delay: polynomial for delay, polynomial in polynomials.items() if not polynomial.is_zero}
    return dict(sorted(kept.items(), key=lambda item: sympy.default_sort_key(item[0])))
