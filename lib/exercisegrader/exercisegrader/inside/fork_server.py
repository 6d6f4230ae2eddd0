"""The fork server, the first of three roles: it waits in the jail with all libraries imported, and forks.

It never sees a notebook: it hands two descriptors on, one to read the notebook from and one to tell events to. For
each submission it forks a `guard`, which forks the `submission`; meanwhile it looks at what their processes take. When
the submission's first process ends, everything that it started ends with it.

Without a jail the same happens without the namespaces.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import signal
import socket
import sys
from multiprocessing.connection import wait

from exercisegrader.inside import confinement, guard

#: How often (s) a submission's processes are looked at.
WATCH = 0.1
#: What the kernel keeps for a full socket (bytes).
SOCKET = 2**18
#: Of more processes and threads than this, a submission has a crowd.
CROWD = 4
KILL = b"kill\n"


def main(jailed: bool) -> None:
    """Answer the grader at the socket that is standard input, until it goes.

    A job is a line of JSON with the limits and whether to show the notebook, and two descriptors: the notebook's and
    the events'. While a submission runs, the line "kill" ends it. The reply is a line of JSON: how the process ended,
    and whether for its memory.
    """
    control = socket.socket(fileno=os.dup(0))
    try:
        confinement.drop_root(sys.path)
        prepared = _libraries(), confinement.call_filter() if jailed else None
    except Exception as problem:
        _reply(control, {"failed": f"{type(problem).__name__}: {problem}"})
        return
    gc.collect()
    gc.freeze()  # so that a child's collections do not copy what it shares with this process
    _reply(control, {"ready": True})
    while True:
        message, descriptors, *_ = socket.recv_fds(control, 4096, 2)
        if not message:
            return
        job = message.removeprefix(KILL)  # for one that ended by itself just before
        if job:
            _reply(control, _job(control, prepared, json.loads(job), *descriptors))


def _reply(control, data):
    control.sendall(json.dumps(data).encode() + b"\n")


def _job(control, prepared, limits, notebook, events):
    """Run one submission; returns {"exit": code, or minus the signal, "memory": whether it was ended for that}."""
    ended, ending = os.pipe()
    forked = os.fork()
    if forked == 0:
        os.close(ended)
        control.close()
        guard.watch_over(prepared, limits, notebook, events, ending)
    for descriptor in (notebook, events, ending):
        os.close(descriptor)
    too_much = False
    while True:
        ready = wait([control, ended], WATCH)
        if ended in ready:
            break
        if control in ready:
            os.kill(forked, signal.SIGTERM)
            if not control.recv(4096):  # the grader is gone
                break
        if prepared[1] and not too_much:  # without a jail, its processes cannot be told from others
            others = _processes(forked)
            _hold_together(others)
            too_much = _is_too_much(others, forked, limits["memory"])
            if too_much:
                os.kill(forked, signal.SIGTERM)
    code = int(os.read(ended, 20) or -signal.SIGKILL)
    os.close(ended)
    os.waitpid(forked, 0)
    return {"exit": code, "memory": too_much}


def _processes(forked):
    """The processes of the submission, as the jail numbers them: all but the guard and this one."""
    passed = {"1", str(forked), str(os.getpid())}
    return [name for name in os.listdir("/proc") if name.isdigit() and name not in passed]


def _hold_together(processes):
    """Keep a crowd on one processor: who divides the others is then no matter of how many it starts."""
    tasks = []
    for process in processes:
        with contextlib.suppress(OSError):  # it has just ended
            tasks += map(int, os.listdir(f"/proc/{process}/task"))
    if len(tasks) > CROWD:
        last = {max(os.sched_getaffinity(0))}
        for task in tasks:
            with contextlib.suppress(OSError):
                os.sched_setaffinity(task, last)


def _is_too_much(processes, forked, memory):
    """Whether processes hold more memory (bytes) than that, beyond what they share with this one, and in sockets."""
    most = memory + _resident("self") - SOCKET * _sockets(forked)
    if sum(map(_resident, processes)) <= most:  # which counts what they share several times
        return False
    return sum(map(_share, processes)) > most


def _resident(process):
    try:
        with open(f"/proc/{process}/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):  # it has just ended
        return 0


def _share(process):
    """What a process holds, with its part of what it shares (bytes); all of that, where it does not let one see."""
    try:
        with open(f"/proc/{process}/smaps_rollup") as file:
            return next(1024 * int(line.split()[1]) for line in file if line.startswith("Pss:"))
    except (OSError, StopIteration):
        return _resident(process)


def _sockets(forked):
    """The number of sockets in the network of the submission, which is the guard's too."""
    try:
        with open(f"/proc/{forked}/net/sockstat") as file:
            return int(file.readline().split()[-1])
    except (OSError, ValueError, IndexError):
        return 0


def _libraries():
    """Import what notebooks use, and use it once, so that each submission finds it done; returns the shell."""
    from exercisegrader.inside import rehearsal
    from exercisegrader.inside.shell import shell

    made = shell()
    rehearsal.rehearse()
    return made


if __name__ == "__main__":
    main(jailed=sys.argv[1:] == ["jailed"])
