"""Prove that each package stands alone: ``python tests/repository/alone.py [PACKAGE ...]``, without names all of them.

Each gets a fresh environment in a temporary folder, with the package, those of ours on which it says that it stands,
and what its tests need; there its examples and its own folder of tests are run. One line says what came of each.
"""

import os
import subprocess
import sys
import tempfile
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).parents[2]
LIB = ROOT / "lib"
#: The folder of each package's tests.
TESTS = {
    "plainmath": "tests/plainmath",
    "bookledger": "tests/bookledger",
    "exercisebook": "tests/exercisebook",
    "exercisegrader": "tests/exercisegrader",
    "loopbook": "tests/control_engineering",
    "loopbook-books": "tests/books",
}
#: What is installed with each, besides pytest and hypothesis: extras of its own, and packages of others.
EXTRAS = {"bookledger": "pytest", "loopbook": "certified,diagrams", "loopbook-books": "lab"}
OTHERS = {
    "bookledger": ["ipykernel", "nbclient"],
    "exercisebook": ["control", "ipython", "matplotlib"],
    "exercisegrader": ["control"],
    "loopbook": ["control"],
    "loopbook-books": ["control"],
}


def stands_on(package: str) -> set[str]:
    """Return those of our packages that a package needs, itself among them.

    >>> sorted(stands_on("loopbook"))
    ['loopbook', 'plainmath']
    """
    project = tomllib.loads((LIB / package / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = {line.partition("==")[0].partition("[")[0] for line in project["dependencies"]} & {*TESTS}
    return {package}.union(*map(stands_on, named))


def asked_for(package: str) -> list[str]:
    """Return what pip is asked to install for a package.

    >>> [Path(one).name for one in asked_for("plainmath")]
    ['pytest', 'hypothesis', 'plainmath']
    """
    extras = f"[{EXTRAS[package]}]" if package in EXTRAS else ""
    ours = [f"{LIB / one}{extras if one == package else ''}" for one in sorted(stands_on(package))]
    return ["pytest", "hypothesis", *OTHERS.get(package, []), *ours]


def prove(package: str, folder: Path) -> str:
    """What is wrong with a package in an environment of its own in a folder; nothing if all is well."""
    if not (ROOT / TESTS[package]).is_dir():
        return f"there is no folder {TESTS[package]}"
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    pins = (ROOT / "environment.txt").read_text(encoding="utf-8").splitlines()
    constraints = folder / "constraints.txt"
    constraints.write_text("\n".join(line for line in pins if not line.startswith("-e")), encoding="utf-8")
    pytest = [python, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--confcutdir=tests", "-o", "addopts="]
    steps = {
        "pip": [python, "-m", "pip", "install", "--quiet", "--constraint", constraints, *asked_for(package)],
        "tests": [*pytest, "-o", f"pythonpath=tests {TESTS[package]}", TESTS[package]],
    }
    if package != "loopbook-books":  # whose modules are within loopbook
        steps["examples"] = [*pytest, "--doctest-modules", "--pyargs", package]
    surroundings = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    for name, command in steps.items():
        ended = subprocess.run(
            command, cwd=ROOT, env=surroundings, capture_output=True, encoding="utf-8", errors="replace"
        )
        if ended.returncode:
            return f"{name} failed\n{ended.stdout[-5000:]}{ended.stderr[-5000:]}"
    return ""


def main(packages: list[str]) -> bool:
    """Print a line for each package; return whether something is wrong."""
    if unknown := {*packages} - {*TESTS}:
        sys.exit(f"there is no package {', '.join(sorted(unknown))}: expected some of {', '.join(TESTS)}")
    wrong = False
    for package in packages or TESTS:
        with tempfile.TemporaryDirectory(prefix="alone-") as folder:
            why = prove(package, Path(folder))
        wrong = wrong or bool(why)
        print(f"{package}: {why or 'passes alone'}", flush=True)
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
