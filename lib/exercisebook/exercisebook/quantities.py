"""Numbers with their units, and formulas of them, read by the grammar of formulas.

A letter is a symbol first, then a constant or a function, and then a unit.
"""

from __future__ import annotations

import ast
import copy
import functools
import itertools
import math
import re
import unicodedata
from collections.abc import Iterable
from typing import NamedTuple

import lark

from exercisebook import units
from exercisebook.formulas import value_of
from exercisebook.grammar import (
    UPRIGHT,
    Doubtful,
    NotRead,
    Part,
    Reader,
    Unreadable,
    in_either,
    is_group,
    is_leaf,
    is_name,
    joined,
    last_row,
    leaves,
    negative,
    product,
    sign_of,
    span,
)
from exercisebook.pages import conversion

WORDS = dict.fromkeys(("none", "zero"), 0) | {
    word: number
    for number, word in enumerate(
        ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"), 1
    )
}
#: What begins a remark that is none: it says that the number is not meant so.
_DOUBTING = ("or", "not", "no", "if")
#: What may follow a sign ± beside the number, which is the answer: a wider range would hold other answers.
WIDEST = 0.2


class Quantity(NamedTuple):
    """A tree whose names may be units, {name: unit}, and whether it was written in another notation than Python's."""

    tree: ast.expr
    units: dict[str, str]
    is_other: bool

    def in_unit(self, to: str, time: str = "") -> ast.expr:
        """Return the tree in a unit, without names of units.

        Arguments:
            to: the unit.
            time: the unit of t.
        Raises:
            ValueError: where the units do not fit together, or do not make this one.

        >>> (one,) = quantities("15 K / (10 %)")
        >>> ast.unparse(one.in_unit("K/%"))
        '15 / 10'
        """
        for node in ast.walk(self.tree):
            match node:
                case ast.BinOp(base, ast.Pow(), exponent) if not isinstance(exponent, ast.Constant | ast.UnaryOp):
                    if self._has_unit(base):
                        raise ValueError("a unit in it has a power that is no number")
        known = {name: conversion.unit_of(unit) for name, unit in self.units.items()}
        has_time = any("[time]" in unit.dimensionality for unit in known.values())
        known |= {"t": conversion.unit_of(time if has_time else "")} | dict.fromkeys("eE", conversion.unit_of(""))
        tree, unit = conversion.converted(copy.deepcopy(self.tree), known)
        if unit is conversion.UNKNOWN:
            raise ValueError("the units in it do not fit together")
        return _Ones().visit(conversion.times(tree, conversion.factor(unit, to)))

    def _has_unit(self, tree):
        return any(getattr(node, "id", "") in self.units for node in ast.walk(tree))

    @property
    def apart(self) -> tuple[ast.expr, str] | None:
        """The number and its unit, which is empty where there is none; None where units are in several terms.

        A unit behind a sum is that of the sum.
        """
        match self.tree:
            case ast.BinOp(left, ast.Add() | ast.Sub() as sign, right) if not self._has_unit(left):
                last = Quantity(right, self.units, False).apart
                return last and (ast.BinOp(left, sign, last[0]), last[1])
        above, below, numbers = [], [], []
        for factor, is_above in _factors(self.tree):
            match factor:
                case ast.Name(name) if name in self.units:
                    (above if is_above else below).append(self.units[name])
                case ast.BinOp(ast.Name(name), ast.Pow(), ast.Constant(int(power))) if name in self.units:
                    (above if is_above else below).append(self.units[name] + {2: "²", 3: "³"}.get(power, f"^{power}"))
                case ast.BinOp(ast.Name(name), ast.Pow(), ast.UnaryOp(ast.USub(), ast.Constant(int(power)))) if (
                    name in self.units
                ):
                    raised = {1: "", 2: "²", 3: "³"}.get(power, f"^{power}")
                    (below if is_above else above).append(self.units[name] + raised)
                case _ if self._has_unit(factor):
                    return None
                case _:
                    numbers.append((factor, is_above))
        tree = _multiplied(numbers)
        bottom = f"/({' '.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
        return tree, (" ".join(above) or ("1" if below else "")) + bottom


def quantities(text: str, symbols: Iterable[str] = ()) -> list[Quantity]:
    """Return what a text says: one number, or formula, with its units, or several that are said to be equal.

    Raises Unreadable in a sentence.

    >>> [one.apart[1] for one in quantities("3840 s = 64 min")]
    ['s', 'min']
    """
    if not symbols:
        text = re.sub(r"(?<= [A-Zac-df-z])-(?=[1-3](?:[)/]|$))", "^-", text.strip())  # m³ s-1
    return in_either(text, lambda line, commas: _Quantities(line, tuple(symbols), commas).sides())


class _Quantities(Reader):
    """Of one text, in which names may be units."""

    def sides(self):
        """What is on the sides of =, without names of quantities."""
        children = self.parsed().children
        within = children.pop() if children[-1].data == "within" else None
        if not any(_is_number(leaf) for leaf in leaves(children[-1])):
            raise NotRead("there is no number in it")
        said = [side for side in children[:-1] if not is_name(side) and any(map(_is_number, leaves(side)))]
        found = []
        for side in (*said, children[-1]):
            try:
                found += self._statements(side)
            except Unreadable as error:
                if side is children[-1] or isinstance(error, Doubtful):
                    raise
        if within is not None:  # 5.2 ± 0.1 bar
            self.units = {}
            factors = [factor for factor, _ in _factors(self.tree(*within.children))]
            deviation = math.prod(factor.value for factor in factors if isinstance(factor, ast.Constant))
            is_in_same_unit = {*self.units.values()} <= {*found[-1].units.values()} or not found[-1].units
            unit_of_both = [factor for factor in factors if not isinstance(factor, ast.Constant)]
            value = found[-1]
            if value.apart and is_in_same_unit and deviation > WIDEST * abs(value_of(value.apart[0])):
                raise Doubtful(f"± {deviation:g} leaves a wide range: write the number alone")
            if not value.units and unit_of_both:
                value = Quantity(_multiplied([(one, True) for one in (value.tree, *unit_of_both)]), self.units, True)
            found[-1] = value._replace(is_other=True)
        return found

    def _statements(self, side):
        """A side, and what a bracket behind its unit says once more: 120 s (2 min)."""
        again, last = [], last_row(side)
        if last and is_group(last.children[1:][-1:]):
            *_, before, group = last.children
            inside = list(leaves(group))
            names = [leaf for leaf in inside if leaf.type == "NAME"]
            if not inside or any(map(_is_number, inside)):
                is_quantity = names and _is_number(inside[0]) and all(map(self._unit, names))
                if len(last.children) > 2 and is_leaf(before, "NAME") and self._unit(before) and is_quantity:
                    again = last.children.pop().children
            elif (
                inside[0] not in _DOUBTING
                and not (is_leaf(before, "NAME") and self._function(before))
                and any(len(name) > 1 and not self._unit(name) for name in names)
            ):  # a remark
                last.children.pop()
                return [self._quantity(side, len(names) < len(inside))]
        return [self._quantity(one) for one in (side, *again)]

    def _quantity(self, side, is_other=False):
        self.units, self.is_other = {}, self.commas or is_other
        if len(side.children) == 2 and " and " in self.text:  # 1 min and 20 s
            one, other = map(self.tree, side.children)
            tree = ast.BinOp(one, ast.Add(), other)
        else:
            tree = self._pieces(side)
        return Quantity(tree, self.units, self.is_other)

    def _unit(self, token):
        """The unit that a name is; empty for another name."""
        name = UPRIGHT.sub(r"\1", token)
        name = "%" if name == "\\%" else re.sub(r"^\^ ?\{? ?\\circ ?\}? ?", "°", name)
        if self._spelled(token) in self.known | self.constants or _is_greek(name):
            return ""
        name = re.sub(r"^bar ?(?:\((?:g|a|abs)\)|[ag])$", "bar", name, flags=re.IGNORECASE)
        return units.spelled(name) if units.is_unit(name) else ""

    def _named(self, token, exponent, waiting):
        unit, (start, end) = self._unit(token), span(token)
        if unit and not (is_group(waiting[:1]) and "," in self.text[end:]):
            name = f"_u{len(self.units)}"
            self.units[name] = unit
            part = Part(ast.Name(name), "unit", start, end)
            return [self._raised(part, exponent)._replace(kind="unit")]
        if token.lower() in WORDS and exponent is None:
            self.is_other = True
            return [Part(ast.Constant(WORDS[token.lower()]), "number", start, end)]
        return super()._named(token, exponent, waiting)

    def _next(self, waiting):
        found = super()._next(waiting)
        is_unit = all(isinstance(one, ast.Name) and one.id in self.units for one, _ in _factors(found[0].tree))
        return [found[0]._replace(kind="unit")] if is_unit else found  # as [m/s]

    def _row(self, elements):
        """The factors; of 1 h 4 min, and of the mixed number 1 1/2, the sum."""
        starts = [
            k for k, one in enumerate(elements)
            if k and is_leaf(one, "NUMBER") and is_leaf(elements[k - 1], "NAME") and self._unit(elements[k - 1])
            and not (is_leaf(elements[-1], "NAME") and elements[-1] == elements[k - 1])
        ]  # fmt: skip
        if not starts:
            return super()._row(elements)
        self.is_other = True
        bounds = [0, *starts, len(elements)]
        rows = [super(_Quantities, self)._row(elements[one:other]) for one, other in itertools.pairwise(bounds)]
        tree = functools.reduce(lambda one, other: ast.BinOp(one, ast.Add(), other), map(product, rows))
        return [Part(tree, "group", rows[0][0].start, rows[-1][-1].end)]

    def _term(self, parsed):
        children = list(parsed.children)
        if children[0].data == "signed":  # -2 1/s
            tree = self._term(lark.Tree("term", [children[0].children[1], *children[1:]], parsed.meta))
            return tree if sign_of(children[0].children[0]) == "+" else negative(tree)
        k = 1
        while k < len(children) - 1:
            before, sign, after = children[k - 1 : k + 2]
            *others, whole, above = [None, None, *(before.children if before.data == "row" else ())]
            others = others[2:]
            are_numbers = is_leaf(whole, "NUMBER") and is_leaf(above, "NUMBER") and sign == "/" and after.data == "row"
            below = _first(after)
            if are_numbers and above == "1" and is_leaf(next(iter(leaves(after))), "NAME"):  # 20 1/min
                children[k - 1] = lark.Tree("row", [*others, whole], before.meta)
            elif (
                are_numbers and is_leaf(below, "NUMBER") and all(map(str.isdigit, (whole, above, below))) and int(below)
            ):
                self.is_other = True  # 1 1/2 min
                mixed = repr(int(whole) + int(above) / int(below))
                mixed = lark.Token.new_borrow_pos("NUMBER", mixed, whole)
                children[k - 1 : k + 2] = [lark.Tree("row", [*others, mixed, *after.children[1:]], before.meta)]
                continue
            elif sign == "/" and self._is_spaced(sign) and is_leaf(below, "NUMBER"):  # 14 L / 3.5 L/min
                ends = k + 2
                while ends < len(children) and children[ends] == "/" and not self._is_spaced(children[ends]):
                    ends += 2
                if ends > k + 2:
                    children[k + 1 : ends] = [lark.Tree("term", children[k + 1 : ends], after.meta)]
            k += 2
        if len(children) == 1:
            return self.tree(children[0])
        return super()._term(lark.Tree("term", children, parsed.meta))

    def _is_spaced(self, sign):
        return self.text[sign.start_pos - 1] == " " and self.text[sign.end_pos : sign.end_pos + 1] == " "

    def _below(self, factors, is_number, above):
        """Behind a fraction bar a number takes its unit along where above it there is one: 15 K/11 %, but 3/4 min."""
        below, *others = factors
        if others and others[0].kind == "unit" and below.kind != "unit":
            if not any(isinstance(node, ast.Name) and node.id not in self.constants for node in ast.walk(above)):
                return factors
            while others and others[0].kind == "unit":
                below = joined(below, others.pop(0))
            return super()._below([below._replace(kind="group"), *others], is_number, above)
        return super()._below(factors, is_number, above)


def _is_number(leaf):
    """Whether this is a number, or a name that is one."""
    return leaf.type == "NUMBER" or leaf.lower() in WORDS or bool(re.fullmatch(r"pi|π|\\pi|[eij]|[ij]\d+", leaf))


def _first(parsed):
    """The first element of a row; None of anything else."""
    return parsed.children[0] if parsed.data == "row" else None


def _is_greek(name):
    """Whether this is the name of a letter; Pint takes some for prefixes."""
    try:
        return bool(unicodedata.lookup(f"GREEK SMALL LETTER {name.upper()}"))
    except KeyError:
        return False


class _Ones(ast.NodeTransformer):
    """Names of units are ones."""

    def visit_BinOp(self, node):
        node = self.generic_visit(node)
        if isinstance(node.op, ast.Mult | ast.Div) and _is_one(node.right):
            return node.left
        return node.right if isinstance(node.op, ast.Mult) and _is_one(node.left) else node

    def visit_Name(self, node):
        return ast.Constant(1) if node.id.startswith("_u") else node


def _is_one(node):
    match node:
        case ast.Constant(1):
            return True
        case ast.BinOp(base, ast.Pow(), _):
            return _is_one(base)
    return False


def _factors(tree, is_above=True):
    """The factors of a product, and whether each is above the bar."""
    match tree:
        case ast.BinOp(left, ast.Mult(), right):
            yield from _factors(left, is_above)
            yield from _factors(right, is_above)
        case ast.BinOp(left, ast.Div(), right):
            yield from _factors(left, is_above)
            yield from _factors(right, not is_above)
        case ast.UnaryOp(ast.USub(), operand):
            first, *others = _factors(operand, is_above)
            yield ast.UnaryOp(ast.USub(), first[0]), first[1]
            yield from others
        case _:
            yield tree, is_above


def _multiplied(factors):
    """The product of factors, above or below the bar."""
    tree = None
    for factor, is_above in factors:
        if tree is None:
            tree = factor if is_above else ast.BinOp(ast.Constant(1), ast.Div(), factor)
        else:
            tree = ast.BinOp(tree, ast.Mult() if is_above else ast.Div(), factor)
    return ast.Constant(1) if tree is None else tree
