"""Mistakes in a formula: the key with one place changed, and the answer compared with each of them.

What is changed is the tree of the key's text, and all that happens is arithmetic with numbers: no formula of a reader
is ever manipulated.
"""

from __future__ import annotations

import ast
import copy
import itertools
from collections.abc import Callable, Collection, Iterator
from typing import Any

import numpy as np

from exercisebook import agreement, formulas
from exercisebook.diagnoses import facts
from exercisebook.diagnoses.background import Background
from exercisebook.diagnoses.finding import Finding, explained, recomputed
from exercisebook.grammar import listed
from exercisebook.kinds import Expression

#: A number in place of a symbol is sought from this power of ten on, and is told in digits that make such a difference.
LEAST_SIZE, SHORTENED = -6, 1e-3
#: So many changes of the key are tried at most.
MOST_CHANGES = 250
#: Of the key's symbols these are no quantities.
_VARIABLES = ("s", "t")
#: A tree with one place changed, and a sentence on it.
Change = tuple[ast.expr, str]


@explained.register
def _(kind: Expression, answer: Any, background: Background) -> Finding | None:
    if _is_nothing(kind, answer):  # which comes out of many a mistake
        return facts.of(kind, answer, background) or Finding("that is 0, and the right one is not", is_mistake=False)
    return (
        with_a_number(kind, answer)
        or changed_in_one_place(kind, answer, _likely)
        or recomputed(kind, answer, background)
        or changed_in_one_place(kind, answer, _possible)
        or facts.of(kind, answer, background)
    )


def _is_nothing(kind, answer):
    return not np.any(answer if isinstance(answer, np.ndarray) else answer.values_at(kind.points()))


def with_a_number(kind: Expression, answer: Any) -> Finding | None:
    """Return the symbol of the key in whose place the answer has a number, and which one."""
    if not isinstance(answer, formulas.Formula):
        return None
    used, there = ({node.id for node in _names(one.tree)} - {*_VARIABLES} for one in (kind.key, answer))
    if len(used - there) != 1:
        return None
    (name,) = used - there
    points = {one: np.ravel(values)[7:60:9, None] for one, values in kind.points().items() if one != name}
    for sign in (1, -1):
        value = sign * _best(lambda sizes, sign=sign: kind.key(**points, **{name: sign * sizes}), answer(**points))
        if not 10 ** (LEAST_SIZE + 1) < abs(value) < 10 ** -(LEAST_SIZE + 1):  # none is the best, or an endless one
            continue
        short = [float(f"{value:.{digits}g}") for digits in range(1, 6)]
        for number in short:
            wrong = copy.copy(kind)
            wrong.key = kind.key.with_tree(_with_number(kind.key.tree, name, number))
            if number != 1 and abs(number / value - 1) < SHORTENED and wrong.agrees(answer):
                return Finding(f"that is right if {name} is {number:g}: leave {name} as a symbol")
    return None


def _best(key, found):
    """The size with which a key comes nearest to what is found at some points, in finer and finer steps."""
    low, high = LEAST_SIZE, -LEAST_SIZE
    for _ in range(5):
        sizes = np.linspace(low, high, 121)
        with np.errstate(all="ignore"):
            off = np.max(np.abs(key(10**sizes) / found - 1), axis=0)
        best, step = sizes[np.argmin(np.where(np.isfinite(off), off, np.inf))], sizes[1] - sizes[0]
        low, high = best - 2 * step, best + 2 * step
    return float(10**best)


def _with_number(tree, name, number):
    """The tree with a number in place of a symbol."""
    for node in _names(tree):
        if node.id == name:
            tree = _with(tree, node, ast.Constant(number))
            return _with_number(tree, name, number)
    return tree


def changed_in_one_place(kind: Expression, answer: Any, changes: Callable[..., Iterator[Change]]) -> Finding | None:
    """Return the place of the key in which a formula differs from it."""
    if isinstance(answer, formulas.Formula) and not np.isfinite(answer(**kind.points())).any():
        return None
    for tree, says in itertools.islice(changes(kind.key.tree, kind.symbols or ()), MOST_CHANGES):
        wrong = copy.copy(kind)
        wrong.key = kind.key.with_tree(tree)
        if not wrong.may_agree(answer):
            continue
        if not agreement.agree(kind.key, wrong.key, kind.points(), 1e-9) and wrong.agrees(answer):
            return Finding(says)
    return None


def _likely(tree: ast.expr, symbols: Collection[str]) -> Iterator[Change]:
    """The tree with one place changed, and a sentence on it, the likelier changes.

    >>> tree = ast.parse("a/(b + c)", mode="eval").body
    >>> {ast.unparse(one): says for one, says in _likely(tree, "abc")}["a / (b - c)"]
    'one sign is wrong: look at the term with c'
    """
    yield from _signs(tree)
    if {node.id for node in _names(tree)} - {*_VARIABLES}:  # else the givens say more than the places of numbers
        yield from _terms(tree)
        yield from _sides(tree)


def _possible(tree: ast.expr, symbols: Collection[str]) -> Iterator[Change]:
    """The others."""
    yield from _terms(tree)
    yield from _symbols(tree, symbols)
    yield from _powers(tree)


def _places(tree, *types):
    """The places of some types of nodes, from the whole to its parts."""
    return [node for node in ast.walk(tree) if isinstance(node, types)]


def _names(tree):
    """The places of symbols, without the names of functions."""
    functions = {id(call.func) for call in _places(tree, ast.Call)}
    return [node for node in _places(tree, ast.Name) if id(node) not in functions]


def _with(tree, place, new):
    """The tree with another node in a place."""
    if tree is place:
        return new
    parts = {}
    for name, value in ast.iter_fields(tree):
        if isinstance(value, ast.expr):
            value = _with(value, place, new)
        elif isinstance(value, list):
            value = [_with(part, place, new) if isinstance(part, ast.expr) else part for part in value]
        parts[name] = value
    return type(tree)(**parts)


def _called(node):
    """A part of a formula in words, by the symbols in it."""
    names = {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
    functions = {one.func.id for one in ast.walk(node) if isinstance(one, ast.Call)}
    quantities = sorted(names - functions - {*_VARIABLES})
    variables = sorted(names & {*_VARIABLES})
    if quantities:
        return f"with {listed(quantities)}"
    if functions:
        return f"with {listed(sorted(functions))}"
    return f"with {variables[0]}" if variables else "without symbols"


_MINUS = ast.USub()


def _signs(tree):
    for node in _places(tree, ast.BinOp):
        if isinstance(node.op, ast.Add | ast.Sub):
            other = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
            says = f"one sign is wrong: look at the term {_called(node.right)}"
            yield _with(tree, node, ast.BinOp(node.left, other, node.right)), says
            says = f"one sign is wrong: look at the term {_called(node.left)}"
            yield _with(tree, node, ast.BinOp(ast.UnaryOp(_MINUS, node.left), node.op, node.right)), says
    for node in _places(tree, ast.UnaryOp):
        if isinstance(node.op, ast.USub):
            yield _with(tree, node, node.operand), f"one sign is wrong: look at the part {_called(node.operand)}"
    for node in _places(tree, ast.Call):
        if node.func.id == "exp":
            (exponent,) = node.args
            says = "the sign of an exponent is wrong: does that grow, or does it die away?"
            yield _with(tree, node, ast.Call(node.func, [ast.UnaryOp(_MINUS, exponent)], [])), says


def _terms(tree):
    for node in _places(tree, ast.BinOp):
        if isinstance(node.op, ast.Add | ast.Sub):
            yield _with(tree, node, node.left), f"a term is missing: look for one {_called(node.right)}"
            left = node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(_MINUS, node.right)
            yield _with(tree, node, left), f"a term is missing: look for one {_called(node.left)}"


def _sides(tree):
    """What multiplies where it should divide; a factor that is missing, or there twice."""
    for node in _places(tree, ast.BinOp):
        if isinstance(node.op, ast.Mult | ast.Div):
            left, right, is_product = node.left, node.right, isinstance(node.op, ast.Mult)
            other = ast.Div() if is_product else ast.Mult()
            inverse_left, inverse_right = (ast.BinOp(ast.Constant(1), ast.Div(), part) for part in (left, right))
            does = "divides where it should multiply" if is_product else "multiplies where it should divide"
            yield _with(tree, node, ast.BinOp(left, other, right)), f"{_factor(right)} {does}"
            says = f"{_factor(left)} divides where it should multiply"
            yield _with(tree, node, ast.BinOp(inverse_left, node.op, right)), says
            yield _with(tree, node, left), f"{_factor(right)} is missing"
            yield _with(tree, node, right if is_product else inverse_right), f"{_factor(left)} is missing"


def _factor(node):
    called = _called(node)
    return "a number" if called == "without symbols" else f"the factor {called}"


def _symbols(tree, symbols):
    used = sorted({node.id for node in _names(tree)} & {*symbols} - {*_VARIABLES})
    allowed = sorted({*symbols} - {*_VARIABLES})
    for k, one in enumerate(used):  # two of them interchanged everywhere
        for other in used[k + 1 :]:
            yield _renamed(tree, {one: other, other: one}), f"{one} and {other} are interchanged"
    for one in used:
        places = [node for node in _names(tree) if node.id == one]
        for other in allowed:
            if other != one:
                says = f"somewhere there is {other} where {one} belongs"
                yield _renamed(tree, {one: other}), says
                if len(places) > 1:
                    yield from ((_with(tree, node, ast.Name(other)), says) for node in places)
        for node in places:
            yield _with(tree, node, ast.Constant(1)), f"{one} is missing somewhere"
            yield _with(tree, node, ast.Constant(0)), f"{one} is missing somewhere"
            yield _with(tree, node, ast.BinOp(ast.Constant(1), ast.Div(), node)), f"somewhere {one} is upside down"
            for factor in (2, 0.5):
                new = ast.BinOp(ast.Constant(factor), ast.Mult(), node)
                yield _with(tree, node, new), f"{one} comes with a factor of 2 too many, or with one too few"


def _renamed(tree, names):
    class Renamed(ast.NodeTransformer):
        def visit_Name(self, node):
            return ast.Name(names.get(node.id, node.id))

    return Renamed().visit(copy.deepcopy(tree))


def _powers(tree):
    for node in _places(tree, ast.BinOp):
        if isinstance(node.op, ast.Pow):
            says = f"a power is wrong: look at the part {_called(node.left)}"
            yield _with(tree, node, node.left), says
            yield _with(tree, node, ast.BinOp(node, ast.Mult(), node.left)), says
            yield _with(tree, node, ast.BinOp(node.left, ast.Pow(), ast.UnaryOp(_MINUS, node.right))), says
    for node in _places(tree, ast.Call):
        if node.func.id == "sqrt":
            yield _with(tree, node, node.args[0]), "a square root is missing"
        swap = {"sin": "cos", "cos": "sin"}.get(node.func.id)
        if swap:
            yield _with(tree, node, ast.Call(ast.Name(swap), node.args, [])), "sine and cosine are interchanged"
    for node in _names(tree):
        says = f"{node.id} is there without its square, or with another power than it should have"
        yield _with(tree, node, ast.BinOp(node, ast.Pow(), ast.Constant(2))), says
