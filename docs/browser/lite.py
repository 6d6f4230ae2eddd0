"""JupyterLite in the site: every chapter and its solutions as a notebook that runs in the page.

JupyterLite's own command makes the application; what the collection adds lies in docs/jupyterlite: ``python.mjs``
(Python with all packages, which no notebook has to install), ``door.js`` (the line above a notebook, and the service
worker's place) and ``service-worker.js`` (what was loaded once is there without a network).

Only the application of single notebooks is kept, and the list of them, because that one suits a phone as well.
"""

import contextlib
import importlib.metadata
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import nbformat
from nbformat.v4.rwbase import rejoin_lines

from . import runtime, wheels

ROOT = Path(__file__).resolve().parents[2]
DOOR = ROOT / "docs" / "jupyterlite"
DARK = ROOT / "docs" / "jupyterlab" / "custom.css"
FOLDERS = ("chapters", "solutions")
#: Where JupyterLite is made, to be copied into each site that is made; git ignores the folder.
CACHE = ROOT / "build" / "jupyterlite"
#: Its place on the site; docs/extensions/launch.py leads there.
PLACE = "lite"
APPS = ("notebooks", "tree")
MADE_WITH = ("jupyterlite-core", "jupyterlite-pyodide-kernel", "jupyterlab-widgets", "jupyterlab-pygments")
#: What a site has no use for: how JupyterLite is made and documented, and wheels that `PURE` and python.mjs replace.
SUPERFLUOUS = (
    "doc", "rspack.*", "package.json", "jupyterlite.schema.v0.json", "extensions/**/*.orig",
    "extensions/**/install.json", "extensions/**/pypi/piplite-*", "extensions/**/pypi/widgetsnbextension-*",
)  # fmt: skip

EXTENSION = "@jupyterlite/pyodide-kernel-extension"
#: What the kernel need not install, because python.mjs has loaded it or goes without.
LOADED = ("micropip", "piplite", "ipykernel", "comm", "pyodide-kernel", "jedi", "ipython")
#: The packages of Pyodide that a notebook needs, and those in pure Python that are made of what is installed here.
COMPILED = (
    "asttokens", "contourpy", "cycler", "decorator", "executing", "ipython", "jedi", "kiwisolver", "matplotlib",
    "matplotlib-inline", "numpy", "openblas", "packaging", "parso", "pillow", "prompt-toolkit", "pure-eval",
    "pygments", "pyparsing", "python-dateutil", "scipy", "six", "sqlite3", "stack-data", "traitlets", "wcwidth",
)  # fmt: skip
PURE = (
    "comm", "control", "flexcache", "flexparser", "ipywidgets", "lark", "latex2mathml", "loopbook", "markdown-it-py",
    "mdurl", "mpmath", "pint", "platformdirs", "schemdraw", "sympy", "typing-extensions",
)  # fmt: skip
OWN = ("ipykernel", "pyodide-kernel")  # JupyterLite's
PYTHON = ("pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip")

#: What a page of JupyterLite does instead of starting it.
OPENED = """if (location.protocol === 'file:') {
          document.addEventListener('DOMContentLoaded', () => {
            document.body.textContent = 'A notebook runs only on the pages of a web server, and this is a file: ' +
              'a browser lets no file start Python. "python -m http.server" in the folder of the site makes it one.';
          });
          return;
        }
        await import('../door.js');"""

SETTINGS = {
    "@jupyter-notebook/application-extension:top": {"visible": "no"},  # its place has the line of door.js
    "@jupyterlab/apputils-extension:themes": {"adaptive-theme": True},
    "@jupyterlab/docmanager-extension:plugin": {"autosaveInterval": 10},
}
DISABLED = (
    "@jupyterlab/apputils-extension:announcements",
    "@jupyter-notebook/notebook-extension:kernel-logo",
    "@jupyter-notebook/notebook-extension:trusted",
    "@jupyterlite/application-extension:share-file",
    "@jupyterlite/notebook-application-extension:logo",
)


def write(site: Path, offline: bool = False, source: str | Path | None = None) -> None:
    """Write JupyterLite into a site.

    Arguments:
        site: its folder.
        offline: whether the site holds Pyodide itself, in runtime/.
        source: a folder with Pyodide's parts, for a site that holds them; if not given, they are fetched.
    Raises:
        runtime.MissingError: a part of Pyodide is not available.
        subprocess.CalledProcessError: JupyterLite cannot be made; its own words are in ``stdout`` and ``stderr``.
    """
    made = _made()
    shutil.rmtree(site / PLACE, ignore_errors=True)
    shutil.copytree(made, site / PLACE)
    home = "../runtime/" if offline else runtime.CDN
    theirs = {package: runtime.known()[runtime.wheel(package)] for package in COMPILED}
    if offline:
        names = [*PYTHON, *(part.name for part in theirs.values())]
        runtime.place(names, site / "runtime", Path(source) if source else None)
    packages = {package: _entry(package, home + part.name, part.sha256) for package, part in theirs.items()}
    packages["scipy"]["depends"] = ["openblas"]
    size = sum(runtime.known()[name].bytes for name in PYTHON) + sum(part.bytes for part in theirs.values())
    ours = {package: _wheel(package, site / "wheels") for package in PURE}
    ours |= {package: next((site / PLACE).glob(f"extensions/**/{package.replace('-', '_')}-*.whl")) for package in OWN}
    for package, path in ours.items():
        packages[package] = _entry(package, _relative(path, site / PLACE), runtime.digest(path.read_bytes()))
        size += path.stat().st_size
    info = {"arch": "wasm32", "platform": "emscripten", "python": runtime.PYTHON, "version": runtime.VERSION}
    listed = {"info": info, "packages": packages, "runtime": home, "bytes": size}
    listed["version"] = runtime.digest(json.dumps(listed, sort_keys=True).encode())[:12]
    (site / PLACE / "python.json").write_text(json.dumps(listed, indent=1), encoding="utf-8")


def _wheel(package, folder):
    """A wheel of the site; it may have been made a moment ago, for the exercises."""
    there = folder / wheels.filename(package)
    return there if there.exists() else wheels.make(package, folder)


def _entry(package, address, sha256):
    """What Pyodide wants to know of a package; what depends on what it need not know, since all are loaded."""
    library = address.endswith(".zip")
    return {
        "name": package, "version": re.split("-|.zip", address.rpartition("/")[2])[1], "file_name": address,
        "sha256": sha256, "install_dir": "dynlib" if library else "site",
        "package_type": "shared_library" if library else "package", "imports": [], "depends": [],
    }  # fmt: skip


def _relative(path, folder):
    """A path as it is seen from a folder beside it or above it."""
    return path.relative_to(folder).as_posix() if folder in path.parents else f"../{path.relative_to(folder.parent)}"


def _made() -> Path:
    """The folder with JupyterLite as it is copied into a site: made again only when something of it has changed."""
    folder = CACHE / _fingerprint()
    if not folder.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        older = [path for path in CACHE.iterdir() if not path.name.startswith("work")]
        with tempfile.TemporaryDirectory(prefix="work", dir=CACHE) as name:
            work = Path(name)
            _prepare(work)
            command = [sys.executable, "-m", "jupyterlite_core", "build"]
            subprocess.run(command, cwd=work, check=True, capture_output=True, encoding="utf-8")
            _finish(work / "made", folder.name)
            with contextlib.suppress(OSError):  # another process was quicker, with the same
                (work / "made").rename(folder)
        for path in older:
            shutil.rmtree(path, ignore_errors=True)
    return folder


def _fingerprint() -> str:
    """A word for all that JupyterLite is made of."""
    notebooks = [path for name in FOLDERS for path in sorted((ROOT / name).glob("*.ipynb"))]
    inputs = [Path(__file__), DARK, *sorted(DOOR.iterdir()), *notebooks]
    contents = [f"{path.relative_to(ROOT)} {runtime.digest(path.read_bytes())}" for path in inputs]
    versions = [f"{package} {importlib.metadata.version(package)}" for package in MADE_WITH]
    return runtime.digest("\n".join([*contents, *versions]).encode())[:16]


def _prepare(work: Path) -> None:
    """Put into a folder what JupyterLite's command is to make a site of."""
    for name in FOLDERS:
        (work / "contents" / name).mkdir(parents=True)
        for path in (ROOT / name).glob("*.ipynb"):
            (work / "contents" / name / path.name).write_text(_of_lite(path), encoding="utf-8")
    options = {"packages": list(LOADED), "packagesURL": "./python.json"}
    kernel = {"pyodideUrl": "./python.mjs", "disablePyPIFallback": True, "loadPyodideOptions": options}
    config = {
        "appName": "loopbook", "appUrl": "./tree", "exposeAppInBrowser": True, "disabledExtensions": list(DISABLED),
        "settingsOverrides": SETTINGS, "litePluginSettings": {f"{EXTENSION}:kernel": kernel},
    }  # fmt: skip
    settings = {
        "apps": list(APPS), "contents": ["contents"], "output_dir": "made", "cache_dir": "cache",
        "no_sourcemaps": True, "no_unused_shared_packages": True,
    }  # fmt: skip
    files = {
        "jupyter-lite.json": {"jupyter-lite-schema-version": 0, "jupyter-config-data": config},
        "jupyter_lite_config.json": {"LiteBuildConfig": settings},
    }
    for name, content in files.items():
        (work / name).write_text(json.dumps(content), encoding="utf-8")


def _of_lite(path: Path) -> str:
    """A notebook as JupyterLite writes it: it takes any other form for a reader's change."""
    notebook = rejoin_lines(nbformat.from_dict(json.loads(path.read_text(encoding="utf-8"))))
    notebook["metadata"]["kernelspec"] = {"display_name": "Python (Pyodide)", "language": "python", "name": "python"}
    return json.dumps(notebook, ensure_ascii=False)


def _finish(made: Path, fingerprint: str) -> None:
    """Take away what a site has no use for, and put the door before the applications."""
    for pattern in SUPERFLUOUS:
        for path in sorted(made.glob(pattern)):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    (made / "service-worker.js").rename(made / "jupyterlite-service-worker.js")
    for path in DOOR.iterdir():
        shutil.copy(path, made)
    with (made / "door.css").open("a", encoding="utf-8") as style:
        style.write(DARK.read_text(encoding="utf-8"))
    _replace(made / "service-worker.js", {'"VERSION"': f'"{fingerprint}"'})
    for app in APPS:
        version = importlib.metadata.version("jupyterlite-core")
        changes = {
            "<html>": f'<html lang="en" data-version="{version}">',
            "</title>": '</title>\n    <link rel="stylesheet" href="../door.css">',
            r"await import\(\s*'\.\./config-utils\.js[^']*'\s*\);": OPENED,
        }
        _replace(made / app / "index.html", changes)


def _replace(path: Path, changes: Mapping[str, str]) -> None:
    """Replace in a file what some patterns match, each of them once."""
    text = path.read_text(encoding="utf-8")
    for pattern, instead in changes.items():
        text, count = re.subn(pattern, lambda _, instead=instead: instead, text)
        if count != 1:
            raise ValueError(f"JupyterLite's {path.name} has {pattern} {count} times: expected it once")
    path.write_text(text, encoding="utf-8")
