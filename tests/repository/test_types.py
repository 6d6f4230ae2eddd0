"""Type hints: every public function and method has them, they name what there is, and the package says so."""

import ast
import functools
import importlib
import pkgutil
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LIBRARY = ROOT / "lib"
PACKAGES = [path.parent for path in sorted(LIBRARY.glob("*/pyproject.toml"))]

OURS = {path.name for package in PACKAGES for path in package.iterdir() if (path / "py.typed").exists()}
PATHS = sorted(LIBRARY.rglob("*.py"))


def spelled(path):
    return path.relative_to(LIBRARY).as_posix()


@functools.cache
def parsed(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def is_public(name):
    """Whether a user may call it; the methods behind the operators count."""
    return not name.startswith("_") or (name.startswith("__") and name.endswith("__"))


def functions(body, inside=""):
    """The public functions and methods of a module, by their names, as the source has them."""
    for node in body:
        if isinstance(node, ast.ClassDef) and is_public(node.name):
            yield from functions(node.body, f"{inside}{node.name}.")
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and is_public(node.name):
            yield f"{inside}{node.name}", node


def without_hints(name, node):
    """What of a function has no hint: its parameters but for self and cls, and its result."""
    spec = node.args
    parameters = [*spec.posonlyargs, *spec.args, *spec.kwonlyargs, spec.vararg, spec.kwarg]
    static = any(isinstance(word, ast.Name) and word.id == "staticmethod" for word in node.decorator_list)
    if "." in name and not static:
        parameters = parameters[1:]
    found = [parameter.arg for parameter in parameters if parameter is not None and parameter.annotation is None]
    return found + ["the result"] * (node.returns is None and node.name != "__init__")


def missing_in_library(tree):
    """What a module imports, perhaps for a type checker alone, out of modules of ours that do not have it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in OURS:
            module = importlib.import_module(node.module)
            submodules = {part.name for part in pkgutil.iter_modules(getattr(module, "__path__", []))}
            yield from (
                f"{node.module}.{alias.name}"
                for alias in node.names
                if not (alias.name in {"*", *submodules} or hasattr(module, alias.name))
            )


def is_api(path):
    """Whether a file has functions to call; the exercises of the bank are declarations."""
    return "/exercises/bank/ch" not in spelled(path)


def test_what_is_public_has_type_hints():
    found = {
        f"{spelled(path)}: {name}": without_hints(name, node)
        for path in filter(is_api, PATHS)
        for name, node in functions(parsed(path).body)
    }
    assert {name: missing for name, missing in found.items() if missing} == {}


def test_what_only_a_type_checker_imports_is_there():
    """The names in the hints themselves are for ruff to find."""
    found = {spelled(path): [*missing_in_library(parsed(path))] for path in PATHS}
    assert {path: missing for path, missing in found.items() if missing} == {}


# what loopbook-books has lies within loopbook, where it is installed
@pytest.mark.parametrize("package", [p for p in PACKAGES if p.name != "loopbook-books"], ids=lambda path: path.name)
def test_type_checkers_find_the_hints(package):
    project = tomllib.loads((package / "pyproject.toml").read_text(encoding="utf-8"))
    [folder] = project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    assert (package / folder / "py.typed").is_file()


@pytest.mark.parametrize(
    ("source", "missing"),
    [
        ("def f(x: int) -> int: ...", {}),
        ("def f(x, *, y: int = 0, **more) -> int: ...", {"f": ["x", "more"]}),
        ("def f(*x: int): ...", {"f": ["the result"]}),
        ("def _f(x): ...", {}),
        ("class A:\n def __init__(self, x: int): ...\n def _f(self, x): ...", {}),
        ("class A:\n @property\n def x(self): ...\n def __add__(self, other): ...",
         {"A.x": ["the result"], "A.__add__": ["other", "the result"]}),
        ("class A:\n @staticmethod\n def f(x) -> int: ...", {"A.f": ["x"]}),
    ],
)  # fmt: skip
def test_a_missing_hint_is_found(source, missing):
    found = {name: without_hints(name, node) for name, node in functions(ast.parse(source).body)}
    assert {name: words for name, words in found.items() if words} == missing
