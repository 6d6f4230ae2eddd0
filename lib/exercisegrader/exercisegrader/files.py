"""Files that are whole at any moment: an interruption leaves the old one or the new one."""

from __future__ import annotations

import contextlib
import errno
import os
from typing import TYPE_CHECKING

from exercisegrader import GradingError

if TYPE_CHECKING:
    from pathlib import Path


def write(path: Path, content: str | bytes) -> bool:
    """Make a text, or bytes, the content of a file, in one step; the folders on the way are made.

    Returns whether that changed the file: the same bytes are not written again. Raises GradingError where the file
    cannot be written.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "new", "grades.csv")
    ...     write(path, "a,b"), write(path, "a,b")
    (True, False)
    """
    content = content.encode() if isinstance(content, str) else content
    partial = path.with_name(f".{path.name}.partial")
    try:
        if path.is_file() and path.read_bytes() == content:
            return False
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(partial, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # a crash of the machine keeps what was reported as done
        partial.replace(path)
    except OSError as problem:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise GradingError(f"{path} cannot be written: {problem.strerror}") from None
    return True


def append(path: Path, content: bytes) -> None:
    """Write bytes behind what is in a file, all of them or none. Raises GradingError where that is not possible."""
    try:
        with open(path, "ab", buffering=0) as file:
            size = file.tell()
            try:
                if file.write(content) != len(content):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                os.fsync(file.fileno())
            except OSError:
                file.truncate(size)
                raise
    except OSError as problem:
        raise GradingError(f"{path} cannot be written: {problem.strerror}") from None
