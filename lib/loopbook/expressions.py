"""Expressions: reading them from text without `eval`, and proving two of them equal.

The library has one Laplace variable `s` and one time `t` (zero or later, as the Laplace transform wants it).
"""

import ast
import random

import sympy
from sympy.core.function import AppliedUndef

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
_OPERATORS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: a**b,
}


def parse(text):
    """Return the SymPy expression that `text` spells, with every decimal number exact.

    Known are the operators ``+ - * / **``, brackets, the elementary functions, `pi`, `oo`, `I`, and the library's
    own `s` and `t`. Any other name is a positive symbol, or an undefined function where it is called. Nothing is
    ever evaluated as Python.

    Raises ValueError when the text says anything else.

    >>> parse("3/(s + 0.5)")
    3/(s + 1/2)
    >>> parse("y(t) + 2*K").free_symbols == {t, sympy.Symbol("K", positive=True)}
    True
    >>> parse("__import__('os')")
    Traceback (most recent call last):
    ValueError: cannot read "__import__('os')" as an expression: 'os' is not a number, a name or a known operation
    """
    try:
        # an indented or broken line is no matter in a book's formula
        source = " ".join(text.split())
        tree = ast.parse(source, mode="eval")
    except (AttributeError, SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(f"cannot read {text!r} as an expression: expected something like 'K/(T*s + 1)'") from None

    def refuse(node, why="is not a number, a name or a known operation"):
        raise ValueError(f"cannot read {text!r} as an expression: {ast.get_source_segment(source, node)} {why}")

    def number(node):
        if isinstance(node.value, (bool, complex)) or not isinstance(node.value, (int, float)):
            refuse(node)
        return sympy.Rational(ast.get_source_segment(source, node).replace("_", ""))

    def call(node):
        if not isinstance(node.func, ast.Name) or node.keywords:
            refuse(node)
        function = _FUNCTIONS.get(node.func.id) or sympy.Function(node.func.id)
        try:
            return function(*(read(argument) for argument in node.args))
        except TypeError:
            refuse(node, "has the wrong number of arguments")

    def read(node):
        match node:
            case ast.Constant():
                return number(node)
            case ast.Name():
                return _NAMES.get(node.id) or sympy.Symbol(node.id, positive=True)
            case ast.BinOp() if type(node.op) in _OPERATORS:
                left, right = read(node.left), read(node.right)
                if isinstance(node.op, ast.Pow) and left.is_number and right.is_number and abs(right) > 1000:
                    refuse(node, "is too large a power")
                return _OPERATORS[type(node.op)](left, right)
            case ast.UnaryOp(op=ast.USub()):
                return -read(node.operand)
            case ast.UnaryOp(op=ast.UAdd()):
                return read(node.operand)
            case ast.Call():
                return call(node)
            case ast.Tuple():
                return sympy.Tuple(*(read(element) for element in node.elts))
        refuse(node)

    return read(tree.body)


def agreement(one, other):
    """Say whether two expressions are equal: ``"proved"``, ``"probed"`` or ``"different"``.

    Random exact points come first, because a single one refutes an equality for good. What survives them is
    simplified: a difference that vanishes is *proved* zero. Only where SymPy cannot finish the proof do the points
    stand alone, and the answer says *probed*. Undefined functions, derivatives, open integrals and impulses count as
    quantities of their own.

    Raises ValueError when the two cannot be compared at any point.

    >>> K, T = sympy.symbols("K T", positive=True)
    >>> agreement(K / (T * s + 1), (K / T) / (s + 1 / T))
    'proved'
    >>> agreement(K / (T * s + 1), K / (T * s - 1))
    'different'
    """
    one, other = sympy.sympify(one), sympy.sympify(other)
    if one == other:
        return "proved"
    one, other = _opaque(one.doit(deep=True), other.doit(deep=True))
    if one == other:
        return "proved"
    if _refuted(one, other):
        return "different"
    difference = one - other
    steps = (sympy.expand, lambda e: sympy.cancel(sympy.together(e)), sympy.gammasimp, sympy.simplify)
    return "proved" if any(step(difference) == 0 for step in steps) else "probed"


def _opaque(*expressions):
    """Replace what has no value at a point by symbols, the same one for the same quantity."""
    kinds = (sympy.Derivative, sympy.Subs, sympy.Integral, AppliedUndef, sympy.DiracDelta)
    symbols = {}

    def replace(expression):
        if isinstance(expression, kinds):
            return symbols.setdefault(expression, sympy.Dummy(f"quantity{len(symbols)}"))
        if not expression.args:
            return expression
        return expression.func(*(replace(argument) for argument in expression.args))

    return tuple(replace(expression) for expression in expressions)


def _refuted(one, other, points=8):
    """Whether the two differ at one of several random points; the same points every time."""
    symbols = sorted(one.free_symbols | other.free_symbols, key=lambda symbol: (symbol.name, str(symbol.assumptions0)))
    dice = random.Random(4)
    judged = 0
    for _ in range(4 * points):
        point = {symbol: _random_value(symbol, dice) for symbol in symbols}
        a, b = (sympy.N(expression.subs(point), 30) for expression in (one, other))
        if not (a.is_number and b.is_number and a.is_finite and b.is_finite):
            continue
        judged += 1
        if abs(a - b) > sympy.Float("1e-20") * (1 + abs(a) + abs(b)):
            return True
        if judged == points:
            return False
    if judged == 0:
        raise ValueError(f"cannot compare {one} with {other}: no point where both have a finite value")
    return False


def _random_value(symbol, dice):
    """A random exact value that the symbol's assumptions allow; complex for a symbol that assumes nothing."""
    if symbol.is_integer:
        return sympy.Integer(dice.randint(1, 6))
    value = sympy.Rational(dice.randint(1, 10**6), 10**5 * dice.randint(1, 9))
    if symbol.is_nonnegative:
        return value
    if symbol.is_negative:
        return -value
    if symbol.is_real:
        return value * dice.choice((-1, 1))
    return value * dice.choice((-1, 1)) + sympy.I * sympy.Rational(dice.randint(1, 10**6), 10**5)


def symbols_by_name(expression, like):
    """Return `expression` with its symbols exchanged for those of the same name in `like`.

    Two SymPy symbols of one name differ when their assumptions do; a book's formula means the name.

    >>> T = sympy.Symbol("T", real=True)
    >>> symbols_by_name(parse("1/T"), like=T + 2) == 1 / T
    True
    """
    known = {}
    for symbol in sorted(like.free_symbols, key=str):
        if symbol.name in known:
            raise ValueError(f"{like} has two different symbols named {symbol.name}: declare {symbol.name} once")
        known[symbol.name] = symbol
    return expression.xreplace({x: known[x.name] for x in expression.free_symbols if x.name in known})


def exact(value):
    """Return `value` as a SymPy expression whose decimal numbers are exact, as they are meant: 0.1 is one tenth.

    >>> exact(0.1) * s
    s/10
    """
    return sympy.nsimplify(sympy.sympify(value), rational=True)
