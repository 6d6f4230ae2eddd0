"""What a process gives up before it runs a submission. Linux alone.

The walls are built twice, for speed. Bubblewrap builds the outer ones once, around the fork server: what is visible,
and no network. To start Python and its libraries in them takes seconds, so it is done once for a class, and each
submission is a fork of that process. What one submission must not have of another, its files, processes and users, the
fork builds for itself, in a tenth of a second, within the outer walls.

All walls are the kernel's: namespaces (``man 7 user_namespaces``), resource limits, capabilities, and a filter of
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
_NEW_CGROUP = 0x02000000
_NOSUID_NODEV = 2 | 4
#: Terminals, of which a machine has 4096: shell escapes take one at a time.
_MOST_TERMINALS = 16
_PR_SET_DUMPABLE, _PR_CAPBSET_DROP, _PR_SET_NO_NEW_PRIVS = 4, 24, 38
_CAPABILITIES_V3 = 0x20080522

#: The system calls of calculations, and of the programs behind shell escapes. Any other one, also one that a later
#: kernel brings, is answered as by a kernel that does not have it, with ENOSYS: libraries then take another way. So
#: there are no other processes, namespaces and mounts to reach, none of the kernel's keys and no programs in it, no
#: other share of the processors, and no memory that a limit does not count (of memfd, System V, splice, io_uring).
_ALLOWED = {
    "files": """
        open openat openat2 creat close close_range read write readv writev pread64 pwrite64 preadv pwritev preadv2
        pwritev2 lseek sendfile copy_file_range stat lstat fstat newfstatat statx statfs fstatfs access faccessat
        faccessat2 readlink readlinkat getdents getdents64 getcwd chdir fchdir mkdir mkdirat rmdir mknod mknodat
        rename renameat renameat2 link linkat symlink symlinkat unlink unlinkat truncate ftruncate fallocate fadvise64
        readahead fsync fdatasync sync_file_range flock chmod fchmod fchmodat fchmodat2 chown fchown lchown fchownat
        umask utime utimes futimesat utimensat getxattr lgetxattr fgetxattr listxattr llistxattr flistxattr dup dup2
        dup3 pipe pipe2
    """,
    "waiting": """
        poll ppoll select pselect6 epoll_create epoll_create1 epoll_ctl epoll_wait epoll_pwait epoll_pwait2 eventfd
        eventfd2 signalfd signalfd4 timerfd_create timerfd_settime timerfd_gettime pause nanosleep clock_nanosleep
        futex futex_waitv
    """,
    "memory": "brk mmap munmap mremap mprotect madvise mincore msync",
    "processes": """
        fork vfork execve execveat exit exit_group wait4 waitid getpid getppid gettid getpgid getpgrp setpgid getsid
        setsid set_tid_address set_robust_list get_robust_list rseq arch_prctl sched_yield sched_getaffinity
        sched_getparam sched_getscheduler sched_getattr sched_get_priority_max sched_get_priority_min
        sched_rr_get_interval getpriority setpriority getrlimit setrlimit prlimit64 getrusage times
    """,
    "signals": """
        kill tkill tgkill rt_sigaction rt_sigprocmask rt_sigreturn rt_sigpending rt_sigsuspend rt_sigtimedwait
        rt_sigqueueinfo rt_tgsigqueueinfo sigaltstack restart_syscall alarm getitimer setitimer timer_create
        timer_settime timer_gettime timer_getoverrun timer_delete
    """,
    "sockets": """
        bind listen accept accept4 connect getsockname getpeername getsockopt sendto sendmsg sendmmsg recvfrom recvmsg
        recvmmsg shutdown
    """,
    "questions": """
        getuid geteuid getresuid getgid getegid getresgid getgroups capget uname sysinfo getcpu getrandom time
        gettimeofday clock_gettime clock_getres
    """,
}
#: Of these calls some uses alone, by the values of arguments, {its place: value}: of sockets those that stay within the
#: namespaces, local ones and the internet's, without larger buffers; of fcntl neither locks on parts of files, of which
#: the kernel keeps as many as one likes, nor larger pipes; of prctl no further filters; of ioctl what terminals and
#: files are asked, and no other drivers of terminals.
_ALLOWED_WITH = {
    "socket": [{0: family} for family in (1, 2, 10)],
    "socketpair": [{0: 1}],
    "setsockopt": [{1: level, 2: option} for level, option in ((1, 2), (1, 9), (1, 15), (6, 1), (41, 26))],
    "fcntl": [{1: command} for command in (0, 1, 2, 3, 4, 8, 9, 1030, 1032)],
    "ioctl": [
        {1: request} for request in (
            0x5401, 0x5402, 0x5403, 0x5404, 0x5409, 0x540A, 0x540B, 0x540E, 0x540F, 0x5410, 0x5411, 0x5413, 0x5414,
            0x541B, 0x5421, 0x5422, 0x5429, 0x5441, 0x5450, 0x5451, 0x40045431, 0x80045430, 0x80045439,
            0x402C542B, 0x402C542C, 0x402C542D, 0x802C542A,
        )
    ],
    "prctl": [{0: option} for option in (1, 2, 3, 4, 15, 16, 23, 38, 39, 0x53564D41)],
}  # fmt: skip
_ALLOW, _NO_SUCH_CALL = 0x7FFF0000, 0x00050000 | errno.ENOSYS
_MASKED_EQUAL, _OPTIMIZED = 7, 8


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
    """Make a process of root one of nobody, with the groups and the capabilities of nobody; another one stays as it is.

    Raises PermissionError where nobody cannot read one of the folders that are needed: root itself runs nothing.
    """
    if os.geteuid() != 0:
        return
    _drop_bounding_set()
    os.setgroups([])
    os.setresgid(NOBODY, NOBODY, NOBODY)
    os.setresuid(NOBODY, NOBODY, NOBODY)
    _keep_no_capability()
    for folder in needed:
        if os.path.dirname(folder) and not os.access(os.path.dirname(folder), os.R_OK | os.X_OK):
            raise PermissionError(
                f"{os.path.dirname(folder)} can be read by root alone, who runs no submissions: grade as another user"
            )
    # the change of user took away the right to one's own /proc, where the maps of a namespace are written
    _demand(_libc().prctl(_PR_SET_DUMPABLE, 1, 0, 0, 0), "dumpable")


def _drop_bounding_set():
    """Give up every capability that a program could bring back."""
    for capability in range(64):
        if _libc().prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0) != 0:  # beyond the last one that the kernel knows
            break


def _keep_no_capability():
    """Give up what is left, also what a program that is started could take over."""
    header = (ctypes.c_uint32 * 2)(_CAPABILITIES_V3, 0)
    _demand(_libc().capset(header, (ctypes.c_uint32 * 6)()), "capabilities")


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
    library.seccomp_attr_set.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32]
    made = library.seccomp_init(_NO_SUCH_CALL)
    library.seccomp_attr_set(made, _OPTIMIZED, 2)  # by a tree, where the library can; else it takes some more time

    def allow(name, *comparisons):
        call = library.seccomp_syscall_resolve_name(name.encode())
        if call >= 0:  # a call that this machine has
            array = (_Comparison * len(comparisons))(*comparisons)
            _demand(add(made, _ALLOW, call, len(comparisons), array), f"filter of {name}")

    for name in " ".join(_ALLOWED.values()).split():
        allow(name)
    for name, cases in _ALLOWED_WITH.items():
        for values in cases:  # of the 64 bits of an argument, the kernel takes the lower half for these
            allow(name, *(_Comparison(place, _MASKED_EQUAL, 0xFFFFFFFF, value) for place, value in values.items()))
    # the flags of clone3 are out of a filter's sight; without it the C library takes clone
    allow("clone", _Comparison(0, _MASKED_EQUAL, sum(_NEW.values()) | _NEW_CGROUP, 0))
    return library, made


def surrender(call_filter: tuple[ctypes.CDLL, int]) -> None:
    """Give up every capability for good, and load the filter."""
    libc = _libc()
    _drop_bounding_set()
    _keep_no_capability()
    _demand(libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "no new privileges")
    library, made = call_filter
    _demand(-library.seccomp_load(made), "filter of system calls")
