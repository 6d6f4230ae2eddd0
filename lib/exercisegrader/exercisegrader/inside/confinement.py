"""What a process gives up before it runs a submission. Linux alone; bubblewrap has made the outer walls already.

The walls are the kernel's: namespaces (``man 7 user_namespaces``), resource limits, capabilities, and a filter of
system calls by libseccomp. Each step that fails raises OSError, and nothing is run.
"""

from __future__ import annotations

import ctypes
import errno
import os
from collections.abc import Iterable, Mapping

NOBODY = 65534
#: Who a submission is inside, and the only place where it can write.
STUDENT, HOME = 1000, "/home/student"

_NEW = {"files": 0x00020000, "name": 0x04000000, "ipc": 0x08000000, "user": 0x10000000, "processes": 0x20000000,
        "network": 0x40000000}  # fmt: skip
_NOSUID_NODEV = 2 | 4
#: Terminals, of which a machine has 4096: shell escapes take one at a time.
_MOST_TERMINALS = 16
_PR_SET_DUMPABLE, _PR_CAPBSET_DROP, _PR_SET_NO_NEW_PRIVS = 4, 24, 38
_CAPABILITIES_V3 = 0x20080522

#: No calculation needs these: memory that no limit of a process counts, what a machine or a user has few of, another
#: share of the processors, other processes, new namespaces, new mounts, the kernel's keys, programs in the kernel, and
#: the interfaces that go round a filter.
_REFUSED = (
    "memfd_create", "memfd_secret", "shmget", "semget", "msgget", "mq_open", "vmsplice", "splice", "tee",
    "inotify_init", "inotify_init1", "fanotify_init", "io_setup", "syslog",
    "sched_setaffinity",
    "ptrace", "process_vm_readv", "process_vm_writev", "kcmp", "pidfd_getfd",
    "unshare", "setns", "chroot",
    "mount", "umount2", "pivot_root", "move_mount", "open_tree", "fsopen", "fsmount", "fspick", "mount_setattr",
    "add_key", "request_key", "keyctl",
    "bpf", "perf_event_open", "userfaultfd", "io_uring_setup",
)  # fmt: skip
_ALLOW, _ERRNO = 0x7FFF0000, 0x00050000
_EQUAL, _ABOVE, _MASKED_EQUAL = 4, 6, 7
#: The families of sockets that stay within the namespaces: local ones, the internet's, and the kernel's about them.
#: Others reach further, as that to the host of a virtual machine does.
_FAMILIES = (1, 2, 10, 16)
#: Commands of fcntl for locks on parts of a file: the kernel keeps as many as one likes, in memory that is nobody's.
_LOCKS = (6, 7, 37, 38)
_SOL_SOCKET, _SNDBUF, _RCVBUF = 1, 7, 8


class _Comparison(ctypes.Structure):
    _fields_ = (
        ("argument", ctypes.c_uint),
        ("operation", ctypes.c_int),
        ("a", ctypes.c_uint64),
        ("b", ctypes.c_uint64),
    )


def _libc():
    return ctypes.CDLL(None, use_errno=True)


def _demand(result, what):
    if result != 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{what}: {os.strerror(number)}")


def drop_root(needed: Iterable[str]) -> None:
    """Make a process of root one of nobody, with the groups of nobody; another one stays what it is.

    Raises PermissionError where nobody cannot read one of the folders that are needed: root itself runs nothing.
    """
    if os.geteuid() != 0:
        return
    os.setgroups([])
    os.setresgid(NOBODY, NOBODY, NOBODY)
    os.setresuid(NOBODY, NOBODY, NOBODY)
    for folder in needed:
        if os.path.dirname(folder) and not os.access(os.path.dirname(folder), os.R_OK | os.X_OK):
            raise PermissionError(
                f"{os.path.dirname(folder)} can be read by root alone, who runs no submissions: grade as another user"
            )
    # the change of user took away the right to one's own /proc, where the maps of a namespace are written
    _demand(_libc().prctl(_PR_SET_DUMPABLE, 1, 0, 0, 0), "dumpable")


def confine(disk: int) -> None:
    """Move into new namespaces; the next child is the first process of its own.

    Arguments:
        disk: size (bytes) of the only places that can be written, which are empty.
    """
    libc, user, group = _libc(), os.getuid(), os.getgid()
    with open("/proc/self/oom_score_adj", "w") as file:
        file.write("1000")  # where memory runs out after all, this ends first
    _demand(libc.unshare(sum(_NEW.values())), "namespaces")
    for name, line in (("setgroups", "deny"), ("uid_map", f"{STUDENT} {user} 1"), ("gid_map", f"{STUDENT} {group} 1")):
        with open(f"/proc/self/{name}", "w") as file:
            file.write(line)
    for place, size in ((HOME, disk), ("/dev/shm", disk), ("/proc", 4096)):
        options = f"size={size},nr_inodes=4096,mode=0{'555' if place == '/proc' else '1777'}".encode()
        _demand(libc.mount(b"tmpfs", place.encode(), b"tmpfs", _NOSUID_NODEV, options), f"{place} of its own")
    options = f"ptmxmode=0666,mode=0620,max={_MOST_TERMINALS}".encode()
    _demand(libc.mount(b"devpts", b"/dev/pts", b"devpts", _NOSUID_NODEV & ~4, options), "terminals of its own")


def address_space() -> int | None:
    """Return the size of this process's address space (bytes); None where the system does not tell."""
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return None


def limit(limits: Mapping[str, int], size: int | None, jailed: bool) -> None:
    """Limit this process, and what it will make.

    Arguments:
        limits: those of `jail.Limits`, as a dictionary.
        size: of the address space that it begins with (bytes); without it, memory has no limit.
        jailed: whether the number of processes has a limit; without a namespace, all of the same user would count.
    """
    import resource  # which Windows does not have

    bounds = {
        resource.RLIMIT_CPU: limits["cpu"],
        resource.RLIMIT_FSIZE: limits["file"],
        resource.RLIMIT_NOFILE: 256,
        resource.RLIMIT_CORE: 1,  # at 0, the kernel still hands a dump to the program that collects them
    }
    if size is not None:
        bounds[resource.RLIMIT_AS] = size + limits["memory"]
    if jailed:
        bounds[resource.RLIMIT_NPROC] = limits["processes"]
        # some users may go before all others, up to the machine's standstill
        bounds[resource.RLIMIT_RTPRIO] = bounds[resource.RLIMIT_NICE] = 0
    for which, bound in bounds.items():
        most = resource.getrlimit(which)[1]  # nobody goes beyond what this machine allows already
        bound = bound if most == resource.RLIM_INFINITY else min(bound, most)
        resource.setrlimit(which, (bound, bound))


def call_filter() -> tuple[ctypes.CDLL, int]:
    """Return a filter of system calls that is ready to be loaded, with its library.

    Raises OSError where libseccomp is not installed.
    """
    library = ctypes.CDLL("libseccomp.so.2")
    library.seccomp_init.restype = ctypes.c_void_p
    library.seccomp_init.argtypes = [ctypes.c_uint32]
    library.seccomp_load.argtypes = [ctypes.c_void_p]
    add = library.seccomp_rule_add_array
    add.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int, ctypes.c_uint, ctypes.POINTER(_Comparison)]
    made = library.seccomp_init(_ALLOW)

    def refuse(name, number, *comparisons):
        call = library.seccomp_syscall_resolve_name(name.encode())
        if call >= 0:  # a call that this machine has
            array = (_Comparison * len(comparisons))(*comparisons)
            _demand(add(made, _ERRNO | number, call, len(comparisons), array), f"filter of {name}")

    for name in _REFUSED:
        refuse(name, errno.EPERM)
    refuse("clone", errno.EPERM, _Comparison(0, _MASKED_EQUAL, _NEW["user"], _NEW["user"]))
    for family in set(range(max(_FAMILIES))) - {*_FAMILIES}:
        refuse("socket", errno.EAFNOSUPPORT, _Comparison(0, _EQUAL, family))
    refuse("socket", errno.EAFNOSUPPORT, _Comparison(0, _ABOVE, max(_FAMILIES)))
    for size in (_SNDBUF, _RCVBUF):  # `fork_server.SOCKET` is what it is without
        refuse("setsockopt", errno.EPERM, _Comparison(1, _EQUAL, _SOL_SOCKET), _Comparison(2, _EQUAL, size))
    for command in _LOCKS:
        refuse("fcntl", errno.ENOLCK, _Comparison(1, _EQUAL, command))
    refuse("clone3", errno.ENOSYS)  # its flags are out of a filter's sight; the C library then takes clone
    return library, made


def surrender(call_filter: tuple[ctypes.CDLL, int]) -> None:
    """Give up every capability for good, and load the filter."""
    libc = _libc()
    for capability in range(64):
        if libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0) != 0:  # beyond the last one that the kernel knows
            break
    header = (ctypes.c_uint32 * 2)(_CAPABILITIES_V3, 0)
    _demand(libc.capset(header, (ctypes.c_uint32 * 6)()), "capabilities")
    _demand(libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "no new privileges")
    library, made = call_filter
    _demand(-library.seccomp_load(made), "filter of system calls")
