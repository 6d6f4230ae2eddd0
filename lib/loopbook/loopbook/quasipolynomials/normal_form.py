"""The normal form of a transfer function with symbols: a fraction of sums of polynomials with dead times."""

from __future__ import annotations

import math

import sympy

from loopbook.quasipolynomials.fraction import MOST_MULTIPLES, NoFractionError, dead_time_of, earlier, rational
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
    letters = sorted(H.free_symbols - {s}, key=str)
    try:
        powers, delays = _dead_times(H)
        rational_function = H.xreplace(powers).replace(_is_irrational, _rational)
        if not rational_function.is_rational_function(s, *delays, *letters):
            raise NoFractionError
        fraction = sympy.QQ.frac_field(s, *delays, *letters).from_sympy(rational_function)
    except ZeroDivisionError:
        raise ValueError(f"{H} is infinite: expected a transfer function") from None
    except NoFractionError:
        raise ValueError(f"{H} is not a rational function of s and dead times exp(-delay*s)") from None
    above, below = (_collected(part, list(delays.values()), letters) for part in (fraction.numer, fraction.denom))
    base = next((d for d in below if all((other - d).is_nonnegative for other in below)), None)
    if base is None:
        raise ValueError(f"the dead times {', '.join(map(str, below))} cannot be ordered: give numbers for symbols")
    above, below = earlier(above, base), earlier(below, base)
    for delay in above:
        if not delay.is_nonnegative:
            raise ValueError(f"{H} contains exp({-delay * s}): a dead time cannot be negative")
    return above, below


def _dead_times(H):
    """Symbols for the dead times in H: {exponential: number times power of a symbol} and {symbol: dead time}.

    Dead times that are multiples of a common one are powers of one symbol, so that common factors are seen.
    """
    families = {}
    for exponential in sorted((e for e in H.atoms(sympy.exp) if e.has(s)), key=str):
        number, delay = dead_time_of(exponential)
        delay = _rational(delay) if delay.is_number else delay
        base = next((base for base in families if sympy.cancel(delay / base).is_Rational), delay)
        families.setdefault(base, []).append((exponential, _rational(number), sympy.cancel(delay / base)))
    powers, delays = {}, {}
    for base, family in families.items():
        ratios = [ratio for *_, ratio in family]
        unit = sympy.Rational(math.gcd(*(r.p for r in ratios)), math.lcm(*(r.q for r in ratios)))
        together = max(map(abs, ratios)) <= MOST_MULTIPLES * unit
        for group in [family] if together else [[member] for member in family]:
            step = unit if together else group[0][-1]
            sign = -1 if (step * base).could_extract_minus_sign() else 1
            symbol = sympy.Dummy()
            delays[symbol] = sign * step * base
            powers |= {exponential: number * symbol ** (sign * ratio / step) for exponential, number, ratio in group}
    return powers, delays


def _is_irrational(e):
    return e.is_number and not e.is_Rational


def _rational(number):
    number = rational(number)
    return sympy.Rational(number.numerator, number.denominator)


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
