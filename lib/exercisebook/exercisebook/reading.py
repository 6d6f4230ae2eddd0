"""Reading what readers give, without running anything of theirs: values, rows of values, and what spells a formula.

The text of a formula is read by `grammar`, numbers with their units in `kinds.numeric`. SymPy's expressions, and linear
systems of SciPy and python-control, are read from what they spell.
"""

from __future__ import annotations

import ast
import itertools
import math
import re
from collections.abc import Iterable, Iterator, MappingView
from typing import Any

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from exercisebook.grammar import CONSTANTS, MOST_NODES, Unreadable, read

#: What is left of an answer cell that nobody has filled in.
NOT_ANSWERED = "not answered yet"
#: Of what gives one value after another, so many are read.
MOST_VALUES = 10_000
#: Brackets around a whole list.
MOST_BRACKETS = 10

# --------------------------------------------------------------------------------------------------------- values


def answered(given: object) -> Any:
    """Return what was given; raises Unreadable where that is nothing yet."""
    if given is None or given is Ellipsis:
        raise Unreadable(NOT_ANSWERED)
    return given


def in_a_row(given: object) -> list[Any] | None:
    """Return the values of a list, tuple, array, matrix or range as a list; None where there is no row of values."""
    if isinstance(given, sympy.MatrixBase):
        return given.tolist()
    if isinstance(given, sympy.Tuple | list | tuple | range | Iterator | MappingView):
        return list(itertools.islice(given, MOST_VALUES))
    if hasattr(given, "tolist") and hasattr(given, "ndim"):
        return given.tolist() if given.ndim else None
    return None


def members(given: Iterable[Any]) -> list[Any]:
    """Return the members of a set in an order that is the same in each run of Python, numbers before texts.

    >>> members({"S4", "S2", 1})
    [1, 'S2', 'S4']
    """
    return sorted(given, key=lambda one: (isinstance(one, str), str(one)))


def alone(given: object) -> Any:
    """Return the value that stands alone in a row, a set, an array, or an equation for a symbol; others as they are.

    >>> alone([{sympy.Symbol("x"): 3}]), alone(sympy.Eq(sympy.Symbol("x"), 3)), alone([1, 2])
    (3, 3, [1, 2])
    """
    if isinstance(given, sympy.Equality) and isinstance(given.lhs, sympy.Symbol | AppliedUndef):
        return given.rhs
    if isinstance(given, dict) and len(given) == 1 and isinstance(next(iter(given)), sympy.Symbol | AppliedUndef):
        return next(iter(given.values()))
    if isinstance(given, set | frozenset | sympy.FiniteSet):
        given = members(given)
    elif getattr(given, "ndim", None) == 0 and hasattr(given, "tolist") and not hasattr(given, "units"):
        return given.tolist()
    row = in_a_row(given)
    if row is None:
        return given
    return alone(row[0]) if len(row) == 1 else row


#: A name before a list or an array, and the call that makes an array.
_NAMED_LIST = re.compile(r"^[^\W\d]\w* ?= ?(?=\[|(?:\w+\.)?(?:Matrix|array)\()")
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?(?:[-+](?:\d+\.?\d*|\.\d+)j)?"
_ARRAY = re.compile(r"(?:\w+\.)?(?:Matrix|array)\((.*)\)")


def listed_in(text: str) -> list[str]:
    """Return the parts of a text that lists several: "[1, 2]" or "1; 2".

    Between brackets every comma separates, unless there are semicolons; elsewhere a comma before a space or a sign
    does, as others are decimal commas.

    >>> listed_in("[-1,-2]"), listed_in("-1 + 2j; -3"), listed_in("1,5"), listed_in("[0,5; 1]")
    (['-1', '-2'], ['-1 + 2j', '-3'], ['1,5'], ['0,5', '1'])
    >>> listed_in("[[1, 2], [3, 4]]"), listed_in("1, 2 and 3")
    (['[1, 2]', '[3, 4]'], ['1', '2', '3'])
    """
    text = re.sub(r"\\[,;:! ]|\\q?quad|~|\$|\\(?:left|right)(?![a-z])", " ", text.strip())
    text = re.sub(r"\\text\{ *(and|or) *\}", r" \1 ", text).replace("\\{", "{").replace("\\}", "}")
    text = _NAMED_LIST.sub("", " ".join(re.sub(r" *[,;]? *\n", "; ", text).split()))
    if array := _ARRAY.fullmatch(text):
        text = array[1]
    if not text:
        return [text]
    inside = _unwrapped(text)
    in_spaces = inside != text and re.fullmatch(_NUMBER + rf"(?: {_NUMBER})+", inside)  # an array as it is printed
    for separator in (
        r";",
        r",? (?:(?:and|und|&) |or (?=[a-z]\w* ?=))|, |,(?=[-−+±])",
        r"," if inside != text else r",(?=\[)",
        " " if in_spaces else r"(?!)",
    ):
        depths = _depths(inside)
        places = [found for found in re.finditer(separator, inside) if not depths[found.start()]]
        if places:
            ends = [(0, 0), *(found.span() for found in places), (len(inside), len(inside))]
            parts = [inside[one[1] : other[0]].strip() for one, other in itertools.pairwise(ends)]
            return [part for part in parts if part]
    return [inside] if inside else []


def _depths(text):
    """How many brackets are open before each sign of a text, and after the last one."""
    return list(itertools.accumulate(((sign in "([{") - (sign in ")]}") for sign in text), initial=0))


def _unwrapped(text):
    """What stands within the brackets around the whole text; within round ones, where it lists several."""
    pairs = {"[": "]", "{": "}", "(": ")"}
    for _ in range(MOST_BRACKETS):
        depths = _depths(text)
        if not text or pairs.get(text[0]) != text[-1] or not all(depths[1:-1]):
            break
        lists = any(sign in ",;" and depth == 1 for sign, depth in zip(text, depths, strict=False))
        if text[0] == "(" and not lists:
            break
        text = text[1:-1].strip()
        if lists:
            break
    return text


# ------------------------------------------------------------------------------------------------------- formulas


def symbols_in(given: object) -> list[str]:
    """Return the symbols of a formula, whichever they are, in their order; of what is no formula, none.

    Raises Unreadable where nothing spells it.

    >>> symbols_in("K*exp(-tau*s)/(T*s + 1)")
    ['K', 'T', 's', 'tau']
    """
    text = spelled(given)
    try:
        tree = read(text, None).tree
    except Unreadable:
        return []
    functions = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call)}
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return sorted(names - functions - CONSTANTS.keys())


def spelled(given: object) -> str:
    """Return the text of a formula that was given as text, number, expression or system; raises Unreadable."""
    if isinstance(given, str):
        return given
    if isinstance(given, bool | np.bool_):
        raise Unreadable(f"{given} is a truth value: expected an expression")
    if isinstance(given, sympy.Xor):
        raise Unreadable("in Python ^ is no power: write **, or put the formula in quotes")
    try:
        expression = _expression(given)
    except Exception:  # objects of others may fail in any way
        expression = None
    if expression is None:
        raise Unreadable("this is neither an expression nor a text that spells one")
    nodes = zip(sympy.preorder_traversal(expression), range(MOST_NODES + 1), strict=False)
    if sum(1 for _ in nodes) > MOST_NODES:
        raise Unreadable("the expression is very long: expected a simpler one")
    return str(expression)


def _expression(given):
    """The expression in SymPy that an object is or has; None where there is none."""
    if isinstance(given, sympy.Expr):
        # a signal, h(t), is a symbol here
        return None if given.is_Matrix else given.replace(_is_signal, lambda signal: sympy.Symbol(signal.func.__name__))
    if isinstance(getattr(given, "expr", None), sympy.Expr):
        return given.expr
    if hasattr(given, "to_expr"):  # SymPy's own systems
        return given.to_expr()
    if hasattr(given, "gain") and hasattr(given, "to_tf"):  # SciPy's zeros and poles
        given = given.to_tf()
    if all(hasattr(given, part) for part in ("num", "den")) or all(hasattr(given, part) for part in "ABCD"):
        return _of_system(given)
    if np.ndim(given) == 0:
        value = complex(given)
        return sympy.sympify(value if value.imag else value.real) if math.isfinite(abs(value)) else None
    return None


def _is_signal(part):
    return isinstance(part, AppliedUndef) and [str(argument) for argument in part.args] == ["t"]


def _of_system(given):
    """The expression of a system of python-control or SciPy; None unless it is one in s with one input and output."""
    if getattr(given, "dt", None) or getattr(given, "ninputs", 1) * getattr(given, "noutputs", 1) != 1:
        return None
    if hasattr(given, "num"):
        above, below = np.ravel(given.num), np.ravel(given.den)
    else:
        import scipy.signal

        above, below = map(np.ravel, scipy.signal.ss2tf(given.A, given.B, given.C, given.D))
        above = np.where(np.abs(above) > 1e-12 * np.abs(below), above, 0)  # powers that are there by rounding alone
    above, below = (sympy.Poly([float(x) for x in part], sympy.Symbol("s")).as_expr() for part in (above, below))
    return above / below
