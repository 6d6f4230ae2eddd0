"""Rules for the notebooks that check a ledger: no number of the book is typed, and no check can only succeed.

A rule takes a stored notebook and the books, and returns its complaints, a sentence for each.
"""

from __future__ import annotations

import ast
import builtins
import copy
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import PurePath

from bookledger.books import Books, printed_numbers
from bookledger.stored import Stored, checks, code, names, parsed, sections, tree, walk
from plainmath.tables import is_symbol

#: Functions that make a number of a literal, and names of constants: what consists of these alone is not computed.
MAKERS = {"S", "sympify", "Rational", "Integer", "Float", "Fraction", "Decimal", "int", "float", "abs", "round"}
CONSTANTS = MAKERS | {*vars(builtins)} | {"sympy", "sp", "np", "numpy", "math", "oo", "inf", "nan", "pi", "E", "I"}
#: What holds of any values, once they are in order.
OF_ORDER = {"greater", "less", "at_least", "at_most", "positive", "negative", "increasing", "decreasing"}
#: The tag of a cell whose outputs nbval does not compare, as of one with sliders.
NOT_COMPARED = "nbval-ignore-output"


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


def checks_are_computed(stored: Stored, books: Books) -> list[str]:
    """No argument of `.check(...)` is a literal, a name for a literal, or the printed value handed back."""
    cells = [(label, tree(cell)) for label, cell in code(stored.notebook)]
    modules = [module for _, module in cells]
    literal, imported = CONSTANTS | _names_of_literals(modules), _imported(modules, books)
    # a claim may be about printed values
    compared = {module: _evidence_in(module, imported, books) for module in modules}
    printed = _names_of_printed_values(compared)
    hidden = [label for label, cell in code(stored.notebook) if parsed(cell.source) is None and ".check" in cell.source]
    found = [f"{label}: a check in what is not plain Python" for label in hidden]
    for label, module in cells:
        calls = [n for n in walk(module) if isinstance(n, ast.Call) and getattr(n.func, "attr", "") == "check"]
        uses = [n for n in walk(module) if isinstance(n, ast.Attribute) and n.attr == "check"]
        if len(uses) > len(calls):
            found.append(f"{label}: a check under another name")
        of_ledger = [call for call in calls if not _answers_an_exercise(call)]
        for argument in (a for call in of_ledger for a in [*call.args, *(keyword.value for keyword in call.keywords)]):
            if names(argument) <= literal:
                found.append(f"{label}: {ast.unparse(argument)} in a check is not computed")
            if names(argument) & {"printed", "correct", "computed"} or names(argument, compared[module]) & printed:
                found.append(f"{label}: {ast.unparse(argument)} checks the ledger against itself")
    return found


def _names_of_printed_values(compared):
    """The method `printed_value`, and the names that are bound to what it returns, or to an expression with it."""
    found = {"printed_value"}
    for module, calls in compared.items():
        for node in walk(module):
            if isinstance(node, ast.Assign) and names(node.value, calls) & found:
                found |= {name for target in node.targets for name in names(target)}
    return found


def _answers_an_exercise(call):
    """Whether it is `exercise(...).check(...)`, which compares an answer with a key and nothing with a book."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name("exercise"))):
            return True
    return False


def _names_of_literals(modules):
    """The names that are bound to nothing but literals, directly or through other such names."""
    bindings: list[tuple[set[str], set[str]]] = []  # what is bound, and what it is made of
    for node in (n for module in modules for n in walk(module)):
        match node:
            case ast.Assign(targets=targets, value=value):
                bindings += [(names(target), names(value)) for target in targets]
            case ast.AnnAssign(target=target, value=ast.expr() as value) | ast.NamedExpr(target=target, value=value):
                bindings.append((names(target), names(value)))
            case ast.AugAssign(target=target, value=value):
                bindings.append((names(target), names(target) | names(value)))
            case ast.For(target=target, iter=value) | ast.comprehension(target=target, iter=value):
                bindings.append((names(target), names(value)))
    found = {name for bound, _ in bindings for name in bound}
    while rest := {name for bound, made_of in bindings if not made_of <= found | CONSTANTS for name in bound} & found:
        found -= rest
    return found


# Evidence.


def evidence_can_fail(stored: Stored, books: Books) -> list[str]:
    """No evidence is of literals, of a thing beside itself, or of what a condition or a sort has put in order."""
    cells = [(label, tree(cell)) for label, cell in code(stored.notebook)]
    modules = [module for _, module in cells]
    literal, same, imported = CONSTANTS | _names_of_literals(modules), _other_names(modules), _imported(modules, books)
    found = []
    for label, module in cells:
        calls = _evidence_in(module, imported, books)
        for node in walk(module):
            match node:
                case ast.ImportFrom() | ast.Import():
                    found += [f"{label}: {why}" for why in _hidden_evidence(node, books)]
                case ast.IfExp(body=one, orelse=other) if all(
                    _evidence_in(part, imported, books) for part in (one, other)
                ):
                    found.append(f"{label}: {ast.unparse(node)} chooses among evidence")
                case ast.Attribute(attr="turned"):
                    found.append(f"{label}: {ast.unparse(node)} turns evidence around")
        found += [f"{label}: {ast.unparse(call)} {why}" for call in calls for why in _idle(call, books, literal, same)]
    return found


def _hidden_evidence(node, books):
    """What a statement imports of evidence so that no rule would know it by its name."""
    module = getattr(node, "module", "") or ""
    for alias in node.names:
        *_, last = alias.name.split(".")
        if "evidence" in module.split("."):
            hidden = alias.asname or module != books.evidence or alias.name not in books.offered
        else:
            hidden = "evidence" in alias.name.split(".") and (alias.asname or last != "evidence")
        if hidden:
            yield f"{ast.unparse(alias)} is evidence under another name, or its making"


def _idle(call, books, literal, same):
    """Why a call of evidence cannot fail."""
    starred = [side.value for side in call.args if isinstance(side, ast.Starred)]
    named = [keyword.value for keyword in call.keywords if keyword.arg not in ("quantity", None)]
    sides = starred or [*call.args[: books.sides[_called(call)]], *named]
    written = [ast.unparse(_Renamed(same).visit(copy.deepcopy(side))) for side in sides]
    if sides and all(names(side) <= literal for side in sides):
        yield "is evidence of literals"
    if _called(call) in OF_ORDER:  # the largest of several is never smaller than the smallest
        written = [re.sub(r"^(max|min)\b", "", text) for text in written]
    if len(sides) > 1 and len(set(written)) == 1:
        yield "compares a thing with itself"
    done = {_called(side) for side in sides if isinstance(side, ast.Call)}
    if _called(call) in OF_ORDER and done & {"sorted", "abs", "Abs"}:
        yield "has been put in order, or made positive, before it is compared"


def _called(call):
    """The last name of what is called."""
    return getattr(call.func, "id", getattr(call.func, "attr", ""))


def _imported(modules, books):
    """The names that a notebook imports from the module of evidence."""
    return {
        alias.name
        for node in (node for module in modules for node in walk(module))
        if isinstance(node, ast.ImportFrom) and node.module == books.evidence
        for alias in node.names
    }


def _evidence_in(part, imported, books):
    """The calls of evidence in a piece of code, by the names that the notebook imports."""
    return [
        call
        for call in walk(part)
        if isinstance(call, ast.Call) and _called(call) in books.sides
        if _called(call) in imported or (isinstance(call.func, ast.Attribute) and "evidence" in names(call.func.value))
    ]


def _other_names(modules):
    """Names that are bound once, and to nothing but another name."""
    bound: dict[str, list[str]] = {}
    for node in (n for module in modules for n in walk(module)):
        match node:
            case ast.Assign(targets=[ast.Name(name)], value=ast.Name(other)):
                bound.setdefault(name, []).append(other)
            case ast.Name(id=name, ctx=ast.Store()):
                bound.setdefault(name, []).append("")
    return {
        name: others[0] for name, others in bound.items() if len([o for o in others if o]) == 1 and len(others) == 2
    }


class _Renamed(ast.NodeTransformer):
    """Writes the first name of everything."""

    def __init__(self, same):
        self.same = same

    def visit_Name(self, node):
        return ast.Name(self.same.get(node.id, node.id), node.ctx)


def no_truth_value_becomes_a_word(stored: Stored, books: Books) -> list[str]:
    """No cell whose outputs are compared chooses a text by a condition: evidence decides what a book says in words."""
    found: list[str] = []
    for label, cell in code(stored.notebook):
        if NOT_COMPARED in cell.metadata.get("tags", []):
            continue
        for node in walk(tree(cell)):
            match node:
                case ast.IfExp(body=one, orelse=other) if _is_text(one) and _is_text(other):
                    found.append(f"{label}: {ast.unparse(node)} turns a truth value into a word")
                case ast.Dict(keys=[ast.Constant(bool()), *_], values=values) if all(map(_is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} has words for truth values")
                case ast.Subscript(value=ast.Dict(values=values)) if all(map(_is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
                case ast.BoolOp(values=values) if any(map(_is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
                case ast.If(body=[ast.Assign(value=one)], orelse=[ast.Assign(value=other)]) if _is_text(
                    one
                ) and _is_text(other):
                    found.append(f"{label}: {ast.unparse(node.test)} chooses a word")
                case ast.Subscript(value=ast.Tuple(parts) | ast.List(parts), slice=index) if all(
                    map(_is_text, parts)
                ) and not isinstance(index, ast.Constant | ast.UnaryOp | ast.Slice):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
    return found


def _is_text(node):
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


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
    checks_are_computed,
    evidence_can_fail,
    no_truth_value_becomes_a_word,
    no_number_of_the_book,
)
