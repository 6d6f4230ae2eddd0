"""The fork server: it waits in the jail with all libraries imported, and forks for each submission.

It never sees a notebook: it hands two descriptors on, one to read the notebook from and one to tell events to. For
each submission it forks a guard, which moves into namespaces of its own (users, processes, files, network, IPC) and
covers what was writable. The guard forks the first process of those namespaces, which limits itself, gives up every
right, and only then reads the notebook. When that process ends, everything it started ends with it.

Without a jail the same happens without the namespaces.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import shutil
import signal
import socket
import sys
import tempfile
from multiprocessing.connection import wait

from exercisegrader.inside import confinement

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
    guard = os.fork()
    if guard == 0:
        os.close(ended)
        control.close()
        _guard(prepared, limits, notebook, events, ending)
    for descriptor in (notebook, events, ending):
        os.close(descriptor)
    too_much = False
    while True:
        ready = wait([control, ended], WATCH)
        if ended in ready:
            break
        if control in ready:
            os.kill(guard, signal.SIGTERM)
            if not control.recv(4096):  # the grader is gone
                break
        if prepared[1] and not too_much:  # without a jail, its processes cannot be told from others
            others = _processes(guard)
            _hold_together(others)
            too_much = _is_too_much(others, guard, limits["memory"])
            if too_much:
                os.kill(guard, signal.SIGTERM)
    code = int(os.read(ended, 20) or -signal.SIGKILL)
    os.close(ended)
    os.waitpid(guard, 0)
    return {"exit": code, "memory": too_much}


def _processes(guard):
    """The processes of the submission, as the jail numbers them."""
    passed = {"1", str(guard), str(os.getpid())}
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


def _is_too_much(processes, guard, memory):
    """Whether processes hold more memory (bytes) than that, beyond what they share with this one, and in sockets."""
    most = memory + _resident("self") - SOCKET * _sockets(guard)
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


def _sockets(guard):
    """The number of sockets in the network of the submission, which is the guard's too."""
    try:
        with open(f"/proc/{guard}/net/sockstat") as file:
            return int(file.readline().split()[-1])
    except (OSError, ValueError, IndexError):
        return 0


def _guard(prepared, limits, notebook, events, ending):
    """Fork the submission's first process, wait for it, and tell how it ended; SIGTERM ends it."""
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
        _tell(events, {"refused": f"no process could be made for it ({problem})"})
        os._exit(1)
    if first == 0:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
        _submission(shell, call_filter, limits, size, notebook, events, folder)
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


def _submission(shell, call_filter, limits, size, notebook, events, folder):
    """Be the submission's first process: run the notebook with nothing else in reach, and end."""
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
        _tell(4, {"refused": f"no process could be made for it ({type(problem).__name__}: {problem})"})
        os._exit(1)
    try:
        from exercisegrader.inside import shell as runner

        first = os.getpid()

        def tell(event):
            if os.getpid() == first:  # a copy of it, which it forked, runs on through the same cells
                _tell(4, event)

        runner.run(content, shell, tell, limits["cell"], limits["show"])
    finally:
        os._exit(0)


def _tell(descriptor, event):
    line = json.dumps(event, allow_nan=False).encode() + b"\n"
    while line:
        line = line[os.write(descriptor, line) :]


def _libraries():
    """Import what notebooks use, and use it once, so that each submission finds it done; returns the shell."""
    from exercisegrader.inside import rehearsal
    from exercisegrader.inside.shell import shell

    made = shell()
    rehearsal.rehearse()
    return made


if __name__ == "__main__":
    main(jailed=sys.argv[1:] == ["jailed"])
