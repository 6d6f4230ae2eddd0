"""Slips that a page does not know: what comes out where one place of one formula is another one.

A slip is a change as the section Mistakes has them, so that a line of a page can be made of it.
"""

from __future__ import annotations

import ast
import copy
import itertools
from collections.abc import Iterator, Mapping

from exercisebook.pages.formula import Formula
from exercisebook.pages.page import Page

#: Functions of which the one is taken for the other.
_ALIKE = [{"sin", "cos", "tan"}, {"log", "ln", "log10"}, {"min", "max"}, {"asin", "acos", "atan"}]
#: By these factors a whole quantity is wrong, and of these wholes it is the other part.
_FACTORS = ("2", "pi", "2*pi", "10", "60", "100", "1000", "log(2)", "(1 - exp(-1))", "pi/180")
_WHOLES = ("1", "100", "90", "180")
#: So many slips of a quantity are enough.
MOST = 600

#: {name of a quantity: formula for what it is by mistake}.
Slip = Mapping[str, Formula]


def slips(page: Page, name: str) -> Iterator[Slip]:
    """Yield the slips that may change an asked quantity, the plainer ones first; many have the same value.

    Arguments:
        page: the exercise.
        name: of the asked quantity.

    >>> from exercisebook.pages import page
    >>> text = "# 1 Fall (1 point)\\nFrom {h}?\\n## Given\\n| n | v | u |\\n|---|---|---|\\n| h | 1 … 9 | m |\\n"
    >>> text += "## Formulas\\n```\\nv = sqrt(2*9.81*h)\\n```\\n## Asked\\n- `v` the speed\\n"
    >>> [line(one) for one in slips(page.of(text, "fall.md")[1]["1"], "v")][:4]
    ['v = 2 * 9.81 * h', 'v = sqrt(2 * 9.81 / h)', 'v = sqrt(2 * 9.81)', 'v = sqrt(h)']
    """
    graph, found = page.graph, set()
    known = [*graph.givens, *graph.formulas]

    def made(of, tree):
        text = ast.unparse(tree)
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        return {of: Formula(text, tree, frozenset(names & {*known}))}

    def every():
        for of, formula in graph.formulas.items():
            if of == name or of in page.sources(name):
                above = known[: known.index(of)]
                alike = {one: [other for other in above if page.units[other] == page.units[one]] for one in above}
                for tree in _changed(formula.tree, alike):
                    yield made(of, tree)
        for one, other in itertools.combinations(graph.givens, 2):
            if page.units[one] == page.units[other]:
                yield made(one, ast.Name(other)) | made(other, ast.Name(one))
        yield from (made(name, tree) for tree in _instead(ast.Name(name), [one for one in known if one != name]))

    for slip in itertools.islice(every(), MOST):
        if (text := line(slip)) not in found:
            found.add(text)
            yield slip


def _instead(own, others):
    """What may stand for a whole quantity: it with a factor or a term, another one, and two others together."""
    one, names, plus, minus, times, by = (
        ast.Constant(1),
        [*map(ast.Name, others)],
        ast.Add(),
        ast.Sub(),
        ast.Mult(),
        ast.Div(),
    )
    for factor in map(_tree, _FACTORS):
        yield from (ast.BinOp(own, times, factor), ast.BinOp(own, by, factor))
    yield from (ast.UnaryOp(ast.USub(), own), ast.BinOp(one, by, own))
    for whole in map(_tree, _WHOLES):
        yield from (ast.BinOp(whole, minus, own), ast.BinOp(own, minus, whole), ast.BinOp(own, plus, whole))
    yield from names
    for other in names:
        yield from (ast.BinOp(own, op, other) for op in (plus, minus, times, by))
        yield ast.BinOp(other, minus, own)
    for other, another in itertools.combinations(names, 2):
        yield from (ast.BinOp(other, by, another), ast.BinOp(another, by, other), ast.BinOp(other, times, another))


def _tree(text):
    return ast.parse(text, mode="eval").body


def line(slip: Slip) -> str:
    """Return a slip as the section Mistakes of a page has it."""
    return "; ".join(f"{name} = {formula.text}" for name, formula in slip.items())


def _changed(tree, alike):
    """Yield a tree with one of its places changed."""
    for other in _others(tree, alike):
        yield other
    for field, value in ast.iter_fields(tree):
        if isinstance(value, ast.expr):
            for other in _changed(value, alike):
                new = copy.copy(tree)
                setattr(new, field, other)
                yield new
        elif isinstance(value, list) and all(isinstance(one, ast.expr) for one in value):
            for place, one in enumerate(value):
                for other in _changed(one, alike):
                    new = copy.copy(tree)
                    setattr(new, field, [*value[:place], other, *value[place + 1 :]])
                    yield new


def _others(node, alike):
    """What may stand in the place of a part of a formula by mistake."""
    one = ast.Constant(1)
    match node:  # brackets that are elsewhere
        case ast.BinOp(ast.BinOp(a, ast.Mult() | ast.Div() as op, b), ast.Add() | ast.Sub() as sum_, c):
            yield ast.BinOp(a, op, ast.BinOp(b, sum_, c))
        case ast.BinOp(a, ast.Mult() | ast.Div() as op, ast.BinOp(b, ast.Add() | ast.Sub() as sum_, c)):
            yield ast.BinOp(ast.BinOp(a, op, b), sum_, c)
        case ast.BinOp(ast.BinOp(a, ast.Add() | ast.Sub() as sum_, b), ast.Mult() | ast.Div() | ast.Pow() as op, c):
            yield ast.BinOp(a, sum_, ast.BinOp(b, op, c))
    match node:
        case ast.BinOp(left, ast.Add(), right):
            yield from (ast.BinOp(left, ast.Sub(), right), left, right)
        case ast.BinOp(left, ast.Sub(), right):
            yield from (ast.BinOp(left, ast.Add(), right), ast.BinOp(right, ast.Sub(), left), left, right)
        case ast.BinOp(left, ast.Mult(), right):
            yield from (ast.BinOp(left, ast.Div(), right), left, right)
        case ast.BinOp(left, ast.Div(), right):
            yield from (ast.BinOp(left, ast.Mult(), right), ast.BinOp(right, ast.Div(), left), left)
            yield ast.BinOp(one, ast.Div(), right)
        case ast.BinOp(left, ast.Pow(), right):
            yield from (left, ast.BinOp(left, ast.Mult(), right))
        case ast.UnaryOp(ast.USub(), operand):
            yield operand
        case ast.Call(ast.Name(name), [argument, *rest], keywords):
            if not rest:
                yield argument
            if name == "exp":
                yield ast.BinOp(one, ast.Sub(), node)
            for group in _ALIKE:
                for other in sorted(group - {name}) if name in group else ():
                    yield ast.Call(ast.Name(other), [argument, *rest], keywords)
        case ast.Name(name):
            for other in alike.get(name, ()):
                if other != name:
                    yield ast.Name(other)
