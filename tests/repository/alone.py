"""Prove that each package can be released: ``python tests/repository/alone.py [--into FOLDER] [PACKAGE ...]``.

Of each (all without names) a source archive is made, and from that a wheel, which must hold every file of the package.
The wheel gets a fresh environment, without pip's cache, with those of ours on which it says that it stands, as wheels,
and what its tests need; there its examples and its own folder of tests are run. Installed from the source archive it
must be the same files. One line says what came of each. With a folder, what was made is left there.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import tomllib
import venv
import zipfile
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


def made(package: str, made_in: Path, ending: str = ".whl") -> Path:
    """The wheel of a package, or with another ending its source archive, in the folder where they were made."""
    (file,) = made_in.glob(f"{package.replace('-', '_')}-[0-9]*{ending}")
    return file


def asked_for(package: str, made_in: Path) -> list[str]:
    """Return what pip is asked to install for a package."""
    extras = f"[{EXTRAS[package]}]" if package in EXTRAS else ""
    ours = [f"{made(one, made_in)}{extras if one == package else ''}" for one in sorted(stands_on(package))]
    return ["pytest", "hypothesis", *OTHERS.get(package, []), *ours]


def environment(folder: Path) -> Path:
    """Make an environment in a folder, and return its Python."""
    venv.create(folder, with_pip=True)
    folder.chmod(0o755)  # where root runs this, the jail's user must read the libraries
    return folder / ("Scripts" if os.name == "nt" else "bin") / "python"


def run(command: list, **options) -> subprocess.CompletedProcess:
    """Run a command with nothing of this environment and of what pip has kept."""
    surroundings = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | {
        "PIP_NO_CACHE_DIR": "1"
    }
    options |= {"cwd": ROOT, "env": surroundings, "capture_output": True, "encoding": "utf-8", "errors": "replace"}
    return subprocess.run(command, **options)


def make(packages: set[str], made_in: Path) -> str:
    """Make source archives and, from those, wheels in a folder; return what is wrong with them."""
    with tempfile.TemporaryDirectory(prefix="build-") as folder:
        python = environment(Path(folder))
        steps = [[python, "-m", "pip", "install", "--quiet", "build"]]
        steps += [[python, "-m", "build", "--outdir", made_in, LIB / package] for package in sorted(packages)]
        for step in steps:
            if (ended := run(step)).returncode:
                return f"{ended.stdout[-5000:]}{ended.stderr[-5000:]}"
    owners: dict[str, str] = {}
    for package in sorted(packages):
        inside = {name for name in zipfile.ZipFile(made(package, made_in)).namelist() if ".dist-info/" not in name}
        licences = {path.name for path in (LIB / package).glob("LICENSE*")}
        info = zipfile.ZipFile(made(package, made_in)).namelist()
        kept = {
            path.relative_to(LIB / package).as_posix()
            for path in (LIB / package).rglob("*")
            if path.is_file() and path.parent != LIB / package and not {"__pycache__", ".mypy_cache"} & {*path.parts}
        }
        if inside != kept:
            return f"the wheel of {package} has other files than its folder: {sorted(inside ^ kept)[:5]}"
        if missing := licences - {Path(name).name for name in info if "/licenses/" in name}:
            return f"the wheel of {package} is without {', '.join(sorted(missing))}"
        if both := inside & {*owners}:
            return f"{package} and {owners[min(both)]} both have {min(both)}"
        owners |= dict.fromkeys(inside, package)
    return ""


def prove(package: str, folder: Path, made_in: Path) -> str:
    """What is wrong with a package in an environment of its own in a folder; nothing if all is well."""
    if not (ROOT / TESTS[package]).is_dir():
        return f"there is no folder {TESTS[package]}"
    python = environment(folder)
    pins = (ROOT / "environment.txt").read_text(encoding="utf-8").splitlines()
    constraints = folder / "constraints.txt"
    constraints.write_text("\n".join(line for line in pins if not line.startswith("-e")), encoding="utf-8")
    pytest = [python, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--confcutdir=tests", "-o", "addopts="]
    steps = {
        "pip": [python, "-m", "pip", "install", "--quiet", "--constraint", constraints, *asked_for(package, made_in)],
        "what it needs": [python, "-m", "pip", "check"],
        "tests": [*pytest, "-o", f"pythonpath=tests {TESTS[package]}", TESTS[package]],
    }
    if package != "loopbook-books":  # whose modules are within loopbook
        steps["examples"] = [*pytest, "--doctest-modules", "--pyargs", package]
    source = made(package, made_in, ".tar.gz")
    again = folder / "again"
    steps["source"] = [
        python,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-deps",
        "--no-compile",
        "--target",
        again,
        source,
    ]
    for name, command in steps.items():
        if (ended := run(command)).returncode:
            return f"{name} failed\n{ended.stdout[-5000:]}{ended.stderr[-5000:]}"
    wheel = zipfile.ZipFile(made(package, made_in))
    held = [name for name in wheel.namelist() if ".dist-info/" not in name]
    other = [name for name in held if (again / name).read_bytes() != wheel.read(name)]
    return f"the source archive installs other files than the wheel: {other[:5]}" if other else ""


def main(packages: list[str], into: Path | None) -> bool:
    """Print a line for each package; return whether something is wrong."""
    if unknown := {*packages} - {*TESTS}:
        sys.exit(f"there is no package {', '.join(sorted(unknown))}: expected some of {', '.join(TESTS)}")
    wrong = False
    with tempfile.TemporaryDirectory(prefix="made-") as elsewhere:
        made_in = into or Path(elsewhere)
        made_in.mkdir(parents=True, exist_ok=True)
        if list(made_in.glob("*")):
            sys.exit(f"{made_in} is not empty")
        if why := make(set().union(*map(stands_on, packages or TESTS)), made_in):
            sys.exit(why)
        for package in packages or TESTS:
            with tempfile.TemporaryDirectory(prefix="alone-") as folder:
                why = prove(package, Path(folder), made_in)
            wrong = wrong or bool(why)
            print(f"{package}: {why or 'passes alone, from its wheel and from its source archive'}", flush=True)
    return wrong


if __name__ == "__main__":
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("packages", nargs="*", metavar="PACKAGE")
    asked.add_argument("--into", type=Path, metavar="FOLDER")
    sys.exit(main(**vars(asked.parse_args())))
