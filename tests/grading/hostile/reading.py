"""Attacks that read what is not theirs, and write there."""

from hostile.attack import GOES_ON, attack

_READS = "reading"
_WRITES = "writing"

ATTACKS = (
    attack(
        _READS,
        "assignment, roster, results, other submissions",
        """
for path in GIVEN["reads"]:
    attempt(f"read {path}", lambda: hunt(open(path, "rb").read(), path))
    attempt(f"listed the folder of {path}", os.listdir, os.path.dirname(path))
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "by way of processes' own folders",
        """
for path in GIVEN["reads"]:
    for pid in ["self", "thread-self", *pids()]:
        for way in ("root", "cwd"):
            attempt(f"read {path} by way of {pid}", lambda: open(f"/proc/{pid}/{way}{path}", "rb").read())
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "everything that os.walk finds, by name",
        """
wanted = {os.path.basename(path) for path in GIVEN["reads"]}
for start in ("/home", "/root", "/tmp", "/var/tmp", "/run", "/mnt", "/media", "/srv", "/work", "/dev/shm", os.getcwd()):
    for folder, folders, names in os.walk(start):
        for name in wanted & set(names):
            attempt("found " + name, open, os.path.join(folder, name))
""",
    ),
    attack(
        _READS,
        "/etc/shadow",
        """
for path in ("/etc/shadow", "/etc/gshadow", "/etc/sudoers", "/root/.ssh/id_ed25519", "/root/.bash_history"):
    attempt("read " + path, lambda: open(path, "rb").read())
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "environment",
        """
hunt(repr(dict(os.environ)).encode(), "the environment")
for pid in ["self", *pids()]:
    try:
        hunt(open(f"/proc/{pid}/environ", "rb").read(), f"environment of {pid}")
        hunt(open(f"/proc/{pid}/cmdline", "rb").read(), f"command of {pid}")
    except OSError:
        pass
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "memory of all processes",
        """
def walk(pid):
    with open(f"/proc/{pid}/maps") as maps, open(f"/proc/{pid}/mem", "rb", 0) as memory:
        for line in maps:
            if " rw" in line and "[v" not in line:
                low, high = (int(one, 16) for one in line.split()[0].split("-"))
                try:
                    memory.seek(low)
                    hunt(memory.read(min(high - low, 2**28)), f"memory of {pid}")
                except (OSError, OverflowError, ValueError):
                    pass


for pid in ["self", os.getppid(), *pids()]:
    try:
        walk(pid)
    except OSError:
        pass
""",
    ),
    attack(
        _READS,
        "the inherited heap, page by page",
        """
out, into = os.pipe()
fcntl.fcntl(into, fcntl.F_SETPIPE_SZ, 2**17)
LIBC.write.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t]
starts = {id(one) >> 28 for one in (object(), [], {}, "x" * 10**5, bytes(10**7), sys.modules, json, LIBC)}
for start in sorted(starts):
    for address in range(start << 28, (start + 1) << 28, 2**16):
        written = LIBC.write(into, address, 2**16)  # of what is not there, the kernel says so
        if written > 0:
            hunt(os.read(out, written), "the heap")
""",
    ),
    attack(
        _READS,
        "memory of the parent can be written",
        """
for pid in {os.getppid(), *pids()} - {os.getpid(), 0, 1}:
    attempt(f"opened the memory of process {pid}", open, f"/proc/{pid}/mem", "r+b", 0)
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "objects that were inherited",
        """
import gc

for one in gc.get_objects():
    try:
        if type(one) in (dict, list, tuple, set):
            for text in [*one.keys(), *one.values()] if type(one) is dict else one:
                if type(text) is str and "canary-" in text[:10**5]:
                    hunt(text.encode("utf-8", "replace"), "objects")
    except Exception:
        pass
for name, module in list(sys.modules.items()):
    hunt(repr(getattr(module, "__dict__", {}))[:10**6].encode("utf-8", "replace"), name)
""",
    ),
    attack(
        _READS,
        "file descriptors that were inherited",
        """
for fd in range(3, 256):
    try:
        fcntl.fcntl(fd, fcntl.F_SETFL, fcntl.fcntl(fd, fcntl.F_GETFL) | os.O_NONBLOCK)
        hunt(os.read(fd, 10**6), f"descriptor {fd}")
    except OSError:
        pass
    try:
        hunt(os.pread(fd, 10**6, 0), f"descriptor {fd}")
        hunt(os.readlink(f"/proc/self/fd/{fd}").encode(), f"name of descriptor {fd}")
    except OSError:
        pass
    for path in ("..", "../..", "../../.."):
        try:
            attempt("left a folder by its descriptor", os.listdir, os.open(path, os.O_RDONLY, dir_fd=fd))
        except OSError:
            pass
""",
    ),
    attack(
        _READS,
        "memory shared and messages",
        """
for folder in ("/dev/shm", "/dev/mqueue", "/run", "/run/user", "/tmp"):
    for name in os.listdir(folder) if os.path.isdir(folder) else []:
        try:
            hunt(open(os.path.join(folder, name), "rb").read(10**6), folder)
        except OSError:
            pass
for number in range(64):
    if LIBC.shmat(number, None, 0o10000) not in (-1, 0xFFFFFFFF):
        escaped("memory that others share")
""",
        expects=GOES_ON,
    ),
    attack(
        _READS,
        "traces of the submission before",
        """
folders = (os.getcwd(), os.path.expanduser("~"), "/tmp", "/var/tmp", "/dev/shm")
if any(os.path.exists(os.path.join(folder, "trace")) for folder in folders):
    escaped("a trace of another submission")
for folder in folders:
    try:
        open(os.path.join(folder, "trace"), "w").write("here")
    except OSError:
        pass
""",
        expects=GOES_ON,
    ),
    attack(
        _WRITES,
        "results, other submissions, the assignment",
        """
for path in GIVEN["writes"]:
    inside = os.path.join(path, "evil") if os.path.isdir(path) else path
    attempt(f"wrote {inside}", lambda: open(inside, "ab").write(b" "))
    attempt(f"renamed {path}", os.rename, path, path + ".evil")
    attempt(f"removed {path}", os.remove, path)
    attempt(f"opened {path} to all", os.chmod, path, 0o777)
    attempt(f"made a folder in {path}", os.mkdir, os.path.join(path, "evil.d"))
""",
        expects=GOES_ON,
    ),
    attack(
        _WRITES,
        "the libraries",
        """
import numpy

import loopbook

only_in_a_jail()
for module in (os, numpy, loopbook, json):
    path = os.path.join(os.path.dirname(module.__file__), "hostile.pth")
    attempt("wrote beside " + module.__name__, open, path, "w")
    attempt("wrote into " + module.__name__, open, module.__file__, "a")
attempt("wrote beside python", open, os.path.join(os.path.dirname(sys.executable), "hostile"), "w")
""",
        expects=GOES_ON,
    ),
    attack(
        _WRITES,
        "devices and the kernel's files",
        """
only_in_a_jail()
for path in ("/dev/sda", "/dev/vda", "/dev/mem", "/dev/kmem", "/dev/kmsg", "/proc/sysrq-trigger",
             "/proc/sys/kernel/core_pattern", "/proc/sys/kernel/hostname", "/sys/fs/cgroup/cgroup.procs"):
    attempt("opened " + path, os.open, path, os.O_WRONLY)
""",
        expects=GOES_ON,
    ),
)
