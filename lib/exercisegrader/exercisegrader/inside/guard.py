"""The guard, the second of three roles: it is between the fork server and one submission.

It moves into namespaces of its own (users, processes, files, network, IPC), covers what was writable, and forks their
first process, the `submission`. It runs no line of a student's.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import tempfile
from collections.abc import Mapping
from typing import TYPE_CHECKING, NoReturn

from exercisegrader.inside import confinement, submission

if TYPE_CHECKING:
    import ctypes

    from IPython.core.interactiveshell import InteractiveShell


def watch_over(
    prepared: tuple[InteractiveShell, tuple[ctypes.CDLL, int] | None],
    limits: Mapping[str, float],
    notebook: int,
    events: int,
    ending: int,
) -> NoReturn:
    """Fork the submission's first process, wait for it, and tell how it ended; SIGTERM ends it.

    Arguments:
        prepared: the shell, and the filter of system calls, which is None where there is no jail.
        limits: those of `jail.Limits`, as a dictionary, and whether to "show" the notebook.
        notebook, events, ending: descriptors: of the notebook, of what it tells, and of how it ended.
    """
    shell, call_filter = prepared
    first = 0

    def end(number, frame):
        with contextlib.suppress(ProcessLookupError):  # it has ended by itself
            os.kill(first, signal.SIGKILL)

    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])  # until there is something to end
    signal.signal(signal.SIGTERM, end)
    folder = confinement.HOME if call_filter else tempfile.mkdtemp(prefix="loopbook-")
    size = confinement.address_space()
    try:
        if call_filter:
            confinement.confine(limits["disk"])
        first = os.fork()
    except OSError as problem:
        submission.tell(events, {"refused": f"no process could be made for it ({problem})"})
        os._exit(1)
    if first == 0:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
        submission.run(shell, call_filter, limits, size, notebook, events, folder)
    for descriptor in (notebook, events):
        os.close(descriptor)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
    _, status = os.waitpid(first, 0)
    if not call_filter:
        with contextlib.suppress(OSError):
            os.killpg(first, signal.SIGKILL)
        shutil.rmtree(folder, ignore_errors=True)
    os.write(ending, str(os.waitstatus_to_exitcode(status)).encode())
    os._exit(0)
