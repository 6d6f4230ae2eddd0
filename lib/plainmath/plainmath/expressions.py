"""Expressions: reading them from text without `eval`, and proving two of them equal.

The library has one Laplace variable `s` and one time `t` (zero or later, as the Laplace transform wants it).
"""

from __future__ import annotations

import ast
import functools
import random
from fractions import Fraction

import mpmath
import sympy
from sympy.core.function import AppliedUndef
from sympy.core.parameters import distribute

from plainmath.types import Number

s = sympy.Symbol("s")
t = sympy.Symbol("t", nonnegative=True)

_FUNCTIONS = {
    "exp": sympy.exp, "log": sympy.log, "sqrt": sympy.sqrt, "Abs": sympy.Abs, "sign": sympy.sign,
    "sin": sympy.sin, "cos": sympy.cos, "tan": sympy.tan, "asin": sympy.asin, "acos": sympy.acos, "atan": sympy.atan,
    "atan2": sympy.atan2, "sinh": sympy.sinh, "cosh": sympy.cosh, "tanh": sympy.tanh,
    "re": sympy.re, "im": sympy.im, "Min": sympy.Min, "Max": sympy.Max,
    "factorial": sympy.factorial, "gamma": sympy.gamma, "DiracDelta": sympy.DiracDelta, "Heaviside": sympy.Heaviside,
    "Derivative": sympy.Derivative, "Integral": sympy.Integral, "Subs": sympy.Subs,
}  # fmt: skip
_NAMES = {"s": s, "t": t, "pi": sympy.pi, "oo": sympy.oo, "I": sympy.I}
_WITH_LISTS = (sympy.Derivative, sympy.Integral, sympy.Subs)
_GROWING = (sympy.factorial, sympy.gamma)
POINTS = 9  # at which a difference is looked at
_OPERATORS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: a**b,
}


def parse(text: str, real: str = "") -> sympy.Expr:
    """Return the SymPy expression that `text` spells, with every decimal number exact.

    Known are the operators ``+ - * / **``, brackets, the elementary functions, `pi`, `oo`, `I`, and the library's
    own `s` and `t`. Any other name is a positive symbol, or one of either sign if it is among `real`, as "v x", or an
    undefined function where it is called. Nothing is ever evaluated as Python.

    Raises ValueError when the text says anything else, or something that has no value.

    >>> parse("3/(s + 0.5)")
    3/(s + 1/2)
    >>> parse("y(t) + 2*K").free_symbols == {t, sympy.Symbol("K", positive=True)}
    True
    >>> parse("open('file')")
    Traceback (most recent call last):
    ValueError: cannot read "open('file')" as an expression: 'file' is not a number, a name or a known operation
    """
    if not isinstance(text, str):
        raise _unreadable(text)
    return _parsed(str.__str__(text), frozenset(real.split()))


def _unreadable(text):
    return ValueError(f"cannot read {text!r} as an expression: expected something like 'K/(T*s + 1)'")


@functools.lru_cache(maxsize=4096)  # a printed formula is read, proved and shown
def _parsed(text, real):
    try:
        # an indented or broken line is no matter in a book's formula
        source = " ".join(text.split())
        tree = ast.parse(source, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _unreadable(text) from None

    def refuse(node, why="is not a number, a name or a known operation"):
        raise ValueError(f"cannot read {text!r} as an expression: {ast.get_source_segment(source, node)} {why}")

    def number(node):
        digits = ast.get_source_segment(source, node).replace("_", "")
        if type(node.value) not in (int, float) or not set(digits) <= set("0123456789.eE+-"):
            refuse(node)
        if abs(node.value) > 1e300 or (node.value == 0 and set(digits.lower().partition("e")[0]) - set("0.")):
            refuse(node, "is out of range")
        return sympy.Rational(digits)

    def name(node):
        if node.id.startswith("__"):
            refuse(node, "is not the name of a quantity")
        return node.id

    def operation(node):
        left, right = read(node.left), read(node.right)
        # such powers would fill the memory, at once or when they are multiplied out
        if isinstance(node.op, ast.Pow) and right.is_number and abs(right) * _digits(left) > 1000:
            refuse(node, "is too large a power")
        return _OPERATORS[type(node.op)](left, right)

    def call(node):
        if not isinstance(node.func, ast.Name) or node.keywords:
            refuse(node)
        if node.func.id in _NAMES:
            refuse(node, f"calls {node.func.id}, which is not a function: a product needs its *")
        function = _FUNCTIONS.get(node.func.id) or sympy.Function(name(node.func))
        arguments = [
            sympy.Tuple(*map(read, argument.elts))
            if function in _WITH_LISTS and isinstance(argument, ast.Tuple)
            else read(argument)
            for argument in node.args
        ]
        if function in _GROWING and any(argument.is_number and abs(argument) > 1000 for argument in arguments):
            refuse(node, "is too large")
        try:
            return function(*arguments)
        except (TypeError, ValueError):
            refuse(node, "has the wrong arguments")

    def read(node):
        match node:
            case ast.Constant():
                return number(node)
            case ast.Name():
                signs = {"real": True} if node.id in real else {"positive": True}
                return _NAMES.get(node.id) or sympy.Symbol(name(node), **signs)
            case ast.BinOp() if type(node.op) in _OPERATORS:
                return operation(node)
            case ast.UnaryOp(op=ast.USub()):
                return -read(node.operand)
            case ast.UnaryOp(op=ast.UAdd()):
                return read(node.operand)
            case ast.Call():
                return call(node)
        refuse(node)

    try:
        with distribute(False):  # 4*(s - 1) stays as it is written
            expression = read(tree.body)
    except RecursionError:
        raise _unreadable(text) from None
    if expression.has(sympy.nan, sympy.zoo):
        refuse(tree.body, "has no value")
    return expression


def _digits(expression):
    """About how many decimal digits a power multiplies: those of a rational number, one for anything else."""
    if not expression.is_Rational:
        return 1
    return max(abs(expression.p).bit_length(), expression.q.bit_length()) * 0.3


def agreement(one: Number, other: Number) -> str:
    """Say whether two expressions are equal: ``"proved"``, ``"probed"`` or ``"different"``.

    Random exact points of all magnitudes come first, because a single one refutes an equality for good. What survives
    them is simplified: a difference that vanishes is *proved* zero. Only where SymPy cannot finish the proof do the
    points stand alone, and the answer says *probed*. Decimal numbers are exact, and the name of a bound symbol does
    not matter. Undefined functions, derivatives, open integrals and impulses count as quantities of their own.

    Raises ValueError when one is not an expression, or the two cannot be compared at any point.

    >>> K, T = sympy.symbols("K T", positive=True)
    >>> agreement(K / (T * s + 1), (K / T) / (s + 1 / T))
    'proved'
    >>> agreement(K / (T * s + 1), K / (T * s - 1))
    'different'
    """
    one, other = sympy.Tuple(exact(one), exact(other)).as_dummy()
    if one == other:
        return "proved"
    one, other = _opaque(one.doit(deep=True), other.doit(deep=True))
    difference = one - other
    if difference == 0 or sympy.expand(difference) == 0:
        return "proved"
    if not difference.is_finite and difference.is_number:
        raise ValueError(f"cannot compare {one} with {other}: expected finite values")
    if _nonzero_somewhere(difference):
        return "different"
    steps = (lambda e: sympy.cancel(sympy.together(e)), sympy.gammasimp, sympy.simplify)
    return "proved" if any(step(difference) == 0 for step in steps) else "probed"


def _opaque(*expressions):
    """Replace what has no value at a point by symbols, the same one for the same quantity."""
    kinds = (sympy.Derivative, sympy.Subs, sympy.Integral, AppliedUndef, sympy.DiracDelta)
    symbols = {}

    def replace(expression):
        if isinstance(expression, kinds):
            # multiplied out, a quantity is spelled in one way only
            return symbols.setdefault(sympy.expand(expression), sympy.Dummy(f"quantity{len(symbols)}"))
        if not expression.args:
            return expression
        return expression.func(*(replace(argument) for argument in expression.args))

    return tuple(replace(expression) for expression in expressions)


def _nonzero_somewhere(difference):
    """Whether a difference is not zero at one of several random points; the same points every time."""
    symbols = sorted(difference.free_symbols, key=lambda symbol: (symbol.name, str(symbol.assumptions0)))
    # dummify: two symbols of one name may stand in a difference
    terms = sympy.lambdify(symbols, sympy.Add.make_args(sympy.expand(difference)), [_NUMERIC, "mpmath"], dummify=True)
    dice = random.Random(4)
    judged = 0
    for attempt in range(4 * POINTS):
        # ordinary numbers first, then small and large ones: a limiter or a switch shows at large values only
        point = [_random_value(symbol, (0, -6, 6)[attempt % 3], dice) for symbol in symbols]
        sizes = _sum_and_largest(terms, point)
        if sizes is None:
            continue
        # worked out with 200 digits, a zero is zero to about so many digits of the largest term
        if sizes[0] > sizes[1] * mpmath.mpf("1e-150"):
            return True
        judged += 1
        if judged == POINTS:
            return False
    if judged == 0:
        raise ValueError(f"cannot compare the two: {difference} has no value at any point")
    return False


def _sum_and_largest(terms, point):
    """The size of a sum at an exact point, and that of its largest term; None where it has no value."""
    with mpmath.workdps(200):
        try:
            values = [mpmath.mpmathify(value) for value in terms(*(x._to_mpmath(mpmath.mp.prec) for x in point))]
        except (ArithmeticError, TypeError, ValueError):  # TypeError: a complex number on a step or in a limiter
            return None
        sizes = abs(mpmath.fsum(values)), max(map(abs, values))
    return sizes if all(map(mpmath.isfinite, sizes)) else None


def _heaviside(x, at_zero=None):
    return mpmath.mpf(1) if x > 0 else mpmath.mpf(0) if x < 0 else mpmath.mpf("0.5")


def _bounded(function):
    """The function for arguments below ``10**60``: an exponential of an exponential can fill the memory."""

    def bounded(x):
        if abs(x) > 1e60:
            raise OverflowError
        return function(x)

    return bounded


_NUMERIC = {"Heaviside": _heaviside} | {
    name: _bounded(getattr(mpmath, name)) for name in ("exp", "sin", "cos", "tan", "sinh", "cosh", "tanh", "gamma")
}


def _random_value(symbol, scale, dice):
    """A random exact value that the symbol's assumptions allow; complex for a symbol that assumes nothing."""
    if symbol.is_integer:
        # small ones, of which factorials and powers are moderate, and larger ones where a limiter may begin
        value = sympy.Integer(dice.randint(7, 40) if scale > 0 else dice.randint(1, 6))
        return value if symbol.is_nonnegative else -value if symbol.is_nonpositive else value * dice.choice((-1, 1))

    def value():
        # a prime below the fraction bar: a power with such an exponent stays a number of moderate size
        return sympy.Rational(dice.randint(1, 10**6), 99991) * sympy.Integer(10) ** scale

    if symbol.is_nonnegative:
        return value()
    if symbol.is_nonpositive:
        return -value()
    if symbol.is_real:
        return value() * dice.choice((-1, 1))
    return value() * dice.choice((-1, 1)) + sympy.I * value() * dice.choice((-1, 1))


def exact(value: Number | complex) -> sympy.Expr:
    """Return `value` as a SymPy expression whose decimal numbers are exact, as they are meant.

    0.1 is one tenth and 1/3 is one third: a fraction with a denominator up to 1000 where the decimal is one but for
    its rounding, and otherwise the decimal itself to 15 digits.

    Raises ValueError for what is neither a number nor an expression, as text, a list, a truth value or NaN.

    >>> exact(0.1) * s
    s/10
    >>> exact(0.1 + 0.2), exact(1 / 3), exact(1.000000001)
    (3/10, 1/3, 1000000001/1000000000)
    """
    if isinstance(value, (str, bool)):
        raise _no_expression(value)
    if isinstance(value, sympy.Rational):  # as it is, most often
        return value
    try:
        expression = sympy.sympify(value)
    except (sympy.SympifyError, TypeError, AttributeError):
        raise _no_expression(value) from None
    if isinstance(expression, sympy.Expr) and expression.has(sympy.nan):
        raise ValueError(f"{value!r} is not a number: expected a number or an expression")
    if not isinstance(expression, sympy.Expr) or getattr(expression, "is_Matrix", False):
        raise _no_expression(value)
    if expression.is_Float:
        return _meant(expression)
    return expression.xreplace({decimal: _meant(decimal) for decimal in expression.atoms(sympy.Float)})


def _no_expression(value):
    return ValueError(f"{value!r} is of type {type(value).__name__}: expected a number or an expression")


def _meant(decimal):
    """The fraction that a decimal number is meant to be."""
    if not decimal.is_finite:
        return decimal
    digits = Fraction(str(decimal))
    simple = digits.limit_denominator(1000)
    meant = simple if abs(simple - digits) <= Fraction(2, 10**15) * abs(digits) else digits
    return sympy.Rational(meant.numerator, meant.denominator)


def function_of(variable: sympy.Symbol, value: Number | complex) -> sympy.Expr:
    """Return `value`, exact, as a function of `variable`, which is `s` or `t`; other symbols may stand in it.

    Raises ValueError where it contains the other of the two, or a symbol that is only named like one of them. With
    such a symbol, which SymPy tells apart by its assumptions, results would be wrong without a word.

    >>> function_of(s, 2.5 / s)
    5/(2*s)
    >>> function_of(t, sympy.exp(-sympy.Symbol("t")))
    Traceback (most recent call last):
    ValueError: the t in exp(-t) is another symbol than plainmath's: import s and t from there
    """
    expression = exact(value)
    for symbol in expression.free_symbols - {variable}:
        if symbol in (s, t):
            raise ValueError(f"{expression} contains {symbol}: expected a function of {variable}")
        if symbol.name in ("s", "t") and not isinstance(symbol, sympy.Dummy):
            raise ValueError(
                f"the {symbol} in {expression} is another symbol than plainmath's: import s and t from there"
            )
    return expression


def written(value: sympy.Expr) -> str:
    """Return a value as text, a fraction with a long denominator as a decimal of six digits.

    >>> written(sympy.Rational(2, 3)), written(sympy.Rational(299855, 100001))
    ('2/3', '2.99852')
    """
    return f"{float(value):.6g}" if _is_long(value) else str(value)


def _is_long(value):
    return isinstance(value, sympy.Rational) and value.q > 1000
