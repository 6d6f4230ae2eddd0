"""Make a Colab session ready for loopbook: the first cell of each copy that copies.py writes runs this.

Installed are the library and what it stands on, at the versions of environment.txt. What Colab itself runs on (IPython,
ipykernel, ipywidgets, Jupyter) keeps Colab's versions, because a session whose own kernel is replaced breaks: so
environment.txt serves as a list of constraints here, which names versions but asks for nothing.
"""

import importlib
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def constraints(environment):
    """Return the lines of environment.txt that say a version, which is all but our own packages.

    >>> constraints("# the library" + chr(10) + "some-package==7" + chr(10) + "-e lib/loopbook")
    ['some-package==7']
    """
    lines = [line.strip() for line in environment.splitlines()]
    return [line for line in lines if line and not line.startswith(("#", "-"))]


def versions():
    """The version of each installed package."""
    importlib.invalidate_caches()
    return {found.name: found.version for found in metadata.distributions()}


def in_use():
    """The names of the packages of which the running session has already loaded something."""
    owners = metadata.packages_distributions()
    return {owner for module in list(sys.modules) for owner in owners.get(module, ())}


def main():
    """Install, and restart the session if it holds an older version of something that was renewed."""
    before, loaded = versions(), in_use()
    with tempfile.TemporaryDirectory() as folder:
        pins = Path(folder) / "constraints.txt"
        pins.write_text("\n".join(constraints((ROOT / "environment.txt").read_text(encoding="utf-8"))), "utf-8")
        command = ["install", "--quiet", "--disable-pip-version-check", "--constraint", str(pins)]
        command += sorted(str(path.parent) for path in (ROOT / "lib").glob("*/pyproject.toml"))
        subprocess.run([sys.executable, "-m", "pip", *command], check=True)
    after = versions()
    if any(after.get(name) != before.get(name) for name in loaded):
        print("loopbook is installed. The session restarts now, to use it: then run the cells once more.")
        get_ipython().kernel.do_shutdown(restart=True)  # noqa: F821 (IPython's own name, there where %run runs this)
    else:
        print("loopbook is ready.")


if __name__ == "__main__":
    main()
