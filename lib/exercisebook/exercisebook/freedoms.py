"""The numbers of a formula that may be rounded, and those that belong together.

A number that multiplies a product is one number, however it is written: 5/2, and the 5 and the 2 of 5*x/(2*y). In a
factor as 40*s + 4 one of the two numbers says nothing new beside the number before the product: 1/(40*s + 4) is a
0.25/(10*s + 1). What stands in an exponent alone, as in s**2, is exact, unless it is a decimal such as 0.33. A 1 is
a number like any other, also where it is not written: exp(-s) is a dead time of 1.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

from exercisebook.arithmetic import Decimals, worked_out
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
        is_switch: whether it is what a step or a piece depends on.

    >>> from exercisebook.formulas import Formula
    >>> tree = Formula("5*exp(-10*s/3)/(2*(40*s + 4)*(s + 0.1))", "s").tree
    >>> [ast.unparse(one.node) for one in freedoms(tree)]
    ['-10 * s / 3', '40 * s', '0.1', '5 * exp(-10 * s / 3) / (2 * (40 * s + 4) * (s + 0.1))']
    >>> [ast.unparse(one.node) for one in freedoms(Formula("1 - exp(-(t - 1))", "t").tree)]
    ['1', '1', '-(t - 1)', 'exp(-(t - 1))']
    """
    return list(_of(tree, None if is_switch else (), is_switch))


def _of(node: ast.expr, beside: tuple[ast.expr, ...] | None, decides: bool) -> Iterator[Freedom]:
    """The numbers of a part; beside it are no other terms yet, or there is None that counts."""
    match node:
        case _ if is_number(node):
            if _says(node):
                yield Freedom(node, beside or (), decides)
        case ast.BinOp(op=ast.Add() | ast.Sub()):
            terms = terms_of(node)
            for term in terms:
                yield from _of(term, None if beside is None else tuple(terms), decides)
        case ast.Call(ast.Name("Piecewise")):
            for piece in node.args:
                value, condition = piece.elts
                yield from _of(value, beside, decides)
                yield from _of(condition, None, True)
        case ast.Compare():
            yield from _of(node.left, None, True)
            yield from _of(node.comparators[0], None, True)
        case _:
            yield from _of_product(node, beside, decides)


def _of_product(node, beside, decides):
    """The numbers in the factors of a product, and its own one."""
    for factor in _factors(node):
        if is_number(factor):
            continue
        if _is_sum(factor):
            terms = terms_of(factor)
            inside = tuple(terms) if beside == () and _is_above(node, factor) else None
            fixed = _fixed(terms)
            for term in terms:
                yield from (one for one in _of(term, inside, decides) if term is not fixed or one.node is not term)
        elif isinstance(factor, ast.Call):
            is_step = decides or factor.func.id in _STEPS
            for argument in factor.args:
                yield from _of(argument, None, is_step)
        elif isinstance(factor, ast.BinOp):  # a power with a symbol in its exponent
            yield from _of(factor.left, None, decides)
            yield from _of(factor.right, None, decides)
    for exponent in _exponents(node):
        yield Freedom(exponent, (), decides)
    yield Freedom(node, beside or (), decides)


def _fixed(terms):
    """The term of a sum whose number says nothing new beside that of the product: one that has none, or is a number."""
    bare = (term for term in terms if not is_number(term) and not _has_number(term))
    return next(bare, None) or next((term for term in terms if is_number(term)), terms[0])


def _has_number(term):
    return any(is_number(factor) and _says(factor) for factor in _factors(term))


def _says(node):
    """Whether a part without symbols has a number that may be rounded; zero has none."""
    match node:
        case ast.Constant():
            return type(node.value) is not bool and node.value != 0
        case ast.BinOp(op=ast.Pow()):
            return _says(node.left)
        case ast.Name():
            return False
    return any(_says(part) for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr))


def _exponents(node):
    """The exponents in a product that are no multiples of one half, which may be rounded."""
    match node:
        case ast.BinOp(op=ast.Mult() | ast.Div()):
            yield from _exponents(node.left)
            yield from _exponents(node.right)
        case ast.UnaryOp():
            yield from _exponents(node.operand)
        case ast.BinOp(op=ast.Pow()) if is_number(node.right) and not is_number(node.left):
            value = complex(worked_out(node.right, Decimals({})))
            if (2 * value.real) % 1:
                yield node.right


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
    """What is multiplied and divided in a product; of a power, and of a root, what it is a power of."""
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
        case ast.Call(ast.Name("sqrt"), [argument]):
            yield from _factors(argument)
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
