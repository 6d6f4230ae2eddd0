"""A limit for the time that a computation may take, on every system and in every thread."""

from __future__ import annotations

import ctypes
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, TypeVar

_Found = TypeVar("_Found")

#: A computation ends, too, when it has slept, or waited for something, for so many times its limit.
WAITING = 4
#: Who has less than this part of a processor waits for something else than the processor, however busy the machine is.
_IDLE = 0.1
#: How often (s) the time is looked at.
_LOOK = 0.25
#: A browser's Python has one thread, and the page ends it where it takes too long.
HAS_THREADS = sys.platform != "emscripten"


class TooSlow(BaseException):
    """The computation took longer than it may."""


def limited(seconds: float, function: Callable[..., _Found], *arguments: Any) -> _Found:
    """Return ``function(*arguments)``, which may take that many seconds of this process.

    What counts is the processor's time, so that a busy machine changes no result. The computation runs in a thread of
    its own, which is stopped at its next step in Python when the time is over. In a browser there are no threads: there
    it runs to its end, and whoever shows the page ends all of Python.

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

    if HAS_THREADS:
        _in_time(seconds, work)
    else:
        work()
    if failure:
        raise failure[0]
    return result[0]


def _in_time(seconds, work):
    """Run the work in a thread, and stop it when the time is over."""
    worker = threading.Thread(target=work, daemon=True)
    worker.start()
    worked = waited = 0.0
    while worker.is_alive() and worked < seconds and waited < WAITING * seconds:
        began, clock = time.process_time(), time.monotonic()
        worker.join(min(_LOOK, seconds))
        work, passed = time.process_time() - began, time.monotonic() - clock
        worked += work
        waited += passed if work < _IDLE * passed else 0
    if worker.is_alive():
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(worker.ident), ctypes.py_object(TooSlow))
        raise TimeoutError(f"not done after {seconds:g} s")
