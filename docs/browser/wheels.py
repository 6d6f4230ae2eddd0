"""Wheels of packages in pure Python, made of what is installed here: without a network, and in our versions."""

from __future__ import annotations

import base64
import hashlib
import zipfile
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from packaging.utils import canonicalize_name

#: What no reader imports.
LEFT_OUT = {"__pycache__", "tests", "benchmarks"}
LIBRARY = Path(__file__).parents[2] / "lib"
#: What the wheel of loopbook holds in a page: all but the grader.
OURS = ("plainmath", "bookledger", "exercisebook", "loopbook", "loopbook-books")
#: A fixed time, so that the same content is the same file.
EPOCH = (1980, 1, 1, 0, 0, 0)


def filename(package: str) -> str:
    """Return the name of a package's wheel, with the version that is installed.

    >>> filename("mpmath").startswith("mpmath-1.")
    True
    """
    return f"{canonicalize_name(package).replace('-', '_')}-{metadata.version(package)}-py3-none-any.whl"


def make(package: str, folder: Path) -> Path:
    """Write the wheel of an installed package in pure Python, without its tests, and return its path.

    Arguments:
        package: its name.
        folder: for the wheel; it is made.
    Raises:
        ValueError: the package holds compiled code.
    """
    members = dict(sorted(_of_library() if package == "loopbook" else _installed(package)))
    if compiled := [name for name in members if name.endswith((".so", ".pyd", ".dylib"))]:
        raise ValueError(f"{package} holds compiled code, as {compiled[0]}: expected pure Python")
    about = f"{filename(package).removesuffix('-py3-none-any.whl')}.dist-info"
    members[f"{about}/RECORD"] = _record(members, about)
    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / filename(package)
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name, EPOCH), content, zipfile.ZIP_DEFLATED)
    return wheel


def _installed(package) -> Iterator[tuple[str, bytes]]:
    """The files of a package as its own record lists them: pairs of a name and a content."""
    for file in metadata.files(package) or ():
        if not LEFT_OUT & set(file.parts) and ".." not in file.parts and file.name not in ("RECORD", "INSTALLER"):
            yield file.as_posix(), file.read_binary()


def _of_library():
    """The same of our own packages, which are installed as references to their sources: a page fetches one file."""
    for package in OURS:
        for path in (LIBRARY / package).rglob("*"):
            if path.is_file() and path.name != "pyproject.toml" and not LEFT_OUT & set(path.parts):
                yield "/".join(path.relative_to(LIBRARY).parts[1:]), path.read_bytes()
    about = f"loopbook-{metadata.version('loopbook')}.dist-info"
    for name, content in _installed("loopbook"):
        if ".dist-info/" in name and not name.endswith("direct_url.json"):
            yield name, content
    for name, content in _installed("loopbook-books"):
        if name.endswith("/entry_points.txt"):  # a wheel has one folder of this kind
            yield f"{about}/entry_points.txt", content


def _record(members, about):
    """The list of files that a wheel holds about itself."""
    lines = []
    for name, content in members.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}")
    return "\n".join([*lines, f"{about}/RECORD,,", ""]).encode()
