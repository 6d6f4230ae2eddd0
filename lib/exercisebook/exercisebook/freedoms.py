"""The numbers of a formula that may be rounded, and those that belong together.

A number that multiplies a product is one number, however it is written: 5/2, and the 5 and the 2 of 5*x/(2*y). In a
factor as 40*s + 4 one of the two numbers says nothing new beside the number before the product: 1/(40*s + 4) is a
0.25/(10*s + 1). What stands in an exponent alone, as in s**2, is exact. In a function, a 1 is a number like any other,
also where it is not written: exp(-s) is a dead time of 1.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

from exercisebook.formulas import is_number


@dataclass(frozen=True)
class Freedom:
    """A number of a formula that may be rounded.

    Attributes:
        node: what is multiplied by a factor where the number is.
        beside: the terms of the sum that it is a term of; none where that is a sum in a function, or below a bar.
        decides: whether it stands where a step or a piece begins; what a limiter compares are values.
    """

    node: ast.expr
    beside: tuple[ast.expr, ...] = ()
    decides: bool = False


#: What jumps; and what has a kink, and the values of its arguments beside it.
_STEPS = {"Heaviside", "sign"}
_SWITCHES = _STEPS | {"Min", "Max", "min", "max", "Abs", "abs"}


def freedoms(tree: ast.expr, is_switch: bool = False) -> list[Freedom]:
    """Return the numbers of a formula that may be rounded.

    Arguments:
        is_switch: whether it is what a step or a piece depends on, where 1 is a number, too.

    >>> from exercisebook.formulas import Formula
    >>> tree = Formula("5*exp(-10*s/3)/(2*(40*s + 4)*(s + 0.1))", "s").tree
    >>> [ast.unparse(one.node) for one in freedoms(tree)]
    ['-10 * s / 3', '40 * s', '0.1', '5 * exp(-10 * s / 3) / (2 * (40 * s + 4) * (s + 0.1))']
    >>> [ast.unparse(one.node) for one in freedoms(Formula("exp(-(t - 1))", "t").tree)]
    ['1', '-(t - 1)']
    """
    return list(_of(tree, None if is_switch else (), _IN_SWITCH if is_switch else _PLAIN))


#: Where a part stands: in no function, in one, or where a step or a piece begins. In a function, 1 is a number, too.
_PLAIN, _IN_FUNCTION, _IN_SWITCH = range(3)


def _of(node: ast.expr, beside: tuple[ast.expr, ...] | None, where: int) -> Iterator[Freedom]:
    """The numbers of a part; beside it are no other terms yet, or there is None that counts."""
    decides = where == _IN_SWITCH
    match node:
        case _ if is_number(node):
            if _says(node) or (where and not _is_none(node)):
                yield Freedom(node, beside or (), decides)
        case ast.BinOp(op=ast.Add() | ast.Sub()):
            terms = terms_of(node)
            for term in terms:
                yield from _of(term, None if beside is None else tuple(terms), where)
        case ast.BinOp(op=ast.Mult() | ast.Div()) | ast.UnaryOp():
            yield from _of_product(node, beside, where)
        case ast.BinOp(op=ast.Pow()) if is_number(node.right):
            yield from _of_product(node, beside, where)
        case ast.Call(ast.Name("Piecewise")):
            for piece in node.args:
                value, condition = piece.elts
                yield from _of(value, beside, where)
                yield from _of(condition, None, _IN_SWITCH)
        case ast.Call():
            for argument in node.args:
                inside = _IN_SWITCH if decides or node.func.id in _STEPS else _IN_FUNCTION
                yield from _of(argument, None, inside)
        case ast.Compare():
            yield from _of(node.left, None, _IN_SWITCH)
            yield from _of(node.comparators[0], None, _IN_SWITCH)
        case ast.BinOp():
            yield from _of(node.left, None, where)
            yield from _of(node.right, None, max(where, _IN_FUNCTION))
        case _ if where:
            yield Freedom(node, (), decides)


def _of_product(node, beside, where):
    """The numbers in the factors of a product, and its own one."""
    has_number, factors = where != _PLAIN, list(_factors(node))
    for factor in factors:
        if is_number(factor):
            has_number = has_number or _says(factor)
        elif _is_sum(factor):
            terms = terms_of(factor)
            fixed = _fixed(terms, where)
            has_number = has_number or fixed is not None
            inside = tuple(terms) if beside == () and _is_above(node, factor) else None
            for term in terms:
                found = _of(term, inside, where)
                yield from (one for one in found if term is not fixed or one.node is not term)
        elif not isinstance(factor, ast.Name):
            yield from _of(factor, None, where)
    if has_number:
        yield Freedom(node, beside or (), where == _IN_SWITCH)


def _fixed(terms, where):
    """The term of a sum whose number says nothing new beside that of the product; None where each other one is 1."""
    if where == _PLAIN and not all(_has_number(term) for term in terms):
        return None
    bare = (term for term in terms if not is_number(term) and not _has_number(term))
    return next(bare, None) or next((term for term in terms if is_number(term)), terms[0])


def _has_number(term):
    return any(is_number(factor) and _says(factor) for factor in _factors(term))


def _says(node):
    """Whether a part without symbols has a number that may be rounded."""
    match node:
        case ast.Constant():
            return type(node.value) is not bool and node.value not in (0, 1)
        case ast.BinOp(op=ast.Pow()):
            return _says(node.left)
        case ast.Name():
            return False
    return any(_says(part) for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr))


def terms_of(node: ast.expr) -> list[ast.expr]:
    """Return the terms of a sum, without their signs.

    >>> [ast.unparse(term) for term in terms_of(ast.parse("a - (2*b + c)", mode="eval").body)]
    ['a', '2 * b', 'c']
    """
    match node:
        case ast.BinOp(op=ast.Add() | ast.Sub()) if not is_number(node):
            return terms_of(node.left) + terms_of(node.right)
    return [node]


def _is_sum(node):
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub) and not is_number(node)


def _factors(node):
    """What is multiplied and divided in a product; of a power what it is a power of."""
    match node:
        case _ if is_number(node):
            yield node
        case ast.BinOp(op=ast.Mult() | ast.Div()):
            yield from _factors(node.left)
            yield from _factors(node.right)
        case ast.UnaryOp():
            yield from _factors(node.operand)
        case ast.BinOp(op=ast.Pow()) if is_number(node.right):
            yield from _factors(node.left)
        case _:
            yield node


def _is_above(node, factor):
    """Whether a factor is above all fraction bars of a product."""
    match node:
        case ast.BinOp(op=ast.Mult()):
            return _is_above(node.left, factor) or _is_above(node.right, factor)
        case ast.BinOp(op=ast.Div()):
            return _is_above(node.left, factor)
        case ast.UnaryOp():
            return _is_above(node.operand, factor)
    return node is factor


def switches(tree: ast.expr) -> list[ast.expr]:
    """Return the expressions of a formula at whose change of sign a step, a limiter or a piece begins.

    >>> [ast.unparse(one) for one in switches(ast.parse("Heaviside(t - 3)*Max(t, 2)", mode="eval").body)]
    ['t - 3', 't - 2']
    """
    found: list[ast.expr] = []
    for node in ast.walk(tree):
        match node:
            case ast.Call(ast.Name("Min" | "Max" | "min" | "max"), [first, *others]):
                found += [ast.BinOp(first, ast.Sub(), other) for other in others]
            case ast.Call(ast.Name(name), [one]) if name in _SWITCHES:
                found.append(one)
            case ast.Compare():
                found.append(ast.BinOp(node.left, ast.Sub(), node.comparators[0]))
    return [one for one in found if not is_number(one)]


def _is_none(node):
    return isinstance(node, ast.Constant) and (not node.value or node.value is True)
