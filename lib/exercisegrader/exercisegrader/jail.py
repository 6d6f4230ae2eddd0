"""A jail for submissions: bubblewrap around a fork server, and what a submission told before it ended.

The list of what is visible inside is `visible`: the system's programs and libraries, Python, its packages, and this
library, all read-only. There is no network, no environment, no descriptor but one for the events, and nothing else of
the machine.

What a submission takes is bounded three times. Each process has limits of its own (`inside.confinement`). The fork
server looks at all of them together each tenth of a second, and says why it ends them (`inside.fork_server`). Where
systemd gives this user a cgroup, the jail runs in one that bounds memory and tasks, also what the kernel holds for them
and nobody sees; elsewhere, as in a container, the first two have to do.
"""

from __future__ import annotations

import functools
import json
import os
import shutil
import signal
import site
import socket
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from multiprocessing.connection import wait
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Self

from exercisebook import plugins
from exercisegrader import GradingError, NoJail
from exercisegrader.events import Scene, Story
from exercisegrader.inside.confinement import HOME
from exercisegrader.inside.fork_server import KILL

if TYPE_CHECKING:
    from exercisegrader.events import Outcome, Shown

MEGA = 2**20
#: What libraries may take to be imported (s).
STARTING = 120
#: Between the end of a cell's time and the end of its process (s): the cell is asked to stop first.
PATIENCE = 2
#: What the end of a process may take (s).
STUBBORN = 10
#: What the fork server itself may hold, in memory (bytes) and in tasks; and what systemd may take to answer (s).
OWN_MEMORY, OWN_TASKS, ANSWER = 512 * MEGA, 32, 5
SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/fonts", "/etc/localtime")
PYTHON = os.path.abspath(sys.executable)
#: Where systemd of a user is found.
RUNTIME = "XDG_RUNTIME_DIR"
ENVIRONMENT = {
    "HOME": HOME,
    "TMPDIR": HOME,
    "PATH": f"{os.path.dirname(PYTHON)}:/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "PYTHONDONTWRITEBYTECODE": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MPLBACKEND": "agg",
    "LOOPBOOK_PROGRESS": "off",
}


@dataclass(frozen=True)
class Limits:
    """What a submission may take: times in s, sizes in bytes.

    Attributes:
        cell, total: wall time of a cell, and of the notebook.
        cpu: processor time of each process.
        memory: of all processes, beyond what they share with the fork server.
        processes: processes and threads.
        file, disk: of one file, and of all.
        events: of what it tells, a line and all of it.
    """

    cell: float = 60
    total: float = 180
    cpu: int = 120
    memory: int = 1024 * MEGA
    processes: int = 64
    file: int = 32 * MEGA
    disk: int = 64 * MEGA
    line: int = MEGA // 2
    events: int = 16 * MEGA


USUAL = Limits()


def visible() -> list[str]:
    """Return the folders and files that a submission can read: the system's, Python's, its packages', this library."""
    python = [sys.base_prefix, sys.prefix]
    if site.ENABLE_USER_SITE and site.getusersitepackages() in sys.path:
        python.append(site.getusersitepackages())
    paths = [*SYSTEM, *python, str(Path(__file__).parents[2]), *map(str, plugins.folders())]
    within = [path for path in dict.fromkeys(paths) if os.path.lexists(path)]
    return [path for path in within if not any(Path(path) != Path(o) and Path(path).is_relative_to(o) for o in within)]


def demand_hidden(*paths: str | Path) -> None:
    """Raise GradingError where one of the paths is visible inside."""
    for path in paths:
        for seen in visible():
            if Path(path).resolve().is_relative_to(Path(seen).resolve()):
                raise GradingError(f"{path} is in {seen}, which every submission can read: move it elsewhere")


def command() -> list[str]:
    """Return the command that starts the fork server in bubblewrap. Raises NoJail where there is none."""
    program = shutil.which("bwrap")
    if sys.platform != "linux" or program is None:
        why = "bubblewrap is not installed" if sys.platform == "linux" else "a jail needs Linux"
        raise NoJail(
            f"there is no jail here, {why}: install bubblewrap and libseccomp2 on a Linux machine, "
            "or say --without-jail and every output is marked so"
        )
    line = [program, "--die-with-parent", "--new-session", "--hostname", "jail", "--unsetenv", RUNTIME]
    line += ["--unshare-pid", "--unshare-ipc", "--unshare-net", "--unshare-uts", "--unshare-cgroup-try"]
    if os.geteuid() == 0:  # the fork server becomes nobody, for which it takes these, and keeps none
        line += ["--cap-drop", "ALL"]
        line += [word for name in ("SETUID", "SETGID", "SETPCAP") for word in ("--cap-add", f"CAP_{name}")]
    folders = [str(folder) for path in visible() for folder in [*Path(path).parents][-2::-1]]
    for folder in dict.fromkeys(folders):  # for nobody to pass through
        line += ["--perms", "0755", "--dir", folder]
    for path in visible():
        line += ["--symlink", os.readlink(path), path] if os.path.islink(path) else ["--ro-bind", path, path]
    line += ["--proc", "/proc", "--dev", "/dev", "--tmpfs", "/dev/shm", "--perms", "1777", "--tmpfs", HOME]
    if not any(Path(path).is_relative_to("/tmp") for path in visible()):
        line += ["--symlink", HOME.lstrip("/"), "/tmp"]
    line += ["--remount-ro", "/dev", "--remount-ro", "/", "--chdir", HOME, "--"]
    return line


@functools.cache
def in_cgroup(memory: int, tasks: int) -> tuple[str, ...]:
    """Return how a command begins that runs in a cgroup of its own, by systemd; nothing where that is not possible.

    Arguments:
        memory: of all in it (bytes).
        tasks: their number.
    """
    line = [shutil.which("systemd-run") or "", "--scope", "--quiet", "--collect", *(["--user"] if os.geteuid() else [])]
    for bound in (f"MemoryMax={memory}", "MemorySwapMax=0", f"TasksMax={tasks}"):
        line += ["--property", bound]
    try:
        subprocess.run([*line, "--", "true"], env=_systemd(), capture_output=True, timeout=ANSWER, check=True)
    except (OSError, subprocess.SubprocessError):  # there is none, or it has nothing for this user
        return ()
    return (*line, "--")


def _systemd():
    """The environment in which systemd is found; bubblewrap takes it away again."""
    return ENVIRONMENT | {name: os.environ[name] for name in (RUNTIME,) if name in os.environ}


class Jail:
    """A fork server that runs one submission after another, each in walls of its own.

    Arguments:
        jailed: without a jail, submissions run with the rights of whoever grades.
        limits: `Limits`.
    Raises:
        NoJail: where no jail is possible, or the libraries cannot be imported in it.
    """

    def __init__(self, jailed: bool = True, limits: Limits = USUAL):
        self.jailed, self.limits = jailed, limits
        self.process: subprocess.Popen[bytes] | None = None
        self._start()

    def _start(self):
        ours, theirs = socket.socketpair()
        around = _systemd() if self.jailed else ENVIRONMENT | dict.fromkeys(("HOME", "TMPDIR"), tempfile.gettempdir())
        line = [PYTHON, "-m", "exercisegrader.inside.fork_server"]
        if self.jailed:
            memory = OWN_MEMORY + self.limits.memory + 2 * self.limits.disk
            line = [*in_cgroup(memory, OWN_TASKS + self.limits.processes), *command(), *line, "jailed"]
        with theirs, tempfile.TemporaryFile() as complaints:
            self.process = subprocess.Popen(
                line,
                stdin=theirs,
                stdout=subprocess.DEVNULL,
                stderr=complaints,
                env=around,
                cwd="/",
            )
            theirs.close()
            self._control = ours
            reply = self._reply(STARTING)
            if "ready" not in reply:
                self.close()
                complaints.seek(0)
                said = complaints.read(10**6).decode(errors="replace").strip().splitlines()
                why = reply.get("failed") or (said[-1] if said else "it ended without a word")
                raise NoJail(f"the {'jail' if self.jailed else 'process'} for submissions does not start: {why}")

    def _reply(self, seconds):
        """The next line of the fork server; empty where it is gone or silent."""
        self._control.settimeout(seconds)
        try:
            line = self._control.recv(65536)
            return json.loads(line) if line else {}
        except (OSError, ValueError):
            return {}

    def close(self) -> None:
        """End the fork server, and whatever runs in its walls."""
        self._control.close()
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *problem: object) -> None:
        self.close()

    def run(self, content: bytes) -> Outcome:
        """Run a notebook, given as the bytes of its file; returns the `Outcome`. Raises NoJail as the start.

        Where the fork server ends under it, which no submission in a jail can bring about, it runs once more.
        """
        for _ in range(2):
            if self.process.poll() is not None:
                self.close()
                self._start()
            story = Story(self.limits.line, self.limits.events)
            try:
                return self._run(content, story)
            except ConnectionError:
                self.close()
        return story.outcome("the process around it ended", -signal.SIGKILL)

    def show(self, content: bytes) -> tuple[list[Shown], str]:
        """Run a notebook to see what its cells show; returns that, and why it did not run to its end.

        It is a run of its own, so that looking at it changes no answer. Raises NoJail as the start.
        """
        if self.process.poll() is not None:
            self.close()
            self._start()
        scene = Scene()
        try:
            outcome = self._run(content, scene, show=True)
        except ConnectionError:
            self.close()
            return scene.shown, "the process around it ended"
        return scene.shown, outcome.refused or outcome.stopped

    def _run(self, content, story, show=False):
        reader, writer = os.pipe()
        with tempfile.TemporaryFile() as notebook, open(reader, "rb", buffering=0) as events:
            try:
                notebook.write(content)
                notebook.seek(0)
                job = json.dumps(asdict(self.limits) | {"show": show}).encode() + b"\n"
                socket.send_fds(self._control, [job], [notebook.fileno(), writer])
            finally:
                os.close(writer)
            return self._followed(events, story)

    def _followed(self, events, story):
        """The outcome of the submission that tells these events. Raises ConnectionError where the fork server ends."""
        end, why = monotonic() + self.limits.total, ""
        watched, done = [events, self._control], False
        while not done:
            due = end if why else min(end, story.cell_began + self.limits.cell + PATIENCE)
            ready = wait(watched, max(0.0, due - monotonic()))
            if events in ready and not story.read(events):
                watched.remove(events)  # nothing more will come: the process is about to end
            done = self._control in ready
            # it may have ended in time while this process read the large file of somebody else
            is_late = monotonic() >= due and not wait([self._control], 0)
            if done or not (is_late or story.too_long):
                continue
            if why:  # it was to be ended, and was not: then everything in these walls is
                break
            why = story.too_long or self._late(monotonic() >= end)
            end = monotonic() + STUBBORN
            self._control.send(KILL)
        reply = self._reply(STUBBORN) if done else {}
        if not reply:
            if not why:
                raise ConnectionResetError
            self.close()
        os.set_blocking(events.fileno(), False)
        while not story.too_long and story.read(events):
            pass
        why = why or story.too_long
        if reply.get("memory"):
            why = f"it took more than {self.limits.memory // MEGA} MB of memory"
        return story.outcome(why, reply.get("exit", -signal.SIGKILL))

    def _late(self, in_all):
        if in_all:
            return f"the notebook took longer than {self.limits.total:g} s"
        return f"the cell took longer than {self.limits.cell:g} s"
