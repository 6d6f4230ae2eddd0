"""Rules for the notebooks that check a ledger, as they are stored: no number of the book is typed.

A rule takes a stored notebook and the books, and returns its complaints, a sentence for each. Whether what a notebook
hands over is computed, no rule knows: `mutation` runs it again.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from fractions import Fraction
from itertools import chain
from pathlib import PurePath

from bookledger.books import Books, printed_numbers
from bookledger.stored import Stored, checks, code, sections, tree, walk
from plainmath.tables import is_symbol

#: Functions that make a number of a literal.
MAKERS = {"S", "sympify", "Rational", "Integer", "Float", "Fraction", "Decimal", "int", "float", "abs", "round"}


# Checks.


def checks_are_of_the_ledger(stored: Stored, books: Books) -> list[str]:
    """A stored check is of an entry that belongs to the notebook, has the results of the ledger, and holds."""
    found = []
    for check in checks(stored.notebook):
        place = f"the check of {check['source']}, {check['entry']}"
        entry = books.written.get(check["source"], {}).get(check["entry"])
        if entry is None:
            found.append(f"{place}: the ledger has no such entry")
            continue
        if entry["chapter"] != stored.path.stem:
            found.append(f"{place}: it belongs to {entry['chapter']}")
        results = [(row["name"], *_shown(row), row.get("status", "computed")) for row in entry.get("result", [])]
        keys = ("name", "title", "book", "status")
        if [tuple(verdict.get(key) for key in keys) for verdict in check["verdicts"]] != results:
            found.append(f"{place}: not the results of the ledger as it is now: run the notebook again")
        found += [f"{place}: {row['name']} does not hold" for row in check["verdicts"] if row["holds"] is not True]
    return found


def _shown(row):
    """What a check shows of a result: what it is called, and what the book prints."""
    if "claim" in row:
        return " ".join(row["claim"].split()), "says so" if row.get("says", "true") == "true" else "denies it"
    title = row.get("label") or (row["name"] if is_symbol(row["name"]) else row["name"].replace("_", " "))
    return title, " ".join(f"{row['printed']} {row.get('unit', '')}".split())


def nothing_is_handed_back(stored: Stored, books: Books) -> list[str]:
    """No argument of `.check(...)` is a literal or a given, or a name for nothing but these."""
    cells = [(label, walk(tree(cell))) for label, cell in code(stored.notebook)]
    nodes = [node for _, nodes in cells for node in nodes]
    idle = {
        part
        for node in nodes
        if isinstance(node, ast.Assign) and _is_idle(node.value)
        for part in chain.from_iterable(map(walk, node.targets))
    }
    bound = [node for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
    names = {node.id for node in bound if node in idle} - {node.id for node in bound if node not in idle}
    found = []
    for label, node in ((label, node) for label, nodes in cells for node in nodes):
        match node:  # an answer to an exercise("1.1") is compared with a key, and nothing with a book
            case ast.Call(func=ast.Attribute(attr="check", value=ast.Name() | ast.Subscript()), keywords=keywords):
                for value in (keyword.value for keyword in keywords):
                    for part in value.values if isinstance(value, ast.Dict) else [value]:
                        if _is_idle(part) or getattr(part, "id", "") in names:
                            found.append(f"{label}: {ast.unparse(part)} in a check is not computed")
    return found


def _is_idle(node):
    """Whether it is a literal, several of them, or what an entry gives."""
    match node:
        case ast.Tuple(parts) | ast.List(parts):
            return all(map(_is_idle, parts))
        case ast.Call(func=ast.Attribute(attr="given")):
            return True
    return _number(node) is not None or isinstance(node, ast.Constant)


# Numbers.


def no_number_of_the_book(stored: Stored, books: Books) -> list[str]:
    """In a section, no literal is a given or a result of the ledger's entries that the section uses."""
    sources = dict(_sources(stored, books))
    found = []
    for section in sections(stored.notebook):
        book: dict[Fraction, str] = {}
        for node in (n for _, cell in section for n in walk(tree(cell))):
            match node:
                case ast.Subscript(value=ast.Name(name), slice=ast.Constant(str(entry))) if name in sources:
                    printed = printed_numbers(books.written[sources[name]].get(entry, {}))
                    book |= dict.fromkeys(printed, f"{name} {entry}")
        for label, cell in section:
            for value in _literals(tree(cell)):
                if abs(value) in book:
                    found.append(f"{label}: {float(value):g} stands in {book[abs(value)]}: take it from the ledger")
    return found


def _sources(stored, books):
    """The names under which a notebook has sources of the ledger: imported, or opened by the name of the file."""
    for node in (node for _, cell in code(stored.notebook) for node in walk(tree(cell))):
        match node:
            case ast.ImportFrom(names=imported):
                yield from ((one.asname or one.name, one.name) for one in imported if one.name in books.written)
            case ast.Assign(targets=[ast.Name(name)], value=ast.Call(args=[ast.Constant(str(path))])):
                if (stem := PurePath(path).stem) in books.written:
                    yield name, stem


def _literals(node):
    """The numbers written in a piece of code, except where they are form and not data."""
    value = _number(node)
    if value is not None:
        yield value
        return
    for child in ast.iter_child_nodes(node):
        if child not in _form(node):
            yield from _literals(child)


def _form(node):
    """The numbers in `node` that are its form: an exponent, an index, the order of a derivative."""
    match node:
        case ast.BinOp(op=ast.Pow(), right=part) | ast.Subscript(slice=part):
            parts = [part]
        case ast.Call(func=ast.Name("diff" | "Derivative") | ast.Attribute(attr="diff"), args=parts):
            pass
        case _:
            parts = []
    return [part for part in parts if _number(part) is not None]


def _number(node):
    """The value of a literal number, also as `-2`, `1/2`, `S("0.5")` or `Rational(1, 2)`."""
    match node:
        case ast.Constant(bool()):
            return None
        case ast.Constant(int() | float() as value):
            return Fraction(str(value))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return None if (value := _number(operand)) is None else -value
        case ast.BinOp(left=over, op=ast.Div(), right=under):
            return _quotient([_number(over), _number(under)])
        case ast.Call(func=ast.Name(name), args=[ast.Constant(str(text))]) if name in MAKERS:
            try:
                return Fraction(text)
            except ValueError:
                return None
        case ast.Call(func=ast.Name(name), args=[_, *_] as arguments) if name in MAKERS:
            return _quotient([_number(argument) for argument in arguments])
    return None


def _quotient(parts):
    if None in parts or 0 in parts[1:]:
        return None
    return parts[0] / parts[1] if len(parts) == 2 else parts[0]


#: What a stored notebook must obey.
RULES: tuple[Callable[[Stored, Books], list[str]], ...] = (
    checks_are_of_the_ledger,
    nothing_is_handed_back,
    no_number_of_the_book,
)
