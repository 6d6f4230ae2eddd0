"""The submission, the last of three roles: the process in which a student's code runs, and all that it starts.

It limits itself, gives up every right, and only then reads the notebook.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NoReturn

from exercisegrader.inside import confinement

if TYPE_CHECKING:
    import ctypes

    from IPython.core.interactiveshell import InteractiveShell


def run(
    shell: InteractiveShell,
    call_filter: tuple[ctypes.CDLL, int] | None,
    limits: Mapping[str, float],
    size: int | None,
    notebook: int,
    events: int,
    folder: str,
) -> NoReturn:
    """Be the submission's first process: run the notebook with nothing else in reach, and end.

    Arguments:
        shell, call_filter, limits, notebook, events: as `guard.watch_over` has them.
        size: of the address space that it begins with (bytes).
        folder: where it may write.
    """
    try:
        os.setsid()
        os.dup2(notebook, 3)
        os.dup2(events, 4)
        os.closerange(5, os.sysconf("SC_OPEN_MAX"))
        nothing = os.open(os.devnull, os.O_RDWR)
        for standard in range(3):
            os.dup2(nothing, standard)
        os.close(nothing)
        os.chdir(folder)
        confinement.limit(limits, size, jailed=bool(call_filter))
        if call_filter:
            confinement.surrender(call_filter)
        with open(3, "rb") as file:
            content = file.read()
    except BaseException as problem:
        tell(4, {"refused": f"no process could be made for it ({type(problem).__name__}: {problem})"})
        os._exit(1)
    try:
        from exercisegrader.inside import shell as runner  # which the fork server has imported, and the grader has not

        first = os.getpid()

        def tell_one(event):
            if os.getpid() == first:  # a copy of it, which it forked, runs on through the same cells
                tell(4, event)

        runner.run(content, shell, tell_one, limits["cell"], limits["show"])
    finally:
        os._exit(0)


def tell(descriptor: int, event: dict[str, Any]) -> None:
    """Write an event, as a line of JSON."""
    line = json.dumps(event, allow_nan=False).encode() + b"\n"
    while line:
        line = line[os.write(descriptor, line) :]
