"""The form of our stored notebooks, a function for each rule: it takes a stored notebook and returns its complaints.

What a notebook does with the ledger has rules of its own, which `bookledger` brings.
"""

import ast
import re
import statistics
import symtable
from pathlib import Path

import nbformat
from nbformat import NotebookNode

from bookledger.stored import Stored, code, parsed, sections, tree, walk
from loopbook import notebooks, working_copy

ROOT = Path(__file__).parents[2]

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
    return [f"{label}: not plain Python" for label, cell in code(stored.notebook) if parsed(cell.source) is None]


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
    """No comment hides a cell; the normal form leaves no tag that does to any but those with sliders."""
    return [
        f"{label}: a comment that hides a cell from comparison"
        for label, cell in code(stored.notebook)
        if re.search(r"NBVAL|PYTEST_VALIDATE", cell.source)
    ]


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
    cells = [(label, cell) for label, cell in code(stored.notebook) if parsed(cell.source)]
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
    """No cell ends in a literal: a number has its name and unit, and several of them are a table."""
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
    sections_begin_a_cell,
    answers_are_labelled,
    core_is_short,
    opens_and_closes,
)
