"""Slips that a page does not know: what comes out where one place of one formula is another one.

A slip is a change as the section Mistakes has them, so that a line of a page can be made of it.
"""

from __future__ import annotations

import ast
import copy
import itertools
from collections.abc import Iterator, Mapping, Sequence

from exercisebook.pages.formula import Formula
from exercisebook.pages.page import Page

#: Functions of which the one is taken for the other.
_ALIKE = [{"sin", "cos", "tan"}, {"log", "ln", "log10"}, {"min", "max"}, {"asin", "acos", "atan"}]
_ONE = ast.Constant(1)
#: By these factors a whole quantity is wrong, and of these wholes it is the other part.
_FACTORS = ("2", "3", "4", "5", "pi", "2*pi", "10", "60", "100", "1000", "3600", "log(2)", "(1 - exp(-1))", "pi/180")
_WHOLES = ("1", "100", "90", "180")

#: {name of a quantity: formula for what it is by mistake}.
Slip = Mapping[str, Formula]


def slips(page: Page, name: str, numbers: Sequence[str] = (), factors: Sequence[str] = ()) -> Iterator[Slip]:
    """Yield the slips that may change an asked quantity, the plainer ones first; many have the same value.

    Arguments:
        page: the exercise.
        name: of the asked quantity.
        numbers: the names of the quantities that are numbers; those of the page if not given.
        factors: by which it may be off besides the usual ones.

    >>> from exercisebook.pages import page
    >>> text = "# 1 Fall (1 point)\\nFrom {h}?\\n## Given\\n| n | v | u |\\n|---|---|---|\\n| h | 1 … 9 | m |\\n"
    >>> text += "## Formulas\\n```\\nv = sqrt(2*9.81*h)\\n```\\n## Asked\\n- `v` the speed\\n"
    >>> [line(one) for one in itertools.islice(slips(page.of(text, "fall.md")[1]["1"], "v"), 4)]
    ['v = 2 * 9.81 * h', 'v = sqrt(2 * 9.81 / h)', 'v = sqrt(2 * 9.81)', 'v = sqrt(h)']
    """
    graph = page.graph
    known = [*graph.givens, *graph.formulas]
    numbers = numbers or known
    above = [one for one in reversed(known) if one == name or one in page.sources(name)]

    def made(of, tree):
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        return {of: Formula("", tree, frozenset(names & {*known}))}

    formulas = {of: graph.formulas[of].tree for of in above if of in graph.formulas}
    alike = {one: [other for other in known if page.units[other] == page.units[one]] for one in known}
    for of, tree in formulas.items():
        yield from (made(of, other) for other in _changed(tree, lambda node: _others(node, alike)))
    for one, other in itertools.combinations(graph.givens, 2):
        if page.units[one] == page.units[other]:
            yield made(one, ast.Name(other)) | made(other, ast.Name(one))
    yield from (made(name, ast.BinOp(_tree(one), ast.Mult(), ast.Name(name))) for one in factors)
    constants = [*map(_tree, (*_FACTORS, *_WHOLES))]
    quantities = {of: [ast.Name(one) for one in numbers if one != of] for of in above if of in numbers}
    for of, others in quantities.items():
        yield from (made(of, tree) for tree in _instead(ast.Name(of), others))
        yield from (made(of, tree) for tree in _together(others, [*others, *constants]))
    for of, tree in formulas.items():
        yield from (made(of, other) for other in _changed(tree, lambda node: _instead(node, map(ast.Name, numbers))))
    for of, tree in formulas.items():
        once = _changed(tree, lambda node: _others(node, {}))
        yield from (made(of, other) for one in once for other in _changed(one, lambda node: _others(node, {})))
    for third in ([ast.Constant(2)], [*map(ast.Name, numbers), *constants]):
        for of, others in quantities.items():
            pairs = (two for pair in itertools.combinations(others, 2) for two in _together(pair[:1], pair[1:]))
            yield from (made(of, tree) for tree in _together(pairs, third))


def _instead(own, others):
    """What may stand for a quantity, or a part of a formula: it with a factor or a term, and others."""
    for factor in map(_tree, _FACTORS):
        yield from (ast.BinOp(own, ast.Mult(), factor), ast.BinOp(own, ast.Div(), factor))
    yield from (ast.UnaryOp(ast.USub(), own), ast.BinOp(_ONE, ast.Div(), own), _ONE, ast.Constant(0))
    yield from (ast.BinOp(own, ast.Pow(), ast.Constant(2)), ast.Call(ast.Name("sqrt"), [own], []))
    for whole in map(_tree, _WHOLES):
        yield from (
            ast.BinOp(own, ast.Add(), whole),
            ast.BinOp(own, ast.Sub(), whole),
            ast.BinOp(whole, ast.Sub(), own),
        )
    for other in others:
        yield from (other, *_together([own], [other]))


def _together(some, others):
    """Each of some with each of the others."""
    for one, other in itertools.product(some, others):
        yield from (ast.BinOp(one, op, other) for op in (ast.Mult(), ast.Div(), ast.Add(), ast.Sub()))
        yield from (ast.BinOp(other, op, one) for op in (ast.Div(), ast.Sub()))


def _tree(text):
    return ast.parse(text, mode="eval").body


def line(slip: Slip) -> str:
    """Return a slip as the section Mistakes of a page has it."""
    return "; ".join(f"{name} = {ast.unparse(formula.tree)}" for name, formula in slip.items())


def _changed(tree, others):
    """Yield a tree with one of its places changed into each of the others of that place."""
    yield from others(tree)
    for field, value in ast.iter_fields(tree):
        if isinstance(value, ast.expr) and field != "func":
            for other in _changed(value, others):
                new = copy.copy(tree)
                setattr(new, field, other)
                yield new
        elif isinstance(value, list) and all(isinstance(one, ast.expr) for one in value):
            for place, one in enumerate(value):
                for other in _changed(one, others):
                    new = copy.copy(tree)
                    setattr(new, field, [*value[:place], other, *value[place + 1 :]])
                    yield new


def _others(node, alike):
    """What may stand in the place of a part of a formula by mistake."""
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
            yield ast.BinOp(_ONE, ast.Div(), right)
        case ast.BinOp(left, ast.Pow(), right):
            yield from (left, ast.BinOp(left, ast.Mult(), right))
        case ast.UnaryOp(ast.USub(), operand):
            yield operand
        case ast.Call(ast.Name(name), [argument, *rest], keywords):
            if not rest:
                yield argument
            if name == "exp":
                yield ast.BinOp(_ONE, ast.Sub(), node)
            for group in _ALIKE:
                for other in sorted(group - {name}) if name in group else ():
                    yield ast.Call(ast.Name(other), [argument, *rest], keywords)
        case ast.Name(name):
            for other in alike.get(name, ()):
                if other != name:
                    yield ast.Name(other)
