"""A limit for the time that a computation may take, on every system and in every thread."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any, TypeVar

_Found = TypeVar("_Found")


class TooSlow(BaseException):
    """The computation took longer than it may."""


def limited(seconds: float, function: Callable[..., _Found], *arguments: Any) -> _Found:
    """Return ``function(*arguments)``, which may take that many seconds.

    The computation runs in a thread of its own, which is stopped at its next step in Python when the time is over.

    Raises:
        TimeoutError: when the time is over.
        Exception: whatever the function raises; RuntimeError for what would end the program, as SystemExit.

    >>> limited(1, max, 2, 3)
    3
    """
    result, failure = [], []

    def work():
        try:
            result.append(function(*arguments))
        except TooSlow:
            pass
        except Exception as error:
            failure.append(error)
        except BaseException as error:
            failure.append(RuntimeError(f"stopped by {type(error).__name__}"))

    worker = threading.Thread(target=work, daemon=True)
    worker.start()
    worker.join(seconds)
    if worker.is_alive():
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(worker.ident), ctypes.py_object(TooSlow))
        raise TimeoutError(f"not done after {seconds:g} s")
    if failure:
        raise failure[0]
    return result[0]
