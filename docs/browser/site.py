"""The site's own parts of Python: wheels/, the list of what there is, and runtime/ where the site needs no network."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Sequence
from pathlib import Path

from loopbook.exercises.forms import version

from . import runtime, wheels

HERE = Path(__file__).parent
SERVICE = "service-worker.js"
#: The part that every answer needs.
FIRST = "python"
PYTHON = ("pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip", runtime.LOCK)
#: Parts by their names: what a progress bar says, Pyodide's packages, our own packages in pure Python, and the packages
#: whose import asks for the part. "python" comes first, the others when an exercise needs them.
PARTS = {
    "python": (
        "Python with NumPy and SymPy",
        ("numpy",),
        ("loopbook", "sympy", "mpmath", "pint", "flexcache", "flexparser", "platformdirs", "typing-extensions",
         "markdown-it-py", "mdurl", "latex2mathml", "lark"),
        (),
    ),
    "scipy": ("SciPy", ("openblas", "scipy"), (), ("scipy",)),
    "pictures": (
        "Matplotlib",
        ("contourpy", "cycler", "kiwisolver", "matplotlib", "packaging", "pillow", "pyparsing", "python-dateutil",
         "six"),
        ("schemdraw",),
        ("matplotlib", "PIL", "schemdraw"),
    ),
}  # fmt: skip


RUNTIME = "runtime"


def place(names: Sequence[str], site: Path, source: str | Path | None = None) -> None:
    """Put files of Pyodide into a site that is to need no network; take them out of one that may need it.

    Arguments:
        names: of the files; none for a site that may need a network.
        site: its folder.
        source: a folder with the files; if not given, they are fetched.
    Raises:
        runtime.MissingError: a file is not available.
    """
    shutil.rmtree(site / RUNTIME, ignore_errors=True)
    if names:
        runtime.place(dict.fromkeys(names), site / RUNTIME, Path(source) if source else None)


def of_all() -> list[str]:
    """Return the files of Pyodide of which all parts consist."""
    return [name for part in PARTS for name in of_pyodide(part)]


def of_pyodide(part: str) -> list[str]:
    """Return the files of Pyodide that a part consists of, with wheels of its compiled packages."""
    _, compiled, _, _ = PARTS[part]
    return [*(PYTHON if part == FIRST else ()), *map(runtime.wheel, compiled)]


def write(site: Path, offline: bool) -> None:
    """Write into a site the wheels, the list of all parts, and the service worker, which knows the site by its content.

    Arguments:
        site: its folder, finished otherwise.
        offline: whether Pyodide is in it, see `place`.
    """
    folder = site / "wheels"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copyfile(HERE / "judge.py", folder / "judge.py")
    home = f"../{RUNTIME}/" if offline else runtime.CDN
    parts, later = {}, {}
    for name, (says, _, pure, packages) in PARTS.items():
        files = [
            _entry(home + part.name, part.bytes, part.sha256) for part in map(runtime.known().get, of_pyodide(name))
        ]
        files += [_ours(wheels.make(package, folder)) for package in pure]
        files += [_ours(folder / "judge.py")] if name == FIRST else []
        parts[name] = {"says": says, "files": files}
        later |= dict.fromkeys(packages, name)
    listed = {"library": version(), "parts": parts, "later": later}
    parts_version = runtime.digest(json.dumps(listed, sort_keys=True).encode())[:12]
    (folder / "parts.json").write_text(json.dumps({"version": parts_version, **listed}, indent=1), encoding="utf-8")
    worker = (HERE / SERVICE).read_text(encoding="utf-8").replace('"VERSION"', f'"{content(site)}"')
    (site / SERVICE).write_text(worker, encoding="utf-8")


def content(site: Path) -> str:
    """Return a short hash of all that a site consists of.

    Of Pyodide the list of the parts tells the version, and JupyterLite keeps its files by itself.
    """
    found = hashlib.sha256()
    for path in sorted(site.rglob("*")):
        inside = path.relative_to(site)
        if path.is_file() and inside.parts[0] not in (RUNTIME, SERVICE, "lite"):
            found.update(f"{inside.as_posix()} {runtime.digest(path.read_bytes())}\n".encode())
    return found.hexdigest()[:12]


def _entry(url, size, sha256):
    return {"url": url, "bytes": size, "sha256": sha256}


def _ours(path):
    """An entry of a file in wheels/; its address changes with its content."""
    content = path.read_bytes()
    sha256 = runtime.digest(content)
    return _entry(f"{path.name}?{sha256[:12]}", len(content), sha256)
