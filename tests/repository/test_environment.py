"""The environment is pinned, complete and installed, and importing the library is quick."""

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
PACKAGES = sorted(path.parent.name for path in (ROOT / "lib").glob("*/pyproject.toml"))

unpinned = os.environ.get("LOOPBOOK_UNPINNED") == "1"
needs_the_pins = pytest.mark.skipif(unpinned, reason="this run tries the newest versions on purpose")

# The pins.

LINES = [line.strip() for line in (ROOT / "environment.txt").read_text(encoding="utf-8").splitlines()]
ENTRIES = [line for line in LINES if line and not line.startswith("#")]
PIN = re.compile(r"[A-Za-z0-9_.-]+==[A-Za-z0-9_.!+]+( ; .+)?")


def pins():
    """The pinned requirement of each package, by the package's name."""
    return {canonicalize_name(pin.name): pin for pin in map(Requirement, ENTRIES[: -len(PACKAGES)])}


def version(pin):
    return next(iter(pin.specifier)).version


def direct():
    """What our packages and the tests say they need, with their extras, of the packages of others."""
    needed = []
    for path in [ROOT, *(ROOT / "lib" / package for package in PACKAGES)]:
        written = tomllib.loads((path / "pyproject.toml").read_text(encoding="utf-8"))
        project = written["project"]
        needed += project["dependencies"]
        groups = [*project.get("optional-dependencies", {}).values(), *written.get("dependency-groups", {}).values()]
        needed += [line for group in groups for line in group]
    return sorted({line for line in needed if Requirement(line).name not in PACKAGES})


def test_the_environment_pins_exactly_and_ends_with_the_library():
    pinned, ours = ENTRIES[: -len(PACKAGES)], ENTRIES[-len(PACKAGES) :]
    assert sorted(ours) == [f"-e lib/{package}" for package in PACKAGES]
    assert [line for line in pinned if not PIN.fullmatch(line)] == []
    assert len(pins()) == len(pinned), "a package is pinned twice"


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
