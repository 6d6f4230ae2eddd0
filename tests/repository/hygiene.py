"""The rules for stored notebooks, one function each: it takes a stored notebook and returns its complaints."""

import ast
import builtins
import copy
import inspect
import re
import statistics
import symtable
import tomllib
from collections.abc import Collection, Iterator
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import NamedTuple

import nbformat
from nbformat import NotebookNode

from loopbook import evidence, notebooks, working_copy

ROOT = Path(__file__).parents[2]
LEDGER = ROOT / "lib" / "loopbook-books" / "loopbook" / "ledger"

#: The chapters that the README lists.
NAMES = {*re.findall(r"\]\(chapters/(\w+)\.ipynb\) \|", (ROOT / "README.md").read_text(encoding="utf-8"))}
#: The page that leads to them.
START = Path(working_copy.START).stem
MOST_LINES = 12
MOST_IMPORTS = 13
MOST_COLUMNS = 88  # what a notebook shows beside a file list without scrolling
MOST_BYTES = 900_000
MOST_IN_CORE = 60
MOST_IN_MEDIAN = 4  # an answer with its names and units takes a line or two

# Functions that make a number of a literal, and names of constants: what consists of these alone is not computed.
MAKERS = {"S", "sympify", "Rational", "Integer", "Float", "Fraction", "Decimal", "int", "float", "abs", "round"}
CONSTANTS = MAKERS | {*vars(builtins)} | {"sympy", "sp", "np", "numpy", "math", "oo", "inf", "nan", "pi", "E", "I"}


class Stored(NamedTuple):
    """A notebook as it lies in its folder."""

    path: Path
    text: str
    notebook: NotebookNode

    @classmethod
    def at(cls, path: Path) -> "Stored":
        text = path.read_bytes().decode()
        return cls(path, text, nbformat.reads(text, as_version=nbformat.NO_CONVERT))


# What it takes to look into a notebook.


def code(notebook: NotebookNode) -> list[tuple[str, NotebookNode]]:
    """The code cells, each with its label."""
    return [(label, cell) for label, cell in notebooks.labelled(notebook) if cell.cell_type == "code"]


def sections(notebook: NotebookNode) -> list[list[tuple[str, NotebookNode]]]:
    """The code cells between one heading of level 2 and the next."""
    found: list[list[tuple[str, NotebookNode]]] = [[]]
    for label, cell in notebooks.labelled(notebook):
        if cell.cell_type == "code":
            found[-1].append((label, cell))
        elif re.search(r"^## ", cell.source, re.MULTILINE):
            found.append([])
    return found


def tree(cell: NotebookNode) -> ast.Module:
    """The syntax tree of a cell, empty where it is no Python (`plain_python` complains about that)."""
    return parsed(cell.source) or ast.Module([], [])


def is_python(cell: NotebookNode) -> bool:
    return parsed(cell.source) is not None


@cache
def parsed(source: str) -> ast.Module | None:
    try:
        return ast.parse(source)
    except SyntaxError:
        return None


@cache
def walk(module: ast.Module) -> list[ast.AST]:
    """Every node of a cell, of which each rule asks something."""
    return [*ast.walk(module)]


def names(node: ast.AST, without: Collection[ast.AST] = ()) -> set[str]:
    """The names and attributes used in an expression, but for some of its parts."""
    if node in without:
        return set()
    own = {getattr(node, "id", getattr(node, "attr", ""))} if isinstance(node, ast.Name | ast.Attribute) else set()
    return own.union(*(names(part, without) for part in ast.iter_child_nodes(node)))


# The file.


def named_as_designed(stored: Stored) -> list[str]:
    return (
        []
        if stored.path.stem in {START, *NAMES}
        else [f"{stored.path.name} has no row in the README's table of chapters"]
    )


def valid(stored: Stored) -> list[str]:
    if (version := (stored.notebook.nbformat, stored.notebook.nbformat_minor)) != (4, 5):
        return [f"format {version[0]}.{version[1]} instead of 4.5"]
    try:
        nbformat.validate(stored.notebook)
    except nbformat.ValidationError as error:
        return [f"not a valid notebook: {error.message}"]
    return []


def in_normal_form(stored: Stored) -> list[str]:
    if stored.text != notebooks.as_text(notebooks.normalised(stored.notebook)):
        return ["not as `python -m loopbook execute` stores it: run `make execute`"]
    return []


def light(stored: Stored) -> list[str]:
    size = len(stored.text.encode())
    return [f"{size} bytes are more than {MOST_BYTES}"] if size > MOST_BYTES else []


# The outputs.


def fit_to_store(stored: Stored) -> list[str]:
    return notebooks.unfit(stored.notebook)


# The code.


def plain_python(stored: Stored) -> list[str]:
    return [f"{label}: not plain Python" for label, cell in code(stored.notebook) if not is_python(cell)]


def without_tricks(stored: Stored) -> list[str]:
    found = []
    for label, cell in code(stored.notebook):
        for node in walk(tree(cell)):
            match node:
                case ast.Attribute(value=ast.Name("sys"), attr="path"):
                    found.append(f"{label}: sys.path")
                case ast.Try() if any(isinstance(n, ast.Import | ast.ImportFrom) for n in ast.walk(node)):
                    found.append(f"{label}: try around an import")
                case ast.ExceptHandler(type=None | ast.Name("Exception" | "BaseException")):
                    found.append(f"{label}: an except that hides every error")
                case ast.Assert(test=ast.Constant()):
                    found.append(f"{label}: an assert that cannot fail")
    return found


def one_import_cell(stored: Stored) -> list[str]:
    first, *others = [(label, tree(cell)) for label, cell in code(stored.notebook)] or [("", ast.Module([], []))]
    found = [
        f"{first[0]}: {ast.unparse(statement)[:40]!r} among the imports"
        for statement in first[1].body
        if not isinstance(statement, ast.Import | ast.ImportFrom)
    ]
    for label, module in others:
        if any(isinstance(node, ast.Import | ast.ImportFrom) for node in walk(module)):
            found.append(f"{label}: an import outside the first cell")
    return found


def is_folded(cell: NotebookNode) -> bool:
    """Whether the code of a cell is folded, so that no reader has to pass it."""
    return notebooks.FOLDED in cell.metadata.get("tags", [])


def short_cells(stored: Stored) -> list[str]:
    found = [
        f"{label}: a line of {len(line)} columns is wider than {MOST_COLUMNS}"
        for label, cell in code(stored.notebook)
        for line in cell.source.splitlines()
        if len(line) > MOST_COLUMNS
    ]
    lengths = {label: len(cell.source.strip().splitlines()) for label, cell in code(stored.notebook)}
    most = dict.fromkeys(lengths, MOST_LINES) | {label: MOST_IMPORTS for label in [*lengths][:1]}
    found += [f"{label}: {n} lines are more than {most[label]}" for label, n in lengths.items() if n > most[label]]
    seen = [n for (label, cell), n in zip(code(stored.notebook), lengths.values(), strict=True) if not is_folded(cell)]
    if seen and statistics.median(seen) > MOST_IN_MEDIAN:
        found.append(f"the median cell has {statistics.median(seen)} lines, more than {MOST_IN_MEDIAN}")
    return found


# The sliders.


def only_sliders_escape_comparison(stored: Stored) -> list[str]:
    found = []
    for label, cell in code(stored.notebook):
        escapes = {tag for tag in cell.metadata.get("tags", []) if tag != notebooks.FOLDED}
        if escapes != ({notebooks.SLIDERS} if notebooks.has_sliders(cell.source) else set()):
            found.append(f"{label}: tags {sorted(escapes)}, but only sliders escape comparison")
        if re.search(r"NBVAL|PYTEST_VALIDATE", cell.source):
            found.append(f"{label}: a comment that hides a cell from comparison")
    return found


def sliders_follow_a_figure(stored: Stored) -> list[str]:
    found = []
    for section in sections(stored.notebook):
        shown = False
        for label, cell in section:
            shown = shown or any(mime.startswith("image/") for o in cell.outputs for mime in o.get("data", {}))
            if notebooks.has_sliders(cell.source) and not shown:
                found.append(f"{label}: a slider without a figure, its own or one before it in its section")
    return found


def sliders_keep_what_they_use(stored: Stored) -> list[str]:
    """What a slider's function uses is not bound to something else in a later cell: it is called when all have run."""
    cells = [(label, cell) for label, cell in code(stored.notebook) if is_python(cell)]
    found, functions = [], {}
    for n, (label, cell) in enumerate(cells):
        table = symtable.symtable(cell.source, label, "exec")
        functions |= {child.get_name(): globals_of(child) for child in table.get_children()}
        if not notebooks.has_sliders(cell.source):
            continue
        used = set().union(*map(globals_of, table.get_children()))
        while more := set().union(*(functions[name] for name in used & set(functions))) - used:
            used |= more
        for later, other in cells[n + 1 :]:
            for name in sorted(used & notebooks.bound_in(other.source)):
                found.append(f"{label}: the slider uses {name}, which {later} binds again")
    return found


def globals_of(function: symtable.SymbolTable) -> set[str]:
    """The names from outside that a function uses, itself or in a function or comprehension within it."""
    own = {symbol.get_name() for symbol in function.get_symbols() if symbol.is_global()}
    return own.union(*map(globals_of, function.get_children()))


# What a reader meets.


def is_chapter(stored: Stored) -> bool:
    """Whether it is a chapter, and not a solution or the start page."""
    return stored.path.parent.name == "chapters" and stored.path.stem in NAMES


def sections_begin_a_cell(stored: Stored) -> list[str]:
    """A heading of level 2 begins its cell: what JupyterLab folds under it is a section."""
    return [
        f"{label}: a section within the cell: begin a cell with its heading"
        for label, cell in notebooks.labelled(stored.notebook)
        if cell.cell_type == "markdown" and "\n## " in cell.source
    ]


def answers_are_labelled(stored: Stored) -> list[str]:
    """In a chapter, no cell ends in a literal: a number has its name and unit, and several of them are a table.

    Solutions end in answers as a student gives them.
    """
    if not is_chapter(stored):
        return []
    return [
        f"{label}: answers {''.join(output.data['text/plain'])[:40]!r}, which nothing names: show quantities or a table"
        for label, cell in code(stored.notebook)
        for output in cell.outputs
        if output.output_type == "execute_result"
        and "text/html" not in output.data
        and is_bare(output.data["text/plain"])
    ]


def is_bare(text: str) -> bool:
    """Whether what a cell shows is a number, a text, a truth value, or several of them, and nothing with a name."""
    node = parsed(text)
    values = (ast.Constant, ast.Tuple, ast.List, ast.Dict, ast.Set, ast.UnaryOp, ast.BinOp, ast.Call, ast.Name)
    form = (ast.Module, ast.Expr, ast.operator, ast.unaryop, ast.Load)
    return node is not None and all(
        isinstance(part, values + form) and (not isinstance(part, ast.Name) or part.id in IN_NUMBERS)
        for part in ast.walk(node)
    )


#: Names that stand in what SymPy and NumPy print of numbers.
IN_NUMBERS = {"pi", "E", "I", "oo", "inf", "nan", "sqrt", "exp", "log", "atan", "acos", "array", "Matrix"}


def core_is_short(stored: Stored) -> list[str]:
    """The core of a chapter, all but what is marked as further reading, is a first reading of 45 minutes."""
    if not is_chapter(stored):
        return []
    inside, count = True, 0
    for cell in stored.notebook.cells:
        if re.match(r"## ", cell.source) and cell.cell_type == "markdown":
            inside = not notebooks.FURTHER.search(cell.source)
        count += inside and cell.cell_type == "code"
    return [f"{count} code cells in its core are more than {MOST_IN_CORE}"] if count > MOST_IN_CORE else []


def opens_and_closes(stored: Stored) -> list[str]:
    """A chapter opens with something that moves, before its first section, and says what the reader can do now."""
    if not is_chapter(stored):
        return []
    first = next((n for n, cell in enumerate(stored.notebook.cells) if cell.source.startswith("## ")), 0)
    live = [c for c in stored.notebook.cells[:first] if c.cell_type == "code" and notebooks.has_sliders(c.source)]
    found = [] if live else ["no slider before the first section"]
    if not any(cell.source.startswith("## What you can do now") for cell in stored.notebook.cells):
        found.append("no section 'What you can do now'")
    return found


# The numbers.


def checks_are_computed(stored: Stored) -> list[str]:
    """No argument of `.check(...)` is a literal, a name for a literal, or the printed value handed back."""
    cells = [(label, tree(cell)) for label, cell in code(stored.notebook)]
    modules = [module for _, module in cells]
    literal, printed = CONSTANTS | names_of_literals(modules), names_of_printed_values(modules)
    imported = imported_evidence(modules)
    found = []
    for label, module in cells:
        compared = evidence_in(module, imported)  # a claim may be about printed values
        calls = [n for n in walk(module) if isinstance(n, ast.Call) and getattr(n.func, "attr", "") == "check"]
        uses = [n for n in walk(module) if isinstance(n, ast.Attribute) and n.attr == "check"]
        if len(uses) > len(calls):
            found.append(f"{label}: a check under another name")
        of_ledger = [call for call in calls if not answers_an_exercise(call)]
        for argument in (a for call in of_ledger for a in [*call.args, *(keyword.value for keyword in call.keywords)]):
            if names(argument) <= literal:
                found.append(f"{label}: {ast.unparse(argument)} in a check is not computed")
            if names(argument) & {"printed", "correct", "computed"} or names(argument, compared) & printed:
                found.append(f"{label}: {ast.unparse(argument)} checks the ledger against itself")
    return found


def names_of_printed_values(modules: list[ast.Module]) -> set[str]:
    """The method `printed_value`, and the names that are bound to what it returns, or to an expression with it."""
    found, imported = {"printed_value"}, imported_evidence(modules)
    for module in modules:
        compared = evidence_in(module, imported)
        for node in walk(module):
            if isinstance(node, ast.Assign) and names(node.value, compared) & {"printed_value"}:
                found |= {name for target in node.targets for name in names(target)}
    return found


def answers_an_exercise(call: ast.Call) -> bool:
    """Whether it is `exercise(...).check(...)`: solutions are run with other numbers, which proves more than a look."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name("exercise"))):
            return True
    return False


def names_of_literals(modules: list[ast.Module]) -> set[str]:
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


def evidence_can_fail(stored: Stored) -> list[str]:
    """No evidence is of literals, of a thing beside itself, or of what a condition or a sort has put in order."""
    cells = [(label, tree(cell)) for label, cell in code(stored.notebook)]
    modules = [module for _, module in cells]
    literal, same = CONSTANTS | names_of_literals(modules), other_names(modules)
    offered = imported_evidence(modules)
    found = []
    for label, module in cells:
        for node in walk(module):
            match node:
                case ast.ImportFrom(module="loopbook.evidence", names=imported):
                    for alias in imported:
                        if alias.asname or alias.name not in OFFERED:
                            found.append(f"{label}: {ast.unparse(alias)} is evidence under another name, or its making")
                case ast.IfExp(body=one, orelse=other) if all(evidence_in(choice, offered) for choice in (one, other)):
                    found.append(f"{label}: {ast.unparse(node)} chooses among evidence")
                case ast.Attribute(attr="turned"):
                    found.append(f"{label}: {ast.unparse(node)} turns evidence around")
    for label, call in ((label, call) for label, module in cells for call in evidence_in(module, offered)):
        of = f"{label}: {ast.unparse(call)}"
        starred = [side.value for side in call.args if isinstance(side, ast.Starred)]
        named = [keyword.value for keyword in call.keywords if keyword.arg not in ("quantity", None)]
        sides = starred or [*call.args[: SIDES[called(call)]], *named]
        written = [ast.unparse(Renamed(same).visit(copy.deepcopy(side))) for side in sides]
        if sides and all(names(side) <= literal for side in sides):
            found.append(f"{of} is evidence of literals")
        if called(call) in OF_ORDER:  # the largest of several is never smaller than the smallest
            written = [re.sub(r"^(max|min)\b", "", text) for text in written]
        if len(sides) > 1 and len(set(written)) == 1:
            found.append(f"{of} compares a thing with itself")
        done = {called(side) for side in sides if isinstance(side, ast.Call)}
        if called(call) in OF_ORDER and done & {"sorted", "abs", "Abs"}:
            found.append(f"{of} has been put in order, or made positive, before it is compared")
    return found


#: What holds of any values, once they are in order.
OF_ORDER = {"greater", "less", "at_least", "at_most", "positive", "negative", "increasing", "decreasing"}
#: What evidence is made with.
OFFERED = {name for name in evidence.__all__ if name[0].islower()}
#: How many of the arguments of evidence are values.
SIDES = {
    name: 2 if len(inspect.signature(getattr(evidence, name)).parameters) > 2 else 1
    for name in evidence.__all__
    if name[0].islower() and name not in ("every", "some", "refused")
}  # fmt: skip


def called(call: ast.Call) -> str:
    """The last name of what is called."""
    return getattr(call.func, "id", getattr(call.func, "attr", ""))


def imported_evidence(modules: list[ast.Module]) -> set[str]:
    """The names that a notebook imports from `loopbook.evidence`."""
    return {
        alias.name
        for node in (n for module in modules for n in walk(module))
        if isinstance(node, ast.ImportFrom) and node.module == "loopbook.evidence"
        for alias in node.names
    }


def evidence_in(module: ast.AST, imported: Collection[str]) -> list[ast.Call]:
    """The calls of evidence in a piece of code, by the names that the notebook imports."""
    calls = [node for node in walk(module) if isinstance(node, ast.Call) and called(node) in SIDES]
    return [
        call
        for call in calls
        if called(call) in imported or (isinstance(call.func, ast.Attribute) and "evidence" in names(call.func.value))
    ]


def other_names(modules: list[ast.Module]) -> dict[str, str]:
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


class Renamed(ast.NodeTransformer):
    """Writes the first name of everything."""

    def __init__(self, same: dict[str, str]):
        self.same = same

    def visit_Name(self, node: ast.Name) -> ast.Name:
        return ast.Name(self.same.get(node.id, node.id), node.ctx)


def no_truth_value_becomes_a_word(stored: Stored) -> list[str]:
    """In a chapter, no cell but a slider chooses a text by a condition: evidence decides what a book says in words.

    Solutions answer exercises, some of which ask for a word.
    """
    found: list[str] = []
    if stored.path.parent.name != "chapters":
        return found
    for label, cell in code(stored.notebook):
        if notebooks.SLIDERS in cell.metadata.get("tags", []):
            continue
        for node in walk(tree(cell)):
            match node:
                case ast.IfExp(body=one, orelse=other) if is_text(one) and is_text(other):
                    found.append(f"{label}: {ast.unparse(node)} turns a truth value into a word")
                case ast.Dict(keys=[ast.Constant(bool()), *_], values=values) if all(map(is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} has words for truth values")
                case ast.Subscript(value=ast.Dict(values=values)) if all(map(is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
                case ast.BoolOp(values=values) if any(map(is_text, values)):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
                case ast.If(body=[ast.Assign(value=one)], orelse=[ast.Assign(value=other)]) if is_text(one) and is_text(
                    other
                ):
                    found.append(f"{label}: {ast.unparse(node.test)} chooses a word")
                case ast.Subscript(value=ast.Tuple(parts) | ast.List(parts), slice=index) if all(
                    map(is_text, parts)
                ) and not isinstance(index, ast.Constant | ast.UnaryOp | ast.Slice):
                    found.append(f"{label}: {ast.unparse(node)} chooses a word")
    return found


def is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def no_number_of_the_book(stored: Stored) -> list[str]:
    """In a section, no literal is a given or a result of the ledger's entries that the section uses."""
    sources = {}
    for _, cell in code(stored.notebook):
        for node in walk(tree(cell)):
            if isinstance(node, ast.ImportFrom) and node.module == "loopbook.ledger":
                sources |= {alias.asname or alias.name: alias.name for alias in node.names}
    found = []
    for section in sections(stored.notebook):
        book: dict[Fraction, str] = {}
        for node in (n for _, cell in section for n in walk(tree(cell))):
            match node:
                case ast.Subscript(value=ast.Name(name), slice=ast.Constant(str(entry))) if name in sources:
                    book |= dict.fromkeys(printed_numbers(LEDGER, sources[name], entry), f"{name} {entry}")
        for label, cell in section:
            for value in literals(tree(cell)):
                if abs(value) in book:
                    found.append(f"{label}: {float(value):g} stands in {book[abs(value)]}: take it from the ledger")
    return found


def literals(node: ast.AST) -> Iterator[Fraction]:
    """The numbers written in a piece of code, except where they are form and not data."""
    value = number(node)
    if value is not None:
        yield value
        return
    for child in ast.iter_child_nodes(node):
        if child not in form(node):
            yield from literals(child)


def form(node: ast.AST) -> list[ast.AST]:
    """The numbers in `node` that are its form: an exponent, an index, the order of a derivative."""
    match node:
        case ast.BinOp(op=ast.Pow(), right=part) | ast.Subscript(slice=part):
            parts = [part]
        case ast.Call(func=ast.Name("diff" | "Derivative") | ast.Attribute(attr="diff"), args=parts):
            pass
        case _:
            parts = []
    return [part for part in parts if number(part) is not None]


def number(node: ast.AST) -> Fraction | None:
    """The value of a literal number, also as `-2`, `1/2`, `S("0.5")` or `Rational(1, 2)`."""
    match node:
        case ast.Constant(bool()):
            return None
        case ast.Constant(int() | float() as value):
            return Fraction(str(value))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return None if (value := number(operand)) is None else -value
        case ast.BinOp(left=over, op=ast.Div(), right=under):
            return quotient([number(over), number(under)])
        case ast.Call(func=ast.Name(name), args=[ast.Constant(str(text))]) if name in MAKERS:
            try:
                return Fraction(text)
            except ValueError:
                return None
        case ast.Call(func=ast.Name(name), args=[_, *_] as arguments) if name in MAKERS:
            return quotient([number(argument) for argument in arguments])
    return None


def quotient(parts: list[Fraction | None]) -> Fraction | None:
    if None in parts or 0 in parts[1:]:
        return None
    return parts[0] / parts[1] if len(parts) == 2 else parts[0]


@cache
def written(path: Path) -> dict:
    """What a ledger says; nothing where there is none."""
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


@cache
def printed_numbers(ledger: Path, source: str, entry: str) -> frozenset[Fraction]:
    """The magnitudes that an entry of the ledger prints, 0 and 1 excepted."""
    content = written(ledger / f"{source}.toml").get(entry, {})
    texts = [str(value) for value in content.get("given", {}).values()]
    for result in content.get("result", []):
        texts += [str(result[key]) for key in ("printed", "correct", "computed") if key in result]
    # Exponents, orders of derivatives and the numbers of examples are no data.
    data = [
        re.sub(r"(\*\*|\^)\s*[({]?-?\d+|\(\w+, \d+\)|(Example|Equation|Figure|Section) \S+", "", text) for text in texts
    ]
    found = {Fraction(n) for text in data for n in re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?:[eE][+-]?\d+)?", text)}
    return frozenset(found - {0, 1})


CHECKS = (
    named_as_designed,
    valid,
    in_normal_form,
    light,
    fit_to_store,
    plain_python,
    without_tricks,
    one_import_cell,
    short_cells,
    only_sliders_escape_comparison,
    sliders_follow_a_figure,
    sliders_keep_what_they_use,
    checks_are_computed,
    evidence_can_fail,
    sections_begin_a_cell,
    answers_are_labelled,
    core_is_short,
    opens_and_closes,
    no_truth_value_becomes_a_word,
    no_number_of_the_book,
)
