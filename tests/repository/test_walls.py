"""The packages import in one direction, no modules import each other, and each order is the one that is said."""

import ast
import functools
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import alone

ROOT = Path(__file__).parents[2]
LIB = ROOT / "lib"
#: Each package with the packages that it stands on. A tool is for any book, and knows nothing of control engineering.
MAY_IMPORT = {
    "plainmath": set(),
    "bookledger": {"plainmath"},
    "exercisebook": {"plainmath"},
    "exercisegrader": {"exercisebook", "plainmath"},
    "loopbook": {"plainmath"},
    "loopbook-books": {"bookledger", "exercisebook", "exercisegrader", "loopbook", "plainmath"},
}
#: What of loopbook is in the package of the books, with names within `loopbook`.
OF_THE_BOOKS = {path.stem for path in (LIB / "loopbook-books" / "loopbook").iterdir()}
#: What runs beside a submission, in the jail and in the student's notebook.
INSIDE = "exercisegrader.inside."
#: The order in which a reader meets the modules of loopbook; the groups on one line do not know each other.
ORDER = [
    ["types"],
    ["expressions", "tables"],
    ["laplace"],
    ["transfer"],
    ["oscillation"],
    ["approximation"],
    ["scaling"],
    ["pid"],
    ["synthesis"],
    ["tuning"],
    ["figures"],
    ["quasipolynomials"],
    ["stability"],
    ["deadtime"],
    ["integrals"],
    ["loops"],
    ["families"],
    ["identification"],
    ["plants"],
    ["signals"],
    ["structures"],
    ["simulation"],
    ["sequence"],
    ["instruments"],
    ["diagrams"],
]
LEVEL = {name: level for level, names in enumerate(ORDER) for name in names}


@functools.cache
def modules():
    """All modules of all packages: {(package, dotted name): path}."""
    found = {}
    for package in MAY_IMPORT:
        for path in sorted((LIB / package).rglob("*.py")):
            name = ".".join(path.relative_to(LIB / package).with_suffix("").parts)
            found[package, name.removesuffix(".__init__")] = path
    return found


def imported(source):
    """Where a text imports from, anywhere in it and for type checkers alone, too: dotted names."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, "imports are written in full"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@functools.cache
def imports_of(path):
    return [*imported(path.read_text(encoding="utf-8"))]


def package_of(name):
    """The package of ours that a dotted name is in; None for those of others."""
    top, _, rest = name.partition(".")
    if top == "loopbook" and rest.partition(".")[0] in OF_THE_BOOKS:
        return "loopbook-books"
    return top if top in MAY_IMPORT else None


def across(package, names):
    """The names of those that are imported from a package which this one may not know."""
    return {name for name in names if package_of(name) not in {None, package, *MAY_IMPORT[package]}}


def outside(names):
    """Those of the grader's modules among the names that are not beside a submission."""
    return {one for one in names if one.partition(".")[0] == "exercisegrader" and not f"{one}.".startswith(INSIDE)}


def circles(graph):
    """The groups of modules that import each other, each in order, of {module: modules that it imports}."""

    def reached(start):
        found, ahead = set(), [start]
        while ahead:
            new = graph[ahead.pop()] - found
            found |= new
            ahead += new
        return found

    reach = {name: reached(name) for name in graph}
    groups = {frozenset({name, *(o for o in reach[name] if name in reach[o])}) for name in graph if name in reach[name]}
    return sorted(map(sorted, groups))


def upward(name, names):
    """What a part of the module `name` of loopbook imports, of names, that does not stand above it."""
    found = {one.split(".")[1] if "." in one else "itself" for one in names if one.partition(".")[0] == "loopbook"}
    return {other for other in found - {name} if LEVEL.get(other, len(ORDER)) >= LEVEL[name]}


def test_a_package_imports_only_those_that_it_stands_on():
    found = {f"{name} ({package})": across(package, imports_of(path)) for (package, name), path in modules().items()}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def test_the_examples_of_a_package_need_no_other():
    """Those in docstrings, which no syntax tree has as imports."""
    said = re.compile(r"^\s*(?:>>>|\.\.\.) (?:from|import) ([\w.]+)", re.MULTILINE)
    found = {
        name: across(package, said.findall(path.read_text("utf-8"))) for (package, name), path in modules().items()
    }
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def test_the_tests_of_a_package_need_no_other():
    files = {path: package for package, folder in alone.TESTS.items() for path in (ROOT / folder).rglob("*.py")}
    found = {path.name: across(package, imports_of(path)) for path, package in files.items()}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


@pytest.mark.parametrize("package", MAY_IMPORT)
def test_a_package_says_on_which_it_stands(package):
    project = tomllib.loads((LIB / package / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = {line.partition("==")[0].partition("[")[0] for line in project["dependencies"]} & {*MAY_IMPORT}
    used = {package_of(name) for (home, _), path in modules().items() if home == package for name in imports_of(path)}
    assert named == used - {package, None}


def test_each_package_is_proved_alone():
    assert {package: alone.stands_on(package) - {package} for package in alone.TESTS} == MAY_IMPORT


def test_no_modules_import_each_other():
    names = {name for _, name in modules()}

    def home(name):
        return name if name in names else name.rpartition(".")[0]

    graph = {name: {home(one) for one in imports_of(path)} & names - {name} for (_, name), path in modules().items()}
    assert circles(graph) == []


def test_a_module_of_loopbook_imports_only_what_stands_above_it():
    found = {}
    for (package, name), path in modules().items():
        if package == "loopbook" and "." in name:
            top = name.split(".")[1]
            assert top in LEVEL, f"{top} has no place in the order of the modules"
            found[name] = upward(top, imports_of(path))
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def test_inside_imports_nothing_of_outside():
    found = {name: outside(imports_of(path)) for (_, name), path in modules().items() if f"{name}.".startswith(INSIDE)}
    assert len(found) > 5
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


@pytest.mark.parametrize("package", [package for package in MAY_IMPORT if (ROOT / "tests" / package).is_dir()])
def test_the_tests_of_a_package_do_without_those_beside_it(package):
    found = {path.name: across(package, imports_of(path)) for path in (ROOT / "tests" / package).glob("*.py")}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


@pytest.mark.parametrize("package", ["plainmath", "bookledger", "exercisebook", "exercisegrader", "loopbook"])
def test_importing_a_package_does_not_import_another_beside_it(package):
    """Nor by a plug-in, which waits until exercises are written or read."""
    program = f"import sys, {package}; print(*sorted({{name.partition('.')[0] for name in sys.modules}}))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert {*result.stdout.split()} & {*MAY_IMPORT} <= {package, *MAY_IMPORT[package]}


@pytest.mark.parametrize(
    ("package", "source", "wrong"),
    [
        ("bookledger", "from loopbook.stability import margins", {"loopbook.stability.margins"}),
        ("exercisegrader", "def f():\n    import bookledger.evidence", {"bookledger.evidence"}),
        ("loopbook", "from loopbook.ledger import haugen", {"loopbook.ledger.haugen"}),
        ("loopbook", "from loopbook import exercises", {"loopbook.exercises"}),
        ("exercisegrader", "from exercisebook import png\nimport numpy", set()),
    ],
)
def test_an_import_through_a_wall_is_found(package, source, wrong):
    assert across(package, imported(source)) == wrong


def test_an_import_from_inside_to_outside_is_found():
    names = imported("from exercisegrader.inside import plain\nfrom exercisegrader import judge, inside")
    assert outside(names) == {"exercisegrader.judge"}


@pytest.mark.parametrize(
    ("name", "source", "wrong"),
    [
        ("laplace", "from plainmath.expressions import s\nimport sympy", set()),
        ("laplace", "from loopbook.transfer import poles", {"transfer"}),
        ("laplace", "import loopbook.transfer as transfer", {"transfer"}),
        ("laplace", "from loopbook import transfer", {"transfer"}),
        ("plants", "from loopbook import s", {"s"}),
        ("plants", "import loopbook", {"itself"}),
    ],
)
def test_an_import_against_the_order_is_found(name, source, wrong):
    assert upward(name, imported(source)) == wrong


def test_a_circle_is_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == [["b", "c"]]
