"""Which functions and classes of the library a piece of a notebook uses, by the names in its code.

Nothing is run: imports say what a name means, and a name that the notebook gives to something else means it no longer.
"""

import ast
import functools
import importlib
import inspect
from types import ModuleType

HIDDEN = {"exercise", "progress"}  # of every chapter's exercises, and in no example


class Names:
    """The names of the library that a notebook knows, as its cells come one after the other."""

    def __init__(self):
        self.known = {}  # {name: (address, object)}

    def used(self, code):
        """Return what the code of a cell uses: {address in the reference: name}, and learn what it imports.

        >>> names = Names()
        >>> names.used("from loopbook import tuning")
        {}
        >>> names.used("settings = tuning.simc(process)")
        {'loopbook.tuning.simc': 'simc'}
        """
        nodes, found = ordered(code), {}
        for node in nodes:
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "loopbook":
                self.learn(node)
            elif isinstance(node, ast.Attribute | ast.Name) and isinstance(node.ctx, ast.Load):
                address, thing = self.meant(node)
                if (inspect.isfunction(thing) or inspect.isclass(thing)) and offered(address, thing):
                    found[address] = address.rpartition(".")[2]
        for node in nodes:
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                self.known.pop(node.id, None)
        return {address: name for address, name in found.items() if name not in HIDDEN}

    def learn(self, statement):
        """Take in the names of an import."""
        module = importlib.import_module(statement.module)
        for alias in statement.names:
            address = f"{statement.module}.{alias.name}"
            if not hasattr(module, alias.name):
                importlib.import_module(address)
            self.known[alias.asname or alias.name] = address, getattr(module, alias.name)

    def meant(self, node):
        """Return address and object that a name, or an attribute of a module, stands for; (None, None) if not ours."""
        if isinstance(node, ast.Name):
            return self.known.get(node.id, (None, None))
        if isinstance(node, ast.Attribute):
            address, thing = self.meant(node.value)
            if isinstance(thing, ModuleType) and hasattr(thing, node.attr):
                return f"{address}.{node.attr}", getattr(thing, node.attr)
        return None, None


def offered(address, thing):
    """Whether the module of an address has it among what it offers, and so the reference too."""
    module, _, name = address.rpartition(".")
    names = getattr(importlib.import_module(module), "__all__", None)
    return thing.__module__ == module if names is None else name in names


@functools.cache
def ordered(code):
    """The nodes of a piece of code in its order: the chapters are read for their pages and for the reference."""
    return sorted(
        ast.walk(ast.parse(code)), key=lambda node: (getattr(node, "lineno", 0), getattr(node, "col_offset", 0))
    )


def of_sections(cells):
    """Return what each section of a notebook uses: [(title of the section, {address: name})], in order.

    Arguments:
        cells: of a notebook; a section begins with a Markdown line that begins with "## ".
    """
    names, sections = Names(), [("", {})]
    for cell in cells:
        if cell["cell_type"] == "markdown":
            sections += [(line[3:].strip(), {}) for line in cell["source"].splitlines() if line.startswith("## ")]
        elif cell["cell_type"] == "code":
            sections[-1][1].update(names.used(cell["source"]))
    return sections
