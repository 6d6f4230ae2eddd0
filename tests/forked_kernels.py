"""Kernels for the tests that begin with the libraries imported: one process imports them, and forks for each notebook.

A test run starts some eighty kernels, and each would spend as long on importing libraries as many a notebook takes to
run. What a reader starts is tested by the tests of the browser as it is. Jupyter starts the program of a kernel
and interrupts or ends it by signals; here that program is a small one, which asks the server at a socket for a kernel,
hands the signals on, and ends with it.
"""

import json
import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

INTERRUPT, END = b"i", b"e"
LIBRARIES = ("control", "ipykernel.kernelapp", "ipywidgets", "matplotlib.pyplot")


def start(folder):
    """Start the server and let Jupyter's programs, and those that they start, find its kernels. Returns the server.

    Arguments:
        folder: an empty folder for the kernel's description and the socket.
    """
    address = folder / "socket"
    description = {
        "argv": [sys.executable, "-S", "-E", str(Path(__file__)), str(address), "-f", "{connection_file}"],
        "display_name": "Python 3",
        "language": "python",
        "interrupt_mode": "signal",
    }
    kernel = folder / "jupyter" / "kernels" / "python3" / "kernel.json"
    kernel.parent.mkdir(parents=True)
    kernel.write_text(json.dumps(description), encoding="utf-8")
    os.environ["JUPYTER_PATH"] = str(folder / "jupyter")
    command = [sys.executable, str(Path(__file__)), str(address)]
    server = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    threading.Thread(target=_report, args=(server, folder), daemon=True).start()
    return server


def _report(server, folder):
    """Hand on what the server says, and keep the last line where the kernels look if it ends without being asked to."""
    said = [line.decode(errors="replace") for line in server.stderr]
    sys.stderr.writelines(said)
    if server.wait():
        partial = folder / "failed.partial"
        partial.write_text("".join(said[-1:]) or f"it ended with {server.returncode}", encoding="utf-8")
        partial.rename(folder / "failed")


def failure(folder):
    """Why there is no server, None as long as it has not failed."""
    told = folder / "failed"
    return told.read_text(encoding="utf-8").strip() if told.exists() else None


# ---- The program that Jupyter starts.


def ask(address, *arguments):
    """Ask the server for a kernel, and be its stand-in: hand signals on, and end as it ends."""
    import signal

    server = socket.socket(socket.AF_UNIX)
    while True:
        try:
            server.connect(address)
            break
        except OSError:  # the server is still importing, or has failed
            if why := failure(Path(address).parent):
                sys.exit(f"there are no kernels: {why}")
            time.sleep(0.05)
    signal.signal(signal.SIGINT, lambda *_: server.sendall(INTERRUPT))
    signal.signal(signal.SIGTERM, lambda *_: server.sendall(END))
    job = {"arguments": arguments, "folder": os.getcwd(), "environment": dict(os.environ)}
    socket.send_fds(server, [json.dumps(job).encode() + b"\n"], [1, 2])
    code = server.makefile("rb").readline()
    sys.exit(int(code or 1))


# ---- The server.


def serve(address):
    """Import the libraries, then fork a process for each that asks; end when standard input is closed."""
    import gc
    import selectors
    import signal

    _import_libraries()
    gc.collect()
    gc.freeze()  # no kernel looks through what all of them share
    gc.set_threshold(50_000)
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(address)
    listening.listen(64)
    ended, ending = os.pipe()  # written to when a child has ended
    os.set_blocking(ending, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(ending)
    selector = selectors.DefaultSelector()
    for source in (sys.stdin.fileno(), listening, ended):
        selector.register(source, selectors.EVENT_READ)
    kernels = {}  # by the socket of their stand-ins

    def forget(stand_in):
        selector.unregister(stand_in)
        stand_in.close()
        return kernels.pop(stand_in)

    while True:
        for key, _ in selector.select():
            source = key.fileobj
            if source == sys.stdin.fileno():
                for process in kernels.values():
                    os.kill(process, signal.SIGKILL)
                return
            if source == ended:
                os.read(ended, 4096)
                while process := _ended():
                    stand_in = next((one for one, kernel in kernels.items() if kernel == process[0]), None)
                    if stand_in:
                        with _gone():
                            stand_in.sendall(b"%d\n" % process[1])
                        forget(stand_in)
            elif source is listening:
                stand_in, _ = listening.accept()
                if job := _job(stand_in):
                    kernels[stand_in] = _fork(*job, [listening, ended, ending, *kernels, stand_in])
                    selector.register(stand_in, selectors.EVENT_READ)
            elif source in kernels:
                said = b""
                with _gone():
                    said = source.recv(64)
                process = kernels[source] if said else forget(source)
                os.kill(process, signal.SIGINT if said == INTERRUPT else signal.SIGKILL)


def _import_libraries():
    """Import what chapters and their kernels use, and use it once; nothing of it starts a thread."""
    import importlib
    import pkgutil

    import loopbook
    from exercisegrader.inside import rehearsal

    for name in LIBRARIES:
        importlib.import_module(name)
    for module in pkgutil.walk_packages(loopbook.__path__, "loopbook."):
        if not module.name.startswith(("exercisegrader", "loopbook.__main__")):
            importlib.import_module(module.name)
    rehearsal.rehearse()


def _gone():
    import contextlib

    return contextlib.suppress(OSError)


def _ended():
    """The number and the exit code of a process that has ended, None if there is none."""
    try:
        process, status = os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return None
    return (process, os.waitstatus_to_exitcode(status)) if process else None


def _job(stand_in):
    """What a stand-in asks for, with the descriptors for what the kernel prints; None if it has gone."""
    message, descriptors, *_ = socket.recv_fds(stand_in, 2**16, 2)
    while message and not message.endswith(b"\n"):
        message += stand_in.recv(2**16)
    return (json.loads(message), descriptors) if message else None


def _fork(job, descriptors, not_for_it):
    """The number of a new process that is the kernel."""
    import signal

    process = os.fork()
    if process:
        for descriptor in descriptors:
            os.close(descriptor)
        return process
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for one in not_for_it:
        os.close(one if isinstance(one, int) else one.detach())
    os.setsid()
    nothing = os.open(os.devnull, os.O_RDONLY)
    for number, descriptor in enumerate((nothing, *descriptors)):
        os.dup2(descriptor, number)
    os.chdir(job["folder"])
    os.environ.clear()
    os.environ.update(job["environment"])
    sys.path[0] = job["folder"]
    # What a kernel otherwise reads from the environment as it imports.
    settings = [f"--IPKernelApp.parent_handle={os.getppid()}", "--matplotlib=inline"]
    sys.argv = ["ipykernel_launcher", *settings, *job["arguments"]]
    from ipykernel import kernelapp

    try:
        kernelapp.launch_new_instance()
    finally:
        os._exit(0)


if __name__ == "__main__":
    serve(sys.argv[1]) if len(sys.argv) == 2 else ask(*sys.argv[1:])
