"""Attacks on the borders of the jail itself."""

from hostile.attack import attack

_BORDERS = "leaving the jail"

ATTACKS = (
    attack(
        _BORDERS,
        "ptrace",
        """
for pid in {os.getppid(), *pids()} - {os.getpid(), 0, 1}:
    for request in (16, 0x4206):  # attach, seize
        if LIBC.ptrace(request, pid, None, None) == 0:
            escaped(f"traces process {pid}")
local, remote = ctypes.create_string_buffer(8), (ctypes.c_size_t * 2)(0x400000, 8)
LIBC.process_vm_readv(os.getppid(), ctypes.byref(local), 1, ctypes.byref(remote), 1, 0)
""",
    ),
    attack(
        _BORDERS,
        "namespaces and mounts",
        """
only_in_a_jail()
before = os.stat("/")
for flags in (0x10000000, 0x10000000 | 0x00020000, 0x00020000, 0x40000000, 0x20000000):
    LIBC.unshare(flags)
for source, place, kind, flags in (
    (b"proc", b"/proc", b"proc", 0), (b"none", b"/", None, 0x20 | 0x1000), (b"none", b"/usr", None, 0x20 | 0x1000),
    (b"/dev/vda", b"/tmp", b"ext4", 0), (b"/dev/sda1", b"/tmp", b"ext4", 0), (b"sysfs", b"/sys", b"sysfs", 0),
):
    LIBC.mount(source, place, kind, flags, None)
for place in (b"/", b"/usr", b"/proc", b"/dev", b"/tmp", b"/etc"):
    LIBC.umount2(place, 2)
for path in (GIVEN["outside"], *GIVEN["reads"]):
    attempt(f"sees {path}", os.stat, path)
attempt("writes where only reading was", open, os.path.join(os.path.dirname(os.__file__), "hostile"), "w")
""",
    ),
    attack(
        _BORDERS,
        "namespaces of other processes",
        """
only_in_a_jail()
for pid in [1, os.getppid(), *pids()]:
    for kind in ("user", "mnt", "net", "pid", "ipc", "uts"):
        try:
            fd = os.open(f"/proc/{pid}/ns/{kind}", os.O_RDONLY)
        except OSError:
            continue
        LIBC.setns(fd, 0)
        os.close(fd)
for path in (GIVEN["outside"], *GIVEN["reads"]):
    attempt(f"sees {path}", os.stat, path)
""",
    ),
    attack(
        _BORDERS,
        "chroot",
        """
only_in_a_jail()
os.makedirs("in", exist_ok=True)
if LIBC.chroot(b"in") == 0:
    for _ in range(64):
        os.chdir("..")
    LIBC.chroot(b".")
for path in (GIVEN["outside"], *GIVEN["reads"]):
    attempt(f"sees {path}", os.stat, path)
""",
    ),
    attack(
        _BORDERS,
        "another user",
        """
for change in (os.setuid, os.setgid, os.seteuid, os.setegid):
    for number in (0, 1, 33, 65534):
        try:
            change(number)
        except OSError:
            pass
if 0 in os.getresuid():
    attempt("read /etc/shadow as root", open, "/etc/shadow")
for path in (GIVEN["outside"], *GIVEN["reads"]):
    attempt(f"sees {path}", os.stat, path)
for program in ("su", "sudo", "mount", "passwd", "newuidmap", "pkexec"):
    try:
        subprocess.run([program, "--version"], capture_output=True, timeout=1, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired):
        pass
""",
    ),
    attack(
        _BORDERS,
        "limits raised",
        """
import resource

for name in [name for name in dir(resource) if name.startswith("RLIMIT_")]:
    number = getattr(resource, name)
    try:
        soft, hard = resource.getrlimit(number)
        resource.setrlimit(number, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        if hard != resource.RLIM_INFINITY:
            escaped("raised " + name)
    except (OSError, ValueError):
        pass
""",
    ),
    attack(
        _BORDERS,
        "programs in the kernel, letters to a terminal",
        """
attempt("a program in the kernel", lambda: 1 / (LIBC.syscall(321, 0, (ctypes.c_char * 72)(), 72) >= 0))  # bpf
attempt("letters to a terminal", lambda: fcntl.ioctl(0, 0x5412, b"x"))  # TIOCSTI
""",
    ),
)
