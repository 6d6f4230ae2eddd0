"""Pyodide, the Python that runs in a browser: which files it consists of, and where they come from.

A page fetches them from Pyodide's public address. A site for people without a network holds them itself; `place` puts
them there, and believes nobody what a file's content is.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import urllib.request
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

VERSION = "0.27.7"
#: The address of the parts, for the pages of a site that does not hold them itself.
CDN = f"https://cdn.jsdelivr.net/pyodide/v{VERSION}/full/"
#: What this Python is, for compiled wheels.
PYTHON = "3.12"
#: The list of the parts as Pyodide's authors publish it; its own hash is in pyodide.json as that of every part.
LOCK = "pyodide-lock.json"
#: A minute without a byte is a network that does not answer (s).
PATIENCE = 60


class MissingError(Exception):
    """A part is not available."""


@dataclass(frozen=True)
class Part:
    """A file of Pyodide: its name, its size and its SHA-256."""

    name: str
    bytes: int
    sha256: str

    def is_at(self, path: Path) -> bool:
        """Whether the file at a path is this one."""
        return path.is_file() and path.stat().st_size == self.bytes and digest(path.read_bytes()) == self.sha256


def digest(content: bytes) -> str:
    """Return the SHA-256 of a content as text.

    >>> digest(b"")[:8]
    'e3b0c442'
    """
    return hashlib.sha256(content).hexdigest()


def known() -> dict[str, Part]:
    """Return the parts by their names: those of Python itself, and the compiled packages that the collection uses.

    >>> known()["pyodide.asm.wasm"].bytes
    10105545
    """
    stored = json.loads(Path(__file__).with_name("pyodide.json").read_text(encoding="utf-8"))
    return {name: Part(name, **rest) for name, rest in stored.items()}


def wheel(package: str) -> str:
    """Return the name of the file that holds a package. Raises KeyError for one that is no part.

    >>> wheel("numpy")
    'numpy-2.0.2-cp312-cp312-pyodide_2024_0_wasm32.whl'
    """
    for name in known():
        if name.partition("-")[0].lower().replace("_", "-") == package and name.endswith((".whl", ".zip")):
            return name
    raise KeyError(f"{package!r} is no part of Pyodide {VERSION} that pyodide.json lists")


def place(names: Iterable[str], folder: Path, source: Path | None = None) -> None:
    """Put parts into a folder; what is there already and is the right content stays.

    Arguments:
        names: of the parts.
        folder: where they are wanted; it is made.
        source: a folder with the parts. If not given, they come from `CDN`.
    Raises:
        MissingError: a part is not there, cannot be reached or is not what it should be.
    """
    parts = known()
    folder.mkdir(parents=True, exist_ok=True)
    for part in (parts[name] for name in names):
        target = folder / part.name
        if part.is_at(target):
            continue
        if source is None:
            target.write_bytes(_fetched(part))
        elif (source / part.name).is_file():
            shutil.copyfile(source / part.name, target)
        else:
            raise MissingError(f"{part.name} is not in {source}: expected the parts of Pyodide {VERSION} there")
        if not part.is_at(target):
            target.unlink()
            raise MissingError(f"{part.name} from {source or CDN} has another SHA-256 than the published one")


def _fetched(part):
    try:
        with urllib.request.urlopen(CDN + part.name, timeout=PATIENCE) as response:
            return response.read()
    except OSError as error:
        raise MissingError(
            f"{part.name} cannot be fetched from {CDN} ({error}): "
            f"get the parts of Pyodide {VERSION} elsewhere and name their folder, as PARTS=FOLDER"
        ) from None
