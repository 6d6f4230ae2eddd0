"""What exercises remember of a reader: small files of JSON beside the notebook."""

from __future__ import annotations

import contextlib
import contextvars
import json
import os
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

#: A larger file is none that was written here.
LARGEST = 10**6
#: Set to "off", this variable of the environment keeps the files from being read and written, as in tests.
SWITCH = "LOOPBOOK_PROGRESS"


_forgetting = contextvars.ContextVar("_forgetting", default=False)


def are_off() -> bool:
    """Whether nothing is remembered."""
    return _forgetting.get() or os.environ.get(SWITCH) == "off"


@contextlib.contextmanager
def off() -> Iterator[None]:
    """Remember nothing for a while, and read no file.

    >>> with off():
    ...     are_off()
    True
    """
    before = _forgetting.set(True)
    try:
        yield
    finally:
        _forgetting.reset(before)


def read(file: Path, key: str, valid: Callable[[Any], bool], otherwise: str) -> Any:
    """Return what a file says under a key, or None without a file. A damaged one is ignored, with a warning.

    Arguments:
        file: in the folder of the notebook.
        key: the one of the file's table.
        valid: whether a value can be what was written.
        otherwise: what the warning says besides.
    """
    if are_off() or not os.path.lexists(file):
        return None
    try:
        if not file.is_file() or file.stat().st_size > LARGEST:
            raise ValueError("no file, or a very large one")
        stored = json.loads(file.read_text(encoding="utf-8-sig"))[key]
        if not valid(stored):
            raise ValueError("not what was written")
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        warnings.warn(f"{file} is damaged and ignored; {otherwise}", stacklevel=4)
        return None
    return stored


def write(file: Path, key: str, value: Any, what: str) -> None:
    """Replace a file in one step, so that an interruption leaves the old one or the new one.

    Where that fails, a warning says `what` cannot be stored.
    """
    target = file.resolve() if file.is_file() else file  # where a link leads
    partial = target.with_name(f"{target.name}.{os.getpid()}")
    try:
        partial.write_text(json.dumps({key: value}, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        partial.replace(target)
    except OSError as problem:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        warnings.warn(f"{what} cannot be stored in {file}: {problem.strerror}", stacklevel=5)
