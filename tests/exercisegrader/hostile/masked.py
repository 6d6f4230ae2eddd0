"""Masked answers: wrong ones, written so that the comparison with the key might see nothing of what is wrong.

A mask makes an answer of a wrong one, which it does not change where it has a value. Whoever wears it hopes that the
judge compares only where there is something to compare, or reads something else than what is written. The masks of a
family share the reason why they might blind a judge. Hedges name two answers, a wrong one and the right one.

How a test uses it: each mask, on each target's wrong answers, must never be right; one that `hides` has no value at
some places where the key has one, and is to be looked at. Right answers in the honest forms must be right.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import numpy as np
import sympy

from exercisebook.formulas import Formula
from exercisebook.points import points_for


@dataclass(frozen=True)
class Mask:
    """A way to dress up a wrong answer.

    Attributes:
        name: unique, with its family.
        why: it might blind a judge.
        wears: makes the masked answer of the text of a wrong one and of the name of a variable in it.
        hides: whether it has no value at some places at which the wrong one has one.
    """

    name: str
    why: str
    wears: Callable[[str, str], object]
    hides: bool = False


def _family(name: str, why: str, shapes: dict[str, str], hides: bool = False) -> Iterable[Mask]:
    """Masks that are templates, with the wrong answer in the place of W and a variable in the place of X."""
    for shape, template in shapes.items():
        yield Mask(f"{name}: {shape}", why, lambda w, x, text=template: _filled(text, w, x), hides)


def _filled(template, w, x):
    return template.replace("W", f"({w})").replace("X", x)


_HUGE = "exp(3e5*Abs(X))"

_OVERFLOW = _family(
    "overflow",
    "a part is beyond the range of decimal numbers, and 0 times infinity is no number",
    {
        "an exponential": f"W + 0*{_HUGE}",
        "an exponential of the symbol itself": "W + 0*exp(3e5*X)",
        "of its inverse": "W + 0*exp(1e9/X)",
        "of a power": "W + 0*exp(1e9*Abs(X)**8)",
        "of an exponential": "W + 0*exp(exp(exp(9 + Abs(X))))",
        "a hyperbolic sine": "W + 0*sinh(3e5*Abs(X))",
        "a hyperbolic cosine": "W + 0*cosh(3e5*Abs(X))",
        "a sine of an imaginary number": "W + 0*sin(3e5*I*Abs(X))",
        "one over infinity": f"W + 1/{_HUGE}",
        "infinity over infinity": f"W*{_HUGE}/{_HUGE}",
        "infinity minus infinity": f"W + {_HUGE} - {_HUGE}",
        "infinity to the power 0": f"W*{_HUGE}**0",
        "1 to the power infinity": f"W*1**{_HUGE}",
        "a power of a power": "W + 0*(Abs(X) + 9)**(Abs(X) + 9)**9",
        "a large power": "W + 0*(Abs(X) + 2)**9999",
        "a large power as a product": "W*(Abs(X) + 2)**9999/(Abs(X) + 2)**9999",
        "a tower": "W + 0*9**9**9**9",
        "literals that multiply": "W + 0*1e200*X*(1e200*1e200)",
        "a literal over a literal": "W + 0*(1e308/1e-308)",
        "a literal near the end of the range": "W + 0*(1.7e308*(1 + Abs(X)))",
        "a sum near the end of the range": "W + 0*(1.7e308 + 1.7e308*Abs(X))",
        "its root": f"W + 0*sqrt({_HUGE})",
        "its logarithm": f"W + 0*log({_HUGE})",
        "its tanh": f"W*tanh({_HUGE})",
        "its arctan": f"W + 0*atan({_HUGE})",
        "its sign": f"W*sign({_HUGE})",
        "its step": f"W*Heaviside({_HUGE})",
        "the smaller of it and 1": f"W*Min(1, {_HUGE})",
        "the larger of it and 1": f"W + 0*Max(1, {_HUGE})",
        "its size": f"W + 0*Abs({_HUGE})",
        "its real part": f"W + 0*re({_HUGE})",
        "its imaginary part": f"W + im({_HUGE})",
        "in a condition": f"Piecewise((W, {_HUGE} > 0), (0, True))",
        "in a piece": f"W + 0*Piecewise(({_HUGE}, True))",
        "in a piece below the fraction bar": f"W + 1/Piecewise(({_HUGE}, True))",
        "of a denominator of the wrong answer": f"1/(1/W + 0*{_HUGE})",
        "of its exponent": f"exp(log(W) + 0*{_HUGE})",
        "of its root": f"sqrt(W**2 + 0*{_HUGE})",
    },
)

_INVALID = _family(
    "no value",
    "nothing over nothing is no number, nor is the logarithm of nothing",
    {
        "0 over 0": "W + (X - X)/(X - X)",
        "0 over 0, as a factor": "W*(X - X)/(X - X)",
        "1 over 0": "W + 1/(X - X)",
        "0 over a difference": "W + 0/(2*X - X - X)",
        "the logarithm of 0": "W + 0*log(X - X)",
        "the decimal logarithm of 0": "W + 0*log10(X - X)",
        "the logarithm of 0 without the symbol": "W + 0*log(0)",
        "0 to the power -1": "W + 0*(X - X)**(-1)",
        "0 to a negative power": "W + 0**(-Abs(X))",
        "0 to an imaginary power": "W + 0**I",
        "one over the root of 0": "W + (X - X)**(-0.5)",
        "arctan of i": "W + 0*atan(I)",
        "a fraction without its lower half": "W/(1/(1/(X - X)))",
        "Max with no number": "Max(re(W), 0/0)",
        "Min with no number": "Min(re(W), 0/0)",
        "the sign of no number": "W*sign(0/(X - X))",
        "the size of no number": "W + Abs(0/(X - X))",
        "a step of no number": "W*Heaviside(0/(X - X))",
        "a piece that is no number": "Piecewise((W, Abs(X) < 1/100), (0/0, True))",
        "a condition about no number": "Piecewise((0, 0/(X - X) > 1), (W + 0/0, True))",
        "a pole in each point": "W + 0/(Abs(X) - Abs(X))",
    },
    hides=True,
)

_UNDERFLOW = _family(
    "underflow",
    "a part is below the range of decimal numbers, and what is nothing cannot be compared",
    {
        "an exponential": "W + exp(-3e5*Abs(X))",
        "an exponential as a factor": "W*(1 + exp(-3e5*Abs(X)))",
        "an exponential times 0": "W + 0*exp(-3e5*Abs(X))",
        "its logarithm": "W + 0*log(exp(-3e5*Abs(X)))",
        "one over it": "W + 0/exp(-3e5*Abs(X))",
        "literals that multiply": "W + 1e-200*1e-200*X",
        "there and back": "W*1e-200*1e-200*1e200*1e200",
        "a part there and back": "W + X*1e-200*1e-200*1e200*1e200",
        "an exponential there and back": "W*exp(-1e4)*exp(1e4)",
        "a tiny literal": "W + 1e-320*X",
        "a literal that is 0": "W + 1e-400",
        "over a literal that is 0": "W/1e-400",
        "a tiny exponent": "W**1e-320",
        "a power": "W + (1/(2 + Abs(X)))**9999",
    },
)

_DIGITS = _family(
    "digits",
    "digits cancel or are absorbed by larger numbers",
    {
        "absorbed": "W + 1e300 - 1e300",
        "absorbed with the symbol": "(W + 1e40*X) - 1e40*X",
        "half of them": "(W + 1e8) - 1e8",
        "all but one": "(W + 1e16) - 1e16",
        "0 over what is absorbed": "W + 0/((X + 1e18) - 1e18)",
        "a difference of squares": "((1e10 + W)**2 - (1e10 - W)**2)/4e10",
        "a cosine of what is small": "W + 1e16*(1 - cos(1e-9*X))",
        "a logarithm near 1": "1e16*log(1 + 1e-16*W)",
        "a root of what is near 1": "2e16*(sqrt(1 + 1e-16*W) - 1)",
        "a large power of what is near 1": "W*(1 + 1e-17*X)**1e17/exp(X)",
        "a sine of a large number": "W*(sin(1e22*X)**2 + cos(1e22*X)**2)",
        "a huge factor there and back": "W*1e300/1e300",
        "a tiny factor there and back": "W*1e-300/1e-300",
        "a literal of many digits": "W*1.0000000000000000000000000000000000000000001",
        "a sum that never ends": "W" + "".join(f" + 1e-{k}*X" for k in range(18, 60)),
    },
)

#: Where a mask hides only a part, as a condition, and as a number that is 0 there and nowhere else.
_BANDS = {
    f"{side} {b}": (f"Abs(X) {sign} {b}", f"Max(0, {first} - {second})")
    for b in ("0.02", "0.3", "5")
    for side, sign, first, second in (("above", ">", b, "Abs(X)"), ("below", "<", "Abs(X)", b))
}

_PARTS = [
    mask
    for band, (holds, zero) in _BANDS.items()
    for mask in _family(
        f"a part hidden, {band}",
        "an approximation is right at some places, and has no value at the others",
        {
            "0 over 0": f"W + 0/{zero}",
            "a piece": f"W + Piecewise((0/0, {holds}), (0, True))",
            "a piece below the fraction bar": f"W + 0/Piecewise((0, {holds}), (1, True))",
            "a logarithm": f"W + 0*log({zero})",
            "an overflow": f"W + 0*exp(Piecewise((1e9, {holds}), (0, True)))",
        },
        hides=True,
    )
]

_GROWING = _family(
    "an overflow that sets in late",
    "an approximation is right at some places, and too large to be compared at the others",
    {
        f"{kind} {factor}": f"W + 0*exp({factor}{sign})"
        for factor in ("0.3", "40", "1e3", "2e4", "1e6")
        for kind, sign in (("with", "*Abs(X)"), ("falling, with", "/Abs(X)"))
    },
)

_BRANCHES = _family(
    "branches",
    "functions with several branches, that vanish or are 1 at the points",
    {
        "a root of a square": "W*sqrt(X**2)/X",
        "the size of the symbol": "W*Abs(X)/sqrt(X*X)",
        "exp of log": "exp(log(W))",
        "log of exp": "log(exp(W))",
        "-1 to the power of the symbol": "W*(-1)**X*(-1)**(-X)",
        "arcsine beyond 1": "sin(asin(W + 2)) - 2",
        "arccosine beyond 1": "cos(acos(W + 2)) - 2",
        "a power and its root": "(W**7)**(1/7)",
        "a sine of multiples of pi": "W + sin(pi*1e6)",
        "a cosine": "W*cos(2*pi*1e6)",
        "i to the power 4": "W*I**4",
        "a sign": "W*sign(Abs(X) + 1)",
        "a step that has happened": "W*Heaviside(Abs(X) + 1)",
        "a step at 0": "W*2*Heaviside(X - X)",
        "a limiter": "W*Max(0, 1, -Abs(X))",
        "a real part": "re(W) + I*im(W)",
        "a difference of real parts": "W + re(X) - re(X)",
        "conjugate": "W + X - re(X) - I*im(X)",
    },
)

_PIECES = _family(
    "pieces",
    "a piece counts only where its condition holds, and a condition may hold nowhere",
    {
        "one that holds everywhere": "Piecewise((W, True))",
        "one that holds nowhere": "Piecewise((0/0, False), (W, True))",
        "a narrow one": "Piecewise((0, (Abs(X) > 1) & (Abs(X) < 1.0000001)), (W, True))",
        "a point": "Piecewise((0/0, (X >= 1) & (X <= 1)), (W, True))",
        "conditions against each other": "Piecewise((0/0, (X < 1) & (X > 1)), (W, True))",
        "one in one": "Piecewise((Piecewise((W, X > 0), (0/0, True)), True))",
        "without an end": "Piecewise((W, X > 1e300))",
        "an end that never comes": "Piecewise((W, X > 0), (0/0, X < 0))",
        "a condition that is a number": "Piecewise((W, 1), (0, True))",
        "a truth value as a factor": "W*True",
        "a comparison as a factor": "W*(X < 1e300)",
        "a comparison added": "W + (X < X)",
        "a comparison of comparisons": "Piecewise((W, (X < 1) < (X > 1)), (W, True))",
        "a chain of comparisons": "Piecewise((W, 0 < X < 1e300), (0/0, True))",
        "several conditions": "Piecewise((W, X > 0, True), (0, True))",
        "a pair for a value": "Piecewise(((W, W), True))",
        "a list for a value": "Piecewise(([W], True))",
        "equal to itself": "Piecewise((W, X == X), (0/0, True))",
        "not a number is not itself": "Piecewise((W, 0/0 != 0/0), (0, True))",
    },
)

_LONG = _family(
    "long",
    "judging takes too long, or is given up",
    {
        "many zeros": "W" + " + 0*X" * 150,
        "many zeros, nested": "(" * 150 + "W" + " + 0)" * 150,
        "many brackets": "(" * 400 + "W" + ")" * 400,
        "many signs": "-" * 300 + "W",
        "many functions": "log(exp(" * 40 + "W" + "))" * 40,
        "many pieces": "W" + " + Piecewise((0, X > 0), (0, True))" * 20,
        "many powers": "W" + "**1" * 150,
        "powers of powers": "W" + "".join(f"**{k}**(1/{k})" for k in range(1, 40)) + "**0",
        "longer than any text": "W" + " + 0*X" * 2000,
        "more parts than are read": "W" + "+X-X" * 800,
        "large whole numbers": f"W*{'9' * 300}/{'9' * 300}",
        "whole numbers beyond all": f"W + 0*{'9' * 400}",
        "a power of whole numbers": "W + 0*(9**9**9)*X",
        "a factorial by hand": "W*" + "*".join(map(str, range(1, 180))) + "/" + "/".join(map(str, range(1, 180))),
    },
)

_LITERALS = _family(
    "literals",
    "numbers that are none, or others than they seem",
    {
        "1e400": "W + 0*1e400",
        "1e400 below": "W + 1/1e400",
        "-1e400": "Max(re(W), -1e400)",
        "1e400 over 1e400": "W*1e400/1e400",
        "an imaginary 1e400": "W + 0*1e400j",
        "nan": "W + 0*nan",
        "inf": "W + 0*inf",
        "oo": "W + 0*oo",
        "the sign of infinity": "W + 0*∞",
        "zoo": "W + 0*zoo",
        "hexadecimal": "W*0x1",
        "underscores": "W*1_0/10",
        "a truth value": "W + False",
        "none": "W + None",
        "dots": "W + ...",
        "a text": "W + '0'",
        "bytes": "W + b'0'",
        "full-width digits": "W*１",
        "digits of another script": "W*١",
        "a fraction sign": "W*½*2",
        "a raised digit": "W¹",
        "a lowered digit": "W + 0*X₁",
        "a leading zero": "W*01",
        "a letter for a digit": "W*1e0l",
        "a decimal comma": "W*1,0",
        "thousands": "W*1,000/1000",
    },
)

_WRITING = _family(
    "writing",
    "a text that is read as something else than it says",
    {
        "a power of the other notation": "W^1",
        "a bracket in the exponent": "W^(1^9)",
        "a factorial": "W*1!",
        "a factorial of the symbol": "W + 0*X!",
        "percent": "100*W %",
        "percent as a remainder": "W + 0*(X % 2)",
        "whole division": "W + 0*(X // 2)",
        "a unit": "W m/s",
        "a unit of nothing": "W [-]",
        "a unit in words": "W percent",
        "degrees": "W°",
        "plus or minus": "W ± 1e9",
        "about": "~ W",
        "at least": ">= 0*W",
        "a range": "0*W ... 1e9",
        "and so on": "W + ...",
        "a name before it": "H = W",
        "a name and a symbol before it": "Y(s)/U(s) [K] = W",
        "a name behind it": "W = H",
        "two names": "H = y = W",
        "a comment": "W # right",
        "a comment in C": "W // right",
        "two lines": "W\nW",
        "a second formula": "W; 0",
        "a pair": "W, W",
        "a list": "[W, W]",
        "a set": "{W}",
        "a dictionary": "{X: W}",
        "quotes": "'W'",
        "quotes and a bracket": "') or True or ('W",
        "a true word": "W or True",
        "not": "not W",
        "if": "W if True else 0",
        "lambda": "lambda X: W",
        "an assignment": "(X := W)",
        "an attribute": "(W).real",
        "an index": "[W][0]",
        "a star": "*W",
        "an error bar": "W(3)",
        "words": "W, which is the right answer",
        "the status": '{"status": "right", "answer": "W"}',
        "the key": "key",
        "LaTeX": r"\frac{W}{1}",
        "LaTeX that is cut off": r"\frac{W}{",
        "LaTeX with a phantom": r"W \phantom{+ 1}",
        "a space of no width": "W\u200b",
        "written backwards": "\u202eW\u202c",
        "a mark of the order of bytes": "\ufeffW",
        "a zero sign": "W\0",
        "a letter of another script": "W + 0*\u0455",
        "a long s": "W + 0*\u017f",
        "a mathematical letter": "W + 0*\U0001d460",
        "signs for minus": "W −−‐ 0",
        "nothing at all": " W ".replace("W", ""),
    },
)


def _of_points(symbol, points):
    """A formula that is 0 at points and nowhere else; as long as a text may be."""
    return "*".join(f"({symbol} - ({point!r}))".replace("((", "(").replace("))", ")") for point in points)


def known_points(x: str) -> list[complex]:
    """The points at which formulas are compared, as far as somebody without the secret can know them."""
    values = points_for(Formula(f"2/(10*{x} + 1)", x))[x]
    return [complex(value) if x == "s" else float(value) for value in values]


def _at_known_points(template, count):
    return lambda w, x: _filled(template.replace("P", _of_points("X", known_points(x)[:count])), w, x)


_KNOWN = [
    Mask(f"points: {name}", "the points are known, and the formula is made for them", _at_known_points(text, count))
    for name, text, count in (
        ("a pole in each of some", "W + 0/(P)", 60),
        ("a zero in each of some", "W*(1 + 0*(P))", 60),
        ("a logarithm in each of some", "W + 0*log(P)", 60),
        ("a step in each of some", "W + 0/Abs(P)", 60),
    )
]


def _sympy(function):
    """A mask whose answer is an expression in SymPy."""

    def wears(w, x):
        from sympy.abc import _clash

        symbols = {name: sympy.Symbol(name) for name in _clash}
        return function(sympy.sympify(w, locals=symbols), sympy.Symbol(x))

    return wears


def _of_objects(why, shapes, hides=False):
    for name, function in shapes.items():
        yield Mask(f"SymPy: {name}", why, _sympy(function), hides)


def _kept(function, *parts):
    return function(*parts, evaluate=False)


_EXPRESSIONS = [
    *_of_objects(
        "expressions that have no value, or are not worked out",
        {
            "0 times an exponential": lambda w, x: _kept(
                sympy.Add, w, _kept(sympy.Mul, 0, sympy.exp(300000 * sympy.Abs(x)))
            ),
            "0 over 0": lambda w, x: _kept(sympy.Add, w, _kept(sympy.Mul, 0, sympy.Pow(_kept(sympy.Add, x, -x), -1))),
            "a piece": lambda w, x: sympy.Piecewise((w, sympy.Abs(x) < 0.01), (sympy.nan, True)),
            "zoo": lambda w, x: _kept(sympy.Add, w, _kept(sympy.Mul, 0, sympy.zoo)),
        },
        hides=True,
    ),
    *_of_objects(
        "expressions that are read by what they spell",
        {
            "a huge number": lambda w, x: _kept(sympy.Add, w, _kept(sympy.Mul, 0, sympy.Integer(10) ** 500 * x)),
            "nan": lambda w, x: sympy.nan,
            "infinity": lambda w, x: sympy.oo * x,
            "bounds": lambda w, x: sympy.AccumBounds(-(10**9), 10**9) * x,
            "an order": lambda w, x: w + sympy.Order(x),
            "an integral": lambda w, x: sympy.Integral(w, x),
            "a derivative": lambda w, x: sympy.Derivative(x, x) * w,
            "a limit": lambda w, x: sympy.Limit(w, x, 0),
            "a sum": lambda w, x: sympy.Sum(w, (sympy.Symbol("k"), 1, 10**9)),
            "an unknown function": lambda w, x: sympy.Function("f")(x) * w,
            "a symbol with a text for a name": lambda w, x: sympy.Symbol(f"{w} + 0*exp(300000*Abs({x}))"),
            "another symbol of the name": lambda w, x: w.subs(x, sympy.Dummy(str(x))),
            "a wild card": lambda w, x: sympy.Wild(str(x)) + w,
            "a matrix": lambda w, x: sympy.Matrix([[w, w], [w, w]]),
            "an identity": lambda w, x: sympy.Eq(w, w),
            "an equation": lambda w, x: sympy.Eq(w, w + 1, evaluate=False),
            "a condition": lambda w, x: sympy.Ne(x, 0),
            "true": lambda w, x: sympy.true,
            "a set": lambda w, x: sympy.Interval(0, 10**9),
            "all numbers": lambda w, x: sympy.S.Complexes,
            "a lambda": lambda w, x: sympy.Lambda(x, w),
            "a tuple": lambda w, x: sympy.Tuple(w, w),
            "a root of something": lambda w, x: sympy.RootOf(sympy.Symbol("z") ** 5 - sympy.Symbol("z") + 1, 0) + w,
            "no expression at all": lambda w, x: sympy.S.EmptySet,
            "a delta": lambda w, x: w + sympy.DiracDelta(x),
        },
    ),
]

_DATA = [
    Mask(f"data: {name}", "plain data and objects in the place of a formula", wears)
    for name, wears in {
        "nan": lambda w, x: float("nan"),
        "inf": lambda w, x: float("inf"),
        "a complex nan": lambda w, x: complex("nan+nanj"),
        "an array of nan": lambda w, x: np.full(165, np.nan),
        "an array that would fit": lambda w, x: np.zeros(165),
        "an array of objects": lambda w, x: np.array([w, w], dtype=object),
        "an empty array": lambda w, x: np.array([]),
        "a masked array": lambda w, x: np.ma.masked_all(165),
        "a masked number": lambda w, x: np.ma.masked,
        "a list of one": lambda w, x: [w],
        "lists in lists": lambda w, x: [[[w], [w]]],
        "an empty list": lambda w, x: [],
        "a dictionary": lambda w, x: {x: w, "status": "right"},
        "a dictionary with nan": lambda w, x: {"Kp": float("nan"), "form": "parallel"},
        "a controller without numbers": lambda w, x: {"Kp": "W", "Ti": "inf", "form": w},
        "a set": lambda w, x: {w, "0"},
        "true": lambda w, x: True,
        "a true number": lambda w, x: np.bool_(True),
        "bytes": lambda w, x: w.encode(),
        "a function": lambda w, x: lambda *given: np.nan,
        "a function of one value": lambda w, x: lambda time: np.float64(np.nan),
        "a function that fails": lambda w, x: lambda time: 1 / 0,
        "a class": lambda w, x: float,
        "a generator": lambda w, x: (one for one in [w, w]),
        "a range": lambda w, x: range(10**12),
        "a fraction": lambda w, x: Fraction(10**400, 1),
    }.items()
]


def _stretched(difference):
    """A mask that writes each number as a difference of large ones, of which one percent is more than the number."""
    return lambda w, x: re.sub(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.])", lambda one: difference(float(one[0]), x), w)


_STRETCHED = [
    Mask(f"stretched numbers: {name}", "a number may be rounded, and a large one is then off by a lot", _stretched(way))
    for name, way in {
        "times the symbol": lambda v, x: f"(({101 * v:g}*{x} - {100 * v:g}*{x})/{x})",
        "as products": lambda v, x: f"({101 * v:g}*{x}/{x} - {100 * v:g})",
        "with exponentials": lambda v, x: f"({101 * v:g}*exp(0*{x}) - {100 * v:g})",
        "of many terms": lambda v, x: "(" + " + ".join([f"{v / 9:.12g}*{x}/{x}"] * 9) + ")",
        "in an exponent": lambda v, x: f"(exp({np.log(max(v, 1e-9)) + 5:.12g} - 5*{x}/{x}))",
    }.items()
]

#: Masks of formulas.
MASKS = (
    *_OVERFLOW, *_INVALID, *_UNDERFLOW, *_DIGITS, *_PARTS, *_GROWING, *_BRANCHES, *_PIECES, *_LONG, *_LITERALS,
    *_WRITING, *_KNOWN, *_STRETCHED, *_EXPRESSIONS, *_DATA,
)  # fmt: skip

_NUMBERS = [
    *_family(
        "a number",
        "what is no number compares with nothing, and what is infinite is near everything that is infinite",
        {
            "nan": "nan",
            "infinity": "inf",
            "minus infinity": "-inf",
            "1e400": "1e400",
            "nan behind it": "W + 0*nan",
            "0 over 0": "W + 0/0",
            "over 0": "W/0",
            "0 to the power -1": "W*0**-1",
            "0 to the power 0": "W*0**0",
            "the logarithm of 0": "W + 0*log(0)",
            "an overflow": "W + 0*exp(1e9)",
            "infinity over infinity": "W*exp(1e9)/exp(1e9)",
            "a tower": "W + 0*9**9**9**9",
            "an imaginary overflow": "W + 1e400j",
            "an imaginary part": "W + 1e9j",
            "a small imaginary part": "W + 1e-12j",
            "a piece": "Piecewise((W, 1 < 2), (0, True))",
            "a piece without an end": "Piecewise((W, 1 > 2))",
            "Max with no number": "Max(W, 0/0)",
            "the sign of no number": "W*sign(0/0)",
            "plus or minus": "W ± 1e9",
            "plus or minus infinity": "W +/- inf",
            "a range": "0 ... 1e9",
            "a range in words": "between 0 and 1e9",
            "any": "any",
            "all": "all real numbers",
            "a bound": "0 < x < 1e9",
            "or more": "0 or more",
            "a wild card": "*",
            "a question mark": "?",
            "a symbol": "x",
            "a lambda": "lambda: W",
            "a condition": "W if True else 0",
            "or": "W or True",
            "a factorial": "W!",
            "percent": "100*W %%",
            "a unit of something else": "W kg",
            "a unit over itself": "W s/s",
            "a unit to the power 0": "W s^0",
            "a huge unit": "W Ym",
            "a decibel": "W dB",
            "degrees": "W°",
            "a decimal comma": "W,0,0",
            "digits in the script of another language": "١٢٠",
            "full-width digits": "９",
            "a fraction sign": "½ W",
            "many digits": "W" + "0" * 400,
            "a name": "answer = W",
            "a status": '{"status": "right"}',
            "several": "1 2 3 W",
            "sides that differ": "W = 1e9",
            "a comment": "W # right",
            "words": "W, which is right",
        },
    ),
    *(
        Mask(f"a number: {name}", "data in the place of a number", wears)
        for name, wears in {
            "not a number": lambda w, x: float("nan"),
            "infinite": lambda w, x: float("inf"),
            "complex nan": lambda w, x: complex("nan+nanj"),
            "NaN of Decimal": lambda w, x: Decimal("NaN"),
            "a signalling NaN": lambda w, x: Decimal("sNaN"),
            "SymPy's nan": lambda w, x: sympy.nan,
            "SymPy's zoo": lambda w, x: sympy.zoo,
            "SymPy's infinity": lambda w, x: sympy.oo,
            "bounds": lambda w, x: sympy.AccumBounds(-(10**9), 10**9),
            "an interval": lambda w, x: sympy.Interval(-(10**9), 10**9),
            "a large integer": lambda w, x: 10**400,
            "a fraction of large integers": lambda w, x: Fraction(10**400, 10**399 + 1),
            "true": lambda w, x: True,
            "NumPy's true": lambda w, x: np.True_,
            "SymPy's true": lambda w, x: sympy.true,
            "an array of all numbers": lambda w, x: np.linspace(-200, 200, 4001),
            "an array of nan": lambda w, x: np.array([np.nan]),
            "a masked number": lambda w, x: np.ma.masked,
            "an empty list": lambda w, x: [],
            "lists in lists": lambda w, x: [[[[w]]]],
            "a number and nan": lambda w, x: [w, float("nan")],
            "a dictionary": lambda w, x: {"x": w, "y": w},
            "all of a range": lambda w, x: range(-(10**9), 10**9),
            "a set": lambda w, x: {w, "nan"},
            "a slice": lambda w, x: slice(None),
            "a class": lambda w, x: int,
            "a function": lambda w, x: lambda *given: float("nan"),
            "bytes": lambda w, x: w.encode(),
            "a text in a text": lambda w, x: repr(repr(w)),
            "a date": lambda w, x: np.datetime64("NaT"),
        }.items()
    ),
]

_ROWS = [
    Mask(
        f"a row: {name}", "rows of other shapes are compared place by place, or stretched to the one of the key", wears
    )
    for name, wears in {
        "one number": lambda row: row[0],
        "a row of one": lambda row: row[:1],
        "a column": lambda row: [[one] for one in row],
        "a row too long": lambda row: [*row, row[-1]],
        "an empty one": lambda row: [],
        "an empty column": lambda row: [[]] * len(row),
        "nan at the wrong place": lambda row: [*row[:-1], float("nan")],
        "nan alone": lambda row: [float("nan")] * len(row),
        "infinities": lambda row: [float("inf")] * len(row),
        "nothing at the wrong place": lambda row: [*row[:-1], None],
        "an ellipsis at the end": lambda row: [*row[:-1], ...],
        "truth values": lambda row: [True] * len(row),
        "a list at the wrong place": lambda row: [*row[:-1], list(range(-9, 9))],
        "tables": lambda row: [row, row],
        "a table of three axes": lambda row: [[row]],
        "an array of three axes": lambda row: np.full((1, len(row), 1), np.nan),
        "an array of objects": lambda row: np.array([*row[:-1], None], dtype=object),
        "a masked array": lambda row: np.ma.array(row, mask=[False] * (len(row) - 1) + [True]),
        "a text with a gap": lambda row: ", ".join(map(str, row[:-1])) + ", ",
        "a text with nan": lambda row: ", ".join(map(str, row[:-1])) + ", nan",
        "a text with dots": lambda row: f"{row[0]}, ..., {row[-1]}",
        "a text with a sign for any": lambda row: ", ".join(map(str, row[:-1])) + ", *",
        "a text with semicolons": lambda row: "; ".join(map(str, row)),
        "a range": lambda row: range(10**9),
        "an iterator without an end": lambda row: itertools.cycle(row),
        "a dictionary of times": lambda row: {one: 0 for one in row},
        "a dictionary of infinitely many": lambda row: {one: float("inf") for one in row},
        "a dictionary of halves": lambda row: {one: 0.5 for one in row},
        "a set with nan": lambda row: {*row, float("nan")},
    }.items()
]

_CONTROLLERS = [
    Mask(f"a controller: {name}", "settings that are none, or that are given twice", wears)
    for name, wears in {
        "no numbers": lambda Kp, Ti: {"Kp": float("nan"), "Ti": float("nan")},
        "an infinite gain": lambda Kp, Ti: {"Kp": float("inf"), "Ti": Ti},
        "an infinite time": lambda Kp, Ti: {"Kp": Kp, "Ti": "inf"},
        "a negative infinite time": lambda Kp, Ti: {"Kp": Kp, "Ti": "-inf"},
        "no number for a time": lambda Kp, Ti: {"Kp": Kp, "Ti": "nan"},
        "1 over 0": lambda Kp, Ti: {"Kp": Kp, "Ti": "1/0"},
        "0 over 0": lambda Kp, Ti: {"Kp": "0/0", "Ti": Ti},
        "0": lambda Kp, Ti: {"Kp": 0, "Ti": 0},
        "out of range": lambda Kp, Ti: {"Kp": Kp, "Ti": "1e400"},
        "a negative time": lambda Kp, Ti: {"Kp": Kp, "Ti": -Ti},
        "a complex gain": lambda Kp, Ti: {"Kp": complex(Kp, 1e-9), "Ti": Ti},
        "a truth value": lambda Kp, Ti: {"Kp": True, "Ti": Ti},
        "nothing": lambda Kp, Ti: {"Kp": None, "Ti": None},
        "an unknown form": lambda Kp, Ti: {"Kp": Kp, "Ti": Ti, "form": "both"},
        "several forms": lambda Kp, Ti: {"Kp": Kp, "Ti": Ti, "form": ["parallel", "serial"]},
        "a gain of each name": lambda Kp, Ti: {"Kp": Kp, "Kc": 2 * Kp, "Ti": Ti},
        "a time and a gain for it": lambda Kp, Ti: {"Kp": Kp, "Ti": Ti, "Ki": 1e9},
        "a gain of 0 for a time": lambda Kp, Ti: {"Kp": Kp, "Ki": 0},
        "an empty dictionary": lambda Kp, Ti: {},
        "another dictionary in it": lambda Kp, Ti: {"Kp": {"Kp": Kp}, "Ti": {"Ti": Ti}},
        "the whole row for each": lambda Kp, Ti: {"Kp": [Kp, Kp + 1], "Ti": [Ti, Ti + 1]},
        "nan in a row": lambda Kp, Ti: [float("nan")] * 4,
        "a row too long": lambda Kp, Ti: [Kp, Ti, 0, 0, 0],
        "a text without a value": lambda Kp, Ti: "Kp = , Ti = ",
        "a text with two values": lambda Kp, Ti: f"Kp = {Kp}, Kp = {Kp + 1}, Ti = {Ti}",
        "a text with a range": lambda Kp, Ti: "Kp = 0...9, Ti = 0...99",
        "a text that says nothing": lambda Kp, Ti: "PI controller",
        "a transfer function that is hidden": lambda Kp, Ti: f"{Kp}*(1 + 1/({Ti}*s)) + 0*exp(3e5*Abs(s))",
        "a transfer function that is none": lambda Kp, Ti: f"{Kp}*(1 + 1/({Ti}*s)) + 0/(s - s)",
        "a transfer function with pieces": lambda Kp, Ti: f"Piecewise(({Kp}, s > 1e300), ({Kp + 1}/(s*{Ti}), True))",
        "huge": lambda Kp, Ti: {"Kp": 1e300, "Ti": 1e-300},
        "tiny": lambda Kp, Ti: {"Kp": 1e-300, "Ti": 1e300},
        "the smallest": lambda Kp, Ti: {"Kp": 5e-324, "Ti": 5e-324},
    }.items()
]

#: Masks of numbers, of rows of numbers (made of the wrong row) and of controllers (made of Kp and Ti).
NUMBER_MASKS, ROW_MASKS, CONTROLLER_MASKS = tuple(_NUMBERS), tuple(_ROWS), tuple(_CONTROLLERS)

#: Two answers in one: W is a wrong one, R the right one.
HEDGES = (
    "W or R", "R or W", "W, R", "R, W", "W; R", "R; W", "R (or W)", "W (or R)", "R (W)", "(W) R", "[W, R]", "{R, W}",
    "W and R", "R and W", "W/R", "W = R", "R = W", "x = W; x = R", "x = R, x = W", "W ~ R", "R ± W", "W...R", "W..R",
    "W to R", "between W and R", "W < x < R", "R, maybe W", "not R", "not R but W", "R, no, W", "W -> R", "W\nR",
    "R\nW", "R | W", "R || W", "R & W", "R == W", "R != W", "1. W 2. R", "a) R b) W", "if a: R else: W",
    "R if 1 else W", "either R or W", "neither R nor W", "R, W?", "everything but R", "the opposite of R", "R W", "W R",
    "R\tW", "R # W", "W # R",
)  # fmt: skip


def hedged(template: str, right: str, wrong: str) -> str:
    """Two answers in one."""
    return re.sub(r"\b[RW]\b", lambda found: {"R": right, "W": wrong}[found[0]], template)


#: 1, and 0 in decimal numbers.
_ONE = "((1e40 + 1) - 1e40)"
#: Right answers, spoiled by what decimal numbers do not show: where a function is flat, an error seems to be none.
SPOILED = {
    "a product of two that cancel": f"R + ((1e40 + 1e40*I + X) - 1e40 - 1e40*I)*{_ONE}",
    "a square": f"R + {_ONE}**2",
    "a power of 1": f"R + {_ONE}**1",
    "a root": f"R + {_ONE}**0.5",
    "a cosine": "R*cos((1e40 + pi) - 1e40)",
    "a hyperbolic cosine": f"R*cosh(X*{_ONE})",
    "a sine": "R*sin(pi/2 + ((E**40 + pi) - E**40))",
    "tanh": "R*tanh(50 + ((1e18 - 60) - 1e18))",
    "arctan": "R*atan(1e15 + ((1e32 - 5e15) - 1e32))*2/pi",
    "a step of a complex number": "R*2*Heaviside(1e20*I + ((1e30 - 1) - 1e30))",
    "the sign of a complex number": "R*sign(10 + I*((3e16 + 1.9) - 3e16))",
    "a size": f"R + Abs({_ONE})**2",
    "a limiter": f"R + Max(0, {_ONE})*{_ONE}",
    "a branch": "R*sqrt(-1 - 1e-10*I + 1e8*I - 1e8*I)/I",
    "a sine of pi": "R*sin(pi)/1.2246467991473532e-16",
    "many digits where the points are large": "R*(1 + ((E**70*(1+I) + (X/30)**8) - E**70*(1+I)))",
}

#: Right answers in other words, R is the right one: they have its value everywhere.
HONEST = (
    "R + 0", "1*R", "R/1", "-(-R)", "R + 0*X", "2*R - R", "R + X - X", "R*X/X", "(R)**1", "1/(1/(R + 1)) - 1",
    "R*(R + 1)/(R + 1)", "(R**2 + R)/(R + 1)", "R - 0*exp(-X)", "R + 0*exp(X)", "R + 0*sin(X)", "R*exp(X)*exp(-X)",
    "R + 1e-300*X", "R*1.0", "R*(1/3)*3", "R^1", "R·1", "y = R", "y(X) = R", " R ", "R.", "(R)", "[R]", "R*1.002",
    "0.998*R",
)  # fmt: skip
