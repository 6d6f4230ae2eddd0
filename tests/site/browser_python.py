"""Python in the browser for the tests, without a browser: Pyodide in node, with the collection and what it needs."""

import json
import os
import pickle
import shutil
import subprocess
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from docs.browser import wheels

import browser_runtime

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
#: Pyodide's own packages: those that are compiled, and what a notebook runs in.
PACKAGES = ["numpy", "scipy", "matplotlib", "pillow", "ipython", "sqlite3"]
#: Those in pure Python, in the versions that are installed here, and ours in the wheel of a page.
PURE = [
    "sympy", "mpmath", "pint", "flexcache", "flexparser", "platformdirs", "typing-extensions", "schemdraw", "control",
    "lark", "latex2mathml", "markdown-it-py", "mdurl", "ipywidgets", "comm", "loopbook",
]  # fmt: skip
PROGRAM = """
import sys, logging, pathlib, zipfile
logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)  # it says that it looks for fonts
for wheel in pathlib.Path("/order/wheels").glob("*.whl"):
    zipfile.ZipFile(wheel).extractall("/wheels")
sys.path[:0] = ["/tests", "/wheels"]
import in_browser
in_browser.perform(pathlib.Path("/order/jobs"), pathlib.Path("/order/results"))
"""


def required() -> Path:
    """Return the folder with Pyodide's parts; where these or node are not there, skip loudly, or fail with CI set."""
    if shutil.which("node") is None:
        missing = "no node: nothing was proved of Python in the browser"
        if os.environ.get("CI"):
            pytest.fail(missing)
        warnings.warn(pytest.PytestWarning(missing), stacklevel=2)
        pytest.skip(missing)
    return browser_runtime.required()


def performed(jobs: Sequence[tuple[str, Any]], parts: Path, folder: Path, seconds: float = 3600) -> list[dict]:
    """Let Pyodide do jobs, pairs of a word of `in_browser.DOES` and what it is about, and return what it says to each.

    Arguments:
        parts: the folder with Pyodide.
        folder: for what is exchanged.
        seconds: after which it has failed.
    Returns:
        For each job a dictionary with what was found, "is", or the "error", and the "seconds" that it took.
    """
    with (folder / "jobs").open("wb") as file:
        pickle.dump(list(jobs), file, protocol=4)
    for package in PURE:
        wheels.make(package, folder / "wheels")
    order = {
        "parts": str(parts),
        "packages": PACKAGES,
        "folders": {"/tests": str(HERE), "/chapters": str(ROOT / "chapters"), "/solutions": str(ROOT / "solutions"),
                    "/order": str(folder)},
        "environment": {"HOME": "/home/pyodide", "MPLBACKEND": "agg", "LOOPBOOK_PROGRESS": "off"},
        "program": PROGRAM,
    }  # fmt: skip
    (folder / "order.json").write_text(json.dumps(order), encoding="utf-8")
    command = ["node", str(HERE / "node" / "pyodide_runner.mjs"), str(folder / "order.json")]
    run = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=seconds)
    results = folder / "results"
    lines = results.read_text(encoding="utf-8").splitlines() if results.exists() else []
    if run.returncode or len(lines) != len(jobs):
        raise RuntimeError(f"Pyodide did {len(lines)} of {len(jobs)} jobs: {run.stdout[-1000:]}{run.stderr[-3000:]}")
    return list(map(json.loads, lines))
