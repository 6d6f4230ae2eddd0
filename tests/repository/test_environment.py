"""The environment is pinned, complete and installed, and the library's modules import only what stands above them."""

import ast
import os
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
LIBRARY = ROOT / "lib" / "loopbook"

unpinned = os.environ.get("LOOPBOOK_UNPINNED") == "1"
needs_the_pins = pytest.mark.skipif(unpinned, reason="this run tries the newest versions on purpose")

# The pins.

LINES = [line.strip() for line in (ROOT / "environment.txt").read_text(encoding="utf-8").splitlines()]
ENTRIES = [line for line in LINES if line and not line.startswith("#")]
PIN = re.compile(r"[A-Za-z0-9_.-]+==[A-Za-z0-9_.!+]+( ; .+)?")


def pins():
    """The pinned requirement of each package, by the package's name."""
    return {canonicalize_name(pin.name): pin for pin in map(Requirement, ENTRIES[:-1])}


def version(pin):
    return next(iter(pin.specifier)).version


def direct():
    """What the library says it needs, with its extras."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return [*project["dependencies"], *(line for extra in project["optional-dependencies"].values() for line in extra)]


def test_the_environment_pins_exactly_and_ends_with_the_library():
    assert ENTRIES[-1] == "-e ."
    assert [line for line in ENTRIES[:-1] if not PIN.fullmatch(line)] == []
    assert len(pins()) == len(ENTRIES) - 1, "a package is pinned twice"


@pytest.mark.parametrize("line", ["numpy", "numpy>=2.2", "numpy==2.*", "numpy ==2.4.6", "-r other.txt"])
def test_a_loose_line_is_no_pin(line):
    assert not PIN.fullmatch(line)


@pytest.mark.parametrize("needed", direct())
def test_what_the_library_needs_is_pinned_within_its_range(needed):
    requirement = Requirement(needed)
    pin = pins().get(canonicalize_name(requirement.name))
    assert pin, f"{requirement.name} is not in environment.txt"
    assert requirement.specifier.contains(version(pin))


@needs_the_pins
def test_what_is_pinned_is_installed():
    here = {name: version(pin) for name, pin in pins().items() if pin.marker is None or pin.marker.evaluate()}
    installed = {canonicalize_name(found.name): found.version for found in metadata.distributions()}
    assert {name: installed.get(name) for name in here} == here


@needs_the_pins
def test_what_the_pinned_packages_need_is_pinned():
    pinned, missing, seen = pins(), set(), set()
    open_requirements = [Requirement(line) for line in direct()]
    while open_requirements:
        requirement = open_requirements.pop()
        name = canonicalize_name(requirement.name)
        if (name, *sorted(requirement.extras)) in seen:
            continue
        seen.add((name, *sorted(requirement.extras)))
        if name not in pinned:
            missing.add(name)
            continue
        for line in metadata.requires(name) or []:
            needed = Requirement(line)
            extras = ["", *requirement.extras]
            if needed.marker is None or any(needed.marker.evaluate({"extra": extra}) for extra in extras):
                open_requirements.append(needed)
    assert missing == set()


# The library.


def test_importing_the_library_is_quick():
    """What is slow to import waits until it is used."""
    heavy = {"numpy", "matplotlib", "control", "scipy", "pandas", "ipywidgets", "IPython", "nbformat", "schemdraw"}
    program = f"import sys, loopbook; print(sorted({heavy} & set(sys.modules)))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.strip() == "[]"


# The order in which a reader meets the modules; the groups on one line do not know each other.
ORDER = [
    ["types"],
    ["expressions"],
    ["latex", "validation"],
    ["tables"],
    ["laplace"],
    ["transfer"],
    ["oscillation"],
    ["approximation"],
    ["scaling"],
    ["pid"],
    ["synthesis"],
    ["tuning"],
    ["figures"],
    ["sliders"],
    ["quasipolynomials"],
    ["stability"],
    ["deadtime"],
    ["ise"],
    ["families"],
    ["identification"],
    ["plants"],
    ["signals"],
    ["structures"],
    ["simulation"],
    ["sequence"],
    ["instruments"],
    ["diagrams"],
    ["evidence"],
    ["ledger", "notebooks", "working_copy"],
    ["exercises"],
    ["grading"],
    ["__main__"],
]
LEVEL = {name: level for level, names in enumerate(ORDER) for name in names}


def imported(source, module=("loopbook",)):
    """The library's modules that `source`, in the package `module`, imports anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            paths = [alias.name.split(".") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = list(module[: len(module) - node.level + 1]) if node.level else []
            base += node.module.split(".") if node.module else []
            paths = [[*base, alias.name] for alias in node.names]
        else:
            continue
        found |= {path[1] if len(path) > 1 else "loopbook" for path in paths if path[0] == "loopbook"}
    return found


def upward(name, source, module=("loopbook",)):
    """The imports in `source`, a part of the module `name`, of modules that do not stand above it."""
    return {other for other in imported(source, module) - {name} if LEVEL.get(other, len(ORDER)) >= LEVEL[name]}


MODULES = [path for path in sorted(LIBRARY.rglob("*.py")) if path != LIBRARY / "__init__.py"]


def test_a_module_imports_only_what_stands_above_it():
    found = {}
    for path in MODULES:
        inside = path.relative_to(LIBRARY)
        name = inside.parts[0].removesuffix(".py")
        assert name in LEVEL, f"{name} has no place in the order of the modules"
        found[inside.as_posix()] = upward(name, path.read_text(encoding="utf-8"), ("loopbook", *inside.parts[:-1]))
    assert {path: wrong for path, wrong in found.items() if wrong} == {}


@pytest.mark.parametrize(
    ("name", "source", "wrong"),
    [
        ("laplace", "from loopbook.expressions import s\nimport sympy", set()),
        ("laplace", "from loopbook.transfer import poles", {"transfer"}),
        ("laplace", "import loopbook.transfer as transfer", {"transfer"}),
        ("laplace", "from loopbook import transfer", {"transfer"}),
        ("laplace", "from .transfer import poles", {"transfer"}),
        ("laplace", "from . import transfer", {"transfer"}),
        ("pid", "def f():\n    from loopbook.ledger import haugen", {"ledger"}),
        ("plants", "from loopbook import s", {"s"}),
        ("plants", "import loopbook", {"loopbook"}),
        ("ledger", "from loopbook import notebooks", {"notebooks"}),
        ("ledger", "from loopbook.ledger import numbers\nfrom loopbook import figures", set()),
    ],
)
def test_an_import_against_the_order_is_found(name, source, wrong):
    assert upward(name, source) == wrong
