"""One figure of a notebook as a program of its own: its cell, and of the cells before it what it needs.

Nothing is run. A statement is kept if it gives a value to a name that is needed, or changes what a needed name stands
for; what it needs itself is then needed too. Where it cannot be known, too much is kept rather than too little.
"""

import ast
import builtins
import functools
import textwrap
from dataclasses import dataclass

SHOWN_ONLY = {"sliders"}  # decorators that show what a function returns: the program calls it itself
WIDTH = 88  # of the program's first lines


EFFECTS = {"add", "append", "extend", "insert", "pop", "remove", "setdefault", "sort", "update"}  # of Python's own


@dataclass
class Statement:
    """One statement of a notebook at the top of a cell, with the comment lines above it.

    Attributes:
        node: its syntax tree.
        text: its source.
        gives: the names that it gives a value.
        needs: the names whose values it takes.
        later: the names that functions made here take when they are called.
        changes: the names of which it changes what they stand for: by a method, an item, an attribute.
        passed: the names that it takes other than to call them, so that their functions may be called later.
        called: the names of the functions that it calls.
        cell: number of its cell.
    """

    node: ast.stmt
    text: str
    gives: set
    needs: set
    later: set
    changes: set
    passed: set
    called: set
    cell: int


def program(cells, number, title="", place="", file="figure.png"):
    """Return the program that draws the figure of one cell, as text.

    Arguments:
        cells: of a notebook.
        number: of the cell whose last statement is the figure, or a function of sliders that returns it.
        title, place: of the figure, and of its notebook, for the program's first lines.
        file: where the program puts the picture.
    Raises:
        ValueError: the cell ends in nothing that is shown.
    """
    code = [(k, cell["source"]) for k, cell in enumerate(cells[: number + 1]) if cell["cell_type"] == "code"]
    whole = [statement for k, source in code for statement in statements(source, k)]
    last = whole[-1]
    kept = needed(whole)
    imports = import_lines(
        [one for one in kept if is_import(one.node)], set().union(*(one.needs | one.later for one in kept)) - SHOWN_ONLY
    )
    body, before = [], None
    for one in kept:
        if is_import(one.node) or one is last:
            continue
        if before and (is_block(before.node) or is_block(one.node)):
            body += ["", ""]
        elif before and before.cell != one.cell:
            body.append("")
        body.append(one.text)
        before = one
    words = textwrap.wrap(title, WIDTH - 4) or ["A figure"]
    head = "\n".join([f'"""{words[0]}', *words[1:]]) + (f"\n\n{place}\n" if place else "") + '"""'
    head = f"r{head}" if "\\" in head else head
    body += ["", ""] if before and is_block(before.node) else [""] if before else []
    parts = [head, "\n".join(imports), "\n".join([*body, shown(last, file)])]
    return "\n\n".join(part for part in parts if part).strip("\n") + "\n"


@functools.cache
def statements(source, cell=0):
    """Return the statements of a cell, the number of which is given."""
    lines, before, found = source.splitlines(), 0, []
    for node in ast.parse(source).body:
        text = "\n".join(lines[before : node.end_lineno]).strip("\n")
        before = node.end_lineno
        found.append(Statement(node, text, *names(node), cell))
    if found and isinstance(found[-1].node, ast.Expr) and not has_effect(found[-1].node.value):
        found[-1].changes.clear()  # what ends a cell is shown
    return found


def has_effect(value):
    return isinstance(value, ast.Call) and isinstance(value.func, ast.Attribute) and value.func.attr in EFFECTS


def names(node):
    """Return what a statement gives, needs, needs later, changes, passes on and calls: sets of names."""
    if is_import(node):
        return (
            {(alias.asname or alias.name).partition(".")[0] for alias in node.names},
            set(),
            set(),
            set(),
            set(),
            set(),
        )
    reader = Reader()
    reader.visit(node)
    if isinstance(node, ast.For) and reader.changed_within:
        reader.changes |= reader.needs  # what is changed may be an item of anything
    own = set(dir(builtins))
    return (
        reader.gives,
        reader.needs - own,
        reader.later - own,
        reader.changes,
        reader.passed - own,
        reader.called - own,
    )


class Reader(ast.NodeVisitor):
    """Reads which names a statement of the top level gives, needs and changes."""

    def __init__(self):
        self.gives, self.needs, self.later, self.changes = set(), set(), set(), set()
        self.passed, self.called = set(), set()
        self.changed_within = False  # whether it changes what a name of its own stands for
        self.local = [set()]  # of the functions and comprehensions around
        self.waits = 0  # in the body of how many functions, which run later

    def known(self, name):
        return any(name in names for names in self.local)

    def visit_Name(self, node):
        if isinstance(node.ctx, ast.Load):
            if not self.known(node.id):
                (self.later if self.waits else self.needs).add(node.id)
                self.passed.add(node.id)
        elif len(self.local) == 1:
            self.gives.add(node.id)

    def visit_Call(self, node):
        if isinstance(node.func, ast.Name) and not self.known(node.func.id):
            (self.later if self.waits else self.needs).add(node.func.id)
            self.called.add(node.func.id)
        else:
            self.visit(node.func)
        for part in [*node.args, *node.keywords]:
            self.visit(part)

    def visit_Assign(self, node):
        self.visit(node.value)  # before the names that it gives
        for target in node.targets:
            self.visit(target)

    def visit_AugAssign(self, node):
        self.visit(node.value)
        self.change(node.target)
        self.visit(node.target)
        for part in ast.walk(node.target):
            if isinstance(part, ast.Name):
                self.needs.add(part.id)

    def visit_Attribute(self, node):
        if not isinstance(node.ctx, ast.Load):
            self.change(node)
        self.generic_visit(node)

    def visit_Subscript(self, node):
        if not isinstance(node.ctx, ast.Load):
            self.change(node)
        self.generic_visit(node)

    def visit_Expr(self, node):
        if isinstance(node.value, ast.Call) and isinstance(node.value.func, ast.Attribute):
            self.change(node.value.func)  # a method that is called for what it does
        self.generic_visit(node)

    def change(self, node):
        while isinstance(node, ast.Attribute | ast.Subscript | ast.Call):
            node = node.func if isinstance(node, ast.Call) else node.value
        if isinstance(node, ast.Name) and not self.known(node.id):
            self.changes.add(node.id)
            self.changed_within = self.changed_within or node.id in self.gives

    def visit_FunctionDef(self, node):
        for part in [*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)]:
            if not shows(part) or widgets(node):
                self.visit(part)
        if len(self.local) == 1:
            self.gives.add(node.name)
        arguments = {one.arg for one in ast.walk(node.args) if isinstance(one, ast.arg)}
        self.waits += 1
        self.inside(arguments | assigned(node.body), node.body)
        self.waits -= 1

    def visit_ClassDef(self, node):
        for part in [*node.bases, *node.decorator_list]:
            self.visit(part)
        if len(self.local) == 1:
            self.gives.add(node.name)
        before = set(self.needs)
        self.inside(assigned(node.body), node.body)
        self.later |= self.needs - before

    def visit_Lambda(self, node):
        for part in [*node.args.defaults, *filter(None, node.args.kw_defaults)]:
            self.visit(part)
        names, before = {one.arg for one in ast.walk(node.args) if isinstance(one, ast.arg)}, set(self.needs)
        self.inside(names, [node.body])  # it may be called at once, and later too
        self.later |= self.needs - before

    def comprehension(self, node):
        bound = {
            part.id
            for generator in node.generators
            for part in ast.walk(generator.target)
            if isinstance(part, ast.Name)
        }
        self.visit(node.generators[0].iter)  # outside
        self.inside(bound, ast.iter_child_nodes(node))

    visit_ListComp = visit_SetComp = visit_DictComp = visit_GeneratorExp = comprehension  # noqa: N815 - names of ast

    def inside(self, names, parts):
        self.local.append(names)
        for part in parts:
            self.visit(part)
        self.local.pop()


def assigned(body):
    """The names that the statements of a function give a value, and so are its own."""
    found = set()
    for statement in body:
        for node in ast.walk(statement):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                found.add(node.id)
            elif isinstance(node, ast.FunctionDef | ast.ClassDef):
                found.add(node.name)
    return found


def widgets(function):
    """What the sliders of a function begin with, where its parameters have no values of their own: their widgets."""
    missing = len(function.args.args) - len(function.args.defaults)
    labels = next((d.args[0] for d in function.decorator_list if shows(d) and d.args), None)
    return [f"{ast.unparse(value)}.value" for value in labels.values[:missing]] if isinstance(labels, ast.Dict) else []


def shows(decorator):
    function = decorator.func if isinstance(decorator, ast.Call) else decorator
    return isinstance(function, ast.Name) and function.id in SHOWN_ONLY


def needed(whole):
    """Return the statements that the last one needs, and itself, in their order."""
    wanted = effective(whole)
    kept, open_names = [whole[-1]], set(wanted[-1])
    for one, needs in zip(reversed(whole[:-1]), reversed(wanted[:-1]), strict=True):
        if open_names & (one.gives | one.changes):
            kept.append(one)
            if settles(one.node):
                open_names -= one.gives
            open_names |= needs
    return kept[::-1]


def effective(whole):
    """Return the names that each statement needs, with those of the functions that it calls or may call."""
    carried, makers, found = {}, set(), []  # what is needed when a name is called; functions that make functions
    for one in whole:
        last = one is whole[-1] and isinstance(one.node, ast.FunctionDef)
        needs, waiting = set(), [*one.needs, *(one.later if last else ())]
        while waiting:
            name = waiting.pop()
            if name not in needs:
                needs.add(name)
                waiting += carried.get(name, ())
        found.append(needs)
        within = set(one.later)
        if not isinstance(one.node, ast.FunctionDef):
            for name in one.passed | (one.called & makers):
                within |= carried.get(name, set())
        elif any(isinstance(part, ast.FunctionDef | ast.Lambda) for line in one.node.body for part in ast.walk(line)):
            makers.add(one.node.name)
        for name in one.gives | one.changes:
            carried[name] = within if settles(one.node) and name in one.gives else carried.get(name, set()) | within
    return found


def settles(node):
    """Whether what a statement gives does not depend on what its names were before, nor on a condition."""
    return is_import(node) or isinstance(node, ast.Assign | ast.AnnAssign | ast.FunctionDef | ast.ClassDef)


def is_block(node):
    return isinstance(node, ast.FunctionDef | ast.ClassDef)


def is_import(node):
    return isinstance(node, ast.Import | ast.ImportFrom)


def import_lines(kept, used):
    """The imports, of the names that are used."""
    lines, seen = [], set()
    for one in kept:
        names = [a for a in one.node.names if (a.asname or a.name).partition(".")[0] in used]
        fresh = [a for a in names if ast.unparse(a) not in seen]
        seen |= {ast.unparse(a) for a in fresh}
        if not fresh:
            continue
        said = ", ".join(ast.unparse(a) for a in fresh)
        if isinstance(one.node, ast.Import):
            lines.append(f"import {said}")
            continue
        line = f"from {'.' * one.node.level}{one.node.module or ''} import {said}"
        lines.append(line if len(line) <= WIDTH else line.replace(f"import {said}", f"import (\n    {said},\n)"))
    return lines


def shown(last, file):
    """The last statement, with what it shows put into a file."""
    if isinstance(last.node, ast.FunctionDef):
        function = last.text[last.text.index("\ndef ") + 1 :] if "\ndef " in last.text else last.text
        several = any(isinstance(part, ast.Return) and isinstance(part.value, ast.List) for part in ast.walk(last.node))
        value = (
            f"{function}\n\n\npicture{', *_' if several else ''} = {last.node.name}({', '.join(widgets(last.node))})"
        )
    elif isinstance(last.node, ast.Expr):
        lines = last.text.splitlines()
        comment = [line for line in lines[: len(lines) - (last.node.end_lineno - last.node.lineno) - 1]]
        code = "\n".join(lines[len(comment) :])
        value = "\n".join(
            [*comment, f"picture = {code}" if fits(code) else f"picture = (\n{textwrap.indent(code, '    ')}\n)"]
        )
    else:
        raise ValueError(f"a cell of a figure ends in {ast.unparse(last.node)[:60]!r}: expected what it shows")
    return f'{value}\npicture.save("{file}")  # or .svg, .pdf'


def fits(code):
    """Whether an expression can follow an equals sign as it is: on one line, or in brackets from its first line on."""
    try:
        ast.parse(f"picture = {code}")
    except SyntaxError:
        return False
    return len(f"picture = {code.splitlines()[0]}") <= WIDTH + 12
