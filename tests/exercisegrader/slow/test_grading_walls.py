"""The walls around a submission, tried from inside: what once got through them, and no longer does."""

import ctypes
import json
import os
import re
import signal
import threading
from pathlib import Path
from textwrap import dedent

import pytest

from exercisegrader import NoJail
from exercisegrader.events import Story
from exercisegrader.inside import confinement
from exercisegrader.jail import MEGA, Jail, Limits, in_cgroup
from needs import needs_jail

pytestmark = needs_jail
LIMITS = Limits(cell=3, total=6, memory=300 * MEGA)


@pytest.fixture(scope="module")
def jail():
    with Jail(limits=LIMITS) as jail:
        yield jail


def notebook(*sources):
    cells = [{"cell_type": "code", "source": dedent(source), "metadata": {}, "outputs": []} for source in sources]
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": cells}).encode()


def told(jail, source):
    """What a notebook of one cell answers in exercise 1."""
    outcome = jail.run(notebook(source))
    assert (outcome.errors, outcome.stopped, outcome.refused) == ((), "", "")
    return outcome.answers["1"]


def story_of(*values, most=MEGA):
    """The answers of what tells these values, which are texts of JSON."""
    story, (reader, writer) = Story(MEGA // 8, most), os.pipe()
    start, end = '{"answer": {"student": "s", "exercise": "1", "given": {"K": ', "}}}\n"
    lines = (f"{start}{value}{end}" for value in values)
    with open(reader, "rb", buffering=0) as events:
        threading.Thread(target=lambda: _write(writer, "".join(lines).encode())).start()
        while story.read(events):
            pass
    return story


def _write(descriptor, data):
    with open(descriptor, "wb") as file:
        file.write(data)


def test_beside_a_submission_nothing_of_the_judge_is_imported(jail):
    source = """
        import sys
        sheet.answer("1", K=2)
        sheet.answer("1", loaded=sorted(name for name in sys.modules if name.partition(".")[0] == "exercisegrader"))
        """
    ours, *loaded = told(jail, source)["loaded"]
    assert ours == "exercisegrader"
    assert [name for name in loaded if not f"{name}.".startswith("exercisegrader.inside.")] == []
    assert "exercisegrader.inside.shell" in loaded


def test_of_the_rights_of_root_nothing_is_left(jail):
    """Those of the fork server, which has none to give to a submission."""
    inner = [jail.process.pid]
    while children := Path(f"/proc/{inner[-1]}/task/{inner[-1]}/children").read_text().split():
        inner.append(int(children[0]))
    status = Path(f"/proc/{inner[-1]}/status").read_text()
    assert not re.search(r"^(Uid|Gid):.*\t0\b", status, re.MULTILINE)
    sets = r"^Cap(?:Inh|Prm|Eff|Bnd|Amb):\t(\w+)" if os.geteuid() == 0 else r"^Cap(?:Prm|Eff|Amb):\t(\w+)"
    assert {int(found, 16) for found in re.findall(sets, status, re.MULTILINE)} == {0}


def test_many_small_processes_are_one_large_one(jail):
    outcome = jail.run(
        notebook("""
            import subprocess, sys, time
            code = "b = bytearray(b'x') * (60 << 20); import time; time.sleep(3)"
            for _ in range(20):
                subprocess.Popen([sys.executable, "-S", "-c", code])
            time.sleep(3)
            """)
    )
    assert "more than 300 MB of memory" in outcome.stopped


def test_a_process_that_lets_nobody_see_its_memory_counts_in_full(jail):
    outcome = jail.run(
        notebook("""
            import ctypes, os, time
            for _ in range(12):
                if os.fork() == 0:
                    ctypes.CDLL(None).prctl(4, 0, 0, 0, 0)
                    held = bytearray(b"x") * (60 << 20)
                    time.sleep(3)
            time.sleep(3)
            """)
    )
    assert "more than 300 MB of memory" in outcome.stopped


def test_a_few_processes_that_share_what_they_have_are_no_large_one(jail):
    source = """
        import subprocess, sys, time
        code = "b = bytearray(b'x') * (20 << 20); import time; time.sleep(0.4)"
        started = [subprocess.Popen([sys.executable, "-S", "-c", code]) for _ in range(3)]
        import multiprocessing
        with multiprocessing.Pool(3) as pool:
            squares = pool.map(abs, range(9))
        sheet.answer("1", ended=[one.wait() for one in started], squares=squares)
        """
    assert told(jail, source) == {"ended": [0, 0, 0], "squares": [*range(9)]}


def test_full_sockets_count_as_memory(jail):
    outcome = jail.run(
        notebook("""
            import os, socket, time
            for _ in range(12):
                if os.fork() == 0:
                    pairs = [socket.socketpair() for _ in range(110)]
                    time.sleep(3)
            time.sleep(3)
            """)
    )
    assert "more than 300 MB of memory" in outcome.stopped


def test_there_are_a_few_terminals_and_local_sockets(jail):
    source = """
        import os, socket

        pair, terminals = socket.socketpair(), []
        try:
            while len(terminals) < 100:
                terminals.append(os.openpty())
        except OSError:
            pass
        sheet.answer("1", terminals=0 < len(terminals) <= 16, sent=pair[0].send(b"a"))
        """
    assert told(jail, source) == {"terminals": True, "sent": 1}


def test_a_crowd_stays_on_one_processor(jail):
    source = """
        import os, time
        for _ in range(6):
            if os.fork() == 0:
                os.setsid()
                while True:
                    pass
        began = time.monotonic()
        while len(os.sched_getaffinity(0)) > 1 and time.monotonic() < began + 2:
            time.sleep(0.05)
        sheet.answer("1", processors=len(os.sched_getaffinity(0)))
        """
    assert told(jail, source) == {"processors": 1}


def test_where_systemd_has_a_cgroup_the_jail_is_in_one(monkeypatch, tmp_path):
    """By a program that notes what it is asked for and runs the rest, for few machines of tests have systemd."""
    program = tmp_path / "systemd-run"
    program.write_text(
        f'#!/bin/sh\necho "$@" >> {tmp_path}/asked\nuntil [ "$1" = -- ]; do shift; done\nshift\nexec "$@"'
    )
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/run/user/1000")
    in_cgroup.cache_clear()
    with Jail(limits=LIMITS) as inside:
        assert told(inside, "import os\nsheet.answer('1', user='XDG_RUNTIME_DIR' in os.environ)") == {"user": False}
    in_cgroup.cache_clear()
    tried, asked = (tmp_path / "asked").read_text().splitlines()
    bounds = f"MemoryMax={(512 + 300 + 128) * MEGA} --property MemorySwapMax=0 --property TasksMax=96 -- "
    assert f"{bounds}true" in tried
    assert f"{bounds}/" in asked


def test_where_systemd_has_none_there_is_no_cgroup(monkeypatch):
    for program in ("/nowhere/systemd-run", "/bin/false", None):
        monkeypatch.setattr("shutil.which", lambda name, program=program: program)
        in_cgroup.cache_clear()
        assert in_cgroup(1, 1) == ()
    in_cgroup.cache_clear()


def test_limits_of_the_kernel_are_set(jail):
    source = """
        import resource
        names = ("AS", "CPU", "FSIZE", "NOFILE", "NPROC", "CORE", "RTPRIO", "NICE")
        sheet.answer("1", **{name: list(resource.getrlimit(getattr(resource, "RLIMIT_" + name))) for name in names})
        """
    found = told(jail, source)
    assert all(soft == hard for soft, hard in found.values())
    assert 300 * MEGA < found.pop("AS")[0] < 2**32
    assert {name: hard for name, (_, hard) in found.items()} == {
        "CPU": LIMITS.cpu, "FSIZE": LIMITS.file, "NOFILE": 256, "NPROC": LIMITS.processes, "CORE": 1, "RTPRIO": 0,
        "NICE": 0,
    }  # fmt: skip


@pytest.mark.parametrize("machine", [0xC000003E, 0xC00000B7], ids=["x86_64", "aarch64"])
def test_the_calls_that_are_allowed_have_these_names_on_each_machine(machine):
    resolve = ctypes.CDLL("libseccomp.so.2").seccomp_syscall_resolve_name_arch
    numbers = {name: resolve(machine, name.encode()) for name in " ".join(confinement._ALLOWED.values()).split()}
    assert {name for name, number in numbers.items() if number == -1} <= {"fchmodat2", "futex_waitv"}  # new ones
    needed = {"openat", "read", "mmap", "execve", "wait4", "futex", "epoll_pwait", "rt_sigreturn", "getrandom"}
    assert all(numbers[name] >= 0 for name in needed)


def test_what_libraries_do_is_allowed():
    source = """
        import asyncio, concurrent.futures, matplotlib.pyplot, multiprocessing, shutil, subprocess, sys, tempfile
        from concurrent.futures import ThreadPoolExecutor
        import numpy as np, scipy.integrate, sympy

        program = "import numpy, scipy.optimize, sympy; print(numpy.linalg.inv(numpy.eye(2)).sum())"

        async def heard():
            echo = await asyncio.create_subprocess_exec("echo", "a", stdout=asyncio.subprocess.PIPE)
            return (await echo.communicate())[0].decode()

        matplotlib.pyplot.plot([1, 2]), matplotlib.pyplot.savefig("a.pdf"), shutil.copy2("a.pdf", "b.pdf")
        with tempfile.TemporaryFile() as file, ThreadPoolExecutor(4) as threads:
            np.save(file, np.ones(9))
            squares = [*threads.map(lambda x: x * x, range(3))]
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            lengths = pool.map(len, ["a"])
        sheet.answer(
            "1", squares=squares, lengths=lengths, heard=await heard(),
            end=scipy.integrate.solve_ivp(lambda t, y: 0 * y, (0, 1), [1]).y[0, -1],
            program=subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout,
        )
        """
    expected = {"squares": [0, 1, 4], "lengths": [1], "heard": "a\n", "end": 1, "program": "2.0\n"}
    with Jail() as patient:  # it starts Python three times, on a machine that may be busy
        assert told(patient, source) == expected


def test_shell_escapes_have_a_terminal(jail):
    assert told(jail, "said = !echo here\nsheet.answer('1', said=list(said))") == {"said": ["here"]}


def test_chance_is_the_same_each_time(jail):
    source = "import random, numpy as np\nsheet.answer('1', dice=[random.random(), np.random.rand()])"
    assert told(jail, source) == told(jail, source)


def test_answers_deeper_than_any_sheet_tells_are_passed_over():
    nested = ["[" * depth + '"1.25"' + "]" * depth for depth in (8, 9, 40, 300)]
    dictionary = '{"a": ' * 9 + "1" + "}" * 9
    story = story_of(*nested, dictionary, "1e999", "9" * 302, "1")
    assert (story.odd, story.answers) == (6, {"1": {"K": 1}})


def test_cells_are_numbered():
    story = Story(1000, 10_000)
    for number in ("9" * 400, "1e300", "-1", "true", '"1"'):
        story._take(b'{"cell": %s}' % number.encode())
        story._take(b'{"error": {"cell": %s, "says": "x"}}' % number.encode())
    assert (story.odd, story.cell, story.errors) == (10, 0, [])


def test_where_too_much_is_told_the_same_lines_count_each_time():
    stories = [story_of(*range(3000), most=100_000) for _ in range(3)]
    assert all(story.too_long for story in stories)
    assert len({story.answers["1"]["K"] for story in stories}) == 1
    assert stories[0].answers["1"]["K"] == pytest.approx(100_000 / 66, rel=0.05)


def test_without_a_jail_other_programs_of_the_machine_are_not_counted():
    held = bytearray(b"x") * (400 * MEGA)
    try:
        process = Jail(jailed=False, limits=Limits(cell=3, total=6, memory=100 * MEGA))
    except NoJail as problem:
        pytest.skip(str(problem))  # root, with a Python of its own
    with process:
        assert told(process, "import time\ntime.sleep(0.3)\nsheet.answer('1', K=1)") == {"K": 1}
    assert held


def test_a_submission_runs_again_where_the_fork_server_ends(jail, monkeypatch):
    run, tries = jail._run, []

    def gone_once(*arguments):
        tries.append(arguments)
        if len(tries) == 1:
            raise ConnectionResetError
        return run(*arguments)

    monkeypatch.setattr(jail, "_run", gone_once)
    monkeypatch.setattr(jail, "close", lambda: None)
    assert told(jail, "sheet.answer('1', K=2)") == {"K": 2}


def test_a_fork_server_that_is_ended_from_outside_is_no_end_of_a_submission(jail, monkeypatch):
    starts = []

    def ends_too():
        starts.append(jail)
        raise NoJail("no other one")

    monkeypatch.setattr(jail, "_start", ends_too)
    threading.Timer(0.2, os.kill, (jail.process.pid, signal.SIGKILL)).start()
    with pytest.raises(NoJail, match="no other one"):
        jail.run(notebook("sheet.answer('1', K=2)\nimport time\ntime.sleep(2)"))
    assert starts == [jail]
