"""The library's reference: the directive `library` documents a module, with all that it offers.

Autodoc and napoleon read the docstrings, which are reStructuredText: code in double back-quotes, names of the library
in single ones. What is here is what they cannot do:

- a package is documented under the names that a reader imports, `loopbook.tuning.simc` and not the module within, part
  by part in the order of the source;
- a name in single back-quotes leads to its place, whatever module it is of;
- a function has links to the chapters that use it, and its source stands among arguments and results.
"""

import ast
import functools
import importlib
import inspect
import json
import pkgutil
import re
from pathlib import Path

import functions_used
from docutils.parsers.rst import directives
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[2]
#: Our packages; the reference calls a module of loopbook by its name within it.
OURS = ("bookledger", "exercisebook", "exercisegrader", "loopbook", "plainmath")
_SOURCE = re.compile(r"^Source: (.*(?:\n(?! *$).*)*)", re.MULTILINE)


def modules():
    """Return the rows of the README's table of modules: [(names, what they do), ...]."""
    rows = (ROOT / "README.md").read_text(encoding="utf-8").partition("| module | what it does |\n")[2]
    table = rows.partition("\n\n")[0].splitlines()[1:]
    return [(re.findall(r"`(\w+)`", row.split("|")[1]), row.split("|")[2].strip()) for row in table]


def address_of(name):
    """Return the full name of a module that the README's table names: a package, or a module of loopbook.

    >>> address_of("pid"), address_of("plainmath")
    ('loopbook.pid', 'plainmath')
    """
    return name if name in OURS else f"loopbook.{name}"


def offered(module):
    """Return the public names of a module, in the order of its source; of a package part by part."""
    names = getattr(module, "__all__", None) or [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    ]
    return sorted(names, key=lambda name: _place(module, name))


def _place(module, name):
    """Where a name is made: the part of the package as `__init__` imports it, and the line there."""
    home = part_of(module, name)
    parts = [part for part in _imported_parts(module) if part != module.__name__]
    part = -1 if home == module.__name__ else parts.index(home) if home in parts else len(parts)
    return (part, _made(home).get(name, 10**9))


@functools.cache
def _imported_parts(module):
    found = re.findall(rf"^from ((?:{'|'.join(OURS)})[\w.]*) import", inspect.getsource(module), re.MULTILINE)
    return list(dict.fromkeys(found))


@functools.cache
def _made(name):
    """The line at which a module makes each of its names, constants too; what it imports is made elsewhere."""
    lines = {}
    for node in ast.parse(inspect.getsource(importlib.import_module(name))).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            lines[node.name] = node.lineno
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            names = (part for part in ast.walk(node) if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store))
            lines |= {part.id: node.lineno for part in names}
    return lines


def part_of(module, name):
    """Return the module that makes what another one offers: itself, or a part of a package."""
    made_in = getattr(getattr(module, name), "__module__", "") or module.__name__
    parts = (part for part in (module.__name__, *_imported_parts(module)) if name in _made(part))
    return next(parts, made_in if made_in.startswith(OURS) else module.__name__)


@functools.cache
def public():
    """Return what a back-quoted name means: {name: its address in the reference}, for names of more than a letter."""
    found = {}
    for names, _ in modules():
        for name in names:
            module = importlib.import_module(address_of(name))
            found |= {key: f"{module.__name__}.{key}" for key in offered(module) if len(key) > 1 and key not in found}
            found.setdefault(name, module.__name__)
    return found


@functools.cache
def chapters_with():
    """Return the chapters that use a function or a class: {its address in the reference: [chapter, ...]}."""
    found = {}
    for file in sorted((ROOT / "chapters").glob("*.ipynb")):
        names, used = functions_used.Names(), set()
        for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
            if cell["cell_type"] == "code":
                used |= set(names.used("".join(cell["source"])))
        for address in used:
            found.setdefault(address, []).append(file.stem)
    return found


def mend(app, what, name, obj, options, lines):
    """Make a field of the source, and one with the chapters that use a function or a class."""
    if not name.startswith(OURS):
        return
    text = _SOURCE.sub(lambda match: "\n:Source: " + re.sub(r"\n\s*", "\n    ", match[1]) + "\n", "\n".join(lines))
    pages = [chapter for chapter in chapters_with().get(name, ()) if f"chapters/{chapter}" in app.env.found_docs]
    if pages:
        links = ", ".join(f":doc:`{page.partition('_')[0].lstrip('0')} </chapters/{page}>`" for page in pages)
        example = re.search(r"^>>>|\Z", text, re.MULTILINE).start()
        text = f"{text[:example]}\n\n:In {'chapters' if pages[1:] else 'chapter'}: {links}\n\n{text[example:]}"
    lines[:] = text.split("\n")


def find(app, env, node, shown):
    """Return a link to what a back-quoted name of the library means, of whatever module it is; None for others."""
    head, _, rest = node["reftarget"].removeprefix("loopbook.").partition(".")
    if node.get("reftype") != "obj" or head not in public():
        return None
    address = f"{public()[head]}{'.' + rest if rest else ''}"
    domain = env.domains["py"]
    return domain.resolve_xref(env, node["refdoc"], app.builder, "obj", address, node, shown)


class Library(SphinxDirective):
    """`.. library:: loopbook.tuning` documents a module, and with `:parts:` modules within it, a section each.

    A part that ends in `.*` is every module of a folder.
    """

    required_arguments = 1
    option_spec = {"parts": directives.unchanged}  # noqa: RUF012 - as docutils has it

    def run(self):
        name = self.arguments[0]
        module = importlib.import_module(name)
        self.env.note_dependency(module.__file__)
        lines = [f".. py:module:: {name}", "", *inspect.getdoc(module).split("\n"), ""]
        homes = {}
        for key in offered(module):
            homes.setdefault(part_of(module, key), []).append(key)
        for home, keys in homes.items():
            if len(homes) > 1 and home != name and hasattr(module, "__path__"):
                lines += self.heading(home)
            lines += [line for key in keys for line in documented(module, key)]
        for part in listed(name, self.options.get("parts", "")):
            inner = importlib.import_module(f"{name}.{part}")
            lines += self.heading(inner.__name__, f"{name}.{part}")
            lines += [f".. py:module:: {inner.__name__}", ""]
            lines += [line for key in offered(inner) for line in documented(inner, key)]
        return self.parse_text_to_nodes("\n".join(lines), allow_section_headings=True)

    def heading(self, home, title=""):
        """The title of a part, and what its module says of itself."""
        part = importlib.import_module(home)
        self.env.note_dependency(part.__file__)
        title = title.removeprefix("loopbook.") or home.rpartition(".")[2].replace("_", " ")
        return [title, "-" * len(title), "", *inspect.getdoc(part).split("\n"), ""]


def listed(name, parts):
    """Return the names of the parts of a module, with those of folders spelled out."""
    found = []
    for part in parts.split():
        folder = part.removesuffix(".*")
        if folder == part:
            found.append(part)
        else:
            inside = pkgutil.iter_modules(importlib.import_module(f"{name}.{folder}").__path__)
            found += [f"{folder}.{module.name}" for module in inside]
    return found


def documented(module, name):
    """Return the lines that document one name of a module."""
    value, address = getattr(module, name), f"{module.__name__}.{name}"
    place = f"   :module: {module.__name__}"
    if inspect.isclass(value):
        if value.__name__ != name:  # another name for a class that has its place elsewhere
            return [f".. py:class:: {name}", place, "", f"   The same as `{value.__name__}`.", ""]
        if value.__module__.partition(".")[0] != module.__name__.partition(".")[0]:  # a class has one place
            home = f":py:obj:`{value.__module__}.{value.__qualname__}`"
            return [f".. py:class:: {name}", place, "", f"   The same as {home}.", ""]
        lines = [f".. auto{'exception' if issubclass(value, Exception) else 'class'}:: {address}", "   :members:"]
        bases = [base for base in value.__bases__ if base.__module__.startswith(OURS)]
        return [*lines, *(["   :show-inheritance:"] if bases else []), ""]
    if callable(value) and hasattr(value, "__code__"):
        return [f".. autofunction:: {address}", ""]
    home = part_of(module, name)
    comment = ModuleAnalyzer.for_module(home).find_attr_docs().get(("", name), [])
    return [f".. py:data:: {name}", place, "", *(f"   {line}" for line in comment), ""]


class Modules(SphinxDirective):
    """`.. modules::` is the README's table of modules, each with its page."""

    def run(self):
        self.env.note_dependency(ROOT / "README.md")
        lines = [
            ".. list-table::",
            "   :header-rows: 1",
            "   :widths: 25 75",
            "",
            "   * - module",
            "     - what it does",
        ]
        for names, what in modules():
            pages = ", ".join(f":doc:`/reference/{name}`" for name in names)
            what = re.sub(r"`(\w+)`", r"``\1``", what)
            lines += [f"   * - {pages}", f"     - {what}"]
        lines += ["", ".. toctree::", "   :hidden:", ""]
        lines += [f"   /reference/{name}" for names, _ in modules() for name in names]
        return self.parse_text_to_nodes("\n".join(lines))


def setup(app):
    """Join Sphinx: autodoc, napoleon for the sections of the docstrings, and the directives."""
    app.setup_extension("sphinx.ext.autodoc")
    app.setup_extension("sphinx.ext.napoleon")
    app.connect("autodoc-process-docstring", mend, priority=400)
    app.connect("missing-reference", find)
    app.add_directive("library", Library)
    app.add_directive("modules", Modules)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
